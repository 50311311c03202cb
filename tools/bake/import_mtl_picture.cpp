// In: decoded pictures. Out: what they hold, or one made of two.
#include "tools/bake/import_mtl_picture.hpp"

namespace espalier::import {

bool holdsNormals(const Picture& picture) {
    double sum[3] = {};
    const size_t texels = picture.rgba.size() / 4;
    for (size_t i = 0; i < texels; ++i)
        for (size_t k = 0; k < 3; ++k) sum[k] += picture.rgba[i * 4 + k];
    for (double& channel : sum) channel /= 255.0 * double(texels);
    // Normals lie around (0, 0, 1), which is stored as (1/2, 1/2, 1).
    return std::abs(sum[0] - 0.5) < 0.15 && std::abs(sum[1] - 0.5) < 0.15 && sum[2] > 0.7;
}

std::optional<Picture> withCutOut(const Picture* colour, const Picture& shape, Intake& intake) {
    const Picture& size = colour ? *colour : shape;
    if (!intake.take(size.rgba.size())) return std::nullopt;
    Picture out{size.width, size.height, size.rgba, {}};
    bool byAlpha = false;
    for (size_t i = 3; i < shape.rgba.size(); i += 4) byAlpha = byAlpha || shape.rgba[i] < 255;
    for (uint32_t y = 0; y < out.height; ++y)
        for (uint32_t x = 0; x < out.width; ++x) {
            const size_t at = (size_t(y) * out.width + x) * 4;
            const size_t row = uint64_t(y) * shape.height / out.height, column = uint64_t(x) * shape.width / out.width;
            const uint8_t* from = &shape.rgba[(row * shape.width + column) * 4];
            if (!colour) out.rgba[at] = out.rgba[at + 1] = out.rgba[at + 2] = 255;
            out.rgba[at + 3] = byAlpha ? from[3] : uint8_t((from[0] + from[1] + from[2]) / 3);
        }
    return out;
}

}  // namespace espalier::import
