// Files as other programs write them: every model and every mistake of the folder of further data, read or refused
// with a cause. Which is which comes from the validator's reports and the table below, not from the importer.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "runtime/core/file.hpp"
#include "tests/support/data.hpp"
#include "tools/bake/bake.hpp"

using namespace espalier;
using namespace espalier::test;
namespace fs = std::filesystem;

namespace {

// Path, format and the number of triangles (those of instances counted each) of the list of sources.
struct Listed {
    std::string path;
    size_t triangles = 0;
    bool hasUvs = false;
};
std::vector<Listed> listed() {
    auto text = readTextFile(dataFolder() / "SOURCES.md");
    std::vector<Listed> out;
    if (!text) return out;
    size_t at = 0;
    while (at < text->size()) {
        std::string line = text->substr(at, text->find('\n', at) - at);
        at += line.size() + 1;
        std::vector<std::string> cells;
        for (size_t from = 1, to; (to = line.find('|', from)) != line.npos; from = to + 1) {
            std::string cell = line.substr(from, to - from);
            size_t a = cell.find_first_not_of(' '), b = cell.find_last_not_of(' ');
            cells.push_back(a == cell.npos ? "" : cell.substr(a, b - a + 1));
        }
        if (cells.size() < 10) continue;
        std::string ending = fs::path(cells[0]).extension();
        if (ending != ".glb" && ending != ".gltf" && ending != ".obj" && ending != ".ply" && ending != ".gz") continue;
        size_t bracket = cells[4].find('[');
        std::string count = bracket == std::string::npos ? cells[4] : cells[4].substr(bracket + 1);
        out.push_back({cells[0], size_t(std::strtoull(count.c_str(), nullptr, 10)), cells[5] != "no"});
    }
    return out;
}

}  // namespace

TEST_CASE("every model of the list is read, with as many triangles as others have counted") {
    if (dataFolder().empty()) {
        (void)dataFile("SOURCES.md");
        return;
    }
    auto models = listed();
    CHECK(models.size() == 101);
    // The list counts neither GPU instances nor scenes apart.
    const std::map<std::string, size_t> counted = {
        {"models/khronos/SimpleInstancing/glTF-Binary/SimpleInstancing.glb", 12 * 125},
        {"models/khronos/MultipleScenes/glTF/MultipleScenes.gltf", 2}};
    for (const Listed& l : models) {
        CAPTURE(l.path);
        auto path = dataFile(l.path);
        if (!path) continue;
        auto model = importModel(*path);
        if (!model) {
            FAIL_CHECK(model.failure().text());
            continue;
        }
        auto it = counted.find(l.path);
        size_t expected = it == counted.end() ? l.triangles : it->second;
        CHECK(model->indices.size() / 3 == expected);
        CHECK(model->uvs.empty() == !l.hasUvs);
        for (uint32_t i : model->indices) REQUIRE(i < model->positions.size());
        CHECK(model->triangleMaterial.size() * (model->triangleMaterial.empty() ? 0 : 3) ==
              (model->triangleMaterial.empty() ? 0 : model->indices.size()));
    }
}

TEST_CASE("every case of the validator is read or refused with its file's name, as its report lets expect") {
    if (dataFolder().empty()) {
        (void)dataFile("validator_cases");
        return;
    }
    // Cases whose triangles can be read all the same: their mistakes lie elsewhere (skins, morph targets, attributes
    // that we don't read), or they have none.
    const std::set<std::string> readable = {"accessor_attribute_uint32",
                                            "accessor_unequal_count",
                                            "index_buffer_degenerate_triangle",
                                            "index_buffer_primitive_restart",
                                            "invalid_attribute",
                                            "invalid_indexed_attribute",
                                            "morph_attribute_invalid_count",
                                            "morph_unequal_targets_count",
                                            "node_skinned_mesh_without_skin",
                                            "node_weights_override",
                                            "primitive_generated_tangent_space",
                                            "unresolved_morph_positions",
                                            "uv"};
    // Of the others with triangles: what must be said.
    const std::map<std::string, std::string> said = {{"position_accessor_invalid_format", "POSITION has 4 components"},
                                                     {"unresolved_indices", "indices"},
                                                     {"primitive_no_position", "no POSITION"},
                                                     {"not_found", "not_found.bin"},
                                                     {"wrong_bytelength", "states 17 bytes, has 16"},
                                                     {"node_parent_override", "nodes[2] is reached"},
                                                     {"unresolved_child_node", "nodes[1] does not exist"},
                                                     {"truncated_chunk_data", "truncated"},
                                                     {"invalid_magic", "not glTF"},
                                                     {"invalid_object", "buffers[0]"},
                                                     {"empty_json_chunk", "no JSON chunk"},
                                                     {"alignment", "buffer 0 holds nothing"},
                                                     {"small_stride", "buffer 0 holds nothing"}};
    size_t cases = 0;
    for (const auto& entry : fs::recursive_directory_iterator(dataFolder() / "validator_cases")) {
        std::string ending = entry.path().extension(), name = entry.path().stem();
        if (ending != ".gltf" && ending != ".glb") continue;
        ++cases;
        CAPTURE(entry.path().string());
        auto report = readTextFile(entry.path().string() + ".report.json");
        REQUIRE(report);
        auto judged = nlohmann::json::parse(*report, nullptr, false);
        size_t errors = judged["issues"]["numErrors"];
        auto model = importModel(entry.path());
        std::string text = model ? "read" : model.failure().text();
        CAPTURE(text);
        CHECK(bool(model) == (readable.count(name) == 1));
        if (model) continue;
        CHECK(text.find(entry.path().filename()) != std::string::npos);
        auto it = said.find(name);
        if (it != said.end()) CHECK(text.find(it->second) != std::string::npos);
        // What the validator finds no fault with is refused only where there is nothing to bake.
        if (errors == 0) CHECK(text.find("holds no triangles") != std::string::npos);
    }
    CHECK(cases == 67);
}
