#pragma once

// A wall with a pattern along a field, and an editor that combs it: for tests of fields in an editor's hands.
#include <map>
#include <random>

#include "sample_game/field_tool.hpp"
#include "tests/editor/widgets.hpp"
#include "tools/document/run.hpp"

using namespace espalier::document;
using espalier::scene::SceneField;
using sample::Tool;

namespace field_tool {

inline constexpr uint32_t kCells = 24;

// A wall of many triangles, 2 m wide and high, on which arrows lie along a field.
inline std::string patternScene(const Folder& folder) {
    std::string model;
    for (uint32_t y = 0; y <= kCells; ++y)
        for (uint32_t x = 0; x <= kCells; ++x)
            model += "v " + std::to_string(2. * x / kCells - 1) + " " + std::to_string(2. * y / kCells) + " 0\n";
    for (uint32_t y = 0; y < kCells; ++y)
        for (uint32_t x = 0; x < kCells; ++x) {
            const uint32_t a = y * (kCells + 1) + x + 1, b = a + kCells + 1;
            for (const uint32_t corner : {a, a + 1, b + 1, b})
                model += (corner == a ? "f " : " ") + std::to_string(corner);
            model += "\n";
        }
    folder.write("plate.obj", model);
    const Ran baked = run(program("espalier-bake") + " -q --resolution 128 -o " + folder.file("plate.surface.glb") +
                          " " + folder.file("plate.obj"));
    REQUIRE_MESSAGE(baked.code == 0, baked.output);
    folder.write("rows.grammar",
                 "field flow : vector \"Direction\"\n"
                 "Start -> A\n"
                 "A -> [S(0.06) IC(\"scale\")] [T(0.1, 0, 0) A] [T(0, 0.1, 0) A] [T(0, -0.1, 0) A]\n");
    return folder.write("plate.json",
                        R"({"surfaces": [{"file": "plate.surface.glb"}], "grammars": [{"file": "rows.grammar",
      "seeds": [{"position": [0, 1, 0], "direction": [1, 0, 0], "seed": 1}]}],
      "camera": {"eye": [0, 1, 4], "target": [0, 1, 0], "fov": 40}})");
}

inline uint64_t patternOf(EspContext* context) {
    REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    EspPatternStats stats;
    REQUIRE(espPatternStats(context, &stats) == ESP_OK);
    REQUIRE(stats.pieces > 20);
    return stats.hash;
}

struct Comber : Editor {
    explicit Comber(const Folder& folder) : Editor(folder, patternScene(folder), Tool::fields) {
        work.field.radius = .3f;
    }
    uint64_t pattern() { return patternOf(work.context.get()); }
    glm::vec2 on(float x, float y) const { return at({x, y, 0}); }
    const std::vector<SceneField>& fields() const { return work.scene().surfaces[0].fields; }
    std::string lines() const {
        std::string all;
        for (const SceneField& field : fields()) {
            all += toJson({0, 0, SetField{0, field}});
            for (const auto& stroke : field.strokes) all += toJson({0, 0, BrushField{0, field.name, stroke}});
        }
        return all;
    }
};

inline std::string plyOf(const std::string& rows, int count) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) + "\n";
    for (const char* name : {"x", "y", "z", "vx", "vy", "vz"}) text += std::string("property float ") + name + "\n";
    return text + "end_header\n" + rows;
}

}  // namespace field_tool
