// Grammars of patterns: the texts of Li 2011, what they compile to, and what is refused.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "runtime/grammar/grammar.hpp"
#include "runtime/grammar/rule_map_layout.hpp"

using namespace espalier;

namespace {

CompileOptions patternOptions() {
    CompileOptions o;
    o.pieces = {{"torus", false}, {"star", false}, {"cylinder", false}, {"ico1", false}, {"ico2", false}};
    return o;
}
RuleMap patternMap(const std::string& text) {
    Result<RuleMap> map = compileGrammar(text, patternOptions());
    REQUIRE_MESSAGE(map, (map ? "" : map.failure().text()));
    return std::move(map.value());
}
std::string patternRefusal(const std::string& text) {
    const Result<RuleMap> map = compileGrammar(text, patternOptions());
    return map ? "" : map.failure().text();
}
std::vector<PatternPart> partsOf(const RuleMap& map, const char* symbol) {
    const SymbolRecord s = RuleMapAccess::record<SymbolRecord>(map, kSectionSymbols, *map.findSymbol(symbol));
    const RuleRecord r = RuleMapAccess::record<RuleRecord>(map, kSectionRules, s.firstRule);
    std::vector<PatternPart> parts;
    for (uint32_t i = 0; i < r.successorCount; ++i)
        parts.push_back(RuleMapAccess::record<PatternPart>(map, kSectionParts, r.firstSuccessor + i));
    return parts;
}

const char* const kLattice = R"(
1: Axiom ~> P
2: P ~> [RZ(30) T(0.6,0,0) A] [RZ(150) T(0.6,0,0) A] [RZ(-90) T(0.6,0,0) A]
3: A ~> B [ T(0.6, 0, 0) RZ(60) T(0.6, 0, 0) A ]
    [ T(0.6, 0, 0) RZ(-60) T(0.6, 0, 0) A ];
4: B ~> S(1.0, 1.0, 0.6) IC("torus") ;
)";

const char* const kCracks = R"(
angles degrees
start = S(0.5, 0.5, 0.5) F
F = [RS(Rand(-5, 5)) T(Rand(0.4, 0.45), 0, 0) M A]
    [RS(Rand(85, 95)) T(Rand(0.4, 0.45), 0, 0) M A]
    [RS(Rand(175, 185)) T(Rand(0.4, 0.45), 0, 0) M A]
    [RS(Rand(265, 275)) T(Rand(0.4, 0.45), 0, 0) M A];
A = RS(Rand(-5, 5)) T(Rand(0.6, 0.65), 0, 0) M C
C = [RS(Rand(-5, 5)) T(Rand(0.6, 0.65), 0, 0) M A]
    [RS(Rand(-85, -95)) T(Rand(0.4, 0.45), Rand(0.3, 0.35), 0) M A] : 0.2;
C = RS(Rand(-5, 5)) T(Rand(0.6, 0.65), 0, 0) M A : 0.1;
M = [ S(0.1, 0.55, 0.1) RS(90) I("cylinder.obj")]
    [ S(0.1, 0.1, 0.1) T(0, Rand(1, 1.2), 0) I("ico1.obj")]
    [ S(0.1, 0.1, 0.1) T(0, Rand(-1, -1.2), 0) I("ico2.obj")];
)";

}  // namespace

TEST_CASE("a symbol may be called Line, as in grammars of roofs") {
    for (const char* text :
         {"Ivy -> Branch(1) {Line}\nLine -> Marching(0.1, 0, true) {Line, Leaf}\nLeaf -> S(0.1) Shape(\"leaf\")",
          "A -> Line\nLine -> IC(\"star\")"}) {
        const std::string refused = patternRefusal(text);
        CHECK_MESSAGE(refused.empty(), refused);
    }
}

TEST_CASE("the paper's texts compile but for the alphabet") {
    const RuleMap lattice = patternMap(kLattice);
    CHECK(lattice.patterns());
    CHECK(lattice.symbols()[lattice.startSymbol()].name == "Axiom");
    const RuleMap cracks = patternMap(kCracks);
    CHECK(cracks.patterns());
    CHECK(partsOf(cracks, "F").size() == 8);
    CHECK(partsOf(cracks, "M").size() == 3);
}

