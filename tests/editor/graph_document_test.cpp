// Edits of graphs as actions of a document: what they do to the text, what is evaluated for them, undo, projects, runs.
#include "tests/editor/graph_designer.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;

namespace {

constexpr const char* kTower =
    "graph 1\n# A tower.\nbase   = Cube( size: (1,3,1) )\nbent = Twist(base, angle: 0.5)\nball = Sphere\nshow bent\n"
    "layout {\n    base 0 0\n    bent 160 0\n    ball 0 120\n}\n";
const std::string kCanonical =
    "graph 1\n# A tower.\nbase = Cube(size: (1, 3, 1))\nbent = Twist(base, angle: 0.5)\nball = Sphere\nshow bent\n"
    "layout {\n    base 0 0\n    bent 160 0\n    ball 0 120\n}\n";

std::string graphFile(const Folder& folder, const char* text = kTower) {
    return folder.write("tower.graph", text);
}

struct Graphs : Editing {
    explicit Graphs(const std::string& file) : Editing(file) {}
    const espalier::scene::LoadedGraph& graph() const { return document->scene().graphs[0]; }
    const std::string& text() const { return graph().text; }
    EspGraphStats stats() {
        REQUIRE_MESSAGE(espUpdate(context.get()) == ESP_OK, espLastError(context.get()));
        EspGraphStats stats;
        REQUIRE(espGraphStats(context.get(), graph().id, &stats) == ESP_OK);
        return stats;
    }
    void done(const Action& action) { REQUIRE_MESSAGE(perform(action), error); }
    void refused(const Action& action, const char* why) {
        const std::string before = text();
        CHECK(!perform(action));
        CHECK_MESSAGE(contains(error, why), error);
        CHECK(text() == before);
    }
};

std::string without(std::string text, const std::string& part, const std::string& instead = "") {
    REQUIRE(contains(text, part));
    return text.replace(text.find(part), part.size(), instead);
}

}  // namespace

TEST_CASE("edits of a graph change its text as one would by hand, and are undone byte for byte") {
    const Folder folder;
    Graphs editing(graphFile(folder));
    REQUIRE(editing.text() == kTower);
    const auto check = [&](const Action& action, const std::string& text) {
        const std::string before = editing.text();
        editing.done(action);
        CHECK(editing.text() == text);
        editing.done(Undo{});
        CHECK(editing.text() == before);
        editing.done(Redo{});
        CHECK(editing.text() == text);
        editing.done(Undo{});
    };
    check(MoveNodes{0, {"bent"}, {{170, 5.5f}}}, without(kCanonical, "bent 160 0", "bent 170 5.5"));
    check(SetNodeInput{0, "bent", "angle", "0.75"}, without(kCanonical, "angle: 0.5", "angle: 0.75"));
    check(SetNodeInput{0, "bent", "angle", ""}, without(kCanonical, ", angle: 0.5"));
    check(ConnectNodes{0, "bent", "geometry", "ball"}, without(kCanonical, "Twist(base,", "Twist(ball,"));
    check(ConnectNodes{0, "bent", "geometry", ""}, without(kCanonical, "Twist(base, angle", "Twist(angle"));
    check(ShowNodes{0, {"ball", "base"}}, without(kCanonical, "show bent", "show ball base"));
    check(MuteNodes{0, {"bent"}}, without(kCanonical, "show bent\n", "show bent\nmute bent\n"));
    check(AddNodes{0, "graph 1\nring = Torus(radius: 2)\nlayout { ring 3 4 }\n"},
          without(without(kCanonical, "ball = Sphere\n", "ball = Sphere\nring = Torus(radius: 2)\n"), "ball 0 120\n",
                  "ball 0 120\n    ring 3 4\n"));
    check(RenameNode{0, "base", "foot"},
          without(without(without(kCanonical, "base = Cube", "foot = Cube"), "(base,", "(foot,"), "base 0 0",
                  "foot 0 0"));
    check(RemoveNodes{0, {"base"}},
          without(without(without(kCanonical, "# A tower.\nbase = Cube(size: (1, 3, 1))\n"), "(base, ", "("),
                  "    base 0 0\n"));
    CHECK(editing.text() == kTower);
}

