#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/document/action.hpp"
#include "tools/document/graph_model.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/scene.hpp"

namespace espalier::document {

// A scene that is being edited: everything that changes it is an action, and every action but those of the camera can
// be undone. One thread; the context outlives the document, and nobody else edits what it holds.
class Document {
  public:
    static constexpr size_t kMaxHistoryBytes = size_t(256) << 20;
    explicit Document(EspContext* context, size_t maxHistoryBytes = kMaxHistoryBytes)
        : context_(context), maxHistoryBytes_(maxHistoryBytes) {}
    ~Document();
    Document(const Document&) = delete;

    // See scene::openScene; seeds are planted. Once a document.
    bool open(const scene::Request& request, std::string& error);

    // Does it now. Actions of one gesture (not 0), such as those of a dragged slider, become one step of undo.
    // False: `error` tells why, and the document is as it was, but for what undo and redo have done of a step of
    // several edits before one failed, which is a step of its own then. A text with mistakes is taken, and its
    // grammar's `error` tells them.
    bool perform(const Action& action, std::string& error, uint32_t gesture = 0);

    // What the next undo and redo would take back or do again, in a few words; null: there is nothing.
    const char* undoName() const;
    const char* redoName() const;
    size_t undoSteps() const { return done_.size() - beyond_; }
    // Of the step that the next undo takes back; 0: it has none.
    uint32_t undoGesture() const { return undoSteps() == 0 ? 0 : done_.back().gesture; }
    // That step, if it is of the gesture, is called so from now on: who asked for several things knows what for.
    void callStep(uint32_t gesture, std::string name);
    // What is kept for undo and redo. Past maxHistoryBytes the oldest steps are forgotten, or, by undo, those that it
    // undid first; the latest one is kept however large it is.
    size_t historyBytes() const;

    // Files of a project that couldn't be read, and that undo or redo may bring back.
    std::vector<std::string> filesOfHistory() const;

    // Rises with every action that changes what a project holds; undoing one is a change too.
    uint64_t revision() const { return revision_; }
    // Of what a project holds as it is now: undone and done again it is the same state.
    uint64_t state() const { return stroking() ? ~0ull : done_.empty() ? bottom_ : done_.back().state; }

    // For a recording, from here on as if it had been opened as a project of it: seeds have the keys that its reader
    // gives them. What their keys were, in the list's order. No stroke is open. What was done before is out of undo's
    // reach until reachBack(); nothing can be done again.
    std::vector<uint32_t> beginAnew();
    void reachBack() { beyond_ = 0; }

    // Called with every action that was asked for and done, after it.
    using Listener = std::function<void(const Action&, uint32_t gesture)>;
    void listen(Listener listener) { listener_ = std::move(listener); }
    // Called before anything changes what a project holds: who reads the document bit by bit reads the rest of it.
    void beforeEdits(std::function<void()> settle) { settle_ = std::move(settle); }

    const scene::Scene& scene() const { return scene_; }
    EspContext* context() const { return context_; }
    const scene::Seed* seed(uint32_t key) const;
    bool stroking() const { return !strokes_.empty(); }
    // One surface's layer over its walk UVs, the first row at v = 0; of a layer of colours one of scene::channelsOf.
    bool readLayer(size_t surface, const std::string& layer, scene::GreyPicture& out, std::string& error) const;
    // A layer over the town's site, the first row in the north.
    bool readTownLayer(const std::string& layer, scene::GreyPicture& out, std::string& error) const;
    // A key that no seed of this document has or had.
    uint32_t freshKey() { return ++lastKey_; }
    SeedRecord recordOf(const scene::Seed& seed) const;
    // Another text for a grammar, whose parameters keep their values.
    SetText withText(uint32_t grammar, std::string text) const;

