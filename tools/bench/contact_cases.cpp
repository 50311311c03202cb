// contact/…: a surface of the sample's size moved against another: contacts and what is buried found and given to both,
// beside the same from loaded surfaces on, as if nothing were kept.
#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

#include "runtime/surface/burial.hpp"
#include "tools/bake/bake.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {
namespace {

using glm::dmat4;
using glm::dvec3;

// Finds what is buried of a surface and what changes of its levels, and adds to their numbers.
void give(const SurfaceData& data, const PlacedGround& own, const PlacedGround& by, const std::vector<Crossing>& added,
          bool yields, size_t& changed, size_t& buried) {
    const TexelSets sets = buriedTexels(data, hiddenTexels(data, own, by, added, yields), added);
    for (const auto& level : sets) buried += level.size();
    if (const auto patches = patchLevels(data, added, sets))
        for (const LevelPatch& patch : patches.value()) changed += patch.texels.size();
}

// A closed block from -half to half.
Model block(glm::vec3 half) {
    Model model;
    model.name = "block";
    for (uint32_t i = 0; i < 8; ++i)
        model.positions.push_back(half * glm::vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    model.indices = {1, 3, 7, 1, 7, 5, 0, 4, 6, 0, 6, 2, 2, 6, 7, 2, 7, 3,
                     0, 1, 5, 0, 5, 4, 4, 5, 7, 4, 7, 6, 0, 2, 3, 0, 3, 1};
    return model;
}

// A place of b's ruin against a's: a little further each time.
dmat4 placeOf(int move) {
    return glm::rotate(glm::translate(dmat4(1), dvec3(6.5 + 0.01 * (move % 20), 0.02, 0.4)), 0.3, dvec3(0, 1, 0));
}

void moveRuin(Bench& bench) {
    const char* name = "contact/move";
    if (!bench.wants(name)) return;
    Result<SurfaceData> data = readSurface(bench.options().contentFolder + "/ruin.surface.glb");
    if (!data) return bench.skip(name, "needs the sample content");
    const ContactGround keptA(*data), keptB(*data);
    size_t crossings = 0, changed = 0, buried = 0;
    int moves = 0;
    const auto join = [&](const ContactGround& a, const ContactGround& b) {
        const PlacedGround placedA{&a, dmat4(1)}, placedB{&b, placeOf(moves++)};
        const PlacedContacts found = contactsOf(placedA, placedB, {});
        crossings = found.fromA.size() + found.fromB.size();
        changed = buried = 0;
        give(*data, placedA, placedB, found.fromA, true, changed, buried);
        give(*data, placedB, placedA, found.fromB, false, changed, buried);
    };
    const Pair times = medianSeconds(
        bench.options().repeats, [&] { join(keptA, keptB); },
        [&] {
            const ContactGround a(*data), b(*data);
            join(a, b);
        });
    char figure[160];
    std::snprintf(figure, sizeof figure,
                  "a ruin moved against a ruin, 70k triangles each: %zu crossings, %zu texels changed, %zu buried",
                  crossings, changed, buried);
    bench.add({name, figure, "ms", times.a * 1e3, "nothing kept from before", times.b * 1e3});
}

// A block that stands in the ruin's ground, moved about on it: what it buries is found, and what it had buried comes
// back.
void moveBlock(Bench& bench) {
    const char* name = "contact/bury";
    if (!bench.wants(name)) return;
    Result<SurfaceData> data = readSurface(bench.options().contentFolder + "/ruin.surface.glb");
    if (!data) return bench.skip(name, "needs the sample content");
    BakeOptions options;
    options.resolution = 256;
    Result<Baked> baked = bake(block({0.5, 0.5, 0.3}), options);
    if (!baked) return bench.skip(name, baked.failure().text());
    const SurfaceData& moved = baked->surface;
    const ContactGround keptRuin(*data), keptBlock(moved);
    size_t buried = 0, changed = 0;
    int moves = 0;
    const auto join = [&](const ContactGround& ruin, const ContactGround& box) {
        const dmat4 place = glm::translate(dmat4(1), {-1.6 + 0.01 * (moves++ % 20), 0.2, 1.4});
        const PlacedGround on{&ruin, dmat4(1)}, stands{&box, place};
        const PlacedContacts found = contactsOf(on, stands, {});
        changed = buried = 0;
        give(*data, on, stands, found.fromA, true, changed, buried);
        give(moved, stands, on, found.fromB, false, changed, buried);
    };
    const Pair times = medianSeconds(
        bench.options().repeats, [&] { join(keptRuin, keptBlock); },
        [&] {
            const ContactGround ruin(*data), box(moved);
            join(ruin, box);
        });
    char figure[160];
    std::snprintf(figure, sizeof figure, "a block moved on a ruin's ground: %zu texels changed, %zu buried", changed,
                  buried);
    bench.add({name, figure, "ms", times.a * 1e3, "nothing kept from before", times.b * 1e3});
}

// A house as large as a quarter of a terrain's side, moved about on its hills and set into them.
void moveHouse(Bench& bench) {
    const char* name = "contact/terrain";
    if (!bench.wants(name)) return;
    constexpr uint32_t kQuads = 200;
    Model hills;
    hills.name = "hills";
    for (uint32_t y = 0; y <= kQuads; ++y)
        for (uint32_t x = 0; x <= kQuads; ++x) {
            const double u = 60.0 * x / kQuads - 30, v = 60.0 * y / kQuads - 30;
            hills.positions.push_back({float(u), float(0.8 * std::sin(0.31 * u) * std::cos(0.23 * v)), float(v)});
            if (x == kQuads || y == kQuads) continue;
            const uint32_t a = y * (kQuads + 1) + x, b = a + 1, c = a + kQuads + 1, d = c + 1;
            for (uint32_t i : {a, c, b, b, c, d}) hills.indices.push_back(i);
        }
    Model walls = block({7.5, 6, 5});
    walls.name = "house";
    BakeOptions options;
    options.resolution = 1024;
    Result<Baked> terrain = bake(hills, options), house = bake(walls, options);
    if (!terrain || !house) return bench.skip(name, (terrain ? house : terrain).failure().text());
    const SurfaceData &under = terrain->surface, &over = house->surface;
    const ContactGround keptUnder(under), keptOver(over);
    size_t buried = 0, changed = 0;
    int moves = 0;
    const auto join = [&](const ContactGround& ground, const ContactGround& stands) {
        const dmat4 place = glm::rotate(glm::translate(dmat4(1), {0.1 * (moves++ % 20), 2, 1.4}), 0.3, dvec3(0, 1, 0));
        const PlacedGround a{&ground, dmat4(1)}, b{&stands, place};
        const PlacedContacts found = contactsOf(a, b, {});
        changed = buried = 0;
        give(under, a, b, found.fromA, true, changed, buried);
        give(over, b, a, found.fromB, false, changed, buried);
    };
    const Pair times = medianSeconds(
        bench.options().repeats, [&] { join(keptUnder, keptOver); },
        [&] {
            const ContactGround ground(under), stands(over);
            join(ground, stands);
        });
    char figure[160];
    std::snprintf(figure, sizeof figure, "a house moved on hills, both 1024 squared: %zu texels changed, %zu buried",
                  changed, buried);
    bench.add({name, figure, "ms", times.a * 1e3, "nothing kept from before", times.b * 1e3});
}

}  // namespace

void contactCases(Bench& bench) {
    moveRuin(bench);
    moveBlock(bench);
    moveHouse(bench);
}

}  // namespace espalier
