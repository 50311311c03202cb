// In: positions in double precision. Out: a model's positions in single precision, near an origin of its own where they
// would lose too much otherwise: maps count metres from somewhere far away.
#include <algorithm>
#include <cmath>

#include "tools/bake/import_polygons.hpp"

namespace espalier::import {
namespace {

constexpr double kRounding = 1.0 / (1 << 24);   // of a number: what float32 rounds off at most
constexpr double kLoss = 1.0 / 65536;           // of the bounding radius: rounding that can be seen in charts
constexpr double kMostLoss = 0.01;              // metres: however large the model is, doors and bricks suffer
constexpr double kNear = 1000, kNearRadii = 8;  // metres, and bounding radii: what lies no farther away stays

// Float32 would round off what matters.
bool isFar(double most, double radius) {
    return most > kNear && most > kNearRadii * radius && most * kRounding > std::min(kMostLoss, kLoss * radius);
}

// A round number near the middle; 0 where the model reaches over it, so that what stands on the ground still does.
double originOf(double low, double high, double radius) {
    if (low <= 0 && high >= 0) return 0;
    const double step = std::pow(10.0, std::ceil(std::log10(std::max(radius, 1e-3))));
    return std::round((low + high) / 2 / step) * step;
}

std::string textOf(const glm::dvec3& p) {
    char text[100];
    std::snprintf(text, sizeof text, "(%.15g, %.15g, %.15g)", p.x, p.y, p.z);
    return text;
}

}  // namespace

void settle(const std::vector<glm::dvec3>& places, std::span<const uint32_t> used,
            const std::optional<glm::dvec3>& wanted, Model& model) {
    glm::dvec3 low(1e300), high(-1e300);
    for (uint32_t i : used) low = glm::min(low, places[i]), high = glm::max(high, places[i]);
    const glm::dvec3 most = glm::max(glm::abs(low), glm::abs(high));
    const double radius = glm::length(high - low) / 2;
    if (wanted) {
        model.origin = *wanted;
    } else if (!used.empty() && isFar(std::max({most.x, most.y, most.z}), radius)) {
        for (int k = 0; k < 3; ++k) model.origin[k] = originOf(low[k], high[k], radius);
    }
    if (model.origin != glm::dvec3(0)) {
        std::string text = textOf(model.origin) + " is taken off all positions and kept as the surface's origin";
        if (!wanted) text = "positions are too large for single precision: " + text;
        model.warnings.push_back({model.name, 0, 0, {}, text, true});
    }
    // What no triangle names may be anything; it gets a place that is one.
    const glm::dvec3 instead = used.empty() ? model.origin : places[used.front()];
    model.positions.resize(places.size());
    for (size_t i = 0; i < places.size(); ++i)
        model.positions[i] = glm::vec3((isPlace(places[i]) ? places[i] : instead) - model.origin);
}

}  // namespace espalier::import
