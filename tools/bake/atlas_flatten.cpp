// In: a patch. Out: UVs for its vertices, in metres: the map that is as rigid as possible triangle by triangle (Liu et
// al. 2008: local rotations and one sparse solve in turns). It starts from rotations that are carried over the patch
// from triangle to triangle by the hinge rule, which unfolds what is developable exactly: that is done then.
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

#include "tools/bake/atlas.hpp"

namespace espalier::bakery {
namespace {

constexpr int kRounds = 24;
constexpr int kTrialRounds = 5;    // after so many it mostly can be a chart: then it is left at that
constexpr double kStride = 1.8;    // how much farther than to its solution a round goes: below 2 it always converges
constexpr double kSettled = 1e-4;  // of the patch's size: a round that moves less is the last
constexpr double kFlat = 1e-4;     // of a triangle's altitude: how far its corners may lie off where it lies flat
constexpr double kLeastHeight = 0.01;  // of a triangle over its longest edge: slivers are treated as if they had it

struct Shape {
    glm::dvec2 edge[3];   // from corner k to the next, in the triangle's own plane
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
        glm::dvec2 top(glm::dot(e1, e2) / edge[base], up);
        Shape& s = shapes[t];
        s.edge[base] = {edge[base], 0}, s.edge[(base + 1) % 3] = top - s.edge[base], s.edge[(base + 2) % 3] = -top;
        for (int k = 0; k < 3; ++k) {
            glm::dvec2 a = s.edge[(k + 2) % 3], b = -s.edge[(k + 1) % 3];
            s.cotangent[k] = glm::dot(a, b) / cross(a, b);
        }
    }
    return shapes;
}

glm::dvec2 turned(glm::dvec2 by, glm::dvec2 v) {
    return {by.x * v.x - by.y * v.y, by.y * v.x + by.x * v.y};
}

// Triangles turned as the first one lies, and vertices where the triangles that come to them first have them.
struct Unfolded {
    std::vector<glm::dvec2> rotation;  // per triangle
    std::vector<glm::dvec2> at;        // per vertex
};

// Carries a rotation from the first triangle to all others across glued edges, breadth first.
Unfolded unfold(const Patch& patch, const std::vector<Shape>& shapes) {
    Unfolded out{std::vector<glm::dvec2>(shapes.size(), glm::dvec2(0)), std::vector<glm::dvec2>(patch.point.size())};
    auto& rotation = out.rotation;
    std::vector<uint32_t> queue = {0};
    std::vector<uint8_t> placed(patch.point.size(), 0);
    rotation[0] = {1, 0};
    placed[patch.corner[0][0]] = 1;
    for (size_t i = 0; i < queue.size(); ++i) {
        uint32_t t = queue[i];
        for (uint32_t k = 0; k < 5; ++k) {  // each corner from one that is placed, wherever that is
            const uint32_t from = patch.corner[t][k % 3], to = patch.corner[t][(k + 1) % 3];
            if (!placed[from] || placed[to]) continue;
            out.at[to] = out.at[from] + turned(rotation[t], shapes[t].edge[k % 3]);
            placed[to] = 1;
        }
        for (uint32_t k = 0; k < 3; ++k) {
            uint32_t twin = patch.twin[t * 3 + k];
            if (twin == kNone || rotation[twin / 3] != glm::dvec2(0)) continue;
            // The edge as this triangle has it, turned, and as the other has it: the quotient is its rotation.
            glm::dvec2 here = turned(rotation[t], shapes[t].edge[k]), there = -shapes[twin / 3].edge[twin % 3];
            glm::dvec2 r(glm::dot(here, there), cross(there, here));
            rotation[twin / 3] = r / glm::length(r);
            queue.push_back(twin / 3);
        }
    }
    return out;
}

// Does every triangle lie as its corners have been placed? What is developable does.
bool fits(const Unfolded& unfolded, const Patch& patch, const std::vector<Shape>& shapes) {
    for (size_t t = 0; t < shapes.size(); ++t) {
        const Shape& s = shapes[t];
        const double altitude = cross(s.edge[2], s.edge[0]) /
                                std::sqrt(std::max({glm::dot(s.edge[0], s.edge[0]), glm::dot(s.edge[1], s.edge[1]),
                                                    glm::dot(s.edge[2], s.edge[2])}));
        for (size_t k = 0; k < 3; ++k) {
            const glm::dvec2 edge = unfolded.at[patch.corner[t][(k + 1) % 3]] - unfolded.at[patch.corner[t][k]];
            if (!(glm::length(edge - turned(unfolded.rotation[t], s.edge[k])) < kFlat * altitude)) return false;
        }
    }
    return true;
}

// One sparse system for both coordinates, solved for many right-hand sides. Vertices are kept in the order in which
// they are eliminated.
class Stitcher {
  public:
    // rotation: per triangle, as it begins.
    Stitcher(const Patch& patch, const std::vector<Shape>& shapes, std::vector<glm::dvec2> rotation)
        : shapes_(shapes), rotation_(std::move(rotation)), corner_(patch.corner), at_(patch.point.size()) {
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(shapes.size() * 9 + 1);
        for (size_t t = 0; t < shapes.size(); ++t)
            for (size_t k = 0; k < 3; ++k) {
                int a = int(patch.corner[t][k]), b = int(patch.corner[t][(k + 1) % 3]);
                double w = shapes[t].cotangent[k];
                entries.emplace_back(a, a, w), entries.emplace_back(b, b, w);
                entries.emplace_back(std::max(a, b), std::min(a, b), -w);
            }
        // One vertex is held; the rest of the plane's motions are fixed by the rotations.
        entries.emplace_back(0, 0, 1.0);
        Eigen::SparseMatrix<double> matrix(long(at_.size()), long(at_.size()));
        matrix.setFromTriplets(entries.begin(), entries.end());
        solver_.compute(matrix);
        if (!good()) return;
        const auto& place = solver_.permutationP().indices();
        for (auto& c : corner_)
            for (uint32_t& v : c) v = uint32_t(place(v));
        inverse_ = solver_.vectorD().cwiseInverse();
    }
    bool good() const { return solver_.info() == Eigen::Success; }

