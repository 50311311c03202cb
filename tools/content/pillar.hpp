#pragma once

// What stands freely on the ground: a profile swept round an axis, its section between square and circle.

#include <string>

#include "tools/content/ruin.hpp"

namespace espalier::content {

// A ring of the profile. square: 1 a square of half width r, 0 a circle of radius r.
struct Ring {
    float y, r, square;
};

// Carved work over the profile: metres outwards at q of the section (unturned) and height y.
using Relief = float (*)(glm::vec2 q, float y);

struct Pillar {
    std::string name;
    glm::vec2 foot;                        // (x, z)
    float turn = 0;                        // radians about the axis
    std::vector<std::vector<Ring>> bands;  // a chart each, from the ground up; consecutive ones share a ring
    float topTilt = 0;                     // slope of the broken top
    float topBulge = 0;                    // relief of the top
    std::vector<float> joints;             // heights of joints between drums
    std::vector<float> edges;              // heights of worn edges
    uint32_t pieces = 48;                  // round the axis, a multiple of 8
    uint32_t salt = 1;
    bool spiralMask = false;
    float ringDistance = 0.055f;  // metres along the profile, at most
    float roughness = 0.8f;
    float dry = 0;  // metres less that damp and moss climb
    Relief relief = nullptr;
    bool shallow = false;   // the relief is told by shading alone: what grows finds a smooth shaft
    bool earthTop = false;  // soil on top instead of stone
};

// Appends the charts, and the loop that the foot leaves in the ground.
void addPillar(std::vector<Chart>& charts, std::vector<Loop>& footprints, const Pillar& pillar);

// The court's sculpture: a campana urn with gadroons on a panelled pedestal.
Pillar urn();

}  // namespace espalier::content
