#pragma once

#include <optional>
#include <vector>

#include "sample_game/workspace.hpp"

namespace sample {

// The layer that leads, and its value for no direction; see content/grammars/ivy_path.grammar.
inline constexpr const char* kLeadingLayer = "way";
// The first grammar that reads this layer, the one in hand before others.
std::optional<uint32_t> leadingGrammar(const Workspace& work);

using LinePoint = std::array<float, 6>;  // of a seed's line: position, normal

// A plant along a line over surfaces, whose places lie close: its direction is painted, and a seed is planted where it
// begins. One step of undo; all of it or nothing.
void growAlong(Workspace& work, const std::vector<EspHit>& line);

// Leads the plant of a seed along other points, or, with none, takes it away with its line. One step of undo; all of it
// or nothing.
void relay(Workspace& work, uint32_t seed, const std::vector<LinePoint>& points);

// The places of surfaces that a line goes over from point to point.
std::vector<EspHit> placesOf(const Workspace& work, const std::vector<LinePoint>& points);

}  // namespace sample
