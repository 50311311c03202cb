// Text -> rule map: parse, declare, analyse, lower, assemble, verify. And the same from a file, with a cache.
#include "runtime/core/file.hpp"
#include "runtime/core/file_beside.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/grammar/parser.hpp"
#include "runtime/grammar/rule_map_cache.hpp"
#include "runtime/grammar/rule_map_layout.hpp"

namespace espalier {
namespace {

// Part of the content hash: raise it whenever the same text compiles to another map.
constexpr uint64_t kCompilerVersion = 12;

uint64_t contentHashOf(const std::vector<std::string>& sources, const std::vector<std::string>& names,
                       const CompileOptions& options) {
    uint64_t hash = kCompilerVersion;
    for (const std::string& s : sources) hash = hashText(s, mix64(hash + s.size()));
    for (const std::string& s : names) hash = hashText(s, mix64(hash + s.size()));
    for (const TerminalMesh& m : options.meshes) hash = hashText(m.name, mix64(hash + (m.bark ? 1 : 2)));
    for (const TerminalMesh& m : options.roofMeshes) hash = hashText(m.name, mix64(hash + 3));
    for (const TerminalMesh& m : options.pieces) hash = hashText(m.name, mix64(hash + 4));
    return hash;
}

Failure failureOf(grammar::Reporter& reporter) {
    return Failure(std::move(reporter.all()));
}

struct Parsed {
    explicit Parsed(const CompileOptions& options) : compilation(options) {}
    grammar::Compilation compilation;
    uint64_t contentHash = 0;
};

void parse(std::string_view text, Parsed& p) {
    std::vector<std::string> sources;
    grammar::Compilation& c = p.compilation;
    grammar::parseModule(text, c.options, c.module, c.reporter, sources);
    p.contentHash = contentHashOf(sources, c.module.files, c.options);
}

// What the statement `word` says, if it stands there; called `name` in messages.
void lowerLength(grammar::Compilation& c, const std::string& word, const std::string& name,
                 const std::vector<grammar::LengthDeclaration>& declared, FixedLength& length) {
    for (size_t i = 0; i < declared.size(); ++i) {
        if (i > 0) c.reporter.error(declared[i].place, word, name + " is given twice; a grammar has one");
        grammar::Env env;
        env.rule = word;
        grammar::Node node = c.expressions.lower(declared[i].value, env);
        const grammar::Place& place = c.module.exprs[declared[i].value].place;
        if (!c.graph.isFixed(node))
            c.reporter.error(place, word, name + " may use numbers and parameters only");
        else if (c.graph.isConstant(node) && !(c.graph[node].value >= 0))
            c.reporter.error(place, word, name + " can't be negative");
        else if (c.graph.isConstant(node))
            length.value = c.graph[node].value;
        else if (i == 0 && c.code.failure.empty()) {
            length.uniform = c.code.uniform(node).slot - grammar::kSlotUniform;
            if (!c.code.failure.empty()) c.reporter.error(place, word, c.code.failure);
        }
    }
}

void lowerLengths(grammar::Compilation& c) {
    lowerLength(c, "width", "the width", c.module.widths, c.width);
    lowerLength(c, "avoid", "the distance", c.module.avoids, c.avoid);
    if (c.kind != GrammarKind::plants && !c.module.avoids.empty())
        c.reporter.error(c.module.avoids[0].place, "avoid", "only stems of plants keep a distance");
}

Result<RuleMap> compile(Parsed& p) {
    grammar::Compilation& c = p.compilation;
    c.kind = grammar::kindOf(c.module);
    c.expressions.ofKind(c.kind);
    c.code.roofs = c.kind == GrammarKind::roofs;
    if (c.kind == GrammarKind::patterns) c.code.queries = &c.expressions.queries;
    c.expressions.declare();
    // Lowering checks what is in the rules; it can't get stuck on what has been reported so far.
    if (c.kind == GrammarKind::roofs) {
        grammar::collectSymbols(c);
        grammar::lowerRoofs(c);
    } else if (c.kind == GrammarKind::patterns) {
        grammar::collectSymbols(c);
        grammar::lowerPatterns(c);
    } else {
        grammar::analyseSymbols(c);
        grammar::lowerGrowth(c);
    }
    lowerLengths(c);
    if (c.reporter.failed()) return failureOf(c.reporter);
    c.expressions.warnUnused();
    if (c.kind == GrammarKind::plants) grammar::warnUnreached(c);
    RuleMap map = RuleMapAccess::assemble(c, p.contentHash);
    if (!c.code.failure.empty()) return Failure(c.options.fileName, c.code.failure);
    std::string wrong = RuleMapAccess::verify(map);
    if (!wrong.empty()) return Failure(c.options.fileName, "the compiled map doesn't pass verification: " + wrong);
    return map;
}

}  // namespace

Result<RuleMap> compileGrammar(std::string_view text, const CompileOptions& options,
                               const std::filesystem::path& cacheFolder) {
    Parsed p(options);
    parse(text, p);
    if (cacheFolder.empty() || p.compilation.reporter.failed()) return compile(p);

    const RuleMapCache cache(cacheFolder);
    std::optional<RuleMap> known = cache.find(p.contentHash);
    if (known && RuleMapAccess::meshesWithin(*known, options)) return std::move(*known);
    Result<RuleMap> map = compile(p);
    if (!map) return map;
    if (Status kept = cache.keep(*map); !kept)
        RuleMapAccess::warnings(*map).push_back(
            {cacheFolder.string(), 0, 0, {}, "the compiled grammar can't be cached: " + kept.failure().text(), true});
    return map;
}

IncludeReader includesBeside(const std::filesystem::path& file) {
    return [file](const std::string& name) -> Result<std::string> {
        Result<std::filesystem::path> place = placeBeside(file, name);
        if (!place) return std::move(place.failure());
        return readTextFile(*place);
    };
}

Result<RuleMap> compileGrammarFile(const std::filesystem::path& file, CompileOptions options,
                                   const std::filesystem::path& cacheFolder) {
    Result<std::string> text = readTextFile(file);
    if (!text) return std::move(text.failure());
    options.fileName = file.filename().string();
    options.readInclude = includesBeside(file);
    return compileGrammar(*text, options, cacheFolder);
}

}  // namespace espalier
