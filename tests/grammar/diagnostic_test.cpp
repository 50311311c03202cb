// What wrong grammars are answered with: place, rule, message and hint; several at once; limits; no bytes that
// crash or hang the compiler.
#include <algorithm>
#include <ctime>

#include "tests/grammar/support.hpp"

using namespace grammar_test;

namespace {

const std::string kGood =
    "param speed = 0.1 [0 .. 1] \"m\" \"Speed\"\n"
    "context mask = 1\n"
    "A(n) : n < 3 -> Marching(speed, rand(-1, 1), mask(texCoord)) {B(n + 1), Leaves} : 0.5;\n"
    "A(n) -> NULL\n"
    "B(n) -> Branch(2) {A(n), A(0)}\n"
    "Leaves -> [S(0.01) Shape(\"bark\", C1)] Repeat(3) {S(0.1) T(rand()) R(angleTo(down)) Shape(\"leaf\")}\n";

struct Case {
    const char* text;
    const char* expected;  // a part of the failure's text
};

std::string repeated(const std::string& s, int n) {
    std::string all;
    for (int i = 0; i < n; ++i) all += s;
    return all;
}

}  // namespace

TEST_CASE("mistakes are named with place, rule and hint") {
    const Case cases[] = {
        {"", "grammar:1:1: the grammar has no rules"},
        {"// nothing\n", "the grammar has no rules"},
        {"A -> Marching(0.1, 0, true) {Bb}\nB -> NULL", "grammar:1:30: A: there is no rule for 'Bb'"},
        {"A -> Marching(0.1, 0, true) {Stemm}\nStem -> A", "did you mean 'Stem'?"},
        {"A -> Marching(0.1, 0, true) {A, Leafs}\nLeaves -> S(1) Shape(\"leaf\")", "did you mean 'Leaves'?"},
        {"A -> Marchin(0.1, 0, true) {A}", "did you mean 'Marching'?"},
        {"A(n) -> Marching(0.1, 0, m < 1) {A(n)}", "grammar:1:26: A: 'm' is not known"},
        {"param wander = 1\nA -> Marching(0.1, wandr, true) {A}", "did you mean 'wander'?"},
        {"A -> Marching(0.1, rnd(0, 1), true) {A}",
         "there is no function or context layer 'rnd' (did you mean 'rand'?)"},
        {"A -> Marching(0.1, rand(1), true) {A}", "rand takes no argument or two"},
        {"A -> Marching(0.1, clamp(1), true) {A}", "clamp takes 3 arguments, not 1: clamp(x, least, greatest)"},
        {"A(n) -> Marching(0.1, 0, true) {A}", "A takes 1 argument, not 0"},
        {"A(n) -> Marching(0.1, 0, true) {A(n)}\nA -> NULL",
         "an earlier rule of this name takes 1 arguments, this one 0"},
        {"A(a, b, c, d, e) -> Marching(0.1, 0, true) {A(1, 2, 3, 4, 5)}", "too many arguments: 4 are the most"},
        {"A(a, a) -> Marching(0.1, 0, true) {A(1, 2)}", "two arguments are named 'a'"},
        {"A -> Marching(0, true) {A}", "Marching has no length"},
        {"A -> Marching(0.1) {A}", "write Marching(length, angle, condition)"},
        {"A -> Marching(-1, 0, true) {A}", "the marching length must be positive"},
        {"A -> Marching(0.1, 0, true) {A A}", "Marching goes on with one successor"},
        {"A -> B\nB -> A\nC -> Marching(0.1, 0, true) {C}", "endless recursion: A -> B -> A never marches"},
        {"A -> Branch(2) {A, M}\nM -> Marching(0.1, 0, true) {A}", "endless recursion: A -> A never marches"},
        {"A -> Branch(3) {M, M}\nM -> Marching(0.1, 0, true) {A}", "Branch's number must be that of its successors, 2"},
        {"A -> S(1) Shape(\"leaf\")", "no rule marches, so nothing can grow"},
        {"A -> Marching(0.1, 0, true) {L}\nL -> S(1) Shape(\"leaf\")", "put it into Marching's second successor"},
        {"A -> Marching(0.1, 0, true) {A, A}", "an extruded successor draws on its span"},
        {"A -> Marching(0.1, 0, true) {A, S(1) Shape(\"lief\")}", "there is no mesh \"lief\" (did you mean 'leaf'?)"},
        {"A -> Marching(0.1, 0, true) {A, Shape(\"leaf\")}", "the shape has no size"},
        {"A -> Marching(0.1, 0, true) {A, S(1) Shape(\"leaf\", C2)}", "a shape is discontinuous, C0 or C1"},
        {"A -> Marching(0.1, 0, true) {A, Repeat(2) {S(1) Shape(\"bark\")}}", "a span has one bark"},
        {"A -> Marching(0.1, 0, true) {A, ] S(1)}", "']' without '['"},
        {"A -> Marching(0.1, 0, true) {A, [ S(1)}", "'[' without ']'"},
        {"A -> Marching(0.1, 0, true) {A, L}\nL -> L", "endless recursion"},
        {"A -> Marching(0.1, toTip, true) {A}", "'toTip' is known only once the branch has grown"},
        {"A -> Marching(0.1, 0, true) {A, S(index) Shape(\"leaf\")}", "'index' has a meaning inside Repeat only"},
        {"A(n) -> Marching(0.1, 0, true) {A(n + 1), S(n) Shape(\"leaf\")}",
         "only arguments that the branch hands on unchanged"},
        {"context mask\nA -> Marching(0.1, 0, mask) {A}", "write mask(texCoord)"},
        {"A -> Marching(0.1, 0, context.mask(texCoord)) {A}", "no context layer 'mask' is declared"},
        {"context tint = #ff0000\nA -> Marching(0.1, 0, tint(texCoord)) {A}",
         "'tint' is a layer of colours: write Colour(tint"},
        {"context tint = #ff0000\nA -> Marching(0.1, 0, true) {A, Colour(tint) S(1) Shape(\"leaf\")}",
         "Colour takes a colour"},
        {"context tint = #ff0000\nA -> Marching(0.1, 0, tint.x(texCoord)) {A}", "'tint.x'"},
        {"context a context b context c context d context e context f context g context h context i context j context "
         "k "
         "context l context m context n context tint = #ff0000\nB -> Marching(0.1, 0, true) {B}",
         "too many context layers: 16 are the most, a colour counting as three"},
        {"param rand = 1\nA -> Marching(0.1, 0, true) {A}", "'rand' is the name of a function"},
        {"param p = 5 [0 .. 1]\nA -> Marching(p, 0, true) {A}", "the default lies outside the range"},
        {"param p = 1 [1 .. 0]\nA -> Marching(p, 0, true) {A}", "the range is empty"},
        {"param p = 1\nparam p = 2\nA -> Marching(p, 0, true) {A}", "'p' is declared twice"},
        {"let a = b let b = a\nA -> Marching(a, 0, true) {A}", "is defined by itself"},
        {"A -> Marching(1e12, 0, true) {A}", "the number 1e12 is too large"},
        {"A -> Marching(1e999999, 0, true) {A}", "is too large"},
        {"A -> Marching(0.1, nan, true) {A}", "'nan' is not known"},
        {"A -> Marching(0.1, 1 / 0, true) {A}", "division by zero"},
        {"A -> Marching(0.1, 2n, true) {A}", "a letter directly behind a number"},
        {"A -> M : arc\nA -> M : 1\nM -> Marching(0.1, 0, true) {A}",
         "a probability may use numbers and parameters only"},
        {"A -> M : -1\nM -> Marching(0.1, 0, true) {A}", "a probability can't be negative"},
        {"A -> Marching(0.1, 0, true) {A} 5", "expected ';' or the next rule, found '5'"},
        {"A -> Marching(0.1, (1 + 2, true) {A}", "expected ')'"},
        {"A -> ", "expected a successor behind ->"},
        {"A -> Marching(0.1, 0, true) {A, \"leaf\"}", "found the text \"leaf\""},
        {"include \"elsewhere.grammar\"\nA -> Marching(0.1, 0, true) {A}",
         "grammar:1:9: can't read the included file \"elsewhere.grammar\": there is no folder"},
        {"A -> Marching(0.1, 0, true) {A} \xFF", "byte 0xFF isn't UTF-8 text"},
        {"A -> Marching(0.1, 0, true) {A} \xC3\xA4", "has no meaning here"},
        {"/* A -> A", "this comment is never closed"},
        {"A -> Marching(0.1, 0, true) {A, S(1) Shape(\"leaf)}", "this text is not closed before the line's end"},
        {"A -> Split(2) {A}", "1:6: A: write Split(X or Y, size"},
        {"width -0.1\nA -> Marching(0.1, 0, true) {A}", "grammar:1:7: width: the width can't be negative"},
        {"width sqrt(0) - 1e-3\nA -> Marching(0.1, 0, true) {A}", "the width can't be negative"},
        {"width nan\nA -> Marching(0.1, 0, true) {A}", "grammar:1:7: width: 'nan' is not known"},
        {"width 1 / 0\nA -> Marching(0.1, 0, true) {A}", "division by zero"},
        {"width rand()\nA -> Marching(0.1, 0, true) {A}", "the width may use numbers and parameters only"},
        {"width 0.1 * arc\nA -> Marching(0.1, 0, true) {A}", "grammar:1:11: width: the width may use numbers"},
        {"let l = height\nwidth l\nA -> Marching(0.1, 0, true) {A}", "the width may use numbers"},
        {"width n\nA(n) -> Marching(0.1, 0, true) {A(n)}", "width: 'n' is not known"},
        {"width 0.1\nA -> Marching(0.1, 0, true) {A}\nwidth 0.2", "grammar:3:1: width: the width is given twice"},
        {"width = 0.1\nA -> Marching(0.1, 0, true) {A}", "without '='"},
        {"A -> Marching(0.1, 0, true) {A}\nwidth", "width: expected a value, found the end of the text"},
    };
    for (const Case& c : cases) {
        const std::string source = c.text;
        INFO(source);
        std::string text = failureText(source);
        INFO(text);
        CHECK(text.find(c.expected) != std::string::npos);
    }
}

