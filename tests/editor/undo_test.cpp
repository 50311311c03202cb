// Undo of all that there is to do, in one sequence as chance has it, judged by everything that can be asked of the
// document and of what has grown after each step.
#include <map>
#include <optional>

#include "tests/editor/designer.hpp"
#include "tools/document/project.hpp"
#include "tools/scene/hash.hpp"

using namespace espalier::document;
using espalier::scene::GreyPicture;
using espalier::scene::House;

namespace {

// ---- How things stand

using State = std::map<std::string, std::string>;  // by what they are called

std::string line(const Action& action) {
    return toJson({0, 0, action});
}
std::string hashOf(const GreyPicture& picture) {
    return espalier::scene::hashName(picture.texels.data(), picture.texels.size() * sizeof(float));
}

void noteGrammars(Editing& editing, State& state) {
    EspContext* context = editing.context.get();
    for (uint32_t i = 0; i < editing.document->scene().grammars.size(); ++i) {
        const auto& grammar = editing.document->scene().grammars[i];
        const std::string name = "grammar " + std::to_string(i) + " ";
        state[name + "text"] = grammar.text;
        state[name + "grows"] = grammar.grows;
        state[name + "error"] = grammar.error;
        for (uint32_t p = 0; p < espParamCount(context, grammar.id); ++p) {
            EspParamInfo info;
            REQUIRE(espParamInfo(context, grammar.id, p, &info) == ESP_OK);
            state[name + info.name] = line(SetParam{i, {info.name, {info.value, info.value + 3}}});
        }
    }
}

void noteSeeds(Editing& editing, State& state) {
    const auto& seeds = editing.document->scene().seeds;
    for (size_t i = 0; i < seeds.size(); ++i) {
        const std::string name = "seed " + std::to_string(i) + " ";
        SeedRecord record = editing.document->recordOf(seeds[i]);
        state[name + "frozen"] =
            record.frozen ? espalier::scene::hashName(record.frozen->data(), record.frozen->size()) : "";
        state[name + "key"] = std::to_string(std::exchange(record.key, 0));
        state[name + "record"] = line(ChangeSeeds{{record}});
        EspSeedInfo info;
        REQUIRE(espSeedInfo(editing.context.get(), seeds[i].planted, &info) == ESP_OK);
        CHECK(bool(info.frozen) == bool(record.frozen));
    }
    CHECK(espSeedCount(editing.context.get()) == seeds.size());
    for (uint32_t i = 0; i < espPrunedCount(editing.context.get()); ++i) {
        uint64_t branch = 0;
        REQUIRE(espPrunedAt(editing.context.get(), i, &branch) == ESP_OK);
        state["pruned"] += std::to_string(branch) + " ";
    }
}

void noteGraphs(const Editing& editing, State& state) {
    const auto& graphs = editing.document->scene().graphs;
    for (size_t i = 0; i < graphs.size(); ++i) {
        const std::string name = "graph " + std::to_string(i) + " ";
        state[name + "text"] = graphs[i].text;
        state[name + "runs"] = graphs[i].runs;
        state[name + "error"] = graphs[i].error;
    }
}

State stateOf(Editing& editing) {
    State state;
    state["growth"] = std::to_string(editing.hash());
    EspRoofStats roofs;
    REQUIRE(espReadRoofStats(editing.context.get(), &roofs) == ESP_OK);
    state["roofs"] = std::to_string(roofs.hash);
    noteGrammars(editing, state);
    noteSeeds(editing, state);
    noteGraphs(editing, state);
    GreyPicture picture;
    for (const char* layer : kWallLayers) {
        REQUIRE_MESSAGE(editing.document->readLayer(0, layer, picture, editing.error), editing.error);
        state[std::string("wall's ") + layer] = hashOf(picture);
    }
    for (const char* layer : kTownLayers) {
        REQUIRE_MESSAGE(editing.document->readTownLayer(layer, picture, editing.error), editing.error);
        state[std::string("town's ") + layer] = hashOf(picture);
    }
    const auto& scene = editing.document->scene();
    for (const std::string& layer : scene.layers) state["layers"] += layer + " ";
    for (uint32_t i = 0; i < espHouseCount(editing.context.get()); ++i)
        state["house " + std::to_string(i)] = line(SetHouse{espalier::scene::houseNow(editing.context.get(), i)});
    for (const House& house : scene.town->houses) state["changed houses"] += line(SetHouse{house});
    const EspLook& look = scene.look;
    state["light"] = line(SetLight{scene.hour, look.exposure, look.shadows != 0});
    state["sun"] = line(SetCamera{{look.sunDirection[0], look.sunDirection[1], look.sunDirection[2]},
                                  {look.sunColour[0], look.sunColour[1], look.sunColour[2]},
                                  look.skyColour[2]});
    for (size_t i = 0; i < scene.surfaces.size(); ++i)
        for (const auto& field : scene.surfaces[i].fields) {
            std::string& fields = state["fields of " + std::to_string(i)];
            fields += line(SetField{uint32_t(i), field, true});
            for (const auto& stroke : field.strokes) fields += line(BrushField{uint32_t(i), field.name, stroke});
        }
    state["walk"] = espalier::scene::nameOf(scene.grow.walk);
    return state;
}

std::string difference(const State& a, const State& b) {
    std::string names;
    for (const auto& [name, value] : a)
        if (const auto other = b.find(name); other == b.end() || other->second != value) names += name + ", ";
    for (const auto& [name, value] : b)
        if (!a.count(name)) names += name + ", ";
    return names;
}

// ---- What ought to be

// The states that undo and redo lead through. Those that nobody has looked at yet are taken as they come.
class Course {
  public:
    explicit Course(Editing& editing) : editing_(editing) { look(); }
    void step() {
        states_.resize(++at_);
        states_.emplace_back();
    }
    void look() {
        State now = stateOf(editing_);
        std::optional<State>& known = states_[at_];
        if (known) CHECK_MESSAGE(now == *known, "step ", at_, ": not as it was: ", difference(now, *known));
        known = std::move(now);
    }
    // Undo, or redo.
    void move(bool back) {
        REQUIRE_MESSAGE(editing_.perform(back ? Action(Undo{}) : Action(Redo{})), editing_.error);
        at_ += back ? -1 : 1;
        look();
    }
    bool first() const { return at_ == 0; }
    bool last() const { return at_ + 1 == states_.size(); }
    const State& state() const { return *states_[at_]; }

