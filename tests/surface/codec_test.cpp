// Levels as bytes: any records come back bit for bit, damage is noticed and never followed.
#include "runtime/surface/codec.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <random>

#include "tests/bake/small_models.hpp"
#include "tests/support/same_bits.hpp"

using namespace espalier;
using namespace espalier::surface_file;
using namespace espalier::test;

namespace {

std::span<const std::byte> view(const std::vector<uint8_t>& bytes) {
    return std::as_bytes(std::span(bytes));
}

bool comesBack(const SurfaceLevelData& level, std::span<const TrianglePlane> triangles) {
    auto bytes = encodeLevel(level, triangles);
    REQUIRE(bytes);
    SurfaceLevelData out;
    out.size = level.size;
    const std::string wrong = decodeLevel(view(*bytes), triangles, level.crossingRefs.size(), out);
    CHECK(wrong == "");
    return sameBits(level.texels, out.texels) && sameBits(level.aux, out.aux) &&
           sameBits(level.crossingHead, out.crossingHead) && sameBits(level.crossingRefs, out.crossingRefs);
}

// Records that no bake would make: `wild` of a hundred words are of any bits.
SurfaceLevelData noise(uint32_t size, uint32_t wild, uint32_t triangles, uint32_t seed) {
    std::mt19937 random(seed);
    auto word = [&](uint32_t tame) { return random() % 100 < wild ? uint32_t(random()) : tame; };
    SurfaceLevelData level;
    level.size = size;
    for (uint32_t i = 0; i < size * size; ++i) {
        uint32_t words[6] = {word(0), word(0x3F800000u),         word(0), word(random() & 0xFFF60000u),
                             word(7), word(random() % triangles)};
        if (random() % 3 == 0) words[0] = words[1] = words[2] = words[3] = words[4] = 0, words[5] = kNoIndex;
        Texel texel;
        TexelAux aux;
        std::memcpy(&texel, words, sizeof texel);
        std::memcpy(&aux, words + 4, sizeof aux);
        level.texels.push_back(texel);
        level.aux.push_back(aux);
        level.crossingHead.push_back(word(0));
    }
    for (uint32_t i = random() % 300; i > 0; --i) level.crossingRefs.push_back(uint32_t(random()));
    return level;
}

SurfaceData baked() {
    BakeOptions options;
    options.resolution = 128;
    auto done = bake(cubeCross(6), options);
    REQUIRE(done);
    return std::move(done->surface);
}

}  // namespace

TEST_CASE("any level comes back bit for bit") {
    std::vector<TrianglePlane> triangles(50);
    for (uint32_t t = 0; t < 50; ++t) {
        triangles[t].position = {0, 1, float(t)};
        triangles[t].chart = t % 3;
    }
    for (uint32_t size : {8u, 16u, 64u, 128u})
        for (uint32_t wild : {0u, 1u, 30u, 100u}) {
            CAPTURE(size);
            CAPTURE(wild);
            CHECK(comesBack(noise(size, wild, 50, size + wild), triangles));
        }
    CHECK(comesBack(noise(8, 50, 1, 3), {}));
    const SurfaceData data = baked();
    for (const SurfaceLevelData& level : data.levels) CHECK(comesBack(level, data.triangles));
    SurfaceLevelData uneven = data.levels[0];
    uneven.aux.pop_back();
    CHECK(!encodeLevel(uneven, data.triangles));
}

TEST_CASE("a baked texel's position is its triangle's at its centre, to the bit, and costs nothing") {
    const SurfaceData data = baked();
    const SurfaceLevelData& level = data.levels[0];
    for (uint32_t y = 0; y < level.size; ++y)
        for (uint32_t x = 0; x < level.size; ++x) {
            const uint32_t at = texelIndex(level.size, x, y);
            if (texelClass(level.texels[at].bits) != kTexelInner) continue;
            const glm::vec2 uv((float(x) + 0.5f) / float(level.size), (float(y) + 0.5f) / float(level.size));
            REQUIRE(level.texels[at].position == placeOn(data.triangles[level.aux[at].triangle], uv));
        }
    CHECK(encodeLevel(level, data.triangles)->size() < level.texels.size());
}

TEST_CASE("damaged levels are refused or decoded to something, within their arrays") {
    const SurfaceData data = baked();
    const SurfaceLevelData& level = data.levels[1];
    const std::vector<uint8_t> bytes = *encodeLevel(level, data.triangles);
    SurfaceLevelData out;
    out.size = level.size;
    std::mt19937 random(5);
    for (int i = 0; i < 300; ++i) {
        std::vector<uint8_t> damaged = bytes;
        for (int k = 0; k < 1 + i % 3; ++k) damaged[random() % damaged.size()] ^= uint8_t(1u << random() % 8);
        (void)decodeLevel(view(damaged), data.triangles, level.crossingRefs.size(), out);
        CHECK(out.texels.size() == size_t(level.size) * level.size);
    }
    for (size_t keep = 0; keep < bytes.size(); keep += 1 + bytes.size() / 40)
        CHECK(decodeLevel(view(bytes).first(keep), data.triangles, level.crossingRefs.size(), out) != "");
    CHECK(decodeLevel(view(bytes), {}, level.crossingRefs.size(), out) != "");
    CHECK(decodeLevel(view(bytes), data.triangles, level.crossingRefs.size() + 1, out) != "");
}
