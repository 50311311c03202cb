// Actions -> the words for them in menus: what is changed, by how the document is before it.
#include <algorithm>
#include <filesystem>

#include "tools/document/document.hpp"
#include "tools/scene/param_words.hpp"

namespace espalier::document {
namespace {

using Name = std::string;

Name counted(size_t count, const char* one, const char* several) {
    return count == 1 ? one : std::to_string(count) + " " + several;
}
Name listed(const std::vector<std::string>& nodes) {
    return counted(nodes.size(), nodes.empty() ? "" : nodes[0].c_str(), "nodes");
}
Name seeds(size_t count) {
    return counted(count, "a seed", "seeds");
}

// What is asked for of seeds, all of whom it is asked for.
Name changeOf(const Document& document, const std::vector<SeedRecord>& wanted) {
    struct {
        bool moved = false, turned = false, numbered = false, planted = false, valued = false;
    } by;
    for (const SeedRecord& seed : wanted) {
        const scene::Seed* known = document.seed(seed.key);
        if (!known) continue;
        const SeedRecord before = document.recordOf(*known);
        by.moved |= seed.position != before.position;
        by.turned |= seed.direction != before.direction;
        by.numbered |= seed.number != before.number;
        by.planted |= seed.grammar != before.grammar;
        by.valued |= seed.params != before.params;
    }
    const char* what = by.planted    ? "Grammar of "
                       : by.valued   ? "Values of "
                       : by.numbered ? "Random number of "
                       : by.moved    ? "Move "
                       : by.turned   ? "Turn "
                                     : "Change ";
    return what + seeds(wanted.size());
}

Name houseName(const EspContext* context, uint32_t house) {
    EspHouseInfo info;
    const bool named = espHouseInfo(context, house, &info) == ESP_OK && info.id[0];
    return "house " + (named ? info.id : std::to_string(house + 1));
}

const char* changeOf(const scene::House& before, const scene::House& now) {
    if (now.corners.size() > before.corners.size()) return "New corner";
    if (!now.corners.empty() && now.corners.size() < before.corners.size()) return "Corner removed";
    if (now.shape != before.shape) return "Roof kind";
    if (now.slope != before.slope) return "Pitch";
    if (now.eaveHeight != before.eaveHeight) return "Walls";
    if (now.edges != before.edges) return "Edge";
    if (!now.corners.empty() && now.corners != before.corners) return "Corner";
    if (!now.look || !before.look || *now.look == *before.look) return "Roof";
    if (now.look->covering != before.look->covering) return "Covering";
    if (now.look->colour != before.look->colour) return "Colour";
    return now.look->overhang != before.look->overhang ? "Overhang" : "Chimneys";
}

struct Names {
    const Document& document;

    Name ofGrammar(uint32_t grammar) const {
        return grammar < document.scene().grammars.size() ? grammarName(document.scene(), grammar) : "a grammar";
    }
    Name labelOf(const SetParam& set) const {
        const EspGrammar grammar = document.scene().grammars[set.grammar].id;
        for (uint32_t i = 0; i < espParamCount(document.context(), grammar); ++i)
            if (EspParamInfo info; espParamInfo(document.context(), grammar, i, &info) == ESP_OK &&
                                   info.name == set.param.name && info.label[0])
                return scene::paramWords(info.label).name;
        return set.param.name;
    }

    scene::SceneField fieldOf(uint32_t surface, const std::string& name) const {
        const auto& surfaces = document.scene().surfaces;
        if (surface < surfaces.size())
            for (const scene::SceneField& field : surfaces[surface].fields)
                if (field.name == name) return field;
        return {};
    }

