#pragma once

// Props that the sample's site is furnished with: trees and bushes of leaves on cards, grass, walls, fences, a well,
// what stands about in yards. Metres, y up, origin on the ground.

#include "tools/content/model.hpp"

namespace espalier::content {

struct PropMeshes {
    enum Material { kFoliage, kBuilt, kGrass, kMeadow, kFallen };  // kMeadow: foliage of the meadow's hue
    struct Entry {
        std::string name;  // MODEL_lodN
        Mesh mesh;
        Material material;
    };
    std::vector<Entry> all;
    void add(const std::string& model, int lod, Mesh mesh, Material material) {
        all.push_back({model + "_lod" + std::to_string(lod), std::move(mesh), material});
    }
};
PropMeshes makePropMeshes();
void addTrees(PropMeshes& out);
void addSmallPlants(PropMeshes& out);
void addFurniture(PropMeshes& out);
void addYard(PropMeshes& out);
void addFallenStones(PropMeshes& out);
Picture paintFallenStones();  // a cell for each face of each

// Twigs full of leaves, cut out along a distance ramp, and bark. Cells are a quarter of the picture wide, from u = 1/8;
// bark fills the strip before them, birch its right half, and repeats along v. Cells of the last column are for the
// larger cards of coarse levels: more and smaller leaves. Beyond them stand, in cells of half the size, flowers, below
// them tall grass, the second with poppies and buttercups, and clover.
constexpr float kCellSide = 0.25f, kFirstCell = 0.125f, kFlowerSide = 0.125f;
constexpr int kFarColumn = 2, kFlowers = 3, kMeadows = 2;
constexpr int kCloverCell = kFlowers + kMeadows;
Picture paintFoliage(int size);

// Built props' colours: u is how bright, v picks the material.
enum class Paint { stone, mortar, wood, darkWood, white, iron, clay, straw, count };
Picture paintPalette();
inline glm::vec2 paletteUv(Paint paint, float bright) {
    return {0.05f + 0.9f * glm::clamp(bright, 0.0f, 1.0f), (float(paint) + 0.5f) / float(Paint::count)};
}

}  // namespace espalier::content
