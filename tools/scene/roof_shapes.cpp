// Names of roofs' shapes and what dresses them, as scene files have them.
#include "tools/scene/named.hpp"
#include "tools/scene/town.hpp"

namespace espalier::scene {
namespace {

constexpr const char* kShapes[] = {"hip", "gable", "half-hip", "pyramid", "shed", "gambrel", "mansard", "flat"};
constexpr const char* kCoverings[] = {"any",   "tiles",       "slate",     "metal",       "copper", "thatch",
                                      "wood",  "stone",       "concrete",  "asphalt",     "gravel", "glass",
                                      "grass", "plain_tiles", "pan_tiles", "barrel_tiles"};
constexpr const char* kChimneys[] = {"any", "none", "all"};

}  // namespace

bool shapeNamed(const std::string& name, EspRoofShape& out) {
    return valueNamed(kShapes, name, out);
}

const char* nameOf(EspRoofShape shape) {
    return kShapes[shape];
}

bool coveringNamed(const std::string& name, EspCovering& out) {
    return valueNamed(kCoverings, name, out);
}
const char* nameOf(EspCovering covering) {
    return kCoverings[covering];
}

bool chimneysNamed(const std::string& name, EspChimneys& out) {
    return valueNamed(kChimneys, name, out);
}
const char* nameOf(EspChimneys chimneys) {
    return kChimneys[chimneys];
}

}  // namespace espalier::scene