  private:
    Editing& editing_;
    std::vector<std::optional<State>> states_{1};
    size_t at_ = 0;
};

// Layers that a stroke has brought into being stay, as their fill, when it is undone: so they are there from the start.
void fillLayers(Editing& editing) {
    for (const char* layer : kWallLayers) REQUIRE_MESSAGE(editing.perform(FillLayer{layer, .8f}), editing.error);
    for (const char* layer : kTownLayers) REQUIRE_MESSAGE(editing.perform(FillLayer{layer, .4f}), editing.error);
}

// Edits, undo and redo as chance has it, each counted by its kind.
void work(Editing& editing, Designer& designer, Course& course, int edits, std::array<int, kKinds>& done) {
    Document& document = *editing.document;
    for (int i = 0; i < edits; ++i) {
        const Designer::Actions actions = designer.next();
        if (actions.empty()) continue;
        for (const Action& action : actions) ++done[action.index()];
        if (const bool back = std::holds_alternative<Undo>(actions[0]);
            back || std::holds_alternative<Redo>(actions[0])) {
            course.move(back);
            continue;
        }
        const size_t steps = document.undoSteps();
        for (const Action& action : actions)
            REQUIRE_MESSAGE(editing.perform(action, uint32_t(i + 1)), line(action), ": ", editing.error);
        CAPTURE(line(actions.back()));
        if (document.undoSteps() == steps + 1) course.step();
        REQUIRE(document.undoSteps() <= steps + 1);
        // Now and then several edits reach growth at once.
        if (designer.pick(3)) course.look();
        for (uint32_t n = designer.pick(3) ? 0 : designer.pick(6); n-- > 0 && !course.first();) course.move(true);
        for (uint32_t n = designer.pick(2) ? 0 : designer.pick(4); n-- > 0 && !course.last();) course.move(false);
    }
}

}  // namespace

TEST_CASE("all that there is to do is undone and done again, in any order, to the state that it was in") {
    const Folder folder;
    const std::string scene = wallScene(folder, true);
    constexpr int kEdits = 150;
    std::array<int, kKinds> done{};
    for (const uint32_t seed : {1u, 2u, 3u}) {
        CAPTURE(seed);
        Editing editing(scene);
        fillLayers(editing);
        Designer designer(editing, folder, seed);
        Course course(editing);
        const State begin = course.state();
        work(editing, designer, course, kEdits, done);
        while (!course.last()) course.move(false);
        course.look();
        const State end = course.state();
        while (!course.first()) course.move(true);
        CHECK_MESSAGE(course.state() == begin, difference(course.state(), begin));
        while (!course.last()) course.move(false);
        CHECK_MESSAGE(course.state() == end, difference(course.state(), end));
        CHECK(!editing.perform(Redo{}));
        CHECK(contains(editing.error, "nothing to redo"));

        // The same again in another context, where nothing has grown before: as a recording would begin with it.
        REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
        (void)editing.document->beginAnew();
        Editing opened(folder.file("saved"));
        const State fresh = stateOf(opened), kept = stateOf(editing);
        CHECK_MESSAGE(fresh == kept, difference(fresh, kept));
    }
    [&]<size_t... I>(std::index_sequence<I...>) {
        const char* names[] = {std::variant_alternative_t<I, Action>::kName...};
        for (size_t i = 0; i < kKinds; ++i)
            if (*names[i] && names[i] != AddSurface::kName)
                CHECK_MESSAGE(done[i] > 0,
                              "never done: ", std::string(names[i]));  // inverses only, and what has tests of its own
    }
    (std::make_index_sequence<kKinds>());
}