    // Begins with the patch's UVs.
    void startFrom(const std::vector<glm::dvec2>& uv) {
        const auto& place = solver_.permutationP().indices();
        for (size_t v = 0; v < uv.size(); ++v) at_[size_t(place(long(v)))] = uv[v];
    }

    // Lays the triangles out as they are turned.
    void start() {
        right_.assign(at_.size(), glm::dvec2(0));
        for (size_t t = 0; t < shapes_.size(); ++t) pull(t);
        solve();
        at_ = right_;
    }

    // Turns each triangle as it lies by now, solves, and goes `stride` times as far as the solution. Returns the
    // longest way of a vertex to its solution.
    double round(double stride) {
        right_.assign(at_.size(), glm::dvec2(0));
        for (size_t t = 0; t < shapes_.size(); ++t) {
            const Shape& s = shapes_[t];
            const auto& c = corner_[t];
            glm::dvec2 sum(0);
            for (size_t k = 0; k < 3; ++k) {
                glm::dvec2 to = at_[c[(k + 1) % 3]] - at_[c[k]];
                sum += glm::dvec2(glm::dot(s.edge[k], to), cross(s.edge[k], to)) * s.cotangent[k];
            }
            double length = glm::length(sum);
            if (length > 0) rotation_[t] = sum / length;
            pull(t);
        }
        solve();
        double most = 0;
        for (size_t i = 0; i < at_.size(); ++i) {
            glm::dvec2 way = right_[i] - at_[i];
            most = std::max(most, glm::dot(way, way));
            at_[i] = stride == 1 ? right_[i] : at_[i] + way * stride;
        }
        return std::sqrt(most);
    }
    // Back to the last solution.
    void settle() { at_ = right_; }

    void take(std::vector<glm::dvec2>& uv) const {
        uv.resize(at_.size());
        const auto& place = solver_.permutationP().indices();
        for (size_t v = 0; v < uv.size(); ++v) uv[v] = at_[size_t(place(long(v)))];
    }

  private:
    // Adds what a triangle asks of its corners.
    void pull(size_t t) {
        for (size_t k = 0; k < 3; ++k) {
            glm::dvec2 d = turned(rotation_[t], shapes_[t].edge[k]) * shapes_[t].cotangent[k];
            right_[corner_[t][k]] -= d;
            right_[corner_[t][(k + 1) % 3]] += d;
        }
    }

    // L D Lᵀ x = right, in place, both coordinates at once.
    void solve() {
        const auto& lower = solver_.matrixL().nestedExpression();
        const int *first = lower.outerIndexPtr(), *row = lower.innerIndexPtr();
        const double* value = lower.valuePtr();
        const long n = long(at_.size());
        glm::dvec2* x = right_.data();
        for (long i = 0; i < n; ++i)
            for (int j = first[i]; j < first[i + 1]; ++j) x[row[j]] -= x[i] * value[j];
        for (long i = 0; i < n; ++i) x[i] *= inverse_[i];
        for (long i = n - 1; i >= 0; --i) {
            glm::dvec2 own = x[i];
            for (int j = first[i]; j < first[i + 1]; ++j) own -= x[row[j]] * value[j];
            x[i] = own;
        }
    }

    const std::vector<Shape>& shapes_;
    std::vector<glm::dvec2> rotation_;             // per triangle
    std::vector<std::array<uint32_t, 3>> corner_;  // per triangle
    std::vector<glm::dvec2> at_, right_;           // per vertex
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
    Eigen::VectorXd inverse_;  // of D
};

}  // namespace

PatchVerdict flatten(Patch& patch) {
    std::vector<Shape> shapes = measureShapes(patch);
    Unfolded unfolded = unfold(patch, shapes);
    if (fits(unfolded, patch, shapes)) {
        patch.uv = std::move(unfolded.at);
        return judgePatch(patch);
    }
    Stitcher stitcher(patch, shapes, std::move(unfolded.rotation));
    if (!stitcher.good()) {
        patch.uv.assign(patch.point.size(), glm::dvec2(0));
        return judgePatch(patch);
    }
    double area = 0;
    for (const Shape& s : shapes) area += cross(s.edge[2], s.edge[0]) / 2;
    stitcher.start();
    for (int round = 1; round <= kRounds; ++round) {
        const bool trial = round == kTrialRounds;
        if (stitcher.round(trial || round == kRounds ? 1.0 : kStride) < kSettled * std::sqrt(area)) {
            stitcher.settle();
            break;
        }
        if (!trial) continue;
        stitcher.take(patch.uv);
        if (PatchVerdict verdict = judgePatch(patch); verdict.settled()) return verdict;
    }
    stitcher.take(patch.uv);
    return judgePatch(patch);
}

PatchVerdict relax(Patch& patch) {
    std::vector<Shape> shapes = measureShapes(patch);
    Stitcher stitcher(patch, shapes, unfold(patch, shapes).rotation);
    PatchVerdict verdict = judgePatch(patch);
    if (!stitcher.good()) return verdict;
    stitcher.startFrom(patch.uv);
    for (int round = 0; round < kTrialRounds && !verdict.serves(); ++round) {
        stitcher.round(1);
        stitcher.take(patch.uv);
        verdict = judgePatch(patch);
    }
    return verdict;
}

}  // namespace espalier::bakery
