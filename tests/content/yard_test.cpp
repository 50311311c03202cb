// What stands in yards and gardens. In: meshes, the sample's site. The judge lays a rectangle about each thing, as wide
// as its mesh, and asks whether two overlap, or one a house; the layout goes by circles.

#include <doctest/doctest.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "tools/content/props.hpp"
#include "tools/content/ruin.hpp"
#include "tools/content/site.hpp"

using namespace espalier::content;
using glm::vec2;

namespace {

constexpr float kMeadow = -0.06f, kPi = 3.14159265f;
const std::set<std::string> kThings{"woodpile", "barrel",  "tub",    "seat", "trough", "cart",
                                    "hives",    "washing", "boards", "step", "bench",  "well"};
const std::set<std::string> kFences{"fence", "wall", "hedge", "rails"};

struct Bounds {
    glm::vec3 low{1e9f}, high{-1e9f};
};
std::map<std::string, Bounds> boundsOfProps() {
    std::map<std::string, Bounds> all;
    for (const PropMeshes::Entry& e : makePropMeshes().all) {
        if (!e.name.ends_with("_lod0")) continue;
        Bounds& b = all[e.name.substr(0, e.name.rfind("_lod"))];
        for (glm::vec3 p : e.mesh.positions) b.low = glm::min(b.low, p), b.high = glm::max(b.high, p);
    }
    return all;
}

struct Footprint {
    std::string model;
    std::vector<vec2> corners;
};
// Rectangles; stones to step on are round.
Footprint footprint(const std::string& model, const SitePlace& p, const Bounds& b) {
    const float a = p.degrees * kPi / 180, c = std::cos(a), s = std::sin(a);
    const vec2 low(b.low.x, b.low.z), high(b.high.x, b.high.z);
    Footprint f{model, {}};
    const auto add = [&](vec2 share) {
        const vec2 local = p.scale * glm::mix(low, high, share);
        f.corners.push_back(vec2(p.position.x, p.position.z) +
                            vec2(c * local.x + s * local.y, c * local.y - s * local.x));
    };
    if (model == "step")
        for (int k = 0; k < 12; ++k)
            add(0.5f + 0.5f * vec2(std::cos(kPi / 6 * float(k)), std::sin(kPi / 6 * float(k))));
    else
        for (vec2 share : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)}) add(share);
    return f;
}
// Is there a side of `a` that all of `b` lies beyond?
template <class A, class B>
bool parted(const A& a, const B& b) {
    for (size_t i = 0; i < a.size(); ++i) {
        const vec2 d = a[(i + 1) % a.size()] - a[i], n(d.y, -d.x);
        const auto most = [&](const auto& shape) {
            float low = 1e9f, high = -1e9f;
            for (vec2 p : shape) low = std::min(low, glm::dot(p, n)), high = std::max(high, glm::dot(p, n));
            return std::pair(low, high);
        };
        const auto [low, high] = most(a);
        const auto [low2, high2] = most(b);
        if (high <= low2 || high2 <= low) return true;
    }
    return false;
}
template <class A, class B>
bool overlap(const A& a, const B& b) {
    return !parted(a, b) && !parted(b, a);
}

Site sampleSite() {
    auto houses = readOutlines("content/street.json");
    auto doors = findDoors("content/street.json", "content/grammars/town.grammar");
    REQUIRE(houses);
    REQUIRE(doors);
    return makeSite(*houses, *doors, 256);
}

}  // namespace

TEST_CASE("what stands in yards stands on the ground, and flowers above it in a tub") {
    const auto bounds = boundsOfProps();
    const Site site = sampleSite();
    for (const std::string& thing : kThings) {
        CAPTURE(thing);
        REQUIRE(bounds.count(thing));
        CHECK(bounds.at(thing).low.y <= 0.001f);
        REQUIRE(site.props.count(thing));
        for (const SitePlace& p : site.props.at(thing)) CHECK(p.position.y <= kMeadow + 0.001f);
    }
    for (const auto& [model, places] : site.props)
        for (const SitePlace& p : places) {
            const vec2 at(p.position.x, p.position.z);
            const bool grass = model.starts_with("tuft") || model.starts_with("meadow") || model == "turf";
            const bool inCourt = grass && std::abs(p.position.y - groundHeight(at)) < 0.02f;
            if (p.position.y <= kMeadow + 0.001f || inCourt) continue;
            CAPTURE(model);
            const auto& tubs = site.props.at("tub");
            const bool held = std::any_of(tubs.begin(), tubs.end(), [&](const SitePlace& tub) {
                const glm::vec3 up = p.position - tub.position;
                return glm::length(vec2(up.x, up.z)) < 0.01f && up.y < bounds.at("tub").high.y;
            });
            CHECK(held);
        }
}

