// Enters: sRGB bytes. Leaves: an image with mips, sRGB or square roots.
#include "runtime/gpu/color_texture.hpp"

#include <array>
#include <cmath>
#include <utility>
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

size_t addColorTexture(Upload& upload, std::string name, uint32_t width, uint32_t height, std::span<const uint8_t> rgba,
                       bool roots) {
    const auto bytes = std::as_bytes(rgba);
    std::vector<std::byte> texels(bytes.begin(), bytes.end());
    if (roots) {
        static const std::array<uint8_t, 256> table = rootsOfSrgb();
        for (size_t i = 0; i < texels.size(); ++i)
            if (i % 4 != 3) texels[i] = std::byte(table[size_t(texels[i])]);
    }
    const VkFormat format = roots ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_R8G8B8A8_SRGB;
    return upload.addImage(std::move(name), format, width, height, std::move(texels));
}

Result<Image> makeColorTexture(Device& device, std::string_view name, uint32_t width, uint32_t height,
                               std::span<const uint8_t> rgba) {
    Upload upload;
    const size_t image = addColorTexture(upload, std::string(name), width, height, rgba, holdsRoots(device));
    if (Status done = upload.run(device); !done) return done.failure();
    return upload.takeImage(image);
}

}  // namespace espalier
