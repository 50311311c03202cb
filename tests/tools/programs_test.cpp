// The programs with what users get wrong: each ends with a message that names file and cause, a code that isn't 0,
// and nothing half-written.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <algorithm>

#include "tests/support/small_pictures.hpp"
#include "tests/tools/program.hpp"
#include "tools/scene/picture.hpp"

namespace {

// Fails as it should: not by a signal, with the message, which is given back, and leaving nothing behind.
std::string refuses(const std::string& command, const Folder& folder, std::initializer_list<const char*> parts) {
    const size_t before = folder.count();
    const Ran ran = run(command);
    CAPTURE(command);
    CAPTURE(ran.output);
    CHECK(ran.code > 0);
    for (const char* part : parts) CHECK_MESSAGE(contains(ran.output, part), part);
    CHECK(folder.count() == before);
    return ran.output;
}

const char* kScene = R"({
  "surface": "SURFACE",
  "grammars": [{"file": "GRAMMAR", "seeds": [{"position": [0, 1, 0.4]}]}]
})";

std::string sceneOf(std::string surface, std::string grammar) {
    std::string text = kScene;
    text.replace(text.find("SURFACE"), 7, surface);
    text.replace(text.find("GRAMMAR"), 7, grammar);
    return text;
}

}  // namespace

TEST_CASE("layers that no grammar of a scene reads are warned of, and aren't there to be exported") {
    const Folder folder;
    std::string scene = sceneOf(content("ruin.surface.glb"), content("grammars/ivy_free.grammar"));
    scene.replace(scene.rfind('}'), 1,
                  R"(, "layers": {"maks": "nosuch.png", "mask": "odd.exr"}, "filled": {"tnit": 0}})");
    std::string error;
    REQUIRE_MESSAGE(espalier::scene::writeGrey(folder.file("odd.exr"), {2, 2, {0, 1, 7, 1}}, error), error);
    folder.write("scene.json", scene);
    const std::string capture =
        program("espalier-capture") + " " + folder.file("scene.json") + " --size 64x36 -o " + folder.file("out");
    const Ran ran = run(capture);
    CHECK_MESSAGE(ran.code == 0, ran.output);
    for (const char* layer : {"'maks'", "'tnit'"}) CHECK_MESSAGE(contains(ran.output, layer), ran.output);
    CHECK_MESSAGE(contains(ran.output, "odd.exr: values limited to 0 to 1: 1"), ran.output);
    const Ran exported = run(capture + " --export maks=" + folder.file("maks.png"));
    CHECK(exported.code == 1);
    CHECK_MESSAGE(contains(exported.output, "has no layer 'maks'"), exported.output);
    CHECK(!std::filesystem::exists(folder.file("maks.png")));
    CHECK(run(capture + " --view nope").code == 2);
    folder.write("run.jsonl", R"({"espalier_run": 1, "scene": "scene.json", "width": 64, "height": 36, "step": 0.1}
{"frame": 0, "fill": {"layer": "msak", "value": 1}}
{"frame": 1, "fill": {"layer": "msak", "value": 0}}
{"frame": 1, "fill": {"layer": "mask", "value": 0}}
)");
    const Ran replayed = run(capture + " --replay " + folder.file("run.jsonl"));
    CHECK_MESSAGE(replayed.code == 0, replayed.output);
    CHECK_MESSAGE(contains(replayed.output, "run.jsonl:2: no grammar reads the layer 'msak'"), replayed.output);
    CHECK(!contains(replayed.output, "run.jsonl:3"));
    CHECK(!contains(replayed.output, "'mask'"));
    folder.write("text.jsonl", R"({"espalier_run": 1, "scene": "scene.json", "width": 64, "height": 36, "step": 0.1}
{"frame": 0, "text": {"grammar": 0, "text": "Ivy -> Marching(1,", "params": []}}
{"frame": 1, "undo": {}}
)");
    const Ran mistaken = run(capture + " --replay " + folder.file("text.jsonl"));
    CHECK_MESSAGE(mistaken.code == 0, mistaken.output);
    CHECK_MESSAGE(contains(mistaken.output, "text.jsonl:2: "), mistaken.output);
    CHECK_MESSAGE(contains(mistaken.output, "ivy_free.grammar:1:"), mistaken.output);
    CHECK_MESSAGE(!contains(mistaken.output, "text.jsonl:3: "), mistaken.output);
}

