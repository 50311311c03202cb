// What no text names any more, by the hashes in files' names.
#include "tools/document/sweep.hpp"

#include <charconv>
#include <filesystem>
#include <fstream>
#include <functional>
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

// Cuts the first character off a text; JSON may write any by its number, as in "\\u0061".
char takeCharacter(std::string_view& text) {
    uint8_t number = 0;
    const std::string_view escape = text.substr(0, 6);
    const bool whole = escape.size() == 6 && escape.starts_with("\\u00") &&
                       std::from_chars(escape.data() + 4, escape.data() + 6, number, 16).ptr == escape.data() + 6;
    const char c = whole ? char(number) : text.front();
    text.remove_prefix(whole ? 6 : 1);
    return c;
}

// What may be the hash in a file's name: the last digits of each row of them.
void addHashes(std::string_view text, Hashes& out) {
    const auto isDigit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    std::string row;
    while (!text.empty() || !row.empty()) {
        const char c = text.empty() ? '\0' : takeCharacter(text);
        if (isDigit(c)) {
            row += c;
            continue;
        }
        if (row.size() >= kHashDigits) out.insert(row.substr(row.size() - kHashDigits));
        row.clear();
    }
}

// Of a file that begins with a brace, as scenes, projects and runs do, all; of others nothing. False: it can't be read.
bool readDescription(const std::string& path, std::string& text) {
    constexpr uint64_t kMost = uint64_t(1) << 28;
    constexpr std::string_view kBlanks = " \t\r\n", kByteOrderMark = "\xEF\xBB\xBF";
    std::ifstream file(path, std::ios::binary);
    std::string begin(kByteOrderMark.size(), 0), error;
    if (!file) return false;
    file.read(begin.data(), std::streamsize(begin.size()));
    if (begin != kByteOrderMark) file.clear(), file.seekg(0);
    char first = 0;
    while (file.get(first) && kBlanks.find(first) != kBlanks.npos) {
    }
    text.clear();
    if (!file) return file.eof();
    return first != '{' || scene::readText(path, text, error, kMost);
}

// The hashes that any text in the folder, or in a folder in it, names: who has a copy of an older project.json, or a
// scene or a run that uses a layer of this project, keeps it. False: a text can't be read or there are more folders
// than anybody has there, and who knows what they name.
bool addHashesIn(const Folder& home, int depth, size_t& texts, Hashes& all) {
    constexpr int kMostDepth = 8;
    constexpr size_t kMostTexts = 100000;
    if (depth > kMostDepth) return false;
    for (const std::string& name : home.names()) {
        const std::string path = home.pathOf(name);
        std::error_code ignored;
        std::string text, none;
        if (++texts > kMostTexts) return false;
        if (fs::is_directory(fs::symlink_status(path, ignored))) {
            if (name.front() == '.') continue;  // those of other programs
            const Folder inner = home.in(name, false, none);
            if (!inner || !addHashesIn(inner, depth + 1, texts, all)) return false;
        } else if (fs::is_regular_file(path, ignored)) {
            if (!readDescription(path, text)) return false;
            addHashes(text, all);
        }
    }
    return true;
}

template <class F>
void clear(const Folder& folder, F&& unwanted) {
    for (const std::string& name : folder.names())
        if (scene::Unfinished::isAbandoned(name) || unwanted(name)) folder.remove(name);
}

}  // namespace

void sweepProject(const Folder& home, const std::vector<std::string>& kept) {
    Hashes wanted;
    size_t texts = 0;
    // First what a program that was killed has left: what only such a text names, nothing opens any more.
    clear(home, [](const std::string&) { return false; });
    if (!addHashesIn(home, 0, texts, wanted)) return;
    for (const std::string& file : kept) addHashes(file, wanted);
    for (const char* place : {kLayers, kPlants, kSurfaces}) {
        std::string none;
        const Folder folder = home.in(place, false, none);
        if (!folder) continue;
        clear(folder, [&](const fs::path& file) { return named(file) && !wanted.contains(hashOf(file)); });
        home.removeFolder(place);  // if nothing is in it
    }
}

}  // namespace espalier::document
