// The node editor under a user's hands: wires that are dragged, nodes that are added, moved and put into wires.
#include "sample_game/graph_editor.hpp"
#include "sample_game/graph_parts.hpp"
#include "sample_game/panels.hpp"
#include "tests/editor/imgui_keys.hpp"
#include "tests/editor/widgets.hpp"

using namespace espalier::document;
using sample::NodeCanvas;
using sample::Tool;

namespace {

constexpr const char* kChain =
    "graph 1\ngrid = PointGrid\nball = Sphere\nmany = Scatter(grid, ball)\nbent = Bend(many)\ntwisted = Twist(bent)\n"
    "show twisted\nlayout {\n    grid 0 0\n    ball 0 160\n    many 200 0\n    bent 400 0\n    twisted 600 0\n}\n";

struct Wirer : Editor {
    Wirer(const Folder& folder, const std::string& text) : Editor(folder, folder.write("a.graph", text), Tool::look) {
        ImGui::GetIO().MouseDoubleClickTime = 0;                                // frames follow each other at once
        ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;  // as the window's
        work.window = {1600, 1000};
        work.layout.panel = false;
        work.graphs.nodes = true;
        work.graphs.height = 600;
        panels = [this] {
            sample::beginGesture(work);
            sample::showGraphs(work);
        };
        rest();
    }
    ~Wirer() { sample::forgetNodeList(); }
    sample::GraphDesk& desk() { return *sample::graphDesk(work); }
    const std::string& text() const { return work.scene().graphs[0].text; }
    void rest() {
        for (int i = 0; i < 3; ++i) frame({});
    }
    void mouseTo(glm::vec2 at, bool down) {
        mouse = at;
        ImGui::GetIO().MouseDown[0] = down;
        frame({});
    }
    void dragMouse(glm::vec2 from, glm::vec2 to) {
        mouseTo(from, false);
        mouseTo(from, false);
        mouseTo(from, true);
        for (int i = 1; i <= 4; ++i) mouseTo(glm::mix(from, to, float(i) / 4), true);
        mouseTo(to, false);
        rest();
    }
    void clickMouse(glm::vec2 at) { dragMouse(at, at); }
    glm::vec2 port(const std::string& node, const std::string& name, bool output) {
        const int n = desk().model.find(node);
        REQUIRE(n >= 0);
        const NodeKind& kind = *desk().canvas.boxes[size_t(n)].kind;
        const int index = output ? kind.output(name) : kind.input(name);
        REQUIRE(index >= 0);
        return desk().toWindow(desk().canvas.placeOf({uint32_t(n), uint32_t(index), output}));
    }
    glm::vec2 title(const std::string& node) {
        const int n = desk().model.find(node);
        REQUIRE(n >= 0);
        return desk().toWindow(desk().canvas.boxes[size_t(n)].at + glm::vec2(30, 10));
    }
    glm::vec2 empty() { return desk().toWindow({480, 165}); }
    void type(const std::string& letters) {
        for (const char letter : letters) ImGui::GetIO().AddInputCharacter(unsigned(letter));
        rest();
    }
    void enter() {
        setKey(ImGuiKey_Enter, true);
        frame({});
        setKey(ImGuiKey_Enter, false);
        rest();
    }
    void add(const std::string& kind, glm::vec2 at) {
        mouseTo(at, false);
        key(GLFW_KEY_TAB);
        rest();
        type(kind);
        enter();
    }
};

}  // namespace

TEST_CASE("a wire is dragged from port to port, and taken away by dragging its end to nothing") {
    const Folder folder;
    Wirer wirer(folder, kChain);
    wirer.dragMouse(wirer.port("ball", "mesh", true), wirer.port("bent", "geometry", false));
    CHECK(contains(wirer.text(), "bent = Bend(ball)"));
    // The end of a wire that is there moves: its old place is free.
    wirer.dragMouse(wirer.port("bent", "geometry", false), wirer.port("twisted", "geometry", false));
    CHECK(contains(wirer.text(), "bent = Bend\n"));
    CHECK(contains(wirer.text(), "twisted = Twist(ball)"));
    wirer.dragMouse(wirer.port("twisted", "geometry", false), wirer.empty());
    CHECK(contains(wirer.text(), "twisted = Twist\n"));
    for (int i = 0; i < 3; ++i) wirer.undo();
    CHECK(wirer.text() == kChain);
}

