#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace espalier {

// Where something meets a mesh: the weights are those of the triangle's second and third corner.
struct MeshHit {
    uint32_t triangle = 0;
    glm::vec2 weights{0};
    glm::vec3 position{0};
    float distance = 0;  // along the ray in lengths of its direction, or from the point asked for
};

// A tree of boxes over a mesh's triangles, for picking and nearest points on the CPU. It copies what it needs;
// after building it is read-only and may be shared between threads. Degenerate triangles are never hit by rays.
class MeshTree {
  public:
    MeshTree() = default;
    // indices: three a triangle, each below positions.size(). Any number of triangles, none included.
    MeshTree(std::span<const glm::vec3> positions, std::span<const uint32_t> indices);

    // The first triangle, from either side, that origin + t * direction meets with 0 <= t < limit.
    std::optional<MeshHit> pick(glm::vec3 origin, glm::vec3 direction,
                                float limit = std::numeric_limits<float>::infinity()) const;
    // The nearest point nearer than `limit`; or any not farther than `enough`, which is found sooner.
    std::optional<MeshHit> nearest(glm::vec3 point, float limit = std::numeric_limits<float>::infinity(),
                                   float enough = 0) const;

    uint64_t bytes() const { return nodes_.size() * sizeof(Node) + triangles_.size() * sizeof(Triangle); }

  private:
    // count 0: inner node with children first and first + 1; else triangles [first, first + count).
    struct Node {
        glm::vec3 low, high;
        uint32_t first = 0, count = 0;
    };
    struct Triangle {
        glm::vec3 a, ab, ac;
        uint32_t index;
    };

    std::vector<Node> nodes_;
    std::vector<Triangle> triangles_;
};

}  // namespace espalier