TEST_CASE("several mistakes are reported in one go, those behind a broken statement too") {
    std::string text = failureText(
        "param p = \nA -> Marching(0.1, q, true) {A}\nB -> Marching(0.1 {B}\nC -> Marching(0.1, r, true) {D}\n");
    INFO(text);
    for (const char* part : {"p: expected a value", "2:20: A: 'q' is not known", "3:19: B: expected ')'",
                             "4:20: C: 'r' is not known", "4:30: C: there is no rule for 'D'"})
        CHECK(text.find(part) != std::string::npos);
}

TEST_CASE("a value may go on in the next line, whatever it begins with") {
    for (const char* text : {"let l = 0.1 > 0 ?\nq : 2\nlet q = 1\nA -> Marching(l, 0, true) {A}\n",
                             "let k = 1\nlet l = 2 *\nk * 2\nA -> Marching(l, 0, true) {A}\n"}) {
        const Result<RuleMap> map = compileGrammar(text);
        const std::string told = map ? "" : map.failure().text();
        CHECK(told == "");
    }
}

TEST_CASE("what is missing at a line's end is told there, and nobody who uses that statement is blamed") {
    const auto told = [](const char* text) {
        const Result<RuleMap> map = compileGrammar(text);
        REQUIRE(!map);
        return map.failure().text();
    };
    CHECK(told("A -> Marching(0.1, 0, true) {A, B}\nB -> S(0.1) Shape(\"bark\", C1 // with a remark\nC -> B\n") ==
          "grammar:2:29: B: expected ')' behind the arguments of Shape, found the end of the line");
    CHECK(told("A -> Marching(0.1, 0, true) {A, B\nB -> Shape(\"bark\", C1)\n") ==
          "grammar:1:34: A: expected '}' behind the successors of Marching, found the end of the line");
    for (const char* next :
         {"A -> Marching(p, 0, true) {A}\n", "A : p > 0 -> Marching(p, 0, true) {A}\n",
          "param q = 1\nA -> Marching(p * q, 0, true) {A}\n", "let q = 1\nA -> Marching(p * q, 0, true) {A}\n"})
        CHECK(told(("param p = 2 *\n" + std::string(next)).c_str()) ==
              "grammar:1:14: p: expected a value, found the end of the line");
    CHECK(told("A -> Marching(0.1, 0, true) {A, B\nB : arc > 1 -> NULL\nB -> Branch(2) {A, A}\n") ==
          "grammar:1:34: A: expected '}' behind the successors of Marching, found the end of the line");
    CHECK(told("context mask = \nA -> Marching(0.1, 0, mask(texCoord) > 0.5) {A}\n") ==
          "grammar:1:15: mask: expected a value, found the end of the line");
    CHECK(told("param hue = #12\nA -> Marching(0.1, 0, true) {A, B}\nB -> S(0.1) Colour(hue) Shape(\"bark\", C1)\n")
              .find("Colour takes") == std::string::npos);
    CHECK(told("let l = (1, 2\nA -> Marching(l.x, 0, true) {A}\n").find("is not known") == std::string::npos);
    CHECK(told("A -> Marching(0.1, 0, true) {A}\nB -> (") ==
          "grammar:2:6: B: expected a successor behind -> (NULL stands for none), found '('");
}

