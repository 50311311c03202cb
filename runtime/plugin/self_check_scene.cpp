#include "runtime/plugin/self_check_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/roof/shapes.hpp"
#include "shaders/shared/exact.h"
#include "shaders/shared/random.h"

namespace espalier::selfcheck {
namespace {

constexpr uint32_t kSize = 64;                      // texels a side
constexpr uint32_t kSide = 24, kRow = 20;           // of a chart: texels a side, its first row
constexpr std::array<uint32_t, 2> kColumns{4, 36};  // their first columns
constexpr float kTexel = 1.0f / float(kSize);

// A chart is a square of texels and a square of one metre.
struct Sheet {
    glm::vec3 position, right, up, normal;  // at the chart's corner of least u and v, for u, for v
};
constexpr std::array<Sheet, 2> kSheets{{
    {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
}};

glm::vec2 cornerOf(size_t chart) {
    return glm::vec2(kColumns[chart], kRow) * kTexel;
}
constexpr float kUvSide = float(kSide) * kTexel;

glm::vec3 placeAt(size_t chart, glm::vec2 uv) {
    const Sheet& s = kSheets[chart];
    const glm::vec2 at = (uv - cornerOf(chart)) / kUvSide;
    return s.position + s.right * at.x + s.up * at.y;
}

void addCharts(SurfaceData& data) {
    for (size_t c = 0; c < 2; ++c) {
        const Sheet& s = kSheets[c];
        const glm::vec2 low = cornerOf(c), high = low + kUvSide;
        const glm::vec3 du = s.right / kUvSide, dv = s.up / kUvSide;
        const glm::vec2 lowRight(high.x, low.y), highLeft(low.x, high.y);
        data.charts.push_back({low, high, 1, 0, 1, 1 / kUvSide, uint32_t(data.triangles.size()), 2});
        data.triangles.push_back({s.position, du, dv, low, uint32_t(c), lowRight, high});
        data.triangles.push_back({s.position, du, dv, low, uint32_t(c), high, highLeft});
    }
}

// Each chart's borders, its inside to their left; the floor's far border and the wall's foot are one edge.
void addCrossings(SurfaceData& data) {
    for (uint32_t c = 0; c < 2; ++c) {
        const glm::vec2 low = cornerOf(c), high = low + kUvSide;
        const std::array<glm::vec2, 5> corners{low, {high.x, low.y}, high, {low.x, high.y}, low};
        for (uint32_t side = 0; side < 4; ++side) {
            const bool seam = side == (c == 0 ? 2u : 0u);
            const glm::vec2 a = corners[side], b = corners[side + 1];
            const glm::vec2 shift = cornerOf(1 - c) - low + glm::vec2(0, c == 0 ? -kUvSide : kUvSide);
            Crossing crossing{};
            crossing.a = crossing.ta = a;
            crossing.b = crossing.tb = b;
            crossing.edge = crossing.targetEdge = packOct(glm::normalize(placeAt(c, b) - placeAt(c, a)));
            crossing.target = 0xFFFF0000u | (seam ? 1 - c : c);
            crossing.flags = (seam ? kCrossingSeam : kCrossingOpen) | kCrossingInsideLeft | c << 16;
            if (seam) crossing.ta += shift, crossing.tb += shift;
            data.crossings.push_back(crossing);
        }
    }
}

// The chart at whose square, grown by `gutter` texels, a texel lies; 2: none.
size_t chartAt(uint32_t x, uint32_t y, uint32_t gutter) {
    for (size_t c = 0; c < 2; ++c)
        if (x + gutter >= kColumns[c] && x < kColumns[c] + kSide + gutter && y + gutter >= kRow &&
            y < kRow + kSide + gutter)
            return c;
    return 2;
}

uint32_t bitsOf(size_t chart, uint32_t x, uint32_t y) {
    const uint32_t x0 = kColumns[chart], x1 = x0 + kSide - 1, y0 = kRow, y1 = y0 + kSide - 1;
    const uint32_t seamRow = chart == 0 ? y1 : y0;
    const uint32_t fromSeam = std::max(y, seamRow) - std::min(y, seamRow);
    if (chartAt(x, y, 0) == chart) {
        const uint32_t clear = std::min({x - x0, x1 - x, y - y0, y1 - y, 31u});
        return packTexelBits(uint32_t(chart), kTexelInner, fromSeam < 2, clear, 0);
    }
    const bool beyondSeam = x >= x0 && x <= x1 && (chart == 0 ? y > y1 : y < y0);
    return packTexelBits(uint32_t(chart), beyondSeam ? kTexelLink : kTexelOpen, fromSeam < 2, 0, 0);
}

void addLevel(SurfaceData& data) {
    SurfaceLevelData level;
    level.size = kSize;
    level.texels.assign(kSize * kSize, Texel{});
    level.aux.assign(kSize * kSize, TexelAux{0, kNoIndex});
    level.crossingHead.assign(kSize * kSize, 0);
    for (uint32_t at = 0; at < kSize * kSize; ++at) {
        const uint32_t x = at % kSize, y = at / kSize, i = texelIndex(kSize, x, y);
        const size_t chart = chartAt(x, y, 2);
        if (chart < 2) {
            const glm::vec2 local = glm::vec2(x, y) - glm::vec2(kColumns[chart], kRow);
            level.texels[i] = {placeAt(chart, (glm::vec2(x, y) + .5f) * kTexel), bitsOf(chart, x, y)};
            level.aux[i] = {packOct(kSheets[chart].normal),
                            data.charts[chart].firstTriangle + (local.y > local.x ? 1u : 0u)};
        }
        const glm::vec2 low = (glm::vec2(x, y) - .01f) * kTexel, high = (glm::vec2(x, y) + 1.01f) * kTexel;
        const uint32_t first = uint32_t(level.crossingRefs.size());
        for (uint32_t c = 0; c < data.crossings.size(); ++c) {
            const glm::vec2 from = glm::min(data.crossings[c].a, data.crossings[c].b);
            const glm::vec2 to = glm::max(data.crossings[c].a, data.crossings[c].b);
            if (glm::all(glm::lessThanEqual(from, high)) && glm::all(glm::greaterThanEqual(to, low)))
                level.crossingRefs.push_back(c);
        }
        level.crossingHead[i] = first << 8 | (uint32_t(level.crossingRefs.size()) - first);
    }
    data.levels.push_back(std::move(level));
}

void addMesh(SurfaceData& data) {
    for (size_t c = 0; c < 2; ++c) {
        const uint32_t first = uint32_t(data.vertices.size());
        for (int i = 0; i < 4; ++i) {
            const glm::vec2 at = cornerOf(c) + glm::vec2(i & 1, i >> 1) * kUvSide;
            data.vertices.push_back({placeAt(c, at), kSheets[c].normal, glm::vec4(kSheets[c].right, 1), at, at});
        }
        for (uint32_t i : {0u, 1u, 3u, 0u, 3u, 2u}) data.indices.push_back(first + i);
    }
    data.materials.resize(1);
    data.materials[0].baseColor = {.5f, .5f, .5f, 1};
    data.ranges.push_back({0, uint32_t(data.indices.size()), 0});
}

constexpr std::string_view kPlant = R"(
context mask = 1 "Where the plant grows"
Plant(l) : arc >= 1.2 -> NULL
Plant(l) : rand() < 0.3 -> Branch(2) {Step(l), Twig(l * 0.5)}
Plant(l) -> Step(l)
Step(l) -> Marching(0.05, clamp(angleTo(up) * 0.3, -0.3, 0.3) + rand(-0.2, 0.2), mask(texCoord) > 0.5) {Plant(l), Wood Foliage}
Twig(l) : arc >= 0.3 -> NULL
Twig(l) -> Marching(0.04, rand(-0.5, 0.5), mask(texCoord) > 0.5) {Twig(l), Wood Foliage}
Wood -> S(mix(0.004, 0.02, min(1, toTip))) Shape("bark", C1)
Foliage -> Repeat(every(0.04)) {Leaf}
Leaf -> S(0.06) T(rand(), 0.02) R(angleTo(down) + rand(-1, 1), 0.3) Shape("leaf")
)";

constexpr std::string_view kRoof = R"(
House -> Extrude(wallHeight) {Wall, TopWall}
TopWall -> Join(roofHeight, roofPos1, roofPos2) {Cover, Joints, NULL}
Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}
Joints -> Explode() {NULL, NULL, Cap, Cap, Cap}
Cap : owner == 1 -> Repeat(X, 0.4) {Tile}
Cap -> NULL
Wall -> Repeat(XY, vec2(2, 2.5)) {Window}
Window -> T(0.4, 0.6, 0.01) S(1, 1.2, 0.05) Tile
Tile -> Shape("tile")
)";

