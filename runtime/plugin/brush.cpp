// Enters: a brush as hosts describe it. Leaves: what is wrong with it, and the numbers by which kernels apply it.
#include <cmath>
#include <limits>

#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/painting.hpp"

namespace espalier {
namespace {

constexpr float kSteepest = 1e30f;     // a fade of no width
constexpr float kSlopeFade = kPi / 4;  // radians at softness 1

// 1 / width of a fade.
float per(float width) {
    return width > 1e-6f ? 1 / width : kSteepest;
}

bool limitsSlope(const EspBrush& brush) {
    EspBrush open{};
    setDefaults(open);
    return brush.slopeRange[0] > open.slopeRange[0] || brush.slopeRange[1] < open.slopeRange[1];
}
bool limitsHeight(const EspBrush& brush) {
    EspBrush open{};
    setDefaults(open);
    return brush.heightRange[0] > open.heightRange[0] || brush.heightRange[1] < open.heightRange[1];
}

}  // namespace

const char* mistakeIn(const EspBrush& brush) {
    const auto share = [](float v) { return v >= 0 && v <= 1; };
    if (!brush.layer || !*brush.layer) return "a brush needs a layer's name";
    if (!isAmong(brush.mode, ESP_BRUSH_PAINT, ESP_BRUSH_SMOOTH)) return "there is no such mode";
    if (!(brush.radius >= 1e-6f && brush.radius <= 1e6f)) return "the radius must be within 1e-6 to 1e6 m";
    if (!share(brush.value) || !share(brush.strength) || !share(brush.hardness) || !share(brush.limitSoftness))
        return "value, strength, hardness and limitSoftness are 0 to 1";
    if (std::isnan(brush.slopeRange[0]) || std::isnan(brush.slopeRange[1]) || std::isnan(brush.heightRange[0]) ||
        std::isnan(brush.heightRange[1]))
        return "a limit is not a number";
    return nullptr;
}

BrushLimits limitsOf(const EspBrush& brush) {
    BrushLimits l = kNoLimits;
    if (limitsSlope(brush)) {
        l.slopeLow = brush.slopeRange[0];
        l.slopeHigh = brush.slopeRange[1];
        l.perSlope = per(brush.limitSoftness * kSlopeFade);
    }
    if (limitsHeight(brush)) {
        l.heightLow = brush.heightRange[0];
        l.heightHigh = brush.heightRange[1];
        l.perHeight = per(brush.limitSoftness * brush.radius);
    }
    return l;
}

BrushRecord recordOf(const EspBrush& brush, float fill) {
    BrushRecord r{};
    r.perRadius = 1 / brush.radius;
    r.hardness = brush.hardness;
    r.perSoft = per(1 - brush.hardness);
    r.target = brush.mode == ESP_BRUSH_ERASE ? fill : brush.value;
    r.strength = brush.strength;
    r.limits = limitsOf(brush);
    if (limitsSlope(brush)) r.flags |= kBrushSlope;
    if (limitsHeight(brush)) r.flags |= kBrushHeight;
    if (brush.frontOnly) r.flags |= kBrushFront;
    return r;
}

}  // namespace espalier

namespace espalier {

void setDefaults(EspBrush& brush) {
    brush.radius = .5f;
    brush.value = 1;
    brush.strength = .5f;
    brush.slopeRange[1] = kPi;
    brush.heightRange[0] = -std::numeric_limits<float>::max();
    brush.heightRange[1] = std::numeric_limits<float>::max();
}

}  // namespace espalier

extern "C" EspResult espDefaultBrush(EspBrush* out) {
    return espalier::giveDefaults("espDefaultBrush", out);
}
