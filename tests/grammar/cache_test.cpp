// Saved rule maps: the same when loaded, refused when damaged, harmless when forged; the cache on disk.
#include <chrono>
#include <cstdio>
#include <cstring>
#include <iterator>

#include "runtime/core/hash.hpp"
#include "runtime/grammar/rule_map_cache.hpp"
#include "tests/grammar/support.hpp"

using namespace grammar_test;

namespace {

RuleMap ivy() {
    Result<RuleMap> map = compileGrammarFile("content/grammars/ivy_free.grammar");
    if (!map) FAIL(map.failure().text());
    return std::move(map.value());
}

// Makes the checksum in the header (bytes 16..23) fit the rest again.
void forgeChecksum(std::vector<uint8_t>& bytes) {
    uint64_t sum = hashBytes(std::as_bytes(std::span(bytes).subspan(24)));
    std::memcpy(&bytes[16], &sum, 8);
}

// Every kind of rule and of part.
const std::string kRoofs =
    "param high = 3 [1 .. 9]\n"
    "House -> Extrude(high) {Wall, Top}\n"
    "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, Explode() {NULL, Row, Row, Row, Row}, Top}\n"
    "Cover -> Split(X, eaveStart + 1, ~, rel(0.1)) {Project(localTangent, globalNormal) {Tiles}, Tiles, NULL} : 2\n"
    "Cover -> Tiles\n"
    "Tiles -> Repeat(XY, vec2(0.26, 0.2), bond) {Shape(\"leaf\")}\n"
    "Row -> Repeat(X, 0.4) {Cap(index, rand())}\n"
    "Cap(i, r) : i % 2 == 0 -> S(sizeX, 0.2) T(0, r) Tint(r * 0.5) Shape(\"pebble\")\n"
    "Cap(i, r) -> NULL\n"
    "Wall -> Shape(\"pebble\")\n";

// Does everything that an expander could do with a map, for some steps.
void exercise(const RuleMap& map) {
    RuleMapRef ref = map.ref();
    uint32_t symbol = map.startSymbol();
    Machine machine = machineFor({1, 2, 3, 4});
    for (uint64_t key = 1; key < 20; ++key) {
        SymbolRecord s = ref.symbols.v[symbol];
        drawSites(MACHINE ref.sites, s.firstSite, s.siteCount, key, key);
        runCode(MACHINE ref.code, s.select);
        int chosen = selectedRule(MACHINE s);
        if (chosen < 0) return;
        RuleRecord r = ref.rules.v[s.firstRule + static_cast<uint32_t>(chosen)];
        drawSites(MACHINE ref.sites, r.firstSite, r.siteCount, key, key);
        runCode(MACHINE ref.code, r.start);
        runCode(MACHINE ref.code, r.arrive);
        if (r.extrude != 0 && !map.roofs()) {
            ExtrudeRecord e = ref.extrudes.v[r.extrude - 1];
            for (uint32_t t = 0; t < e.terminalCount; ++t) {
                TerminalRecord terminal = ref.terminals.v[e.firstTerminal + t];
                drawSites(MACHINE ref.sites, terminal.gateFirstSite, terminal.gateSiteCount, key, key);
                runCode(MACHINE ref.code, terminal.gate);
                runCode(MACHINE ref.code, terminal.body);
                CHECK(std::isfinite(valueOf(MACHINE terminal.size)));
            }
        }
        if (r.successorCount == 0) return;
        SuccessorRecord next = ref.successors.v[r.firstSuccessor + key % r.successorCount];
        runCode(MACHINE ref.code, next.code);
        for (const Value& v : next.args) CHECK(std::isfinite(valueOf(MACHINE v)));
        symbol = next.symbol;
    }
}

struct TemporaryFolder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("espalier_grammar_" + std::to_string(std::random_device{}()));
    TemporaryFolder() { std::filesystem::create_directories(path); }
    ~TemporaryFolder() {
        std::error_code code;
        std::filesystem::remove_all(path, code);
    }
};

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary);
    out << text;
}

}  // namespace

