// What becomes of one house's roof when its kind, a pitch, an edge or its walls change: judged by its heights.
#include <cmath>

#include "tests/editor/editing.hpp"
#include "tests/editor/over_town.hpp"
#include "tests/editor/user.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;
using espalier::scene::House;
using espalier::scene::houseNow;

namespace {

// One house of 10 x 8 metres; tags: more of its plan.
struct Planned : Editing {
    Planned(const Folder& folder, const std::string& tags)
        : Editing(folder.write(
              "plan.json", R"({"buildings": [{"id": "one", "outer": [[0,0],[10,0],[10,8],[0,8]], )" + tags + "}]}")) {}
    House house() const { return houseNow(context.get(), 0); }
    EspHouseInfo info() const {
        EspHouseInfo found;
        REQUIRE(espHouseInfo(context.get(), 0, &found) == ESP_OK);
        return found;
    }
    float roof() const { return info().ridgeHeight - info().eaveHeight; }
    template <class Change>
    void change(Change&& what) {
        House house = this->house();
        what(house);
        REQUIRE_MESSAGE(perform(SetHouse{house}), error);
    }
};

constexpr float kUsual = .7f;  // tangent of a gabled roof's pitch
const char* const kByHeight = R"("roof:shape": "gabled", "roof:height": 1.5, "height": 5, "building:levels": 1)";
const char* const kByLevels = R"("roof:shape": "gabled", "roof:levels": 0.5, "building:levels": 2)";
const char* const kByWhole = R"("roof:shape": "gabled", "height": 7.5, "building:levels": 2)";

}  // namespace

TEST_CASE("a roof whose height its plan gives keeps it while outline, walls and gables change") {
    const Folder folder;
    for (const char* plan : {kByHeight, kByLevels, kByWhole}) {
        CAPTURE(plan);
        Planned built(folder, plan);
        CHECK(built.roof() == doctest::Approx(1.5));
        built.change([](House& h) { h.corners[0][0] -= .1f; });
        CHECK(built.roof() == doctest::Approx(1.5));
        built.change([](House& h) { h.eaveHeight = 4; });
        CHECK(built.roof() == doctest::Approx(1.5));
        CHECK(built.info().eaveHeight == doctest::Approx(4));
        built.change([](House& h) { h.edges = {{1, "eave", 0}}; });
        CHECK(built.roof() == doctest::Approx(1.5));
    }
}

TEST_CASE("a roof that its house's height alone keeps low stays so while outline, walls and gables change") {
    const Folder folder;
    const auto plan = [](const char* more) { return std::string(R"("roof:shape": "gabled", "height": 3)") + more; };
    for (const std::string& tags : {plan(""), plan(R"(, "roof:angle": 45)")}) {
        CAPTURE(tags);
        Planned built(folder, tags), pitch(folder, tags);
        CHECK(built.roof() == doctest::Approx(2));  // two thirds
        built.change([](House& h) { h.corners[0][0] -= .01f; });
        CHECK(built.roof() == doctest::Approx(2));
        CHECK(built.info().eaveHeight == doctest::Approx(1));
        built.change([](House& h) { h.eaveHeight = 4; });
        CHECK(built.roof() == doctest::Approx(2));
        built.change([](House& h) { h.edges = {{1, "eave", 0}}; });
        CHECK(built.roof() == doctest::Approx(2));
        pitch.change([](House& h) { h.slope = .6f; });
        CHECK(pitch.roof() == doctest::Approx(.6 * 4));
    }
    Planned kind(folder, plan(""));
    kind.change([](House& h) { h.shape = "hip"; });
    CHECK(kind.roof() == doctest::Approx(kUsual * 4));
}

TEST_CASE("who asks for another pitch or kind gets it, whatever height the plan gave the roof") {
    const Folder folder;
    for (const char* plan : {kByHeight, kByLevels, kByWhole}) {
        CAPTURE(plan);
        Planned pitch(folder, plan), kind(folder, plan), edge(folder, plan);
        pitch.change([](House& h) { h.slope = .5f; });
        CHECK(pitch.roof() == doctest::Approx(.5 * 4));
        kind.change([](House& h) { h.shape = "hip"; });
        CHECK(kind.roof() == doctest::Approx(kUsual * 4));
        kind.change([](House& h) { h.shape = "gable"; });  // as planned again
        CHECK(kind.roof() == doctest::Approx(1.5));
        // As steep as it says: both eaves meet over the middle.
        edge.change([](House& h) { h.edges = {{0, "", kUsual}, {2, "", kUsual}}; });
        CHECK(edge.roof() == doctest::Approx(kUsual * 4));
    }
}

