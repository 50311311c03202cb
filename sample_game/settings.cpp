// The user's own files: layout and presets, each a small JSON.
#include "sample_game/settings.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "tools/document/durable.hpp"
#include "tools/document/fields.hpp"
#include "tools/scene/picture.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using namespace espalier;

std::string below(const char* variable, const char* inHome) {
    if (const char* folder = std::getenv(variable); folder && *folder) return std::string(folder) + "/espalier";
    if (const char* home = std::getenv("HOME"); home && *home) return std::string(home) + inHome + "/espalier";
    return {};
}

struct LayoutRecord {
    Layout layout;
    Brush brush;
    template <class V>
    void fields(V&& v) {
        v("panel", layout.panel), v("figures", layout.figures), v("grammar", layout.grammar);
        v("atlas", layout.atlas), v("layer_opacity", layout.layerOpacity);
        v("panel_width", layout.panelWidth), v("size", layout.sizeOfAll),
            v("half_while_moving", layout.halfWhileMoving);
        v("radius", brush.radius), v("strength", brush.strength), v("hardness", brush.hardness);
        v("spacing", brush.spacing), v("town_radius", brush.townRadius);
    }
};

struct Preset {
    std::vector<document::Param> params;
    template <class V>
    void fields(V&& v) {
        v("params", params);
    }
};

template <class Record>
bool write(const std::string& path, Record record, std::string& error) {
    std::error_code code;
    fs::create_directories(fs::path(path).parent_path(), code);
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    record.fields(document::FieldWriter(json));
    return document::writeTextDurably(path, json.dump(1) + "\n", error);
}

template <class Record>
bool read(const std::string& path, Record& record, std::string& error) {
    std::string text;
    scene::Json json;
    if (!scene::readText(path, text, error)) return false;
    if (scene::readJson(text, json, error)) {
        document::FieldReader reader(json, error);
        record.fields(reader);
        reader.end();
    }
    if (!error.empty()) error = path + ":" + error;
    return error.empty();
}

std::string presetFolder(const std::string& grammar) {
    return configFolder() + "/presets/" + grammar;
}

}  // namespace

std::string configFolder() {
    return below("XDG_CONFIG_HOME", "/.config");
}
std::string cacheFolder() {
    return below("XDG_CACHE_HOME", "/.cache");
}

void readLayout(Layout& layout, Brush& brush) {
    LayoutRecord record{layout, brush};
    std::string ignored;
    if (configFolder().empty() || !read(configFolder() + "/layout.json", record, ignored)) return;
    layout = record.layout;
    layout.panelWidth = std::clamp(layout.panelWidth, 200.f, 800.f);
    layout.layerOpacity = std::clamp(layout.layerOpacity, .05f, 1.f);
    layout.sizeOfAll = std::clamp(layout.sizeOfAll, .5f, 3.f);
    brush.radius = std::clamp(record.brush.radius, .005f, 20.f);
    brush.townRadius = std::clamp(record.brush.townRadius, .005f, 20.f);
    brush.strength = std::clamp(record.brush.strength, .01f, 1.f);
    brush.hardness = std::clamp(record.brush.hardness, 0.f, 1.f);
    brush.spacing = std::clamp(record.brush.spacing, .05f, 1.f);
}

void writeLayout(const Layout& layout, const Brush& brush) {
    std::string ignored;
    if (!configFolder().empty()) write(configFolder() + "/layout.json", LayoutRecord{layout, brush}, ignored);
}

std::vector<std::string> presetNames(const std::string& grammar) {
    std::vector<std::string> names;
    std::error_code ignored;
    if (configFolder().empty()) return names;
    for (const auto& entry : fs::directory_iterator(presetFolder(grammar), ignored))
        if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

bool readPreset(const std::string& grammar, const std::string& name, std::vector<document::Param>& params,
                std::string& error) {
    Preset preset;
    if (!read(presetFolder(grammar) + "/" + name + ".json", preset, error)) return false;
    params = preset.params;
    return true;
}

bool writePreset(const std::string& grammar, const std::string& name, const std::vector<document::Param>& params,
                 std::string& error) {
    if (configFolder().empty()) {
        error = "neither XDG_CONFIG_HOME nor HOME is set: there is no place for presets";
        return false;
    }
    std::string file = name;
    std::replace(file.begin(), file.end(), '/', '-');
    return write(presetFolder(grammar) + "/" + file + ".json", Preset{params}, error);
}

}  // namespace sample
