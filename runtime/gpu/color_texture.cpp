// Enters: sRGB bytes. Leaves: an image with mips, sRGB or square roots.
#include "runtime/gpu/color_texture.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "runtime/core/srgb.hpp"

namespace espalier {
namespace {

std::array<uint8_t, 256> rootsOfSrgb() {
    std::array<uint8_t, 256> roots{};
    for (size_t i = 0; i < roots.size(); ++i) {
        roots[i] = uint8_t(std::sqrt(linearOfSrgb(float(i) / 255)) * 255 + 0.5f);
    }
    return roots;
}

}  // namespace

bool holdsRoots(const Device& device) {
    return device.info().cpu;
}

Result<Image> makeColorTexture(Device& device, std::string_view name, uint32_t width, uint32_t height,
                               std::span<const uint8_t> rgba) {
    ImageDesc desc{.name = name, .format = VK_FORMAT_R8G8B8A8_SRGB, .width = width, .height = height};
    desc.levels = 0;
    std::vector<uint8_t> roots;
    if (holdsRoots(device)) {
        desc.format = VK_FORMAT_R8G8B8A8_UNORM;
        static const std::array<uint8_t, 256> table = rootsOfSrgb();
        roots.assign(rgba.begin(), rgba.end());
        for (size_t i = 0; i < roots.size(); ++i)
            if (i % 4 != 3) roots[i] = table[roots[i]];
        rgba = roots;
    }
    Result<Image> image = Image::create(device, desc);
    if (!image) return image;
    if (Status s = fillImage(device, *image, std::as_bytes(rgba)); !s) return s.failure();
    return image;
}

}  // namespace espalier
