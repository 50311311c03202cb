// Each vertex has the direction that most of what is asked for at it says; then, pass by pass, that of itself and its
// neighbours together.
#include "runtime/field/summed_field.hpp"

#include <cmath>

namespace espalier {

Field summedField(const FieldMesh& mesh, uint32_t symmetry, const Pull& pull, uint32_t passes) {
    std::vector<std::complex<double>> along(mesh.twin.size());
    for (uint32_t h = 0; h < along.size(); ++h) along[h] = std::polar(1.0, symmetry * mesh.transport(h));
    Field field;
    field.symmetry = symmetry;
    field.power = pull.sum;
    field.mean.assign(field.power.size(), 0);
    field.deviator.assign(field.power.size(), 1);
    const auto makeUnit = [&] {
        for (auto& z : field.power) z = std::abs(z) > 0 ? z / std::abs(z) : 1;
    };
    makeUnit();
    for (uint32_t pass = 0; pass < passes; ++pass) {
        const std::vector<std::complex<double>> before = field.power;
        for (uint32_t h = 0; h < along.size(); ++h) {
            field.power[mesh.to(h)] += before[mesh.from(h)] * along[h];
            if (mesh.twin[h] == kNoIndex) field.power[mesh.from(h)] += before[mesh.to(h)] * std::conj(along[h]);
        }
        makeUnit();
    }
    return field;
}

}  // namespace espalier
