// Every input that fuzzing has kept, whole, cut and changed, through the fuzzed functions.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "runtime/core/file.hpp"
#include "shaders/shared/random.h"
#include "tests/bake/small_models.hpp"
#include "tests/fuzz/targets.hpp"
#include "tools/bake/bake.hpp"

using namespace espalier;

namespace {

// The file itself, sixteen beginnings of it, and 64 copies with a byte changed.
void runAll(const fuzz::Target& target, fuzz::Bytes all) {
    target.run(all);
    for (size_t i = 0; i < 16; ++i) target.run(all.first(all.size() * i / 16));
    std::vector<uint8_t> changed(all.begin(), all.end());
    uint64_t state = all.size();
    for (size_t i = 0; i < 64 && !all.empty(); ++i) {
        state = mix64(state + 1);
        size_t at = (state >> 8) % all.size();
        changed[at] ^= uint8_t(1u << (state & 7u));
        target.run(changed);
        changed[at] = all[at];
    }
}

}  // namespace

TEST_CASE("kept inputs neither crash nor break a promise") {
    for (const fuzz::Target& target : fuzz::kTargets) {
        CAPTURE(target.name);
        std::vector<std::filesystem::path> files;
        std::error_code none;  // surfaces are made below
        for (const auto& entry :
             std::filesystem::directory_iterator(std::filesystem::path("tests/fuzz/corpus") / target.name, none))
            files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        CHECK((!files.empty() || target.run == fuzz::surface));
        for (const auto& file : files) {
            auto bytes = readFile(file);
            REQUIRE(bytes);
            runAll(target, {reinterpret_cast<const uint8_t*>(bytes->data()), bytes->size()});
        }
    }
}

TEST_CASE("a surface as the baker writes it today neither crashes nor breaks a promise when damaged") {
    BakeOptions options;
    options.resolution = 64;
    auto baked = bake(test::cube(1), options);
    REQUIRE(baked);
    auto path = std::filesystem::temp_directory_path() / ("espalier-fuzz-" + std::to_string(::getpid()) + ".glb");
    REQUIRE(writeSurface(baked->surface, path));
    auto bytes = readFile(path);
    std::filesystem::remove(path);
    REQUIRE(bytes);
    runAll({"surface", fuzz::surface}, {reinterpret_cast<const uint8_t*>(bytes->data()), bytes->size()});
}
