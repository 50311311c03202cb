// Names of roofs' shapes, as scene files have them.
#include "tools/scene/named.hpp"
#include "tools/scene/town.hpp"

namespace espalier::scene {
namespace {

constexpr const char* kShapes[] = {"hip", "gable", "half-hip", "pyramid", "shed", "gambrel", "mansard", "flat"};

}  // namespace

bool shapeNamed(const std::string& name, EspRoofShape& out) {
    return valueNamed(kShapes, name, out);
}

const char* nameOf(EspRoofShape shape) {
    return kShapes[shape];
}

}  // namespace espalier::scene
