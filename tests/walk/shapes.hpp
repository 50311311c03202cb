#pragma once

// Analytic surfaces cut into charts, and their exact geodesics in double precision. Shares no code with the walk.

#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "runtime/surface/surface.hpp"
#include "tools/bake/bake.hpp"

namespace espalier::walktest {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;

// Where a chart's parameter square [0,1]² lies in the atlas: turned by `angle`, `mirror` flips it.
struct AtlasCell {
    Vec2 centre;
    Vec2 extent;
    double angle = 0;
    bool mirror = false;
    Vec2 toUv(Vec2 ab) const;
    Vec2 toParameter(Vec2 uv) const;
};

// One chart: a parameter square, `at` its embedding (defined a little beyond the square too), na × nb quads.
struct ChartPatch {
    std::function<Vec3(Vec2)> at;
    int na = 1, nb = 1;
    AtlasCell cell;
};

// The end of a walk, or nothing where the exact geodesic leaves the surface.
using Geodesic = std::function<std::optional<Vec3>(Vec3 from, Vec3 direction, double length)>;

struct Shape {
    std::string name;
    std::vector<ChartPatch> charts;
    std::function<Vec3(Vec3)> normal;  // outward, at a point of the surface
    Geodesic geodesic;
    double radius = 1;  // of the bounds
};

// detail: quads along a chart's side where the shape is curved. mirrors: some charts are mirrored in the atlas, which
// the paper's walk has to exclude.
Shape sphere(int detail, bool mirrors = true);
Shape torus(int detail, bool mirrors = true);
Shape cylinder(int detail, bool mirrors = true);
Shape cone(int detail, bool mirrors = true);
Shape cubeOfSixCharts(bool mirrors = true);
Shape cubeWithStrip(bool mirrors = true);  // four faces in one chart that meets itself, and two more charts

// The shape as a mesh, a baker's input: its UVs are the atlas.
Model toModel(const Shape& shape);

// The geometry image straight from the formulas, without the baker: positions from `at`, crossings along the charts'
// sides. No triangles and so no creases: not for the cube's strip.
SurfaceData toSurface(const Shape& shape, uint32_t resolution, uint32_t levels);

// A random start on the shape, away from its border: where, in which chart's UV, which way.
struct Start {
    Vec3 position;
    Vec3 direction;
    Vec2 uv;
    int chart;
};
Start randomStart(const Shape& shape, std::mt19937_64& random);

}  // namespace espalier::walktest