TEST_CASE("a stone of a heap lies in the ground or on another") {
    const PropMeshes props = makePropMeshes();
    const auto found = std::find_if(props.all.begin(), props.all.end(),
                                    [](const PropMeshes::Entry& e) { return e.name == "rubble_lod0"; });
    REQUIRE(found != props.all.end());
    constexpr size_t kVertices = 6 * 5 * 5;  // of one stone: six faces
    const auto& points = found->mesh.positions;
    REQUIRE(points.size() % kVertices == 0);
    std::vector<Bounds> stones(points.size() / kVertices);
    for (size_t i = 0; i < points.size(); ++i) {
        Bounds& b = stones[i / kVertices];
        b.low = glm::min(b.low, points[i]), b.high = glm::max(b.high, points[i]);
    }
    CHECK(stones.size() > 4);
    for (const Bounds& a : stones) {
        CAPTURE(&a - stones.data());
        const bool sunk = a.low.y < -0.03f;
        const bool borne = std::any_of(stones.begin(), stones.end(), [&](const Bounds& b) {
            return &a != &b && b.low.y < -0.03f && a.low.y < b.high.y - 0.01f &&
                   0.5f * (a.low.y + a.high.y) > b.high.y && a.low.x < b.high.x && b.low.x < a.high.x &&
                   a.low.z < b.high.z && b.low.z < a.high.z;
        });
        const bool rests = sunk || borne;
        CHECK(rests);
    }
}

TEST_CASE("a woodpile's logs lie between its posts") {
    size_t ends = 0;
    for (const PropMeshes::Entry& e : makePropMeshes().all) {
        if (!e.name.starts_with("woodpile")) continue;
        CAPTURE(e.name);
        for (glm::vec3 p : e.mesh.positions) {
            if (p.y > 0.91f || p.z < 0.201f) continue;  // boards, posts and what lies behind their fronts
            ++ends;
            CHECK(std::abs(p.x) < 0.936f);
        }
    }
    CHECK(ends > 200);
}

TEST_CASE("what stands in many yards is simple from afar") {
    std::map<std::string, size_t> triangles;  // of the farthest level
    for (const PropMeshes::Entry& e : makePropMeshes().all)
        triangles[e.name.substr(0, e.name.rfind("_lod"))] = e.mesh.indices.size() / 3;
    const Site site = sampleSite();
    for (const std::string& thing : kThings) {
        CAPTURE(thing);
        CHECK(triangles.at(thing) * site.props.at(thing).size() < 2500);
    }
}

TEST_CASE("nothing in a yard stands in a wall, a fence or another thing") {
    const auto bounds = boundsOfProps();
    const Site site = sampleSite();
    auto houses = readOutlines("content/street.json");
    REQUIRE(houses);
    std::vector<Footprint> things, fences;
    for (const auto& [model, places] : site.props)
        for (const SitePlace& p : places) {
            if (kThings.count(model)) things.push_back(footprint(model, p, bounds.at(model)));
            if (kFences.count(model)) fences.push_back(footprint(model, p, bounds.at(model)));
        }
    CHECK(things.size() > 100);
    for (size_t i = 0; i < things.size(); ++i) {
        const Footprint& f = things[i];
        CAPTURE(f.model);
        CAPTURE(f.corners[0].x);
        CAPTURE(f.corners[0].y);
        // Houses needn't be convex: each of their walls is asked.
        for (const Outline& o : *houses)
            for (size_t k = 0; k < o.size(); ++k)
                CHECK_FALSE(overlap(f.corners, std::array<vec2, 2>{o[k], o[(k + 1) % o.size()]}));
        for (size_t k = 0; k < i; ++k) {
            CAPTURE(things[k].model);
            CHECK_FALSE(overlap(f.corners, things[k].corners));
        }
        for (const Footprint& fence : fences) {
            CAPTURE(fence.model);
            CHECK_FALSE(overlap(f.corners, fence.corners));
        }
    }
}
