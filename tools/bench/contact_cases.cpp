// contact/…: a surface of the sample's size moved against another: contacts found and given to both, beside the same
// from loaded surfaces on, as if nothing were kept.
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

#include "runtime/surface/added_crossings.hpp"
#include "runtime/surface/contact_ground.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {

void contactCases(Bench& bench) {
    const char* name = "contact/move";
    if (!bench.wants(name)) return;
    Result<SurfaceData> data = readSurface(bench.options().contentFolder + "/ruin.surface.glb");
    if (!data) return bench.skip(name, "needs the sample content");
    const ContactGround kept(*data);
    size_t crossings = 0, texels = 0;
    // Two ruins that overlap by a part of their ground, turned against each other; each time a little further.
    int moves = 0;
    const auto join = [&](const ContactGround& a, const ContactGround& b) {
        const glm::dmat4 place =
            glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(6.5 + 0.01 * (moves++ % 20), 0.02, 0.4)), 0.3,
                        glm::dvec3(0, 1, 0));
        const PlacedContacts found = contactsOf({&a, glm::dmat4(1)}, {&b, place}, {});
        crossings = found.fromA.size() + found.fromB.size();
        texels = 0;
        for (const auto* added : {&found.fromA, &found.fromB})
            if (const auto patches = patchLevels(*data, *added))
                for (const LevelPatch& patch : patches.value()) texels += patch.texels.size();
    };
    const Pair times = medianSeconds(
        bench.options().repeats, [&] { join(kept, kept); },
        [&] {
            const ContactGround a(*data), b(*data);
            join(a, b);
        });
    char figure[128];
    std::snprintf(figure, sizeof figure,
                  "a ruin moved against a ruin, 70k triangles each: %zu crossings, %zu texels changed", crossings,
                  texels);
    bench.add({name, figure, "ms", times.a * 1e3, "nothing kept from before", times.b * 1e3});
}

}  // namespace espalier
