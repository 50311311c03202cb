// What a model on its own looks like at first sight: it stands on a studio's floor, or a meadow if one is asked for;
// all of it is seen, wherever its origin lies; its plants stand in the ground.
#include <doctest/doctest.h>

#include <algorithm>
#include <optional>

#include "tests/support/data.hpp"
#include "tests/tools/program.hpp"
#include "tools/scene/picture.hpp"

using namespace espalier::scene;

namespace {

constexpr const char* kRed = "newmtl red\nKd 0.8 0.05 0.03\nnewmtl grey\nKd 0.7 0.7 0.7\n";

// A box between two corners, and what of its sides is red or grey. Open boxes have no lid.
std::string box(const std::string& low, const std::string& high, bool lid) {
    std::istringstream lows(low), highs(high);
    double a[3], b[3];
    for (int i = 0; i < 3; ++i) lows >> a[i], highs >> b[i];
    std::ostringstream out;
    out << "mtllib red.mtl\n";
    for (int i = 0; i < 8; ++i)
        out << "v " << (i & 1 ? b[0] : a[0]) << ' ' << (i & 4 ? b[1] : a[1]) << ' ' << (i & 2 ? b[2] : a[2]) << '\n';
    out << "usemtl red\n" << (lid ? "f 5 7 8 6\nf 1 2 4 3\n" : "f 1 3 4 2\n");
    out << "usemtl grey\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
    return out.str();
}

class Views {
  public:
    Views() { folder_.write("red.mtl", kRed); }

    // The default view of a model that is baked first; `more`: options of espalier-capture.
    ColourPicture of(const std::string& model, const std::string& name, const std::string& more = "") {
        const std::string surface = folder_.file((name + ".surface.glb").c_str());
        const Ran baked = run(program("espalier-bake") + " -q --resolution 256 " + model + " -o " + surface);
        REQUIRE_MESSAGE(baked.code == 0, baked.output);
        return shown(surface, name, more);
    }
    ColourPicture shown(const std::string& scene, const std::string& name, const std::string& more) {
        const Ran ran = run(program("espalier-capture") + " " + scene + " --size 320x180 --max-nodes 40 -o " +
                            folder_.file(name.c_str()) + more);
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
        ColourPicture picture;
        std::string error;
        REQUIRE_MESSAGE(readColour(folder_.file((name + "/frame_0000.png").c_str()), picture, error), error);
        return picture;
    }
    // A scene that shows the surface high above a meadow.
    std::string alone(const std::string& surface) {
        return write("alone.json", R"({"surface": ")" + surface + R"(", "grammars": [{"file": ")" +
                                       content("grammars/ivy_free.grammar") + R"("}], "ground": {"level": -300}})");
    }
    std::string write(const char* name, const std::string& text) { return folder_.write(name, text); }

  private:
    Folder folder_;
};

template <class Test>
double share(const ColourPicture& picture, const Test& test) {
    size_t count = 0;
    const size_t all = picture.rgba.size() / 4;
    for (size_t i = 0; i < all; ++i)
        count += test(picture.rgba[4 * i], picture.rgba[4 * i + 1], picture.rgba[4 * i + 2]);
    return double(count) / double(all);
}
bool red(int r, int g, int b) {
    return r > 90 && 2 * r > 3 * g && 2 * r > 3 * b;
}
bool pale(int r, int g, int b) {
    return g > 150 && std::abs(r - g) < 30 && b > g - 40;
}
std::optional<std::string> report(const std::string& name) {
    return espalier::test::dataFile("reports/" + name);
}

}  // namespace

TEST_CASE("a court's paving is seen, at the lowest level of the model") {
    Views views;
    const std::string court = views.write("court.obj", box("-5 0 -5", "5 2 5", false));
    CHECK(share(views.of(court, "court"), red) > .05);
    if (const auto path = report("obj_court/court.obj")) CHECK(share(views.of(*path, "reported"), red) > .05);
}

