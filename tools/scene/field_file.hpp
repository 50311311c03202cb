#pragma once

// Files of fields that other programs have computed.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace espalier::scene {

// What such a file holds: vectors or symmetric tensors at points, or vectors over the walk's UVs. All numbers are
// finite.
struct FieldFile {
    std::vector<std::array<double, 3>> points;  // as the model's file has them, metres
    std::vector<float> vectors;                 // three for each point, or for each texel, rows from v = 0
    std::vector<float> tensors;                 // or six for each point: xx, yy, zz, xy, xz, yz
    uint32_t width = 0, height = 0;             // of a picture, which has no points

    size_t bytes() const {
        return points.size() * sizeof points[0] + (vectors.size() + tensors.size()) * sizeof(float);
    }
};

// PLY with vectors or tensors at vertices, and OpenEXR with vectors as red, green and blue, told by their first bytes
// (docs/patterns.md). field: the field's name, by which vectors may be called. False: `error` names file, place and
// cause; no exception leaves this function.
bool readFieldFile(const std::string& path, const std::string& field, FieldFile& out, std::string& error);

}  // namespace espalier::scene
