// Every shipped graph is drawn as its golden shows, without a message of the validation layer.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/tools/golden.hpp"

namespace {

struct GraphPicture {
    const char* name;
    int frame;
};
constexpr GraphPicture kGraphPictures[] = {{"bent_tower", 0},
                                           {"brush_strokes", 0},
                                           {"cube_clouds", 0},
                                           {"noise_in_fluid", 34},
                                           {"fluid_dam", 34},
                                           {"glass_tubes", 0},
                                           {"ivy_pergola", 0},
                                           {"nautilus", 0},
                                           {"pergola", 0},
                                           {"planet", 100},
                                           {"rippled_sphere", 40},
                                           {"spherified_car", 0},
                                           {"twisted_all", 0},
                                           {"twisted_cubes", 0},
                                           {"twisted_points", 0},
                                           {"twisted_tree", 0},
                                           {"urchins", 60},
                                           {"varied_grove", 0},
                                           {"vaulted_hall", 0},
                                           {"wave_shells", 20},
                                           {"waved_cube", 20},
                                           {"weathered_town", 0},
                                           {"woven_sphere", 300},
                                           {"woven_sphere_low", 300},
                                           {"woven_sphere_medium", 300}};

std::string captureOf(const GraphPicture& graph, const std::string& folder, const std::string& more = "") {
    return program("espalier-capture") + " content/graphs/" + graph.name + ".graph --size 480x270 --still --frame " +
           std::to_string(graph.frame) + " -o " + folder + more;
}

}  // namespace

TEST_CASE("shipped graphs are drawn as the goldens show") {
    const Folder folder;
    for (const GraphPicture& graph : kGraphPictures) {
        CAPTURE(std::string(graph.name));
        const std::string out = folder.file(graph.name), stats = out + ".json";
        const Ran drawn = run("env ESPALIER_VALIDATION=1 " + captureOf(graph, out, " --stats " + stats));
        REQUIRE_MESSAGE(drawn.code == 0, drawn.output);
        CHECK(nlohmann::json::parse(readAll(stats)).at("validation_messages") == 0);
        checkGolden("graph_" + std::string(graph.name), out + "/frame_0000.png");
    }
}

TEST_CASE("no shipped graph is without a golden") {
    std::set<std::string> shipped, drawn;
    for (const auto& file : std::filesystem::directory_iterator("content/graphs"))
        if (file.path().extension() == ".graph") shipped.insert(file.path().stem().string());
    for (const GraphPicture& graph : kGraphPictures) drawn.insert(graph.name);
    CHECK(shipped == drawn);
}

TEST_CASE("a fluid is drawn alike by shaders and by native code") {
    const Folder folder;
    const GraphPicture early{"fluid_dam", 3};
    const Ran native = run(captureOf(early, folder.file("native")));
    REQUIRE_MESSAGE(native.code == 0, native.output);
    const Ran shaders = run(captureOf(early, folder.file("shaders"), " --shaders"));
    REQUIRE_MESSAGE(shaders.code == 0, shaders.output);
    CHECK(readAll(folder.file("native") + "/frame_0000.png") == readAll(folder.file("shaders") + "/frame_0000.png"));
}
