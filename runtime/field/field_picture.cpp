#include "runtime/field/field_picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "runtime/core/jobs.hpp"
#include "runtime/field/triangle_weights.hpp"
#include "shaders/shared/random.h"

namespace espalier {
namespace {

using glm::dvec3;
using Complex = std::complex<double>;

constexpr uint32_t kMostTexels = 1024;  // a side
constexpr double kStreak = 1. / 120;    // width of a streak, of the mesh's radius
constexpr double kLength = 9;           // of a streak each way, in widths
constexpr double kMark = .03;           // of the mesh's radius, for one N-th of a turn

// A place on the mesh, by the weights of a triangle's corners.
struct Place {
    uint32_t triangle;
    std::array<double, 3> weights;
};

// The mesh with each triangle laid flat, its first half-edge along the axis of reals.
class FlatMesh {
  public:
    FlatMesh(const FieldMesh& mesh, const Field& field) : mesh_(mesh), symmetry_(field.symmetry) {
        const size_t count = mesh.twin.size();
        edges_.resize(count);
        gradients_.resize(count);
        powers_.resize(count);
        parallelFor(mesh.triangles.size(), 1024, [&](size_t begin, size_t end) {
            for (size_t t = begin; t < end; ++t) lay(uint32_t(t), field);
        });
    }

    dvec3 positionOf(const Place& p) const {
        dvec3 sum(0);
        for (uint32_t k = 0; k < 3; ++k) sum += p.weights[k] * mesh_.positions[mesh_.triangles[p.triangle][k]];
        return sum;
    }

    // One of the field's N directions there, that numbered `family`.
    Complex directionAt(const Place& p, uint32_t family) const {
        const Complex power = powerAt(p);
        return std::polar(1.0, (std::arg(power) + 2 * std::numbers::pi * family) / symmetry_);
    }
    // That which is nearest to `along`.
    Complex directionAt(const Place& p, Complex along) const {
        const Complex power = powerAt(p);
        if (power == 0.0) return along;
        Complex own = along;
        for (uint32_t i = 1; i < symmetry_; ++i) own *= along;
        return along * std::polar(1.0, std::arg(power * std::conj(own)) / symmetry_);
    }

    // Moves on straight ahead, over edges; `along` becomes the same direction in the triangle where the way ends.
    // False: the way ends at a border.
    bool move(Place& p, Complex& along, double way) const {
        for (int crossings = 0; crossings < 16; ++crossings) {
            double most = way;
            uint32_t leaving = 3;
            std::array<double, 3> change;
            for (uint32_t k = 0; k < 3; ++k) {
                const Complex g = gradients_[3 * p.triangle + k];
                change[k] = g.real() * along.real() + g.imag() * along.imag();
                if (change[k] < 0 && -p.weights[k] / change[k] < most)
                    most = std::max(-p.weights[k] / change[k], 0.0), leaving = k;
            }
            for (uint32_t k = 0; k < 3; ++k) p.weights[k] += most * change[k];
            if (leaving == 3) return true;
            if (!cross(p, along, leaving)) return false;
            way -= most;
        }
        return true;
    }

  private:
    void lay(uint32_t t, const Field& field) {
        const auto& triangle = mesh_.triangles[t];
        const dvec3 a = mesh_.positions[triangle[0]], e = mesh_.positions[triangle[1]] - a,
                    f = mesh_.positions[triangle[2]] - a;
        const double length = glm::length(e), area = glm::length(glm::cross(e, f));
        if (!(area > 0)) return;
        const Complex corners[3] = {0, length, Complex(glm::dot(e, f) / length, area / length)};
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t h = 3 * t + k;
            const Complex on = corners[(k + 1) % 3] - corners[k], back = corners[(k + 2) % 3] - corners[k];
            edges_[h] = on / std::abs(on);
            // A weight grows towards its corner, across the opposite edge.
            const Complex opposite = corners[(k + 2) % 3] - corners[(k + 1) % 3];
            gradients_[h] = opposite * Complex(0, 1) / area;
            const double middle = std::arg(on) + std::arg(back / on) / 2;
            powers_[h] =
                field.power[triangle[k]] * std::polar(1.0, symmetry_ * (middle - mesh_.angle[h] - mesh_.tip(h) / 2));
        }
    }
    Complex powerAt(const Place& p) const {
        Complex sum = 0;
        for (uint32_t k = 0; k < 3; ++k) sum += p.weights[k] * powers_[3 * p.triangle + k];
        return sum;
    }
    bool cross(Place& p, Complex& along, uint32_t opposite) const {
        const uint32_t h = 3 * p.triangle + (opposite + 1) % 3, twin = mesh_.twin[h];
        if (twin == kNoIndex) return false;
        const double from = p.weights[(opposite + 1) % 3], to = p.weights[(opposite + 2) % 3];
        p.triangle = twin / 3;
        p.weights[twin % 3] = to;
        p.weights[(twin + 1) % 3] = from;
        p.weights[(twin + 2) % 3] = 0;
        // The edge keeps its direction, which the other triangle has backwards.
        along *= -edges_[twin] * std::conj(edges_[h]);
        return true;
    }

