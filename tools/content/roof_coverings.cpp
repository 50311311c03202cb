// Flat tiles, pantiles, barrel tiles and standing seams. In: nothing. Out: meshes of one cell each, whose course lies
// on the one below: the lower edge stands up, the next course hides the head.
#include "tools/content/roof_solid.hpp"

namespace espalier::content {
namespace {

using glm::vec3;

// How high a tile's upper side lies, from its lower edge (t = 0) up: the head lies under the next tile's edge.
float lie(float t) {
    return 0.032f - 0.015f * t;
}

// A plain tile with a round tail. Its head reaches far under the next courses, since two tails leave a gap that shows
// the tile below.
Mesh plain(int lod) {
    constexpr float kGap = 0.01f, kHead = 1.4f, kTail = 0.22f, kThick = 0.014f;
    const int steps = lod == 0 ? 6 : 2;
    Solid s;
    auto rim = [&](int i) {
        const float u = float(i) / float(steps), x = kGap + (1 - 2 * kGap) * u, c = 2 * u - 1;
        const float y = kTail * (1 - std::sqrt(std::max(0.0f, 1 - c * c * 0.999f)));
        return vec3(x, y, lie(y));
    };
    const vec3 down(0, 0, -kThick);
    for (int i = 0; i < steps; ++i) {
        const vec3 a = rim(i), b = rim(i + 1);
        const vec3 c(b.x, kHead, lie(kHead)), d(a.x, kHead, lie(kHead));
        s.quad(a, b, c, d);
        s.quad(a + down, b + down, b, a, 0.8f);
    }
    return s.mesh;
}

// One roll beside a flat trough; its right edge lies on the next tile's left one.
Mesh pan(int lod) {
    const int across = lod == 0 ? 12 : 5;
    auto height = [](float x) {
        const float c = 0.5f + 0.5f * std::cos(6.2831853f * (x - 0.8f));
        return 0.045f * c * c + 0.007f * x;
    };
    auto at = [&](float s, float t) {
        const float x = -0.02f + 1.06f * s, y = 1.08f * t;
        return vec3(x, y, lie(y) + height(x));
    };
    auto shade = [&](float s, float) { return 0.8f + 0.2f * std::min(1.0f, height(-0.02f + 1.06f * s) / 0.03f); };
    Solid s;
    s.sheet(across, 1, at, shade);
    auto front = [&](float u, float t) { return at(u, 0) - vec3(0, 0, 0.016f * (1 - t)); };
    s.sheet(across, 1, front, [](float, float) { return 0.75f; });
    return s.mesh;
}

// Monk and nun: a trough, and a tile over the joint of two troughs.
Mesh barrel(int lod) {
    const int across = lod == 0 ? 8 : 4;
    Solid s;
    // The cover lies in the cell's middle, half a trough on either side.
    auto cover = [](float u, float t) {
        const float c = 2 * u - 1, wide = 0.33f - 0.04f * t, y = 1.1f * t;
        return vec3(0.5f + wide * c, y, lie(y) + 0.012f + 0.085f * std::sqrt(std::max(0.0f, 1 - c * c * 0.98f)));
    };
    auto trough = [](float u, float t) {
        const float c = 2 * u - 1, y = 1.1f * t;
        return vec3(0.32f * c, y, lie(y) - 0.012f + 0.045f * c * c);
    };
    auto dark = [](float u, float) { return 0.62f + 0.25f * std::abs(2 * u - 1); };
    s.sheet(across, 1, cover);
    s.sheet(
        across, 1, [&](float u, float t) { return cover(u, 0) - vec3(0, 0, 0.02f * (1 - t)); },
        [](float, float) { return 0.7f; });
    s.sheet(across / 2, 1, trough, dark);
    s.sheet(
        across / 2, 1, [&](float u, float t) { return trough(u, t) + vec3(1, 0, 0); }, dark);
    return s.mesh;
}

// A sheet with an upright fold at its left.
Mesh seam(int lod) {
    constexpr float kHigh = 0.045f, kFlat = 0.012f;
    const float fold = 0.035f;
    Solid s;
    s.quad({0, 0, kFlat}, {1, 0, kFlat}, {1, 1, kFlat}, {0, 1, kFlat}, 0.95f);
    s.quad({0, 0, kFlat - 0.02f}, {1, 0, kFlat - 0.02f}, {1, 0, kFlat}, {0, 0, kFlat}, 0.8f);
    if (lod > 0) return s.quad({0, 0, kHigh}, {fold, 0, kHigh}, {fold, 1, kHigh}, {0, 1, kHigh}).mesh;
    return s.box({0, 0, 0}, {fold, 1, kHigh}).mesh;
}

// What shows where tiles have gone: a batten over a rafter, the dark of the loft behind. Its front lies just below the
// cells' plane.
Mesh batten() {
    Solid s;
    constexpr float kDeep = -0.13f, kRafter = -0.035f, kFront = -0.006f;
    s.quad({0, 0, kDeep}, {1, 0, kDeep}, {1, 1, kDeep}, {0, 1, kDeep}, 0.06f);
    s.box({0.42f, 0, kDeep}, {0.55f, 1, kRafter}, 0.5f);
    return s.box({0, 0.1f, kRafter}, {1, 0.3f, kFront}).mesh;
}

// Over a valley: two sheets that rise by half of Shape's thickness a side, folded up at their edges.
Mesh valley(int lod) {
    Solid s;
    for (float side : {-0.5f, 0.5f}) {
        const vec3 in(0, 0, 0), out(0, side, 1), along(1, 0, 0);
        if (side > 0)
            s.quad(in, in + along, out + along, out);
        else
            s.quad(out, out + along, in + along, in);
        if (lod > 0) continue;
        const vec3 low(0, side, 0.9f);
        s.quad(out, out + along, low + along, low, 0.7f);
    }
    return s.mesh;
}

}  // namespace

void addCoverings(RoofMeshes& out) {
    for (int lod : {0, 1}) {
        const std::string end = "_lod" + std::to_string(lod);
        out.all.push_back({"plain" + end, plain(lod), 0});
        out.all.push_back({"pan" + end, pan(lod), 0});
        out.all.push_back({"barrel" + end, barrel(lod), 0});
        out.all.push_back({"seam" + end, seam(lod), 1});
        out.all.push_back({"valley" + end, valley(lod), 1});
    }
    out.all.push_back({"batten_lod0", batten(), 1});
}

}  // namespace espalier::content