// The mesh of all vertices and indices from these on.
void addVariant(TerminalData& data, const char* name, uint32_t kind, uint32_t firstVertex, uint32_t firstIndex) {
    TerminalLod lod;
    lod.firstVertex = firstVertex;
    lod.firstIndex = firstIndex;
    lod.vertexCount = uint32_t(data.vertices.size()) - firstVertex;
    lod.indexCount = uint32_t(data.indices.size()) - firstIndex;
    data.variants.push_back({name, kind, {lod}});
}

void addQuad(TerminalData& data, const char* name, uint32_t kind, glm::vec3 corner, glm::vec3 right, glm::vec3 up) {
    const uint32_t vertex = uint32_t(data.vertices.size()), index = uint32_t(data.indices.size());
    const uint32_t normal = packOct(glm::normalize(glm::cross(right, up)));
    for (int i = 0; i < 4; ++i) {
        const glm::vec2 at(i & 1, i >> 1);
        data.vertices.push_back({corner + right * at.x + up * at.y, normal, at});
    }
    for (uint32_t i : {0u, 1u, 3u, 0u, 3u, 2u}) data.indices.push_back(i);
    addVariant(data, name, kind, vertex, index);
}

}  // namespace

SurfaceData step() {
    SurfaceData data;
    data.source = "self-check";
    addCharts(data);
    addCrossings(data);
    addLevel(data);
    addMesh(data);
    data.boundsMin = {0, 0, 0};
    data.boundsMax = {1, 1, 1};
    data.hash = walkHash(data);
    return data;
}

