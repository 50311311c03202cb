// Which houses of a town an overview shows.
#include "runtime/plugin/dense_part.hpp"

#include <algorithm>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/town_host.hpp"

using namespace espalier;

namespace {

PlanBox house(float x, float z) {
    return {{x, z}, {x + 10, z + 8}};
}

// Rows of houses with streets between them.
std::vector<PlanBox> village(float x, float z, int across, int deep) {
    std::vector<PlanBox> houses;
    for (int i = 0; i < across; ++i)
        for (int k = 0; k < deep; ++k) houses.push_back(house(x + 20 * float(i), z + 25 * float(k)));
    return houses;
}

std::string townText(const std::vector<PlanBox>& houses) {
    std::string text = "{\"buildings\": [";
    for (const PlanBox& h : houses) {
        const auto at = [](float x, float z) { return "[" + std::to_string(x) + "," + std::to_string(-z) + "]"; };
        text += (text.back() == '[' ? "{\"outer\": [" : ", {\"outer\": [") + at(h.low.x, h.low.y) + "," +
                at(h.high.x, h.low.y) + "," + at(h.high.x, h.high.y) + "," + at(h.low.x, h.high.y) + "]}";
    }
    return text + "]}";
}

}  // namespace

TEST_CASE("a town without far-off houses is shown whole") {
    for (const auto& [across, deep] : {std::pair{1, 1}, {2, 1}, {5, 4}, {40, 30}}) {
        CAPTURE(across);
        CHECK(densePart(village(-300, 70, across, deep)).size() == size_t(across) * size_t(deep));
    }
    CHECK(densePart({}).empty());
}

TEST_CASE("farms far off are left out of a village's overview") {
    std::vector<PlanBox> houses = village(0, 0, 8, 6);
    const size_t near = houses.size();
    for (const PlanBox& farm : {house(4000, 100), house(-2500, -3000), house(300, 6000)}) houses.push_back(farm);
    const std::vector<size_t> dense = densePart(houses);
    CHECK(dense.size() == near);
    CHECK(std::ranges::all_of(dense, [&](size_t i) { return i < near; }));
}

TEST_CASE("of villages miles apart the largest is shown, of two across a river both") {
    std::vector<PlanBox> houses = village(0, 0, 10, 8);
    const std::vector<PlanBox> far = village(5000, 2000, 6, 5), across = village(320, 0, 10, 8);
    houses.insert(houses.end(), far.begin(), far.end());
    CHECK(densePart(houses).size() == 80);
    houses.insert(houses.end(), across.begin(), across.end());
    CHECK(densePart(houses).size() == 160);
}

TEST_CASE("one large hall isn't the densest part of a town") {
    std::vector<PlanBox> houses = village(0, 0, 10, 8);
    houses.push_back({{3000, 3000}, {3200, 3150}});
    CHECK(densePart(houses).size() == 80);
}

TEST_CASE("a camera that shows all isn't drawn away by farms") {
    const auto shown = [](const std::vector<PlanBox>& houses) {
        const Bare host;
        const EspGrammar roofs = compiled(host.context, "roofs", kDecaying);
        const std::string text = townText(houses);
        load(host.context, roofs, text.c_str());
        REQUIRE(espUpdate(host.context) == ESP_OK);
        return esp::frameAll(host.context);
    };
    std::vector<PlanBox> houses = village(0, 0, 5, 4);
    const EspCamera alone = shown(houses);
    houses.push_back(house(2600, 1800));
    const EspCamera among = shown(houses);
    for (int i = 0; i < 3; ++i) {
        CHECK(among.eye[i] == doctest::Approx(alone.eye[i]));
        CHECK(among.target[i] == doctest::Approx(alone.target[i]));
    }
}