TEST_CASE("a symbol that only places a piece is looked ahead into, and what stands behind hangs on it") {
    const auto parts = partsOf(patternMap(kLattice), "A");
    REQUIRE(parts.size() == 3);
    CHECK(parts[0].kind == kPartTested);
    CHECK(parts[0].set == 0);
    CHECK(parts[1].kind == kPartSymbol);
    CHECK(parts[1].prereq == 0);
    CHECK(parts[2].prereq == 0);
    // As in Li 2011 §4.4: B stands in front of the piece and is derived in any case, D and E hang on it.
    const auto more = partsOf(patternMap("A -> B IC(\"star\") D E\nB -> T(1) A\nD -> T(1) A\nE -> T(2) A"), "A");
    REQUIRE(more.size() == 4);
    CHECK(more[0].prereq == kNoIndex);
    CHECK(more[2].prereq == 0);
    CHECK(more[3].prereq == 0);
    const auto deep = partsOf(patternMap("A -> B C D\nB -> T(1) A\nC -> F\nF -> IC(\"star\")\nD -> T(1) A"), "A");
    REQUIRE(deep.size() == 3);
    CHECK(deep[1].kind == kPartTested);
    CHECK(deep[2].prereq == 0);
}

TEST_CASE("a Lock is one set of several pieces") {
    const auto parts =
        partsOf(patternMap("Tile -> Lock { Stone | [T(1) IC(\"star\")] | Cap } Tile\nStone -> IC(\"torus\")\n"
                           "Cap -> S(2) I(\"ico1\")"),
                "Tile");
    REQUIRE(parts.size() == 4);
    for (int i : {0, 1, 2}) {
        CHECK(parts[i].set == 0);
        CHECK(parts[i].kind == kPartTested);
    }
    CHECK(parts[3].prereq == 0);
}

TEST_CASE("`else` stands for a piece that can't stand, `omit` lets go on what stands behind it") {
    const auto parts = partsOf(patternMap("A -> IC(\"star\") else { IC(\"torus\") A } IC(\"ico1\") omit A"), "A");
    REQUIRE(parts.size() == 5);
    CHECK(parts[1].prereq == (0 | kIfFallen));
    CHECK(parts[2].prereq == 1);
    CHECK(parts[3].prereq == 0);
    CHECK(parts[4].prereq == 0);
    for (const char* text : {"A -> I(\"star\") else { A }", "A -> else { IC(\"star\") }", "A -> IC(\"star\") T(1) omit",
                             "A -> Lock { IC(\"star\") omit }", "A -> IC(\"star\") omit else { A }",
                             "A -> IC(\"star\") else { A | A }", "A -> IC(\"star\") else A"})
        CHECK(patternRefusal(text).find("behind IC, Lock or a symbol that places one mesh") != std::string::npos);
    CHECK(patternRefusal("V -> Marching(1, 0, true) {V else { V }, S(0.1) Shape(\"bark\")}")
              .find("belongs to patterns") != std::string::npos);
}

