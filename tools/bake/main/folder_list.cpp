// In: a folder. Out: its models in an order that no file system decides.
#include <algorithm>
#include <filesystem>
#include <map>

#include "tools/bake/main/folder.hpp"

namespace espalier::folder {
namespace {

namespace fs = std::filesystem;

// The length of the ending by which a file is a model; 0: it is none.
size_t endingOf(const std::string& name) {
    std::string small = name;
    for (char& c : small) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    auto endsWith = [&](std::string_view end) { return small.size() > end.size() && small.ends_with(end); };
    if (endsWith(".surface.glb")) return 0;
    for (std::string_view ending : {".gltf", ".glb", ".obj", ".ply", ".ply.gz", ".stl"})
        if (endsWith(ending)) return ending.size();
    return 0;
}

}  // namespace

Result<std::vector<Item>> listModels(const std::string& folder, const std::string& out) {
    std::error_code error;
    std::vector<std::string> names;
    auto it = fs::recursive_directory_iterator(folder, error);
    for (; !error && it != fs::recursive_directory_iterator(); it.increment(error)) {
        std::string leaf = it->path().filename();
        std::error_code ignored;
        bool isFolder = it->is_directory(ignored);
        if (leaf.starts_with(".") || (isFolder && fs::equivalent(it->path(), out, ignored))) {
            if (isFolder) it.disable_recursion_pending();
        } else if (it->is_regular_file(ignored) && endingOf(leaf) > 0) {
            names.push_back(it->path().lexically_relative(folder).generic_string());
        }
    }
    if (error) return Failure(folder, "cannot be listed: " + error.message());
    if (names.empty()) return Failure(folder, "holds no models (.gltf, .glb, .obj, .ply, .stl)");
    std::sort(names.begin(), names.end());
    auto stem = [](const std::string& name) { return name.substr(0, name.size() - endingOf(name)); };
    std::map<std::string, int> sharing;
    for (const std::string& name : names) ++sharing[stem(name)];
    std::vector<Item> items;
    for (const std::string& name : names)
        items.push_back({name, (sharing[stem(name)] > 1 ? name : stem(name)) + ".surface.glb"});
    return items;
}

}  // namespace espalier::folder
