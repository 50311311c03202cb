// The same walks on the GPU and on the CPU: one text, so the same bits.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>

#include "runtime/surface/gpu_surface.hpp"
#include "shaders/tests/walk_case.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/walk/judge.hpp"

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

void compare(const Shape& shape, size_t count, uint steps, uint level) {
    TestDevice t;
    auto baked = bake(toModel(shape), {.resolution = 1024, .keepLayout = true});
    REQUIRE(baked);
    const SurfaceData& surface = baked->surface;
    std::vector<WalkCase> cases = turningCases(shape, surface, count, steps);
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
                shape.name.c_str(), level, cases.size(), walked, samples, double(walked) / milliseconds / 1e3,
                double(walked) / seconds / 1e6);
    CHECK(different == 0);
    CHECK(walked > cases.size() * steps / 2);
}

}  // namespace

TEST_CASE("GPU and CPU walk the same way to the bit") {
    compare(sphere(96), 4096, 100, 0);
    compare(cubeWithStrip(), 1021, 100, 0);
    compare(torus(64), 1000, 100, 2);
}