TEST_CASE("a node that is removed with its wire kept leads through") {
    const Folder folder;
    Graphs editing(graphFile(folder,
                             "graph 1\npoints = PointGrid\na = Noise(points)\nb = Twist(a)\ncube = Cube\n"
                             "many = Scatter(b, cube)\nshow many\n"));
    editing.done(RemoveNodes{0, {"a", "b"}, true});
    CHECK(contains(editing.text(), "many = Scatter(points, cube)"));
    editing.done(RemoveNodes{0, {"many"}, true});
    CHECK(!contains(editing.text(), "show"));
}

TEST_CASE("what can't be is refused with its reason, and the text stays") {
    const Folder folder;
    Graphs editing(graphFile(folder));
    editing.done(AddNodes{0, "graph 1\nmore = Bend(bent)\ncurve = Circle\nsum = Math\n"});
    editing.refused(ConnectNodes{0, "bent", "geometry", "more"}, "wires go round in a circle");
    editing.refused(ConnectNodes{0, "bent", "angle", "ball"}, "takes Number");
    editing.refused(ConnectNodes{0, "bent", "geometry", "nobody"}, "there is no node 'nobody'");
    editing.refused(ConnectNodes{0, "bent", "angle", ""}, "nothing is wired there");  // it is a constant's place
    editing.refused(SetNodeInput{0, "base", "cells", "0"}, "isn't 1 to 1000");
    editing.refused(SetNodeInput{0, "base", "cells", "1)\nx = Cube(cells: 2"}, "is no value");
    editing.refused(SetNodeInput{0, "base", "cell", "1"}, "no input 'cell'");
    editing.refused(RenameNode{0, "base", "ball"}, "already");
    editing.refused(RenameNode{0, "base", "2nd"}, "is no name");
    editing.refused(AddNodes{0, "graph 1\nball = Cube\n"}, "already");
    editing.refused(MuteNodes{0, {"ball"}}, "can't be muted");
    editing.refused(ShowNodes{0, {"x"}}, "there is no node 'x'");
    editing.refused(ShowNodes{7, {"x"}}, "there is no graph 7");
    // Nodes may wait for their wires: they fail by themselves.
    editing.done(AddNodes{0, "graph 1\ntube = Loft\n"});
    editing.done(ShowNodes{0, {"tube", "bent"}});
    CHECK(editing.stats().triangles > 0);
    EspNodeState state;
    REQUIRE(espNodeStateOf(editing.context.get(), editing.graph().id, "tube", nullptr, &state) == ESP_OK);
    CHECK(state.made == 0);
    CHECK(contains(state.failure, "'path' is missing"));
}

TEST_CASE("loops are wired, refused, renamed and undone like other nodes") {
    const Folder folder;
    Graphs editing(graphFile(folder, "graph 1\ngrid = PointGrid(counts: (5, 1, 1))\nc = Cube\nshow c\n"));
    editing.done(AddNodes{0, "graph 1\nv = Variant\nt = Twist(c, angle: v.share)\nmany = Replicate(grid, t)\n"});
    editing.done(ShowNodes{0, {"many"}});
    const auto state = [&] {
        EspNodeState now;
        (void)editing.stats();
        REQUIRE(espNodeStateOf(editing.context.get(), editing.graph().id, "many", nullptr, &now) == ESP_OK);
        return now;
    };
    CHECK(contains(state().failure, "'each' is missing: Replicate needs a wire to Variant"));
    editing.refused(ConnectNodes{0, "many", "each", "c"}, "'each' takes a wire to Variant, but 'c' is Cube");
    editing.refused(SetNodeInput{0, "many", "each", "0"}, "'each' takes a wire to Variant");
    editing.done(ConnectNodes{0, "many", "each", "v"});
    editing.done(SetNodeInput{0, "many", "variants", "0"});
    CHECK(state().instances == 5);
    CHECK(state().parts == 5);
    CHECK(std::string(state().note) == "");
    editing.refused(ConnectNodes{0, "c", "size", "many"}, "");
    editing.done(RenameNode{0, "v", "kind"});
    CHECK(contains(editing.text(), "many = Replicate(grid, t, each: kind, variants: 0)"));
    CHECK(contains(editing.text(), "angle: kind.share"));
    editing.done(SetNodeInput{0, "many", "most", "3"});
    CHECK(state().instances == 3);
    CHECK(std::string(state().note) == "3 of 5 instances");
    for (int i = 0; i < 4; ++i) editing.done(Undo{});
    CHECK(contains(editing.text(), "many = Replicate(grid, t)\n"));
    CHECK(state().made == 1);  // as it was last
    for (int i = 0; i < 4; ++i) editing.done(Redo{});
    CHECK(state().instances == 3);
    const NodeKind* kind = findNodeKind("Replicate");
    REQUIRE(kind);
    CHECK(kind->inputs[size_t(kind->input("each"))].opener == "Variant");
    CHECK(kind->inputs[0].opener.empty());
}

