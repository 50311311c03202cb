// Leaf meshes that follow the lobes. In: variant and level of detail. Out: a folded, drooping blade on an arched
// stalk, 35, 10, 4 triangles and one.

#include <algorithm>
#include <cmath>

#include "tools/content/delaunay.hpp"
#include "tools/content/leaf.hpp"
#include "tools/content/leaf_shape.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

// Where a point of the flat leaf is in space: the stalk rises, the blade folds along its midrib, its sides and tips
// droop, and its rim waves a little.
glm::vec3 shapeLeaf(int variant, float base, glm::vec2 p) {
    static const float kFold[] = {0.22f, 0.12f, 0.30f, 0.20f, 0.26f, 0.16f};
    static const float kDroop[] = {0.34f, 0.42f, 0.28f, 0.30f, 0.38f, 0.06f};
    float t = saturate(p.y / base);
    float rise = 0.13f * (1 - (1 - t) * (1 - t));
    glm::vec2 q = p - glm::vec2(0, base);
    float x = std::abs(q.x), up = std::max(q.y, 0.0f);
    float z = rise + kFold[variant] * x - 0.55f * x * x - kDroop[variant] * up * up - 0.10f * std::max(-q.y, 0.0f);
    z += 0.025f * std::sin(q.x * 7.0f + static_cast<float>(variant)) * saturate(x * 4);
    // Length is kept: what goes into height is taken from the run.
    return {p.x * (1 - 0.10f * x), p.y - 0.10f * up * up, z};
}

struct Flat {
    std::vector<glm::vec2> points;
    std::vector<std::array<uint32_t, 3>> triangles;
    float stretch = 1;  // of x against the picture
};

float turn(glm::vec2 a, glm::vec2 b, glm::vec2 c) {
    return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
}

// The fine outline reduced to `keep` points: repeatedly drops the point whose removal changes least. Where the
// outline is hollow that adds area, where it bulges the neighbours are pushed out so that nothing is cut off.
std::vector<glm::vec2> reduceOutline(std::vector<glm::vec2> line, size_t keep) {
    while (line.size() > keep) {
        size_t best = 0;
        float least = 1e9f;
        for (size_t i = 1; i < line.size(); ++i) {
            glm::vec2 a = line[i - 1], b = line[i], c = line[(i + 1) % line.size()];
            float cost = turn(a, b, c);
            cost = cost > 0 ? cost * 1.7f : -cost;
            if (cost < least) {
                least = cost;
                best = i;
            }
        }
        line.erase(line.begin() + static_cast<long>(best));
    }
    return line;
}

// Pushes vertices outwards until the polygon holds the fine outline.
void growOver(std::vector<glm::vec2>& polygon, const std::vector<glm::vec2>& fine) {
    for (int round = 0; round < 40; ++round) {
        bool grown = false;
        for (glm::vec2 p : fine) {
            std::vector<std::vector<glm::dvec2>> loops{{polygon.begin(), polygon.end()}};
            if (insideLoops(loops, p)) continue;
            size_t edge = 0;
            float nearest = 1e9f;
            for (size_t i = 0; i < polygon.size(); ++i) {
                glm::vec2 a = polygon[i], d = polygon[(i + 1) % polygon.size()] - a;
                float distance = glm::distance(p, a + d * saturate(glm::dot(p - a, d) / glm::dot(d, d)));
                if (distance < nearest) {
                    nearest = distance;
                    edge = i;
                }
            }
            if (nearest < 1e-3f) continue;
            glm::vec2 a = polygon[edge], b = polygon[(edge + 1) % polygon.size()];
            glm::vec2 out = glm::normalize(glm::vec2(b.y - a.y, a.x - b.x)) * (nearest * 0.5f);
            polygon[edge] += out;
            polygon[(edge + 1) % polygon.size()] += out;
            grown = true;
        }
        if (!grown) return;
    }
}

// Full detail: the outline in 25 points and four along the midrib.
Flat fineLeaf(const LeafShape& shape) {
    Flat flat;
    std::vector<glm::vec2> rim = reduceOutline(shape.outline, 25);
    growOver(rim, shape.outline);
    glm::vec2 middle(0, shape.base + 0.3f * (1 - shape.base));
    for (glm::vec2& p : rim) p += glm::normalize(p - middle) * 0.008f;
    flat.points = rim;
    for (float f : {0.12f, 0.38f, 0.66f}) flat.points.push_back({0, glm::mix(shape.base, 1.0f, f)});
    std::vector<std::vector<glm::dvec2>> loops{{rim.begin(), rim.end()}};
    std::vector<glm::dvec2> points(flat.points.begin(), flat.points.end());
    for (auto& t : delaunay(points))
        if (insideLoops(loops, (points[t[0]] + points[t[1]] + points[t[2]]) / 3.0)) flat.triangles.push_back(t);
    return flat;
}

// The outline in `corners` points about one inside; the stalk is added apart.
Flat middleLeaf(const LeafShape& shape, size_t corners) {
    Flat flat;
    flat.points = reduceOutline(shape.outline, corners);
    growOver(flat.points, shape.outline);
    uint32_t count = static_cast<uint32_t>(flat.points.size());
    flat.points.push_back({0, glm::mix(shape.base, 1.0f, 0.16f)});
    for (uint32_t i = 0; i < count; ++i) flat.triangles.push_back({count, i, (i + 1) % count});
    return flat;
}

