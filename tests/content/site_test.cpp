// Props and the site: meshes are sound, and nothing stands in a house or on a street. The judge reads the outlines anew
// and asks the painted map, not the layout's own distances.

#include <doctest/doctest.h>
#include <algorithm>
#include <cmath>
#include <set>

#include "shaders/emit/emit_records.h"
#include "tools/content/props.hpp"
#include "tools/content/site.hpp"

using namespace espalier::content;

namespace {

// By the angles under which the corners are seen.
bool within(const Outline& o, glm::vec2 p) {
    double sum = 0;
    for (size_t i = 0; i < o.size(); ++i) {
        const glm::dvec2 a = glm::dvec2(o[i]) - glm::dvec2(p), b = glm::dvec2(o[(i + 1) % o.size()]) - glm::dvec2(p);
        sum += std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
    }
    return std::abs(sum) > 3;
}

const uint8_t* mapAt(const Site& site, glm::vec2 p) {
    const glm::vec2 at = (p - site.low) / (site.high - site.low) * glm::vec2(site.map.width, site.map.height);
    return site.map.at(int(at.x), int(at.y));
}

}  // namespace

TEST_CASE("props' meshes are sound and get coarser level by level") {
    const PropMeshes props = makePropMeshes();
    std::map<std::string, size_t> finer;
    for (const PropMeshes::Entry& e : props.all) {
        CAPTURE(e.name);
        const Mesh& m = e.mesh;
        REQUIRE(m.positions.size() == m.normals.size());
        REQUIRE(m.positions.size() == m.uvs.size());
        REQUIRE(m.indices.size() % 3 == 0);
        for (uint32_t i : m.indices) REQUIRE(i < m.positions.size());
        for (size_t i = 0; i < m.positions.size(); ++i) {
            REQUIRE(std::isfinite(m.positions[i].x + m.positions[i].y + m.positions[i].z));
            REQUIRE(glm::length(m.normals[i]) == doctest::Approx(1).epsilon(0.001));
            REQUIRE(m.positions[i].y > -1.2f);
        }
        const std::string model = e.name.substr(0, e.name.rfind("_lod"));
        if (finer.count(model)) CHECK(m.indices.size() < finer[model]);
        finer[model] = m.indices.size();
        CHECK(m.indices.size() / 3 < 1500);
    }
    std::set<std::string> kinds;
    for (const auto& [model, triangles] : finer) kinds.insert(model.substr(0, model.find('_')));
    CHECK(kinds.size() < espalier::kMaxTerminalKinds);  // the first is none
}

TEST_CASE("a card's texture coordinates stay in one cell of the foliage") {
    for (const PropMeshes::Entry& e : makePropMeshes().all) {
        if (e.material != PropMeshes::kFoliage && e.material != PropMeshes::kMeadow) continue;
        CAPTURE(e.name);
        for (size_t i = 0; i < e.mesh.indices.size(); i += 3) {
            std::set<int> open;
            glm::vec2 low(1), high(0);
            for (size_t k = 0; k < 3; ++k) {
                const glm::vec2 uv = e.mesh.uvs[e.mesh.indices[i + k]];
                open.insert(int(std::floor(uv.x)));
                low = glm::min(low, glm::fract(uv));
                high = glm::max(high, glm::fract(uv));
            }
            CHECK(*open.begin() >= 1);
            CHECK(*open.rbegin() <= 8);
            if (e.mesh.uvs[e.mesh.indices[i]].y < 0)
                CHECK(glm::all(glm::lessThan(high - low, glm::vec2(kCellSide))));
            else  // bark
                CHECK(open.size() == 1);
        }
    }
}

TEST_CASE("the whole part of a card's v tells how it faces") {
    size_t cards = 0;
    for (const PropMeshes::Entry& e : makePropMeshes().all) {
        if (e.material != PropMeshes::kFoliage && e.material != PropMeshes::kMeadow) continue;
        CAPTURE(e.name);
        const Mesh& m = e.mesh;
        for (size_t i = 0; i < m.indices.size(); i += 3) {
            const uint32_t a = m.indices[i], b = m.indices[i + 1], c = m.indices[i + 2];
            if (m.uvs[a].y >= 0) continue;  // bark
            ++cards;
            const int code = -1 - int(std::floor(m.uvs[a].y));
            REQUIRE(std::floor(m.uvs[b].y) == std::floor(m.uvs[a].y));
            REQUIRE(std::floor(m.uvs[c].y) == std::floor(m.uvs[a].y));
            REQUIRE(code >= 0);
            REQUIRE(code < 1024);
            // The octahedron's square, unfolded: its corners are folded down.
            const float x = (float(code % 32) + 0.5f) / 16 - 1, z = (float(code / 32) + 0.5f) / 16 - 1;
            glm::vec3 told(x, 1 - std::abs(x) - std::abs(z), z);
            if (told.y < 0) told = {std::copysign(1 - std::abs(z), x), told.y, std::copysign(1 - std::abs(x), z)};
            const glm::vec3 faces = glm::cross(m.positions[b] - m.positions[a], m.positions[c] - m.positions[a]);
            CHECK(std::abs(glm::dot(glm::normalize(told), glm::normalize(faces))) > 0.99f);
        }
    }
    CHECK(cards > 2000);
}

