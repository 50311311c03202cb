#pragma once

// Growth and terminals made on the CPU, so that emission and drawing are tested without grammar, walk or files.

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "runtime/emit/emit.hpp"
#include "shaders/emit/leaf_place.h"
#include "shaders/shared/random.h"

namespace espalier::test {

struct PlantData {
    std::vector<Node> nodes;
    std::vector<Chunk> chunks;
    std::vector<BranchRecord> branches;
    std::vector<Leaf> leaves;
    std::vector<SurfaceRef> surfaces;

    PlantData() {
        SurfaceRef surface{};
        surface.scale = 1;
        surface.toWorld[0] = {1, 0, 0, 0};
        surface.toWorld[1] = {0, 1, 0, 0};
        surface.toWorld[2] = {0, 0, 1, 0};
        surfaces.push_back(surface);
    }
    NodeBuf nodeBuf() { return {nodes.data()}; }
    ChunkBuf chunkBuf() { return {chunks.data()}; }
    SurfaceBuf surfaceBuf() { return {surfaces.data()}; }

    // One branch along points on a surface; it starts at node `from` (kNoIndex: a seed, whose foot is points[0],
    // else points begin after the joint). radius(s): s in [0, 1] along it. Returns its first node.
    uint32_t addBranch(const std::vector<glm::vec3>& points, const std::vector<glm::vec3>& normals, uint32_t from,
                       const std::function<float(float)>& radius, uint32_t smoothness = kSmoothC1) {
        const uint32_t branch = uint32_t(branches.size()), first = uint32_t(nodes.size());
        const uint32_t firstChunk = uint32_t(chunks.size());
        float arc = from == kNoIndex ? 0.0f : glm::distance(nodes[from].position, points[0]);
        for (size_t i = 0; i < points.size(); ++i) {
            if (i % kChunkNodes == 0) {
                Chunk chunk{};
                chunk.key = mix64(chunks.size() + 1);
                chunk.branch = branch;
                chunk.previousNode = i == 0 ? from : first + uint32_t(i) - 1;
                chunk.firstNode = first + uint32_t(i);
                chunks.push_back(chunk);
            }
            chunks.back().marks += 1u << 8;  // its number of nodes
            const glm::vec3 before = i > 0 ? points[i - 1] : from != kNoIndex ? nodes[from].position : points[0];
            const glm::vec3 after = i + 1 < points.size() ? points[i + 1] : points[i];
            if (i > 0) arc += glm::distance(before, points[i]);
            Node node{};
            node.position = points[i];
            node.normal = packOct(normals[i]);
            const glm::vec3 heading = segmentDirection(before, after);
            node.tangent = packOct(stemTangent(before, points[i], after, normals[i], heading));
            node.radius = radius(points.size() > 1 ? float(i) / float(points.size() - 1) : 0.0f);
            node.arc = arc;
            node.chunk = uint32_t(chunks.size()) - 1;
            node.flags = (uint32_t(i % kChunkNodes) << 8) | (smoothness << 15);
            if (i > 0 || from != kNoIndex) node.flags |= kNodeBark;
            if (i + 1 == points.size()) node.flags |= kNodeTip;
            nodes.push_back(node);
        }
        BranchRecord record{};
        record.extent = arc;
        record.thickness = 1;
        record.firstChunk = firstChunk;
        branches.push_back(record);
        return first;
    }