TEST_CASE("a picture that is to lie in UVs that a model hasn't got is told of") {
    const Folder folder;
    const std::string model = folder.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"),
                      surface = folder.file("bare.surface.glb");
    REQUIRE(run(program("espalier-bake") + " " + model + " -q --resolution 128 -o " + surface).code == 0);
    const auto laid = [&](const std::string& on) {
        return run(program("espalier-capture") + " " + on + " --size 64x36 -o " + folder.file("out") +
                   " --layer mask=" + content("mask.png"));
    };
    const Ran ran = laid(surface);
    CHECK_MESSAGE(ran.code == 0, ran.output);
    CHECK_MESSAGE(contains(ran.output, "layer 'mask': bare.obj has no UVs"), ran.output);
    CHECK(!contains(laid(content("ruin.surface.glb")).output, "has no UVs"));
}

TEST_CASE("a sun's intensity counts without a colour") {
    const Folder folder;
    const auto picture = [&](const char* name, const char* intensity) {
        std::string scene = sceneOf(content("ruin.surface.glb"), content("grammars/ivy_free.grammar"));
        scene.replace(scene.rfind('}'), 1, std::string(R"(, "sun": {"intensity": )") + intensity + "}}");
        folder.write((std::string(name) + ".json").c_str(), scene);
        const Ran ran = run(program("espalier-capture") + " " + folder.file(std::string(name) + ".json") +
                            " --size 64x36 -o " + folder.file(name));
        CHECK_MESSAGE(ran.code == 0, ran.output);
        return readAll(folder.file(name) + "/frame_0000.png");
    };
    CHECK(picture("dim", "0.1") != picture("bright", "3"));
}

TEST_CASE("every program has a version and a help") {
    for (const char* name : {"espalier-bake", "espalier-capture", "espalier-compare", "espalier-sample"}) {
        CAPTURE(name);
        const Ran version = run(program(name) + " --version");
        CHECK(version.code == 0);
        CHECK(contains(version.output, "0.1.0"));
        const Ran help = run(program(name) + " --help");
        CHECK(help.code == 0);
        CHECK(help.output.size() > 200);
        CHECK(run(program(name) + " --no-such-option").code == 2);
    }
    CHECK(run("tools/run --help").code == 0);
    CHECK(run("tools/test --help").code == 0);
    CHECK(run("tools/check --help").code == 0);
    CHECK(run("tools/run --no-such-option").code > 0);
    CHECK(run("tools/run no/such/model.glb").code > 0);
}

TEST_CASE("what a capture's options can't do is told before anything is grown") {
    const Folder folder;
    const std::string capture = program("espalier-capture") + " ", frames = folder.file("frames"),
                      out = " -o " + frames, run1 = " --replay tests/goldens/painting.jsonl",
                      scene = content("sample.json");
    for (const std::string& options :
         {run1 + " --view charts", run1 + " --camera 0,1,9,0,1,0", scene + " --every 3", scene + " --view blue",
          scene + " --camera 0,0,0,0,0,0", scene + " --camera 0,0,nan,0,0,0", scene + " --export mask",
          scene + " --hour nan"}) {
        CAPTURE(options);
        CHECK(run(capture + options + out).code == 2);
        CHECK(!std::filesystem::exists(frames));
    }
}