TEST_CASE("a saved map is the same when loaded, whatever its parameters stood at") {
    RuleMap map = ivy();
    std::vector<uint32_t> words(map.words().begin(), map.words().end());
    float v = 0.31f;
    CHECK(map.setParam(*map.findParam("wander"), {&v, 1}) != 0);
    CHECK_FALSE(std::equal(words.begin(), words.end(), map.words().begin()));
    Result<RuleMap> loaded = RuleMap::load(map.save(), "test.rulemap");
    if (!loaded) FAIL(loaded.failure().text());
    CHECK(std::vector<uint32_t>(loaded->words().begin(), loaded->words().end()) == words);
    CHECK(loaded->contentHash() == map.contentHash());
    CHECK(loaded->startSymbol() == map.startSymbol());
    REQUIRE(loaded->params().size() == map.params().size());
    CHECK(loaded->params()[3].label == map.params()[3].label);
    loaded->setParam(*loaded->findParam("wander"), {&v, 1});
    CHECK(std::equal(map.words().begin(), map.words().end(), loaded->words().begin()));
}

TEST_CASE("the width is kept, constant or not, and a forged one is refused") {
    const std::string march = "A -> Marching(0.1, 0, true) {A}\n";
    RuleMap map = compiled("param p = 0.2 [0 .. 1]\nwidth p * 0.5\n" + march);
    float v = 0.8f;
    map.setParam(0, {&v, 1});
    Result<RuleMap> loaded = RuleMap::load(map.save(), "test.rulemap");
    if (!loaded) FAIL(loaded.failure().text());
    CHECK(loaded->width() == doctest::Approx(0.1f));
    loaded->setParam(0, {&v, 1});
    CHECK(loaded->width() == doctest::Approx(0.4f));

    RuleMap constant = compiled("width 0.25\n" + march);
    Result<RuleMap> loadedConstant = RuleMap::load(constant.save(), "test.rulemap");
    if (!loadedConstant) FAIL(loadedConstant.failure().text());
    CHECK(loadedConstant->width() == 0.25f);

    // The last 8 bytes: which of the host's values it is, and the width.
    auto refused = [](const RuleMap& from, size_t fromEnd, auto value) {
        std::vector<uint8_t> bytes = from.save();
        std::memcpy(&bytes[bytes.size() - fromEnd], &value, 4);
        forgeChecksum(bytes);
        Result<RuleMap> forged = RuleMap::load(bytes, "forged.rulemap");
        return !forged && forged.failure().text().find("damaged in: the width") != std::string::npos;
    };
    CHECK(refused(map, 8, 1u));
    CHECK(refused(constant, 8, 0u));
    for (float bad : {-0.1f, INFINITY, NAN}) CHECK(refused(constant, 4, bad));
    CHECK_FALSE(refused(constant, 4, 0.5f));
}

TEST_CASE("a flipped byte anywhere is found") {
    std::vector<uint8_t> good = ivy().save();
    for (size_t i = 0; i < good.size(); i += 1 + i % 3) {
        if (i >= 8 && i < 16) continue;  // the content hash is compared by who asks for it
        std::vector<uint8_t> bad = good;
        bad[i] ^= 1u << (i % 8);
        CHECK_FALSE(RuleMap::load(bad, "bad.rulemap"));
    }
    for (size_t n = 0; n < good.size(); n += 37) CHECK_FALSE(RuleMap::load(std::span(good).first(n), "short.rulemap"));
    CHECK(RuleMap::load({}, "empty.rulemap").failure().text() ==
          "empty.rulemap: not a usable rule map: it is too short");
}

TEST_CASE("a forged map is refused or does no harm") {
    const std::vector<uint8_t> plants = ivy().save(), roofs = compiled(kRoofs).save();
    std::mt19937 random(3);
    int refused = 0, loadedCount = 0;
    for (int i = 0; i < 12000; ++i) {
        std::vector<uint8_t> bad = i % 2 == 0 ? plants : roofs;
        for (uint32_t k = 0; k <= random() % 3; ++k) {
            size_t at = 24 + random() % (bad.size() - 24);
            bad[at] =
                random() % 2 == 0 ? static_cast<uint8_t>(random()) : static_cast<uint8_t>(random() % 2 == 0 ? 0xFF : 0);
        }
        forgeChecksum(bad);
        Result<RuleMap> map = RuleMap::load(bad, "forged.rulemap");
        refused += map ? 0 : 1;
        if (!map) continue;
        ++loadedCount;
        exercise(*map);
        float v = 1;
        if (!map->params().empty()) map->setParam(0, {&v, 1});
        exercise(*map);
    }
    MESSAGE(refused << " refused, " << loadedCount << " harmless");
    CHECK(refused > 500);
    CHECK(loadedCount > 100);
}

