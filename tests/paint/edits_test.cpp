// After any edits that the public interface has, in any order, a growth of what they concern is the one that all anew
// gives: by the hash over positions, radii and terminals, and by all counts.
#include <cstdlib>
#include <cstring>
#include <map>

#include "tests/bake/small_models.hpp"
#include "tests/paint/random_edits.hpp"
#include "tests/support/cube_model.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

struct Tally {
    uint64_t updates = 0, nodes = 0, smallNodes = 0, smallDerived = 0, touching = 0;
    std::map<std::string, uint32_t> kinds;  // of edits that weren't refused: how many

    void count(const std::vector<std::string>& told) {
        for (const std::string& line : told)
            if (line.find("refused") == std::string::npos) ++kinds[line.substr(0, line.find(' '))];
    }
};

// False: a difference was found, and told with all that led to it.
bool endAlike(const char* model, Twins& twins, RandomEdits& edits, uint32_t seed, uint32_t rounds, Tally& tally) {
    const auto grow = [&] {
        edits.note("update");
        const uint64_t before = twins.stats().nodes;
        const bool alike = twins.alike();
        ++tally.updates;
        tally.nodes += twins.stats().nodes;
        tally.touching += twins.stats().contacts > 0;
        if (edits.small) tally.smallNodes += before, tally.smallDerived += twins.stats().derivedNodes;
        edits.small = false;
        return alike;
    };
    bool alike = grow();
    for (uint32_t i = 0; i < rounds && alike; ++i) {
        const bool many = edits.below(3) == 0;
        edits.focus(many ? 3 : 0);
        for (uint32_t more = many ? 8 : edits.below(2) + 1; more-- > 0 && alike;) {
            alike = edits.edit(grow);
            if (more > 0) edits.small = false;  // what comes next isn't a stroke's alone
        }
        alike = alike && grow();
    }
    if (!alike) twins.tell();
    if (alike && seed % 2 == 1) alike = twins.againFromNothing(edits.rules());
    if (alike) return true;
    std::printf("%s, random seed %u:\n", model, seed);
    for (const std::string& line : edits.told) std::printf("  %s\n", line.c_str());
    return false;
}

// ESPALIER_EDITS=FIRST:COUNT in the environment runs other random seeds, and as many of them as one likes.
Tally randomEdits(const char* model, const std::vector<Ground>& grounds,
                  const std::vector<std::vector<EspTransform>>& poses, uint32_t plants, uint32_t count,
                  uint32_t rounds) {
    uint32_t first = 0;
    if (const char* given = std::getenv("ESPALIER_EDITS")) std::sscanf(given, "%u:%u", &first, &count);
    Tally tally;
    for (uint32_t seed = first; seed < first + count; ++seed) {
        CAPTURE(seed);
        Twins twins(grounds, seed % 4 == 2);
        RandomEdits edits(twins, seed + 1, poses, plants, seed % 2 == 1);
        CHECK(endAlike(model, twins, edits, seed, rounds, tally));
        tally.count(edits.told);
    }
    MESSAGE(std::string(model) << ": " << tally.updates << " updates of " << tally.nodes / tally.updates << " nodes, "
                               << tally.touching << " with surfaces that touch; small dabs derived "
                               << tally.smallDerived << " of " << tally.smallNodes);
    CHECK(tally.touching > tally.updates / 4);
    CHECK(tally.nodes > 300 * tally.updates);
    CHECK(tally.smallDerived > 0);
    CHECK(tally.smallDerived < tally.smallNodes / 4);
    return tally;
}

}  // namespace

TEST_CASE("edits of all kinds in any order end in what growing anew gives: cubes that run into each other") {
    const BakedFile file(cube(2));
    const std::vector<std::vector<EspTransform>> poses = {
        {espIdentity(), standing(0, .1f, 0, 1, .3f)},
        {standing(1.5f, 1.2f, .3f), standing(1.3f, .4f, .5f, 1, .6f), standing(9, 0, 0)},
        {standing(-1.1f, .9f, 0, .6f, -.4f), standing(1.2f, -.6f, 1, .5f), standing(0, 1.5f, 9)}};
    std::vector<Ground> grounds;
    for (const auto& own : poses) grounds.push_back({file.path, own[0]});
    const Tally tally = randomEdits("cubes", grounds, poses, 24, 4, 40);
    for (const char* kind : {"paint", "erase", "smooth",  "undo",   "redo", "fill",     "import", "drop",
                             "set",   "write", "plant",   "remove", "move", "turn",     "number", "give",
                             "take",  "prune", "unprune", "freeze", "thaw", "refreeze", "place"}) {
        CAPTURE(std::string(kind));
        CHECK(tally.kinds.count(kind) == 1);
    }
}

TEST_CASE("edits of all kinds in any order end in what growing anew gives: a ball on a square") {
    const BakedFile round(ball(), 256), square(openQuad(4), 64);
    const EspTransform lying{{{3, 0, 0, -1.5f}, {0, 0, 3, -.9f}, {0, -3, 0, 1.5f}}};
    randomEdits("ball", {{round.path, espIdentity()}, {square.path, lying}},
                {{espIdentity(), standing(.1f, -.1f, 0, 1, 1)}, {lying, standing(-.5f, -.5f, .4f), standing(9, 0, 0)}},
                24, 4, 30);
}

TEST_CASE("edits of all kinds in any order end in what growing anew gives: a cube by the sample's ruin") {
    const BakedFile file(cube(2));
    const EspTransform poses[] = {standing(-1.5f, .4f, .7f, .5f), standing(.5f, .5f, .6f, .5f, .5f)};
    randomEdits("ruin", {{ESPALIER_CONTENT "/ruin.surface.glb", espIdentity()}, {file.path, poses[0]}},
                {{espIdentity()}, {poses, poses + 2}}, 30, 2, 15);
}
