// The same walks on the GPU and on the CPU: one text, so the same bits.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>

#include "runtime/surface/gpu_surface.hpp"
#include "shaders/tests/walk_case.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/support/data.hpp"
#include "tests/walk/mesh_tracer.hpp"

using namespace espalier;
using namespace espalier::walktest;

namespace {

struct WalkPush {
    uint64_t surfaces, cases, ends;
    uint32_t count, level;
};

std::vector<WalkCase> turningCases(const Shape& shape, const SurfaceData& surface, size_t count, uint steps) {
    std::mt19937_64 random(11);
    std::vector<WalkCase> cases;
    while (cases.size() < count) {
        Start s = randomStart(shape, random);
        WalkCase c{};
        c.uv = vec2(s.uv);
        c.place = chartAt(surface, c.uv, s.position);
        c.direction = vec3(s.direction);
        c.step = 0.01f * float(shape.radius);
        c.turn = 0.002f * float(int(random() % 41) - 20);
        c.steps = steps;
        cases.push_back(c);
    }
    return cases;
}

std::vector<WalkEnd> onGpu(TestDevice& t, const SurfaceData& surface, const std::vector<WalkCase>& cases, uint level) {
    Program program = must(Program::compute(t.device, "tests/walk.comp", {.exact = true}));
    GpuSurface gpu = must(GpuSurface::create(t.device, surface));
    Buffer table = must(Buffer::create(t.device, "surfaces", sizeof(SurfaceRef)));
    Buffer in = must(Buffer::create(t.device, "cases", cases.size() * sizeof(WalkCase)));
    Buffer out = must(Buffer::create(t.device, "ends", cases.size() * sizeof(WalkEnd)));
    WalkPush push{table.address(), in.address(), out.address(), uint32_t(cases.size()), level};
    for (int run = 0; run < 2; ++run) {  // the first one compiles the kernel
        Commands commands = must(Commands::begin(t.device, "walks"));
        REQUIRE(commands.upload(table, std::vector<SurfaceRef>{gpu.ref()}));
        REQUIRE(commands.upload(in, cases));
        commands.barrier(Use::transfer, Use::compute);
        {
            Pass pass(commands, "walk");
            pass.dispatchItems(program, uint32_t(cases.size()), push);
        }
        REQUIRE(commands.finish());
    }
    return must(readVector<WalkEnd>(t.device, out, 0, cases.size()));
}

void compare(const std::string& name, const SurfaceData& surface, const std::vector<WalkCase>& cases, uint level) {
    TestDevice t;
    std::vector<WalkEnd> gpu = onGpu(t, surface, cases, level);
    SurfaceRef ref = surfaceRef(surface);
    size_t different = 0, walked = 0, samples = 0;
    auto begin = std::chrono::steady_clock::now();
    std::vector<WalkEnd> cpu;
    for (const WalkCase& c : cases) cpu.push_back(walkCase(SurfaceBuf{&ref}, level, c));
    double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    for (size_t i = 0; i < cases.size(); ++i) {
        different += std::memcmp(&cpu[i], &gpu[i], sizeof(WalkEnd)) != 0;
        walked += gpu[i].steps;
        samples += gpu[i].samples;
    }
    double milliseconds = t.device.milliseconds("walk");
    std::printf("%-30s level %u: %zu walks, %zu steps, %zu samples; GPU %.2f M steps/s, one core of the CPU %.2f\n",
                name.c_str(), level, cases.size(), walked, samples, double(walked) / milliseconds / 1e3,
                double(walked) / seconds / 1e6);
    CHECK(different == 0);
    CHECK(walked > cases.size() * cases[0].steps / 2);
}

void compareShape(const Shape& shape, size_t count, uint steps, uint level) {
    auto baked = bake(toModel(shape), {.resolution = 1024, .keepLayout = true});
    REQUIRE(baked);
    compare(shape.name, baked->surface, turningCases(shape, baked->surface, count, steps), level);
}

}  // namespace

TEST_CASE("GPU and CPU walk the same way to the bit") {
    compareShape(sphere(96), 4096, 100, 0);
    compareShape(cubeWithStrip(), 1021, 100, 0);
    compareShape(torus(64), 1000, 100, 2);
}

TEST_CASE("GPU and CPU walk the same way over a scan") {
    auto path = test::dataFile("derived/bunny_unwrap.glb");
    if (!path) return;
    auto model = importModel(*path);
    REQUIRE(model);
    auto baked = bake(*model, {.resolution = 1024});
    REQUIRE(baked);
    const SurfaceData& surface = baked->surface;
    float radius = glm::length(surface.boundsMax - surface.boundsMin) / 2;
    std::vector<WalkCase> cases;
    for (const Trial& trial : MeshTracer(surface.vertices, surface.indices).trials(surface, 4096, 0.01 * radius, 5)) {
        WalkCase c{};
        c.place = trial.place;
        c.uv = trial.uv;
        c.direction = trial.direction;
        c.step = 0.006f * radius;  // about two texels
        c.turn = 0.002f * float(int(cases.size() % 41) - 20);
        c.steps = 100;
        cases.push_back(c);
    }
    compare("bunny, unwrapped", surface, cases, 0);
}
