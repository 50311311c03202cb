// In: changes to a rule map. Out: nothing, if all goes well; a rule map that is accepted can be used by all that looks
// at one, and is the same once it has been saved and loaded again.
#include <cmath>
#include <cstring>
#include <iterator>
#include <vector>

#include "runtime/core/hash.hpp"
#include "runtime/grammar/grammar.hpp"
#include "tests/fuzz/promise.hpp"

namespace espalier::fuzz {
namespace {

constexpr size_t kChecksumAt = 16, kHead = 24;

void check(std::span<const uint8_t> bytes) {
    Result<RuleMap> map = RuleMap::load(bytes, "fuzzed");
    if (!map) return checkMessage(map.failure());
    const auto saved = map->save();
    Result<RuleMap> again = RuleMap::load(saved, "saved");
    require(bool(again), "what was saved can be loaded");
    require(again->contentHash() == map->contentHash(), "and is the same");
    for (uint32_t i = 0; i < map->params().size(); ++i)
        for (const float value : {-1e30f, 0.f, .5f, 1e30f, NAN}) {
            const float values[] = {value, value, value};
            (void)map->setParam(i, {values, numbersOf(map->params()[i])});
        }
    require(std::isfinite(map->width()) && map->width() >= 0, "a width is finite");
    (void)map->changesFrom(*again);
    (void)map->growsAs(*again);
    for (const SymbolInfo& symbol : map->symbols())
        require(map->findSymbol(symbol.name).has_value(), "symbols are found");
    require(map->startSymbol() < map->symbols().size(), "the first symbol is one");
}

// A plant's grammar and one of roofs, as this version's compiler saves them.
std::vector<uint8_t> savedMap(bool roofs) {
    const char* plant =
        "param size = 1 [0.1 .. 10] \"m\" \"Size\"\n"
        "param on = true \"On\"\n"
        "param tint = #204010 \"Tint\"\n"
        "context mask = 1 \"Mask\"\n"
        "width size * 0.1\n"
        "let side = index % 2 < 1 ? -1 : 1\n"
        "Begin -> Start(3)\n"
        "Start(l) : arc >= l and mask(texCoord) > 0.5 -> NULL\n"
        "Start(l) : rand() < 0.2 and on -> Branch(2) {Go(l), Go((l - arc) * 0.5)} : 0.5\n"
        "Start(l) -> Go(l)\n"
        "Go(l) -> Marching(0.05 * size, clamp(angleTo(up), -0.2, rand(0, 1)), true) {Start(l), Wood Repeat(every(0.1)) "
        "{Leaf}}\n"
        "Wood -> S(mix(0.1, 0.2, min(1, toTip))) Shape(\"bark\", C1)\n"
        "Leaf -> T(0, 0.1) R(side * 30, 0.3) S(size) Colour(tint) Shape(\"leaf\")\n";
    const char* town =
        "context decay = 0\nparam high = 3 [1 .. 9] \"m\" \"High\"\nHouse -> Extrude(wallHeight) {NULL, Top}\n"
        "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
        "Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}\nTile -> Drop(decay) Shape(\"slate\")\n";
    CompileOptions options;
    options.roofMeshes = {{"slate", false}};
    auto map = compileGrammar(roofs ? town : plant, options);
    require(bool(map), "the target's own grammars compile");
    return map->save();
}

// One of these with some of its words changed: six bytes a change, where, how and by what.
std::vector<uint8_t> changedMap(Bytes bytes) {
    static const std::vector<uint8_t> maps[] = {savedMap(false), savedMap(true)};
    std::vector<uint8_t> map = maps[bytes[0] & 1];
    for (bytes = bytes.subspan(1); bytes.size() >= 6; bytes = bytes.subspan(6)) {
        const size_t at = kHead + (bytes[0] | size_t(bytes[1]) << 8) % (map.size() - kHead - 3);
        uint32_t word = 0, value = bytes[3] | uint32_t(bytes[4]) << 8 | uint32_t(bytes[5]) << 16;
        std::memcpy(&word, map.data() + at, sizeof word);
        const uint32_t changes[] = {word + value, word - value, value, value << 8, word ^ value, ~value};
        word = changes[bytes[2] % std::size(changes)];
        std::memcpy(map.data() + at, &word, sizeof word);
    }
    return map;
}

}  // namespace

// The checksum is put right: nearly every change would else be refused for that alone.
void rulemap(Bytes bytes) {
    check(bytes);
    if (bytes.empty()) return;
    std::vector<uint8_t> map = changedMap(bytes);
    const uint64_t checksum = hashBytes(std::as_bytes(std::span(map).subspan(kHead)));
    std::memcpy(map.data() + kChecksumAt, &checksum, sizeof checksum);
    check(map);
}

}  // namespace espalier::fuzz