    const FieldMesh& mesh_;
    const uint32_t symmetry_;
    std::vector<Complex> edges_;      // [half-edge]: unit
    std::vector<Complex> gradients_;  // [half-edge]: of the weight of the corner that it leaves, 1/m
    std::vector<Complex> powers_;     // [half-edge]: the field's at the corner that it leaves
};

uint64_t placeKey(const glm::i64vec3& cell) {
    return mix64(uint64_t(cell.x) + mix64(uint64_t(cell.y) + mix64(uint64_t(cell.z))));
}

double noiseAt(const dvec3& p) {
    return double(placeKey(glm::i64vec3(glm::floor(p))) >> 40) / double(1 << 24);
}

class Marks {
  public:
    Marks(const FieldMesh& mesh, const Field& field) : cell_(2 * kMark * mesh.radius * kLargest) {
        for (const Singularity& s : singularitiesOf(mesh, field)) {
            const dvec3 at = placeOf(mesh, s);
            const double radius = kMark * mesh.radius * std::min(std::sqrt(std::abs(s.turns)), kLargest);
            at_.emplace(placeKey(glm::i64vec3(glm::floor(at / cell_))), Mark{at, radius, s.turns});
        }
    }
    // Lays the marks over a shade.
    dvec3 over(const dvec3& shade, const dvec3& place) const {
        dvec3 shown = shade;
        const glm::i64vec3 low(glm::floor(place / cell_ - .5));
        for (int i = 0; i < 8; ++i) {
            const auto [begin, end] = at_.equal_range(placeKey(low + glm::i64vec3(i % 2, i / 2 % 2, i / 4)));
            for (auto it = begin; it != end; ++it) {
                const double away = glm::length(place - it->second.at) / it->second.radius;
                if (away > 1) continue;
                const dvec3 colour = it->second.turns > 0 ? dvec3(.9, .22, .03) : dvec3(.03, .2, .85);
                shown = away > .8 ? dvec3(.9) : colour;
            }
        }
        return shown;
    }

    static constexpr double kLargest = 2;

  private:
    struct Mark {
        dvec3 at;
        double radius;
        int turns;
    };
    double cell_;
    std::unordered_multimap<uint64_t, Mark> at_;
};

// Where pictures of two fields may differ: no farther from triangles whose corners differ than streaks and marks reach.
class Changed {
  public:
    Changed(const FieldMesh& mesh, const Field& before, const Field& now) : reach_(kLength * kStreak * mesh.radius) {
        static_assert(kLength * kStreak > kMark * Marks::kLargest);
        for (const auto& triangle : mesh.triangles) {
            if (std::ranges::all_of(triangle, [&](uint32_t v) { return before.power[v] == now.power[v]; })) continue;
            dvec3 low(mesh.positions[triangle[0]]), high(low);
            for (const uint32_t v : triangle)
                low = glm::min(low, mesh.positions[v]), high = glm::max(high, mesh.positions[v]);
            const glm::i64vec3 first = cellOf(low - reach_), last = cellOf(high + reach_);
            for (int64_t x = first.x; x <= last.x; ++x)
                for (int64_t y = first.y; y <= last.y; ++y)
                    for (int64_t z = first.z; z <= last.z; ++z) cells_.insert(placeKey({x, y, z}));
        }
    }
    bool near(const dvec3& place) const { return cells_.contains(placeKey(cellOf(place))); }