TEST_CASE("segments of a line hang on each other, and what stands behind the line on none of them") {
    const auto parts = partsOf(
        patternMap("A -> T(1) Line(merge) { T(1) LineSeg(\"star\", 0.1) Rz(1) T(1) LineSeg(\"star\", 0.1) A } A\n"),
        "A");
    REQUIRE(parts.size() == 4);
    CHECK(parts[0].kind == kPartMergedLine);
    CHECK(parts[0].begin == 1);
    CHECK(parts[1].begin == 2);
    CHECK(parts[1].opCount == 4);
    CHECK(parts[1].prereq == 0);
    CHECK(parts[2].prereq == 1);
    CHECK(parts[3].prereq == kNoIndex);
    CHECK(partsOf(patternMap("A -> Line { T(1) LineSeg(\"star\", 0.1) }"), "A")[0].kind == kPartLine);
    const auto merged = partsOf(patternMap("A -> B A\nB -> IM(\"star\", 0.1, 0.2) else { A }"), "B");
    CHECK(merged[0].kind == kPartMerged);
    CHECK(merged[1].prereq == (0 | kIfFallen));
    CHECK(partsOf(patternMap("A -> B A\nB -> IM(\"star\", 0.1, 0.2)"), "A")[1].prereq == 0);
    const std::pair<const char*, const char*> mistakes[] = {
        {"A -> T(1) LineSeg(\"star\", 0.1)", "between the braces of a Line"},
        {"A -> Line(merge) { LineSeg(\"star\", 0.1) }", "leads along a T"},
        {"A -> Line IC(\"star\")", "Line"},
        {"A -> Line(melt) { T(1) LineSeg(\"star\", 0.1) }", "Line(merge) {successors}"},
        {"A -> Line { Line { T(1) LineSeg(\"star\", 0.1) } }", "Line(merge) {successors}"},
        {"A -> Line { T(1) LineSeg(\"tsar\", 0.1) }", "there is no mesh \"tsar\""},
        {"A -> Line { T(1) LineSeg(\"star\") }", "LineSeg(\"mesh\", width)"},
        {"A -> Line { T(1) LineSeg(\"star\", 0.1) omit A }", "omit behind IC"},
        {"A -> Lock { IM(\"star\", 0.1, 0.2) }", "no place in a Lock"},
        {"A -> IM(\"star\", 0.1)", "IM(\"mesh\", distance, turn)"}};
    for (const auto& [text, message] : mistakes)
        CHECK_MESSAGE(patternRefusal(text).find(message) != std::string::npos, patternRefusal(text));
}

TEST_CASE("fields, their queries and priorities") {
    const RuleMap map = patternMap(R"(
angles degrees
field flow : tensor "Growth"
field lie : vector
field bend : curvature
G : flow.value1 >= 0 and lie.length1 > 0.2 -> Rz(F1.Xangle1) I("star") G priority 2
G : bend.mincurv < 0 -> I("torus"))");
    REQUIRE(map.fields().size() == 3);
    CHECK(map.fields()[0].label == "Growth");
    CHECK(map.fields()[1].symmetry == 1);
    CHECK(map.fields()[2].curvature);
    CHECK(map.ref().queryCount == 4);
    CHECK(partsOf(map, "G")[1].priority == 2);
    const std::vector<uint8_t> bytes = map.save();
    Result<RuleMap> again = RuleMap::load(bytes, "saved");
    REQUIRE_MESSAGE(again, (again ? "" : again.failure().text()));
    CHECK(again.value().growsAs(map));
}

TEST_CASE(
    "what is computed of the same answers of fields asks for them once, and a rule asks for slopes if it reads them") {
    const RuleMap map = patternMap(R"(
field flow : vector jumps
field lie : tensor
A : flow.divergence1 > 0 -> S(2 + flow.curl1, 2 + flow.jacobian1.xy, 2 + flow.vector1.y) I("star") B
A -> Rz(flow.Xangle1) I("torus")
B -> Rz(flow.angleTo(lie)) I("star"))");
    // Of flow: length, angle, its two gradients, two turns; of lie: the angle.
    CHECK(map.ref().queryCount == 7);
    CHECK(map.ref().guide == kGuideJumps);
    CHECK(map.fields()[0].jumps);
    const auto inputsOf = [&](const char* symbol) {
        return RuleMapAccess::record<SymbolRecord>(map, kSectionSymbols, *map.findSymbol(symbol)).inputs;
    };
    CHECK((inputsOf("A") & (kInputFields | kInputSlopes)) == (kInputFields | kInputSlopes));
    const PatternPart star = partsOf(map, "B")[0];
    const PatternOp turn = RuleMapAccess::record<PatternOp>(map, kSectionOps, star.firstOp);
    CHECK((turn.inputs & (kInputFields | kInputSlopes)) == kInputFields);
    const Result<RuleMap> again = RuleMap::load(map.save(), "saved");
    REQUIRE_MESSAGE(again, (again ? "" : again.failure().text()));
    CHECK(again.value().growsAs(map));
    CHECK_FALSE(patternMap("field flow : vector\nA -> T(1) I(\"star\")")
                    .growsAs(patternMap("field flow : vector jumps\nA -> T(1) I(\"star\")")));

    CHECK(patternRefusal("field f : tensor\nA -> S(f.gradient.x) I(\"star\")").find("did you mean 'gradient1.x'") !=
          std::string::npos);
    CHECK(patternRefusal("field f : tensor\nA -> S(f.angleTo) I(\"star\")").find("two fields are wanted") !=
          std::string::npos);
    CHECK(patternRefusal("field f : tensor\nA -> S(f.angleTo(g)) I(\"star\")").find("a field's name is wanted") !=
          std::string::npos);
    CHECK(patternRefusal("field f : tensor\nA -> S(f.turnTo(f)) I(\"star\")").find("not 'turnTo'") !=
          std::string::npos);
    CHECK(patternRefusal("field f : tensor\nfield g : vector jumps\nA -> I(\"star\")").find("only that one can say") !=
          std::string::npos);
    std::string many, sum = "0";
    for (const char* name : {"f", "g", "h", "i"}) {
        many += std::string("field ") + name + " : vector\n";
        sum += std::string(" + ") + name + ".divergence1";
    }
    const std::string refused = patternRefusal(many + "A -> S(2 + " + sum + ") I(\"star\")");
    CHECK(refused.find("more than 20 different things") != std::string::npos);
    CHECK(refused.find("more than 20", refused.find("more than 20") + 1) == std::string::npos);
}

