#include "tests/roof/structure_cases.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "tests/support/data.hpp"

namespace espalier::test {

std::vector<Footprint> casesOf(const std::string& file) {
    std::vector<Footprint> cases;
    std::optional<std::string> path = dataFile("footprints/" + file);
    if (!path) return cases;
    Result<std::string> text = readTextFile(*path);
    if (!text) return cases;
    nlohmann::json json = nlohmann::json::parse(*text);
    for (const auto& entry : json.contains("cases") ? json["cases"] : json["buildings"]) {
        Footprint f;
        f.id = entry["id"].get<std::string>();
        auto add = [&](const nlohmann::json& ring) {
            f.rings.emplace_back();
            for (const auto& p : ring) f.rings.back().push_back({p[0].get<double>(), p[1].get<double>()});
        };
        add(entry["outer"]);
        if (entry.contains("holes"))
            for (const auto& hole : entry["holes"]) add(hole);
        cases.push_back(std::move(f));
    }
    return cases;
}

Footprint outline(std::string id, std::vector<Ring> rings) {
    Footprint f;
    f.id = std::move(id);
    f.rings = std::move(rings);
    return f;
}

std::vector<Footprint> letters() {
    return {
        outline("rectangle", {{{0, 0}, {12, 0}, {12, 8}, {0, 8}}}),
        outline("square", {{{0, 0}, {9, 0}, {9, 9}, {0, 9}}}),
        outline("L", {{{0, 0}, {12, 0}, {12, 6}, {5, 6}, {5, 14}, {0, 14}}}),
        outline("L of equal wings", {{{0, 0}, {12, 0}, {12, 6}, {6, 6}, {6, 12}, {0, 12}}}),
        outline("T", {{{0, 0}, {16, 0}, {16, 6}, {11, 6}, {11, 14}, {5, 14}, {5, 6}, {0, 6}}}),
        outline("U", {{{0, 0}, {18, 0}, {18, 14}, {12, 14}, {12, 6}, {6, 6}, {6, 14}, {0, 14}}}),
        outline("H", {{{0, 0},
                       {5, 0},
                       {5, 6},
                       {11, 6},
                       {11, 0},
                       {16, 0},
                       {16, 18},
                       {11, 18},
                       {11, 11},
                       {5, 11},
                       {5, 18},
                       {0, 18}}}),
        outline("plus", {{{5, 0},
                          {10, 0},
                          {10, 5},
                          {15, 5},
                          {15, 10},
                          {10, 10},
                          {10, 15},
                          {5, 15},
                          {5, 10},
                          {0, 10},
                          {0, 5},
                          {5, 5}}}),
        outline("Z", {{{0, 0}, {10, 0}, {10, 6}, {18, 6}, {18, 12}, {7, 12}, {7, 5}, {0, 5}}}),
        outline("courtyard", {{{0, 0}, {20, 0}, {20, 16}, {0, 16}}, {{6, 6}, {6, 10}, {14, 10}, {14, 6}}}),
        outline("two courtyards", {{{0, 0}, {30, 0}, {30, 16}, {0, 16}},
                                   {{5, 5}, {5, 11}, {12, 11}, {12, 5}},
                                   {{17, 5}, {17, 10}, {25, 11}, {24, 4}}}),
        outline("courtyard in an L",
                {{{0, 0}, {24, 0}, {24, 12}, {14, 12}, {14, 24}, {0, 24}}, {{4, 4}, {4, 9}, {9, 9}, {9, 4}}}),
        outline("octagon", {{{3, 0}, {7, 0}, {10, 3}, {10, 7}, {7, 10}, {3, 10}, {0, 7}, {0, 3}}}),
        outline("bay window", {{{0, 0}, {4, 0}, {5, -1.5}, {7, -1.5}, {8, 0}, {12, 0}, {12, 8}, {0, 8}}}),
        outline("crooked", {{{0, 0}, {11, 1}, {13, 7}, {6, 6}, {5, 13}, {-1, 11}}}),
    };
}

Ring turned(const Ring& ring, double angle) {
    Ring out;
    for (glm::dvec2 p : ring)
        out.push_back({p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle)});
    return out;
}

}  // namespace espalier::test