// Four triangles about the foot of the blade, with a little of the stalk.
Flat farLeaf(const LeafShape& shape) {
    float low = 1, tip = 0, side = 0, foot = 0;
    for (glm::vec2 p : shape.outline) {
        low = std::min(low, p.y);
        tip = std::max(tip, p.y);
    }
    for (glm::vec2 p : shape.outline) {
        if (std::abs(p.x) > std::abs(side)) side = p.x;
        if (p.y < low + 0.12f) foot = std::max(foot, std::abs(p.x));
    }
    float width = std::abs(side), height = 0;
    for (glm::vec2 p : shape.outline)
        if (p.x == side) height = p.y;
    Flat flat;
    flat.points = {{0, shape.base * 0.3f},   {foot, low}, {width * 1.02f, height}, {0, tip + 0.01f},
                   {-width * 1.02f, height}, {-foot, low}};
    flat.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    return flat;
}

// A triangle about nearly all of the blade, within its picture; wider by the share that it cuts off.
Flat triangleLeaf(int variant) {
    static const glm::vec2 kSide[] = {{0.55f, 0.14f}, {0.56f, 0.20f}, {0.53f, 0.09f}};
    static const float kTip[] = {1.05f, 1.025f, 1.0f}, kStretch[] = {1.09f, 1.06f, 1.05f};
    const glm::vec2 side = kSide[variant];
    return {{{-side.x, side.y}, side, {0, kTip[variant]}}, {{0, 1, 2}}, kStretch[variant]};
}

void addStalk(Mesh& mesh, int variant, const LeafShape& shape, uint32_t rings) {
    float half = kStalkHalfWidth * 1.6f;
    uint32_t first = static_cast<uint32_t>(mesh.positions.size());
    for (uint32_t r = 0; r < rings; ++r) {
        float y = shape.base * 1.05f * static_cast<float>(r) / static_cast<float>(rings - 1);
        for (float side : {-1.0f, 1.0f}) {
            glm::vec2 p(side * half, y);
            mesh.positions.push_back(shapeLeaf(variant, shape.base, {0, y}) + glm::vec3(side * half, 0, -0.004f));
            mesh.uvs.push_back(leafUv(variant, p));
        }
    }
    for (uint32_t r = 0; r + 1 < rings; ++r) {
        uint32_t a = first + 2 * r;
        for (uint32_t v : {a, a + 1, a + 3, a, a + 3, a + 2}) mesh.indices.push_back(v);
    }
}

void smoothNormals(Mesh& mesh) {
    std::vector<glm::vec3> sum(mesh.positions.size(), glm::vec3(0));
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
        glm::vec3 n = glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        for (uint32_t v : {a, b, c}) sum[v] += n;
    }
    for (glm::vec3 n : sum) mesh.normals.push_back(glm::normalize(n));
}

}  // namespace

namespace {

Mesh bent(int variant, const LeafShape& shape, const Flat& flat, uint32_t stalkRings) {
    Mesh mesh;
    for (glm::vec2 p : flat.points) {
        mesh.positions.push_back(shapeLeaf(variant, shape.base, {p.x * flat.stretch, p.y}));
        mesh.uvs.push_back(leafUv(variant, p));
    }
    for (auto& t : flat.triangles)
        for (uint32_t v : t) mesh.indices.push_back(v);
    if (stalkRings > 0) addStalk(mesh, variant, shape, stalkRings);
    smoothNormals(mesh);
    return mesh;
}

}  // namespace

Mesh makeLeaf(int variant, int lod) {
    LeafShape shape = leafShape(variant);
    Flat flat = lod == 0   ? fineLeaf(shape)
                : lod == 1 ? middleLeaf(shape, 8)
                : lod == 2 ? farLeaf(shape)
                           : triangleLeaf(variant);
    return bent(variant, shape, flat, lod == 0 ? 4 : lod == 1 ? 2 : 0);
}

Mesh makeFlora(int form, int lod) {
    static const size_t kCorners[] = {16, 8, 5};
    const LeafShape shape = leafShape(form);
    return bent(form, shape, middleLeaf(shape, kCorners[lod]), lod == 0 ? 4 : lod == 1 ? 2 : 0);
}

Mesh makeTuft(int lod) {
    static const int kCards[] = {3, 2, 1};
    Mesh mesh;
    for (int card = 0; card < kCards[lod]; ++card) {
        const float turn = kPi * static_cast<float>(card) / static_cast<float>(kCards[lod]);
        const glm::vec3 side(std::cos(turn), 0, std::sin(turn)), out(-side.z, 0, side.x);
        const uint32_t first = static_cast<uint32_t>(mesh.positions.size());
        for (glm::vec2 p :
             {glm::vec2(-0.55f, 0), glm::vec2(0.55f, 0), glm::vec2(0.55f, 1.02f), glm::vec2(-0.55f, 1.02f)}) {
            mesh.positions.push_back(side * p.x + glm::vec3(0, p.y, 0));
            mesh.normals.push_back(glm::normalize(glm::vec3(0, 1, 0) + 0.35f * p.x * side + 0.15f * out));
            mesh.uvs.push_back(leafUv(kTuft, p));
        }
        for (uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
    }
    return mesh;
}

}  // namespace espalier::content
