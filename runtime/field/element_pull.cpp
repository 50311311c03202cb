// Elements and the drift -> what vertices are pulled to.
#include "runtime/field/element_pull.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace espalier {
namespace {

using Complex = std::complex<double>;

constexpr double kElementPull = 40;  // of an element at its centre, against smoothness over its radius
constexpr double kDriftPull = 0.6;   // likewise, over the surface's radius
constexpr double kFelt = 2.5;        // radii beyond which an element isn't felt

bool sameReach(const FieldElement& a, const FieldElement& b) {
    return a.kind == b.kind && a.position == b.position && a.radius == b.radius;
}

FeltElement feltElement(const FieldMesh& mesh, uint32_t symmetry, const FieldElement& element) {
    FeltElement felt{element, nearestVertex(mesh, element.position), {}, 0, {}, {}};
    const double radius = element.radius > 0 ? element.radius : mesh.radius / 10;
    const PolarMap map = polarMap(mesh, felt.centre, kFelt * radius);
    std::vector<double> carried;
    carryAngles(mesh, map, carried);
    const double index = indexOf(element.kind);
    felt.vertices = map.reached;
    for (uint32_t v : map.reached) {
        const double d = map.distance[v] / radius;
        felt.within += d <= 1;
        const double share = std::exp(-d * d) * (index != 0 ? std::min(d * 4, 1.0) : 1);
        felt.weights.push_back(kElementPull * share * mesh.areas[v] / (radius * radius));
        felt.wishes.push_back(std::polar(1.0, symmetry * (index * map.angle[v] + carried[v])));
    }
    return felt;
}

}  // namespace

// It is handed on from the neighbour that the way passes nearest to.
void carryAngles(const FieldMesh& mesh, const PolarMap& map, std::vector<double>& carried) {
    carried.resize(mesh.positions.size());
    for (uint32_t v : map.reached) carried[v] = 0;
    for (uint32_t v : map.reached) {
        if (map.distance[v] == 0) continue;
        double best = map.distance[v];
        uint32_t h = mesh.first[v];
        do {
            for (const uint32_t edge : {h, FieldMesh::previous(h)}) {
                const bool leaves = mesh.from(edge) == v;
                const uint32_t other = leaves ? mesh.to(edge) : mesh.from(edge);
                if (!(map.distance[other] < best)) continue;
                best = map.distance[other];
                carried[v] = carried[other] + (leaves ? -mesh.transport(edge) : mesh.transport(edge));
            }
            h = mesh.twin[FieldMesh::previous(h)];
        } while (h != kNoIndex && h != mesh.first[v]);
    }
}

uint32_t nearestVertex(const FieldMesh& mesh, const glm::dvec3& place) {
    const auto distance = [&](const glm::dvec3& p) { return glm::dot(p - place, p - place); };
    const auto best = std::ranges::min_element(mesh.positions, {}, distance);
    return uint32_t(best - mesh.positions.begin());
}

const FeltElement& FeltElements::of(const FieldMesh& mesh, uint32_t symmetry, const FieldElement& element) {
    const auto known = std::ranges::find_if(all_, [&](const auto& f) { return sameReach(f->element, element); });
    if (known == all_.end()) {
        all_.push_back(std::make_unique<FeltElement>(feltElement(mesh, symmetry, element)));
        return *all_.back();
    }
    return **known;
}

void FeltElements::keepOnly(const std::vector<FieldElement>& elements) {
    std::erase_if(all_, [&](const auto& felt) {
        return std::ranges::none_of(elements, [&](const FieldElement& e) { return sameReach(e, felt->element); });
    });
}

AskedElement askedElement(const FieldMesh& mesh, uint32_t symmetry, const FeltElement& felt,
                          const FieldElement& element) {
    const double direction = mesh.angleOf(felt.centre, element.direction);
    const double quarter = element.kind == ElementKind::centre ? std::numbers::pi / 2 : 0;
    return {&felt, std::polar(1.0, symmetry * ((1 - indexOf(element.kind)) * direction + quarter))};
}

void addElement(const AskedElement& asked, Pull& pull) {
    const FeltElement& felt = *asked.felt;
    for (size_t i = 0; i < felt.vertices.size(); ++i) {
        pull.weight[felt.vertices[i]] += felt.weights[i];
        pull.sum[felt.vertices[i]] += felt.weights[i] * felt.wishes[i] * asked.turn;
    }
}

void addDrift(const FieldMesh& mesh, const FieldDesign& design, Pull& pull) {
    const double length = glm::length(design.drift);
    if (!(design.lean > 0) || !(length > 0)) return;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3 wish = design.drift / length;
        const double steep = glm::length(wish - mesh.normals[v] * glm::dot(wish, mesh.normals[v]));
        const double w = design.lean * kDriftPull * steep * steep * mesh.areas[v] / (mesh.radius * mesh.radius);
        pull.weight[v] += w;
        pull.sum[v] += w * std::polar(1.0, design.symmetry * mesh.angleOf(v, wish));
    }
}

}  // namespace espalier