TEST_CASE("moving a node evaluates nothing, another node that is shown only what wasn't made") {
    const Folder folder;
    Graphs editing(graphFile(folder));
    const EspGraphStats before = editing.stats();
    CHECK(before.evaluations == 1);
    editing.done(MoveNodes{0, {"base", "bent"}, {{1, 2}, {3, 4}}});
    editing.done(RenameNode{0, "ball", "bowl"});
    CHECK(editing.stats().evaluations == 1);
    editing.done(SetNodeInput{0, "bent", "angle", "0.9"});
    EspGraphStats stats = editing.stats();
    CHECK(stats.evaluations == 2);
    CHECK(stats.evaluated == 1);
    // The cube is there already.
    editing.done(ShowNodes{0, {"base"}});
    stats = editing.stats();
    CHECK(stats.evaluations == 2);
    CHECK(stats.boundsMax[1] == 1.5f);
    editing.done(MuteNodes{0, {"bent"}});
    editing.done(ShowNodes{0, {"bent"}});
    CHECK(editing.stats().boundsMax[0] == .5f);
}

TEST_CASE("a thousand edits of a graph as chance has it are undone byte for byte, and done again") {
    const Folder folder;
    Graphs editing(graphFile(folder));
    GraphDesigner designer(*editing.document, 11);
    std::vector<std::string> texts{editing.text()};
    std::array<size_t, GraphDesigner::kEdits> done{};
    size_t refused = 0;
    while (texts.size() <= 1000) {
        const size_t edit = texts.size() % GraphDesigner::kEdits;
        if (!editing.perform(designer.of(0, edit))) {
            REQUIRE(editing.error != "");
            CHECK(editing.text() == texts.back());
            if (++refused % 7 == 0) REQUIRE_MESSAGE(editing.perform(designer.add(0)), editing.error);
            if (refused % 7 != 0) continue;
        }
        ++done[edit];
        texts.push_back(editing.text());
        if (texts.size() % 100 == 0) (void)editing.stats();
    }
    for (const size_t count : done) CHECK(count > 20);
    CHECK(editing.document->undoSteps() == 1000);
    for (size_t i = texts.size(); i-- > 1;) {
        REQUIRE(editing.text() == texts[i]);
        editing.done(Undo{});
    }
    CHECK(editing.text() == kTower);
    for (size_t i = 1; i < texts.size(); ++i) {
        editing.done(Redo{});
        REQUIRE(editing.text() == texts[i]);
    }
}

TEST_CASE("a drag of a value is one step of undo") {
    const Folder folder;
    Graphs editing(graphFile(folder));
    for (const char* value : {"0.6", "0.7", "0.8"})
        REQUIRE(editing.perform(SetNodeInput{0, "bent", "angle", value}, 5));
    CHECK(editing.document->undoSteps() == 1);
    editing.done(Undo{});
    CHECK(editing.text() == kTower);
}

