// A typed path -> what lies in its folder.
#include "sample_game/folder_list.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <tuple>

#include "tools/scene/scene_file.hpp"

namespace sample {

namespace fs = std::filesystem;

std::string sizeInWords(uint64_t bytes) {
    constexpr const char* kUnits[] = {"B", "KB", "MB", "GB", "TB"};
    size_t unit = 0;
    double size = double(bytes);
    while (size >= 999.5 && unit + 1 < std::size(kUnits)) size /= 1000, ++unit;
    char text[32];
    std::snprintf(text, sizeof text, unit > 0 && size < 9.95 ? "%.1f %s" : "%.0f %s", size, kUnits[unit]);
    return text;
}

namespace {

std::string detailOf(const fs::path& path) {
    struct stat info {};
    std::tm when{};
    char date[32];
    if (::stat(path.c_str(), &info) != 0 || !::localtime_r(&info.st_mtime, &when) ||
        std::strftime(date, sizeof date, "%Y-%m-%d %H:%M", &when) == 0)
        return {};
    return S_ISREG(info.st_mode) ? sizeInWords(uint64_t(info.st_size)) + "   " + date : date;
}

}  // namespace

std::vector<FolderEntry> listFolder(const std::string& typed, const std::vector<std::string>& endings) {
    constexpr size_t kMost = 400;
    const std::string before = typed.substr(0, typed.rfind('/') + 1);  // npos + 1: none
    std::vector<FolderEntry> found;
    std::error_code failed;
    for (fs::directory_iterator at(before.empty() ? "." : before, failed), end; !failed && at != end;
         at.increment(failed)) {
        const std::string name = at->path().filename().string();
        std::error_code gone;
        if (name.empty() || name[0] == '.') continue;
        if (at->is_directory(gone)) {
            const bool project = fs::exists(at->path() / espalier::scene::kProjectFile, gone);
            // A project is answered with: the list stays, so that a second click finds it where the first did.
            if (project)
                found.push_back({name, before + name, FolderEntry::project});
            else
                found.push_back({name + "/", before + name + "/", FolderEntry::folder});
        } else if (std::any_of(endings.begin(), endings.end(), [&](const auto& e) { return name.ends_with(e); })) {
            found.push_back({name, before + name, FolderEntry::file});
        }
    }
    std::sort(found.begin(), found.end(), [](const FolderEntry& a, const FolderEntry& b) {
        return std::tuple(a.kind == FolderEntry::file, a.name) < std::tuple(b.kind == FolderEntry::file, b.name);
    });
    if (found.size() > kMost) found.resize(kMost);
    for (FolderEntry& entry : found) entry.detail = detailOf(before + entry.name);
    const fs::path here = wholePath(before);
    if (here.has_relative_path()) {
        const std::string above = here.parent_path().string();
        found.insert(found.begin(), {"..", above == "/" ? above : above + "/", FolderEntry::folder});
    }
    return found;
}

std::string expanded(const std::string& typed) {
    const char* home = std::getenv("HOME");
    const bool own = typed == "~" || typed.starts_with("~/");
    return own && home && *home ? home + typed.substr(1) : typed;
}

std::string wholePath(const std::string& path) {
    std::error_code failed;
    const fs::path whole = fs::absolute(path.empty() ? "." : path, failed).lexically_normal();
    return failed                                               ? path
           : whole.has_filename() || !whole.has_relative_path() ? whole.string()
                                                                : whole.parent_path().string();
}

std::string freeName(const std::string& path, const std::string& ending) {
    std::error_code ignored;
    const bool ends = !ending.empty() && path.ends_with(ending);
    const std::string stem = ends ? path.substr(0, path.size() - ending.size()) : path;
    std::string name = path;
    for (int i = 2; fs::exists(fs::symlink_status(expanded(name), ignored)); ++i)
        name = stem + "-" + std::to_string(i) + (ends ? ending : "");
    return name;
}

}  // namespace sample
