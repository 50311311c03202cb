// Rule maps: continuations, arguments, choices, random numbers, extrude programs, parameters.
#include <cmath>
#include <set>

#include "shaders/shared/expand_scope.h"
#include "tests/grammar/support.hpp"

using namespace grammar_test;

TEST_CASE("the ivy of Buron 2015 §8 runs as printed, its continuations marked") {
    Result<RuleMap> map = compileGrammarFile("content/grammars/ivy_paper.grammar");
    if (!map) FAIL(map.failure().text());
    CHECK(map->warnings().empty());
    CHECK(map->symbols()[map->startSymbol()].name == "IvyMainBranch");

    RuleRecord main = ruleOf(*map, "IvyMainBranch");
    CHECK(main.kind == kRuleMarch);
    CHECK(main.distance.immediate == 0.05f);  // the parameter `length`
    CHECK(main.angle.immediate == 0.0f);
    CHECK(main.arriveLayers == 1);
    CHECK(main.extrude != 0);
    SuccessorRecord top = successorOf(*map, main, 0);
    CHECK(top.symbol == *map->findSymbol("IvyBranching"));
    CHECK(top.flags == kSuccessorContinues);

    RuleRecord branching = ruleOf(*map, "IvyBranching");
    CHECK(branching.kind == kRuleList);
    REQUIRE(branching.successorCount == 2);
    CHECK(successorOf(*map, branching, 0).symbol == *map->findSymbol("IvySecBranch"));
    CHECK(successorOf(*map, branching, 0).flags == 0);
    CHECK(successorOf(*map, branching, 1).symbol == *map->findSymbol("IvyMainBranch"));
    CHECK(successorOf(*map, branching, 1).flags == kSuccessorContinues);

    RuleRecord side = ruleOf(*map, "IvySecBranch");
    CHECK(successorOf(*map, side, 0).flags == kSuccessorContinues);

    // Its arithmetic: n + 1, rand(0, maxBranches), rand(-1, 1) * pi / 2, n < k.
    RuleMapRef ref = map->ref();
    Machine machine = machineFor({7});
    startRule(*map, branching, machine, 42);
    for (uint32_t i = 0; i < 2; ++i) {
        SuccessorRecord s = successorOf(*map, branching, i);
        runCode(MACHINE ref.code, s.code);
        if (i == 0) {
            CHECK(valueOf(MACHINE s.args[0]) == 0.0f);
            CHECK(valueOf(MACHINE s.args[1]) >= 0.0f);
            CHECK(valueOf(MACHINE s.args[1]) <= 12.0f);
        } else {
            CHECK(valueOf(MACHINE s.args[0]) == 8.0f);
        }
    }
    std::set<float> angles;
    for (uint64_t key = 1; key <= 200; ++key) {
        machine = machineFor({3, 3.5f});
        startRule(*map, side, machine, key);
        float angle = valueOf(MACHINE side.angle);
        CHECK(std::fabs(angle) <= kPi / 2 + 1e-6f);
        angles.insert(angle);
        runCode(MACHINE ref.code, side.arrive);
        CHECK(holds(valueOf(MACHINE side.condition)));
    }
    CHECK(angles.size() > 190);
    machine = machineFor({4, 3.5f});
    runCode(MACHINE ref.code, side.arrive);
    CHECK_FALSE(holds(valueOf(MACHINE side.condition)));
}

TEST_CASE("the continuation is the successor of the same cycle, else the first that grows") {
    RuleMap map = compiled(
        "Seed -> Branch(3) {Twig, Stem, Stem}\n"
        "Stem : arc > 2 -> Twig\n"
        "Stem -> Marching(0.1, 0, true) {Fork}\n"
        "Fork -> Branch(3) {Twig, Twig, Stem}\n"
        "Twig -> Marching(0.1, 0, arc < 1) {Twig}\n");
    auto flags = [&](const char* symbol, uint32_t rule) {
        std::string all;
        RuleRecord r = ruleOf(map, symbol, rule);
        for (uint32_t i = 0; i < r.successorCount; ++i) all += successorOf(map, r, i).flags == 1 ? 'c' : '-';
        return all;
    };
    CHECK(flags("Seed", 0) == "c--");
    CHECK(flags("Stem", 0) == "c");
    CHECK(flags("Stem", 1) == "c");
    CHECK(flags("Fork", 0) == "--c");
    CHECK(flags("Twig", 0) == "c");
    CHECK(successorOf(map, ruleOf(map, "Fork"), 1).ordinal == 1);
    CHECK(map.symbols()[map.startSymbol()].name == "Seed");
}

