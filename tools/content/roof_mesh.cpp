// Slates, ridge caps, panels and boards. In: nothing. Out: meshes of few triangles, since a town has millions of them.
#include "tools/content/roof_mesh.hpp"

#include "tools/content/roof_solid.hpp"

namespace espalier::content {
namespace {

using glm::vec3;

void addQuad(Mesh& m, vec3 a, vec3 b, vec3 c, vec3 d) {
    const vec3 n = glm::normalize(glm::cross(b - a, d - a));
    const uint32_t first = uint32_t(m.positions.size());
    for (vec3 p : {a, b, c, d}) {
        m.positions.push_back(p);
        m.normals.push_back(n);
        m.uvs.emplace_back(1, 0);
        m.weld.push_back(uint32_t(m.weld.size()));
    }
    for (uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) m.indices.push_back(first + i);
}

// Lies on the course below, so that its lower edge stands up; the next course hides its head.
Mesh slate(int lod) {
    constexpr float kGap = 0.012f, kHead = 1.1f, kLow = 0.018f, kHigh = 0.008f, kThick = 0.009f;
    const vec3 a(kGap, 0, kLow), b(1 - kGap, 0, kLow), c(1 - kGap, kHead, kHigh), d(kGap, kHead, kHigh);
    const vec3 down(0, 0, -kThick);
    Mesh m;
    addQuad(m, a, b, c, d);
    addQuad(m, a + down, b + down, b, a);  // seen from below at a low angle, courses would gape without
    if (lod > 0) return m;
    addQuad(m, d + down, a + down, a, d);
    addQuad(m, b + down, c + down, c, b);
    return m;
}

// A cap over a joint: edges at z = 0 and y = -0.5 and 0.5, the crown at z = 1. It reaches over the next one. From afar
// its neighbours may have faded into a pattern, so both its ends are closed.
Mesh ridge(int lod) {
    const int steps = lod == 0 ? 6 : 2;
    auto at = [&](int i, float x, float swell) {
        const float t = -1 + 2 * float(i) / float(steps);
        return vec3(x, 0.5f * t * swell, (lod == 0 ? 1 - t * t * (0.55f + 0.45f * t * t) : 1 - std::abs(t)) * swell);
    };
    Mesh m;
    for (int i = 0; i < steps; ++i)
        addQuad(m, at(i, 0, 1.08f), at(i, 1.06f, 1.0f), at(i + 1, 1.06f, 1.0f), at(i + 1, 0, 1.08f));
    for (int i = 0; i < steps && lod == 0; ++i)
        addQuad(m, at(i + 1, 0, 1.08f), at(i + 1, 0, 0.9f), at(i, 0, 0.9f), at(i, 0, 1.08f));
    for (int i = 0, k = steps; i < k; ++i, --k) {
        addQuad(m, at(i, 0, 0.9f), at(i + 1, 0, 0.9f), at(k - 1, 0, 0.9f), at(k, 0, 0.9f));
        addQuad(m, at(k, 1.06f, 1), at(k - 1, 1.06f, 1), at(i + 1, 1.06f, 1), at(i, 1.06f, 1));
    }
    return m;
}

Mesh panel() {
    Mesh m;
    addQuad(m, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    return m;
}

Mesh board() {
    Mesh m;
    const vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), o(0);
    addQuad(m, z, z + x, z + x + y, z + y);
    addQuad(m, o, x, x + z, z);
    addQuad(m, x, x + y, x + y + z, x + z);
    addQuad(m, x + y, y, y + z, x + y + z);
    addQuad(m, y, o, z, y + z);
    addQuad(m, y, x + y, x, o);
    return m;
}

void addBoard(Mesh& m, vec3 low, vec3 high) {
    const Mesh one = board();
    const uint32_t first = uint32_t(m.positions.size());
    for (size_t i = 0; i < one.positions.size(); ++i) {
        m.positions.push_back(low + one.positions[i] * (high - low));
        m.normals.push_back(one.normals[i]);
        m.uvs.push_back(one.uvs[i]);
        m.weld.push_back(uint32_t(m.weld.size()));
    }
    for (uint32_t i : one.indices) m.indices.push_back(first + i);
}

// A window's frame with its cross.
Mesh frame() {
    Mesh m;
    const auto bar = [&](vec3 low, vec3 high) {
        const size_t first = m.positions.size();
        addBoard(m, low, high);
        thinAcross(m, first, low, high);
    };
    bar({0, 0, 0}, {1, 0.06f, 1.4f});
    bar({0, 0.94f, 0}, {1, 1, 1});
    bar({0, 0.06f, 0}, {0.07f, 0.94f, 1});
    bar({0.93f, 0.06f, 0}, {1, 0.94f, 1});
    bar({0.47f, 0.06f, 0}, {0.53f, 0.94f, 0.8f});
    bar({0.07f, 0.6f, 0}, {0.93f, 0.64f, 0.7f});
    return m;
}

}  // namespace

RoofMeshes makeRoofMeshes() {
    RoofMeshes out;
    for (int lod : {0, 1}) {
        out.all.push_back({"slate_lod" + std::to_string(lod), slate(lod), 0});
        out.all.push_back({"ridge_lod" + std::to_string(lod), ridge(lod), 0});
    }
    out.all.push_back({"panel_lod0", panel(), 0});
    out.all.push_back({"board_lod0", board(), 1});
    out.all.push_back({"glass_lod0", panel(), 2});
    out.all.push_back({"frame_lod0", frame(), 1});
    addCoverings(out);
    addFittings(out);
    addOpenings(out);
    return out;
}

}  // namespace espalier::content