    void addLeaf(uint32_t node, uint32_t mesh, float size, float turn, float lift, uint32_t hash, float tint = 0.5f) {
        Leaf leaf;
        leaf.node = node;
        leaf.place = packLeafPlace(float(hash % 97) / 97.0f, mesh, size);
        leaf.pose = packLeafPose(turn, 0.2f, lift, size);
        leaf.tint = packLeafTint(tint, glm::vec3(1), hash);
        leaves.push_back(leaf);
    }
};

// A helix of `count` nodes around a cylinder with a leaf at every other one.
inline PlantData helix(uint32_t count, float radius = 0.5f) {
    PlantData plant;
    std::vector<glm::vec3> points, normals;
    for (uint32_t i = 0; i < count; ++i) {
        const float a = float(i) * 0.11f;
        normals.emplace_back(std::cos(a), 0, std::sin(a));
        points.push_back(normals.back() * radius + glm::vec3(0, float(i) * 0.012f, 0));
    }
    if (count == 0) return plant;
    plant.addBranch(points, normals, kNoIndex, [](float s) { return 0.012f * (1 - 0.7f * s); });
    for (uint32_t i = 1; i < count; i += 2)
        plant.addLeaf(i, 1, 0.05f, i % 4 == 1 ? 1.0f : -1.0f, 0.02f, i * 2654435761u >> 8);
    return plant;
}

// Ivy on the wall z = 0, y from 0 up: stems that wander upward, side shoots, leaves to both sides.
inline PlantData wallIvy(uint32_t stems, float width, float height, uint32_t seed = 1) {
    PlantData plant;
    std::mt19937 random(seed);
    auto uniform = [&](float low, float high) {
        return low + (high - low) * float(random() & 0xFFFFFF) / float(0x1000000);
    };
    struct Shoot {
        glm::vec2 at;
        float heading, length, thick;
        uint32_t from;
        int depth;
    };
    std::vector<Shoot> queue;
    for (uint32_t i = 0; i < stems; ++i)
        queue.push_back({{uniform(-width, width) * 0.5f, 0.0f},
                         1.57f + uniform(-0.3f, 0.3f),
                         height * uniform(0.6f, 1.0f),
                         0.012f,
                         kNoIndex,
                         0});
    const float step = 0.03f;
    for (size_t q = 0; q < queue.size(); ++q) {
        const Shoot shoot = queue[q];
        std::vector<glm::vec3> points, normals;
        glm::vec2 at = shoot.at;
        float heading = shoot.heading, drift = 0;
        const uint32_t first = uint32_t(plant.nodes.size());
        const int steps = std::max(2, int(shoot.length / step));
        for (int i = 0; i < steps; ++i) {
            if (i > 0 || shoot.depth > 0) {
                drift = 0.8f * drift + uniform(-0.16f, 0.16f);
                heading += drift + 0.04f * (1.57f - heading);
                at += step * glm::vec2(std::cos(heading), std::sin(heading));
            }
            points.emplace_back(at.x, at.y, 0.0f);
            normals.emplace_back(0, 0, 1);
            if (i > 2 && shoot.depth < 3 && uniform(0, 1) < 0.13f) {
                const float left = shoot.length - float(i) * step;
                queue.push_back({at, heading + uniform(0.4f, 0.9f) * (random() % 2 ? 1.0f : -1.0f),
                                 left * uniform(0.35f, 0.8f), shoot.thick * 0.65f, first + uint32_t(i),
                                 shoot.depth + 1});
            }
        }
        const float thick = shoot.thick;
        plant.addBranch(points, normals, shoot.from, [thick](float s) { return 0.0012f + thick * (1 - s); });
        for (uint32_t i = 0; i < points.size(); ++i) {
            const uint32_t node = first + i;
            const bool foot = points[i].y < 0.35f && uniform(0, 1) < 0.85f;
            if (!(plant.nodes[node].flags & kNodeBark) || foot) continue;
            const float size = uniform(0.055f, 0.10f) * (1.0f - 0.45f * float(i) / float(points.size()));
            plant.addLeaf(node, 1, size, (i % 2 ? 1.0f : -1.0f) * uniform(0.5f, 1.5f), uniform(0.005f, 0.055f),
                          random(), float(i) / float(points.size()));
        }
    }
    return plant;
}

// A tube of radius 1 along z.
inline void addTube(TerminalData& data, TerminalVariant& variant, uint32_t sides, uint32_t rings) {
    TerminalLod lod;
    lod.firstVertex = uint32_t(data.vertices.size());
    lod.firstIndex = uint32_t(data.indices.size());
    for (uint32_t r = 0; r < rings; ++r)
        for (uint32_t s = 0; s <= sides; ++s) {
            const float a = 6.2831853f * float(s) / float(sides);
            const glm::vec3 n(std::cos(a), std::sin(a), 0);
            data.vertices.push_back(
                {{n.x, n.y, float(r) / float(rings - 1)}, packOct(n), {float(s) / float(sides), 0}});
        }
    for (uint32_t r = 0; r + 1 < rings; ++r)
        for (uint32_t s = 0; s < sides; ++s) {
            const uint32_t a = r * (sides + 1) + s, c = a + sides + 1;
            for (uint32_t i : {a, a + 1, c, a + 1, c + 1, c}) data.indices.push_back(i);
        }
    lod.vertexCount = uint32_t(data.vertices.size()) - lod.firstVertex;
    lod.indexCount = uint32_t(data.indices.size()) - lod.firstIndex;
    variant.lods.push_back(lod);
}

// A folded blade along y, `rows` quads on each side of the midrib.
inline void addBlade(TerminalData& data, TerminalVariant& variant, uint32_t rows) {
    TerminalLod lod;
    lod.firstVertex = uint32_t(data.vertices.size());
    lod.firstIndex = uint32_t(data.indices.size());
    for (uint32_t r = 0; r <= rows; ++r)
        for (int s = -1; s <= 1; ++s) {
            const float y = float(r) / float(rows), half = 0.45f * std::sin(3.1f * std::min(y + 0.03f, 1.0f));
            data.vertices.push_back({{float(s) * half, y, 0.15f * std::abs(float(s)) * half - 0.2f * y * y},
                                     packOct({0, 0, 1}),
                                     {0.5f + 0.5f * float(s), y}});
        }
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t s = 0; s < 2; ++s) {
            const uint32_t a = r * 3 + s;
            for (uint32_t i : {a, a + 1, a + 4, a, a + 4, a + 3}) data.indices.push_back(i);
        }
    lod.vertexCount = uint32_t(data.vertices.size()) - lod.firstVertex;
    lod.indexCount = uint32_t(data.indices.size()) - lod.firstIndex;
    variant.lods.push_back(lod);
}

