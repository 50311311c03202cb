// What no text names any more, by the hashes in files' names.
#include "tools/document/sweep.hpp"

#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <set>
#include <string_view>

#include "tools/scene/hash.hpp"
#include "tools/scene/text_file.hpp"
#include "tools/scene/unfinished.hpp"

namespace espalier::document {
namespace {

namespace fs = std::filesystem;
using scene::Folder;
using scene::kHashDigits;
using Hashes = std::set<std::string, std::less<>>;

std::string hashOf(const fs::path& file) {
    const std::string stem = file.stem().string();
    return stem.substr(stem.size() < kHashDigits ? 0 : stem.size() - kHashDigits);
}

// NAME-SURFACE-HASH.exr, HASH.plant or HASH.glb: whoever keeps files of his own in such a folder keeps them.
bool named(const fs::path& file) {
    const std::string hash = hashOf(file), ending = file.extension().string();
    return (ending == ".exr" || ending == ".plant" || ending == ".glb") && hash.size() == kHashDigits &&
           hash.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// What may be the hash in a file's name: the last digits of each row of them.
void addHashes(std::string_view text, Hashes& out) {
    const auto isDigit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    for (size_t at = 0, digits = 0; at <= text.size(); ++at) {
        const bool digit = at < text.size() && isDigit(text[at]);
        if (!digit && digits >= kHashDigits) out.emplace(text.substr(at - kHashDigits, kHashDigits));
        digits = digit ? digits + 1 : 0;
    }
}

// Of a file that begins with a brace, as scenes, projects and runs do, all; of others nothing. False: it can't be read.
bool readDescription(const std::string& path, std::string& text) {
    constexpr uint64_t kMost = uint64_t(1) << 28;
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    std::ifstream file(path, std::ios::binary);
    std::string begin(1024, 0), error;
    file.read(begin.data(), std::streamsize(begin.size()));
    begin.resize(size_t(file.gcount()));
    text.clear();
    if (file.bad() || (!file.eof() && file.fail())) return false;
    const size_t mark = begin.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
    const size_t first = begin.find_first_not_of(" \t\r\n", mark);
    if (first == std::string::npos || begin[first] != '{') return true;
    return scene::readText(path, text, error, kMost);
}

// The hashes that any text in the folder names: who has a copy of an older project.json, or a scene or a run that uses
// a layer of this project, keeps it. Nothing: a text can't be read, and who knows what it names.
std::optional<Hashes> hashesIn(const Folder& home) {
    Hashes all;
    for (const std::string& name : home.names()) {
        std::error_code ignored;
        std::string text;
        if (!fs::is_regular_file(home.pathOf(name), ignored)) continue;
        if (!readDescription(home.pathOf(name), text)) return std::nullopt;
        addHashes(text, all);
    }
    return all;
}

template <class F>
void clear(const Folder& folder, F&& unwanted) {
    for (const std::string& name : folder.names())
        if (scene::Unfinished::isAbandoned(name) || unwanted(name)) folder.remove(name);
}

}  // namespace

void sweepProject(const Folder& home, const std::vector<std::string>& kept) {
    std::optional<Hashes> wanted = hashesIn(home);
    if (!wanted) return;
    for (const std::string& file : kept) addHashes(file, *wanted);
    clear(home, [](const std::string&) { return false; });
    for (const char* place : {kLayers, kPlants, kSurfaces}) {
        std::string none;
        const Folder folder = home.in(place, false, none);
        if (!folder) continue;
        clear(folder, [&](const fs::path& file) { return named(file) && !wanted->contains(hashOf(file)); });
        home.removeFolder(place);  // if nothing is in it
    }
}

}  // namespace espalier::document
