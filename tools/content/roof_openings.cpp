// Casements, shutters and doors. In: nothing. Out: meshes in the unit box of their shape on a wall: x along, y up, z
// out.
#include "tools/content/roof_solid.hpp"

namespace espalier::content {
namespace {

using glm::vec3;

// Across, where details have no depth any more, and where bars are next to nothing of a pixel.
constexpr float kFlatPixels = 40, kBarlessPixels = 8;

// Two leaves with two bars each, which the coarsest level leaves out.
Mesh casement(int lod) {
    Solid s;
    constexpr float kRim = 0.07f;
    const auto piece = [&](vec3 low, vec3 high) {
        if (lod < 2) return void(s.bar(low, high));
        const size_t first = s.mesh.positions.size();
        s.quad({low.x, low.y, 1}, {high.x, low.y, 1}, {high.x, high.y, 1}, {low.x, high.y, 1});
        thinAcross(s.mesh, first, low, high);
    };
    piece({0, 0, 0}, {1, 0.06f, 1});
    piece({0, 0.95f, 0}, {1, 1, 1});
    piece({0, 0.06f, 0}, {kRim, 0.95f, 1});
    piece({1 - kRim, 0.06f, 0}, {1, 0.95f, 1});
    if (lod == 2) return s.mesh;
    s.bar({0.46f, 0.06f, 0}, {0.54f, 0.95f, 0.8f});
    for (float y : {0.34f, 0.64f}) {
        const float top = y + 0.025f;
        const size_t first = s.mesh.positions.size();
        if (lod == 0)
            s.bar({kRim, y, 0}, {0.46f, top, 0.6f}).bar({0.54f, y, 0}, {1 - kRim, top, 0.6f});
        else
            s.quad({kRim, y, 0.6f}, {1 - kRim, y, 0.6f}, {1 - kRim, top, 0.6f}, {kRim, top, 0.6f});
        if (lod == 1) thinAcross(s.mesh, first, {kRim, y, 0}, {1 - kRim, top, 0.6f});
    }
    return s.mesh;
}

// What surrounds an opening: jambs, a lintel, and a sill that juts out and throws its shade on the reveal.
Mesh surround() {
    Solid s;
    s.box({-0.13f, 0, 0}, {0, 1, 1}).box({1, 0, 0}, {1.13f, 1, 1});
    s.box({-0.13f, 1, 0}, {1.13f, 1.1f, 1.15f});
    return s.box({-0.17f, -0.07f, 0}, {1.17f, 0, 2.4f}, 0.95f).mesh;
}

// A pane with curtains behind it, drawn aside a little more below than above. They lie on it, all but flat: nobody sees
// how deep a room is.
Mesh curtains(int lod) {
    const int rows = lod == 0 ? 6 : 2, folds = lod == 0 ? 5 : 1;
    const auto edge = [](float y) { return 0.19f + 0.17f * y * y; };
    Solid s;
    for (int row = 0; row < rows; ++row) {
        const float y = float(row) / float(rows), top = float(row + 1) / float(rows);
        s.quad({edge(y), y, 0}, {1 - edge(y), y, 0}, {1 - edge(top), top, 0}, {edge(top), top, 0});
        for (int fold = 0; fold < folds; ++fold) {
            const auto at = [&](int line, float up, bool right) {
                const float x = edge(up) * float(line) / float(folds);
                return vec3(right ? 1 - x : x, up, line % 2 && line < folds ? 0.006f : 0.0f);
            };
            const float shade = (lod > 0 ? 7.4f : fold % 2 ? 6.2f : 8.2f) * (0.85f + 0.15f * y);
            s.quad(at(fold, y, false), at(fold + 1, y, false), at(fold + 1, top, false), at(fold, top, false), shade);
            s.quad(at(fold + 1, y, true), at(fold, y, true), at(fold, top, true), at(fold + 1, top, true), shade);
        }
    }
    return s.mesh;
}

// A leaf with slats in two fields.
Mesh shutter(int lod) {
    Solid s;
    constexpr float kRim = 0.12f;
    s.box({0, 0, 0}, {kRim, 1, 1}).box({1 - kRim, 0, 0}, {1, 1, 1});
    for (float y : {0.0f, 0.47f, 0.94f}) s.box({kRim, y, 0}, {1 - kRim, y + 0.06f, 0.95f});
    if (lod > 0) return s.quad({kRim, 0, 0.4f}, {1 - kRim, 0, 0.4f}, {1 - kRim, 1, 0.4f}, {kRim, 1, 0.4f}, 0.75f).mesh;
    for (float field : {0.06f, 0.53f})
        for (int i = 0; i < 8; ++i) {
            const float y = field + 0.41f * float(i) / 8, top = y + 0.41f / 8;
            s.quad({kRim, y, 0.85f}, {1 - kRim, y, 0.85f}, {1 - kRim, top, 0.2f}, {kRim, top, 0.2f}, 0.9f);
        }
    return s.mesh;
}

// A leaf with four sunk panels, and its frame.
Mesh door(int lod) {
    Solid s;
    s.box({-0.09f, 0, 0}, {0, 1.05f, 1}, 1.15f).box({1, 0, 0}, {1.09f, 1.05f, 1}, 1.15f);
    s.box({0, 1, 0}, {1, 1.05f, 1}, 1.15f);
    const float face = 0.85f, deep = 0.62f;  // before the plinth
    if (lod > 0) return s.quad({0, 0, face}, {1, 0, face}, {1, 1, face}, {0, 1, face}).mesh;
    for (float x : {0.0f, 0.44f, 0.88f}) s.box({x, 0, 0}, {x + 0.12f, 1, face});
    for (float y : {0.0f, 0.46f, 0.92f}) s.box({0.12f, y, 0}, {0.88f, y + 0.08f, face * 0.98f});
    s.quad({0.1f, 0, deep}, {0.9f, 0, deep}, {0.9f, 1, deep}, {0.1f, 1, deep}, 0.75f);
    return s.box({0.9f, 0.47f, 0}, {0.94f, 0.53f, 1.15f}, 1.6f).mesh;
}

}  // namespace

void addOpenings(RoofMeshes& out) {
    for (int lod : {0, 1}) {
        const std::string end = "_lod" + std::to_string(lod);
        const float pixels = lod == 0 ? 0 : kFlatPixels;
        out.all.push_back({"casement" + end, casement(lod), 1, pixels});
        out.all.push_back({"shutter" + end, shutter(lod), 1, pixels});
        out.all.push_back({"door" + end, door(lod), 1, pixels});
        out.all.push_back({"curtains" + end, curtains(lod), 2, pixels});
    }
    out.all.push_back({"casement_lod2", casement(2), 1, kBarlessPixels});
    out.all.push_back({"surround_lod0", surround(), 0});
}

}  // namespace espalier::content
