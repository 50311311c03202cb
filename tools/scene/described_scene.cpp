// A scene's file -> surfaces, grammars, layers in a context, and what to plant and how to look.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "plugin_api/espalier.hpp"
#include "tools/scene/carried.hpp"
#include "tools/scene/layers.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/scene_file.hpp"
#include "tools/scene/scene_parts.hpp"
#include "tools/scene/site.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

// `carried`: the picture has nothing beside its charts.
bool layChannel(EspContext* context, const Scene& scene, const std::string& name, const GreyPicture& picture,
                int surface, bool carried, std::string& error) {
    const bool town = surface == SceneLayer::kTown || (surface < 0 && isTownsAlone(context, scene, name));
    if (town)
        return fromContext(
            context,
            espSetTownLayer(context, name.c_str(), picture.texels.data(), picture.width, picture.height, nullptr),
            error);
    for (size_t i = 0; i < scene.surfaces.size(); ++i) {
        if (surface >= 0 && size_t(surface) != i) continue;
        EspLayerDef def;
        if (!fromContext(context, walkLayer(context, scene.surfaces[i].id, name, picture, def), error)) return false;
        if (surface < 0) def.space = ESP_LAYER_MATERIAL_UV;
        if (carried) def.space = ESP_LAYER_WALK_UV;
        if (!fromContext(context, espSetLayer(context, &def), error)) return false;
    }
    return true;
}

// A project's text may not compile any more, since what it includes lies beside it: it opens with its message, and
// until it is mended nothing grows by it.
bool compileText(EspContext* context, Scene& out, LoadedGrammar& grammar, const std::string& text, std::string& error) {
    if (compile(context, grammar, text, error)) return true;
    std::string unheard;
    if (!out.project || !compile(context, grammar, "Nothing -> Marching(1, 0, arc < 0) {Nothing}\n", unheard))
        return false;
    error.clear();
    if (!setText(context, grammar, text))
        out.notes.push_back("nothing grows by a text with mistakes: " + grammar.error);
    return true;
}

bool loadGrammar(EspContext* context, const SceneGrammar& described, Scene& out, LoadedGrammar& grammar,
                 std::string& error) {
    const bool good = described.text
                          ? compileText(context, out, grammar, described.grows.value_or(*described.text), error)
                          : compileFile(context, grammar, error);
    if (!good) return false;
    // A project may have been saved with a mistake in its text: it stands there with its message, as it was.
    if (described.grows) setText(context, grammar, *described.text);
    for (const SceneParam& param : described.params) {
        const ParamValue& v = param.value;
        if (fromContext(context, espSetParam(context, grammar.id, v.name.c_str(), v.value.data(), v.count), error))
            continue;
        error = param.place + ": " + error;
        if (!out.project) return false;
        if (grammar.error.empty())
            out.notes.push_back(error);
        else
            grammar.unset.push_back(v);
        error.clear();
    }
    return true;
}

// A project opens with what can be read of them, and keeps the others.
bool loadLooks(EspContext* context, const SceneGrammar& described, Scene& out, LoadedGrammar& grammar,
               std::string& error) {
    for (const TerminalLook& look : described.looks) {
        putLook(grammar.looks, look);
        if (setLook(context, grammar.id, look, error)) continue;
        if (!out.project) return false;
        out.notes.push_back(std::exchange(error, {}) + "; '" + look.terminal + "' looks as shipped");
    }
    return true;
}

bool readFrozen(Seed& seed, std::string& error) {
    std::string bytes;
    if (!readText(seed.frozenFile, bytes, error)) return false;
    const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
    seed.frozen = std::make_shared<std::vector<std::byte>>(first, first + bytes.size());
    return true;
}

// Counts the parts of a scene as they come.
class Parts {
  public:
    Parts(const Request& request, size_t count) : told_(request.told), count_(std::max<size_t>(count, 1)) {}
    void begin(const std::string& file) {
        if (told_) told_(std::filesystem::path(file).filename().string(), float(done_) / float(count_));
        ++done_;
    }

  private:
    const std::function<void(const std::string&, float)>& told_;
    size_t done_ = 0, count_;
};