// A unit square of quads × quads, whose columns of vertices stand `height` above and below it in turn.
inline void addSquare(TerminalData& data, TerminalVariant& variant, uint32_t quads, float height = 0,
                      uint32_t material = 0) {
    TerminalLod lod;
    lod.firstVertex = uint32_t(data.vertices.size());
    lod.firstIndex = uint32_t(data.indices.size());
    lod.material = material;
    for (uint32_t y = 0; y <= quads; ++y)
        for (uint32_t x = 0; x <= quads; ++x)
            data.vertices.push_back(
                {{float(x) / float(quads), float(y) / float(quads), x % 2 ? height : -height}, 0, {}});
    for (uint32_t i = 0; i < quads * quads; ++i) {
        const uint32_t a = i / quads * (quads + 1) + i % quads, c = a + quads + 1;
        for (uint32_t k : {a, a + 1, c + 1, a, c + 1, c}) data.indices.push_back(k);
    }
    lod.vertexCount = uint32_t(data.vertices.size()) - lod.firstVertex;
    lod.indexCount = uint32_t(data.indices.size()) - lod.firstIndex;
    variant.lods.push_back(lod);
}

inline TerminalData simpleTerminals() {
    TerminalData data;
    data.kinds = standardTerminalKinds();
    data.materials.resize(1);
    data.materials[0].baseColor = {0.2f, 0.4f, 0.1f, 1};
    TerminalVariant bark{"bark", 0, {}}, leafA{"leaf_a", 1, {}}, leafB{"leaf_b", 1, {}}, pebble{"pebble", 2, {}};
    for (auto [sides, rings] : {std::pair{12u, 10u}, {8u, 6u}, {6u, 4u}, {4u, 2u}}) addTube(data, bark, sides, rings);
    for (uint32_t rows : {6u, 3u, 1u}) addBlade(data, leafA, rows);
    for (uint32_t rows : {5u, 2u}) addBlade(data, leafB, rows);
    addBlade(data, pebble, 1);
    data.variants = {bark, leafA, leafB, pebble};
    measureTerminalErrors(data);
    return data;
}

// A plant in GPU buffers.
struct Plant {
    Buffer nodes, chunks, branches, leaves, surfaces;
    GrowthView view;
    SurfaceBuf surfaceBuf{};
    // To be culled by shaders, as on other devices.
    EmitInputs inputs() const {
        EmitInputs given{view, surfaceBuf};
        given.native = false;
        return given;
    }
};

inline Plant upload(Device& device, const PlantData& data) {
    static uint64_t revision = 0;
    auto make = [&](const char* name, const auto& values) {
        auto buffer = makeBuffer(device, name, values);
        return std::move(buffer.value());
    };
    Plant plant{make("nodes", data.nodes),
                make("chunks", data.chunks),
                make("branches", data.branches),
                make("leaves", data.leaves),
                make("surfaces", data.surfaces),
                {},
                {}};
    plant.view.nodes.v = reinterpret_cast<Node*>(plant.nodes.address());
    plant.view.chunks.v = reinterpret_cast<Chunk*>(plant.chunks.address());
    plant.view.branches.v = reinterpret_cast<BranchRecord*>(plant.branches.address());
    plant.view.leaves.v = reinterpret_cast<Leaf*>(plant.leaves.address());
    plant.view.nodeCount = uint32_t(data.nodes.size());
    plant.view.chunkCount = uint32_t(data.chunks.size());
    plant.view.branchCount = uint32_t(data.branches.size());
    plant.view.leafCount = uint32_t(data.leaves.size());
    plant.view.revision = ++revision;
    plant.surfaceBuf.v = reinterpret_cast<SurfaceRef*>(plant.surfaces.address());
    return plant;
}

}  // namespace espalier::test
