// The user's own files: layout and presets, each a small JSON.
#include "sample_game/settings.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "tools/document/durable.hpp"
#include "tools/document/fields.hpp"
#include "tools/scene/text_file.hpp"
#include "tools/scene/user_folders.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using namespace espalier;

// As this version or another has written it.
struct LayoutRecord {
    static constexpr bool kWhole = false;
    Layout layout;
    Brush brush;
    template <class V>
    void fields(V&& v) {
        v("panel", layout.panel), v("figures", layout.figures), v("grammar", layout.grammar);
        v("atlas", layout.atlas), v("layer_opacity", layout.layerOpacity);
        v("panel_width", layout.panelWidth), v("size", layout.sizeOfAll),
            v("smaller_while_moving", layout.smallerWhileMoving);
        v("window_width", layout.windowWidth), v("window_height", layout.windowHeight);
        v("maximised", layout.maximised), v("row_step", layout.rowStep), v("row_along", layout.rowAlong);
        v("recent", layout.recent);
        v("radius", brush.radius), v("strength", brush.strength), v("hardness", brush.hardness);
        v("spacing", brush.spacing), v("town_radius", brush.townRadius);
    }
};

struct Preset {
    static constexpr bool kWhole = true;
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
    return document::writeTextDurably(path, scene::textOf(json, 1) + "\n", error);
}

// Reads what is there, and passes over all else.
struct PartReader {
    document::FieldReader& reader;
    const scene::Json& json;
    template <class T>
    void operator()(const char* name, T& value) {
        if (json.find(name)) reader(name, value);
    }
};

template <class Record>
bool read(const std::string& path, Record& record, std::string& error) {
    std::string text;
    scene::Json json;
    error.clear();
    if (!scene::readText(path, text, error)) return false;
    if (scene::readJson(text, json, error)) {
        document::FieldReader reader(json, error);
        if (json.kind != scene::Json::Kind::object)
            error = "1:1: this isn't an object";
        else if constexpr (Record::kWhole)
            record.fields(reader), reader.end();
        else
            record.fields(PartReader{reader, json});
    }
    if (!error.empty()) error = path + ":" + error;
    return error.empty();
}

constexpr const char* kKept = ".json";
constexpr const char* kRemoved = ".removed";
constexpr const char* kPicture = ".png";

fs::path presetFolder(const std::string& grammar) {
    return espalier::scene::configFolder() + "/presets/" + grammar;
}

fs::path presetFile(const std::string& grammar, const std::string& name, const char* extension = kKept) {
    return presetFolder(grammar) / (presetCalled(name) + extension);
}

// Stems of the files that end so.
std::vector<std::string> namesIn(const fs::path& folder, const char* extension) {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (entry.path().extension() == extension) names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::vector<std::string> presetsWith(const std::string& grammar, const char* extension) {
    return espalier::scene::configFolder().empty() ? std::vector<std::string>{}
                                                   : namesIn(presetFolder(grammar), extension);
}

// Beside the grammar that they come with.
fs::path shippedFolder(const std::string& grammarFile) {
    return fs::path(grammarFile).parent_path() / "presets" / presetsOf(grammarFile);
}

bool readParams(const fs::path& file, std::vector<document::Param>& params, std::string& error) {
    Preset preset;
    if (!read(file.string(), preset, error)) return false;
    params = std::move(preset.params);
    return true;
}

// With a preset that has one; in place of any that is there.
void movePicture(const std::string& grammar, const std::string& name, const std::string& wanted) {
    std::error_code none;
    fs::rename(presetPicture(grammar, name), presetPicture(grammar, wanted), none);
}

bool moveFile(const fs::path& from, const fs::path& to, std::string& error) {
    std::error_code code;
    if (fs::exists(to, code)) {
        error = to.string() + ": is there already";
        return false;
    }
    fs::rename(from, to, code);
    if (code) error = from.string() + ": " + code.message();
    return !code;
}

}  // namespace