std::vector<Seed> seedsOnFloor(uint32_t count) {
    std::vector<Seed> seeds(count);
    for (uint32_t i = 0; i < count; ++i) {
        Seed& seed = seeds[i];
        seed.key = mix64(i + 1);
        seed.walk.place = 0;
        seed.walk.uv = cornerOf(0) + glm::vec2((float(i) + .5f) / float(count), .5f) * kUvSide;
        seed.walk.direction = {0, 0, -1};
    }
    return seeds;
}

Result<RuleMap> plantRules() {
    return compileGrammar(kPlant, {.fileName = "self-check"});
}

TerminalData plantMeshes() {
    TerminalData data;
    data.kinds = standardTerminalKinds();
    data.materials.resize(1);
    data.materials[0].baseColor = {.2f, .4f, .1f, 1};
    constexpr uint32_t kSides = 4;
    for (uint32_t ring = 0; ring < 2; ++ring)
        for (uint32_t side = 0; side <= kSides; ++side) {
            const glm::vec3 n = side % 4 == 0   ? glm::vec3(1, 0, 0)
                                : side % 4 == 1 ? glm::vec3(0, 1, 0)
                                : side % 4 == 2 ? glm::vec3(-1, 0, 0)
                                                : glm::vec3(0, -1, 0);
            data.vertices.push_back({{n.x, n.y, float(ring)}, packOct(n), {float(side) / kSides, 0}});
        }
    for (uint32_t side = 0; side < kSides; ++side)
        for (uint32_t i : {side, side + 1, side + kSides + 1, side + 1, side + kSides + 2, side + kSides + 1})
            data.indices.push_back(i);
    addVariant(data, "bark", kMeshBark, 0, 0);
    addQuad(data, "leaf", kMeshLeaf, {-.5f, 0, 0}, {1, 0, 0}, {0, 1, 0});
    return data;
}

RoofTables house() {
    Footprint footprint;
    footprint.id = "self-check";
    footprint.rings = {{{0, 0}, {8, 0}, {8, 5}, {0, 5}}};
    footprint.levels = 1;
    std::vector<Diagnostic> said;
    return makeAtoms(roofOf(footprint, said));
}

Result<RuleMap> roofRules() {
    return compileGrammar(kRoof, {.fileName = "self-check", .meshes = {{"none", false}, {"tile", false}}});
}

TerminalData roofTiles() {
    TerminalData data;
    data.kinds = {"none", "tile"};
    data.materials.resize(1);
    data.materials[0].baseColor = {.5f, .2f, .1f, 1};
    addQuad(data, "tile", 1, {0, 0, .02f}, {1, 0, 0}, {0, 1, .03f});
    return data;
}

}  // namespace espalier::selfcheck