TEST_CASE("rules are chosen by the first condition that holds, then by probability") {
    RuleMap map = compiled(
        "param weight = 1 [0 .. 10]\n"
        "A(n) : n > 10 -> NULL\n"
        "A(n) : n > 5 -> M(n) : 2\n"
        "A(n) : n > 5 -> NULL : weight\n"
        "A(n) : n > 5 -> M(n) : 5\n"
        "A(n) : n < 0 -> M(n)\n"
        "M(n) -> Marching(0.1, 0, true) {A(n)}\n");
    auto share = [&](uint32_t rule) {
        int hits = 0;
        for (uint64_t key = 0; key < 20000; ++key) {
            Machine machine = machineFor({6});
            hits += chosenRule(map, "A", machine, mix64(key)) == static_cast<int>(rule) ? 1 : 0;
        }
        return hits / 20000.0;
    };
    Machine machine = machineFor({11});
    CHECK(chosenRule(map, "A", machine, 5) == 0);
    machine = machineFor({-1});
    CHECK(chosenRule(map, "A", machine, 5) == 4);
    machine = machineFor({2});
    CHECK(chosenRule(map, "A", machine, 5) == -1);
    CHECK(std::fabs(share(1) - 0.25) < 0.015);  // five standard deviations
    CHECK(std::fabs(share(2) - 0.125) < 0.012);
    CHECK(std::fabs(share(3) - 0.625) < 0.018);
    float none = 0;
    map.setParam(0, {&none, 1});
    CHECK(share(2) == 0.0);
    CHECK(std::fabs(share(1) - 2.0 / 7) < 0.016);
    CHECK(ruleOf(map, "A", 0).kind == kRuleNull);
}

TEST_CASE("a probability's thresholds are whole multiples of 2^-24") {
    RuleMap map = compiled("A -> M : 1\nA -> NULL : 2\nM -> Marching(0.1, 0, true) {A}");
    RuleMapRef ref = map.ref();
    SymbolRecord s = ref.symbols.v[0];
    bool found = false;
    for (uint32_t i = 0; i < s.select.count; ++i) {
        float threshold = ref.code.v[s.select.first + i].immediate;
        found = found || std::fabs(threshold - 1.0f / 3) < 1e-6f;
        CHECK(threshold * 16777216.0f == std::floor(threshold * 16777216.0f));
    }
    CHECK(found);
}

TEST_CASE("an inserted rule changes no other rule's random numbers") {
    std::string rest =
        "B -> Marching(0.1, rand(-1, 1) + rand(), true) {B, C}\nC -> S(rand(0.1, 0.2)) Shape(\"bark\")\n";
    RuleMap before = compiled("A -> Marching(0.1, rand(), true) {B}\n" + rest);
    RuleMap after =
        compiled("A -> Marching(0.1, rand(), true) {New}\nNew -> Marching(0.2, rand() + rand(), true) {B}\n" + rest);
    for (uint64_t key = 1; key < 50; ++key) {
        Machine one = machineFor({}), two = machineFor({});
        CHECK(angleOf(before, "B", one, key) == angleOf(after, "B", two, key));
    }
    uint32_t a = before.ref().terminals.v[before.ref().extrudes.v[ruleOf(before, "B").extrude - 1].firstTerminal].site;
    uint32_t b = after.ref().terminals.v[after.ref().extrudes.v[ruleOf(after, "B").extrude - 1].firstTerminal].site;
    CHECK(a == b);
}

