#pragma once

// Terminal meshes: ivy leaves, bark, pebbles, and their textures. docs/scene_format.md describes the frames.

#include "tools/content/model.hpp"

namespace espalier::content {

inline constexpr int kLeafVariants = 3;
inline constexpr int kLeafLods = 4;
inline constexpr int kBarkLods = 3;
inline constexpr int kPebbleVariants = 2;
inline constexpr int kPebbleLods = 2;

// Origin where the stalk is attached, +Y along the leaf, +Z out of its upper side, one unit long.
Mesh makeLeaf(int variant, int lod);

// Base colour with alpha (a distance ramp about 0.5) and normals; the upper halves of the pictures hold the upper
// sides of the variants side by side, the lower halves their paler backs (v + 0.5).
struct LeafAtlas {
    Picture color, normal;
};
LeafAtlas paintLeaves(int size);

// A tube: section of radius 1 in x and y, z from 0 to 1, open at both ends. u turns once round, v = 1 - z.
Mesh makeBark(int lod);

// Tiles in both directions.
struct Tile {
    Picture color, normal;
};
Tile paintBark(int size);

// About unit size, lying on z = 0, +Z up.
Mesh makePebble(int variant, int lod);
Tile paintPebble(int size);

}  // namespace espalier::content
