// Enters: nothing but the formats. Leaves: a tile of noise that repeats without a seam, the draw of a plane of it, and
// the hills around that it makes.
#include "runtime/render/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "runtime/core/jobs.hpp"
#include "runtime/render/meadow_noise.hpp"

namespace espalier {
namespace {

constexpr uint32_t kSide = kNoiseSide;

// Blades of grass over each other, each lighter from its root to its tip; of mean 0, so that they fade with distance.
std::vector<float> bladeTile() {
    std::vector<float> tile(size_t(kSide) * kSide, -0.9f);
    constexpr uint32_t kBlades = 6500;
    for (uint32_t i = 0; i < kBlades; ++i) {
        const auto random = [&](uint32_t which) { return lattice(i, which, 41); };
        float x = kSide * (0.5f + 0.5f * random(0)), y = kSide * (0.5f + 0.5f * random(1));
        float angle = 3.14159265f * random(2);
        const float length = 34 + 16 * random(3), bend = 0.022f * random(4), shade = 0.45f * random(5);
        for (float along = 0; along < length; along += 0.7f) {
            const float t = along / length, half = 1.9f * (1 - t * t);
            for (float across = -half; across <= half; across += 0.7f) {
                const auto wrapped = [](float v) { return uint32_t(int(std::floor(v)) + 4 * int(kSide)) % kSide; };
                const uint32_t column = wrapped(x - across * std::sin(angle)),
                               row = wrapped(y + across * std::cos(angle));
                tile[size_t(row) * kSide + column] = shade - 0.5f + 0.9f * t + 0.15f * across / 1.9f;
            }
            x += 0.7f * std::cos(angle), y += 0.7f * std::sin(angle);
            angle += 0.7f * bend;
        }
    }
    double sum = 0;
    for (float v : tile) sum += v;
    for (float& v : tile) v -= float(sum / double(tile.size()));
    return tile;
}

// meadowNoise, and blades in its y.
std::vector<uint8_t> noiseTile() {
    const std::vector<float> blades = bladeTile();
    const std::vector<glm::vec4> tile = meadowNoiseTile();
    std::vector<uint8_t> rgba(tile.size() * 4);
    const auto byte = [](float x) { return uint8_t(std::clamp(x * 0.5f + 0.5f, 0.0f, 1.0f) * 255 + 0.5f); };
    for (size_t i = 0; i < tile.size(); ++i) {
        const glm::vec4 noise(tile[i].x, blades[i], tile[i].z, tile[i].w);
        for (int k = 0; k < 4; ++k) rgba[i * 4 + size_t(k)] = byte(noise[k]);
    }
    return rgba;
}

constexpr uint32_t kSkyline = 4096;  // directions

// What sky.frag reads: of three ranges of hills, each farther than the one before, the crest's height in a direction, a
// byte being kHighestHill; in w woods, lighter or darker. Directions go around as texture u, see `around` there.
std::vector<uint8_t> skylineOf(std::span<const uint8_t> noise) {
    const auto noiseAt = [&](glm::vec2 at) {
        at = at * float(kSide) - 0.5f;
        const glm::vec2 low = glm::floor(at), share = at - low;
        const auto texel = [&](int dx, int dy) {
            const uint32_t x = uint32_t(int(low.x) + dx) % kSide, y = uint32_t(int(low.y) + dy) % kSide;
            const uint8_t* t = &noise[(size_t(y) * kSide + x) * 4];
            return glm::vec4(t[0], t[1], t[2], t[3]);
        };
        return glm::mix(glm::mix(texel(0, 0), texel(1, 0), share.x), glm::mix(texel(0, 1), texel(1, 1), share.x),
                        share.y) /
                   255.0f -
               0.5f;
    };
    std::vector<uint8_t> rgba(kSkyline * 4);
    const auto byte = [](float x) { return uint8_t(std::clamp(x, 0.0f, 1.0f) * 255 + 0.5f); };
    for (uint32_t i = 0; i < kSkyline; ++i) {
        const float u = 4 * (float(i) + 0.5f) / kSkyline;
        const float x = u < 2 ? 1 - u : u - 3, z = (1 - std::abs(x)) * (u < 2 ? 1.0f : -1.0f);
        const glm::vec2 to = glm::normalize(glm::vec2(x, z));
        for (int range = 0; range < 3; ++range) {
            const float far = float(range);
            const glm::vec4 high = noiseAt(to * (0.24f - 0.07f * far) + 0.37f * far);
            const glm::vec4 trees = noiseAt(to * 2.1f + 0.11f * far);
            // Broad swells, hills on them, and near by the tops of woods.
            float crest = 0.013f + 0.011f * far + (0.045f + 0.012f * far) * high.x + (0.030f - 0.006f * far) * high.z +
                          (0.010f - 0.0045f * far) * trees.x;
            // The first is never without woods, so that the plain has no bare edge.
            if (range == 0) crest = std::max(crest, 0.0045f + 0.004f * trees.z + 0.006f * trees.x);
            rgba[4 * size_t(i) + size_t(range)] = byte(crest / kHighestHill);
            if (range == 0) rgba[4 * size_t(i) + 3] = byte(trees.x + 0.5f);
        }
    }
    return rgba;
}

constexpr uint32_t kPavingSide = 512;
constexpr int kSetts = 20;  // courses in a tile

// Setts in courses, of uneven widths and heights; each a little tilted, its top rounded towards the joints.
std::vector<uint8_t> pavingTile() {
    std::vector<float> height(size_t(kPavingSide) * kPavingSide), shade(height.size()), stone(height.size());
    const auto smooth = [](float a, float b, float x) {
        const float t = std::clamp((x - a) / (b - a), 0.0f, 1.0f);
        return t * t * (3 - 2 * t);
    };
    const auto layRow = [&](uint32_t y) {
        for (uint32_t x = 0; x < kPavingSide; ++x) {
            const float bend = 0.10f * octaves(x, y, 8, 2, 71);
            float v = float(y) * kSetts / kPavingSide + bend;
            v -= kSetts * std::floor(v / kSetts);
            const uint32_t course = uint32_t(v) % kSetts;
            const int across = 13 + int(course % 3);  // so that joints don't line up
            float u =
                float(x) * float(across) / kPavingSide + 0.5f * float(course % 2) + 0.10f * octaves(x, y, 8, 2, 73);
            u -= float(across) * std::floor(u / float(across));
            const uint32_t which = uint32_t(u) % uint32_t(across);
            const float random = lattice(which, course, 75), other = lattice(which, course, 77);
            const float fu = u - std::floor(u), fv = v - std::floor(v);
            const float toEdge =
                std::min(std::min(fu, 1 - fu) * 1.35f, std::min(fv, 1 - fv)) + 0.03f * octaves(x, y, 64, 2, 79);
            const size_t at = size_t(y) * kPavingSide + x;
            stone[at] = smooth(0.045f, 0.13f, toEdge);
            height[at] = stone[at] * (0.7f + 0.3f * smooth(0.1f, 0.45f, toEdge)) + 0.12f * random +
                         0.25f * other * (fu - 0.5f) + 0.10f * octaves(x, y, 64, 3, 81);
            shade[at] = std::clamp(0.52f + 0.26f * random + 0.22f * octaves(x, y, 32, 4, 83), 0.0f, 1.0f);
        }
    };
    parallelFor(kPavingSide, 16, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y) layRow(uint32_t(y));
    });
    std::vector<uint8_t> rgba(height.size() * 4);
    const auto byte = [](float v) { return uint8_t(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); };
    const auto at = [&](uint32_t x, uint32_t y) {
        return height[size_t(y % kPavingSide) * kPavingSide + x % kPavingSide];
    };
    for (uint32_t y = 0; y < kPavingSide; ++y)
        for (uint32_t x = 0; x < kPavingSide; ++x) {
            uint8_t* texel = &rgba[(size_t(y) * kPavingSide + x) * 4];
            const size_t i = size_t(y) * kPavingSide + x;
            texel[0] = byte(shade[i]);
            texel[1] = byte(stone[i]);
            texel[2] = byte(0.5f + 0.9f * (at(x + 1, y) - at(x + kPavingSide - 1, y)));
            texel[3] = byte(0.5f + 0.9f * (at(x, y + 1) - at(x, y + kPavingSide - 1)));
        }
    return rgba;
}

}  // namespace

