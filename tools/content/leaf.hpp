#pragma once

// Terminal meshes: leaves, blossoms, tufts, bark, pebbles, and their textures. docs/scene_format.md describes the
// frames.

#include "tools/content/model.hpp"

namespace espalier::content {

// Forms that are cut out of pictures: those of the ivy's atlas, then those of the flora's.
inline constexpr int kLeafVariants = 3;
inline constexpr int kOvalVariants = 2;
inline constexpr int kFirstOval = kLeafVariants, kBlossom = kFirstOval + kOvalVariants, kTuft = kBlossom + 1;
inline constexpr int kFloraForms = kTuft + 1 - kFirstOval;
inline constexpr int kLeafLods = 4;
inline constexpr int kFloraLods = 3;
inline constexpr int kBarkLods = 3;
inline constexpr int kPebbleVariants = 2;
inline constexpr int kPebbleLods = 2;

// Origin where the stalk is attached, +Y along the leaf, +Z out of its upper side, one unit long.
Mesh makeLeaf(int variant, int lod);
// The same of the flora's forms but the tuft.
Mesh makeFlora(int form, int lod);
// Upright blades on crossed cards: +Y up, one unit high; its normals lead up, as a lawn is lit.
Mesh makeTuft(int lod);

// Base colour with alpha (a distance ramp about 0.5) and normals; the upper halves of the pictures hold the upper
// sides of the variants side by side, the lower halves their paler backs (v + 0.5).
struct LeafAtlas {
    Picture color, normal;
};
LeafAtlas paintLeaves(int size);
LeafAtlas paintFlora(int size);

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
