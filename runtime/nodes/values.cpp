#include "runtime/nodes/values.hpp"

namespace espalier {

const char* nameOf(ValueType type) {
    constexpr const char* kNames[kValueTypes] = {"Number", "Whole",    "Vector",  "Colour",  "Choice",  "Text",
                                                 "File",   "Material", "Grammar", "Surface", "Plants",  "Town",
                                                 "Layer",  "Points",   "Curves",  "Mesh",    "Geometry"};
    return kNames[size_t(type)];
}

bool accepts(ValueType port, ValueType given) {
    if (port == given) return true;
    if (port == ValueType::geometry) return isGeometry(given);
    if (port == ValueType::number) return given == ValueType::whole;
    return (port == ValueType::colour && given == ValueType::vector) ||
           (port == ValueType::vector && given == ValueType::colour);
}

uint64_t GeometryPart::instances() const {
    uint64_t all = 1;
    for (const DeformOp& op : program) all *= instancesOf(op);
    return all;
}

}  // namespace espalier
