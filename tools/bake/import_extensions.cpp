// In: a document's text. Out: whether its extensions leave a model that can be read, and which of them aren't.
#include <algorithm>
#include <array>

#include "tools/bake/import_gltf.hpp"

namespace espalier::import {
namespace {

using nlohmann::json;

bool isRead(const std::string& name) {
    static constexpr std::array kRead = {"KHR_draco_mesh_compression",
                                         "KHR_mesh_quantization",
                                         "EXT_meshopt_compression",
                                         "EXT_mesh_gpu_instancing",
                                         "KHR_node_visibility",
                                         "KHR_texture_transform",
                                         "KHR_materials_pbrSpecularGlossiness",
                                         "KHR_materials_emissive_strength",
                                         "KHR_materials_transmission",
                                         "ESPALIER_surface"};
    return std::ranges::find(kRead, name) != kRead.end();
}

bool beginsWithOneOf(const std::string& name, std::initializer_list<const char*> beginnings) {
    return std::ranges::any_of(beginnings, [&](const char* beginning) { return name.starts_with(beginning); });
}

// Where a picture's bytes are; the pictures tell of these by themselves.
bool isCodec(const std::string& name) {
    return beginsWithOneOf(name, {"EXT_texture_", "KHR_texture_basisu", "MSFT_texture_dds"});
}

bool isLook(const std::string& name) {
    return beginsWithOneOf(name, {"KHR_materials_", "EXT_materials_", "KHR_texture_", "EXT_texture_"});
}

// Tells nothing of a surface at rest.
bool isElsewhere(const std::string& name) {
    return beginsWithOneOf(name, {"KHR_lights_", "EXT_lights_", "KHR_animation_", "KHR_xmp"});
}

std::vector<std::string> namesIn(const json& root, const char* key) {
    std::vector<std::string> names;
    auto list = root.find(key);
    if (list == root.end() || !list->is_array()) return names;
    for (const json& name : *list)
        if (name.is_string() && std::ranges::find(names, name.get<std::string>()) == names.end())
            names.push_back(name.get<std::string>());
    return names;
}

}  // namespace

Status judgeExtensions(const json& root, Document& document) {
    const std::vector<std::string> required = namesIn(root, "extensionsRequired");
    for (const std::string& name : required)
        if (!isRead(name) && !isLook(name) && !isCodec(name) && !isElsewhere(name))
            return Failure(document.path, "extensionsRequired: " + name + " is not supported");
    std::vector<std::string> used = namesIn(root, "extensionsUsed");
    for (const std::string& name : required)
        if (std::ranges::find(used, name) == used.end()) used.push_back(name);
    for (const std::string& name : used) {
        const bool asked = std::ranges::find(required, name) != required.end();
        if (isRead(name) || isCodec(name)) continue;
        if (isLook(name))
            document.remarks.push_back(name + " is not read: the model may look different, its shape is the same");
        else if (asked)
            document.remarks.push_back(name + " is not read, though the model requires it: its shape is the same");
    }
    return Done{};
}

}  // namespace espalier::import
