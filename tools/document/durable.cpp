// Write beside, flush, rename, flush the folder.
#include "tools/document/durable.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "tools/scene/text_file.hpp"

namespace espalier::document {
namespace {

namespace fs = std::filesystem;

bool writeDurably(scene::Unfinished& file, std::string_view text, std::string& error) {
    return file.write(text, error) && file.flush(error) && file.take(error) && file.folder().flush(error);
}

}  // namespace

bool writeTextDurably(const std::string& path, std::string_view text, std::string& error) {
    scene::Unfinished file(path);
    return writeDurably(file, text, error);
}

bool writeTextDurably(const scene::Folder& folder, const std::string& name, std::string_view text, std::string& error) {
    scene::Unfinished file(folder, name);
    return writeDurably(file, text, error);
}

bool makeFolderDurably(const std::string& folder, std::string& error) {
    std::vector<fs::path> missing;
    std::error_code code;
    for (fs::path at = scene::absolutePath(folder); at.has_relative_path() && !fs::exists(at, code);
         at = at.parent_path())
        missing.push_back(at);
    fs::create_directories(folder, code);
    if (code) error = folder + ": can't be made: " + code.message();
    return !code && std::ranges::all_of(missing, [&](const fs::path& made) {
        const scene::Folder parent = scene::Folder::at(made.parent_path().string(), error);
        return parent && parent.flush(error);
    });
}

}  // namespace espalier::document
