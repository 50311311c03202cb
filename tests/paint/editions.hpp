#pragma once

// The grammars of tests that edit, and how their texts are changed.

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace espalier::test {

// Two grammars, each in a few editions that grow unlike plants. They want unlike values where a layer isn't painted;
// one may read a layer more, its leaves another one than its rules; the other one's grounds are coarser where its stems
// are wide.
struct Edition {
    const char *from, *to;
};
inline std::string editionOf(uint32_t grammar, uint32_t edition) {
    static const std::string texts[2] = {
        R"(context mask = 1
context cover = 0.7
context tint = #80ff40
param reach = 0.9 [0.1 .. 3]
param stride = 0.05 [0.02 .. 0.2]
param leafSize = 0.05 [0.01 .. 0.2]
param twigs = 0.2 [0 .. 1]
Ivy -> Branch(2) {Stem(reach), Stem(reach * 0.6)}
Stem(l) : arc >= l -> NULL
Stem(l) : depth < 4 and rand() < twigs -> Branch(2) {Creep(l), Twig(0, rand(2, 9))}
Stem(l) -> Creep(l)
Creep(l) -> Marching(stride, rand(-0.3, 0.3), mask(texCoord) > 0.5) {Stem(l), Cover}
Twig(n, k) -> Marching(stride * 0.7, rand(-0.6, 0.6), mask(texCoord) > 0.3 and n < k) {Twig(n + 1, k), Cover}
Cover -> Bark Leaves
Bark -> S(0.002 + 0.01 * clamp(toTip / 0.5, 0, 1)) Shape("bark", C1)
Leaves -> Repeat(floor(rand(0, 3) * cover(texCoord))) {T(rand(), 0.01) R(rand(-1, 1), 0.4) S(leafSize * rand(0.6, 1)) Colour(tint(texCoord)) Shape("leaf")}
)",
        R"(context damp = 0.8
context mask = 0.6
param length = 0.8 [0.1 .. 3]
param girth = 0.01 [0.004 .. 0.2]
param climb = 0.3 [0 .. 1]
param lean = 0.3 [-2 .. 2]
width girth
Vine -> Branch(3) {Up(length), Up(length * 0.7), Up(length * 0.5)}
Up(l) : arc >= l * mix(0.4, 1, damp(texCoord)) -> NULL
Up(l) : depth < 3 and rand() < 0.1 -> Branch(2) {Go(l), Go(l - arc)}
Up(l) -> Go(l)
Go(l) -> Marching(0.06, clamp(angleTo(lean, 1, 0) * climb, -0.2, 0.2) + rand(-0.3, 0.3), mask(texCoord) > 0.2) {Up(l), Wood Last}
Wood -> S(girth) Shape("bark", C1)
Last -> Repeat(every(0.05)) {S(0.04 * rand(0.6, 1)) T(rand(), 0.02) R(rand(-1, 1), 0.3) Tint(damp(texCoord)) Shape("leaf")}
)"};
    static const std::vector<std::vector<Edition>> editions[2] = {
        {{},
         {{"rand(0, 3)", "rand(0, 5)"}},
         {{"mask = 1", "mask = 0.4"}},
         {{"context cover", "context damp = 0.3\ncontext cover"}, {"rand(2, 9)", "rand(2, 14 * damp(texCoord))"}},
         {{"Twig(n + 1, k), Cover", "Tail(n + 1, k), Cover"},
          {"Cover ->",
           "Tail(n, k) : n > 3 and rand() < 0.2 -> Branch(2) {Twig(n, k), Twig(n + 1, k)}\n"
           "Tail(n, k) -> Twig(n, k)\nCover ->"}}},
        {{},
         {{"Last -> ", "Last : arc < 0.2 -> NULL\nLast -> "}},
         {{"damp = 0.8", "damp = 0.2"}},
         {{"rand() < 0.1", "rand() < 0.3"}},
         {{"width girth\n", ""}}}};
    std::string text = texts[grammar];
    for (const Edition& change : editions[grammar][edition % editions[grammar].size()]) {
        const size_t at = text.find(change.from);
        REQUIRE(at != std::string::npos);
        text.replace(at, std::string(change.from).size(), change.to);
    }
    return text;
}

}  // namespace espalier::test
