// Names of roofs' shapes, as scene files have them.
#include <algorithm>
#include <iterator>

#include "tools/scene/town.hpp"

namespace espalier::scene {
namespace {

constexpr const char* kShapes[] = {"hip", "gable", "half-hip", "pyramid", "shed", "gambrel", "mansard", "flat"};

}  // namespace

bool shapeNamed(const std::string& name, EspRoofShape& out) {
    const auto found = std::find(std::begin(kShapes), std::end(kShapes), name);
    if (found == std::end(kShapes)) return false;
    out = EspRoofShape(found - std::begin(kShapes));
    return true;
}

const char* nameOf(EspRoofShape shape) {
    return kShapes[shape];
}

}  // namespace espalier::scene
