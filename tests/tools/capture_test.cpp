// What the capture tool and the window show of the sample scene: the same on every run, as the stored picture, and
// without a message of the validation layer.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/golden.hpp"
#include "tools/scene/picture.hpp"

namespace {

nlohmann::json statsOf(const std::string& path) {
    return nlohmann::json::parse(readAll(path));
}

std::string frame(const Folder& folder, const char* out) {
    return folder.file(out) + "/frame_0000.png";
}

}  // namespace

TEST_CASE("the sample scene is drawn as the golden shows, in every run, whatever the threads, by shaders too") {
    const Folder folder;
    const std::string capture = program("espalier-capture") + " " + content("sample.json") + " --size 640x360";
    const Ran first =
        run("env ESPALIER_VALIDATION=1 " + capture + " -o " + folder.file("a") + " --stats " + folder.file("a.json"));
    REQUIRE_MESSAGE(first.code == 0, first.output);
    const Ran second =
        run("env LP_NUM_THREADS=1 " + capture + " -o " + folder.file("b") + " --stats " + folder.file("b.json"));
    REQUIRE_MESSAGE(second.code == 0, second.output);
    const Ran third = run(capture + " --shaders -o " + folder.file("c"));
    REQUIRE_MESSAGE(third.code == 0, third.output);
    CHECK(readAll(frame(folder, "a")) == readAll(frame(folder, "b")));
    CHECK(readAll(frame(folder, "a")) == readAll(frame(folder, "c")));

    const nlohmann::json a = statsOf(folder.file("a.json")), b = statsOf(folder.file("b.json"));
    for (const char* key : {"seeds", "nodes", "branches", "leaves", "polygons", "hash"}) CHECK(a.at(key) == b.at(key));
    CHECK(a.at("validation_messages") == 0);
    CHECK(a.at("overflow") == 0);
    CHECK(a.at("seeds") >= 10);
    CHECK(a.at("nodes") > 10000);
    CHECK(a.at("leaves") > 10000);
    CHECK(a.at("hash").get<std::string>().size() == 16);
    for (const char* key : {"expand", "emit", "draw"}) CHECK(a.at("ms").at(key) > 0);
    CHECK(a.at("bytes").at("total") > 1000000);

    checkGolden("sample_640x360", frame(folder, "a"));
}

TEST_CASE("patterns are drawn as the golden shows") {
    const Folder folder;
    const Ran drawn = run("env ESPALIER_VALIDATION=1 " + program("espalier-capture") + " " + content("patterns.json") +
                          " --size 640x360 -o " + folder.file("a") + " --stats " + folder.file("a.json"));
    REQUIRE_MESSAGE(drawn.code == 0, drawn.output);
    const nlohmann::json a = statsOf(folder.file("a.json"));
    CHECK(a.at("validation_messages") == 0);
    CHECK(a.at("patterns").at("pieces") > 3000);
    checkGolden("patterns_640x360", frame(folder, "a"));
}

// A path wiped free, autumn painted over the arch, a longer parameter, a seed more, one less and again, evening, a
// roof.
TEST_CASE("a run of edits leads to what the goldens show") {
    const Folder folder;
    const Ran ran = run(program("espalier-capture") + " " + content("sample.json") +
                        " --replay tests/goldens/painting.jsonl --every 5 -o " + folder.file("run"));
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    checkGolden("painting_5", folder.file("run") + "/frame_0005.png");
    checkGolden("painting_7", folder.file("run") + "/frame_0007.png");
}

TEST_CASE("a large picture, in which leaves lie at one depth, is the same in every run, whatever the threads") {
    const Folder folder;
    const std::string capture = program("espalier-capture") + " " + content("sample.json") + " --size 1280x720 -o ";
    REQUIRE(run("env LP_NUM_THREADS=1 " + capture + folder.file("a")).code == 0);
    REQUIRE(run(capture + folder.file("b")).code == 0);
    CHECK(readAll(frame(folder, "a")) == readAll(frame(folder, "b")));
}

