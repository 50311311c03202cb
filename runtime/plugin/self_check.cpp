// Each step compares what the device made with something that the device had no part in: the CPU reference, what
// follows from its counts, colours that were written down.
#include "runtime/plugin/self_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "runtime/expand/cpu_growth.hpp"
#include "runtime/expand/growth.hpp"
#include "runtime/gpu/commands.hpp"
#include "runtime/plugin/self_check_picture.hpp"
#include "runtime/plugin/self_check_scene.hpp"
#include "runtime/render/renderer.hpp"
#include "runtime/roof_growth/roof_growth.hpp"
#include "runtime/surface/gpu_surface.hpp"

namespace espalier {
namespace {

constexpr uint32_t kSeeds = 12;  // more than a subgroup of 8 holds
constexpr GrowthRoom kRoom{.chunks = 512, .nodes = 4096, .branches = 512, .leaves = 4096, .items = 512};
constexpr uint32_t kPixels = 64;  // a side of the picture

// What the plant grows from and what has grown.
struct Plant {
    RuleMap rules;
    SurfaceData surface;
    GpuSurface gpuSurface;
    Buffer words, surfaces, layers;
    std::unique_ptr<Growth> growth;
    uint32_t spans = 0, leaves = 0;  // by the CPU reference

    SurfaceBuf surfaceTable() const { return addressOf<SurfaceBuf>(surfaces); }
};

const std::vector<LayerRef>& bareLayers() {
    static const std::vector<LayerRef> layers(kMaxLayers, LayerRef{{nullptr}, 0, 1});
    return layers;
}

GrowthInputs inputsOf(const std::vector<Seed>& seeds, const RuleMapRef& rules) {
    GrowthInputs inputs;
    inputs.surfaceCount = 1;
    inputs.grammars = {&rules, 1};
    inputs.seeds = seeds;
    inputs.native = false;
    return inputs;
}

Status upload(Device& device, Plant& plant) {
    if (Status s = assign(plant.gpuSurface, GpuSurface::create(device, plant.surface)); !s) return s;
    return allDone(
        {assign(plant.words, makeBuffer(device, "self-check rules", std::as_bytes(plant.rules.words()))),
         assign(plant.layers, makeBuffer(device, "self-check layers", bareLayers())),
         assign(plant.surfaces, makeBuffer(device, "self-check surfaces", std::vector{plant.gpuSurface.ref()}))});
}

std::string counts(const GrowthStats& stats) {
    char text[160];
    std::snprintf(text, sizeof text, "%u nodes, %u branches, %u leaves, hash %016llx", stats.nodes, stats.branches,
                  stats.leaves, static_cast<unsigned long long>(stats.hash));
    return text;
}

Status growPlant(Device& device, Plant& plant) {
    Result<RuleMap> rules = selfcheck::plantRules();
    if (!rules) return rules.failure();
    plant.rules = std::move(*rules);
    plant.surface = selfcheck::step();
    const std::vector<Seed> seeds = selfcheck::seedsOnFloor(kSeeds);

    const RuleMapRef here = plant.rules.ref();
    SurfaceRef surface = surfaceRef(plant.surface);
    std::vector<LayerRef> layers = bareLayers();
    GrowthInputs inputs = inputsOf(seeds, here);
    inputs.surfaces = {&surface};
    inputs.layers = {layers.data()};
    Result<CpuGrowth> right = growOnCpu(inputs, kRoom);
    if (!right) return right.failure();
    for (const Node& node : right->nodes) plant.spans += (node.flags & kNodeBark) != 0;
    plant.leaves = right->stats.leaves;

    if (Status uploaded = upload(device, plant); !uploaded) return uploaded;
    const RuleMapRef there = plant.rules.refAt(plant.words.address());
    inputs = inputsOf(seeds, there);
    inputs.surfaces = plant.surfaceTable();
    inputs.layers = addressOf<LayerBuf>(plant.layers);
    if (Status made = assign(plant.growth, Growth::create(device, kRoom)); !made) return made;
    if (Status grown = plant.growth->grow(inputs); !grown) return grown;
    const GrowthStats stats = plant.growth->stats();
    if (stats.hash != right->stats.hash || stats.nodes != right->stats.nodes)
        return device.fault("the plant of the self-check has " + counts(stats) + " instead of " + counts(right->stats));
    return Done{};
}

// Binding, culling and writing of triangles: of each span a tube, of each leaf a quad, all of them near the
// step.
Status writeTriangles(Device& device, const Plant& plant) {
    Result<Terminals> terminals = Terminals::create(device, selfcheck::plantMeshes());
    if (!terminals) return terminals.failure();
    Result<Emit> emit = Emit::create(device, *terminals);
    if (!emit) return emit.failure();
    EmitInputs inputs{plant.growth->view(), plant.surfaceTable()};
    inputs.native = false;
    Result<EmittedTriangles> made = emit->materialise(inputs);
    if (!made) return made.failure();
    const uint64_t wanted = uint64_t(plant.spans) * kBarkIndices + uint64_t(plant.leaves) * 6;
    if (made->indexCount != wanted)
        return device.fault("the plant of the self-check has " + std::to_string(made->indexCount / 3) +
                            " triangles instead of " + std::to_string(wanted / 3));
    Result<std::vector<TriangleVertex>> vertices =
        readVector<TriangleVertex>(device, made->vertices, 0, made->vertexCount);
    Result<std::vector<uint32_t>> indices = readVector<uint32_t>(device, made->indices, 0, made->indexCount);
    if (!vertices) return vertices.failure();
    if (!indices) return indices.failure();
    constexpr float kAround = .3f;  // metres that leaves reach beyond the step
    const auto near = [](const TriangleVertex& v) {
        const glm::vec3 p = v.position;
        return glm::all(glm::greaterThan(p, glm::vec3(-kAround))) && glm::all(glm::lessThan(p, glm::vec3(1 + kAround)));
    };
    if (!std::ranges::all_of(*vertices, near) ||
        !std::ranges::all_of(*indices, [&](uint32_t i) { return i < made->vertexCount; }))
        return device.fault("triangles of the self-check's plant lie astray");
    return Done{};
}

struct Roof {
    RoofTables house = selfcheck::house();
    RuleMap rules;
    std::unique_ptr<RoofGrowth> growth;
};

Status growRoof(Device& device, Renderer& renderer, Roof& roof) {
    Result<std::vector<RoofMesh>> meshes = renderer.loadRoofMeshes(selfcheck::roofTiles());
    if (!meshes) return meshes.failure();
    Result<RuleMap> rules = selfcheck::roofRules();
    if (!rules) return rules.failure();
    roof.rules = std::move(*rules);
    RoofInputs inputs;
    inputs.native = false;
    inputs.town = &roof.house;
    inputs.grammar = &roof.rules;
    inputs.meshes = *meshes;
    if (Status made = assign(roof.growth, RoofGrowth::create(device)); !made) return made;
    if (Status grown = roof.growth->grow(inputs); !grown) return grown;
    const CpuRoofs right = growRoofsOnCpu(inputs);
    if (!right.complete) return right.complete;
    const RoofStats stats = roof.growth->stats();
    const uint64_t hash = uint64_t(right.status.hash[1]) << 32 | right.status.hash[0];
    if (stats.hash != hash || stats.grids != right.records.grids.size())
        return device.fault("the roof of the self-check has " + std::to_string(stats.grids) +
                            " grids, or other ones than the " + std::to_string(right.records.grids.size()) +
                            " that it should have");
    return Done{};
}

// Means of the picture's blocks.
CheckPicture blocksOf(std::span<const uint8_t> rgba) {
    constexpr uint32_t kSide = kPixels / kCheckBlocks;
    CheckPicture means{};
    for (uint32_t block = 0; block < means.size(); ++block)
        for (uint32_t channel = 0; channel < 3; ++channel) {
            uint32_t sum = 0;
            for (uint32_t i = 0; i < kSide * kSide; ++i) {
                const uint32_t x = block % kCheckBlocks * kSide + i % kSide,
                               y = block / kCheckBlocks * kSide + i / kSide;
                sum += rgba[4 * (y * kPixels + x) + channel];
            }
            means[block][channel] = uint8_t(sum / (kSide * kSide));
        }
    return means;
}

Result<CheckPicture> draw(Device& device, Renderer& renderer, const Plant& plant, const Roof& roof) {
    if (Status set = renderer.setSurface(0, plant.surface, glm::mat4(1)); !set) return set.failure();
    const RoofView roofs = roof.growth->view();
    DrawInputs inputs;
    inputs.growth = plant.growth->view();
    inputs.surfaces = plant.surfaceTable();
    inputs.layers = addressOf<LayerBuf>(plant.layers);
    inputs.roofs = &roofs;
    inputs.camera = {.eye = {1.5f, 2, 3.5f}, .target = {1.5f, 1, 0}, .fovY = .9f};
    inputs.look.view = ViewMode::normals;
    inputs.look.shadows = false;
    DrawTarget target;
    target.width = target.height = kPixels;
    Result<Commands> commands = Commands::begin(device, "self-check picture");
    if (!commands) return commands.failure();
    if (Status drawn = renderer.draw(*commands, inputs, target); !drawn) return drawn.failure();
    if (Status done = commands->finish(); !done) return done.failure();
    Result<std::vector<uint8_t>> pixels = renderer.readPixels();
    if (!pixels) return pixels.failure();
    return blocksOf(*pixels);
}

Status judgePicture(Device& device, const CheckPicture& picture) {
    constexpr int kTolerance = 10;  // of 255: smoothed edges, and the rounding of other devices
    for (uint32_t block = 0; block < picture.size(); ++block)
        for (uint32_t channel = 0; channel < 3; ++channel) {
            const int seen = picture[block][channel], right = selfcheck::kPicture[block][channel];
            if (std::abs(seen - right) > kTolerance)
                return device.fault("the picture of the self-check has the colour " + std::to_string(seen) +
                                    " instead of " + std::to_string(right) + " in its block " + std::to_string(block));
        }
    return Done{};
}

}  // namespace

Result<CheckPicture> drawCheckPicture(Device& device) {
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(device, selfcheck::plantMeshes());
    if (!renderer) return renderer.failure();
    Plant plant;
    Roof roof;
    if (Status s = growPlant(device, plant); !s) return s.failure();
    if (Status s = writeTriangles(device, plant); !s) return s.failure();
    if (Status s = growRoof(device, **renderer, roof); !s) return s.failure();
    return draw(device, **renderer, plant, roof);
}

Status runSelfCheck(Device& device) {
    Result<CheckPicture> picture = drawCheckPicture(device);
    if (!picture) return picture.failure();
    return judgePicture(device, *picture);
}

}  // namespace espalier
