#pragma once

// The parts of the node editor, between graph_*.cpp.

#include <glm/glm.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sample_game/gui_events.hpp"
#include "sample_game/workspace.hpp"
#include "tools/document/graph_model.hpp"

namespace sample {

// Where nodes lie on the canvas, and their ports and wires. Lengths are the canvas', as a text's layout has them.
class NodeCanvas {
  public:
    static constexpr float kWidth = 138, kTitle = 22, kRow = 17, kPort = 4.5f;
    struct Box {
        glm::vec2 at{0}, size{0};
        const espalier::document::NodeKind* kind = nullptr;  // null: the plugin doesn't know it
        uint32_t inputs = 0, outputs = 0;
        bool contains(glm::vec2 p, float around = 0) const {
            return p.x >= at.x - around && p.y >= at.y - around && p.x <= at.x + size.x + around &&
                   p.y <= at.y + size.y + around;
        }
    };
    struct Port {
        uint32_t node = 0, index = 0;
        bool output = false;
        bool operator==(const Port&) const = default;
    };
    struct Wire {
        Port from, to;
        uint32_t place = 0;  // among those at the input
    };
    std::vector<Box> boxes;  // [node]
    std::vector<Wire> wires;

    void build(const espalier::document::GraphModel& model);
    glm::vec2 placeOf(const Port& port) const;
    std::optional<uint32_t> nodeAt(glm::vec2 p) const;  // the one that is drawn last
    std::optional<Port> portNear(glm::vec2 p, float reach) const;
    std::optional<size_t> wireNear(glm::vec2 p, float reach) const;
    static float bend(glm::vec2 from, glm::vec2 to);  // how far a wire's handles lie from its ends
};

// What the node editor remembers of the graph that is open.
struct GraphDesk {
    const espalier::document::Document* document = nullptr;
    uint32_t graph = ~0u, id = 0;
    std::string text;  // that the model was read from
    espalier::document::GraphModel model;
    NodeCanvas canvas;
    std::set<std::string> selected;
    glm::vec2 pan{0};  // the canvas' place at the window's left and top
    float zoom = 1;    // pixels to the canvas' lengths, but for the scale of letters
    bool framed = false;

    // Of the canvas in the window, as of the last frame.
    glm::vec2 low{0}, high{0};
    float scale = 1;
    float pixels() const { return zoom * scale; }
    glm::vec2 toCanvas(glm::vec2 window) const { return (window - low) / pixels() + pan; }
    glm::vec2 toWindow(glm::vec2 at) const { return (at - pan) * pixels() + low; }
    bool holds(glm::vec2 window) const {
        return window.x >= low.x && window.y >= low.y && window.x < high.x && window.y < high.y;
    }

    enum class Drag { none, press, pan, nodes, box, wire };
    struct {
        Drag kind = Drag::none;
        glm::vec2 from{0};                      // on the canvas, where it began
        glm::vec2 moved{0};                     // of nodes
        bool more = false;                      // adds to what is selected
        NodeCanvas::Port port;                  // of a wire: the end that stays
        std::optional<NodeCanvas::Wire> taken;  // the wire whose other end is moved
        uint32_t node = 0;                      // that was pressed
    } drag;

    // The list of kinds that may be added.
    struct {
        bool asked = false, open = false;
        glm::vec2 at{0};                       // on the canvas
        std::optional<NodeCanvas::Port> port;  // that a new node is wired to
        std::string node;                      // whose that is
        char search[64] = "";
        int chosen = 0;
    } list;
    std::string renaming;  // the node whose name is typed; empty: none
    bool textShown = false;

    const espalier::document::GraphNode& nodeAt(uint32_t n) const { return model.nodes[n]; }
    const std::string& nameAt(uint32_t n) const { return model.nodes[n].name; }
    // "a" or "a.out".
    std::string wireText(const NodeCanvas::Port& output) const;
    std::string inputName(const NodeCanvas::Port& input) const;
    std::optional<EspNodeType> typeOf(const NodeCanvas::Port& port) const;
    // Whether a wire may lead there; `why` says why not.
    bool fits(const NodeCanvas::Port& output, const NodeCanvas::Port& input, std::string& why) const;
};

// Of the graph that is open, read anew if its text has changed. Null: there are no graphs.
GraphDesk* graphDesk(Workspace& work);

// How a type is drawn.
uint32_t nodeColour(EspNodeType type);
EspNodeState nodeState(const Workspace& work, const std::string& node);
// "250 points", "9,450 triangles in 20 instances", "0.5"; empty: it has made nothing.
std::string stateText(const EspNodeState& state);
std::string countText(uint64_t count);

void showTimeBar(Workspace& work, float top);
void drawCanvas(Workspace& work, GraphDesk& desk);    // into the window that is being laid out
void handleCanvas(Workspace& work, GraphDesk& desk);  // what the mouse does there; behind its button
void showNodeList(Workspace& work, GraphDesk& desk);  // the list of kinds, and the name that is typed
void nodePanel(Workspace& work, GraphDesk& desk);     // of the node that is selected: its inputs
void graphText(Workspace& work, GraphDesk& desk);     // the text pane
void writeGraphButton(Workspace& work, const GraphDesk& desk);
void drawShownPoints(Workspace& work);  // points and curves that are shown, over the view

// ---- Edits; each is one step of undo.
void askForNode(GraphDesk& desk, glm::vec2 at, std::optional<NodeCanvas::Port> port = {});
void addNode(Workspace& work, GraphDesk& desk, const espalier::document::NodeKind& kind);
void connect(Workspace& work, const GraphDesk& desk, const NodeCanvas::Port& output, const NodeCanvas::Port& input,
             const std::optional<NodeCanvas::Wire>& instead, uint32_t gesture);
void removeSelected(Workspace& work, GraphDesk& desk, bool bridge);
void copySelected(const Workspace& work, const GraphDesk& desk);
void pasteNodes(Workspace& work, GraphDesk& desk, const std::string& text, glm::vec2 at);
void duplicateSelected(Workspace& work, GraphDesk& desk);
void muteSelected(Workspace& work, GraphDesk& desk);
void showNode(Workspace& work, const GraphDesk& desk, const std::string& node, bool more);
void frameNodes(GraphDesk& desk, bool selectedOnly);

}  // namespace sample