TEST_CASE("a mistake in what several rules use is told once") {
    const std::string text = failureText(
        "A -> Branch(2) {B, C}\nB -> Marching(0.1, 0, true) {B, L}\nC -> Marching(0.1, 0, true) {C, L}\n"
        "L -> S(m) Shape(\"leaf\")\n");
    INFO(text);
    const size_t first = text.find("'m' is not known");
    REQUIRE(first != std::string::npos);
    CHECK(text.find("'m' is not known", first + 1) == std::string::npos);
}

TEST_CASE("a mistake is told where it is, not where it is used") {
    const auto told = [](const char* text) {
        Result<RuleMap> map = compileGrammar(text);
        REQUIRE(!map);
        return map.failure().text();
    };
    // By a let: once, under the let's name, whatever stands in need of a number.
    CHECK(told("let l = 2 * m\nA -> Marching(l, 0, true) {B} : l\nA -> Marching(l, 1 / l, l) {B} : l\n"
               "B -> Branch(l) {A, A}\nwidth l") == "grammar:1:13: l: 'm' is not known");
    CHECK(told("let k = m\nlet l = k\nA -> Marching(0.1, pow(2, l) + angleTo(l, 0, 1) + facing(0, l, 0), true) {A}") ==
          "grammar:1:9: k: 'm' is not known");
    CHECK(told("param p = m [0 .. 1]\nA -> Marching(0.1, 0, true) {A}") == "grammar:1:11: p: 'm' is not known");
    // An argument of the rule isn't the let's, before it and after it.
    CHECK(told("let l = n\nA(n) -> Marching(0.1, l, n < 3) {A(n + 1)}") == "grammar:1:9: l: 'n' is not known");
}

