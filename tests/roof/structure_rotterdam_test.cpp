// How near grown roofs come to measured ones: Rotterdam's LoD2 houses. All but one are blocks under level roofs at two
// or more heights, which one footprint with an eave and a ridge can't say: by footprints alone the best shape stays
// about a metre off. Given as their parts (building:part) with heights of their own, level roofs fit by construction;
// that figure says only that parts are placed where they should be.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "runtime/core/file.hpp"
#include "runtime/roof/shapes.hpp"
#include "tests/roof/structure_cases.hpp"
#include "tests/roof/structure_judge.hpp"
#include "tests/support/data.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

using Polygon = std::vector<glm::dvec3>;

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

struct Sample {
    glm::dvec2 at;
    double height;
};

// Mean over the outlines' area of |grown - measured|. Each is given its lowest and highest measured roof and the shape
// that fits best, as a mapper would have written them down.
double meanDifference(std::vector<Footprint>& outlines, const std::vector<Polygon>& roofs, std::string& shapes) {
    double sum = 0, area = 0;
    for (Footprint& f : outlines) {
        Polygon ground;
        glm::dvec2 low(INFINITY), high(-INFINITY);
        for (glm::dvec2 p : f.rings[0]) ground.push_back({p, 0}), low = glm::min(low, p), high = glm::max(high, p);
        std::mt19937 random(11);
        std::uniform_real_distribution<double> x(low.x, high.x), y(low.y, high.y);
        std::vector<Sample> samples;
        std::vector<double> heights;
        for (int i = 0; i < 1000; i++) {
            glm::dvec2 p(x(random), y(random));
            double top = -INFINITY;
            for (const Polygon& roof : roofs)
                if (inside(roof, p)) top = std::max(top, planeHeight(roof, p));
            if (!inside(ground, p) || !std::isfinite(top)) continue;
            samples.push_back({p, top});
            heights.push_back(top);
        }
        if (samples.size() < 10) continue;
        std::sort(heights.begin(), heights.end());
        size_t last = heights.size() - 1;
        double eave = heights[last / 50], ridge = heights[last - last / 50], best = INFINITY;
        uint32_t bestShape = 0;
        for (uint32_t shape = 0; shape <= uint32_t(RoofShape::flat); shape++)
            for (int turn = 0; turn < 4; turn++) {
                bool flat = RoofShape(shape) == RoofShape::flat;
                if (turn > 0 && RoofShape(shape) != RoofShape::shed && RoofShape(shape) != RoofShape::gable) continue;
                f.shape = RoofShape(shape);
                f.orientation = turn % 2 ? RidgeOrientation::across : RidgeOrientation::along;
                f.direction = turn * 1.5708;
                f.height = flat ? heights[last / 2] : ridge;
                f.roofHeight = flat ? std::nullopt : std::optional(std::max(ridge - eave, 0.05));
                std::vector<Diagnostic> said;
                RoofStructure roof = roofOf(f, said);
                double difference = 0;
                size_t counted = 0;
                for (const Sample& s : samples)
                    for (uint32_t h = 0; h < roof.houses.size(); h++) {
                        double grown = heightAt(roof, h, s.at - roof.houses[h].origin);
                        if (!std::isfinite(grown)) continue;
                        difference += std::abs(roof.houses[h].eaveHeight + grown - s.height);
                        counted++;
                        break;
                    }
                if (counted * 10 < samples.size() * 9) continue;
                if (difference / double(counted) < best) best = difference / double(counted), bestShape = shape;
            }
        REQUIRE(std::isfinite(best));
        double share = double(samples.size()) * (high.x - low.x) * (high.y - low.y);
        sum += best * share;
        area += share;
        shapes += " " + std::to_string(bestShape);
    }
    return sum / area;
}

}  // namespace

TEST_CASE("Rotterdam's roofs") {
    std::optional<std::string> path = dataFile("footprints/rotterdam_lod2.city.json");
    if (!path) return;
    nlohmann::json city = nlohmann::json::parse(*readTextFile(*path));
    auto vertex = [&](const nlohmann::json& index) {
        const auto& v = city["vertices"][index.get<size_t>()];
        return glm::dvec3(v[0].get<double>() - 580000, v[1].get<double>() - 190000, v[2].get<double>()) * 0.001;
    };
    std::vector<double> byParts, whole;
    for (const auto& [id, object] : city["CityObjects"].items()) {
        const auto& geometry = object["geometry"][0];
        std::vector<Polygon> roofs;
        std::vector<Footprint> grounds, parts;
        for (size_t i = 0; i < geometry["boundaries"].size(); i++) {
            size_t kind = geometry["semantics"]["values"][i].get<size_t>();
            std::string type = geometry["semantics"]["surfaces"][kind]["type"];
            Polygon ring;
            for (const auto& v : geometry["boundaries"][i][0]) ring.push_back(vertex(v));
            auto [low, high] = std::minmax_element(ring.begin(), ring.end(), [](auto a, auto b) { return a.z < b.z; });
            if (type == "GroundSurface") grounds.push_back(outline(id, {Ring(ring.begin(), ring.end())}));
            if (type != "RoofSurface") continue;
            roofs.push_back(ring);
            if (high->z - low->z < 0.1) parts.push_back(outline(id, {Ring(ring.begin(), ring.end())}));
        }
        // Sloping surfaces belong together: the house is one part then.
        if (parts.size() != roofs.size()) parts = grounds;
        std::string shapes;
        whole.push_back(meanDifference(grounds, roofs, shapes));
        shapes.clear();
        byParts.push_back(meanDifference(parts, roofs, shapes));
        MESSAGE(id << ": mean height difference " << byParts.back() << " m, shapes" << shapes
                   << "; by its footprint alone " << whole.back() << " m");
    }
    std::sort(byParts.begin(), byParts.end());
    std::sort(whole.begin(), whole.end());
    REQUIRE(byParts.size() == 16);
    MESSAGE("median over the houses: " << byParts[8] << " m by parts, " << whole[8] << " m by footprints alone");
    CHECK(byParts[8] <= 0.01);
    CHECK(whole[8] <= 1.3);
}