// A project opens without those that can't be read, and keeps their names.
bool readFields(Scene& out, std::vector<SceneField>& fields, std::string& error) {
    for (SceneField& field : fields) {
        if (readGiven(field, error)) continue;
        if (!out.project) return false;
        out.notes.push_back(std::exchange(error, {}) + "; the field '" + field.name + "' is without it");
    }
    return true;
}

bool loadSurfaces(EspContext* context, const SceneFile& file, Parts& parts, Scene& out, std::string& error) {
    for (const SceneSurface& described : file.surfaces) {
        parts.begin(described.file);
        LoadedSurface loaded{described.file, described.placing, described.drawn, {}};
        if (!loadSurface(context, out, loaded, error)) return false;
        LoadedSurface& surface = out.surfaces.emplace_back(std::move(loaded));
        surface.hidden = described.hidden;
        surface.locked = described.locked;
        if (surface.hidden && !fromContext(context, espHideSurface(context, surface.id, 1), error)) return false;
        surface.fields = described.fields;
        if (!readFields(out, surface.fields, error)) return false;
        if (!fromContext(context, setFields(context, surface.id, surface.fields), error)) return false;
    }
    return true;
}

// With the seeds of each, which are planted later.
bool loadGrammars(EspContext* context, const Request& request, const SceneFile& file, Parts& parts, Scene& out,
                  std::string& error) {
    uint32_t number = request.seed.value_or(0);
    for (size_t i = 0; i < file.grammars.size(); ++i) {
        SceneGrammar described = file.grammars[i];
        if (i == 0 && !request.grammar.empty()) {
            described.file = request.grammar;
            described.text.reset();
            described.grows.reset();
        }
        LoadedGrammar grammar;
        grammar.file = described.file;
        parts.begin(grammar.file);
        if (!loadGrammar(context, described, out, grammar, error)) return false;
        if (!loadLooks(context, described, out, grammar, error)) return false;
        out.grammars.push_back(grammar);
        for (Seed seed : described.seeds) {
            seed.grammar = uint32_t(i);
            if (request.seed) seed.number = number++;
            if (!seed.frozenFile.empty() && !readFrozen(seed, error)) {
                if (!out.project) return false;
                out.notes.push_back(std::exchange(error, {}) + "; the plant grows again");
            }
            out.seeds.push_back(seed);
        }
    }
    std::ranges::stable_sort(out.seeds, {}, &Seed::place);
    return true;
}

// What was painted before a grammar's text lost its layer stays in a project. What a scene paints its own grammars are
// to read, but one that takes the place of its first may not.
bool passesOver(const Request& request, Scene& scene, const std::string& layer) {
    if (scene.project || readsLayer(scene, layer)) return false;
    if (request.grammar.empty())
        scene.notes.push_back(request.file + ": no grammar of this scene reads the layer '" + layer + "'");
    return true;
}

// A project has a picture of each surface that has such a layer: what filling makes beside them goes again.
bool keepListed(EspContext* context, const SceneFile& file, const Scene& scene, const std::string& layer,
                std::string& error) {
    if (!scene.project || std::ranges::find(file.layers, layer, &SceneLayer::name) == file.layers.end()) return true;
    for (size_t i = 0; i < scene.surfaces.size(); ++i) {
        const auto lies = [&](const SceneLayer& listed) {
            return listed.name == layer && (listed.surface == int(i) || listed.surface == -1);
        };
        EspLayerDef def = esp::defaults<EspLayerDef>();
        def.surface = scene.surfaces[i].id;
        def.name = layer.c_str();
        if (std::ranges::none_of(file.layers, lies) && !fromContext(context, espSetLayer(context, &def), error))
            return false;
    }
    return true;
}

bool fillLayers(EspContext* context, const Request& request, const SceneFile& file, Scene& out, std::string& error) {
    for (const auto& [name, value] : file.filled) {
        if (passesOver(request, out, name)) continue;
        for (const std::string& layer : out.project ? std::vector{name} : channelsOf(out, name)) {
            EspStroke filled{};
            if (!fromContext(context, espFillLayer(context, layer.c_str(), value, &filled), error)) return false;
            espDestroyStroke(context, filled);
            if (!keepListed(context, file, out, layer, error)) return false;
        }
    }
    return true;
}