TEST_CASE("a pitch that the plan gives stays, however high the plan says that the house is") {
    const Folder folder;
    Planned angle(folder, R"("roof:shape": "gabled", "roof:angle": 30, "height": 9, "building:levels": 2)"),
        whole(folder, R"("roof:shape": "gabled", "height": 12)");
    const float walls = angle.info().eaveHeight;
    for (Planned* built : {&angle, &whole}) {
        const float pitch = built->roof() / 4;
        built->change([](House& h) {
            h.corners[2][1] -= 1;  // 9 metres wide
            h.corners[3][1] -= 1;
        });
        CHECK(built->roof() == doctest::Approx(pitch * 4.5));
    }
    CHECK(angle.info().slope == doctest::Approx(std::tan(30 / 57.29578f)));
    CHECK(angle.info().eaveHeight == doctest::Approx(walls));
}

TEST_CASE("a roof keeps its planned height where an edge with a pitch of its own gets another number") {
    const Folder folder;
    Planned built(folder, std::string(kByHeight) + R"(, "edges": [{"edge": 2, "angle": 50}])");
    const float planned = built.roof();
    built.change([](House& h) {
        h.corners.insert(h.corners.begin() + 1, {5, .5f});
        h.rings[0] = 5;
        h.edges[0].edge += 1;
    });
    CHECK(built.roof() == doctest::Approx(planned));
}

TEST_CASE("a shed falls to the edge that is to be low, and says what it has no use for") {
    const Folder folder;
    Planned built(folder, R"("roof:shape": "skillion", "roof:direction": "S", "building:levels": 1)");
    const float slope = built.roof() / 8;
    for (const uint32_t edge : {0u, 1u, 2u, 3u}) {
        built.change([&](House& h) { h.edges = {{edge, "eave", 0}}; });
        CHECK(built.roof() == doctest::Approx(slope * (edge % 2 ? 10 : 8)));
        CHECK(std::string(built.info().note).empty());
    }
    built.change([](House& h) { h.edges = {{1, "gable", 0}}; });
    CHECK(built.roof() == doctest::Approx(slope * 8));
    CHECK(std::string(built.info().note).find("a shed has neither") != std::string::npos);
    built.change([](House& h) { h.shape = "flat"; });
    CHECK(std::string(built.info().note).find("a flat roof has neither") != std::string::npos);
}

TEST_CASE("a shed falls towards a notch that is to be low: as low as what lies before it") {
    const Folder folder;
    // An L whose edge 3 looks south, as edge 0 does, three metres behind it; world z is south.
    Editing editing(
        folder.write("plan.json", R"({"buildings": [{"id": "one", "roof:shape": "skillion", "building:levels": 1,
 "outer": [[0,0],[6,0],[6,3],[10,3],[10,8],[0,8]]}]})"));
    House house = houseNow(editing.context.get(), 0);
    REQUIRE(house.corners.size() == 6);
    uint32_t notch = 6;
    for (uint32_t i = 0; i < 6; ++i)
        if (house.corners[i][1] == -3 && house.corners[(i + 1) % 6][1] == -3) notch = i;
    REQUIRE(notch < 6);
    house.edges = {{notch, "eave", 0}};
    REQUIRE_MESSAGE(editing.perform(SetHouse{house}), editing.error);
    EspHouseInfo info;
    REQUIRE(espHouseInfo(editing.context.get(), 0, &info) == ESP_OK);
    CHECK(std::string(info.note) == "");
    CHECK(info.ridgeHeight - info.eaveHeight == doctest::Approx(.268 * 8));
}

