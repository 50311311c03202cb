// The scenes of content/li_2011 remake the figures of Li 2011. Each is drawn as its golden shows, without a message of
// the validation layer. Scenes of models that the repository doesn't hold are skipped where these models are missing.
#include <doctest/doctest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "tests/support/data.hpp"
#include "tests/tools/golden.hpp"

namespace {

const std::string kScenes = ESPALIER_CONTENT "/li_2011/", kPrefix = "li_2011_";

// What scenes call BUNNY.surface.glb, and where its model lies in the folder of further models.
const std::map<std::string, std::string> kModels{{"armadillo.surface.glb", "derived/armadillo.glb"},
                                                 {"bunny.surface.glb", "derived/bunny.glb"},
                                                 {"dragon.surface.glb", "derived/dragon_res3.glb"},
                                                 {"spot.surface.glb", "scans/spot.obj"}};

std::set<std::string> stemsIn(const std::string& folder, const std::string& extension, const std::string& prefix = "") {
    std::set<std::string> stems;
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
        const std::string stem = file.path().stem().string();
        if (file.path().extension() == extension && stem.starts_with(prefix)) stems.insert(stem.substr(prefix.size()));
    }
    return stems;
}

// Bakes the scene's model into the folder of scenes, once a run. False: the model isn't there.
bool bakeModelOf(const std::string& scene) {
    static std::map<std::string, bool> baked;
    const nlohmann::json text = nlohmann::json::parse(readAll("content/li_2011/" + scene + ".json"));
    const std::string surface = text.at("surfaces").at(0).at("file");
    const auto model = kModels.find(surface);
    if (model == kModels.end() || baked.contains(surface)) return model == kModels.end() || baked.at(surface);
    const std::optional<std::string> file = espalier::test::dataFile(model->second);
    if (file) {
        const Ran ran =
            run(program("espalier-bake") + " " + *file + " -o " + kScenes + surface + " --resolution 512 -q");
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
    }
    return baked[surface] = file.has_value();
}

// Draws a scene and returns its counts of patterns.
nlohmann::json draw(const std::string& scene, const std::string& out) {
    const Ran drawn = run("env ESPALIER_VALIDATION=1 " + program("espalier-capture") + " " + kScenes + scene +
                          ".json --size 360x270 -o " + out + " --stats " + out + ".json");
    REQUIRE_MESSAGE(drawn.code == 0, drawn.output);
    const nlohmann::json stats = nlohmann::json::parse(readAll(out + ".json"));
    CHECK(stats.at("validation_messages") == 0);
    return stats.at("patterns");
}

}  // namespace

TEST_CASE("figures of Li 2011 are drawn as the goldens show") {
    const Folder folder;
    std::map<std::string, nlohmann::json> patterns;
    for (const std::string& scene : stemsIn("content/li_2011", ".json")) {
        CAPTURE(scene);
        if (!bakeModelOf(scene)) continue;
        patterns[scene] = draw(scene, folder.file(scene));
        CHECK(patterns[scene].at("pieces") > 200);
        checkGolden(kPrefix + scene, folder.file(scene) + "/frame_0000.png");
    }
    // Nothing that stands depends on whether the surface is drawn, which mesh shows lines, or what is drawn on
    // ellipses.
    const auto alike = [&](const std::string& a, const std::string& b, const char* count) {
        if (patterns.contains(a)) CHECK(patterns.at(a).at(count) == patterns.at(b).at(count));
    };
    alike("fig_16_middle", "fig_16_right", "hash");
    alike("fig_10_middle", "fig_10_right", "pieces");
    alike("fig_11_top", "fig_11_bottom", "fallen");
}

TEST_CASE("no figure is without a golden, and no golden without a figure") {
    CHECK(stemsIn("content/li_2011", ".json") == stemsIn("tests/goldens", ".png", kPrefix));
}