bool layLayers(EspContext* context, const Request& request, const SceneFile& file, Parts& parts, Scene& out,
               std::string& error) {
    Carrying carrying;
    for (const SceneLayer& layer : file.layers) {
        parts.begin(layer.file);
        if (passesOver(request, out, layer.name)) continue;
        if (layLayer(context, out, layer, carrying, error)) continue;
        // A project opens with what can be read of it.
        GreyPicture unread;
        std::string why;
        if (!out.project || readGrey(layer.file, unread, why)) return false;
        out.notes.push_back(std::exchange(error, {}) + "; the layer '" + layer.name + "' isn't painted there");
        out.unread.push_back(layer);
    }
    return true;
}

}  // namespace

bool layLayer(EspContext* context, Scene& scene, const SceneLayer& layer, Carrying& carrying, std::string& error) {
    std::vector<GreyPicture> pictures;
    // Projects have what the plugin has: a colour's channels, each by itself.
    const bool colour = !scene.project && isColour(scene, layer.name);
    if (!readChannels(layer.file, colour, pictures, error)) return false;
    if (const uint64_t limited = pictures.front().limited)
        scene.notes.push_back(layer.file + ": values limited to 0 to 1: " + std::to_string(limited));
    const std::vector<std::string> channels = colour ? channelsOf(scene, layer.name) : std::vector{layer.name};
    for (size_t c = 0; c < channels.size(); ++c) {
        std::string note;
        if (layer.square && !moveOver(context, channels[c], *layer.square, pictures[c], error)) return false;
        const bool carried =
            layer.surface >= 0 && carrying.carry(context, scene, channels[c], layer, pictures[c], note);
        if (!layChannel(context, scene, channels[c], pictures[c], layer.surface, carried, error)) return false;
        if (!note.empty()) scene.notes.push_back(note);
    }
    return true;
}

bool openDescription(EspContext* context, const Request& request, Scene& out, std::string& error) {
    SceneFile file;
    if (!readSceneFile(request.file, file, error)) return false;
    out.project = file.project > 0;
    Parts parts(request, file.surfaces.size() + file.grammars.size() + file.layers.size() + file.town.has_value() +
                             !file.site.empty());
    if (!loadSurfaces(context, file, parts, out, error)) return false;
    out.pieces = file.pieces;
    if (!out.pieces.empty() && !fromContext(context, espSetPieces(context, out.pieces.c_str()), error)) return false;
    if (!loadGrammars(context, request, file, parts, out, error)) return false;
    if (!loadGraphs(context, file.graphs, out, error)) return false;
    for (uint64_t branch : file.pruned)
        if (!fromContext(context, espPruneBranch(context, branch, 1), error)) return false;
    out.town = file.town;
    if (out.town) parts.begin(out.town->file);
    if (out.town && !loadTown(context, out, error)) return false;
    out.site = file.site;
    out.grow.walk = file.walk;
    if (!out.site.empty()) parts.begin(out.site);
    if (!out.site.empty() && !furnish(context, out.site, error)) {
        if (!out.project) return false;
        out.notes.push_back(std::exchange(error, {}));
    }
    out.lockedLayers = file.lockedLayers;
    noteLayers(context, out);
    if (!fillLayers(context, request, file, out, error)) return false;
    if (!layLayers(context, request, file, parts, out, error)) return false;
    out.camera = esp::frameAll(context);
    if (file.hasCamera) {
        std::copy(file.eye.begin(), file.eye.end(), out.camera.eye);
        std::copy(file.target.begin(), file.target.end(), out.camera.target);
    }
    out.bookmarks = file.bookmarks;
    std::ranges::sort(out.bookmarks, {}, &Bookmark::digit);
    if (file.fov > 0) out.camera.fovY = fovOfDegrees(file.fov);
    file.applyLook(out.ownLook);
    out.hour = file.hour;
    return true;
}

}  // namespace espalier::scene
