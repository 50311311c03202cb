#pragma once

// Kitbashed pieces as one surface: contacts between a model's shells, and which texels are no ground because they
// lie inside of a closed piece or between faces that touch.

#include "runtime/surface/contact_bodies.hpp"
#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {

class Contacts {
  public:
    struct Options {
        bool wanted;       // false: there are none
        double tolerance;  // metres, what is nearer touches
        double texel;      // the finest level's, in UV
    };
    // links: of the mesh's borders; shells that they join are one body. A model of one shell costs next to nothing.
    // Not to be moved.
    Contacts(const BakeMesh& mesh, const std::vector<Link>& links, const Options& options);
    Contacts(const Contacts&) = delete;

    // All contacts; to be called once, since what follows does without them.
    std::vector<Contact> takeList() { return std::move(list_); }

    // Makes buried inner texels of a composed level kTexelLink: data for reads beside a contact, no ground.
    // Returns their number.
    uint64_t bury(const std::vector<Crossing>& crossings, const std::vector<Plane>& planes,
                  SurfaceLevelData& level) const;

  private:
    bool hidden(glm::dvec3 p, uint32_t triangle, uint32_t exceptBody, bool crevices = true) const;
    void dropHidden();
    void dropBehindLinks(const BakeMesh& mesh, const std::vector<Link>& links);
    void keepFirstMet();

    ContactMesh mesh_;
    Bodies bodies_;
    std::vector<Contact> list_;
    double tolerance_ = 0, texel_ = 0;
    uint32_t shells_ = 0;
};

// The part of a contact's crossing between two shares of its length.
Contact part(const Contact& contact, double from, double to);

}  // namespace espalier::bakery
