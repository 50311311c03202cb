// In: a flattened patch and its tangled vertices. Out: the same with the vertices around them spread evenly: each in
// the middle of its neighbours, which within a convex border leaves no triangle turned over (Tutte). Holes count as if
// they were filled by a vertex in their middle.
#include "tools/bake/atlas.hpp"

namespace espalier::bakery {
namespace {

constexpr int kUntanglings = 60;

}  // namespace

void untangle(Patch& patch, const std::vector<uint32_t>& tangled, int rings) {
    constexpr uint8_t kFixed = 0, kFree = 1;
    std::vector<uint8_t> state(patch.point.size(), kFixed);
    for (uint32_t v : tangled) state[v] = kFree;
    std::vector<std::vector<uint32_t>> loops = borderLoops(patch);
    auto vertexOf = [&](uint32_t h) { return patch.corner[h / 3][h % 3]; };
    for (int ring = 0; ring < rings; ++ring) {
        std::vector<uint8_t> before = state;
        for (const auto& c : patch.corner)
            if (before[c[0]] || before[c[1]] || before[c[2]]) state[c[0]] = state[c[1]] = state[c[2]] = kFree;
        // A hole is moved as a whole.
        for (size_t l = 1; l < loops.size(); ++l) {
            bool any = false;
            for (uint32_t h : loops[l]) any = any || state[vertexOf(h)];
            for (uint32_t h : loops[l])
                if (any) state[vertexOf(h)] = kFree;
        }
    }
    for (uint32_t h : loops[0]) state[vertexOf(h)] = kFixed;
    // Neighbours of free vertices.
    std::vector<uint32_t> place(patch.point.size(), kNone), free;
    for (uint32_t v = 0; v < state.size(); ++v)
        if (state[v] == kFree) place[v] = uint32_t(free.size()), free.push_back(v);
    std::vector<std::vector<uint32_t>> around(free.size());
    for (const auto& c : patch.corner)
        for (size_t k = 0; k < 3; ++k)
            if (place[c[k]] != kNone) {
                around[place[c[k]]].push_back(c[(k + 1) % 3]);
                around[place[c[k]]].push_back(c[(k + 2) % 3]);
            }
    for (size_t l = 1; l < loops.size(); ++l) {
        if (state[vertexOf(loops[l][0])] != kFree) continue;
        uint32_t middle = uint32_t(patch.uv.size());
        patch.uv.push_back(glm::dvec2(0));
        around.emplace_back();
        free.push_back(middle);
        for (uint32_t h : loops[l]) {
            patch.uv[middle] += patch.uv[vertexOf(h)] / double(loops[l].size());
            around.back().push_back(vertexOf(h));
            // As often as another neighbour.
            if (place[vertexOf(h)] != kNone)
                around[place[vertexOf(h)]].insert(around[place[vertexOf(h)]].end(), 2, middle);
        }
    }
    for (int sweep = 0; sweep < kUntanglings; ++sweep)
        for (size_t i = 0; i < free.size(); ++i) {
            glm::dvec2 sum(0);
            for (uint32_t n : around[i]) sum += patch.uv[n];
            patch.uv[free[i]] = sum / double(around[i].size());
        }
    patch.uv.resize(patch.point.size());
}

}  // namespace espalier::bakery
