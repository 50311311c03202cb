// Painted layers over a town's site, seen from above: what rules read of them, and which cells they take away.
#ifndef ESPALIER_SHARED_ROOF_LAYERS_H
#define ESPALIER_SHARED_ROOF_LAYERS_H
#include "shaders/shared/exact.h"
#include "shaders/shared/roof_records.h"

ESPALIER_BEGIN

// The layer's value at a place of the plan, world x and z: bilinear, its fill where nothing is painted.
FN float roofLayerAt(RoofLayerBuf layers, RoofSite site, uint layer, vec2 at) {
    float value = layers.v[layer].fill;
    FloatBuf texels = layers.v[layer].texels;
    if (IS_GIVEN(texels)) {
        float most = float(site.size) - 1.0f;
        float gx = limited((at.x - site.low.x) * site.perMetre - 0.5f, 0.0f, most);
        float gy = limited((at.y - site.low.y) * site.perMetre - 0.5f, 0.0f, most);
        uint x = uint(gx);
        uint y = uint(gy);
        uint x1 = x + 1u < site.size ? x + 1u : x;
        uint y1 = y + 1u < site.size ? y + 1u : y;
        float fx = gx - float(x);
        float fy = gy - float(y);
        float low = texels.v[y * site.size + x] * (1.0f - fx) + texels.v[y * site.size + x1] * fx;
        float high = texels.v[y1 * site.size + x] * (1.0f - fx) + texels.v[y1 * site.size + x1] * fx;
        value = low * (1.0f - fy) + high * fy;
    }
    return value;
}

FN uint roofCellHash(u64 key, uint column, uint row) {
    uint h = uint(key) ^ (column * 0x9E3779B1u) ^ (row * 0x85EBCA77u);
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12u)) * 0x297A2D39u;
    return h ^ (h >> 15u);
}
// A cell is gone where its layer is painted more than this, 0 to below 1: each has a chance of its own and shares one
// with its neighbours, so that holes grow together.
FN float cellHold(u64 key, uint column, uint row) {
    uint own = roofCellHash(key, column, row) & 0xFFFFu;
    uint shared_ = roofCellHash(key, column >> 2u | 0x8000u, row / 3u) & 0xFFFFu;
    return float(own + shared_) * 7.62939453e-6f;   // 2^-17
}

// From the house's plot to the world, in the plan.
FN vec2 plotOf(RoofEnv env, uint house) { return env.plots.v[house & 0xFFFFFFu].at; }

// False for a grid that no layer takes cells from.
FN bool mayDrop(RoofEnv env, RoofGrid g) {
    uint layer = (g.mesh >> kGridDrop) & 15u;
    if (layer == 0u || layer > kRoofLayers) return false;
    return IS_GIVEN(env.layers.v[layer - 1u].texels) || env.layers.v[layer - 1u].fill > 0.0f;
}
FN bool cellDropped(RoofEnv env, RoofGrid g, uint column, uint row) {
    float shift = (g.mesh & kGridBond) != 0u && (row & 1u) != 0u ? 0.0f : 0.5f;
    vec3 p = g.origin + g.axisX * ((float(column) + shift) * g.step.x) + g.axisY * ((float(row) + 0.5f) * g.step.y);
    return roofLayerAt(env.layers, env.site, ((g.mesh >> kGridDrop) & 15u) - 1u, vec2(p.x, p.z) + plotOf(env, g.house)) >
           cellHold(g.key, column, row);
}

ESPALIER_END
#endif
