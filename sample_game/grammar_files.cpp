// Stamps of files -> texts that differ from those seen last. A text is taken over only if its own file has changed:
// what was typed stays when another grammar of the folder is saved.
#include "sample_game/grammar_files.hpp"

#include <algorithm>
#include <sstream>

#include "tools/scene/text_file.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using espalier::scene::readText;

fs::path folderOf(const fs::path& file) {
    return file.parent_path().empty() ? "." : file.parent_path();
}

std::vector<FileStamp> stampsAround(const fs::path& file) {
    std::vector<fs::path> files{file};
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folderOf(file), ignored))
        if (entry.path().extension() == ".grammar") files.push_back(entry.path());
    std::ranges::sort(files);
    std::vector<FileStamp> stamps;
    for (const fs::path& each : files) stamps.push_back(stampOf(each));
    return stamps;
}

// All that a text includes, each file once: `names` are those that are there already.
std::string included(const fs::path& folder, const std::string& text, std::vector<std::string>& names) {
    std::string all;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::string word, name, content, error;
        std::istringstream words(line);
        if (!(words >> word) || word != "include" || !std::getline(words, name, '"') || !std::getline(words, name, '"'))
            continue;
        // What the compiler refuses isn't read here, either: an include names a file beside its own.
        if (name.empty() || fs::path(name).filename() != name || name == "..") continue;
        if (std::ranges::find(names, name) != names.end()) continue;
        names.push_back(name);
        if (!readText((folder / name).string(), content, error)) continue;
        all += content + included(folder, content, names);
    }
    return all;
}

std::string included(const std::string& file, const std::string& text) {
    std::vector<std::string> names;
    return included(folderOf(file), text, names);
}

}  // namespace

void GrammarFiles::begin(const espalier::scene::Scene& scene, fs::file_time_type read) {
    seen_.clear();
    for (const auto& grammar : scene.grammars) {
        std::string text, error;
        std::vector<FileStamp> stamps = stampsAround(grammar.file);
        if (!readText(grammar.file, text, error)) text = grammar.text;
        Seen seen{std::move(stamps), text, included(grammar.file, text)};
        if (std::ranges::any_of(seen.stamps, [&](const FileStamp& stamp) { return stamp.time >= read; }))
            seen = {{}, grammar.text, {}};
        seen_.push_back(std::move(seen));
    }
}

std::vector<GrammarFiles::Change> GrammarFiles::look(const espalier::scene::Scene& scene) {
    std::vector<Change> changes;
    for (uint32_t i = 0; i < seen_.size() && i < scene.grammars.size(); ++i) {
        const auto& grammar = scene.grammars[i];
        Seen& seen = seen_[i];
        Seen now{stampsAround(grammar.file), {}, {}};
        std::string error;
        if (now.stamps == seen.stamps || !readText(grammar.file, now.text, error)) continue;
        now.included = included(grammar.file, now.text);
        if (now.text != seen.text)
            changes.push_back({i, now.text, grammar.text != seen.text && grammar.text != now.text});
        else if (now.included != seen.included)
            changes.push_back({i, grammar.text, false});
        seen = std::move(now);
    }
    return changes;
}

}  // namespace sample
