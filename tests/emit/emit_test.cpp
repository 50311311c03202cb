// Culling, LOD, instances and triangles against loops on the CPU.
#include <doctest/doctest.h>
#include <algorithm>
#include <random>

#include "tests/emit/pipeline.hpp"

using namespace espalier;

namespace {

struct Gpu : test::EmitPipeline {
    using EmitPipeline::EmitPipeline;
    EmitState cull(const test::Plant& plant, const EmitView& view) { return EmitPipeline::cull(plant.inputs(), view); }

    // What the last cull left, in the order of drawing, at the sizes that it asked for.
    std::vector<DrawnItem> drawn(const EmitState& state) {
        return *readVector<DrawnItem>(*device, emit.drawn(), 0, state.spanCount + state.leafCount);
    }
    std::vector<SpanInstance> spans(const test::Plant& plant, const EmitState& state) {
        const auto all = *readVector<SpanInstance>(*device, emit.spanInstances(), 0, plant.view.nodeCount);
        const std::vector<DrawnItem> items = drawn(state);
        std::vector<SpanInstance> out;
        for (uint32_t i = 0; i < state.spanCount; ++i) out.push_back(all.at(items[i].item));
        return out;
    }
    std::vector<LeafInstance> leaves(const test::Plant& plant, const EmitState& state) {
        const auto all = *readVector<LeafInstance>(*device, emit.leafInstances(), 0, plant.view.leafCount);
        const std::vector<DrawnItem> items = drawn(state);
        std::vector<LeafInstance> out;
        for (uint32_t i = state.spanCount; i < items.size(); ++i) {
            out.push_back(all.at(items[i].item));
            for (glm::vec3* axis : {&out.back().axisX, &out.back().axisY, &out.back().axisZ}) *axis *= items[i].value;
        }
        return out;
    }
};

// By repeated halving in double precision: shares nothing with bezier.h.
glm::dvec3 casteljau(const glm::dvec3 (&p)[4], double u) {
    glm::dvec3 a = glm::mix(p[0], p[1], u), b = glm::mix(p[1], p[2], u), c = glm::mix(p[2], p[3], u);
    return glm::mix(glm::mix(a, b, u), glm::mix(b, c, u), u);
}

double degrees(glm::dvec3 a, glm::dvec3 b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

// Reversed depth, infinite far plane, as the renderer's.
glm::mat4 lookAt(glm::vec3 eye, glm::vec3 target, float fovY, float aspect) {
    const glm::vec3 f = glm::normalize(target - eye), r = glm::normalize(glm::cross(f, glm::vec3(0, 1, 0))),
                    u = glm::cross(r, f);
    const glm::mat4 view = glm::transpose(glm::mat4(glm::vec4(r, -glm::dot(r, eye)), glm::vec4(u, -glm::dot(u, eye)),
                                                    glm::vec4(-f, glm::dot(f, eye)), glm::vec4(0, 0, 0, 1)));
    glm::mat4 projection(0);
    projection[1][1] = -1 / std::tan(fovY / 2);
    projection[0][0] = -projection[1][1] / aspect;
    projection[2][3] = -1;
    projection[3][2] = 0.05f;
    return projection * view;
}

bool inside(const glm::mat4& m, glm::vec3 p, float slack) {
    const glm::vec4 c = m * glm::vec4(p, 1);
    const float w = c.w + slack;
    return w > 0.05f && std::abs(c.x) <= w + 2 * slack && std::abs(c.y) <= w + 2 * slack;
}

}  // namespace

TEST_CASE("every span and leaf becomes one instance, at any count") {
    Gpu gpu;
    for (uint32_t count : {0u, 1u, 2u, 31u, 32u, 33u, 63u, 64u, 65u, 129u, 1000u}) {
        CAPTURE(count);
        const test::PlantData data = test::helix(count);
        const test::Plant plant = test::upload(*gpu.device, data);
        const EmitState state = gpu.cull(plant, test::fullDetail());
        CHECK(state.spanCount == (count > 0 ? count - 1 : 0));
        CHECK(state.leafCount == data.leaves.size());
        CHECK(gpu.emit.stats().overflow == 0);
        CHECK(state.drawnTriangles == state.fullTriangles);
        // The two commands of a bucket cover its instances once.
        uint64_t triangles = 0;
        for (const DrawCommand& draw : state.draws) triangles += uint64_t(draw.indexCount) * draw.instanceCount / 3;
        CHECK(triangles == state.drawnTriangles);
        const std::vector<SpanInstance> spans = gpu.spans(plant, state);
        std::vector<float> arcs;
        for (const SpanInstance& s : spans) arcs.push_back(s.arc0);
        std::sort(arcs.begin(), arcs.end());
        CHECK(std::adjacent_find(arcs.begin(), arcs.end()) == arcs.end());  // none twice
    }
}

TEST_CASE("spans meet without a kink, and children leave along their stem") {
    Gpu gpu;
    const test::PlantData data = test::wallIvy(5, 2, 1.5f);
    const test::Plant plant = test::upload(*gpu.device, data);
    const EmitState state = gpu.cull(plant, test::fullDetail());
    const std::vector<SpanInstance> spans = gpu.spans(plant, state);
    uint32_t joints = 0, children = 0;
    double worst = 0, worstRadius = 0;
    for (const SpanInstance& a : spans)
        for (const SpanInstance& b : spans) {
            if (a.p3 != b.p0) continue;
            worst = std::max(worst, degrees(glm::dvec3(a.p3 - a.b2), glm::dvec3(b.b1 - b.p0)));
            const bool child = std::abs(b.arc0 - (a.arc0 + a.metres)) > 0.02f * a.metres;
            if (!child) worstRadius = std::max(worstRadius, double(std::abs(a.radius1 - b.radius0)));
            if (child) CHECK(b.radius0 <= a.radius1 * 1.0001f);
            joints++;
            children += child;
        }
    CHECK(joints > 500);
    CHECK(children > 20);
    CHECK(worst <= 1.0);
    CHECK(worstRadius <= 1e-6);
}

TEST_CASE("culling keeps what is seen and drops what is far outside") {
    Gpu gpu;
    const test::PlantData data = test::helix(700, 1.0f);
    const test::Plant plant = test::upload(*gpu.device, data);
    std::mt19937 random(7);
    auto uniform = [&](float low, float high) { return low + (high - low) * float(random() % 10000) * 1e-4f; };
    for (int round = 0; round < 12; ++round) {
        const glm::vec3 eye(uniform(-4, 4), uniform(0, 8), uniform(2, 5));
        const glm::vec3 target(uniform(-2, 2), uniform(0, 8), uniform(-2, 2));
        const glm::mat4 m = lookAt(eye, target, 0.6f, 1.6f);
        EmitView view = perspectiveView(m, eye, 1e5f, 1);  // so many pixels that nothing is too small
        const EmitState state = gpu.cull(plant, view);
        uint32_t surely = 0, perhaps = 0;
        for (uint32_t i = 1; i < data.nodes.size(); ++i) {
            const glm::vec3 middle = 0.5f * (data.nodes[i].position + data.nodes[i - 1].position);
            surely += inside(m, middle, 0);
            perhaps += inside(m, middle, 0.25f);  // spans are 0.11 m long
        }
        CAPTURE(round);
        CHECK(state.spanCount >= surely);
        CHECK(state.spanCount <= perhaps);
    }
    EmitView away = perspectiveView(lookAt({0, 0, 5}, {0, 0, 50}, 0.6f, 1.6f), {0, 0, 5}, 1000, 1);
    CHECK(gpu.cull(plant, away).drawnTriangles == 0);
}

TEST_CASE("a view that hasn't changed isn't culled again, one of other growth is") {
    Gpu gpu;
    const test::Plant plant = test::upload(*gpu.device, test::helix(300)),
                      other = test::upload(*gpu.device, test::helix(200));
    const auto ran = [&](const test::Plant& of, const EmitView& view, const char* name) {
        Result<Commands> commands = Commands::begin(*gpu.device, name);
        REQUIRE(commands);
        REQUIRE(gpu.emit.cull(*commands, of.inputs(), view, name, true));
        REQUIRE(commands->finish());
        gpu.device->collect();
        return gpu.device->milliseconds(name) > 0;
    };
    const glm::vec3 eye(0, 1, 4);
    EmitView view = perspectiveView(lookAt(eye, {0, 1, 0}, 0.9f, 1.6f), eye, 500, 1);
    CHECK(ran(plant, view, "first"));
    const EmitStats before = gpu.emit.stats();
    CHECK(!ran(plant, view, "the same"));
    CHECK(gpu.emit.stats().spans == before.spans);
    CHECK(ran(other, view, "other growth"));
    CHECK(gpu.emit.stats().spans < before.spans);
    CHECK(ran(plant, view, "back"));
    CHECK(gpu.emit.stats().spans == before.spans);
    view.lodPixels = 2;
    CHECK(ran(plant, view, "another view"));
    gpu.emit.forget();
    CHECK(ran(plant, view, "after a recording that wasn't submitted"));
}

TEST_CASE("levels of detail fall with distance, and far canopies keep their area") {
    Gpu gpu;
    const test::PlantData data = test::wallIvy(8, 2, 1.5f);
    const test::Plant plant = test::upload(*gpu.device, data);
    uint64_t before = ~0ull;
    double nearArea = 0;
    for (float distance : {2.0f, 5.0f, 12.0f, 30.0f, 60.0f}) {
        const glm::vec3 eye(0, 0.7f, distance);
        const EmitState state = gpu.cull(plant, perspectiveView(lookAt(eye, {0, 0.7f, 0}, 0.9f, 1.6f), eye, 745, 1));
        CHECK(state.drawnTriangles <= before);
        before = state.drawnTriangles;
        const auto leaves = gpu.leaves(plant, state);
        double area = 0;
        for (const LeafInstance& leaf : leaves) area += glm::length(glm::cross(leaf.axisX, leaf.axisY));
        if (distance == 2.0f) nearArea = area;
        CAPTURE(distance);
        CHECK(area == doctest::Approx(nearArea).epsilon(distance < 40 ? 0.15 : 0.3));
    }
    CHECK(before * 20 < gpu.cull(plant, test::fullDetail()).drawnTriangles);
}

TEST_CASE("kernels have room for so many levels of detail, the CPU picks among any number") {
    TerminalData meshes = test::simpleTerminals();
    for (uint32_t v = 0; v < kMaxBuckets / 4; ++v) {
        TerminalVariant& variant = meshes.variants.emplace_back(TerminalVariant{"model_" + std::to_string(v), 1, {}});
        for (uint32_t quads : {5u, 3u, 2u, 1u}) test::addSquare(meshes, variant, quads);
    }
    const std::shared_ptr<Device> device = test::validatedDevice();
    Result<Terminals> refused = Terminals::create(*device, meshes);
    REQUIRE_FALSE(refused);
    CHECK(refused.failure().text().find("64 levels of detail") != std::string::npos);
    Result<Terminals> held = Terminals::create(*device, meshes, TerminalChoice::cpu);
    REQUIRE(held);
    const TerminalTable& table = held->table();
    REQUIRE(table.buckets.size() > kMaxBuckets);
    CHECK(table.variants.back().firstBucket + table.variants.back().lodCount == table.buckets.size());
    CHECK(held->kernelTable().bucketCount == 0);
}

TEST_CASE("cut-out leaves of two triangles are for pictures of what moves") {
    TerminalData meshes = test::simpleTerminals();
    meshes.materials.emplace_back().alphaCutoff = 0.5f;
    meshes.variants[1].lods.clear();
    for (uint32_t quads : {4u, 2u, 1u}) test::addSquare(meshes, meshes.variants[1], quads, 0, 1);
    meshes.variants.erase(meshes.variants.begin() + 2);  // the other leaf
    measureTerminalErrors(meshes);
    Gpu gpu(test::validatedDevice(), meshes);
    const test::Plant plant = test::upload(*gpu.device, test::wallIvy(8, 2, 1.5f));
    const auto kites = [&](float distance, float lodPixels) {
        const glm::vec3 eye(0, 0.7f, distance);
        const EmitState state =
            gpu.cull(plant, perspectiveView(lookAt(eye, {0, 0.7f, 0}, 0.9f, 1.6f), eye, 745, lodPixels));
        REQUIRE(state.leafCount > 50);
        const uint32_t first = gpu.terminals.table().variants[1].firstBucket;
        REQUIRE(gpu.terminals.lodOfBucket(first + 2).indexCount == 6);
        CHECK(state.counts[first] + state.counts[first + 1] + state.counts[first + 2] == state.leafCount);
        return double(state.counts[first + 2]) / state.leafCount;
    };
    for (float distance : {2.0f, 12.0f, 60.0f}) {
        CAPTURE(distance);
        CHECK(kites(distance, 1) == 0);     // what rests
        CHECK(kites(distance, 1.2f) == 0);  // and its shadows
    }
    CHECK(kites(1, 4) < 0.1);
    CHECK(kites(12, 4) > 0.9);
}

TEST_CASE("leaves stand off the wall") {
    Gpu gpu;
    const test::PlantData data = test::wallIvy(8, 2, 1.5f);
    const test::Plant plant = test::upload(*gpu.device, data);
    const EmitState state = gpu.cull(plant, test::fullDetail());
    const TerminalTable& table = gpu.terminals.table();
    const auto leaves = gpu.leaves(plant, state);
    uint32_t sunk = 0, facing = 0;
    for (uint32_t b = table.barkBuckets; b < table.buckets.size(); ++b)
        for (uint32_t i = 0; i < state.counts[b]; ++i) {
            const LeafInstance& leaf = leaves[state.starts[b] - state.spanCount + i];
            const float size = glm::length(leaf.axisY);
            for (uint32_t v = 0; v < table.buckets[b].vertexCount; ++v) {
                const glm::vec3 p = gpu.terminals.data().vertices[table.buckets[b].firstVertex + v].position;
                const glm::vec3 world = leaf.origin + leaf.axisX * p.x + leaf.axisY * p.y + leaf.axisZ * p.z;
                if (world.z < -0.12f * size) sunk++;
            }
            facing += leaf.axisZ.z > 0;
            CHECK(glm::dot(glm::cross(leaf.axisX, leaf.axisY), leaf.axisZ) > 0.99f * size * size * size);
        }
    CHECK(sunk == 0);
    CHECK(facing == leaves.size());
}

TEST_CASE("native code writes what shaders write") {
    Gpu gpu;
    for (uint32_t count : {2u, 40u, 600u}) {
        CAPTURE(count);
        test::PlantData data = test::helix(count);
        const test::Plant plant = test::upload(*gpu.device, data);
        std::vector<std::byte> written[2];
        for (bool native : {false, true}) {
            EmitInputs inputs = plant.inputs();
            inputs.native = native;
            Result<EmittedTriangles> out = gpu.emit.materialise(inputs);
            REQUIRE(out);
            CHECK(out->native == (native && gpu.device->info().cpu));
            std::vector<std::byte>& bytes = written[native];
            bytes = *readVector<std::byte>(*gpu.device, out->vertices, 0, out->vertexCount * sizeof(TriangleVertex));
            const auto indices = *readVector<std::byte>(*gpu.device, out->indices, 0, out->indexCount * 4);
            bytes.insert(bytes.end(), indices.begin(), indices.end());
        }
        CHECK(written[0].size() > 0);
        CHECK(written[0] == written[1]);
    }
}

TEST_CASE("written triangles are those of a loop on the CPU") {
    Gpu gpu;
    for (uint32_t count : {0u, 1u, 2u, 40u, 65u}) {
        CAPTURE(count);
        test::PlantData data = test::helix(count);
        const test::Plant plant = test::upload(*gpu.device, data);
        EmitInputs inputs = plant.inputs();
        inputs.native = true;
        Result<EmittedTriangles> out = gpu.emit.materialise(inputs);
        REQUIRE(out);
        const uint32_t spans = count > 0 ? count - 1 : 0;
        REQUIRE(out->vertexCount >= spans * kBarkVertices);
        const auto vertices = *readVector<TriangleVertex>(*gpu.device, out->vertices, 0, out->vertexCount);
        const auto indices = *readVector<uint32_t>(*gpu.device, out->indices, 0, out->indexCount);
        uint64_t loose = 0;
        for (uint32_t i : indices) REQUIRE(i < out->vertexCount);
        for (size_t i = spans * kBarkIndices; i < indices.size(); i += 3) loose += indices[i] != indices[i + 1];
        double worst = 0;
        for (uint32_t i = 1; i < count; ++i) {
            const LoadedSpan s = loadSpan(data.nodeBuf(), data.chunkBuf(), data.surfaceBuf(), i);
            const glm::dvec3 p[4] = {s.span.p0, s.span.b1, s.span.b2, s.span.p3};
            double best = 1e9;
            for (uint32_t block = 0; block < spans; ++block) {  // blocks come in any order
                double error = 0;
                for (uint32_t v = 0; v < kBarkVertices && error < best; ++v) {
                    const double u = double(v / kBarkSides) / (kBarkRings - 1);
                    const double r = barkRadius(s.radius0, s.radius1, spanLength(s.span), s.tip, float(u));
                    const double whole = s.radius0 * (1 - u) + s.radius1 * u;
                    const glm::dvec3 along = glm::normalize(casteljau(p, u + 1e-4) - casteljau(p, u - 1e-4));
                    const glm::dvec3 n = glm::mix(glm::dvec3(s.normal0), glm::dvec3(s.normal1), u);
                    const glm::dvec3 side = glm::normalize(glm::cross(n, along)), up = glm::cross(along, side);
                    const double a = 2 * 3.14159265358979 * (v % kBarkSides) / kBarkSides;
                    const glm::dvec3 at =
                        casteljau(p, u) + up * (whole * kBarkRise) + (side * std::cos(a) + up * std::sin(a)) * r;
                    error = std::max(error, glm::length(at - glm::dvec3(vertices[block * kBarkVertices + v].position)));
                }
                best = std::min(best, error);
            }
            worst = std::max(worst, best);
        }
        CHECK(worst < 2e-6);
        uint64_t wanted = 0;
        const EmitState state = gpu.cull(plant, test::fullDetail());
        for (uint32_t b = gpu.terminals.table().barkBuckets; b < gpu.terminals.table().buckets.size(); ++b)
            wanted += uint64_t(state.counts[b]) * gpu.terminals.table().buckets[b].indexCount / 3;
        CHECK(loose == wanted);
        // Bark faces outward: each triangle's normal agrees with its vertices'.
        uint32_t inward = 0;
        for (size_t i = 0; i < size_t(spans) * kBarkIndices; i += 3) {
            const TriangleVertex &a = vertices[indices[i]], &b = vertices[indices[i + 1]],
                                 &c = vertices[indices[i + 2]];
            const glm::vec3 n = glm::cross(b.position - a.position, c.position - a.position);
            if (glm::length(n) > 1e-12f && glm::dot(n, unpackOct(a.normal)) < 0) inward++;
        }
        CHECK(inward == 0);
    }
}
