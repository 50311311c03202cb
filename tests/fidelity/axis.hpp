#pragma once

// Grows a grammar on a model and measures how the bark's curves lie to the model's triangles.

#include <string>

#include "tests/fidelity/signed_distance.hpp"
#include "tools/bake/bake.hpp"

namespace espalier::fidelitytest {

// Shares are of samples (16 a span), distances in radii of the bark there.
struct AxisFigures {
    uint32_t spans = 0;
    double nodesWithin = 0;                           // share of nodes within one radius: what the walk alone does
    double within = 0;                                // share of samples within one radius
    double floating = 0, sinking = 0;                 // shares more than one radius above and below the mesh
    double median = 0, p99 = 0, p999 = 0, worst = 0;  // of |distance|
    double worstBreak = 0, break999 = 0;              // degrees, at joints
    double withinTexel = 0;  // share of samples within one radius or one texel of the chart, whichever is more
    // Of the samples beyond one radius, shares by cause: an end of the span is out itself; the straight line between
    // the ends would stay within, so the handles are to blame; the ends' normals differ by more than 20 degrees, so a
    // corner is cut; else something lies between ends that are alike. And the median of their radii, in texels.
    double outNodes = 0, outHandles = 0, outCorners = 0, outBetween = 0, outTexels = 0;
};

struct AxisCase {
    std::string grammar;  // file name in content/grammars
    uint32_t seeds = 12;
    uint32_t maxNodes = 40'000;
};

AxisFigures measureAxis(const Baked& baked, const SignedDistance& mesh, const AxisCase& c);

void printHeading();
void print(const std::string& name, const AxisCase& c, const AxisFigures& f);

}  // namespace espalier::fidelitytest