TEST_CASE("a cached map of meshes that there aren't is compiled anew") {
    TemporaryFolder folder;
    const std::string texts[] = {kRoofs, "A -> Marching(0.1, 0, true) {A, S(1) Shape(\"leaf\")}\n"};
    for (const std::string& text : texts) {
        const std::filesystem::path cache = folder.path / std::to_string(text.size());
        Result<RuleMap> map = compileGrammar(text, {}, cache);
        if (!map) FAIL(map.failure().text());
        const std::filesystem::path kept = std::filesystem::directory_iterator(cache)->path();
        const std::string good = contentsOf(kept);
        const RuleMapRef ref = map->ref();
        // Where the file has the mesh of a terminal, or of a rule that is one; plain ones are named by successors, too.
        const uint32_t* mesh = ref.terminalCount ? &ref.terminals.v[0].mesh : nullptr;
        for (uint32_t i = 0; i < ref.ruleCount; ++i)
            if (ref.rules.v[i].kind == kRuleShape && ref.rules.v[i].start.count > 0) mesh = &ref.rules.v[i].extrude;
        REQUIRE(mesh);
        const std::string_view words(reinterpret_cast<const char*>(map->words().data()), map->words().size_bytes());
        REQUIRE(good.find(words) != std::string::npos);
        const size_t at = good.find(words) + size_t(reinterpret_cast<const char*>(mesh) - words.data());
        for (uint32_t other : {uint32_t(standardTerminalMeshes().size()), 255u}) {
            std::vector<uint8_t> bad(good.begin(), good.end());
            std::memcpy(&bad[at], &other, 4);
            forgeChecksum(bad);
            REQUIRE(RuleMap::load(bad, "forged.rulemap"));
            write(kept, std::string(bad.begin(), bad.end()));
            Result<RuleMap> again = compileGrammar(text, {}, cache);
            REQUIRE(again);
            CHECK(std::equal(map->words().begin(), map->words().end(), again->words().begin(), again->words().end()));
            CHECK(contentsOf(kept) == good);
        }
    }
}

TEST_CASE("compiled grammars are kept by content and compiled again when the text or an include changes") {
    TemporaryFolder folder;
    std::filesystem::path cache = folder.path / "cache";
    write(folder.path / "base.grammar", "param p = 0.1\n");
    write(folder.path / "a.grammar", "include \"base.grammar\"\nA -> Marching(p, 0, true) {A}\n");
    auto files = [&] {
        size_t n = 0;
        for (const auto& entry : std::filesystem::directory_iterator(cache)) n += entry.is_regular_file() ? 1 : 0;
        return n;
    };
    Result<RuleMap> first = compileGrammarFile(folder.path / "a.grammar", {}, cache);
    if (!first) FAIL(first.failure().text());
    CHECK(files() == 1);
    Result<RuleMap> again = compileGrammarFile(folder.path / "a.grammar", {}, cache);
    REQUIRE(again);
    CHECK(files() == 1);
    CHECK(std::equal(first->words().begin(), first->words().end(), again->words().begin()));

    // What is in the cache is used: a map of other words under this name comes back.
    std::filesystem::path kept = std::filesystem::directory_iterator(cache)->path();
    std::string bytes = contentsOf(kept);
    write(kept, bytes.substr(0, bytes.size() / 2));
    Result<RuleMap> mended = compileGrammarFile(folder.path / "a.grammar", {}, cache);
    REQUIRE(mended);
    CHECK(contentsOf(kept) == bytes);

    write(folder.path / "base.grammar", "param p = 0.2\n");
    Result<RuleMap> changed = compileGrammarFile(folder.path / "a.grammar", {}, cache);
    REQUIRE(changed);
    CHECK(files() == 2);
    CHECK(ruleOf(*changed, "A").distance.immediate == 0.2f);

    // A file stands where the folder should be.
    write(folder.path / "blocked", "x");
    Result<RuleMap> uncached = compileGrammarFile(folder.path / "a.grammar", {}, folder.path / "blocked");
    REQUIRE(uncached);
    CHECK(toString(uncached->warnings()).find("can't be cached") != std::string::npos);
}

