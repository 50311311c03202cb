// What all fields share: elements, singularities.
#include "runtime/field/field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace espalier {

double indexOf(ElementKind kind) {
    switch (kind) {
        case ElementKind::wedge:
            return .5;
        case ElementKind::trisector:
            return -.5;
        case ElementKind::node:
        case ElementKind::centre:
            return 1;
        case ElementKind::saddle:
            return -1;
        case ElementKind::regular:
            break;
    }
    return 0;
}

bool fits(ElementKind kind, uint32_t symmetry) {
    const double turns = indexOf(kind) * symmetry;
    return turns == std::round(turns);
}

double turnAlong(const FieldMesh& mesh, const Field& field, uint32_t h) {
    // Half a turn is the same for both half-edges of an edge, or it would count twice.
    if (!mesh.ownsEdge(h)) return -turnAlong(mesh, field, mesh.twin[h]);
    const std::complex<double> moved = field.power[mesh.from(h)] * std::polar(1.0, field.symmetry * mesh.transport(h));
    return std::arg(field.power[mesh.to(h)] * std::conj(moved));
}

namespace {

int wholeTurns(double turned) {
    return int(std::lround(turned / (2 * std::numbers::pi)));
}

// Over the ring of edges around a vertex.
int turnsAbout(const FieldMesh& mesh, const Field& field, uint32_t vertex) {
    double turned = 0;
    uint32_t h = mesh.first[vertex];
    do {
        turned += turnAlong(mesh, field, FieldMesh::next(h)) + field.symmetry * mesh.curvature(h / 3);
        h = mesh.twin[FieldMesh::previous(h)];
    } while (h != mesh.first[vertex]);
    return wholeTurns(turned);
}

}  // namespace

std::vector<Singularity> singularitiesOf(const FieldMesh& mesh, const Field& field) {
    std::vector<Singularity> all;
    const auto add = [&](const Singularity& s) {
        if (s.turns != 0) all.push_back(s);
    };
    const auto open = [&](uint32_t v) { return field.power[v] == 0.0; };
    for (uint32_t v = 0; v < mesh.positions.size(); ++v)
        if (open(v) && !mesh.border[v]) add({mesh.first[v] / 3, v, turnsAbout(mesh, field, v)});
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (std::ranges::any_of(mesh.triangles[t], open)) continue;
        double turned = field.symmetry * mesh.curvature(t);
        for (uint32_t k = 0; k < 3; ++k) turned += turnAlong(mesh, field, 3 * t + k);
        add({t, kNoIndex, wholeTurns(turned)});
    }
    return all;
}

glm::dvec3 placeOf(const FieldMesh& mesh, const Singularity& singularity) {
    if (singularity.vertex != kNoIndex) return mesh.positions[singularity.vertex];
    glm::dvec3 sum(0);
    for (const uint32_t v : mesh.triangles[singularity.triangle]) sum += mesh.positions[v];
    return sum / 3.0;
}

}  // namespace espalier