TEST_CASE("extrude programs: conditions become gates, Repeat counts, commands set the scope") {
    RuleMap map = compiled(
        "param size = 0.1 [0 .. 1]\n"
        "A(r) -> Marching(0.1, 0, true) {A(r), Wood(r) Leaves}\n"
        "Wood(w) -> S(w * 2) Shape(\"bark\", C0)\n"
        "Leaves : depth < 1 and arc < 0.5 -> NULL\n"
        "Leaves : depth > 3 -> S(size / 2) Shape(\"pebble\")\n"
        "Leaves -> Repeat(3) {[T(0.25, 0.01) R(1, 0.5) Tint(index / count) S(size) Shape(\"leaf\")] R(0.1) S(size) "
        "Shape(\"leaf\")}\n");
    RuleMapRef ref = map.ref();
    RuleRecord rule = ruleOf(map, "A");
    REQUIRE(rule.extrude == 1);
    ExtrudeRecord program = ref.extrudes.v[0];
    REQUIRE(program.terminalCount == 4);
    CHECK(program.argMask == 1);
    CHECK(program.params == 1);
    auto run = [&](uint32_t i, float depth, float arc, float index, float(&out)[7]) {
        TerminalRecord t = ref.terminals.v[program.firstTerminal + i];
        Machine machine = machineFor({0.02f});
        SLOT(kSlotDepth) = depth;
        SLOT(kSlotArc) = arc;
        SLOT(kSlotIndex) = index;
        runCode(MACHINE ref.code, t.gate);
        out[0] = valueOf(MACHINE t.count);
        SLOT(kSlotCount) = out[0];
        runCode(MACHINE ref.code, t.body);
        const Value* values[] = {&t.size, &t.t, &t.lift, &t.turn, &t.pitch, &t.tint};
        for (int k = 0; k < 6; ++k) out[k + 1] = valueOf(MACHINE * values[k]);
        return t;
    };
    float v[7];
    TerminalRecord bark = run(0, 0, 0, 0, v);
    CHECK(bark.flags == kTerminalBark);
    CHECK(bark.mesh == kMeshBark);
    CHECK(bark.smoothness == kSmoothC0);
    CHECK(v[0] == 1.0f);
    CHECK(v[1] == 0.02f);  // a radius
    TerminalRecord pebble = run(1, 4, 1, 0, v);
    CHECK(pebble.mesh == kMeshPebble);
    CHECK(v[0] == 1.0f);
    CHECK(v[1] == doctest::Approx(0.05));
    CHECK(v[6] == 0.4f);  // its rule says no Tint
    TerminalRecord leaf = run(2, 1, 1, 1, v);
    CHECK(leaf.mesh == kMeshLeaf);
    CHECK(v[0] == 3.0f);
    CHECK(v[1] == doctest::Approx(0.1));
    CHECK(v[2] == 0.25f);
    CHECK(v[3] == doctest::Approx(0.01));
    CHECK(v[4] == 1.0f);
    CHECK(v[5] == 0.5f);
    CHECK(v[6] == doctest::Approx(1.0 / 3));
    run(3, 1, 1, 1, v);
    CHECK(v[4] == doctest::Approx(0.1));  // [ ] kept the turn apart
    CHECK(v[5] == 0.0f);
    for (uint32_t i = 1; i < 4; ++i) {
        run(i, 0, 0.2f, 0, v);
        CHECK(v[0] == 0.0f);  // bare foot
    }
    run(2, 4, 1, 0, v);
    CHECK(v[0] == 0.0f);
}

TEST_CASE("every counts marks along a branch independently of where its steps fall") {
    RuleMap map = compiled("A -> Marching(0.1, 0, true) {A, Repeat(every(0.07)) {S(0.1) Shape(\"leaf\")}}");
    RuleMapRef ref = map.ref();
    TerminalRecord t = ref.terminals.v[0];
    for (float step : {0.03f, 0.05f, 0.21f}) {
        int total = 0;
        float arc = 0;
        while (arc + step <= 10.0f) {
            arc += step;
            Machine machine = machineFor({});
            SLOT(kSlotArc) = arc;
            SLOT(kSlotSpanLength) = step;
            runCode(MACHINE ref.code, t.gate);
            total += static_cast<int>(valueOf(MACHINE t.count));
        }
        CHECK(std::abs(total - static_cast<int>(arc / 0.07f)) <= 3);
    }
}

TEST_CASE("angleTo and facing: directions, and what rules read") {
    RuleMap map = compiled(
        "param sunX = 1 [-1 .. 1]\n"
        "A -> Marching(0.1, angleTo(up) + angleTo(sunX, 0, 1), facing(up) > 0.5 and slope < 1) {A}\n");
    RuleMapRef ref = map.ref();
    RuleRecord rule = ruleOf(map, "A");
    CHECK(rule.startInputs == (kInputAngle | (kInputAngle << 1u)));
    CHECK(rule.arriveInputs == (kInputNormal | kInputSlope));
    CHECK(ref.directions[0].y == 1.0f);
    CHECK(ref.directions[1].x == doctest::Approx(std::sqrt(0.5)));
    float zero = 0;
    CHECK(map.setParam(0, {&zero, 1}) == 1u);
    CHECK(map.ref().directions[1].x == 0.0f);
    CHECK(map.ref().directions[1].z == doctest::Approx(1.0));

    // On a wall that faces +z, heading +x: up is a quarter turn to the left as seen from outside.
    SurfaceRef wall{};
    for (int k = 0; k < 3; ++k) wall.toWorld[k][k] = 1;
    wall.scale = 1;
    wall.boundsMin.y = 1;
    wall.boundsMax.y = 4;
    ref = map.ref();
    ExpandEnv env{};
    env.surfaces.v = &wall;
    env.grammars.v = &ref;
    const uint32_t inputs = rule.startInputs | kInputSlope | kInputHeight;
    const Place place{vec3(0, 3, 0), vec3(0, 0, 1), vec3(1, 0, 0), vec2(0), 0, 0};
    Machine machine = machineFor({});
    giveInputs(MACHINE env.surfaces, env.layers, env.grammars, frameOf(env.surfaces, 0, inputs), 0, inputs, 0, place, 0,
               0, 0);
    CHECK(SLOT(kSlotAngle) == doctest::Approx(kPi / 2).epsilon(1e-4));
    CHECK(SLOT(kSlotSlope) == doctest::Approx(kPi / 2).epsilon(1e-4));
    CHECK(SLOT(kSlotHeight) == 2.0f);
    CHECK(angleInSurface(vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 1, 0)) == 0.0f);
}

