#pragma once

// How the ruin's stonework looks: which stone a point of a wall belongs to, how far it stands out, its colour.

#include <vector>

#include "tools/content/model.hpp"

namespace espalier::content {

// Where a point is among stones. joint: metres to the nearest joint's middle; edge: metres to the nearest convex
// edge of the masonry; id: of the stone; local: place in the stone relative to its middle.
struct StonePlace {
    uint32_t id = 0;
    float joint = 1, edge = 1;
    glm::vec2 local{0};
};

// Inputs to stoneDetail beside the place among stones.
struct StoneLook {
    glm::vec3 block;  // block-out position, for noise
    glm::vec2 st;
    float aboveGround = 1;  // metres
    float upward = 0;       // 1 on surfaces that face the sky, where moss and dirt lie
    float roughness = 1;    // scales bumps; broken crests take 2
    float belowCrest = 3;   // metres under a crest, for streaks
    float shift = 1;        // scales how far whole stones stand out or back
};
Detail stoneDetail(const StonePlace& place, const StoneLook& look);

// A tondo let into the wall: a dressed disc with a moulded rim and a wreath round a rosette. It takes the place of
// `wall` within its reach of the middle; local: metres from there.
inline constexpr float kTondoRadius = 0.46f;
Detail tondoDetail(glm::vec2 local, const StoneLook& look, const Detail& wall);

// An arched opening that stands on the ground.
struct Arch {
    float centre = 0, halfWidth = 0, spring = 0, ring = 0;  // metres; ring: depth of the voussoirs
    int voussoirs = 13;
    bool present() const { return halfWidth > 0; }
};

// One step of a broken crest: from `from` on, the wall is `courses` courses high.
struct CrestStep {
    float from;
    int courses;
};

// A wall in elevation: courses of stones between `begin` and `end`, under a stepped crest, around an arch.
// Coordinates are (along, y) in metres; both faces share the joints.
class Elevation {
  public:
    Elevation(float begin, float end, std::vector<CrestStep> crest, Arch arch, uint32_t salt);

    static const std::vector<float>& courseHeights();  // y of the joints between courses, from 0
    float top(float along) const;                      // metres
    float belowCrest(glm::vec2 p) const;               // metres under the crest, its steps smoothed
    const Arch& arch() const { return arch_; }
    float begin() const { return begin_; }
    float end() const { return end_; }
    const std::vector<CrestStep>& crest() const { return crest_; }

    // Stone at p; `side` salts what differs between the two faces.
    StonePlace placeAt(glm::vec2 p, uint32_t side) const;

    // Points along all joints, and beside them by `offset`.
    std::vector<glm::vec2> alongJoints(float offset) const;

    // Polylines (finely split, corners kept): the crest from (begin, top) to (end, 0); the opening from its left
    // foot over the crown to its right foot (empty without one).
    std::vector<glm::vec2> crestLine() const;
    std::vector<glm::vec2> openingLine() const;

    // Points of the foot between a and b, both ends included.
    std::vector<float> foot(float a, float b) const;

  private:
    bool inRing(glm::vec2 p) const;
    float crestDistance(glm::vec2 p) const;
    std::vector<float> fixedJoints(size_t course) const;
    void growTall(size_t course, std::vector<float>& fixed);
    void layCourse(size_t course);
    bool isTall(size_t course, float from) const;
    float begin_, end_;
    std::vector<CrestStep> crest_;
    Arch arch_;
    uint32_t salt_;
    std::vector<std::vector<float>> joints_;
    std::vector<std::vector<float>> tall_;  // of each course: where stones begin that go on into the course above
    std::vector<glm::vec2> corners_;        // of the crest
};

// Splits a-b into equal pieces no longer than `longest`; appends all but a.
void splitInto(std::vector<glm::vec2>& line, glm::vec2 b, float longest);

// Longest edge of a border, metres.
inline constexpr float kBorderEdge = 0.05f;
// The same samples wherever two walls meet in a vertical edge.
std::vector<float> verticalSamples(float top);

}  // namespace espalier::content
