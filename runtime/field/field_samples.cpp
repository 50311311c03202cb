// Enters: vectors or tensors at points, or over UVs. Leaves: a direction's N-th power, and eigenvalues, at vertices.
// Around a vertex without a point of its own, points count by the inverse squares of their distances (Shepard 1968).
#include "runtime/field/field_samples.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "runtime/core/jobs.hpp"
#include "runtime/surface/box_tree.hpp"

namespace espalier {
namespace {

using Complex = std::complex<double>;
using glm::dvec3;

constexpr double kSamePlace = 1e-5;  // of the radius: between what are roundings of one position
constexpr double kNear = .01;        // of the radius
constexpr double kAround = 2;        // of the nearest point's distance: points that count
constexpr double kMost = 1e30;       // an eigenvalue, so that sums of some stay finite
constexpr double kNothing = 1e-6;    // of the largest of all: a length that gives no direction

// What one or several samples say in a vertex's plane.
struct Said {
    Complex power = 0;  // times the deviator
    double mean = 0, deviator = 0;
    void add(const Said& more, double share) {
        power += share * more.power;
        mean += share * more.mean;
        deviator += share * more.deviator;
    }
};

Complex raised(Complex direction, uint32_t times) {
    const double length = std::abs(direction);
    return length > 0 ? length * std::polar(1.0, times * std::arg(direction)) : 0;
}

class Sampling {
  public:
    Sampling(const FieldMesh& mesh, const FieldSamples& samples, uint32_t symmetry)
        : mesh_(mesh), samples_(samples), symmetry_(symmetry) {
        std::vector<Box> boxes(samples.points.size());
        for (size_t i = 0; i < boxes.size(); ++i) boxes[i].add(samples.points[i]);
        tree_ = BoxTree(std::move(boxes), {});
    }

    // near: whether a point lies near by.
    Said at(uint32_t vertex, bool& near) const {
        const dvec3 place = mesh_.positions[vertex];
        uint32_t nearest = 0;
        double least = std::numeric_limits<double>::infinity();
        tree_.nearestSquare(place, [&](uint32_t i) {
            const double square = squareTo(place, i);
            if (square < least) least = square, nearest = i;
            return square;
        });
        const double same = kSamePlace * mesh_.radius, distance = std::sqrt(least);
        near = distance <= kNear * mesh_.radius;
        if (!near) return said(vertex, nearest);
        const double around = kAround * std::max(distance, same);
        Said sum;
        double shares = 0;
        Box box;
        box.add(place);
        tree_.near(box.grown(around), [&](uint32_t i) {
            const double square = squareTo(place, i);
            if (square > around * around) return;
            const double share = 1 / (square + same * same);
            sum.add(said(vertex, i), share);
            shares += share;
        });
        Said mean;
        mean.add(sum, 1 / shares);
        return mean;
    }

  private:
    double squareTo(const dvec3& place, uint32_t i) const {
        const dvec3 way = dvec3(samples_.points[i]) - place;
        return glm::dot(way, way);
    }
    Said said(uint32_t vertex, uint32_t i) const {
        const dvec3 x = mesh_.axes[vertex], y = glm::cross(mesh_.normals[vertex], x);
        if (samples_.tensors.empty()) {
            const dvec3 v(samples_.vectors[i]);
            const Complex flat(glm::dot(v, x), glm::dot(v, y));
            return {raised(flat, symmetry_), 0, std::abs(flat)};
        }
        const auto& t = samples_.tensors[i];
        const glm::dmat3 tensor(t[0], t[3], t[4], t[3], t[1], t[5], t[4], t[5], t[2]);
        const double xx = glm::dot(x, tensor * x), yy = glm::dot(y, tensor * y), xy = glm::dot(x, tensor * y);
        const Complex twice((xx - yy) / 2, xy);
        return {raised(twice, symmetry_ / 2), (xx + yy) / 2, std::abs(twice)};
    }

    const FieldMesh& mesh_;
    const FieldSamples& samples_;
    const uint32_t symmetry_;
    BoxTree tree_;
};

// Bilinear, among the texels that say something.
dvec3 readAt(const VectorPicture& picture, const glm::dvec2& uv) {
    const glm::dvec2 at = uv * glm::dvec2(picture.width, picture.height) - .5, low = glm::floor(at), part = at - low;
    dvec3 sum(0);
    double shares = 0;
    for (int k = 0; k < 4; ++k) {
        const auto x = size_t(std::clamp(low.x + k % 2, 0.0, picture.width - 1.0));
        const auto y = size_t(std::clamp(low.y + double(k / 2), 0.0, picture.height - 1.0));
        const glm::vec3& texel = picture.texels[y * picture.width + x];
        const double share = (k % 2 ? part.x : 1 - part.x) * (k / 2 ? part.y : 1 - part.y);
        if (texel == glm::vec3(0)) continue;
        sum += share * dvec3(texel);
        shares += share;
    }
    return shares > 0 ? sum / shares : sum;
}

}  // namespace

Result<SampledVertices> sampleVertices(const FieldMesh& mesh, const FieldSamples& samples, uint32_t symmetry) {
    if (!samples.tensors.empty() && symmetry % 2 != 0)
        return Failure("field",
                       "tensors have no front and back: they can't be a field of vectors; declare it as tensor");
    const size_t count = mesh.positions.size();
    std::vector<Said> all(count);
    std::atomic<size_t> near = 0;
    if (!samples.points.empty()) {
        const Sampling sampling(mesh, samples, symmetry);
        parallelFor(count, 256, [&](size_t begin, size_t end) {
            for (size_t v = begin; v < end; ++v) {
                bool has = false;
                all[v] = sampling.at(uint32_t(v), has);
                if (!has) all[v].power = 0;
                near += has;
            }
        });
    }
    if (near == 0)
        return Failure("field", "none of its " + std::to_string(samples.points.size()) +
                                    " points lies near the surface: are they of another model?");
    double largest = 0;
    for (const Said& said : all) largest = std::max(largest, said.deviator);
    SampledVertices out{std::vector<Complex>(count), std::vector<float>(count), std::vector<float>(count), near};
    for (size_t v = 0; v < count; ++v) {
        const double length = std::abs(all[v].power);
        if (length > kNothing * largest) out.wish[v] = all[v].power / length;
        out.mean[v] = float(std::clamp(all[v].mean, -kMost, kMost));
        out.deviator[v] = float(std::min(all[v].deviator, kMost));
    }
    return out;
}

FieldSamples samplesOf(const SurfaceData& surface, const FieldMesh& mesh, const VectorPicture& picture) {
    std::vector<dvec3> sums(mesh.positions.size(), dvec3(0));
    std::vector<uint32_t> counts(mesh.positions.size(), 0);
    for (size_t i = 0; i < surface.triangles.size(); ++i) {
        const uint32_t t = mesh.triangleOf[i];
        if (t == kNoIndex) continue;
        const TrianglePlane& plane = surface.triangles[i];
        const glm::vec2 uvs[] = {plane.uv0, plane.uv1, plane.uv2};
        for (uint32_t k = 0; k < 3; ++k) {
            const dvec3 read = readAt(picture, uvs[mesh.cornerOf[t][k]]);
            if (read == dvec3(0)) continue;
            sums[mesh.triangles[t][k]] += read;
            ++counts[mesh.triangles[t][k]];
        }
    }
    FieldSamples samples;
    for (size_t v = 0; v < sums.size(); ++v) {
        if (counts[v] == 0) continue;
        samples.points.emplace_back(mesh.positions[v]);
        samples.vectors.emplace_back(sums[v] / double(counts[v]));
    }
    return samples;
}

}  // namespace espalier
