#pragma once

// The library's grammars of roofs, and the meshes that the content tool makes for them.

#include <doctest/doctest.h>

#include <filesystem>

#include "runtime/roof_growth/roof_growth.hpp"
#include "tools/content/roof_mesh.hpp"

namespace roof_test {

using namespace espalier;

inline const std::filesystem::path kGrammars = "content/grammars";

// What a grammar may name, and the bounds of each.
struct Meshes {
    std::vector<TerminalMesh> names;
    std::vector<RoofMesh> bounds;
    Meshes() {
        for (const auto& e : content::makeRoofMeshes().all) {
            if (!e.name.ends_with("_lod0")) continue;
            names.push_back({e.name.substr(0, e.name.find('_')), false});
            RoofMesh b{glm::vec3(1e9f), glm::vec3(-1e9f)};
            for (glm::vec3 p : e.mesh.positions) b.low = glm::min(b.low, p), b.high = glm::max(b.high, p);
            bounds.push_back(b);
        }
    }
    uint32_t number(const std::string& name) const {
        for (uint32_t i = 0; i < names.size(); ++i)
            if (names[i].name == name) return i;
        FAIL("there is no mesh " << name);
        return 0;
    }
};

inline Result<RuleMap> compiled(const std::filesystem::path& file, const Meshes& meshes) {
    CompileOptions options;
    options.roofMeshes = meshes.names;
    return compileGrammarFile(file, options);
}

}  // namespace roof_test
