// How near grown roofs come to measured ones: Rotterdam's LoD2 houses, nearly all blocks under level roofs at two or
// more heights. Given are footprints and measured eave and ridge heights as a mapper would write them down (Simple 3D
// Buildings): an outline, or one building:part for each roof that is set off from the next by a wall. The shape follows
// from these alone: flat without a difference between eave and ridge, gabled otherwise.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "runtime/core/file.hpp"
#include "runtime/roof/shapes.hpp"
#include "tests/roof/structure_judge.hpp"
#include "tests/support/data.hpp"

using namespace espalier;
using namespace espalier::test;
using nlohmann::json;

namespace {

using Polygon = std::vector<glm::dvec3>;
using Corner = std::array<int64_t, 3>;  // millimetres

// A measured building, metres above its ground.
struct Building {
    std::string id;
    std::vector<std::vector<Corner>> roofs;
    std::vector<Corner> ground;
};

std::vector<Building> buildingsOf(const json& city) {
    std::vector<Building> all;
    for (const auto& [id, object] : city["CityObjects"].items()) {
        const json& geometry = object["geometry"][0];
        Building b{id, {}, {}};
        for (size_t i = 0; i < geometry["boundaries"].size(); i++) {
            const json& surface = geometry["semantics"]["surfaces"][geometry["semantics"]["values"][i].get<size_t>()];
            std::vector<Corner> ring;
            for (const json& v : geometry["boundaries"][i][0]) {
                const json& p = city["vertices"][v.get<size_t>()];
                ring.push_back({p[0].get<int64_t>() - 580000, p[1].get<int64_t>() - 190000, p[2].get<int64_t>()});
            }
            REQUIRE(geometry["boundaries"][i].size() == 1);
            if (surface["type"] == "RoofSurface") b.roofs.push_back(ring);
            if (surface["type"] == "GroundSurface") b.ground = ring;
        }
        const int64_t ground = b.ground.at(0)[2];
        for (Corner& c : b.ground) c[2] -= ground;
        for (auto& ring : b.roofs)
            for (Corner& c : ring) c[2] -= ground;
        all.push_back(std::move(b));
    }
    return all;
}

Polygon metres(const std::vector<Corner>& ring) {
    Polygon p;
    for (const Corner& c : ring) p.push_back(glm::dvec3(double(c[0]), double(c[1]), double(c[2])) * 0.001);
    return p;
}

// A building for a plan in metres: outline, eave and ridge.
json plan(const std::string& id, const std::vector<Corner>& ring, int64_t eave, int64_t ridge) {
    json outer = json::array();
    for (const Corner& c : ring) outer.push_back({double(c[0]) * 0.001, double(c[1]) * 0.001});
    const bool flat = ridge - eave < 100;
    json b = {{"id", id}, {"outer", outer}, {"height", double(ridge) * 0.001}};
    b["roof:shape"] = flat ? "flat" : "gabled";
    if (!flat) b["roof:height"] = double(ridge - eave) * 0.001;
    return b;
}

// One part for all roof surfaces that share an edge in space: the edges that only one of them has go round it.
std::vector<json> partsOf(const Building& b) {
    const size_t count = b.roofs.size();
    std::vector<size_t> part(count);
    for (size_t i = 0; i < count; i++) part[i] = i;
    auto edges = [&](size_t i) {
        std::vector<std::pair<Corner, Corner>> out;
        for (size_t k = 0; k < b.roofs[i].size(); k++)
            out.push_back({b.roofs[i][k], b.roofs[i][(k + 1) % b.roofs[i].size()]});
        std::erase_if(out, [](const auto& e) { return e.first == e.second; });  // some corners are given twice
        return out;
    };
    for (size_t round = 0; round < count; round++)
        for (size_t i = 0; i < count; i++)
            for (size_t j = 0; j < count; j++)
                for (const auto& e : edges(i))
                    for (const auto& f : edges(j))
                        if (e.first == f.second && e.second == f.first) part[i] = part[j] = std::min(part[i], part[j]);
    std::vector<json> plans;
    for (size_t p = 0; p < count; p++) {
        std::map<Corner, Corner> round;
        int64_t eave = INT64_MAX, ridge = INT64_MIN;
        for (size_t i = 0; i < count; i++) {
            if (part[i] != p) continue;
            for (const auto& [from, to] : edges(i)) {
                eave = std::min(eave, from[2]);
                ridge = std::max(ridge, from[2]);
                auto back = round.find(to);
                if (back != round.end() && back->second == from)
                    round.erase(back);
                else
                    round[from] = to;
            }
        }
        if (round.empty()) continue;
        std::vector<Corner> ring;
        for (Corner at = round.begin()->first; round.count(at) && ring.size() <= round.size(); at = round[at]) {
            if (!ring.empty() && at == ring[0]) break;
            ring.push_back(at);
        }
        plans.push_back(plan(b.id + " part " + std::to_string(p), ring, eave, ridge));
        plans.back()["building:part"] = "yes";
    }
    return plans;
}

bool inside(const Polygon& ring, glm::dvec2 p) {
    bool in = false;
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        glm::dvec3 a = ring[i], b = ring[j];
        if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) in = !in;
    }
    return in;
}

