// What the editor remembers of how a user has it, and what becomes of a file of it that can't be read.
#include <cstdlib>
#include <tuple>

#include "sample_game/settings.hpp"
#include "tests/editor/editing.hpp"

using namespace sample;

namespace {

// The user's settings in a folder of the test's own, for as long as it lives.
struct Home {
    Folder folder;
    std::string before;
    bool had;
    Home() : had(std::getenv("XDG_CONFIG_HOME")) {
        if (had) before = std::getenv("XDG_CONFIG_HOME");
        setenv("XDG_CONFIG_HOME", folder.path.c_str(), 1);
        std::filesystem::create_directories(folder.path / "espalier");
    }
    ~Home() { had ? setenv("XDG_CONFIG_HOME", before.c_str(), 1) : unsetenv("XDG_CONFIG_HOME"); }
    std::string layout() const { return folder.file("espalier/layout.json"); }
};

// All that is remembered of a layout. A new field doesn't compile here until it is said whether it is.
auto remembered(const Layout& of) {
    const auto& [panel, figures, grammar, atlas, help, panelWidth, windowWidth, windowHeight, maximised, sizeOfAll,
                 layerOpacity, smallerWhileMoving, rowStep, rowAlong, recent] = of;
    (void)help;  // it is closed at the beginning
    return std::tuple(panel, figures, grammar, atlas, panelWidth, windowWidth, windowHeight, maximised, sizeOfAll,
                      layerOpacity, smallerWhileMoving, rowStep, rowAlong, recent);
}

// Of a brush what it is like, not what it goes over.
auto remembered(const Brush& of) {
    const auto& [layer, mode, radius, townRadius, strength, hardness, value, colour, spacing, limited, slope, height,
                 softness, frontOnly] = of;
    (void)layer, (void)mode, (void)value, (void)limited, (void)slope, (void)height, (void)softness, (void)frontOnly;
    return std::tuple(radius, townRadius, strength, hardness, spacing);
}

template <class Fields>
bool differEverywhere(const Fields& a, const Fields& b) {
    const auto differ = [&](const auto&... x) {
        return std::apply([&](const auto&... y) { return ((x != y) && ...); }, b);
    };
    return std::apply(differ, a);
}

// Every field another than at the beginning.
Layout unlikeLayout() {
    return {.panel = false,
            .figures = true,
            .grammar = true,
            .atlas = true,
            .panelWidth = 410,
            .windowWidth = 1001,
            .windowHeight = 703,
            .maximised = true,
            .sizeOfAll = 1.5f,
            .layerOpacity = .25f,
            .smallerWhileMoving = false,
            .rowStep = .5f,
            .rowAlong = true,
            .recent = {"/gardens/wall"}};
}

Brush unlikeBrush() {
    Brush brush;
    brush.radius = .125f;
    brush.townRadius = 7;
    brush.strength = .75f;
    brush.hardness = .25f;
    brush.spacing = .5f;
    return brush;
}

}  // namespace

TEST_CASE("all of a layout that is remembered comes back, and the brush, but for what it goes over") {
    const Home home;
    const Layout wanted = unlikeLayout();
    const Brush liked = unlikeBrush();
    REQUIRE(differEverywhere(remembered(wanted), remembered(Layout{})));
    REQUIRE(differEverywhere(remembered(liked), remembered(Brush{})));
    writeLayout(wanted, liked);
    Layout layout;
    Brush brush;
    brush.layer = "mask";
    std::string error;
    readLayout(layout, brush, error);
    CHECK_MESSAGE(error.empty(), error);
    CHECK(remembered(layout) == remembered(wanted));
    CHECK(remembered(brush) == remembered(liked));
    CHECK(brush.layer == "mask");
    CHECK(!layout.help);
}

TEST_CASE("a layout that isn't there leaves everything as it is, and no word is said of it") {
    const Home home;
    Layout layout = unlikeLayout();
    Brush brush = unlikeBrush();
    std::string error;
    readLayout(layout, brush, error);
    CHECK(error.empty());
    CHECK(remembered(layout) == remembered(unlikeLayout()));
    CHECK(remembered(brush) == remembered(unlikeBrush()));
}

TEST_CASE("what a layout says beyond what can be used is brought back to that") {
    const Home home;
    for (const float far : {-1e9f, 1e9f}) {
        CAPTURE(far);
        Layout layout = unlikeLayout();
        Brush brush = unlikeBrush();
        for (float* value : {&layout.panelWidth, &layout.sizeOfAll, &layout.layerOpacity, &layout.rowStep,
                             &brush.radius, &brush.townRadius, &brush.strength, &brush.hardness, &brush.spacing})
            *value = far;
        layout.windowWidth = layout.windowHeight = far < 0 ? -5 : 1 << 30;
        writeLayout(layout, brush);
        std::string error;
        readLayout(layout, brush, error);
        CHECK_MESSAGE(error.empty(), error);
        CHECK(layout.panelWidth == (far < 0 ? kLeastPanel : kMostPanel));
        CHECK(layout.rowStep == (far < 0 ? kLeastRowStep : kMostRowStep));
        for (const float value :
             {layout.sizeOfAll, layout.layerOpacity, brush.radius, brush.townRadius, brush.strength, brush.spacing}) {
            CHECK(value > 0);
            CHECK(value < 100);
        }
        CHECK(brush.hardness == (far < 0 ? 0 : 1));
        for (const int side : {layout.windowWidth, layout.windowHeight}) {
            CHECK(side >= 0);
            CHECK(side < 1 << 20);
        }
    }
}

TEST_CASE("a layout of another version is read as far as both know it") {
    const Home home;
    home.folder.write("espalier/layout.json", R"({"panel_width": 420, "of_a_newer_version": [1, {"a": 2}]})");
    Layout layout = unlikeLayout(), expected = layout;
    Brush brush;
    const float radius = brush.radius;
    std::string error;
    readLayout(layout, brush, error);
    CHECK(error == "");
    expected.panelWidth = 420;
    CHECK(remembered(layout) == remembered(expected));
    CHECK(brush.radius == radius);
    CHECK(!std::filesystem::exists(home.layout() + ".damaged"));
}

TEST_CASE("a damaged layout is told with its place and kept beside the next one") {
    const Home home;
    for (const char* text : {"{\"panel\": true,", "{\"panel\": 3}", "[]", ""}) {
        CAPTURE(text);
        home.folder.write("espalier/layout.json", text);
        Layout layout = unlikeLayout();
        Brush brush = unlikeBrush();
        std::string error;
        readLayout(layout, brush, error);
        CHECK_MESSAGE(contains(error, home.layout() + ":"), error);
        CHECK_MESSAGE(contains(error, "layout.json.damaged"), error);
        CHECK(remembered(layout) == remembered(unlikeLayout()));
        CHECK(remembered(brush) == remembered(unlikeBrush()));
        writeLayout(layout, brush);
        CHECK(readAll(home.layout() + ".damaged") == text);
        readLayout(layout, brush, error);
        CHECK_MESSAGE(error.empty(), error);
    }
}
