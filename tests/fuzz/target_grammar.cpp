// In: bytes. Out: nothing, if all goes well; a grammar that compiles must survive being saved and loaded.
#include "runtime/grammar/grammar.hpp"
#include "tests/fuzz/promise.hpp"

namespace espalier::fuzz {

void grammar(Bytes bytes) {
    auto map = compileGrammar(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    if (!map) return checkMessage(map.failure());
    auto again = RuleMap::load(map->save(), "saved");
    require(bool(again), "what was saved can be loaded");
    require(again->contentHash() == map->contentHash(), "and is the same");
}

}  // namespace espalier::fuzz