TEST_CASE("the slider of a high house's walls goes where it is dragged and stays there") {
    const Folder folder;
    OverTown<User> builder(folder, content("town.json"));
    builder.panel = [&] { sample::housesPanel(builder.work); };
    const uint32_t index = builder.named("gambrel");
    const auto walls = [&] { return houseNow(builder.work.context.get(), index).eaveHeight; };
    House high = houseNow(builder.work.context.get(), index);
    high.eaveHeight = 30;
    REQUIRE(builder.work.perform(SetHouse{high}));
    builder.work.house = index;
    const glm::vec2 at = builder.placeOf({int(index), "Walls", "##value"});
    builder.hold(at);
    builder.rest();
    builder.point({.8f * builder.work.panelUnits(), at.y});
    builder.rest();
    const float dragged = walls();
    CHECK(dragged > 20);
    builder.rest(12);
    CHECK(walls() == dragged);
    builder.point({builder.work.panelUnits(), at.y});
    builder.rest();
    CHECK(walls() > 50);
    builder.letGo();
    builder.rest();
    CHECK(builder.work.document->undoSteps() == 2);
}

TEST_CASE("a corner is dragged although others of its house are behind the camera") {
    const Folder folder;
    OverTown<Editor> builder(folder, content("town.json"));
    const uint32_t index = builder.named("gambrel");
    const House before = houseNow(builder.work.context.get(), index);
    const EspHouseInfo info = builder.info(index);
    const auto eave = [&](size_t i) { return glm::vec3(before.corners[i][0], info.eaveHeight, before.corners[i][1]); };
    const glm::vec3 near = eave(0), far = eave(2), over(0, 2, 0);
    EspCamera camera = builder.work.camera.camera();
    const glm::vec3 eye = glm::mix(near, far, .3f) + over, to = far;
    std::copy(&eye.x, &eye.x + 3, camera.eye);
    std::copy(&to.x, &to.x + 3, camera.target);
    builder.work.camera.set(camera, 10);
    REQUIRE(!builder.work.place(near));
    REQUIRE(builder.work.place(far));
    builder.work.house = index;
    const glm::vec2 from = *builder.work.place(far);
    builder.drag(from, from + glm::vec2(12, 6));
    const House after = houseNow(builder.work.context.get(), index);
    CHECK(after.corners[2] != before.corners[2]);
    CHECK(after.corners[0] == before.corners[0]);
}

TEST_CASE(
    "what is taken back, and what is opened again, is the house that stood, whatever its plan or scene leaves out") {
    const Folder folder;
    const auto heights = [](const EspContext* context) {
        EspHouseInfo info;
        REQUIRE(espHouseInfo(context, 0, &info) == ESP_OK);
        return std::pair(info.eaveHeight, info.ridgeHeight);
    };
    for (const char* plan : {kByHeight, kByLevels, kByWhole}) {
        CAPTURE(plan);
        Planned built(folder, plan);
        const auto state = [&](const Editing& editing) {
            return std::pair(heights(editing.context.get()), houseNow(editing.context.get(), 0));
        };
        std::vector<decltype(state(built))> seen{state(built)};
        const auto step = [&](const auto& what) {
            built.change(what);
            seen.push_back(state(built));
        };
        step([](House& h) { h.look->covering = "slate"; });
        step([](House& h) { h.corners[0][0] -= 3; });
        step([](House& h) { h.shape = "hip"; });
        step([](House& h) { h.shape = "gable"; });
        step([](House& h) { h.edges = {{1, "eave", 0}}; });
        step([](House& h) { h.eaveHeight += 1; });
        step([](House& h) { h.slope = .4f; });
        step([](House& h) { h.slope = 0; });
        step([](House& h) { h = {.index = 0, .shape = "hip"}; });  // as a scene's file may have it
        step([](House& h) { h.corners[2][1] -= 2; });
        const std::string project = folder.file("project");
        REQUIRE_MESSAGE(saveProject(*built.document, project, built.error), built.error);
        CHECK(state(Editing(project)) == seen.back());
        for (size_t i = seen.size() - 1; i-- > 0;) {
            CAPTURE(i);
            REQUIRE(built.perform(Undo{}));
            CHECK(state(built) == seen[i]);
        }
        for (size_t i = 1; i < seen.size(); ++i) {
            REQUIRE(built.perform(Redo{}));
            CHECK(state(built) == seen[i]);
        }
    }
}