TEST_CASE("files that are missing, or aren't what they should be") {
    const Folder folder;
    const std::string out = " -o " + folder.file("frames"), capture = program("espalier-capture") + " ";
    refuses(capture + folder.file("none.json") + out, folder, {"none.json", "No such file"});
    refuses(capture + folder.file("none.glb") + out, folder, {"none.glb", "No such file"});
    refuses(capture + folder.path.string() + out, folder, {folder.path.c_str(), "folder"});
    refuses(capture + folder.write("text.glb", "not a model") + out, folder, {"text.glb"});
    refuses(capture + folder.write("nothing.glb", "") + out, folder, {"nothing.glb"});
    refuses(capture + content("ruin.glb") + out, folder, {"ruin.glb", "espalier-bake"});  // not baked
    refuses(capture + folder.write("model.gltf", R"({"asset": {}})") + out, folder, {"model.gltf", "espalier-bake"});
    refuses(capture + folder.write("note.txt", "of no use") + out, folder, {"note.txt", "neither a scene"});
    std::string half = readAll(content("ruin.surface.glb"));
    half.resize(half.size() / 2);
    refuses(capture + folder.write("half.glb", half) + out, folder, {"half.glb"});
}

TEST_CASE("a pipe in the place of a file is refused, with its name, and nobody waits for its other end") {
    const Folder folder;
    const std::string pipe = folder.file("pipe"), out = " -o " + folder.file("frames");
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    for (const char* name : {"pipe.json", "pipe.png", "pipe.glb", "pipe.jsonl", "pipe.grammar"})
        std::filesystem::create_symlink("pipe", folder.path / name);
    const std::string capture = "timeout 20 " + program("espalier-capture") + " ",
                      surface = content("ruin.surface.glb");
    for (const std::string& options :
         {folder.file("pipe.json"), folder.file("pipe.glb"), surface + " --grammar " + folder.file("pipe.grammar"),
          surface + " --layer mask=" + folder.file("pipe.png"), "--replay " + folder.file("pipe.jsonl"),
          folder.write("scene.json", sceneOf("pipe.glb", "pipe.grammar"))})
        refuses(capture + options + out, folder, {"pipe"});
    const std::string include =
        folder.write("includes.grammar", "include \"pipe.grammar\"\nIvy -> Marching(1, 0, -) Ivy");
    refuses(capture + surface + " --grammar " + include + out, folder, {"is a pipe"});
    refuses("timeout 20 " + program("espalier-compare") + " " + folder.file("pipe.png") + " " + content("mask.png"),
            folder, {"pipe.png"});
    refuses("timeout 20 " + program("espalier-bake") + " " + folder.file("pipe.json") + " -o " + folder.file("x.glb"),
            folder, {"pipe.json"});
}

