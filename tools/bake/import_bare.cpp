// In: a model whose transparent materials are marked, and patterns of names. Out: the materials on which nothing grows.
#include <fnmatch.h>

#include <algorithm>

#include "tools/bake/import.hpp"

namespace espalier::import {
namespace {

bool matches(const std::string& pattern, const std::string& name) {
    return ::fnmatch(pattern.c_str(), name.c_str(), FNM_CASEFOLD) == 0;
}

void warn(Model& model, std::string text) {
    model.warnings.push_back({model.name, 0, 0, {}, std::move(text), true});
}

std::string listOf(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names)
        if (!name.empty()) list += (list.empty() ? "" : ", ") + name;
    return list.empty() ? "none with a name" : list;
}

// Sets what the patterns name; one that names nothing is told of.
void setNamed(const std::vector<std::string>& patterns, bool bare, const char* option, Model& model) {
    for (const std::string& pattern : patterns) {
        bool any = false;
        for (size_t m = 0; m < model.materialNames.size(); ++m)
            if (matches(pattern, model.materialNames[m])) model.materials[m].bare = bare, any = true;
        if (!any)
            warn(model, std::string(option) + " '" + pattern +
                            "' names none of its materials: " + listOf(model.materialNames));
    }
}

}  // namespace

void decideBare(const ImportOptions& options, Model& model) {
    // A model of glass throughout is one to grow on.
    std::vector<uint8_t> used(model.materials.size(), model.triangleMaterial.empty());
    for (uint32_t m : model.triangleMaterial) used[m] = 1;
    bool opaque = false;
    for (size_t m = 0; m < used.size(); ++m) opaque = opaque || (used[m] && !model.materials[m].bare);
    if (!opaque)
        for (Material& m : model.materials) m.bare = false;
    setNamed(options.bare, true, "--bare", model);
    setNamed(options.ground, false, "--ground", model);
}

}  // namespace espalier::import