TEST_CASE("no twig of a tree hangs in the air by itself") {
    size_t cards = 0;
    for (const PropMeshes::Entry& e : makePropMeshes().all) {
        const bool tree = e.name.starts_with("lime") || e.name.starts_with("apple") || e.name.starts_with("birch");
        if (!tree || e.name.ends_with("_lod2")) continue;
        CAPTURE(e.name);
        std::vector<glm::vec4> twigs;  // middle and side
        for (size_t v = 0; v + 3 < e.mesh.positions.size();) {
            if (e.mesh.uvs[v].y >= 0) {  // bark
                ++v;
                continue;
            }
            const glm::vec3 a = e.mesh.positions[v], c = e.mesh.positions[v + 2];
            twigs.push_back({0.5f * (a + c), glm::distance(a, e.mesh.positions[v + 1])});
            v += 4;
        }
        cards += twigs.size();
        for (const glm::vec4& t : twigs) {
            CAPTURE(t.y);
            CHECK(std::count_if(twigs.begin(), twigs.end(), [&](const glm::vec4& other) {
                      return glm::distance(glm::vec3(t), glm::vec3(other)) < 1.2f * t.w;
                  }) >= 4);
        }
    }
    CHECK(cards > 1500);
}

TEST_CASE("twigs have gaps and leaves, and no leaf is black") {
    const Picture picture = paintFoliage(512);
    size_t leaves = 0, dark = 0;
    for (int y = 0; y < 512; ++y)
        for (int x = 64; x < 448; ++x) {
            const uint8_t* texel = picture.at(x, y);
            if (texel[3] < 128) continue;
            ++leaves;
            if (texel[1] < 30) ++dark;
        }
    CHECK(leaves > 0.15 * 384 * 512);
    CHECK(leaves < 0.7 * 384 * 512);
    CHECK(dark * 100 < leaves);
}

TEST_CASE("nothing stands in a house or on a street, and streets lead past no wall") {
    auto houses = readOutlines("content/street.json");
    REQUIRE(houses);
    REQUIRE(houses->size() == 15);
    auto doors = findDoors("content/street.json", "content/grammars/town.grammar");
    REQUIRE(doors);
    const Site site = makeSite(*houses, *doors, 256);
    // Far from all, the ground isn't trodden: what is at the map's rim goes on for ever.
    for (int y = 0; y < site.map.height; ++y) CHECK(site.map.at(0, y)[1] == 0);
    CHECK(site.props.at("well").size() == 1);
    size_t trees = 0;
    for (const auto& [model, places] : site.props)
        for (const SitePlace& p : places) {
            const glm::vec2 at(p.position.x, p.position.z);
            CAPTURE(model);
            CAPTURE(at.x);
            CAPTURE(at.y);
            for (const Outline& o : *houses) CHECK_FALSE(within(o, at));
            CHECK(p.scale > 0);
            const bool tree = model.starts_with("lime") || model.starts_with("apple") || model.starts_with("birch");
            trees += tree;
            if (glm::max(std::abs(at.x), std::abs(at.y)) > 100 || !tree) continue;
            CHECK(mapAt(site, at)[0] < 118);
        }
    CHECK(trees > 60);
    int paved = 0;
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) {
            if (site.map.at(x, y)[0] < 128) continue;
            ++paved;
            const glm::vec2 p = glm::mix(site.low, site.high, (glm::vec2(x, y) + 0.5f) / 256.0f);
            for (const Outline& o : *houses) CHECK_FALSE(within(o, p));
        }
    CHECK(paved > 800);
    CHECK(siteJson(site).find("\"map\":\"site.png\"") != std::string::npos);
}

TEST_CASE("doors stand in walls, face out of them, and have a path if a street is near") {
    auto houses = readOutlines("content/street.json");
    auto doors = findDoors("content/street.json", "content/grammars/town.grammar");
    REQUIRE(houses);
    REQUIRE(doors);
    REQUIRE(doors->size() > 15);
    const Site bare = makeSite(*houses, {}, 512), site = makeSite(*houses, *doors, 512);
    int reached = 0;
    for (const Door& door : *doors) {
        CAPTURE(door.at.x);
        CAPTURE(door.at.y);
        const auto inside = [&](glm::vec2 p) {
            return std::any_of(houses->begin(), houses->end(), [&](const Outline& o) { return within(o, p); });
        };
        CHECK(glm::length(door.out) == doctest::Approx(1));
        CHECK(inside(door.at - 0.4f * door.out));
        CHECK_FALSE(inside(door.at + 0.4f * door.out));
        const glm::vec2 before = door.at + 1.2f * door.out;
        reached += mapAt(site, before)[0] > 128 && mapAt(bare, before)[0] < 128;
    }
    CHECK(reached > 8);
    CHECK_FALSE(findDoors("content/street.json", "content/grammars/none.grammar"));
}

TEST_CASE("a town that is none is told by name") {
    auto none = readOutlines("content/sample.json");
    REQUIRE_FALSE(none);
    CHECK(none.failure().text().find("sample.json") != std::string::npos);
}