void readLayout(Layout& layout, Brush& brush, std::string& error) {
    LayoutRecord record{layout, brush};
    const std::string file = espalier::scene::configFolder() + "/layout.json";
    std::error_code code;
    if (espalier::scene::configFolder().empty() || !fs::exists(file, code)) return;
    if (!read(file, record, error)) {
        fs::remove(file + ".damaged", code);  // a link, too, and not what it leads to
        fs::copy_file(file, file + ".damaged", code);
        error += "; panels are as in the beginning, and it is kept as " + file + ".damaged";
        return;
    }
    layout = record.layout;
    layout.panelWidth = std::clamp(layout.panelWidth, kLeastPanel, kMostPanel);
    layout.layerOpacity = std::clamp(layout.layerOpacity, .05f, 1.f);
    layout.sizeOfAll = std::clamp(layout.sizeOfAll, .5f, 3.f);
    layout.rowStep = std::clamp(layout.rowStep, kLeastRowStep, kMostRowStep);
    for (uint32_t* side : {&layout.windowWidth, &layout.windowHeight}) *side = std::min(*side, 16384u);
    brush.radius = std::clamp(record.brush.radius, kSmallestBrush, kLargestBrush);
    brush.townRadius = std::clamp(record.brush.townRadius, kSmallestBrush, kLargestBrush);
    brush.strength = std::clamp(record.brush.strength, .01f, 1.f);
    brush.hardness = std::clamp(record.brush.hardness, 0.f, 1.f);
    brush.spacing = std::clamp(record.brush.spacing, .05f, 1.f);
}

void writeLayout(const Layout& layout, const Brush& brush) {
    std::string ignored;
    if (!espalier::scene::configFolder().empty())
        write(espalier::scene::configFolder() + "/layout.json", LayoutRecord{layout, brush}, ignored);
}

std::string presetsOf(const std::string& grammarFile) {
    return fs::path(grammarFile).stem().string();
}

// It can't lead elsewhere.
std::string presetCalled(std::string wanted) {
    std::replace(wanted.begin(), wanted.end(), '/', '-');
    return wanted;
}

std::vector<std::string> presetNames(const std::string& grammar) {
    return presetsWith(grammar, kKept);
}

bool readPreset(const std::string& grammar, const std::string& name, std::vector<document::Param>& params,
                std::string& error) {
    return readParams(presetFile(grammar, name), params, error);
}

std::vector<std::string> shippedPresets(const std::string& grammarFile) {
    return namesIn(shippedFolder(grammarFile), kKept);
}

bool readShippedPreset(const std::string& grammarFile, const std::string& name, std::vector<document::Param>& params,
                       std::string& error) {
    return readParams(shippedFolder(grammarFile) / (name + kKept), params, error);
}

bool writePreset(const std::string& grammar, const std::string& name, const std::vector<document::Param>& params,
                 std::string& error) {
    if (espalier::scene::configFolder().empty()) {
        error = "neither XDG_CONFIG_HOME nor HOME is set: there is no place for presets";
        return false;
    }
    if (!write(presetFile(grammar, name).string(), Preset{params}, error)) return false;
    std::error_code none;
    fs::remove(presetPicture(grammar, name), none);
    return true;
}

std::string presetPicture(const std::string& grammar, const std::string& name) {
    return presetFile(grammar, name, kPicture).string();
}

std::string shippedPresetPicture(const std::string& grammarFile, const std::string& name) {
    return (shippedFolder(grammarFile) / (name + kPicture)).string();
}

bool renamePreset(const std::string& grammar, const std::string& name, const std::string& wanted, std::string& error) {
    const fs::path from = presetFile(grammar, name), to = presetFile(grammar, wanted);
    if (from == to) return true;
    if (!moveFile(from, to, error)) return false;
    movePicture(grammar, name, wanted);
    return true;
}

bool removePreset(const std::string& grammar, const std::string& name, std::string& error) {
    const fs::path from = presetFile(grammar, name), to = presetFile(grammar, name, kRemoved);
    std::error_code code;
    fs::rename(from, to, code);
    if (code) error = from.string() + ": " + code.message();
    if (code) return false;
    for (const std::string& before : presetsWith(grammar, kRemoved))
        if (const fs::path file = presetFile(grammar, before, kRemoved); file != to) {
            fs::remove(file, code);
            if (!fs::exists(presetFile(grammar, before), code)) fs::remove(presetPicture(grammar, before), code);
        }
    return true;
}

std::string removedPreset(const std::string& grammar) {
    const std::vector<std::string> names = presetsWith(grammar, kRemoved);
    return names.empty() ? "" : names.back();
}

bool restorePreset(const std::string& grammar, std::string& error) {
    const std::string name = removedPreset(grammar);
    return moveFile(presetFile(grammar, name, kRemoved), presetFile(grammar, name), error);
}

}  // namespace sample
