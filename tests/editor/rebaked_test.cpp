// A project whose model is baked anew: what was painted stays where it was in space, whatever became of the charts.
#include <cmath>
#include <glm/glm.hpp>

#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;

namespace {

constexpr float kRadius = .6f;
constexpr glm::vec3 kCorner(1, 1, 1);

// A cube of two metres about the origin, its far half longer if `grown`.
std::string cube(bool grown) {
    std::string text;
    const float far = grown ? -2.f : -1.f;
    for (float z : {far, 1.f})
        for (float y : {-1.f, 1.f})
            for (float x : {-1.f, 1.f})
                text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    for (const char* face : {"1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"})
        text += "f " + std::string(face) + "\n";
    return text;
}

struct Rebaked {
    Folder folder;
    std::string scene;

    Rebaked() {
        bake(false, 64);
        folder.write("walks.grammar", "context mask = 1\nIvy -> Marching(0.05, 0, mask(texCoord) > 0.5) {Ivy}\n");
        scene = folder.write("scene.json", R"({"surface": "cube.glb", "grammars": [{"file": "walks.grammar",
            "seeds": [{"position": [0, 0, 1], "seed": 1}]}]})");
    }
    void bake(bool grown, int side) {
        const Ran ran = run(program("espalier-bake") + " -q --resolution " + std::to_string(side) + " -o " +
                            folder.file("cube.glb") + " " + folder.write("cube.obj", cube(grown)));
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
    }
    // Keeps ivy away from a corner, over three charts, and saves that.
    void paintAndSave(Editing& editing) {
        StrokeBegin stroke;
        stroke.layer = "mask";
        stroke.radius = kRadius;
        stroke.value = 0;
        stroke.strength = stroke.hardness = 1;
        REQUIRE_MESSAGE(editing.perform(stroke, 1), editing.error);
        REQUIRE_MESSAGE(editing.perform(StrokeDabs{{{kCorner.x, kCorner.y, kCorner.z, 0, 0, 1, 1}}}, 1), editing.error);
        REQUIRE_MESSAGE(editing.perform(StrokeEnd{}, 1), editing.error);
        REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("kept"), editing.error), editing.error);
    }
    // Of random places on the cube that lie farther than `rim` from the painted part's rim: how many of them have
    // another value than the brush gave them.
    static int wrong(const Editing& editing, float rim) {
        const EspSurface surface = editing.document->scene().surfaces[0].id;
        uint32_t side = 0;
        REQUIRE(espReadLayer(editing.context.get(), surface, "mask", nullptr, &side) == ESP_OK);
        std::vector<float> mask(size_t(side) * side);
        REQUIRE(espReadLayer(editing.context.get(), surface, "mask", mask.data(), &side) == ESP_OK);
        std::mt19937 random(5);
        std::uniform_real_distribution<float> within(-1, 1);
        int wrong = 0, painted = 0;
        for (int i = 0; i < 3000; ++i) {
            glm::vec3 point(within(random), within(random), within(random));
            point[int(random() % 3)] = random() % 4 ? 1.f : -1.f;
            const float away = glm::distance(point, kCorner);
            EspHit hit;
            REQUIRE(espNearest(editing.context.get(), &point.x, &hit) == ESP_OK);
            if (std::abs(away - kRadius) < rim || hit.distance > 1e-3f) continue;
            const auto texel = [&](float at) { return std::min(uint32_t(at * float(side)), side - 1); };
            const float value = mask[texel(hit.uv[1]) * side + texel(hit.uv[0])];
            wrong += (value < .5f) != (away < kRadius);
            painted += away < kRadius;
        }
        CHECK(painted > 60);
        return wrong;
    }
    size_t bakes() const {
        std::error_code none;
        size_t count = 0;
        for (const auto& entry : std::filesystem::directory_iterator(folder.file("kept/surfaces"), none))
            count += entry.path().extension() == ".glb";
        return count;
    }
};

}  // namespace

TEST_CASE("paint stays in its place when the model of a project is baked anew") {
    Rebaked cube;
    {
        Editing editing(cube.scene);
        cube.paintAndSave(editing);
        CHECK(Rebaked::wrong(editing, .1f) == 0);
    }
    CHECK(cube.bakes() == 1);
    SUBCASE("as it was") {
        const Editing opened(cube.folder.file("kept"));
        CHECK(opened.document->scene().notes.empty());
    }
    SUBCASE("finer, and one side of it is longer") {
        cube.bake(true, 256);
        Editing opened(cube.folder.file("kept"));
        REQUIRE(opened.document->scene().notes.size() == 1);
        CHECK_MESSAGE(contains(opened.document->scene().notes[0], "cube.glb"), opened.document->scene().notes[0]);
        CHECK_MESSAGE(contains(opened.document->scene().notes[0], "new and unpainted"),
                      opened.document->scene().notes[0]);
        CHECK(Rebaked::wrong(opened, .15f) == 0);
        // Saved once more it lies over the new one, and the old one isn't kept any longer.
        REQUIRE_MESSAGE(saveProject(*opened.document, cube.folder.file("kept"), opened.error), opened.error);
        CHECK(cube.bakes() == 1);
        const Editing again(cube.folder.file("kept"));
        CHECK(again.document->scene().notes.empty());
        CHECK(Rebaked::wrong(again, .15f) == 0);
    }
}

TEST_CASE("a project that is saved after its model was baked anew keeps the bake that was painted on") {
    Rebaked cube;
    Editing editing(cube.scene);
    cube.bake(true, 256);  // it takes the other's place; what is open still has that
    cube.paintAndSave(editing);
    Editing opened(cube.folder.file("kept"));
    CHECK(opened.document->scene().notes.size() == 1);
    CHECK(Rebaked::wrong(opened, .15f) == 0);
}

TEST_CASE("a project opens though the bake that was painted on is damaged") {
    Rebaked cube;
    {
        Editing editing(cube.scene);
        cube.paintAndSave(editing);
    }
    for (const auto& entry : std::filesystem::directory_iterator(cube.folder.file("kept/surfaces")))
        std::filesystem::resize_file(entry.path(), 1000);
    CHECK(Editing(cube.folder.file("kept")).document->scene().notes.empty());  // nobody needs it
    cube.bake(true, 256);
    const Editing opened(cube.folder.file("kept"));
    REQUIRE(opened.document->scene().notes.size() == 1);
    CHECK_MESSAGE(contains(opened.document->scene().notes[0], "can't be read"), opened.document->scene().notes[0]);
}

TEST_CASE("a project without the bake that was painted on opens, and says that its paint may not fit") {
    Rebaked cube;
    Editing editing(cube.scene);
    const std::string bytes = readAll(cube.folder.file("cube.glb"));
    cube.folder.write("cube.glb", bytes);  // written over, so that nobody has what was there
    cube.paintAndSave(editing);
    CHECK(cube.bakes() == 0);
    CHECK(Editing(cube.folder.file("kept")).document->scene().notes.empty());  // it is the same
    cube.bake(true, 256);
    const Editing opened(cube.folder.file("kept"));
    REQUIRE(opened.document->scene().notes.size() == 1);
    CHECK_MESSAGE(contains(opened.document->scene().notes[0], "may not fit"), opened.document->scene().notes[0]);
}
