// Enters: triangles. Leaves: how far up they have open edges. Edges aren't listed: each adds a random number of its one
// end to the sum of the other, and takes it off again where a face runs along it the other way. Sums that aren't zero
// are those of open edges' ends, but for one case in 2^64.
#include "runtime/render/solid.hpp"

#include <bit>
#include <limits>
#include <unordered_map>

#include "runtime/core/disjoint_sets.hpp"
#include "shaders/shared/random.h"

namespace espalier {
namespace {

constexpr double kFlat = 1e-6;  // share of its faces' cones up to which a piece's volume counts as none

struct Place {
    uint32_t x, y, z;
    bool operator==(const Place&) const = default;
};
struct PlaceHash {
    size_t operator()(const Place& p) const { return size_t(mix64(mix64(p.x | uint64_t(p.y) << 32) + p.z)); }
};

// [vertex]: number of its place.
std::vector<uint32_t> placesOf(std::span<const DrawVertex> vertices, uint32_t& count) {
    std::unordered_map<Place, uint32_t, PlaceHash> known;
    known.reserve(vertices.size());
    std::vector<uint32_t> places;
    places.reserve(vertices.size());
    for (const DrawVertex& v : vertices) {
        const glm::vec3 p = v.position + 0.0f;  // no negative zeros
        const Place place{std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y), std::bit_cast<uint32_t>(p.z)};
        places.push_back(known.try_emplace(place, uint32_t(known.size())).first->second);
    }
    count = uint32_t(known.size());
    return places;
}

// Of a piece, as cones from its lowest corner: an open side that lies there adds nothing.
struct Volume {
    glm::dvec3 tip{0};
    double tipHeight = std::numeric_limits<double>::infinity(), sum = 0, size = 0;
};

}  // namespace

float solidAbove(std::span<const DrawVertex> vertices, std::span<const uint32_t> indices, glm::vec3 up) {
    uint32_t count = 0;
    const std::vector<uint32_t> places = placesOf(vertices, count);
    std::vector<uint64_t> sums(count);
    DisjointSets pieces(count);
    for (size_t i = 0; i + 2 < indices.size(); i += 3)
        for (size_t c = 0; c < 3; ++c) {
            const uint32_t from = places[indices[i + c]], to = places[indices[i + (c + 1) % 3]];
            sums[from] += mix64(to + 1);
            sums[to] -= mix64(from + 1);
            pieces.join(from, to);
        }
    float open = -std::numeric_limits<float>::infinity();
    std::vector<Volume> volumes(count);
    for (uint32_t index : indices) {
        const glm::vec3 p = vertices[index].position;
        const float height = glm::dot(up, p);
        if (sums[places[index]] != 0) open = std::max(open, height);
        Volume& volume = volumes[pieces.find(places[index])];
        if (height < volume.tipHeight) volume.tip = p, volume.tipHeight = height;
    }
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        Volume& volume = volumes[pieces.find(places[indices[i]])];
        const auto corner = [&](size_t c) { return glm::dvec3(vertices[indices[i + c]].position) - volume.tip; };
        const double cone = glm::dot(corner(0), glm::cross(corner(1), corner(2)));
        volume.sum += cone;
        volume.size += std::abs(cone);
    }
    for (const Volume& volume : volumes)
        if (volume.sum < -kFlat * volume.size) return std::numeric_limits<float>::infinity();
    return open;
}

}  // namespace espalier
