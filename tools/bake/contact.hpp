#pragma once

// Kitbashed pieces as one surface: contacts between a model's shells, and which texels are no ground because they
// lie inside of a closed piece or between faces that touch.

#include "runtime/surface/contacts.hpp"
#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {

class Contacts {
  public:
    // links: of the mesh's borders; shells that they join are one body. tolerance: metres, what is nearer touches.
    // texel: the finest level's, in UV. A model of one shell costs next to nothing.
    Contacts(const BakeMesh& mesh, const std::vector<Link>& links, double tolerance, double texel);

    const std::vector<Contact>& list() const { return list_; }

    // Makes buried inner texels of a composed level kTexelLink: data for reads beside a contact, no ground.
    // Returns their number.
    uint64_t bury(const std::vector<Crossing>& crossings, const std::vector<Plane>& planes,
                  SurfaceLevelData& level) const;

    // Is a point of a triangle inside another body, or covered by another face? normal: the triangle's, outward.
    bool hidden(glm::dvec3 p, uint32_t triangle) const;

  private:
    struct Cap {
        glm::dvec3 a, b, c;
        uint32_t body;
    };
    void findShells(const BakeMesh& mesh, const std::vector<Link>& links);
    void closeBodies(const std::vector<Link>& links);
    bool inside(glm::dvec3 p, uint32_t ownBody) const;
    bool inside(glm::dvec3 p, glm::dvec3 direction, uint32_t ownBody) const;
    bool covered(glm::dvec3 p, uint32_t triangle) const;

    ContactMesh mesh_;
    std::vector<glm::dvec3> normals_;  // per triangle
    BoxTree tree_;
    std::vector<Cap> walls_;  // triangles of solid bodies and what closes their holes
    BoxTree wallTree_;
    std::vector<Contact> list_;
    double tolerance_ = 0;
    uint32_t shells_ = 0;
};

}  // namespace espalier::bakery