TEST_CASE("scenes with mistakes tell the place of each") {
    const Folder folder;
    const std::string out = " -o " + folder.file("frames"), capture = program("espalier-capture") + " ";
    refuses(capture + folder.write("a.json", "{\"surface\": ") + out, folder, {"a.json:1:"});
    refuses(capture + folder.write("b.json", "[]") + out, folder, {"b.json:1:1", "object"});
    refuses(capture + folder.write("c.json", "{\n \"surfce\": \"x\",\n \"grammars\": []\n}") + out, folder,
            {"c.json:2:", "'surfce'", "'surface' is missing", "c.json:3:", "at least one"});
    std::string text = sceneOf(content("ruin.surface.glb"), "none.grammar");
    refuses(capture + folder.write("d.json", text) + out, folder, {"none.grammar", "No such file"});
    text.replace(text.find("[0, 1, 0.4]"), 11, "[0, 1]");
    refuses(capture + folder.write("e.json", text) + out, folder, {"e.json:3:", "three numbers"});
    refuses(capture + folder.write("f.json", std::string(100000, '[')) + out, folder, {"f.json:1:"});
    refuses(capture + folder.write("g.json", sceneOf("none.glb", "x")) + out, folder, {"none.glb"});
    refuses(capture + folder.write("h.json", "{\"surface\": 1e999}") + out, folder, {"h.json:1:"});
    refuses(
        capture + folder.write("i.json", R"({"town": {"file": "t", "grammar": 0.5, "houses": [
        {"house": 0, "shape": "hip", "edges": {}, "corners": 5}, {"house": 1, "shape": "hip", "corners": [[1, 1e300]]}]},
        "layers": {"mask": [{"surface": 0.5, "file": "m"}]},
        "grammars": [{"file": "g", "params": [], "seeds": [{"position": [0, 0, 0], "params": 7}]}]})") +
            out,
        folder,
        {"i.json:1:", "'grammar' must be a place", "i.json:2:", "'edges' must be a list", "'corners' must be a list",
         "two numbers", "'surface' must be a place", "i.json:4:", "'params' must be an object"});
    refuses(
        capture + folder.write("package.json", R"({"name": "x", "version": "1", "scripts": {}, "author": ""})") + out,
        folder, {"package.json:1:1: a scene has none of the keys that are here, such as 'name'"});
    std::string seeds = "{\"grammars\": [{\"file\": \"g\", \"seeds\": [";
    for (int i = 0; i < 500; ++i) seeds += std::string(i ? "," : "") + "{\"position\": 1}";
    const std::string told = refuses(capture + folder.write("many.json", seeds + "]}]}") + out, folder,
                                     {"many.json:1:", "further mistakes: 491"});
    CHECK(std::ranges::count(told, '\n') < 15);
    refuses(capture + folder.write("nul.json", sceneOf(content("ruin.surface.glb") + "\\u0000x", "x")) + out, folder,
            {"nul.json:2:", "NUL"});
    refuses(capture + folder.write("sun.json", R"({"sun": {"direction": [0, 0, 0]}})") + out, folder,
            {"sun.json:1:", "'direction'"});
    std::string keys = "{\"k\": 1";
    for (int i = 0; i < 150'000; ++i) keys += ", \"k" + std::to_string(i) + "\": 1";
    // Seconds of the processor's, which a busy machine has no part in.
    refuses("ulimit -t 10; " + capture + folder.write("j.json", keys + ", \"k\": 2}") + out, folder,
            {"j.json:1:", "'k' comes twice"});
}

TEST_CASE("grammars, layers and options with mistakes") {
    const Folder folder;
    const std::string capture =
        program("espalier-capture") + " " + content("ruin.surface.glb") + " -o " + folder.file("frames") + " ";
    refuses(capture + "--grammar " + folder.write("empty.grammar", ""), folder, {"empty.grammar"});
    refuses(capture + "--grammar " + folder.write("bad.grammar", "Ivy -> Marching(1,\nStem -> }"), folder,
            {"bad.grammar:2:"});
    refuses(capture + "--layer mask=" + folder.file("none.png"), folder, {"none.png", "No such file"});
    refuses("timeout 20 " + capture + "--layer mask=/dev/zero", folder, {"/dev/zero: is a device"});
    refuses(capture + "--layer mask=" + folder.write("text.png", "not a picture"), folder, {"text.png"});
    refuses(capture + "--layer bark=" + content("mask.png"), folder, {"mask.png", "'bark'"});
    refuses(capture + "--layer mask", folder, {"NAME=FILE"});
    refuses(capture + "--size 0x10", folder, {"--size"});
    for (const char* size : {"10", "4294967360x36", "'64x 36'", "+64x+36", "64x36x", "x36"})
        refuses(capture + "--size " + size, folder, {"--size"});
    refuses(capture + "--layer mask=", folder, {"NAME=FILE"});
    refuses(capture + "--layer mask=a.png --layer mask=b.png", folder, {"'mask' comes twice"});
    refuses(capture + "--view nothing", folder, {"--view"});
    for (const char* camera :
         {"1,2,3", "1,2,3,1,2,4,x", "1,2,3,1,2,4x", "1,2,3,1,2,4,", "1,2,3,1,2,4,50x", ",1,2,3,1,2,4", "''"})
        refuses(capture + "--camera " + camera, folder, {"--camera"});
    refuses(capture + "--frames 0", folder, {"--frames"});
    // A picture of a size that nobody can mean.
    const Ran wide = run("convert -size 9000x1 xc:white " + folder.file("wide.png"));
    if (wide.code == 0) refuses(capture + "--layer mask=" + folder.file("wide.png"), folder, {"wide.png", "9000 x 1"});
}