TEST_CASE("a smooth frame is as bright as a plain one, has softer edges, and is the same in every run") {
    const Folder folder;
    const std::string capture =
        program("espalier-capture") + " " + content("guided.json") + " --size 160x90 -o " + folder.file("");
    REQUIRE(run(capture + "plain").code == 0);
    REQUIRE(run(capture + "smooth --smooth 8").code == 0);
    REQUIRE(run(capture + "again --smooth 8").code == 0);
    CHECK(readAll(frame(folder, "smooth")) == readAll(frame(folder, "again")));
    struct Look {
        double brightness = 0, steps = 0;
    };
    const auto lookOf = [&](const char* out) {
        espalier::scene::ColourPicture picture;
        std::string error;
        REQUIRE_MESSAGE(readColour(frame(folder, out), picture, error), error);
        Look look;
        for (size_t i = 4; i < picture.rgba.size(); ++i) {
            look.brightness += picture.rgba[i];
            look.steps += std::abs(int(picture.rgba[i]) - int(picture.rgba[i - 4]));
        }
        return look;
    };
    const Look plain = lookOf("plain"), smooth = lookOf("smooth");
    CHECK(smooth.brightness == doctest::Approx(plain.brightness).epsilon(0.01));
    CHECK(smooth.steps < 0.95 * plain.steps);
    CHECK(run(capture + "plain --smooth 8 --moving").code == 2);
    CHECK(run(capture + "plain --smooth 0").code == 2);
}

TEST_CASE("another seed grows another plant, more of them grow more, and a mask that is black grows none") {
    const Folder folder;
    const std::string capture = program("espalier-capture") + " " + content("ruin.surface.glb") + " --size 64x36 -o " +
                                folder.file("out") + " --stats ";
    REQUIRE(run(capture + folder.file("a.json") + " --seed 1").code == 0);
    REQUIRE(run(capture + folder.file("b.json") + " --seed 2").code == 0);
    REQUIRE(run(capture + folder.file("c.json") + " --seed 1").code == 0);
    const nlohmann::json a = statsOf(folder.file("a.json")), b = statsOf(folder.file("b.json"));
    CHECK(a.at("hash") != b.at("hash"));
    CHECK(a.at("hash") == statsOf(folder.file("c.json")).at("hash"));
    CHECK(a.at("nodes") > 1000);
    REQUIRE(run(capture + folder.file("f.json") + " --seed 1 --times 3").code == 0);
    const nlohmann::json f = statsOf(folder.file("f.json"));
    CHECK(f.at("seeds") == 3 * a.at("seeds").get<int>());
    CHECK(f.at("nodes") > 2 * a.at("nodes").get<int>());
    if (run("convert -size 64x64 xc:black " + folder.file("black.png") + " && convert -size 64x64 xc:white " +
            folder.file("white.png"))
            .code != 0)
        return;
    REQUIRE(run(capture + folder.file("d.json") + " --layer mask=" + folder.file("black.png")).code == 0);
    REQUIRE(run(capture + folder.file("e.json") + " --layer mask=" + folder.file("white.png")).code == 0);
    CHECK(statsOf(folder.file("d.json")).at("leaves") == 0);
    CHECK(statsOf(folder.file("e.json")).at("leaves") > 1000);
}

TEST_CASE("frames go around the target and keep their names") {
    const Folder folder;
    const Ran ran = run(program("espalier-capture") + " " + content("sample.json") + " --size 64x36 --frames 3 -o " +
                        folder.file("out") + " --max-nodes 5000");
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    CHECK(folder.count() == 3);
    CHECK(std::filesystem::exists(folder.file("out") + "/frame_0002.png"));
    CHECK(readAll(folder.file("out") + "/frame_0000.png") != readAll(folder.file("out") + "/frame_0001.png"));
}

TEST_CASE("the window draws its frames without a word from the validation layer") {
    if (run("command -v xvfb-run").code != 0) {
        MESSAGE("xvfb-run isn't installed; skipped");
        return;
    }
    const Folder folder;
    const Ran ran = runOnDisplay("800x600", program("espalier-sample") + " " + content("sample.json") +
                                                " --validation --frames 4 --size 640x400 --screenshot " +
                                                folder.file("window.png"));
    CHECK_MESSAGE(ran.code == 0, ran.output);
    CHECK(!contains(ran.output, "validation"));
    CHECK(std::filesystem::file_size(folder.file("window.png")) > 20000);
    const Ran without = run("env -u DISPLAY -u WAYLAND_DISPLAY " + program("espalier-sample"));
    CHECK(without.code > 0);
    CHECK(contains(without.output, "display"));
}
