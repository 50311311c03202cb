// How near grown roofs come to measured ones: Rotterdam's LoD2 houses, given footprint, lowest and highest roof.
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

}  // namespace

TEST_CASE("Rotterdam's roofs") {
    std::optional<std::string> path = dataFile("footprints/rotterdam_lod2.city.json");
    if (!path) return;
    nlohmann::json city = nlohmann::json::parse(*readTextFile(*path));
    auto vertex = [&](const nlohmann::json& index) {
        const auto& v = city["vertices"][index.get<size_t>()];
        return glm::dvec3(v[0].get<double>() - 580000, v[1].get<double>() - 190000, v[2].get<double>()) * 0.001;
    };
    std::vector<double> means;
    for (const auto& [id, object] : city["CityObjects"].items()) {
        const auto& geometry = object["geometry"][0];
        std::vector<Polygon> roofs;
        std::vector<Footprint> grounds;
        for (size_t i = 0; i < geometry["boundaries"].size(); i++) {
            size_t kind = geometry["semantics"]["values"][i].get<size_t>();
            std::string type = geometry["semantics"]["surfaces"][kind]["type"];
            Polygon ring;
            for (const auto& v : geometry["boundaries"][i][0]) ring.push_back(vertex(v));
            if (type == "RoofSurface") roofs.push_back(ring);
            if (type != "GroundSurface") continue;
            Footprint f = outline(id, {Ring(ring.begin(), ring.end())});
            for (size_t h = 1; h < geometry["boundaries"][i].size(); h++) {
                f.rings.emplace_back();
                for (const auto& v : geometry["boundaries"][i][h]) f.rings.back().push_back(vertex(v));
            }
            grounds.push_back(std::move(f));
        }
        double sum = 0, area = 0;
        std::string shapes;
        for (Footprint& f : grounds) {
            Polygon ground;
            glm::dvec2 low(INFINITY), high(-INFINITY);
            for (glm::dvec2 p : f.rings[0]) ground.push_back({p, 0}), low = glm::min(low, p), high = glm::max(high, p);
            std::mt19937 random(11);
            std::uniform_real_distribution<double> x(low.x, high.x), y(low.y, high.y);
            std::vector<Sample> samples;
            for (int i = 0; i < 2000; i++) {
                glm::dvec2 p(x(random), y(random));
                double top = -INFINITY;
                for (const Polygon& roof : roofs)
                    if (inside(roof, p)) top = std::max(top, planeHeight(roof, p));
                if (inside(ground, p) && std::isfinite(top)) samples.push_back({p, top});
            }
            if (samples.size() < 10) continue;
            std::vector<double> heights;
            for (const Sample& s : samples) heights.push_back(s.height);
            std::sort(heights.begin(), heights.end());
            size_t last = heights.size() - 1;
            double eave = heights[last / 50], ridge = heights[last - last / 50], middle = heights[last / 2],
                   best = INFINITY;
            std::string bestShape;
            // The shape is what a mapper would have written down: the one that fits best.
            for (uint32_t shape = 0; shape <= uint32_t(RoofShape::flat); shape++)
                for (int turn = 0; turn < 4; turn++) {
                    bool flat = RoofShape(shape) == RoofShape::flat;
                    f.shape = RoofShape(shape);
                    f.orientation = turn % 2 ? RidgeOrientation::across : RidgeOrientation::along;
                    f.direction = turn * 1.5708;
                    f.height = flat ? middle : ridge;
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
                    if (difference / double(counted) < best)
                        best = difference / double(counted), bestShape = std::to_string(shape);
                }
            REQUIRE(std::isfinite(best));
            sum += best * double(samples.size()), area += double(samples.size());
            shapes += " " + bestShape;
        }
        if (!(area > 0)) continue;
        means.push_back(sum / area);
        MESSAGE(id << ": mean height difference " << means.back() << " m, shapes" << shapes);
    }
    std::sort(means.begin(), means.end());
    REQUIRE(means.size() == 16);
    MESSAGE("median over the houses: " << means[means.size() / 2] << " m");
    CHECK(means[means.size() / 2] <= 0.5);
}
