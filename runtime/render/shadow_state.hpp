#pragma once

// What the map of shadows shows, and what of it a picture draws anew: its near half shows all about what is looked at,
// its wide half all that stands but growth. No Vulkan in it.

#include <cstdint>
#include <glm/glm.hpp>

namespace espalier {

// What casts shadows, and where they are asked for; equal ones have equal maps.
struct ShadowScene {
    uint64_t growth = 0, stands = 0, roofs = 0;  // revisions
    glm::vec3 sun{0};                            // its direction
    uint32_t nodes = 0, leaves = 0;
    glm::vec4 sphere{0};  // that the map covers: centre, radius; metres
    bool operator==(const ShadowScene&) const = default;
};

// What a picture asks of them. mayLag: coarser or earlier ones will do while something changes. quick: it is drawn
// quickly itself.
struct ShadowWish {
    bool shadows = true, mayLag = false, quick = false;
};

class NearShadows {
  public:
    // Of tiles only those that edits of growth have changed.
    enum class Redraw { nothing, fewTiles, allTiles, whole };

    // Once a picture. False: the map is good for it.
    bool begin(const ShadowScene& now, const ShadowWish& wish);
    // What of it has to be drawn anew then. bindings: how often growth was bound whole; tiles hold over one such
    // binding.
    Redraw redraw(bool grows, uint64_t bindings) const;
    // Fewer and larger leaves will do in what is drawn anew.
    bool coarse() const { return coarseNow_; }

    // kept: edits of growth can be redrawn alone from now on.
    void drewWhole(bool kept, uint64_t bindings);
    void drewAllTiles();
    void drewFewTiles() { ++taken_; }
    void clear() { drawn_ = false; }

    bool drawn() const { return drawn_; }
    bool behind() const { return behind_; }  // of what this picture shows
    uint32_t timesWhole() const { return whole_; }
    uint32_t timesPartly() const { return partly_; }
    uint32_t timesTaken() const { return taken_; }

  private:
    ShadowScene shown_, now_;
    uint64_t growthBefore_ = 0, bindings_ = 0;
    uint32_t changes_ = 0;  // pictures in a row for which growth has changed
    uint32_t whole_ = 0, partly_ = 0, taken_ = 0;
    bool drawn_ = false, kept_ = false, coarse_ = false;
    bool stroke_ = false, coarseNow_ = false, behind_ = false;
};

class WideShadows {
  public:
    // Once a picture that has them. True: they have to be drawn anew.
    bool begin(const ShadowScene& now, bool mayLag);
    void drew(const ShadowScene& now, const glm::mat4& toTexture);
    void clear() { drawn_ = false; }

    bool drawn() const { return drawn_; }
    bool behind() const { return behind_; }
    const glm::mat4& toTexture() const { return toTexture_; }  // world -> texture coordinates and depth
    float radius() const { return shown_.sphere.w; }           // metres

  private:
    ShadowScene shown_, before_;
    glm::mat4 toTexture_{1};
    uint32_t changes_ = 0;  // pictures in a row for which what casts them has changed
    bool drawn_ = false, behind_ = false;
};

}  // namespace espalier