TEST_CASE("a text with mistakes leaves the last good graph, and both are saved") {
    const Folder folder;
    Graphs editing(graphFile(folder));
    const uint64_t triangles = editing.stats().triangles;
    const std::string wrong = without(kTower, "Cube(", "Cube((");
    editing.done(SetGraphText{0, wrong});
    CHECK(editing.text() == wrong);
    CHECK(contains(editing.graph().error, "tower.graph:3:"));
    CHECK(editing.stats().triangles == triangles);
    editing.refused(MoveNodes{0, {"base"}, {{1, 1}}}, "the graph's text has mistakes");
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
    Graphs opened(folder.file("saved"));
    CHECK(opened.text() == wrong);
    CHECK(contains(opened.graph().error, "tower.graph:3:"));
    CHECK(opened.stats().triangles == triangles);
    editing.done(Undo{});
    CHECK(editing.graph().error == "");
    CHECK(editing.text() == kTower);
    editing.done(Redo{});
    CHECK(editing.text() == wrong);
}

TEST_CASE("a new graph is undone, and a project keeps it without a file") {
    const Folder folder;
    Graphs editing(graphFile(folder));
    editing.done(AddGraph{folder.file("new.graph"), "graph 1\n"});
    editing.done(AddNodes{1, "graph 1\nball = Sphere\n"});
    editing.done(ShowNodes{1, {"ball"}});
    REQUIRE(editing.document->scene().graphs.size() == 2);
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
    Graphs opened(folder.file("saved"));
    REQUIRE(opened.document->scene().graphs.size() == 2);
    CHECK(opened.document->scene().graphs[1].text == "graph 1\nball = Sphere\nshow ball\n");
    for (int i = 0; i < 3; ++i) editing.done(Undo{});
    CHECK(editing.document->scene().graphs.size() == 1);
    for (int i = 0; i < 3; ++i) editing.done(Redo{});
    CHECK(editing.document->scene().graphs[1].text == opened.document->scene().graphs[1].text);
}

TEST_CASE("time is a frame and a rate, is no step of undo, and reaches graphs that come later") {
    const Folder folder;
    Graphs editing(graphFile(folder, "graph 1\nt = Time\na = Cylinder(height: t.seconds)\nshow a\n"));
    editing.done(SetGraphTime{60, 30});
    CHECK(editing.document->undoSteps() == 0);
    CHECK(editing.stats().boundsMax[1] == doctest::Approx(2));
    editing.done(SetGraphTime{60, 20});
    CHECK(editing.stats().boundsMax[1] == doctest::Approx(3));
    editing.done(AddGraph{folder.file("b.graph"),
                          "graph 1\nt = Time\na = Cube(size: (1, 9, 1))\nb = Vector(y: t.seconds)\n"
                          "c = Transform(a, move: b)\nshow c\n"});
    REQUIRE(espUpdate(editing.context.get()) == ESP_OK);
    EspGraphStats stats;
    REQUIRE(espGraphStats(editing.context.get(), editing.document->scene().graphs[1].id, &stats) == ESP_OK);
    CHECK(stats.boundsMax[1] == doctest::Approx(7.5));
    editing.refused(SetGraphTime{1, 0}, "1 to 1000 a second");
    editing.refused(SetGraphTime{20000000, 30}, "a frame is 0 to 16777216");
}

TEST_CASE("every edit of a graph is a line of a run that reads as it was written") {
    const Action actions[] = {AddGraph{"a.graph", "graph 1\n"},
                              SetGraphText{1, "graph 1\n# x\n"},
                              AddNodes{0, "graph 1\na = Cube\n"},
                              RemoveNodes{0, {"a", "b"}, true},
                              SetNodeInput{0, "a", "size", "(1, 2, 3)"},
                              ConnectNodes{0, "b", "geometry", "a.mesh", 2},
                              MoveNodes{0, {"a"}, {{1.5f, -2}}},
                              RenameNode{0, "a", "b"},
                              ShowNodes{0, {}},
                              MuteNodes{0, {"b"}, false},
                              SetGraphTime{12, 24}};
    for (const Action& action : actions) {
        RunLine line;
        std::string error;
        const std::string written = toJson({3, 4, action});
        REQUIRE_MESSAGE(fromJson(written, line, error), error);
        CHECK(toJson(line) == written);
    }
}