TEST_CASE("mistakes in patterns are told with their place") {
    CHECK(patternRefusal("A -> IC(\"tours\") A")
              .find("grammar:1:9: A: there is no mesh \"tours\" (did you mean 'torus'?)") != std::string::npos);
    CHECK(patternRefusal("A -> Lock { B | IC(\"star\") }\nB -> T(1) IC(\"star\") B")
              .find("without condition or choice") != std::string::npos);
    CHECK(patternRefusal("A -> Extrude(1) {I(\"star\")}").size() > 0);
    CHECK(patternRefusal("field f : tensor\nA : f.valeu1 > 0 -> I(\"star\")").find("did you mean 'value1'") !=
          std::string::npos);
    CHECK(patternRefusal("field f : spinor\nA -> I(\"star\")").find("not 'spinor'") != std::string::npos);
    CHECK(patternRefusal("A -> [ I(\"star\")").find("'[' without ']'") != std::string::npos);
    CHECK(patternRefusal("A -> T(1) Rx(2) A").find("no rule places a mesh") != std::string::npos);
    CHECK(patternRefusal("A -> I(\"star\") A priority 9").find("from 0 to 7") != std::string::npos);
    CHECK(patternRefusal("V -> Marching(1, 0, true) {V, Rx(1) S(0.1) Shape(\"bark\")}").find("belongs to patterns") !=
          std::string::npos);
}

TEST_CASE("the shipped grammars of patterns, and the manual's, compile without warnings") {
    CompileOptions o;
    for (const char* piece :
         {"none", "ball",  "blossom", "box",   "cobble", "cylinder", "ellipse", "hexagon",  "ico1", "ico2", "leaf",
          "link", "torus", "rod",     "scale", "star",   "stud",     "tile",    "triangle", "tube", "band", "edge"})
        o.pieces.push_back({piece, false});
    int shipped = 0;
    for (const auto& entry : std::filesystem::directory_iterator("content/grammars")) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with("pattern_")) continue;
        const Result<RuleMap> map = compileGrammarFile(entry.path(), o);
        REQUIRE_MESSAGE(map, (map ? "" : map.failure().text()));
        CHECK(toString(map.value().warnings()) == "");
        CHECK(map.value().patterns());
        CHECK(map.value().findParam("scale"));
        for (const ParamInfo& p : map.value().params()) CHECK(p.label != p.name);
        ++shipped;
    }
    CHECK(shipped >= 17);
    std::ifstream file("docs/patterns.md");
    const std::string text(std::istreambuf_iterator<char>(file), {});
    const std::string open = "```grammar\n";
    const size_t begin = text.find(open) + open.size();
    const Result<RuleMap> example = compileGrammar(text.substr(begin, text.find("\n```", begin) - begin), o);
    REQUIRE_MESSAGE(example, (example ? "" : example.failure().text()));
    CHECK(toString(example.value().warnings()) == "");
}
