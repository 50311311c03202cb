// From which height on a mesh is solid: closed, and turned outward.
#include <doctest/doctest.h>

#include <limits>

#include "runtime/render/solid.hpp"

using namespace espalier;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr glm::vec3 kUp{0, 1, 0};

struct Mesh {
    std::vector<DrawVertex> vertices;
    std::vector<uint32_t> indices;

    // A face each with corners of its own, as a file has them where normals differ. without: 0 to 5, a face left out.
    void addBox(glm::vec3 low, glm::vec3 high, int without = -1, bool inward = false) {
        for (int face = 0; face < 6; ++face) {
            if (face == without) continue;
            const int axis = face >> 1, side = face & 1;
            const uint32_t first = uint32_t(vertices.size());
            for (int corner = 0; corner < 4; ++corner) {
                glm::vec3 at;
                at[axis] = float(side);
                at[(axis + 1) % 3] = float((corner ^ (corner >> 1)) & 1);
                at[(axis + 2) % 3] = float(corner >> 1);
                vertices.push_back({low + at * (high - low), {}, {}, {}, {}});
            }
            for (uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u})
                indices.push_back(first + (((side == 1) != inward) ? i : 3 - i));
        }
    }
    float solidFrom(glm::vec3 up = kUp) const { return solidAbove(vertices, indices, up); }
};

}  // namespace

TEST_CASE("a closed mesh is solid as a whole, an open one above its open edges") {
    Mesh closed;
    closed.addBox({-1, -0.5f, -1}, {1, 3, 1});
    CHECK(closed.solidFrom() == -kInfinity);
    closed.addBox({0, 2, 0}, {2, 4, 2});  // another piece that runs into it
    CHECK(closed.solidFrom() == -kInfinity);
    for (int face = 0; face < 6; ++face) {
        CAPTURE(face);
        Mesh open = closed;
        open.addBox({5, -2, 5}, {6, 1, 6}, face);
        CHECK(open.solidFrom() == (face == 2 ? -2.0f : 1.0f));
        CHECK(open.solidFrom({0, 2, 0}) == (face == 2 ? -4.0f : 2.0f));
    }
}

TEST_CASE("a piece that is turned inside out is not solid, a sheet with two faces is") {
    Mesh mesh;
    mesh.addBox({-9, -9, -9}, {9, 9, 9});
    Mesh cavity = mesh;
    cavity.addBox({-1, -1, -1}, {1, 1, 1}, -1, true);
    CHECK(cavity.solidFrom() == kInfinity);
    Mesh bowl = mesh;
    bowl.addBox({-1, -1, -1}, {1, 1, 1}, 2, true);
    CHECK(bowl.solidFrom() == kInfinity);
    Mesh sheet = mesh;
    const uint32_t first = uint32_t(sheet.vertices.size());
    for (float x : {0.0f, 1.0f, 2.0f}) sheet.vertices.push_back({{x, x * x, 20}, {}, {}, {}, {}});
    for (uint32_t i : {0u, 1u, 2u, 2u, 1u, 0u}) sheet.indices.push_back(first + i);
    CHECK(sheet.solidFrom() == -kInfinity);
    sheet.indices.resize(sheet.indices.size() - 3);
    CHECK(sheet.solidFrom() == 4);
    CHECK(Mesh().solidFrom() == -kInfinity);
}
