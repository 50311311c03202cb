#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "tests/editor/editing.hpp"

// Of wallScene with its town.
inline constexpr const char* kWallLayers[] = {"mask", "damp"};
inline constexpr const char* kTownLayers[] = {"decay", "moss", "soot", "rise", "steep", "covering"};
inline constexpr uint32_t kTown = 2;  // its grammar; the others are of plants

namespace espalier::document {

inline constexpr size_t kKinds = std::variant_size_v<Action>;

// A designer who does anything, by chance. One function a kind of action: a kind that has none doesn't compile.
class Designer {
  public:
    using Actions = std::vector<Action>;  // of one gesture; none: there is nothing to be done of the kind

    Designer(Editing& editing, const Folder& folder, uint32_t seed)
        : editing_(editing), document_(*editing.document), random_(seed), first_(document_.undoSteps()) {
        const auto read = [&](const char* name) { return readAll(content("grammars/") + name); };
        std::string free = read("ivy_free.grammar");
        // As long as the guided one's plants, and alike where nothing is painted.
        for (const auto& [from, to] : {std::pair{"mask = 0.5", "mask = 1"}, {"reach       = 3.5", "reach = 0.8"}}) {
            REQUIRE(contains(free, from));
            free.replace(free.find(from), std::string(from).size(), to);
        }
        plants_ = {document_.scene().grammars[0].text, free, kCreeper};
        roofs_ = {document_.scene().grammars[kTown].text, read("roof_hip_slate.grammar")};
        scene::GreyPicture picture{16, 16, std::vector<float>(256)};
        for (float& texel : picture.texels) texel = chance(0, 1);
        file_ = folder.file("import.exr");
        REQUIRE_MESSAGE(writeGrey(file_, picture, editing.error), editing.error);
    }
    Actions any(size_t kind) { return any(kind, std::make_index_sequence<kKinds>()); }
    // Each kind comes as often as any other, in an order by chance.
    Actions next() {
        if (deck_.empty()) {
            deck_.resize(kKinds);
            std::iota(deck_.begin(), deck_.end(), size_t(0));
            std::ranges::shuffle(deck_, random_);
        }
        const size_t kind = deck_.back();
        deck_.pop_back();
        return any(kind);
    }
    uint32_t pick(size_t count) { return uint32_t(random_() % count); }
    float chance(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }

  private:
    template <size_t... I>
    Actions any(size_t kind, std::index_sequence<I...>) {
        Actions made;
        ((kind == I ? void(made = make(std::variant_alternative_t<I, Action>())) : void()), ...);
        return made;
    }
    const scene::Scene& scene() const { return document_.scene(); }
    SeedRecord anySeed() { return document_.recordOf(scene().seeds[pick(scene().seeds.size())]); }

