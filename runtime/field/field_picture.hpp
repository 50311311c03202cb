#pragma once

#include <array>
#include <vector>

#include "runtime/field/field.hpp"

namespace espalier {

// A picture of a field over a surface's walk UVs: streaks along its lines, a mark at each singularity.
struct FieldPicture {
    uint32_t size = 0;                           // texels a side, in texelIndex order
    std::array<std::vector<float>, 3> channels;  // red, green, blue: linear, 0 to 1
};

// Line integral convolution (Cabral, Leedom 1993) of a noise in space, so that it shows no seams. A field of crosses
// shows both of its families of lines, woven. Marks: warm where the field turns with the way around, blue where against
// it, the larger the more. surface: with aux on its finest level; mesh: made from it.
FieldPicture fieldPicture(const SurfaceData& surface, const FieldMesh& mesh, const Field& field);

// Makes the picture of a field one of another field of the same mesh and symmetry: the texels that fieldPicture gives,
// but only those near vertices at which the fields differ are made anew.
void updateFieldPicture(const SurfaceData& surface, const FieldMesh& mesh, const Field& before, const Field& now,
                        FieldPicture& picture);

}  // namespace espalier
