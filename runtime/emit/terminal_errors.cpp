// Enters: terminal meshes on the CPU, each with its levels of detail. Leaves: how far each level lies from the finest.
#include <algorithm>
#include <cmath>

#include "runtime/emit/terminals.hpp"
#include "runtime/surface/box_tree.hpp"

namespace espalier {
namespace {

// Of a cut-out of two triangles at least, in sizes: its outline and light show more than its distance does. Where
// leaves of less than eight pixels are thinned out and 1.2 pixels are allowed, none is drawn: it is for pictures of
// what moves.
constexpr float kKiteError = 0.16f;

float distanceToSegment(glm::vec3 p, glm::vec3 a, glm::vec3 b) {
    const glm::vec3 d = b - a;
    const float t = glm::clamp(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-20f), 0.0f, 1.0f);
    return glm::length(p - a - d * t);
}

float distanceToTriangle(glm::vec3 p, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const glm::vec3 n = glm::cross(b - a, c - a);
    const float n2 = glm::dot(n, n);
    if (n2 > 1e-20f) {
        const bool inside = glm::dot(glm::cross(b - a, p - a), n) >= 0 && glm::dot(glm::cross(c - b, p - b), n) >= 0 &&
                            glm::dot(glm::cross(a - c, p - c), n) >= 0;
        if (inside) return std::abs(glm::dot(p - a, n)) / std::sqrt(n2);
    }
    return std::min({distanceToSegment(p, a, b), distanceToSegment(p, b, c), distanceToSegment(p, c, a)});
}

// A LOD's triangles in a tree of boxes.
class LodDistance {
  public:
    LodDistance(const TerminalData& data, const TerminalLod& lod) {
        std::vector<Box> boxes;
        for (uint32_t i = 0; i < lod.indexCount; ++i) {
            corners_.push_back(data.vertices[lod.firstVertex + data.indices[lod.firstIndex + i]].position);
            if (i % 3 == 0) boxes.emplace_back();
            boxes.back().add(corners_.back());
        }
        tree_ = BoxTree(std::move(boxes), {});
    }
    double squareAt(glm::vec3 p) const {
        return tree_.nearestSquare(p, [&](uint32_t i) {
            const double d = distanceToTriangle(p, corners_[3 * i], corners_[3 * i + 1], corners_[3 * i + 2]);
            return d * d;
        });
    }

  private:
    std::vector<glm::vec3> corners_;
    BoxTree tree_;
};

}  // namespace

void measureTerminalErrors(TerminalData& data) {
    for (TerminalVariant& variant : data.variants) {
        if (variant.lods.size() < 2) continue;
        const TerminalLod& full = variant.lods[0];
        const LodDistance toFull(data, full);
        for (size_t l = 1; l < variant.lods.size(); ++l) {
            TerminalLod& lod = variant.lods[l];
            if (lod.pixels > 0) {
                lod.error = std::min(1 / lod.pixels, 1e30f);
                continue;
            }
            const LodDistance toLod(data, lod);
            // The root of the mean square: one far point, like the end of a stalk, doesn't decide for all.
            double sum = 0;
            uint32_t count = full.vertexCount;
            for (uint32_t i = 0; i < full.vertexCount; ++i)
                sum += toLod.squareAt(data.vertices[full.firstVertex + i].position);
            // A cut-out may reach further than the shape: its texture takes that away again.
            const bool cutOut = data.materials[lod.material].alphaCutoff > 0;
            if (!cutOut) {
                count += lod.vertexCount;
                for (uint32_t i = 0; i < lod.vertexCount; ++i)
                    sum += toFull.squareAt(data.vertices[lod.firstVertex + i].position);
            }
            const float error = std::min(float(std::sqrt(sum / std::max(count, 1u))), 1e30f);
            const float least = cutOut && lod.indexCount <= 6 ? kKiteError : 1e-4f;
            lod.error = std::max({error, variant.lods[l - 1].error * 1.01f, least});
        }
    }
}

}  // namespace espalier
