#pragma once

// What a kind of roof asks of a house's skeleton: a slope for each edge, its gables, and the height of a break.

#include <string>

#include "runtime/core/result.hpp"
#include "runtime/roof/footprint.hpp"
#include "runtime/roof/shapes_attempts.hpp"
#include "runtime/roof/shapes_beside.hpp"

namespace espalier {

// Plans of one house. Refers to what it is given, for as long as it lives. One thread.
class RoofPlanner {
  public:
    RoofPlanner(const Footprint& footprint, const RepairedOutline& outline, const OutlineEdges& edges,
                const OutlineNeighbours& neighbours, RoofAttempts& attempts, std::vector<Diagnostic>& diagnostics);

    // plain: slopes and gables of the footprint's own don't count. What can't be had is said and replaced by hips.
    RoofPlan planOf(RoofShape shape, bool plain);
    // Gives up a wish that may be why a plan made no roof, and says so: first where the ridge lies, then that the roof
    // ends at neighbours' walls. False: there is none left.
    bool giveUpWish();

    // Tangent that the footprint asks for, or the shape's usual one.
    double slopeOf(RoofShape shape) const;
    // Where a shed falls to, radians clockwise from north, if the footprint says so.
    std::optional<double> fallOf() const;
    // What the footprint says of a ridge and this shape doesn't have.
    void nameUnusedRidge(RoofShape shape);

    // A note about this house.
    void say(const std::string& what);

  private:
    struct Ridge {
        double height = 0, length = 0;  // of what is level at the top
    };
    // What the plan's roof would have without a break; a height of 0: it can't be made.
    Ridge ridgeOf(const RoofPlan& plan);
    void nameDirectionBetweenWalls();
    // Speeds that bring all edges to one apex over the centroid, if it lies before all of them.
    bool pyramid(double slope, std::vector<double>& speeds) const;
    void chooseGables(RoofShape shape, std::vector<double>& speeds);
    void breakSlopes(RoofShape shape, double slope, RoofPlan& plan);
    void ownSlopes(std::vector<double>& speeds);
    void levelLines(std::vector<double>& speeds, std::vector<bool>& own);

    const Footprint& footprint_;
    const RepairedOutline& outline_;
    const OutlineEdges& edges_;
    RoofAttempts& attempts_;
    std::vector<Diagnostic>& diagnostics_;
    std::vector<bool> closed_;         // edges at which a neighbour ends the roof
    std::optional<glm::dvec2> ridge_;  // where the footprint asks the ridge to lead
};

}  // namespace espalier