TEST_CASE("the cache holds the grammars used last, and leaves other files alone") {
    TemporaryFolder folder;
    const std::filesystem::path cache = folder.path / "cache";
    std::filesystem::create_directories(cache);
    write(cache / "notes.rulemap", "x");
    const auto compile = [&](size_t i) {
        Result<RuleMap> map = compileGrammar(
            "param p = " + std::to_string(i) + " [0 .. 1000]\nA -> Marching(p, 0, true) {A}\n", {}, cache);
        if (!map) FAIL(map.failure().text());
        return map->contentHash();
    };
    const auto fileOf = [&](uint64_t hash) {
        char name[32];
        std::snprintf(name, sizeof name, "%016llx.rulemap", static_cast<unsigned long long>(hash));
        return cache / name;
    };
    const uint64_t used = compile(0), typed = compile(1);
    // As if these had been written long ago.
    const auto old = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
    for (uint64_t hash : {used, typed}) std::filesystem::last_write_time(fileOf(hash), old);
    for (size_t i = 2; i < RuleMapCache::kMost; ++i) compile(i);
    CHECK(compile(0) == used);
    compile(RuleMapCache::kMost);
    CHECK(std::filesystem::exists(fileOf(used)));
    CHECK_FALSE(std::filesystem::exists(fileOf(typed)));
    CHECK(std::filesystem::exists(cache / "notes.rulemap"));
    const std::filesystem::directory_iterator files(cache);
    CHECK(std::distance(begin(files), end(files)) == std::ptrdiff_t(RuleMapCache::kMost) + 1);
}

TEST_CASE("files: a missing one is named, includes stay near their folder") {
    CHECK(compileGrammarFile("no/such.grammar").failure().text().find("no/such.grammar") != std::string::npos);
    TemporaryFolder folder;
    std::filesystem::create_directories(folder.path / "kit" / "main" / "deep");
    std::filesystem::create_directories(folder.path / "kit" / "common");
    const auto compiles = [&](const std::string& name) {
        write(folder.path / "kit/main/deep/a.grammar", "include \"" + name + "\"\nA -> Marching(p, 0, true) {A}\n");
        return compileGrammarFile(folder.path / "kit/main/deep/a.grammar");
    };
    // What an included file includes lies beside that one.
    write(folder.path / "kit/common/lib.grammar", "include \"values.grammar\"\n");
    write(folder.path / "kit/common/values.grammar", "param p = 0.1\n");
    CHECK(compiles("../../common/lib.grammar"));
    write(folder.path / "secret.grammar", "param p = 0.1\n");
    Result<RuleMap> outside = compiles("../../../secret.grammar");
    REQUIRE_FALSE(outside);
    CHECK(outside.failure().text().find("2 folders above") != std::string::npos);
    write(folder.path / "loop.grammar",
          "include \"loop.grammar\"\ninclude \"loop2.grammar\"\nA -> Marching(0.1, 0, true) {A}\n");
    write(folder.path / "loop2.grammar", "include \"loop.grammar\"\n");
    CHECK(compileGrammarFile(folder.path / "loop.grammar"));
    // Nor is the text read again that a host compiles, whatever folder its name has.
    CompileOptions options;
    const std::filesystem::path file = folder.path / "main.grammar";
    options.fileName = file.string();
    options.readInclude = includesBeside(file);
    write(file, "param older = 1\n");
    write(folder.path / "part.grammar", "include \"main.grammar\"\nB -> Marching(p, 0, true) {B}\n");
    Result<RuleMap> map =
        compileGrammar("include \"part.grammar\"\nparam p = 0.1\nA -> Marching(p, 0, true) {A}\n", options);
    if (!map) FAIL(map.failure().text());
    CHECK(map->params().size() == 1);
    CHECK(map->symbols().size() == 2);
}