TEST_CASE("a flat model lies above the meadow, and no grass stands on its floor") {
    Views views;
    // So thin that the meadow used to grow over it; the same high above it shows what is to be seen.
    const std::string sheet = "mtllib red.mtl\nusemtl red\nv -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nf 4 3 2 1\n";
    for (const std::string& model :
         {box("-2 0 -2", "2 0.04 2", true), box("-0.2 0 -0.2", "0.2 0.004 0.2", true), sheet}) {
        INFO(model);
        const double onMeadow = share(views.of(views.write("flat.obj", model), "flat", " --ground meadow"), red);
        const std::string scene = views.alone("flat.surface.glb");
        const double alone = share(views.shown(scene, "alone", ""), red);
        CHECK(onMeadow > .05);
        CHECK(onMeadow > .97 * alone);
    }
    if (const auto path = report("lego_flat.ply")) CHECK(share(views.of(*path, "lego"), pale) > .05);
    if (const auto path = report("meadow_through_floor_Bridge.glb")) {
        const ColourPicture bridge = views.of(*path, "bridge");
        const std::string scene = views.alone("bridge.surface.glb");
        CHECK(share(bridge, pale) > .03);
        // Its deck lies low in the picture, where no sky is pale.
        const auto lower = [](ColourPicture picture) {
            picture.rgba.erase(picture.rgba.begin(), picture.rgba.begin() + long(picture.rgba.size() * 2 / 3));
            return share(picture, pale);
        };
        CHECK(lower(bridge) > .9 * lower(views.shown(scene, "bridge_alone", "")));
    }
}

TEST_CASE("a model stands on a neutral floor unless it is to stand on a meadow") {
    Views views;
    const auto green = [](int r, int g, int b) { return g > 20 + b && 10 * g > 9 * r; };
    const std::string model = views.write("box.obj", box("-1 0 -1", "1 2 1", true));
    CHECK(share(views.of(model, "box"), green) < .02);
    CHECK(share(views.of(model, "box", " --ground meadow"), green) > .3);
}

TEST_CASE("few plants stand around a slim model") {
    Views views;
    const auto seeds = [&](const std::string& high) {
        const std::string model = views.write("tower.obj", box("-1 0 -1", "1 " + high + " 1", true));
        const std::string stats = views.write("stats.json", "");
        views.of(model, "tower", " --stats " + stats);
        const std::string text = readAll(stats), key = "\"seeds\":";
        const size_t at = text.find(key);
        REQUIRE(at != std::string::npos);
        return std::atoi(text.c_str() + at + key.size());
    };
    CHECK(seeds("2") == 16);
    CHECK(seeds("6") == 6);
    CHECK(seeds("40") == 3);
}

TEST_CASE("the eye stands to a model as to the same one elsewhere") {
    Views views;
    const std::string depth = " --view depth";
    const ColourPicture here = views.of(views.write("a.obj", box("0 0 -9", "10 3 0", true)), "a", depth);
    for (const char* where : {"0 0 -1009|10 3 -1000", "1000 0 991|1010 3 1000", "0 100 -9|10 103 0"}) {
        INFO(where);
        const std::string corners = where;
        const size_t bar = corners.find('|');
        const std::string model = views.write("b.obj", box(corners.substr(0, bar), corners.substr(bar + 1), true));
        const ColourPicture there = views.of(model, "b", depth);
        size_t other = 0;
        for (size_t i = 0; i < here.rgba.size(); ++i) other += std::abs(here.rgba[i] - there.rgba[i]) > 8;
        CHECK(other < here.rgba.size() / 200);
    }
    if (const auto local = report("obj_house_local.obj")) {
        const ColourPicture first = views.of(*local, "local", depth);
        const ColourPicture second = views.of(*report("obj_house_z1km.obj"), "z1km", depth);
        size_t other = 0;
        for (size_t i = 0; i < first.rgba.size(); ++i) other += std::abs(first.rgba[i] - second.rgba[i]) > 8;
        CHECK(other < first.rgba.size() / 200);
    }
}