TEST_CASE("a wire that would close a circle or doesn't fit is refused, and it is told why") {
    const Folder folder;
    Wirer wirer(folder, kChain);
    wirer.dragMouse(wirer.port("twisted", "geometry", true), wirer.port("many", "shape", false));
    CHECK(wirer.text() == kChain);
    CHECK_MESSAGE(contains(wirer.work.error, "many \u2192 bent \u2192 twisted \u2192 many"), wirer.work.error);
    wirer.dragMouse(wirer.port("ball", "mesh", true), wirer.port("bent", "angle", false));
    CHECK(wirer.text() == kChain);
    CHECK_MESSAGE(contains(wirer.work.error, "'angle' takes Number, this is Mesh"), wirer.work.error);
}

TEST_CASE("nodes are added by their names, and wired to the selected one where one needs the other") {
    const Folder folder;
    Wirer wirer(folder, "graph 1\n");
    wirer.add("particl", wirer.empty());
    CHECK(contains(wirer.text(), "particles = Particles\n"));
    wirer.add("subset", wirer.empty());
    CHECK(contains(wirer.text(), "subsetCurves = SubsetCurves(particles)\n"));
    wirer.add("loft", wirer.empty());
    wirer.add("circle", wirer.empty());
    CHECK(contains(wirer.text(), "loft = Loft(subsetCurves, circle)\n"));
    CHECK(wirer.work.document->undoSteps() == 4);
    // Letters that were typed into the search are no tools' keys.
    CHECK(wirer.desk().model.nodes.size() == 4);
    for (int i = 0; i < 4; ++i) wirer.undo();
    CHECK(wirer.text() == "graph 1\n");
}

TEST_CASE("a wire that is let go over nothing lists what fits, and what is chosen is wired") {
    const Folder folder;
    Wirer wirer(folder, kChain);
    wirer.dragMouse(wirer.port("grid", "points", true), wirer.empty());
    wirer.type("subset");
    wirer.enter();
    CHECK(contains(wirer.text(), "subsetCurves = SubsetCurves(grid)\n"));
    wirer.dragMouse(wirer.port("subsetCurves", "seed", false), wirer.empty() + glm::vec2(-60, 100));
    wirer.type("round");
    wirer.enter();
    CHECK(contains(wirer.text(), "subsetCurves = SubsetCurves(grid, seed: round)\n"));
    CHECK(wirer.work.document->undoSteps() == 2);
}

TEST_CASE("nodes are moved together, chosen by a box, removed, muted and shown") {
    const Folder folder;
    Wirer wirer(folder, kChain);
    const glm::vec2 by(40, 20);
    wirer.dragMouse(wirer.desk().toWindow({390, -20}), wirer.desk().toWindow({760, 90}));
    CHECK(wirer.desk().selected == std::set<std::string>{"bent", "twisted"});
    wirer.dragMouse(wirer.title("bent"), wirer.title("bent") + by * wirer.desk().pixels());
    CHECK(contains(wirer.text(), "    bent 440 20\n    twisted 640 20\n"));
    wirer.undo();
    wirer.mouseTo(wirer.empty(), false);
    wirer.key(GLFW_KEY_M);
    CHECK(contains(wirer.text(), "mute bent twisted\n"));
    wirer.key(GLFW_KEY_M);
    CHECK(!contains(wirer.text(), "mute"));
    wirer.clickMouse(wirer.title("bent"));
    wirer.key(GLFW_KEY_E);
    CHECK(contains(wirer.text(), "show bent\n"));
    wirer.mouseTo(wirer.empty(), false);
    wirer.key(GLFW_KEY_X, GLFW_MOD_CONTROL);
    CHECK(contains(wirer.text(), "twisted = Twist(many)"));
    wirer.key(GLFW_KEY_A);
    wirer.key(GLFW_KEY_DELETE);
    CHECK(wirer.text() == "graph 1\n");
}

TEST_CASE("an unwired node that is let go over a wire becomes a part of it") {
    const Folder folder;
    Wirer wirer(folder, kChain);
    wirer.clickMouse(wirer.empty());
    wirer.add("wave", wirer.empty());
    REQUIRE(contains(wirer.text(), "wave = Wave\n"));
    const glm::vec2 middle = .5f * (wirer.port("bent", "geometry", true) + wirer.port("twisted", "geometry", false));
    const NodeCanvas::Box box = wirer.desk().canvas.boxes[size_t(wirer.desk().model.find("wave"))];
    const glm::vec2 grip = wirer.title("wave"), centre = wirer.desk().toWindow(box.at + .5f * box.size);
    wirer.dragMouse(grip, middle + grip - centre);
    CHECK(contains(wirer.text(), "wave = Wave(bent)\n"));
    CHECK(contains(wirer.text(), "twisted = Twist(wave)\n"));
}