Result<Ground> Ground::create(Device& device, VkFormat color, VkFormat depth, uint32_t samples) {
    Ground ground;
    GraphicsDesc desc;
    desc.name = "ground";
    desc.vertex = "render/ground.vert";
    desc.fragment = "render/ground.frag";
    desc.colors = {color};
    desc.depth = depth;
    desc.samples = samples;
    desc.depthCompare = VK_COMPARE_OP_GREATER_OR_EQUAL;
    for (uint32_t shading = 0; shading < kShadings; ++shading) {
        if (!isAskedOf(device, Shading(shading))) continue;
        desc.options.constants = constantsOf(Shading(shading));
        desc.blend = blendOf(Shading(shading));
        if (Status made = assign(ground.programs_[shading], Program::graphics(device, desc)); !made)
            return made.failure();
    }
    ImageDesc tile{.name = "ground noise", .width = kSide, .height = kSide};
    tile.levels = 0;
    Result<Image> image = Image::create(device, tile);
    if (!image) return image.failure();
    const std::vector<uint8_t> texels = noiseTile();
    if (Status s = fillImage(device, *image, std::as_bytes(std::span(texels))); !s) return s.failure();
    ground.noise_ = std::move(*image);
    Result<Image> skyline = Image::create(device, {.name = "skyline", .width = kSkyline, .height = 1});
    if (!skyline) return skyline.failure();
    const std::vector<uint8_t> crests = skylineOf(texels);
    if (Status s = fillImage(device, *skyline, std::as_bytes(std::span(crests))); !s) return s.failure();
    ground.skyline_ = std::move(*skyline);
    for (const bool quick : {false, true}) {
        SamplerDesc sampler{.name = "ground noise", .blendMips = !quick};
        sampler.anisotropy = device.info().traits.anisotropy;
        if (Status made = assign(ground.samplers_[quick], Sampler::create(device, sampler)); !made)
            return made.failure();
        sampler.name = "site map";
        sampler.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        if (Status made = assign(ground.siteSamplers_[quick], Sampler::create(device, sampler)); !made)
            return made.failure();
    }
    return ground;
}