TEST_CASE("what is never used is warned of") {
    RuleMap map = compiled(
        "param p = 1\ncontext c\nlet l = 2\nA -> Marching(0.1, 0, true) {A}\nA -> NULL\nL -> S(1) Shape(\"leaf\")\nM : "
        "arc > 2 -> NULL\nM -> A");
    std::string text = toString(map.warnings());
    INFO(text);
    for (const char* part :
         {"parameter 'p' is never used", "layer 'c' is never used", "value 'l' is never used", "nothing uses 'L'"})
        CHECK(text.find(part) != std::string::npos);
    CHECK(text.find("'M'") == std::string::npos);
}

TEST_CASE("rules that plants never come to, since another one stands first, are warned of") {
    const std::string ivy = "Ivy -> Branch(2) {Stem, Stem}\nStem -> Marching(0.1, 0, true) {Stem}\n";
    CHECK(compiled(ivy).warnings().empty());
    const std::string text = toString(compiled("Other -> Marching(0.1, 0, true) {Other}\n" + ivy).warnings());
    CHECK_MESSAGE(text.find("grammar:2:1: warning: Ivy: plants begin with 'Other'") != std::string::npos, text);
    CHECK_MESSAGE(text.find("Stem:") == std::string::npos, text);                        // it belongs to Ivy
    CHECK(compiled(ivy + "Twig -> Marching(0.1, 0, true) {Ivy}\n").warnings().empty());  // another way to begin
}

TEST_CASE("warnings hide no mistake, however many there are") {
    std::string unused, mistakes;
    for (int i = 0; i < 60; ++i) {
        unused += "L" + std::to_string(i) + " -> S(1) Shape(\"leaf\")\n";
        mistakes += "A -> Marching(wrong" + std::to_string(i) + ", 0, true) {A}\n";
    }
    const std::string march = "A -> Marching(0.1, 0, true) {A}\n";
    const auto lines = [](const std::string& text) { return std::count(text.begin(), text.end(), '\n') + 1; };
    CHECK(compiled(march + unused).warnings().size() == 40);
    CHECK(failureText(unused + "A -> Marching(wrong, 0, true) {A}\n").find("'wrong' is not known") !=
          std::string::npos);
    CHECK(lines(failureText(mistakes)) == 40);
    CHECK(lines(failureText(unused + mistakes)) == 80);
}

TEST_CASE("a mark at the text's begin, as some editors write it, is no column") {
    const std::string mark = "\xEF\xBB\xBF";
    compiled(mark + "A -> B\n  C\nB -> Marching(0.1, 0, true) {B}\nC -> Marching(0.1, 0, true) {C}\n");
    CHECK(failureText(mark + "A -> Marching(0.1, 0, true) {Bb}\n").find("grammar:1:30: A: ") == 0);
}

