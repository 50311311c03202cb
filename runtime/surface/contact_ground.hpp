#pragma once

// A placed surface as contacts with others are found on it, and those contacts.

#include <memory>

#include "runtime/surface/contact_bodies.hpp"
#include "runtime/surface/surface.hpp"
#include "runtime/surface/tile_boxes.hpp"

namespace espalier {

// The mesh is made from what is drawn, which is quantised to 16 bits: good to a hundred-thousandth of the model's size,
// and to a small part of a texel in UV.
class ContactGround {
  public:
    // Reads vertices, indices, charts, crossings and texels; triangles without a place in the walk's UVs are left out.
    // `data` isn't needed after.
    explicit ContactGround(const SurfaceData& data);
    ContactGround(const ContactGround&) = delete;

    const ContactMesh& mesh() const { return mesh_; }
    const Bodies& bodies() const { return bodies_; }
    uint32_t bodyCount() const { return uint32_t(mesh_.solid.size()); }
    double texel() const { return texel_; }  // metres, object space: of the finest level
    double texelUv() const { return texelUv_; }
    const TileBoxes& tiles(size_t level) const { return tiles_[level]; }
    bool solidChart(uint32_t chart) const { return mesh_.solid[bodyOfChart_[chart]] != 0; }

  private:
    ContactMesh mesh_;
    Bodies bodies_;
    double texel_ = 0, texelUv_ = 0;
    std::vector<uint32_t> bodyOfChart_;
    std::vector<TileBoxes> tiles_;  // per level
};

struct PlacedGround {
    const ContactGround* ground;
    glm::dmat4 toWorld;  // a move, a turn and an even scale, mirrored perhaps
};

// The contacts between two placed surfaces, in both directions: crossings complete but for the instance in `target`.
// A point touches what is nearer than a texel of its own surface. others: further surfaces, which may hide contacts.
struct PlacedContacts {
    std::vector<Crossing> fromA, fromB;
};
PlacedContacts contactsOf(const PlacedGround& a, const PlacedGround& b, std::span<const PlacedGround> others);

// Is a place of another surface within a solid body of this one, or beneath a face that lies on it? All in world space;
// query.body: kNoIndex. tolerance: metres, a texel of the place's own surface. crevices: as for Bodies::hide.
bool hiddenBy(const PlacedGround& by, HiddenQuery query, double tolerance, bool crevices = true);

}  // namespace espalier