TEST_CASE("places that can't be written to") {
    const Folder folder;
    const std::string blocker = folder.write("blocker", "a file where a folder is wanted");
    const std::string capture =
        program("espalier-capture") + " " + content("sample.json") + " --size 32x16 --max-nodes 2000";
    refuses(capture + " -o " + blocker + "/frames", folder, {"blocker"});
    const Ran ran = run(capture + " -o " + folder.file("frames") + " --stats " + blocker + "/stats.json");
    CHECK(ran.code > 0);
    CHECK(contains(ran.output, "stats.json"));
    refuses(program("espalier-bake") + " " + content("ruin.glb") + " -o " + blocker + "/x.glb", folder, {"blocker"});
}

TEST_CASE("no Vulkan device is a message") {
    const Folder folder;
    const std::string without = "env VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent ";
    refuses(without + program("espalier-capture") + " " + content("sample.json") + " -o " + folder.file("frames"),
            folder, {"Vulkan"});
}

TEST_CASE("a picture of another format, or one that states too much, is refused by every program with its name") {
    const Folder folder;
    using namespace espalier::test;
    const std::string gif = "GIF\xFF" + std::string("9a\x18\xFF\xFF\xFF\x7F\0\0\xFF", 11) + std::string(17, '\x1B');
    const std::string bmp =
        "BM" + littleEndian(1292, 4) + std::string(4, '\0') + littleEndian(1078, 4) + littleEndian(40, 4);
    const std::pair<std::string, const char*> pictures[] = {
        {gif, "it is a GIF"},
        {bmp + littleEndian(60000, 4) + littleEndian(60000, 4) + littleEndian(0x80001, 4) + littleEndian(1, 4),
         "it is a BMP"},
        {bmp + littleEndian(8192, 4) + littleEndian(245760, 4) + littleEndian(0x80001, 4) + littleEndian(1, 4),
         "it is a BMP"},
        {pngOf(60000, 60000), "60000 x 60000 texels"},
        {jpegOf(65500, 65500), "65500 x 65500 texels"},
        {exrOf(0, 2000000000), "2000000001 x 2000000001 texels"}};
    const std::string out = " -o " + folder.file("frames"), capture = program("espalier-capture") + " ";
    const std::string whole = content("mask.png");
    folder.write("site.json", R"({"models": ")" + content("props.glb") +
                                  R"(", "props": {}, "ground": {"map": "bad.png", "low": [0, 0], "high": [1, 1]}})");
    for (const auto& [bytes, cause] : pictures) {
        const std::string bad = folder.write("bad.png", bytes);
        CAPTURE(cause);
        const Ran compared = run(program("espalier-compare") + " " + whole + " " + bad);
        CHECK(compared.code == 2);
        CHECK_MESSAGE(contains(compared.output, bad + ": "), compared.output);
        CHECK_MESSAGE(contains(compared.output, cause), compared.output);
        refuses(capture + content("ruin.surface.glb") + " --grammar " + content("grammars/ivy_guided.grammar") +
                    " --layer mask=" + bad + out,
                folder, {"bad.png: ", cause});
        folder.write("sited.json", R"({"surface": ")" + content("ruin.surface.glb") +
                                       R"(", "site": "site.json", "grammars": [{"file": ")" +
                                       content("grammars/ivy_free.grammar") + R"("}]})");
        refuses(capture + folder.file("sited.json") + out, folder, {"bad.png: ", cause});
        refuses(program("espalier-bake") + " -q " + content("ruin.glb") + " --resolution 64 --weights " + bad + " -o " +
                    folder.file("x.glb"),
                folder, {"bad.png: "});
    }
}