TEST_CASE("numbers that are too small for a float are 0, however they are written") {
    const auto marching = [](const std::string& angle) {
        return failureText("A -> Marching(0.1, " + angle + ", true) {A}");
    };
    const std::string zeros = repeated("0", 400), nines = repeated("9", 30);
    for (const std::string& tiny :
         {std::string("1e-400"), std::string("1E-400"), "0." + zeros + "1", "0." + zeros + "1e50", "1E-" + nines})
        CHECK(marching(tiny) == "compiled");
    for (const std::string& large : {std::string("1e400"), std::string("1E+400"), "1" + zeros, "1" + zeros + "e-50",
                                     "0." + zeros + "1e900", "1E" + nines})
        CHECK(marching(large).find("is too large") != std::string::npos);
    CHECK(marching("0e999999") == "compiled");
}

TEST_CASE("; may be left out, → and π may be written, rules may span lines") {
    RuleMap map = compiled(
        "A(n) : n < 2 and\n   n > -1\n  → Marching(0.1,\n  π / 2, true)\n  {A(n),\n   NULL} : 0.5 A(n) -> NULL; B -> "
        "A(1)\nC -> A(2)");
    CHECK(map.symbols().size() == 3);
    CHECK(ruleOf(map, "A").angle.immediate == doctest::Approx(kPi / 2));
}