    Name operator()(const SetParam& a) const {
        if (a.grammar >= document.scene().grammars.size()) return a.param.name;
        return labelOf(a) + (document.scene().grammars.size() > 1 ? " (" + ofGrammar(a.grammar) + ")" : "");
    }
    Name operator()(const SetText& a) const { return kEditText + (" of " + ofGrammar(a.grammar)); }
    Name operator()(const AddSeeds& a) const { return "Plant " + seeds(a.seeds.size()); }
    Name operator()(const RemoveSeeds& a) const { return "Remove " + seeds(a.keys.size()); }
    Name operator()(const ChangeSeeds& a) const { return changeOf(document, a.seeds); }
    Name operator()(const SetLight& a) const {
        const scene::Scene& scene = document.scene();
        if (a.hour != scene.hour) return a.hour == scene::kOwnSun ? "The scene's own light" : "Time of the day";
        return a.exposure != scene.look.exposure ? "Exposure" : "Shadows";
    }
    Name operator()(const SetWalk&) const { return "Walk otherwise"; }
    Name operator()(const StrokeBegin& a) const {
        return (a.mode == "erase" ? "Erase " : a.mode == "smooth" ? "Smooth " : "Paint ") + a.layer;
    }
    Name operator()(const FillLayer& a) const {
        return (a.value == 0 && a.colour.empty() ? "Clear " : "Fill ") + a.layer;
    }
    Name operator()(const LoadLayer& a) const { return "Import " + a.layer; }
    Name operator()(const LoadTownLayer& a) const { return "Import " + a.layer; }
    Name operator()(const FreezeSeeds& a) const {
        return (a.frozen ? "Freeze " : "Thaw ") + counted(a.keys.size(), "a plant", "plants");
    }
    Name operator()(const PruneBranch& a) const { return a.pruned ? "Prune" : "Let a branch grow again"; }
    Name operator()(const SetHouse& a) const {
        const scene::House before = scene::houseNow(document.context(), a.house.index);
        return changeOf(before, a.house) + (" of " + houseName(document.context(), a.house.index));
    }
    Name operator()(const SetField& a) const {
        const scene::SceneField before = fieldOf(a.surface, a.field.name);
        if (a.field.file != before.file)
            return a.field.file.empty() ? "No file for " + a.field.name : "Load " + scene::lastPart(a.field.file);
        const size_t had = before.elements.size(), has = a.field.elements.size();
        return (has > had ? "New element of " : has < had ? "Remove elements of " : "Change ") + a.field.name;
    }
    Name operator()(const BrushField& a) const { return (a.stroke.brush == "smooth" ? "Smooth " : "Comb ") + a.field; }
    Name operator()(const TrimField& a) const { return "Remove strokes of " + a.field; }
    Name operator()(const AddSurface& a) const { return "Add " + scene::lastPart(a.file); }
    Name operator()(const PlaceSurface& a) const {
        const auto& surfaces = document.scene().surfaces;
        return "Move " + (a.surface < surfaces.size() ? scene::lastPart(surfaces[a.surface].file) : "a model");
    }
    Name operator()(const AddGrammar& a) const { return "Add " + scene::lastPart(a.file); }
    Name operator()(const AddGraph& a) const { return "Add " + scene::lastPart(a.file); }
    Name operator()(const SetGraphText&) const { return kEditGraph; }
    Name operator()(const AddNodes& a) const {
        GraphModel added;
        std::string ignored;
        if (!added.read(document.context(), a.text, "", ignored) || added.nodes.empty()) return "Add nodes";
        return "Add " + counted(added.nodes.size(), added.nodes[0].kind.c_str(), "nodes");
    }
    Name operator()(const RemoveNodes& a) const { return "Remove " + listed(a.nodes); }
    Name operator()(const SetNodeInput& a) const { return a.input + " of " + a.node; }
    Name operator()(const ConnectNodes& a) const {
        return (a.wire.empty() ? "Unplug " : "Wire " + a.wire + " to ") + a.node + "." + a.input;
    }
    Name operator()(const MoveNodes& a) const { return "Move " + listed(a.nodes); }
    Name operator()(const RenameNode& a) const { return "Rename " + a.node; }
    Name operator()(const ShowNodes& a) const { return a.nodes.empty() ? "Show nothing" : "Show " + listed(a.nodes); }
    Name operator()(const MuteNodes& a) const { return (a.muted ? "Mute " : "Unmute ") + listed(a.nodes); }
    Name operator()(const ShowPlants& a) const {
        return (a.shown ? "Show " : "Hide ") + counted(a.keys.size(), "a plant", "plants");
    }
    Name operator()(const ShowSurfaces& a) const {
        return (a.shown ? "Show " : "Hide ") + counted(a.surfaces.size(), "a model", "models");
    }
    Name operator()(const LockSurface& a) const { return a.locked ? "Lock a model" : "Unlock a model"; }
    Name operator()(const ShowHouses& a) const {
        return (a.shown ? "Show " : "Hide ") + counted(a.houses.size(), "a house", "houses");
    }
    Name operator()(const LockHouse& a) const {
        return (a.locked ? "Lock " : "Unlock ") + houseName(document.context(), a.house);
    }
    Name operator()(const LockLayer& a) const { return (a.locked ? "Lock " : "Unlock ") + a.layer; }
    Name operator()(const SetBookmark& a) const {
        return (a.kept ? "Bookmark " : "Remove bookmark ") + std::to_string(a.digit);
    }
    Name operator()(const SetLook& a) const { return "Look of " + a.terminal + " (" + ofGrammar(a.grammar) + ")"; }
    Name operator()(const ResetHouse& a) const { return "As planned: " + houseName(document.context(), a.house); }
    // Those that begin no step.
    template <class Other>
    Name operator()(const Other&) const {
        return Other::kName;
    }
};

}  // namespace

std::string grammarName(const scene::Scene& scene, size_t index) {
    const std::string& file = scene.grammars[index].file;
    const auto upTo = scene.grammars.begin() + std::ptrdiff_t(index);
    const auto before = std::count_if(scene.grammars.begin(), upTo, [&](const auto& g) { return g.file == file; });
    const std::string name = std::filesystem::path(file).stem().string();
    return before ? name + " (" + std::to_string(before + 1) + ")" : name;
}

std::string nameOf(const Document& document, const Action& action) {
    return std::visit(Names{document}, action);
}

std::string plantingName(const std::vector<Action>& back) {
    size_t count = 0;
    for (const Action& action : back)
        if (const auto* removal = std::get_if<RemoveSeeds>(&action)) count += removal->keys.size();
    return "Plant " + seeds(count);
}

}  // namespace espalier::document