double planeHeight(const Polygon& ring, glm::dvec2 p) {
    glm::dvec3 n(0);
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
        n += glm::cross(ring[j] - ring[0], ring[i] - ring[0]);
    return ring[0].z - (n.x * (p.x - ring[0].x) + n.y * (p.y - ring[0].y)) / n.z;
}

// Mean over the ground's outline of |grown - measured|; the ground where nothing has grown.
double meanDifference(const Building& b, const std::vector<json>& buildings) {
    Result<Town> town = parseFootprints(json{{"buildings", buildings}}.dump(), "rotterdam");
    REQUIRE(town);
    std::vector<Diagnostic> said;
    const RoofStructure grown = roofsOf(town->footprints, said);
    std::vector<Polygon> roofs;
    for (const auto& ring : b.roofs) roofs.push_back(metres(ring));
    const Polygon ground = metres(b.ground);
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (glm::dvec2 p : ground) low = glm::min(low, p), high = glm::max(high, p);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> x(low.x, high.x), y(low.y, high.y);
    double sum = 0;
    size_t count = 0;
    for (int i = 0; i < 4000; i++) {
        const glm::dvec2 p(x(random), y(random));
        double measured = -INFINITY, ours = 0;
        for (const Polygon& roof : roofs)
            if (inside(roof, p)) measured = std::max(measured, planeHeight(roof, p));
        if (!inside(ground, p) || !std::isfinite(measured)) continue;
        for (uint32_t h = 0; h < grown.houses.size(); h++) {
            const double above = heightAt(grown, h, p - grown.houses[h].origin);
            if (std::isfinite(above)) ours = std::max(ours, grown.houses[h].eaveHeight + above);
        }
        sum += std::abs(ours - measured);
        count++;
    }
    REQUIRE(count > 400);
    return sum / double(count);
}

}  // namespace

TEST_CASE("Rotterdam's roofs") {
    std::optional<std::string> path = dataFile("footprints/rotterdam_lod2.city.json");
    if (!path) return;
    std::vector<double> byParts, whole;
    for (const Building& b : buildingsOf(json::parse(*readTextFile(*path)))) {
        int64_t eave = INT64_MAX, ridge = INT64_MIN;
        for (const auto& ring : b.roofs)
            for (const Corner& c : ring) eave = std::min(eave, c[2]), ridge = std::max(ridge, c[2]);
        const json outline = plan(b.id, b.ground, eave, ridge);
        std::vector<json> parts = partsOf(b);
        const size_t count = parts.size();
        parts.push_back(outline);  // as maps hold it beside its parts
        byParts.push_back(meanDifference(b, parts));
        whole.push_back(meanDifference(b, {outline}));
        MESSAGE(b.id << ": mean height difference " << byParts.back() << " m by its " << count << " parts, "
                     << whole.back() << " m by its footprint alone");
    }
    std::sort(byParts.begin(), byParts.end());
    std::sort(whole.begin(), whole.end());
    REQUIRE(byParts.size() == 16);
    MESSAGE("median over the houses: " << byParts[8] << " m by parts, " << whole[8] << " m by footprints alone");
    // Level roofs fit to the millimetre once parts are where they should be; of the one sloping house the ridge runs
    // across its length, which neither outline nor heights tell.
    CHECK(byParts[8] <= 0.01);
    CHECK(byParts[14] <= 0.5);
    CHECK(whole[8] > byParts[8]);
    CHECK(whole[8] <= 1.85);
}
