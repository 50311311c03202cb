// What all fields share: elements, singularities.
#include "runtime/field/field.hpp"

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

std::vector<Singularity> singularitiesOf(const FieldMesh& mesh, const Field& field) {
    std::vector<Singularity> all;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        double field360 = 0, carried = 0;
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t h = 3 * t + k, a = mesh.from(h), b = mesh.to(h);
            const double transport = mesh.transport(h);
            const std::complex<double> moved = field.power[a] * std::polar(1.0, field.symmetry * transport);
            field360 += std::arg(field.power[b] * std::conj(moved));
            carried += transport;
        }
        // What a direction turns by that is carried once around: the triangle's share of the surface's curvature.
        const double curvature = carried - 2 * std::numbers::pi * std::round(carried / (2 * std::numbers::pi));
        const double turns = (field360 + field.symmetry * curvature) / (2 * std::numbers::pi);
        if (const int whole = int(std::lround(turns)); whole != 0) all.push_back({t, whole});
    }
    return all;
}

}  // namespace espalier
