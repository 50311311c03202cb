// One growth, however it is computed: by the CPU reference as several compilers and optimisation levels build it, and
// by the GPU with several numbers of the software device's threads. The surface is baked once and the rule maps are
// compiled once, here; what the programs get is a file of those bytes.
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <filesystem>
#include <sstream>

#include "runtime/grammar/grammar.hpp"
#include "shaders/shared/random.h"
#include "tests/determinism/variant/grow_on_cpu.hpp"
#include "tests/support/cube_model.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/bake/bake.hpp"

using namespace espalier;
using namespace espalier::determinismtest;

namespace {

// A ball of radius 1 m that is drawn out to one side and dented: curved both ways, six charts, seams that crease.
Model pear() {
    return test::formedCube("pear", 20, [](glm::vec3 p) {
        p *= .5f / std::max(.5f, .35f * glm::length(p));
        p.y *= p.y > 0 ? 1.6f : 1 - .3f * std::abs(p.x);
        return p;
    });
}

void addSeeds(FixedInputs& in, uint32_t grammar, uint32_t symbol, uint32_t count, uint64_t number) {
    const FixedLevel& level = in.levels[0];
    for (uint64_t i = 0; count > 0; ++i) {
        const uint64_t key = mix64(number + i);
        const uint32_t x = uint32_t(uniformRandom(key, 1) * float(level.size)) % level.size;
        const uint32_t y = uint32_t(uniformRandom(key, 2) * float(level.size)) % level.size;
        const Texel& texel = level.texels[texelIndex(level.size, x, y)];
        if (texelClass(texel.bits) != kTexelInner) continue;
        Seed seed{};
        seed.key = key;
        seed.walk.place = texelChart(texel.bits);
        seed.walk.uv = (glm::vec2(x, y) + .5f) / float(level.size);
        seed.walk.direction = {uniformRandom(key, 3) - .5f, uniformRandom(key, 4) - .5f, uniformRandom(key, 5) - .5f};
        seed.grammar = grammar;
        seed.symbol = symbol;
        in.seeds.push_back(seed);
        --count;
    }
}

FixedInputs fixedInputs(uint64_t number) {
    BakeOptions options;
    options.resolution = 256;
    Result<Baked> baked = bake(pear(), options);
    if (!baked) FAIL(baked.failure().text());
    SurfaceData& s = baked->surface;
    FixedInputs in;
    in.surface = {surfaceRef(s)};
    for (SurfaceLevelData& l : s.levels) in.levels.push_back({l.size, l.texels, l.aux, l.crossingHead, l.crossingRefs});
    in.crossings = s.crossings;
    in.charts = s.charts;
    in.triangles = s.triangles;
    for (const char* name : {"ivy_free", "ivy_paper"}) {
        Result<RuleMap> map = compileGrammarFile("content/grammars/" + std::string(name) + ".grammar");
        if (!map) FAIL(map.failure().text());
        const float scale = .5f;
        if (auto param = map->findParam("scale")) map->setParam(*param, {&scale, 1});
        in.grammars.push_back({{map->words().begin(), map->words().end()}, {map->refAt(0)}});
        const uint32_t grammar = uint32_t(in.grammars.size()) - 1;
        addSeeds(in, grammar, map->startSymbol(), 6, number + grammar * 1000);
    }
    return in;
}

// A file of inputs, gone at the end.
struct InputsFile {
    test::ScratchFolder folder;
    explicit InputsFile(FixedInputs& in) { REQUIRE(writeInputs(in, path())); }
    std::string path() const { return folder.file("inputs"); }
};

// Runs a command; its output without the last line's end. exit: its exit code, -1 when a signal ended it.
std::string output(const std::string& command, int& exit) {
    exit = -1;
#ifdef __SANITIZE_ADDRESS__
    // A driver's modules are unloaded at a program's end, and what they keep would be taken for our leak.
    setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
#endif
    FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe);
    std::string text;
    char piece[1024];
    while (size_t got = std::fread(piece, 1, sizeof piece, pipe)) text.append(piece, got);
    const int status = pclose(pipe);
    if (WIFEXITED(status)) exit = WEXITSTATUS(status);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
}

}  // namespace

TEST_CASE("the CPU reference grows the same whatever compiler built it") {
    FixedInputs in = fixedInputs(1);
    const InputsFile file(in);
    const std::string ours = grownOnCpu(in);
    std::printf("%-14s %s\n", "this build", ours.c_str());
    REQUIRE(!ours.empty());
    int variants = 0;
    std::istringstream list(ESPALIER_VARIANTS);
    for (std::string program; std::getline(list, program, '|');) {
        const std::string name = std::filesystem::path(program).filename().string();
        int exit;
        const std::string theirs = output("\"" + program + "\" " + file.path(), exit);
        std::printf("%-14s %s\n", name.c_str(), theirs.c_str());
        CAPTURE(name);
        CHECK(exit == 0);
        CHECK(theirs == ours);
        ++variants;
    }
    CHECK(variants >= 2);
    FixedInputs others = fixedInputs(500);
    CHECK(grownOnCpu(others) != ours);  // the line tells growths apart
}

TEST_CASE("the GPU grows the same with any number of threads and any room") {
    FixedInputs in = fixedInputs(1);
    const InputsFile file(in);
    std::string first;
    for (const char* threads : {"0", "1", "2"}) {
        int exit;
        const std::string line =
            output("LP_NUM_THREADS=" + std::string(threads) + " \"" ESPALIER_GPU_PROGRAM "\" " + file.path(), exit);
        if (exit == 77) {
            std::printf("skipped: %s\n", line.c_str());
            return;
        }
        std::printf("LP_NUM_THREADS=%s  %s\n", threads, line.c_str());
        CAPTURE(threads);
        REQUIRE(exit == 0);
        if (first.empty()) first = line;
        CHECK(line == first);
    }
    std::printf("CPU reference:    %s\n", grownOnCpu(in).c_str());
}
