#pragma once

// What an independent judge says of a model: where its pieces intersect, what is inside of them, which borders are
// its own. By CGAL's triangle intersections and by solid angles; nothing of the baker's.

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

    // Where triangles of different pieces cross each other, not merely touch.
    std::vector<ContactLine> intersections() const;
    // Is there room beside the line, on the outside of all pieces that are closed?
    bool visible(const ContactLine& line) const;
    // How often the pieces that are closed wind around the point: 0.5 and more is inside.
    double winding(Vec3 p) const;
    // The distance to the nearest edge of one triangle alone that nothing of another piece touches; those farther than
    // `within` aren't looked at.
    double toBorder(Vec3 p, double within) const;
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
};

}  // namespace espalier::contacttest
