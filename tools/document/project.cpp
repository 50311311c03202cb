// A document -> what is written of it.
#include "tools/document/project.hpp"

#include <algorithm>
#include <set>

#include "tools/scene/carried.hpp"
#include "tools/scene/json_out.hpp"

namespace espalier::document {
namespace {

using scene::SceneFile;
using scene::SceneLayer;

std::array<float, 3> three(const float* v) {
    return {v[0], v[1], v[2]};
}

void describeLook(const scene::Scene& scene, SceneFile& out) {
    const EspLook& own = scene.ownLook;
    out.sunDirection = three(own.sunDirection);
    out.sunColour = three(own.sunColour);
    out.skyColour = three(own.skyColour);
    out.groundColour = three(own.groundColour);
    out.background = three(own.background);
    out.horizon = three(own.horizon);
    out.hour = scene.hour;
    out.exposure = scene.look.exposure;
    out.shadows = scene.look.shadows != 0;
    if (three(own.wind) != std::array<float, 3>{}) out.wind = three(own.wind);
    out.gusts = own.gusts;
    if (own.ground) {
        out.groundLevel = own.groundLevel;
        out.ground = EspGround(own.ground);
    }
    out.groundOvergrows = own.groundOvergrows != 0;
    out.hasCamera = true;
    out.eye = three(scene.camera.eye);
    out.target = three(scene.camera.target);
    out.bookmarks = scene.bookmarks;
    // At its limits it may be written as a neighbour beyond them.
    out.fov = std::clamp(scene::degreesOf(scene.camera.fovY, scene::fovOfDegrees), scene::kLeastFov, scene::kMostFov);
}

// What tells a house from others when the plan has got or lost some; empty: nothing does.
std::string idOf(const EspContext* context, uint32_t house) {
    EspHouseInfo info;
    const std::string id = espHouseInfo(context, house, &info) == ESP_OK ? info.id : "";
    return scene::isUtf8(id) ? id : "";
}

SceneFile describe(const Document& document) {
    const scene::Scene& scene = document.scene();
    SceneFile out;
    out.project = SceneFile::kProjectVersion;
    for (const scene::LoadedSurface& surface : scene.surfaces)
        out.surfaces.push_back(
            {surface.file, surface.placing, surface.drawn, surface.fields, surface.hidden, surface.locked});
    // Their order tells seeds of one number apart, whichever grammars they are of.
    const bool mixed = !std::ranges::is_sorted(scene.seeds, {}, &scene::Seed::grammar);
    for (size_t i = 0; i < scene.grammars.size(); ++i) {
        const scene::LoadedGrammar& grammar = scene.grammars[i];
        scene::SceneGrammar& described = out.grammars.emplace_back();
        described.file = grammar.file;
        described.text = grammar.text;
        if (grammar.text != grammar.grows) described.grows = grammar.grows;
        for (const scene::ParamValue& value : scene::changedParams(document.context(), grammar.id))
            described.params.push_back({value, {}});
        described.looks = grammar.looks;
        for (const scene::ParamValue& value : grammar.unset) described.params.push_back({value, {}});
        for (uint32_t place = 0; place < scene.seeds.size(); ++place) {
            if (scene.seeds[place].grammar != i) continue;
            scene::Seed& seed = described.seeds.emplace_back(scene.seeds[place]);
            const auto unread = scene.unreadPlants.find(seed.key);
            seed.frozenFile = unread != scene.unreadPlants.end() ? unread->second : "";
            seed.place = mixed ? place : 0;
        }
    }
    out.town = scene.town;
    if (out.town) {
        for (scene::House& house : out.town->houses) house.id = idOf(document.context(), house.index);
        for (scene::HouseMark& mark : out.town->marks) mark.id = idOf(document.context(), mark.index);
    }
    out.lockedLayers = scene.lockedLayers;
    out.site = scene.site;
    out.pieces = scene.pieces;
    for (const scene::LoadedGraph& graph : scene.graphs) {
        out.graphs.push_back({graph.file, graph.text});
        if (graph.text != graph.runs) out.graphs.back().runs = graph.runs;
    }
    out.walk = scene.grow.walk;
    out.pruned.resize(espPrunedCount(document.context()));
    for (uint32_t i = 0; i < out.pruned.size(); ++i) (void)espPrunedAt(document.context(), i, &out.pruned[i]);
    describeLook(scene, out);
    return out;
}

// Where layers are painted. A picture that couldn't be read stays what it is until something is painted in its place.
void outlineLayers(const Document& document, ProjectData& out) {
    EspContext* context = document.context();
    const scene::Scene& scene = document.scene();
    out.file.layers = scene.unread;
    std::set<std::string> names;
    const auto add = [&](const std::string& name, int surface) {
        const auto waits = [&](const SceneLayer& unread) { return unread.name == name && unread.surface == surface; };
        if (std::ranges::none_of(scene.unread, waits)) out.layers.push_back({name, surface, {}});
        names.insert(name);
    };
    for (uint32_t i = 0; i < espPaintedLayerCount(context); ++i)
        for (size_t surface = 0; surface < scene.surfaces.size(); ++surface)
            if (const char* name = espPaintedLayerName(context, i);
                espLayerPainted(context, scene.surfaces[surface].id, name))
                add(name, int(surface));
    for (uint32_t i = 0; i < espTownLayerCount(context); ++i) add(espTownLayerName(context, i), SceneLayer::kTown);
    for (const SceneLayer& unread : scene.unread) names.insert(unread.name);
    std::ranges::stable_sort(out.layers, {}, &ProjectData::Layer::name);  // not by when each was painted
    for (const std::string& name : names)
        if (float value; espLayerFilled(context, name.c_str(), &value)) out.file.filled.push_back({name, value});
}

// All but the layers' texels.
ProjectData outline(const Document& document) {
    ProjectData out;
    out.file = describe(document);
    out.history = document.filesOfHistory();
    EspContext* context = document.context();
    out.square = scene::squareOf(context);
    for (const scene::LoadedSurface& surface : document.scene().surfaces)
        out.bakes.push_back({scene::keptName(context, surface.id), surface.kept});
    outlineLayers(document, out);
    return out;
}

bool read(const Document& document, ProjectData::Layer& layer, std::string& error) {
    if (layer.surface == SceneLayer::kTown) return document.readTownLayer(layer.name, layer.picture, error);
    return document.readLayer(size_t(layer.surface), layer.name, layer.picture, error);
}

using Write = bool (*)(ProjectData, const std::string& folder, Progress&, std::string& error);

Work::Plan writing(const Document& document, const std::string& folder, Write write) {
    Work::Plan plan;
    const auto data = std::make_shared<ProjectData>(outline(document));
    for (ProjectData::Layer& layer : data->layers)
        plan.before.push_back([&document, &layer](std::string& error) { return read(document, layer, error); });
    plan.beside = [data, folder, write](Progress& progress, std::string& error) {
        return write(std::move(*data), folder, progress, error);
    };
    return plan;
}

}  // namespace

bool gather(const Document& document, ProjectData& out, std::string& error) {
    out = outline(document);
    return std::ranges::all_of(out.layers, [&](ProjectData::Layer& layer) { return read(document, layer, error); });
}

Work::Plan saving(const Document& document, const std::string& folder) {
    return writing(document, folder, writeProject);
}

bool saveProject(const Document& document, const std::string& folder, std::string& error) {
    return Work(saving(document, folder)).finish(error);
}

Work::Plan autosaving(const Document& document, const std::string& folder) {
    return writing(document, folder, writeAutosave);
}

bool autosave(const Document& document, const std::string& folder, std::string& error) {
    return Work(autosaving(document, folder)).finish(error);
}

}  // namespace espalier::document