TEST_CASE("parameters: kinds, ranges, limits, and what they change") {
    RuleMap map = compiled(
        "param step1 = 0.05 [0.01 .. 0.2] \"m\" \"Step\"\n"
        "param leafy = true \"Leaves\"\n"
        "param colour1 = #ff8000 \"Colour\"\n"
        "A -> Marching(step1 * 2 + 0.01, 0, leafy) {A, S(0.1) Colour(colour1) Tint(colour1.g) Shape(\"leaf\")}\n");
    REQUIRE(map.params().size() == 3);
    CHECK(map.params()[0].unit == "m");
    CHECK(map.params()[0].label == "Step");
    CHECK(map.params()[0].maximum == 0.2f);
    CHECK(map.params()[1].kind == ParamKind::toggle);
    CHECK(map.params()[2].kind == ParamKind::colour);
    CHECK(map.params()[2].slot == 2);
    CHECK(ruleOf(map, "A").distance.immediate == doctest::Approx(0.11));
    CHECK(ruleOf(map, "A").params == 3);
    CHECK(map.ref().terminals.v[0].colour[0].immediate == 1.0f);
    CHECK(map.ref().terminals.v[0].colour[1].immediate == doctest::Approx(0.2158).epsilon(0.01));
    float v = 7;
    CHECK(map.setParam(0, {&v, 1}) == 1);
    CHECK(map.params()[0].value[0] == 0.2f);
    CHECK(ruleOf(map, "A").distance.immediate == doctest::Approx(0.41));
    v = std::nanf("");
    CHECK(map.setParam(0, {&v, 1}) == 0);
    v = 0.2f;
    CHECK(map.setParam(1, {&v, 1}) == 2);
    CHECK_FALSE(holds(ruleOf(map, "A").condition.immediate));
    float rgb[] = {0, 0.5f, 9};
    CHECK(map.setParam(2, rgb) == (1u << 2 | 1u << 3 | 1u << 4));
    CHECK(map.ref().terminals.v[0].colour[2].immediate == 1.0f);
}

TEST_CASE("meshes of terminals have the numbers that kernels know them by") {
    const std::vector<TerminalMesh> meshes = standardTerminalMeshes();
    const std::pair<uint32_t, const char*> known[] = {{kMeshBark, "bark"},       {kMeshLeaf, "leaf"},
                                                      {kMeshPebble, "pebble"},   {kMeshOval, "oval"},
                                                      {kMeshBlossom, "blossom"}, {kMeshTuft, "tuft"}};
    REQUIRE(meshes.size() == std::size(known));
    for (const auto& [number, name] : known) CHECK(meshes[number].name == name);
}

TEST_CASE("the shipped grammars compile without warnings and have usable sliders") {
    for (const char* name : {"ivy_free", "ivy_guided", "ivy_paper", "clematis", "grass"}) {
        Result<RuleMap> map = compileGrammarFile(std::string("content/grammars/") + name + ".grammar");
        if (!map) FAIL(map.failure().text());
        CHECK(toString(map->warnings()) == "");
        for (const ParamInfo& p : map->params()) {
            CHECK(p.label != p.name);
            CHECK(p.minimum < p.maximum);
        }
        CHECK(map->words().size() * 4 < 12288);
    }
    Result<RuleMap> free = compileGrammarFile("content/grammars/ivy_free.grammar");
    REQUIRE(free);
    float before = ruleOf(*free, "Climb").distance.immediate;
    float twice = 2;
    free->setParam(*free->findParam("scale"), {&twice, 1});
    CHECK(ruleOf(*free, "Climb").distance.immediate == doctest::Approx(2 * before));
}
