#pragma once

// What an independent judge says of a model: where its pieces intersect, what is inside of them, which borders are
// its own, what can be seen. By CGAL's triangle intersections and rays and by solid angles; nothing of the baker's.

#include <memory>
#include <vector>

#include "tools/bake/bake.hpp"

namespace espalier::contacttest {

using Vec3 = glm::dvec3;

struct ContactLine {
    Vec3 a, b;
};

class Oracle {
  public:
    // Vertices within a millionth of the model's radius are one.
    explicit Oracle(const Model& model);

    // Where triangles of different pieces cross each other, not merely touch: faces that lie against each other touch,
    // though by a hair of rounding their planes cross.
    std::vector<ContactLine> intersections() const;
    // Does a straight way lead from p out of the model, not to the ground under it, on which models stand? `normal`: on
    // that side only, 0: on all.
    bool seen(Vec3 p, Vec3 normal) const;
    // Is there a place beside the line that is seen, outside of all pieces that are closed, and that has room for a
    // ball of diameter `room` (0: for a point)? Kits leave out the faces that others hide: a roof's underside and the
    // attic's walls meet where no plant and no eye comes. And what is as narrow as a texel or two, walks go over.
    bool visible(const ContactLine& line, double room = 0) const;
    // The piece of the triangle that is nearest to p, by a number of its own.
    uint32_t pieceAt(Vec3 p) const;
    // How often the pieces that are closed wind around the point: 0.5 and more is inside.
    double winding(Vec3 p) const;
    // The piece that the point is inside of, deeper than `depth`, of those that are closed, and not of another's
    // making: each is asked by itself. kNoPiece: none.
    static constexpr uint32_t kNoPiece = ~0u;
    uint32_t insideOf(Vec3 p, double depth) const;
    // The distance to the nearest place on an edge of one triangle alone that nothing of another piece touches; those
    // that are farther than `within` aren't looked at.
    double toBorder(Vec3 p, double within) const;
    double toSurface(Vec3 p) const;  // the distance to the nearest triangle
    double radius() const { return radius_; }

  private:
    struct Triangle {
        Vec3 p[3];
        uint32_t point[3];
        uint32_t piece;
    };
    std::vector<Triangle> triangles_;
    std::vector<uint8_t> closed_;  // per piece
    std::vector<ContactLine> borders_;
    std::vector<uint32_t> borderTriangle_;
    double radius_ = 0;
    Vec3 low_{1e300}, high_{-1e300};
    struct Sight;
    std::shared_ptr<const Sight> sight_;
    std::vector<uint32_t> bodies_;  // the closed pieces, and of each what it looks like
    std::vector<std::shared_ptr<const Sight>> bodySight_;
};

}  // namespace espalier::contacttest