    std::vector<Param> anyParams(uint32_t grammar, bool all) {
        std::vector<Param> params;
        const EspGrammar id = scene().grammars[grammar].id;
        for (uint32_t i = 0; i < espParamCount(editing_.context.get(), id); ++i) {
            EspParamInfo info;
            REQUIRE(espParamInfo(editing_.context.get(), id, i, &info) == ESP_OK);
            Param& param = params.emplace_back(Param{info.name, {}});
            const float high = info.low < 1.2f ? std::min(info.high, 1.2f) : info.high;  // plants stay small
            const bool whole = info.kind == ESP_PARAM_BOOL;
            for (int axis = 0; axis < (info.kind == ESP_PARAM_COLOUR ? 3 : 1); ++axis)
                param.value.push_back(whole ? float(pick(2)) : chance(info.low, high));
        }
        if (all || params.empty()) return params;
        return {params[pick(params.size())]};
    }
    // One, dragged; or a preset.
    Actions make(SetParam) {
        const uint32_t grammar = pick(3);
        Actions made;
        const auto params = anyParams(grammar, pick(3) == 0);
        for (const Param& param : params) made.push_back(SetParam{grammar, param});
        if (params.size() == 1)
            for (const Param& param : anyParams(grammar, true))
                if (param.name == params[0].name) made.push_back(SetParam{grammar, param});
        return made;
    }
    // Typed: sometimes through a mistake, sometimes into one.
    Actions make(SetText) {
        const uint32_t grammar = pick(3);
        const auto& texts = grammar == kTown ? roofs_ : plants_;
        const std::string text = (pick(3) ? "" : "context lichen = 0\n") + texts[pick(texts.size())];
        const auto set = [&](const char* more) {
            SetText action = document_.withText(grammar, text + more);
            for (const Param& param : anyParams(grammar, false)) action.params.push_back(param);
            return action;
        };
        switch (pick(4)) {
            case 0:
                return {set("Unfinished -> Marching(\n")};
            case 1:
                return {set("Unfinished -> \n"), set("")};
            default:
                return {set("")};
        }
    }
    Actions make(AddSeeds) {
        if (scene().seeds.size() > 4) return make(RemoveSeeds());
        AddSeeds add;
        for (uint32_t i = 0, count = 1 + pick(2); i < count; ++i) {
            const uint32_t grammar = pick(2);
            add.seeds.push_back({document_.freshKey(), grammar, {chance(-2, 2), chance(0, 1), 0}, {0, 1, 0}, pick(3)});
            if (pick(3) == 0) add.seeds.back().params = anyParams(grammar, false);
            add.places.push_back(pick(scene().seeds.size() + 1));
        }
        std::ranges::sort(add.places);
        return {add};
    }
    Actions make(RemoveSeeds) {
        if (scene().seeds.empty()) return make(AddSeeds());
        RemoveSeeds remove{{anySeed().key}};
        if (pick(4) == 0)
            for (const auto& seed : scene().seeds)
                if (seed.key != remove.keys[0]) remove.keys.push_back(seed.key);
        return {remove};
    }
    Actions make(ChangeSeeds) {
        if (scene().seeds.empty()) return {};
        SeedRecord seed = anySeed();
        Actions made;
        const uint32_t what = pick(5);
        for (int drag = 0; drag < 3; ++drag) {
            if (what == 0) seed.position[0] = chance(-2, 2);
            if (what == 1) seed.direction = {chance(-1, 1), chance(0, 1), 0};
            if (what == 2) seed.number = pick(3);
            if (what == 3) seed.params = anyParams(seed.grammar, pick(2) == 0);
            if (what == 4) seed.grammar = pick(2);  // what is set of the other's parameters waits
            made.push_back(ChangeSeeds{{seed}});
        }
        return made;
    }
    Actions make(FreezeSeeds) {
        if (scene().seeds.empty()) return {};
        editing_.hash();  // only what has grown can be frozen
        const SeedRecord seed = anySeed();
        if (const auto* known = editing_.document->seed(seed.key); known && known->hidden)
            return {};  // nor what is hidden
        FreezeSeeds freeze{{seed.key}, !seed.frozen};
        if (pick(4) == 0) freeze.keys.push_back(seed.key);
        return {freeze};
    }
    // A branch that a ray meets; or one that was cut comes back.
    Actions make(PruneBranch) {
        uint64_t branch = 0;
        char key[20];
        const bool back = pick(3) == 0 && espPrunedCount(editing_.context.get()) > 0;
        if (back) REQUIRE(espPrunedAt(editing_.context.get(), 0, &branch) == ESP_OK);
        editing_.hash();
        for (int i = 0; i < 300 && !branch; ++i) {
            const float eye[3] = {chance(-2, 2), chance(0, 1.5f), 1}, ahead[3] = {0, 0, -1};
            EspPlantHit hit;
            if (espPickPlant(editing_.context.get(), eye, ahead, &hit) == ESP_OK) branch = hit.branch;
        }
        std::snprintf(key, sizeof key, "%016llx", static_cast<unsigned long long>(branch));
        return branch ? Actions{PruneBranch{key, !back}} : Actions{};
    }
    Actions make(SetLight) {
        Actions drag;
        for (int i = 0; i < 2; ++i) drag.push_back(SetLight{pick(3) ? chance(0, 24) : -1, chance(-1, 1), pick(2) == 0});
        return drag;
    }
    Actions make(SetField) {
        SetField set;
        set.field.name = pick(2) ? "flow" : "lie";
        set.field.lean = chance(0, 3);
        for (size_t i = pick(4); i > 0; --i)
            set.field.elements.push_back(
                {pick(2) ? "regular" : "node", {chance(-2, 2), chance(0, 2), 0}, {chance(-1, 1), 1, 0}, chance(0, 1)});
        set.said = pick(4) > 0;
        return {set};
    }
    Actions make(BrushField) {
        Actions drag;
        BrushField brush{0, pick(2) ? "flow" : "lie", {pick(2) ? "comb" : "smooth", chance(.1f, 1), chance(0, 1), {}}};
        for (size_t i = 1 + pick(3); i > 0; --i) {
            brush.stroke.points = {{chance(-2, 2), chance(0, 2), 0}, {chance(-2, 2), chance(0, 2), 0}};
            drag.push_back(brush);
            brush.goesOn = true;
        }
        return drag;
    }
    Actions make(TrimField) {
        for (const scene::SceneField& field : scene().surfaces[0].fields) {
            if (field.strokes.empty()) continue;
            const uint32_t strokes = pick(field.strokes.size() + 1);
            const size_t points = strokes > 0 ? field.strokes[strokes - 1].points.size() : 0;
            return {TrimField{0, field.name, strokes, uint32_t(points ? pick(points + 1) : 0), pick(4) > 0}};
        }
        return {};
    }
    Actions make(PlaceSurface) {
        return {PlaceSurface{0, {chance(-.3f, .3f), 0, chance(-.3f, .3f)}, chance(-.2f, .2f), 1, chance(0, 1) < .5f}};
    }
    Actions make(SetLook) {
        SetLook look{pick(2), "bark"};
        if (pick(3) > 0) look.colour = {chance(0, 1), chance(0, 1), chance(0, 1)};
        return {look};
    }
    Actions make(SetBookmark) {
        return {SetBookmark{1 + pick(3), pick(3) > 0, {chance(1, 2), 1, chance(1, 2)}, {0, chance(0, 1), 0}}};
    }
    Actions make(ShowPlants) {
        if (scene().seeds.empty()) return {};
        return {ShowPlants{{anySeed().key}, pick(2) == 0}};
    }
    Actions make(ShowSurfaces) { return {ShowSurfaces{{0}, pick(2) == 0}}; }
    // What is locked isn't moved: so it is for a moment only.
    Actions make(LockSurface) { return {LockSurface{0, true}, LockSurface{0, false}}; }
    Actions make(ShowHouses) {
        const uint32_t houses = espHouseCount(document_.context());
        if (!scene().town || houses == 0) return {};
        return {ShowHouses{{pick(houses)}, pick(2) == 0}};
    }
    Actions make(LockHouse) {
        if (!scene().town || espHouseCount(document_.context()) == 0) return {};
        return {LockHouse{0, true}, LockHouse{0, false}};
    }
    Actions make(LockLayer) {
        if (scene().layers.empty()) return {};
        return {LockLayer{scene().layers[0], true}, LockLayer{scene().layers[0], false}};
    }
    Actions make(AddGrammar) {
        if (scene().grammars.size() > kTown + 1) return {};
        return {AddGrammar{content("grammars/ivy_path.grammar")}};
    }
    Actions make(AddGraph) {
        if (scene().graphs.size() > 1) return {};
        return {AddGraph{"some.graph", "graph 1\na = Cube\nb = Twist(a, angle: 0.7)\nc = Sphere\nshow b\n"}};
    }
    Actions make(SetGraphText) {
        if (scene().graphs.empty()) return make(AddGraph());
        const std::string text = "graph 1\na = Cube(cells: " + std::to_string(1 + pick(3)) + ")\nshow a\n";
        return {SetGraphText{0, pick(3) ? text : "graph 1\na = Cu be\n"}};
    }
    // Of a text that is there before, so that nothing of it is refused.
    Actions graphEdit(Action edit) {
        if (scene().graphs.empty()) return make(AddGraph());
        return {SetGraphText{0, "graph 1\na = Cube\nb = Twist(a)\nc = Torus\nshow b\n"}, edit};
    }
    Actions make(AddNodes) { return graphEdit(AddNodes{0, "graph 1\nd = Sphere\n"}); }
    Actions make(RemoveNodes) { return graphEdit(RemoveNodes{0, {pick(2) ? "a" : "b"}, pick(2) == 0}); }
    Actions make(SetNodeInput) { return graphEdit(SetNodeInput{0, "b", "angle", std::to_string(pick(9))}); }
    Actions make(ConnectNodes) { return graphEdit(ConnectNodes{0, "b", "geometry", pick(2) ? "c" : ""}); }
    Actions make(MoveNodes) { return graphEdit(MoveNodes{0, {"a"}, {{chance(0, 100), 7}}}); }
    Actions make(RenameNode) { return graphEdit(RenameNode{0, "a", "cube" + std::to_string(pick(9))}); }
    Actions make(ShowNodes) { return graphEdit(ShowNodes{0, {pick(2) ? "a" : "c"}}); }
    Actions make(MuteNodes) { return graphEdit(MuteNodes{0, {"b"}, pick(3) > 0}); }
    Actions make(SetGraphTime) { return {SetGraphTime{pick(100), 30}}; }
    // Once it is done again, what followed it can't be: it has tests of its own.
    Actions make(AddSurface) { return {}; }
    Actions make(SetWalk) { return {SetWalk{pick(2) ? "paper" : "intrinsic"}}; }
    Actions make(StrokeBegin) {
        const bool town = pick(2);
        StrokeBegin stroke;
        stroke.layer = anyLayer(town);
        stroke.mode = std::array{"paint", "erase", "smooth"}[pick(3)];
        stroke.radius = town ? chance(2, 6) : chance(.1f, .7f);
        stroke.value = chance(0, 1);
        stroke.frontOnly = pick(2);
        EspHouseInfo house;
        REQUIRE(espHouseInfo(editing_.context.get(), pick(2), &house) == ESP_OK);
        Actions made{stroke};
        for (int i = 0; i < 3; ++i) {
            std::array<float, 7> dab{chance(-2, 2), chance(0, 2.5f), 0, 0, 0, 1, chance(.3f, 1)};
            if (town)
                for (int axis : {0, 2}) dab[size_t(axis)] = chance(house.boundsMin[axis], house.boundsMax[axis]);
            made.push_back(StrokeDabs{{dab}});
        }
        made.push_back(StrokeEnd{});
        return made;
    }
    Actions make(FillLayer) { return {FillLayer{anyLayer(pick(2)), chance(0, 1)}}; }
    Actions make(LoadLayer) { return {LoadLayer{anyLayer(false), file_, 0}}; }
    Actions make(LoadTownLayer) { return {LoadTownLayer{anyLayer(true), file_}}; }
    // A corner that is dragged, with another roof over it.
    Actions make(SetHouse) {
        scene::House house = scene::houseNow(editing_.context.get(), pick(2));
        house.shape = scene::nameOf(EspRoofShape(pick(ESP_ROOF_FLAT + 1)));
        house.slope = chance(.5f, 1);
        house.eaveHeight = chance(3, 6);
        const uint32_t edge = pick(house.corners.size());
        house.edges = {{edge, pick(2) ? "gable" : "eave", pick(2) ? chance(.5f, 1) : 0}};
        Actions drag;
        for (int i = 0; i < 2; ++i) {
            for (float& axis : house.corners[edge]) axis += chance(-.4f, .4f);
            drag.push_back(SetHouse{house});
        }
        return drag;
    }
    Actions make(ResetHouse) { return {ResetHouse{pick(2)}}; }
    Actions make(SetCamera) { return {SetCamera{{chance(1, 2), 1, 5}, {0, 1, 0}, .7f}}; }
    Actions make(SetView) { return {SetView{pick(2) ? "lod" : "shaded", ""}}; }
    Actions make(Undo) { return document_.undoSteps() > first_ ? Actions{Undo{}} : Actions{}; }
    Actions make(Redo) { return document_.redoName() ? Actions{Redo{}} : Actions{}; }
    // These belong to others.
    Actions make(StrokeDabs) { return {}; }
    Actions make(StrokeEnd) { return {}; }
    Actions make(SwapStroke) { return {}; }
    Actions make(DropLast) { return {}; }
    Actions make(RestoreFrozen) { return {}; }

    std::string anyLayer(bool town) {
        return town ? kTownLayers[pick(std::size(kTownLayers))] : kWallLayers[pick(std::size(kWallLayers))];
    }

    Editing& editing_;
    Document& document_;
    std::mt19937 random_;
    std::vector<size_t> deck_;  // kinds that come next, the last first
    size_t first_;              // what was done before stays
    std::vector<std::string> plants_, roofs_;
    std::string file_;
};

}  // namespace espalier::document