TEST_CASE("copies are texts that can be pasted, and get names of their own") {
    const Folder folder;
    Wirer wirer(folder, kChain);
    wirer.mouseTo(wirer.empty(), false);
    sample::pasteNodes(wirer.work, wirer.desk(), "a = Cube\nb = Twist(a, angle: 2)\n", {0, 300});
    CHECK(contains(wirer.text(), "b = Twist(a, angle: 2)\n"));
    wirer.rest();
    wirer.desk().selected = {"many", "ball"};
    wirer.key(GLFW_KEY_D, GLFW_MOD_SHIFT);
    // A wire to what isn't copied stays what it is.
    CHECK(contains(wirer.text(), "many2 = Scatter(grid, ball2)\n"));
    sample::pasteNodes(wirer.work, wirer.desk(), "no graph at all", {0, 0});
    CHECK(contains(wirer.work.error, "is no graph"));
}

TEST_CASE("Space plays frames of a graph's time, the arrows step, and it is no edit") {
    const Folder folder;
    Wirer wirer(folder, "graph 1\nt = Time\na = Cylinder(height: t.seconds)\nshow a\n");
    wirer.mouse = {300, 200};
    wirer.key(GLFW_KEY_RIGHT);
    wirer.key(GLFW_KEY_RIGHT);
    CHECK(wirer.work.scene().graphFrame == 2);
    wirer.key(GLFW_KEY_LEFT);
    CHECK(wirer.work.scene().graphFrame == 1);
    wirer.key(GLFW_KEY_SPACE);
    CHECK(wirer.work.graphs.playing);
    const double began = wirer.work.graphs.playedFrom;
    sample::playGraphs(wirer.work, began + 1);
    CHECK(wirer.work.scene().graphFrame == 31);
    sample::playGraphs(wirer.work, began + 250. / 30 + .01);  // it goes round
    CHECK(wirer.work.scene().graphFrame == 0);
    wirer.key(GLFW_KEY_SPACE);
    CHECK(!wirer.work.graphs.playing);
    wirer.key(GLFW_KEY_RIGHT);
    wirer.key(GLFW_KEY_HOME, GLFW_MOD_CONTROL);
    CHECK(wirer.work.scene().graphFrame == 0);
    CHECK(wirer.work.document->undoSteps() == 0);
}

TEST_CASE("of ten thousand nodes only those are drawn that are seen") {
    const Folder folder;
    std::string text = "graph 1\na0 = Number\n", layout = "layout {\n    a0 0 0\n";
    for (int i = 1; i < 10000; ++i) {
        const std::string name = "a" + std::to_string(i);
        text += name + " = Math(a: a" + std::to_string(i - 1) + ")\n";
        layout += "    " + name + " " + std::to_string(i % 100 * 180) + " " + std::to_string(i / 100 * 130) + "\n";
    }
    Wirer wirer(folder, text + layout + "}\n");
    wirer.desk().zoom = 1;
    wirer.desk().pan = {6000, 6000};
    wirer.rest();
    CHECK(ImGui::GetDrawData()->TotalVtxCount < 40000);
    const int frames = 50;
    const std::clock_t begin = std::clock();
    for (int i = 0; i < frames; ++i) wirer.frame({});
    MESSAGE("a frame with the canvas took ms of CPU: ", 1e3 * double(std::clock() - begin) / CLOCKS_PER_SEC / frames);
}

TEST_CASE("the woven sphere is built from an empty graph in at most ten clicks and four drags") {
    if (run("command -v xvfb-run && command -v xdotool").code != 0) {
        MESSAGE("xvfb-run or xdotool isn't installed; skipped");
        return;
    }
    const Folder folder;
    const Ran ran =
        runOnDisplay("1280x800", "tests/editor/drive_graph " + program("espalier-sample") + " " + folder.path.string());
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    int clicks = 0, drags = 0;
    const size_t counts = ran.output.rfind(" clicks, ");  // the editor's warnings may come behind it
    REQUIRE(counts != std::string::npos);
    const size_t told = ran.output.rfind('\n', counts) + 1;
    REQUIRE(std::sscanf(ran.output.c_str() + told, "%d clicks, %d drags", &clicks, &drags) == 2);
    CHECK(clicks <= 10);
    CHECK(drags <= 4);
    const Ran replayed = run(program("espalier-capture") + " --replay " + folder.file("run.jsonl") +
                             " --every 1000000 --size 64x40 -o " + folder.file("out"));
    REQUIRE_MESSAGE(replayed.code == 0, replayed.output);
    CHECK_MESSAGE(contains(replayed.output, "6 nodes, 179200 vertices, 330000 triangles"), replayed.output);
}
