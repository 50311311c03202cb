// In: vertices and faces as a file of polygons states them. Out: a model's triangles, and what was wrong in a few
// words.
#include "tools/bake/import_polygons.hpp"

#include <algorithm>

#include "runtime/core/srgb.hpp"
#include "tools/bake/import_polygon.hpp"

namespace espalier::import {

void Polygons::add(std::span<const uint32_t> corners, uint32_t material) {
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    sizes_.push_back(uint32_t(corners.size()));
    materials_.push_back(material);
}

void Polygons::fill(Model& model) const {
    model.indices.reserve(model.indices.size() + 3 * (corners_.size() - 2 * sizes_.size()));
    Triangulator triangulator;
    size_t first = 0;
    for (size_t i = 0; i < sizes_.size(); ++i) {
        triangulator.fill(model.positions, corners().subspan(first, sizes_[i]), model.indices);
        model.triangleMaterial.resize(model.indices.size() / 3, materials_[i]);
        first += sizes_[i];
    }
}

void Blemishes::note(const std::string& what, int line) {
    Kind& kind = kinds_[what];
    if (kind.count++ == 0) kind.line = line;
}

void Blemishes::tell(Model& model) const {
    for (const auto& [what, kind] : kinds_) {
        const std::string times = kind.count > 1 ? " (" + std::to_string(kind.count) + " times)" : "";
        model.warnings.push_back({path_, kind.line, 0, {}, what + times, true});
    }
}

void makeColoursLinear(Model& model) {
    float most = 0, mostAlpha = 0;
    bool white = true;
    for (glm::vec4& c : model.colours) {
        if (!(glm::dot(c, c) < 1e30f)) c = glm::vec4(kNotGiven);
        for (int k = 0; k < 3; ++k) most = std::max(most, c[k]);  // what is not a number isn't larger
        mostAlpha = std::max(mostAlpha, c.a);
    }
    // Some programs write numbers up to 255, most of them up to 1.
    const float scale = most > 1.5f ? 1 / 255.0f : 1, alphaScale = mostAlpha > 1.5f ? 1 / 255.0f : 1;
    for (glm::vec4& c : model.colours) {
        c = c == c ? glm::clamp(c * glm::vec4(glm::vec3(scale), alphaScale), 0.0f, 1.0f) : glm::vec4(1);
        for (int k = 0; k < 3; ++k) c[k] = linearOfSrgb(c[k]);
        white = white && c == glm::vec4(1);
    }
    if (white) model.colours.clear();
}

}  // namespace espalier::import
