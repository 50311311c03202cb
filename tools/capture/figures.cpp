// What pictures don't tell: what grew, on which device, from which files.
#include "tools/capture/figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "tools/scene/hash.hpp"
#include "tools/scene/json_out.hpp"
#include "tools/scene/scene_file.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::capture {
namespace {

using Json = nlohmann::ordered_json;

std::string digits(uint64_t hash) {
    char text[scene::kHashDigits + 1];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

double milliseconds(double value) {
    return std::round(1e3 * value) / 1e3;
}

Json jsonOf(const EspStats& stats) {
    return {{"seeds", stats.seeds},
            {"nodes", stats.nodes},
            {"branches", stats.branches},
            {"leaves", stats.leaves},
            {"polygons", stats.polygons},
            {"ms",
             {{"expand", milliseconds(stats.expandMs)},
              {"emit", milliseconds(stats.emitMs)},
              {"draw", milliseconds(stats.drawMs)}}},
            {"bytes",
             {{"nodes", stats.nodeBytes},
              {"leaves", stats.leafBytes},
              {"chunks", stats.chunkBytes},
              {"surfaces", stats.surfaceBytes},
              {"layers", stats.layerBytes},
              {"total", stats.totalBytes}}},
            {"overflow", stats.overflow},
            {"cut", stats.cut},
            {"stopped", stats.stopped},
            {"enlarged", stats.enlarged},
            {"validation_messages", stats.validationMessages},
            {"hash", digits(stats.hash)}};
}

Json jsonOf(const EspRoofStats& roofs) {
    return {{"houses", roofs.houses}, {"tiles", roofs.tiles},     {"clipped", roofs.clippedTiles},
            {"records", roofs.grids}, {"stopped", roofs.stopped}, {"hash", digits(roofs.hash)}};
}

Json jsonOf(const EspPatternStats& patterns) {
    return {{"seeds", patterns.seeds},   {"pieces", patterns.pieces}, {"tried", patterns.tried},
            {"fallen", patterns.fallen}, {"waves", patterns.waves},   {"hash", digits(patterns.hash)}};
}

}  // namespace

std::vector<Input> inputsOf(const scene::Request& request, const scene::Scene& scene,
                            const std::vector<std::string>& further) {
    std::vector<Input> inputs;
    const auto add = [&](const std::string& file) {
        if (file.empty() || std::ranges::any_of(inputs, [&](const Input& input) { return input.file == file; })) return;
        std::string bytes, unread;
        const bool read = scene::readText(file, bytes, unread, uint64_t(1) << 34);
        inputs.push_back({file, read ? scene::hashName(bytes.data(), bytes.size()) : ""});
    };
    const bool folder = std::filesystem::is_directory(request.file);
    const std::string file =
        folder ? (std::filesystem::path(request.file) / scene::kProjectFile).string() : request.file;
    add(file);
    for (const scene::LoadedSurface& surface : scene.surfaces) add(surface.file);
    for (const scene::LoadedGrammar& grammar : scene.grammars) add(grammar.file);
    if (scene.town) add(scene.town->file);
    add(scene.site);
    add(scene.pieces);
    scene::SceneFile described;
    if (std::string bare; scene::readSceneFile(file, described, bare))
        for (const scene::SceneLayer& layer : described.layers) add(layer.file);
    for (const auto& [layer, picture] : request.layers) add(picture);
    for (const std::string& other : further) add(other);
    return inputs;
}

std::string figuresJson(const EspContext* context, const Figures& figures, const std::vector<Input>& inputs) {
    Json json{{"version", espVersion()}, {"device", espDeviceName(context)}, {"driver", espDriverName(context)}};
    json.update(jsonOf(figures.growth));
    if (figures.roofs.houses > 0) json["roofs"] = jsonOf(figures.roofs);
    if (figures.patterns.seeds > 0) json["patterns"] = jsonOf(figures.patterns);
    json["inputs"] = Json::array();
    for (const Input& input : inputs) json["inputs"].push_back({{"file", input.file}, {"hash", input.hash}});
    return scene::textOf(json) + "\n";
}

}  // namespace espalier::capture