  private:
    bool openGuarded(const scene::Request& request, std::string& error);
    struct Step {
        std::string name;
        uint32_t gesture = 0;
        uint64_t state = 0;        // Document::state() after it
        std::vector<Action> back;  // performed from the last to the first, they take the step back
        size_t bytes = 0;          // of that
    };
    // Does an action and tells what takes it back.
    bool carryOut(const Action& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetParam& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetText& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const AddSeeds& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const RemoveSeeds& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const ChangeSeeds& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetLight& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetWalk& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const StrokeBegin& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const StrokeDabs& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const StrokeEnd& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const FillLayer& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const LoadLayer& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const LoadTownLayer& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SwapStroke& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const FreezeSeeds& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const RestoreFrozen& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const PruneBranch& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetHouse& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const ResetHouse& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetField& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const BrushField& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const TrimField& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const AddSurface& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const PlaceSurface& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const AddGrammar& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const AddGraph& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetGraphText& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const AddNodes& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const RemoveNodes& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetNodeInput& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const ConnectNodes& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const MoveNodes& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const RenameNode& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const ShowNodes& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const MuteNodes& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetGraphTime& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetLook& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const ShowPlants& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const ShowSurfaces& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const LockSurface& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const ShowHouses& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const LockHouse& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const LockLayer& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetBookmark& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const DropLast& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetCamera& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const SetView& action, std::vector<Action>& back, std::string& error);
    bool carryOut(const Undo&, std::vector<Action>&, std::string& error) { return move(done_, undone_, error); }
    bool carryOut(const Redo&, std::vector<Action>&, std::string& error) { return move(undone_, done_, error); }

    bool move(std::vector<Step>& from, std::vector<Step>& to, std::string& error);
    void remember(const Action& action, std::string name, std::vector<Action> back, uint32_t gesture);
    void keep(std::vector<Step>& steps);
    bool failed(EspResult result, std::string& error) const;
    std::vector<Param> paramsOf(uint32_t grammar) const;
    bool townGrows() const;  // it has a grammar
    Action keepStroke(EspStroke ended, const std::string& channel, const std::function<bool(int surface)>& covers);
    void exchangeUnread(const StrokeRecord& stroke);
    bool takeBack(std::vector<Action>& back);
    std::string unreadPlant(uint32_t seed) const;  // its file; empty: it was read, or there is none
    std::string takeUnread(uint32_t seed, const std::string& unread);
    bool moveSeeds(const ChangeSeeds& action, const std::vector<scene::Seed>& before, std::string& error);
    bool plant(std::string& error);
    bool replant(const std::vector<scene::Seed>& before, std::string& error);
    size_t indexOf(uint32_t key) const;
    Action houseBack(uint32_t index) const;
    bool knowsHouse(uint32_t house, std::string& error) const;
    bool mayChangeHouse(uint32_t house, std::string& error) const;  // knows it, and it isn't locked
    bool mayPaint(const std::string& layer, std::string& error) const;
    using GraphEdit = std::function<bool(GraphModel& model, std::string& error)>;
    bool carryFields(uint32_t surface, const scene::Placing& to, std::string& error);
    size_t droppedBytes(const SetField& back) const;  // of a file that only the history has now
    bool changeField(uint32_t surface, const std::string& name, const std::optional<scene::SceneField>& now,
                     std::string& error);
    bool editGraph(uint32_t graph, std::vector<Action>& back, std::string& error, const GraphEdit& edit);

    EspContext* context_;
    size_t maxHistoryBytes_;
    scene::Scene scene_;
    bool allPlanted_ = true;
    std::vector<Step> done_, undone_;
    size_t beyond_ = 0;  // of done_, from its beginning: out of undo's reach
    struct OpenStroke {
        std::string channel;
        EspStroke stroke;
    };
    std::vector<OpenStroke> strokes_;  // one for each channel of a layer
    std::string strokeName_;           // its nameOf()
    uint64_t revision_ = 0;
    uint64_t bottom_ = 0, lastState_ = 0;  // bottom: before the oldest step that is kept
    uint32_t lastKey_ = 0;
    Listener listener_;
    std::function<void()> settle_;
};

// The words for an action in menus, before it is done: "Plant 3 seeds", "Pitch of house 12".
std::string nameOf(const Document& document, const Action& action);
constexpr const char* kEditGraph = "Edit the graph's text";
constexpr const char* kEditText = "Edit the text";  // these begin so, of whichever grammar
// A grammar's file, told apart from others of the same file by its place.
std::string grammarName(const scene::Scene& scene, size_t index);
// Of a step of several plantings, by what takes it back.
std::string plantingName(const std::vector<Action>& back);
// The brush of a stroke; the layer's name stays the stroke's. False: there is no such mode.
bool brushOf(const StrokeBegin& stroke, EspBrush& brush, std::string& error);
// Whether undo takes it back, and a project holds what it changes.
bool isEdit(const Action& action);

}  // namespace espalier::document