  private:
    glm::i64vec3 cellOf(const dvec3& place) const { return glm::i64vec3(glm::floor(place / reach_)); }
    const double reach_;
    std::unordered_set<uint64_t> cells_;
};

class Convolution {
  public:
    Convolution(const SurfaceData& surface, const FieldMesh& mesh, const Field& field)
        : surface_(surface),
          mesh_(mesh),
          flat_(mesh, field),
          marks_(mesh, field),
          families_(field.symmetry % 2 == 0 ? field.symmetry / 2 : field.symmetry),
          width_(kStreak * mesh.radius) {}

    FieldPicture run() const {
        FieldPicture picture;
        picture.size = std::min(surface_.levels[0].size, kMostTexels);
        for (auto& channel : picture.channels) channel.assign(size_t(picture.size) * picture.size, 0);
        paint(picture, [](const dvec3&) { return true; });
        return picture;
    }
    // The texels at places that `wanted` wants.
    template <class Wanted>
    void paint(FieldPicture& picture, const Wanted& wanted) const {
        const uint32_t step = surface_.levels[0].size / picture.size;
        parallelFor(picture.size, 8, [&](size_t begin, size_t end) {
            for (uint32_t y = uint32_t(begin); y < end; ++y)
                for (uint32_t x = 0; x < picture.size; ++x) {
                    const std::optional<Place> place = placeOf(x * step + step / 2, y * step + step / 2);
                    if (!place || !wanted(flat_.positionOf(*place))) continue;
                    const dvec3 shown = shadeAt(*place);
                    for (int c = 0; c < 3; ++c) picture.channels[c][texelIndex(picture.size, x, y)] = float(shown[c]);
                }
        });
    }

  private:
    // Nothing: there is no surface.
    std::optional<Place> placeOf(uint32_t x, uint32_t y) const {
        const SurfaceLevelData& level = surface_.levels[0];
        const uint32_t triangle = level.aux[texelIndex(level.size, x, y)].triangle;
        if (triangle == kNoIndex || mesh_.triangleOf[triangle] == kNoIndex) return std::nullopt;
        Place place{mesh_.triangleOf[triangle], {}};
        const std::array<double, 3> weights =
            weightsAt(surface_.triangles[triangle], (glm::dvec2(x, y) + .5) / double(level.size), 0);
        for (uint32_t k = 0; k < 3; ++k) place.weights[k] = weights[mesh_.cornerOf[place.triangle][k]];
        // A texel of the gutter lies beside its triangle.
        double inside = 0;
        for (double& w : place.weights) inside += w = std::max(w, 0.0);
        for (double& w : place.weights) w /= inside;
        return place;
    }
    dvec3 shadeAt(const Place& place) const {
        double sum = 0;
        for (uint32_t family = 0; family < families_; ++family) sum += streak(place, family);
        // The mean of many samples of noise varies little: contrast is given back.
        const double shade = std::clamp(.5 + 2.8 * (sum / families_ - .5) * std::sqrt(double(families_)), 0.0, 1.0);
        const dvec3 dark(.030, .045, .055), light(.62, .66, .62);
        return marks_.over(dark + (light - dark) * shade * shade, flat_.positionOf(place));
    }
    double streak(const Place& from, uint32_t family) const {
        const Complex first = flat_.directionAt(from, family);
        double sum = noiseAt(flat_.positionOf(from) / width_), weight = 1;
        for (const double sign : {1.0, -1.0}) {
            Place p = from;
            Complex along = sign * first;
            // Of a field of an odd symmetry the way back isn't one of its directions.
            for (int i = 1; i < 2 * kLength && flat_.move(p, along, .5 * width_); ++i) {
                const double w = 1 - i / (2 * kLength);
                sum += w * noiseAt(flat_.positionOf(p) / width_);
                weight += w;
                along = sign * flat_.directionAt(p, sign * along);
            }
        }
        return sum / weight;
    }

    const SurfaceData& surface_;
    const FieldMesh& mesh_;
    const FlatMesh flat_;
    const Marks marks_;
    const uint32_t families_;
    const double width_;  // of a streak, metres
};

}  // namespace

FieldPicture fieldPicture(const SurfaceData& surface, const FieldMesh& mesh, const Field& field) {
    return Convolution(surface, mesh, field).run();
}

void updateFieldPicture(const SurfaceData& surface, const FieldMesh& mesh, const Field& before, const Field& now,
                        FieldPicture& picture) {
    const Changed changed(mesh, before, now);
    Convolution(surface, mesh, now).paint(picture, [&](const dvec3& place) { return changed.near(place); });
}

}  // namespace espalier
