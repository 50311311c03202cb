// contact/…: a surface of the sample's size moved against another: contacts and what is buried found and given to both,
// beside the same from loaded surfaces on, as if nothing were kept.
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

#include "runtime/surface/burial.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {
namespace {

// A place of b's ruin against a's: a little further each time.
glm::dmat4 placeOf(int move) {
    return glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(6.5 + 0.01 * (move % 20), 0.02, 0.4)), 0.3,
                       glm::dvec3(0, 1, 0));
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
        const PlacedGround placedA{&a, glm::dmat4(1)}, placedB{&b, placeOf(moves++)};
        const PlacedContacts found = contactsOf(placedA, placedB, {});
        crossings = found.fromA.size() + found.fromB.size();
        changed = buried = 0;
        const auto patch = [&](const PlacedGround& own, const PlacedGround& by, const std::vector<Crossing>& added,
                               bool yields) {
            const TexelSets sets = buriedTexels(*data, hiddenTexels(*data, own, by, added, yields), added);
            for (const auto& level : sets) buried += level.size();
            if (const auto patches = patchLevels(*data, added, sets))
                for (const LevelPatch& one : patches.value()) changed += one.texels.size();
        };
        patch(placedA, placedB, found.fromA, true);
        patch(placedB, placedA, found.fromB, false);
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

}  // namespace

void contactCases(Bench& bench) {
    moveRuin(bench);
}

}  // namespace espalier