TEST_CASE("what a program reads is never written over by what it writes") {
    const Folder folder;
    const std::string town = folder.write("town.json", readAll(content("town.json"))),
                      grammar = folder.write("own.grammar", readAll(content("grammars/town.grammar"))),
                      picture = folder.file("a.png"), same = folder.file("b.png");
    std::filesystem::copy(content("ivy.png"), picture);
    std::filesystem::create_symlink(picture, same);
    const std::string scene =
        folder.write("scene.json", sceneOf(content("ruin.surface.glb"), content("grammars/ivy_free.grammar")));
    const std::string capture = program("espalier-capture") + " " + scene + " -o " + folder.file("frames");
    const std::string before = readAll(grammar), pixels = readAll(picture), text = readAll(scene);
    for (const std::string& command :
         {program("espalier-bake") + " " + town + " -o " + grammar + " --grammar " + grammar,
          program("espalier-bake") + " " + town + " -o " + town,
          program("espalier-compare") + " " + picture + " " + picture + " --diff " + same,
          capture + " --stats " + scene, capture + " --layer mask=" + picture + " --export mask=" + same,
          capture + " --stats " + folder.file("frames/frame_0000.png")}) {
        CAPTURE(command);
        const Ran ran = run(command);
        CHECK(ran.code == 2);
        CHECK_MESSAGE(contains(ran.output, "would overwrite"), ran.output);
    }
    CHECK(readAll(grammar) == before);
    CHECK(readAll(picture) == pixels);
    CHECK(readAll(scene) == text);
    CHECK(!std::filesystem::exists(folder.file("frames")));
}

TEST_CASE("a layer that only a town's roofs read is laid over the town, and stats tell of its roofs") {
    const Folder folder;
    const std::string white = folder.file("white.png"), capture = program("espalier-capture") + " ";
    REQUIRE(run("convert -size 8x8 xc:white " + white).code == 0);
    const auto hash = [&](const std::string& options) {
        const std::string stats = folder.file("stats.json");
        const Ran ran = run(capture + options + content("town.json") + " --size 32x18 -o " + folder.file("frames") +
                            " --stats " + stats);
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
        const std::string told = readAll(stats);
        REQUIRE(contains(told, "\"roofs\":{\"houses\":"));
        return told.substr(told.find("\"tiles\":"));
    };
    const std::string bare = hash("");
    CHECK(hash("") == bare);
    CHECK(hash("--layer decay=" + white + " ") != bare);
}

TEST_CASE("a file that outgrows what is allowed is an error, and nothing of it stays") {
    const Folder folder;
    const Ran ran = run("ulimit -f 8; " + program("espalier-capture") + " " + content("sample.json") +
                        " --size 320x180 -o " + folder.file("frames"));
    CHECK(ran.code == 1);
    CHECK_MESSAGE(contains(ran.output, "frame_0000.png"), ran.output);
    CHECK(folder.count() == 0);
}

TEST_CASE("what is written to a link that leads nowhere yet is written where it leads") {
    const Folder folder;
    const std::string link = folder.file("link.json");
    std::filesystem::create_symlink("there.json", link);
    const Ran ran = run(program("espalier-capture") + " " + content("town.json") + " --size 32x18 -o " +
                        folder.file("frames") + " --stats " + link);
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    CHECK(std::filesystem::is_symlink(link));
    CHECK(contains(readAll(folder.file("there.json")), "\"hash\""));
}

TEST_CASE("numbers that no option takes are refused with its name") {
    const std::string capture = program("espalier-capture") + " " + content("town.json") + " ";
    for (const char* options : {"--max-nodes 0", "--leaf-cap nan", "--leaf-cap -1", "--camera 1,2,3,1,2,0,180",
                                "--camera 1,2,3,1,2,0,0", "--export mask=m.jpg"}) {
        const Ran ran = run(capture + options);
        CAPTURE(options);
        CHECK(ran.code == 2);
        CHECK_MESSAGE(contains(ran.output, std::string(options).substr(0, 6)), ran.output);
    }
    CHECK(run(program("espalier-sample") + " --screenshot x.png").code == 2);
    CHECK(run(program("espalier-sample") + " --autosave nan --frames 1").code == 2);
    CHECK(run(program("espalier-sample") + " --frames -1").code == 2);
    CHECK(run(program("espalier-bench") + " --filter nothing-is-called-so").code == 2);
}