TEST_CASE("limits are reported, not met") {
    const std::string march = "A -> Marching(0.1, 0, true) {A}\n";
    auto expect = [](const std::string& text, const char* part) {
        const std::clock_t begin = std::clock();
        std::string failure = failureText(text);
        const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
        INFO(failure);
        CHECK(failure.find(part) != std::string::npos);
        CHECK(seconds < 5.0);
    };
    expect("A -> Marching(0.1, " + repeated("(", 5000) + "1" + repeated(")", 5000) + ", true) {A}",
           "nested too deeply");
    expect("A -> Marching(0.1, " + repeated("-", 5000) + "1, true) {A}", "nested too deeply");
    expect("A -> Marching(0.1, 1" + repeated(" + arc", 5000) + ", true) {A}", "nested too deeply");
    expect("A -> " + repeated("Branch {", 5000) + "A", "nested too deeply");
    std::string deep;
    for (int i = 0; i < 40; ++i) deep += "B" + std::to_string(i) + " -> B" + std::to_string(i + 1) + "\n";
    expect(march + deep + "B40 -> A\n", "too deep nesting");
    std::string lets = "let l0 = arc + depth\n";
    for (int i = 1; i < 60; ++i)
        lets += "let l" + std::to_string(i) + " = l" + std::to_string(i - 1) + " * l" + std::to_string(i - 1) + "\n";
    expect(lets + "A -> Marching(0.1, l59, true) {A}", "unfolds into too much");
    lets = "let l0 = arc\n";
    for (int i = 1; i < 30000; ++i) lets += "let l" + std::to_string(i) + " = l" + std::to_string(i - 1) + "+1\n";
    expect(lets + "A -> Marching(0.1, l29999, true) {A}", "more than 64 lets");
    lets = "let l0 = arc\n";
    for (int i = 1; i < 60; ++i)
        lets += "let l" + std::to_string(i) + " = " + repeated("sin(", 30) + "l" + std::to_string(i - 1) +
                repeated(")", 30) + "\n";
    expect(lets + "A -> Marching(0.1, l59, true) {A}", "more than 256 operations in a row");
    // Commands that add up, of plants and of roofs.
    for (const char* command : {"R(arc) ", "R(0, arc) ", "T(0, arc) "}) {
        std::string turns = "A -> Marching(0.1, 0, true) {A, D0}\n";
        for (int i = 0; i < 15; ++i)
            turns += "D" + std::to_string(i) + " -> " + repeated(command, 190) + "D" + std::to_string(i + 1) + "\n";
        expect(turns + "D15 -> S(1) Shape(\"leaf\")", "more than 256 operations in a row");
    }
    std::string sines = "let l0 = sizeX\n";
    for (int i = 1; i < 6; ++i)
        sines += "let l" + std::to_string(i) + " = " + repeated("sin(", 30) + "l" + std::to_string(i - 1) +
                 repeated(")", 30) + "\n";
    const std::string house = "House -> Extrude(1) {B, NULL}\nB -> T(l5) ";
    for (const char* command : {"T(sizeX) ", "T(sizeX, 0, sizeY) "})
        expect(sines + house + repeated(command, 190) + "Shape(\"leaf\")", "more than 256 operations in a row");
    expect(sines + house + repeated("R(sizeX) ", 190) + "Shape(\"leaf\")", "compiled");
    std::string uniform = "0";
    for (int i = 0; i < 20; ++i)
        uniform = "sin(p + " + std::to_string(i) + ") * (" + uniform + " + cos(p * " + std::to_string(i) + "))";
    expect("param p = 1\nA -> Marching(0.1, " + uniform + ", true) {A}", "compiled");
    std::string calls;
    for (int i = 0; i < 15; ++i)
        calls += "D" + std::to_string(i) + " -> " + repeated("D" + std::to_string(i + 1) + " ", 9) + "\n";
    expect("A -> Marching(0.1, 0, true) {A, D0}\n" + calls + "D15 -> NULL", "unfolds into too much");
    expect("A -> Marching(0.1, " + repeated("rand() + ", 12) + "1, true) {A}", "more than 8 random numbers");
    std::string wide = "0";
    for (int i = 0; i < 20; ++i)
        wide = "sin(arc + " + std::to_string(i) + ") * (" + wide + " + cos(depth * " + std::to_string(i) + "))";
    expect("A -> Marching(0.1, " + wide + ", true) {A}", "compiled");
    std::string params;
    for (int i = 0; i < 33; ++i) params += "param p" + std::to_string(i) + " = 1\n";
    expect(params + march, "too many parameters");
    expect(march + repeated("// " + repeated("x", 1000) + "\n", 1100), "longer than 1 MiB");
    std::string many;
    for (int i = 0; i < 1100; ++i) many += "R" + std::to_string(i) + " -> Marching(0.1, 0, true) {NULL}\n";
    expect(many, "more than 1,000 rules");
    expect(repeated("%", 100000), "expected a rule or a declaration");
    const std::string roof = "House -> Join(1, v, roofPos2) {A, A}\nA -> NULL\n";
    std::string vectors = "let v0 = currentPos0()\n";
    for (int i = 1; i < 49000; ++i) vectors += "let v" + std::to_string(i) + " = v" + std::to_string(i - 1) + "\n";
    expect(vectors + "let v = v48999\n" + roof, "more than 64 lets");
    vectors = "let v0 = currentPos0()\n";
    for (int i = 1; i < 60; ++i)
        vectors += "let v" + std::to_string(i) + " = " + repeated("unit(", 60) + "v" + std::to_string(i - 1) +
                   repeated(")", 60) + "\n";
    expect(vectors + "let v = v59\n" + roof, "more than 256 operations in a row");
    std::string choices = "A -> Marching(0.1, 0, true) {A, " + repeated("D(rand()) ", 100) + "}\nE -> NULL\n";
    for (int i = 0; i < 900; ++i) choices += "D(n) : arc * n > " + std::to_string(i) + " -> E\n";
    expect(choices, "unfolds into too much");
    std::string shapes = repeated("S(1) Shape(\"leaf\") ", 40);
    expect("A -> Marching(0.1, 0, true) {A, " + shapes + "}", "more than 32 shapes");
}

TEST_CASE("5,000 damaged grammars: a map or a message, quickly") {
    REQUIRE(compileGrammar(kGood));
    std::mt19937 random(7);
    std::string free = contentsOf("content/grammars/ivy_free.grammar");
    int compiledCount = 0;
    const std::clock_t begin = std::clock();
    for (int i = 0; i < 5000; ++i) {
        std::string text = i % 10 == 0 ? free : kGood;
        int flips = 1 + static_cast<int>(random() % 4);
        for (int k = 0; k < flips; ++k) {
            size_t at = random() % text.size();
            switch (random() % 4) {
                case 0:
                    text[at] = static_cast<char>(text[at] ^ (1 << (random() % 8)));
                    break;
                case 1:
                    text[at] = static_cast<char>(random());
                    break;
                case 2:
                    text.erase(at, random() % 5);
                    break;
                default:
                    text.insert(at, text.substr(random() % text.size(), random() % 12));
                    break;
            }
        }
        Result<RuleMap> map = compileGrammar(text);
        compiledCount += map ? 1 : 0;
        if (!map) CHECK_FALSE(map.failure().text().empty());
    }
    const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
    MESSAGE(compiledCount << " of 5000 still compile; " << seconds << " s of CPU time");
    CHECK(compiledCount > 100);
    CHECK(compiledCount < 4500);
    CHECK(seconds < 60.0);
}
