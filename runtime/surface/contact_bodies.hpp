#pragma once

// Which bodies of a mesh are solid, and what is hidden by them: the ground that contacts take away.

#include <span>

#include "runtime/surface/contacts.hpp"

namespace espalier {

// A place on some surface, asked about: is it hidden by these bodies?
struct HiddenQuery {
    glm::dvec3 position, normal;  // normal: unit, outward; in the space of the bodies' mesh
    uint32_t body = kNoIndex;     // its own body when it is one of these
    uint32_t except = kNoIndex;   // a further body that hides nothing here
    bool solid = false;           // it belongs to a solid body
    bool yields = false;          // of equal faces in one place it is the one that is hidden; unused when body is set
};

class Bodies {
  public:
    Bodies() = default;
    // Sets mesh.solid and mesh.lining. A body is solid when it encloses room, its holes closed by fans: kits leave out
    // what stands on the ground. Holes must be small, or lie against other bodies all around, as the backs of stones
    // that stand out of a wall. A lining is a body whose outside lies within other, solid ones, as the inner skin of a
    // window's niche whose faces lie against those of the wall: nobody sees it, so it hides nothing and no contact
    // leads to it. open: per half-edge the share of it that leads nowhere. The mesh must outlive this, unchanged.
    Bodies(ContactMesh& mesh, std::span<const float> open);

    // Inside of a solid body other than its own, covered by a face nearer than the tolerance (metres), or, if asked
    // for, in a crevice below a body that is half as wide again.
    bool hide(const HiddenQuery& query, double tolerance, bool crevices = true) const;

    const BoxTree& tree() const { return tree_; }  // over the mesh's triangles
    // May a triangle, or what closes a hole of a solid body, meet the box?
    bool meets(const Box& box) const;
    // Is p inside of a solid body? Alike for all of a box that meets() nothing.
    bool enclose(glm::dvec3 p) const { return inside({p, glm::dvec3(0)}, 0); }

  private:
    struct Wall {
        glm::dvec3 a, b, c;
        uint32_t body;
    };
    // A solid body: its triangles and what closes its holes.
    struct Solid {
        uint32_t body;
        std::vector<Wall> walls;
        BoxTree tree;
        bool encloses(glm::dvec3 p) const;
        bool encloses(glm::dvec3 p, glm::dvec3 ray) const;
    };
    // Is p on or in another body?
    bool touched(glm::dvec3 p, uint32_t body, double tolerance) const;
    void buildSolids(const std::vector<Wall>& all);
    std::vector<uint8_t> findLinings(double tolerance) const;
    bool inside(const HiddenQuery& query, double above) const;
    bool covered(const HiddenQuery& query, double tolerance) const;

    const ContactMesh* mesh_ = nullptr;
    BoxTree tree_;
    std::vector<Solid> solids_;
    BoxTree solidTree_;
};

}  // namespace espalier
