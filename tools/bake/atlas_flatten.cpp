// In: a patch. Out: UVs for its vertices, in metres: the map that is as rigid as possible triangle by triangle (Liu et
// al. 2008: local rotations and one sparse solve in turns). It starts from rotations that are carried over the patch
// from triangle to triangle by the hinge rule, which unfolds what is developable exactly.
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

#include "tools/bake/atlas.hpp"

namespace espalier::bakery {
namespace {

constexpr int kRounds = 24;
constexpr double kSettled = 1e-4;      // of the patch's size: a round that moves less is the last
constexpr double kLeastHeight = 0.01;  // of a triangle over its longest edge: slivers are treated as if they had it

struct Shape {
    glm::dvec2 p[3];      // in the triangle's own plane
    double cotangent[3];  // of the corner that faces edge k
};

std::vector<Shape> measureShapes(const Patch& patch) {
    std::vector<Shape> shapes(patch.triangles.size());
    for (size_t t = 0; t < shapes.size(); ++t) {
        const auto& c = patch.corner[t];
        double edge[3];
        size_t base = 0;
        for (size_t k = 0; k < 3; ++k) {
            edge[k] = glm::length(patch.point[c[(k + 1) % 3]] - patch.point[c[k]]);
            if (edge[k] > edge[base]) base = k;
        }
        glm::dvec3 origin = patch.point[c[base]], e1 = patch.point[c[(base + 1) % 3]] - origin,
                   e2 = patch.point[c[(base + 2) % 3]] - origin;
        double up = std::max(glm::length(glm::cross(e1, e2)) / edge[base], kLeastHeight * edge[base]);
        Shape& s = shapes[t];
        s.p[base] = {0, 0}, s.p[(base + 1) % 3] = {edge[base], 0};
        s.p[(base + 2) % 3] = {glm::dot(e1, e2) / edge[base], up};
        for (int k = 0; k < 3; ++k) {
            glm::dvec2 a = s.p[k] - s.p[(k + 2) % 3], b = s.p[(k + 1) % 3] - s.p[(k + 2) % 3];
            s.cotangent[k] = glm::dot(a, b) / cross(a, b);
        }
    }
    return shapes;
}

glm::dvec2 turned(glm::dvec2 by, glm::dvec2 v) {
    return {by.x * v.x - by.y * v.y, by.y * v.x + by.x * v.y};
}

// Carries a rotation from the first triangle to all others across glued edges, breadth first.
std::vector<glm::dvec2> unfold(const Patch& patch, const std::vector<Shape>& shapes) {
    std::vector<glm::dvec2> rotation(shapes.size(), glm::dvec2(0));
    std::vector<uint32_t> queue = {0};
    rotation[0] = {1, 0};
    for (size_t i = 0; i < queue.size(); ++i) {
        uint32_t t = queue[i];
        for (uint32_t k = 0; k < 3; ++k) {
            uint32_t twin = patch.twin[t * 3 + k];
            if (twin == kNone || rotation[twin / 3] != glm::dvec2(0)) continue;
            const Shape& other = shapes[twin / 3];
            uint32_t m = twin % 3;
            // The edge as this triangle has it, turned, and as the other has it: the quotient is its rotation.
            glm::dvec2 here = turned(rotation[t], shapes[t].p[(k + 1) % 3] - shapes[t].p[k]);
            glm::dvec2 there = other.p[m] - other.p[(m + 1) % 3];
            glm::dvec2 r(glm::dot(here, there), cross(there, here));
            rotation[twin / 3] = r / glm::length(r);
            queue.push_back(twin / 3);
        }
    }
    return rotation;
}

// One sparse system for both coordinates, solved for many right-hand sides.
class Stitcher {
  public:
    Stitcher(const Patch& patch, const std::vector<Shape>& shapes) : patch_(patch), shapes_(shapes) {
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(shapes.size() * 12);
        for (size_t t = 0; t < shapes.size(); ++t)
            for (size_t k = 0; k < 3; ++k) {
                int a = int(patch.corner[t][k]), b = int(patch.corner[t][(k + 1) % 3]);
                double w = shapes[t].cotangent[k];
                entries.emplace_back(a, a, w), entries.emplace_back(b, b, w);
                entries.emplace_back(std::max(a, b), std::min(a, b), -w);
            }
        // One vertex is held; the rest of the plane's motions are fixed by the rotations.
        entries.emplace_back(0, 0, 1.0);
        Eigen::SparseMatrix<double> matrix(long(patch.point.size()), long(patch.point.size()));
        matrix.setFromTriplets(entries.begin(), entries.end());
        solver_.compute(matrix);
        right_.resize(long(patch.point.size()), 2);
    }
    bool good() const { return solver_.info() == Eigen::Success; }

    void solve(const std::vector<glm::dvec2>& rotation, std::vector<glm::dvec2>& uv) {
        right_.setZero();
        for (size_t t = 0; t < shapes_.size(); ++t)
            for (size_t k = 0; k < 3; ++k) {
                glm::dvec2 d =
                    turned(rotation[t], shapes_[t].p[(k + 1) % 3] - shapes_[t].p[k]) * shapes_[t].cotangent[k];
                long a = long(patch_.corner[t][k]), b = long(patch_.corner[t][(k + 1) % 3]);
                right_(a, 0) -= d.x, right_(a, 1) -= d.y;
                right_(b, 0) += d.x, right_(b, 1) += d.y;
            }
        Eigen::MatrixX2d x = solver_.solve(right_);
        uv.resize(patch_.point.size());
        for (long i = 0; i < x.rows(); ++i) uv[size_t(i)] = {x(i, 0), x(i, 1)};
    }

  private:
    const Patch& patch_;
    const std::vector<Shape>& shapes_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
    Eigen::MatrixX2d right_;
};

// The rotation nearest to each triangle's map from its own plane into UV.
void fitRotations(const Patch& patch, const std::vector<Shape>& shapes, std::vector<glm::dvec2>& rotation) {
    for (size_t t = 0; t < shapes.size(); ++t) {
        glm::dvec2 sum(0);
        for (size_t k = 0; k < 3; ++k) {
            glm::dvec2 from = shapes[t].p[(k + 1) % 3] - shapes[t].p[k];
            glm::dvec2 to = patch.uv[patch.corner[t][(k + 1) % 3]] - patch.uv[patch.corner[t][k]];
            sum += glm::dvec2(glm::dot(from, to), cross(from, to)) * shapes[t].cotangent[k];
        }
        double length = glm::length(sum);
        if (length > 0) rotation[t] = sum / length;
    }
}

}  // namespace

void flatten(Patch& patch) {
    std::vector<Shape> shapes = measureShapes(patch);
    std::vector<glm::dvec2> rotation = unfold(patch, shapes);
    Stitcher stitcher(patch, shapes);
    if (!stitcher.good()) {
        patch.uv.assign(patch.point.size(), glm::dvec2(0));
        return;
    }
    stitcher.solve(rotation, patch.uv);
    double area = 0;
    for (const Shape& s : shapes) area += cross(s.p[1] - s.p[0], s.p[2] - s.p[0]) / 2;
    std::vector<glm::dvec2> before;
    for (int round = 0; round < kRounds; ++round) {
        before = patch.uv;
        fitRotations(patch, shapes, rotation);
        stitcher.solve(rotation, patch.uv);
        double moved = 0;
        for (size_t i = 0; i < before.size(); ++i) moved = std::max(moved, glm::length(patch.uv[i] - before[i]));
        if (moved < kSettled * std::sqrt(area)) break;
    }
}

}  // namespace espalier::bakery
