#pragma once

// How the drawing programs shade. Each kind is a program of its own, as some devices run both sides of an `if`.

#include <vector>

#include "runtime/gpu/device.hpp"
#include "runtime/gpu/program.hpp"
#include "runtime/gpu/spirv.hpp"
#include "shaders/render/frame_records.h"

namespace espalier {

// full: as settled pictures are. explaining: any view but the shaded one and overdraw. quick, quickExplaining: the same
// for a moving picture where a device has those (DeviceTraits::quickPictures), with fewer samples of shadows and
// textures. counting: of overdraw, where fragments add up.
enum class Shading : uint32_t { full = 0, explaining = 1, quick = 2, counting = 3, quickExplaining = 4 };
constexpr uint32_t kShadings = 5;

// A quality of pictures.
inline bool isQuick(Shading shading) {
    return shading == Shading::quick || shading == Shading::quickExplaining;
}
// As in the shaded view.
inline Shading plainOf(Shading shading) {
    return isQuick(shading) ? Shading::quick : Shading::full;
}
// Others are drawn with fewer pixels at full quality at most, and need no programs for it.
inline bool isAskedOf(const Device& device, Shading shading) {
    return device.info().traits.quickPictures || !isQuick(shading);
}

inline std::vector<SpecConstant> constantsOf(Shading shading, bool rooted = false, bool rest = false) {
    const bool explains = shading != Shading::full && shading != Shading::quick;
    return {{kConstantExplains, explains ? 1u : 0u},
            {kConstantRooted, rooted ? 1u : 0u},
            {kConstantQuick, isQuick(shading) ? 1u : 0u},
            {kConstantRest, rest ? 1u : 0u}};
}

// A triangle over all of a picture, in front of whatever is there.
inline GraphicsDesc fullscreen(const char* fragment) {
    GraphicsDesc desc;
    desc.name = desc.fragment = fragment;
    desc.vertex = "render/fullscreen.vert";
    desc.depthCompare = VK_COMPARE_OP_ALWAYS;
    return desc;
}

inline Blend blendOf(Shading shading) {
    return shading == Shading::counting ? Blend::additive : Blend::none;
}

}  // namespace espalier