Status Ground::setSite(Device& device, const SiteMap& map) {
    if (map.rgba.empty()) {
        site_ = Image();
        siteRcp_ = glm::vec2(0);
        return Done{};
    }
    const auto upload = [&](Image& image, const char* name, uint32_t width, uint32_t height,
                            const std::vector<uint8_t>& rgba) -> Status {
        ImageDesc desc{.name = name, .width = width, .height = height};
        desc.levels = 0;
        Result<Image> made = Image::create(device, desc);
        if (!made) return made.failure();
        if (Status s = fillImage(device, *made, std::as_bytes(std::span(rgba))); !s) return s;
        image = std::move(*made);
        return Done{};
    };
    if (!paving_)
        if (Status s = upload(paving_, "paving", kPavingSide, kPavingSide, pavingTile()); !s) return s;
    Image site;
    if (Status s = upload(site, "site map", map.width, map.height, map.rgba); !s) return s;
    site_ = std::move(site);
    siteLow_ = map.low;
    siteRcp_ = 1.0f / (map.high - map.low);
    return Done{};
}

void Ground::describe(FrameRecord& frame) const {
    frame.siteLow = siteLow_;
    frame.siteRcp = siteRcp_;
}

void Ground::draw(DrawPass& pass, const PostPush& push, const Buffer& frame, const Image& shadowMap,
                  const Sampler& shadowSampler, Shading shading) const {
    const bool quick = isQuick(shading);
    pass.draw(programs_[size_t(shading)], 3, 1, push,
              {noiseBinding(quick), {shadowMap, shadowSampler}, siteBinding(quick), pavingBinding(quick), frame});
}

}  // namespace espalier
