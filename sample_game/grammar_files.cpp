// Stamps of files -> texts that differ from those seen last. A text is taken over only if its own file has changed:
// what was typed stays when another grammar of the folder is saved.
#include "sample_game/grammar_files.hpp"

#include <algorithm>
#include <sstream>

#include "tools/document/durable.hpp"
#include "tools/scene/text_file.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using espalier::scene::readText;

fs::path folderOf(const fs::path& file) {
    return file.parent_path().empty() ? "." : file.parent_path();
}

using Included = GrammarFiles::Included;

// Adds all that a text includes which isn't there yet. The text's own file lies in `within`, relative to `folder`.
void addIncluded(const fs::path& folder, const fs::path& within, const std::string& text, Included& all) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::string word, name, content, error;
        std::istringstream words(line);
        if (!(words >> word) || word != "include" || !std::getline(words, name, '"') || !std::getline(words, name, '"'))
            continue;
        if (name.empty() || fs::path(name).is_absolute()) continue;
        name = (within / name).lexically_normal().string();
        if (std::ranges::find(all.names, name) != all.names.end()) continue;
        all.names.push_back(name);
        if (!readText((folder / name).string(), content, error)) continue;
        all.text += content;
        addIncluded(folder, fs::path(name).parent_path(), content, all);
    }
}

Included included(const std::string& file, const std::string& text) {
    Included all;
    addIncluded(folderOf(file), {}, text, all);
    return all;
}

// Of the grammars in the file's folder, where one may come to be included, and of what it includes from elsewhere.
std::vector<FileStamp> stampsAround(const fs::path& file, const Included& included) {
    std::vector<fs::path> files{file};
    std::error_code ignored;
    for (fs::directory_iterator at(folderOf(file), ignored), end; !ignored && at != end; at.increment(ignored))
        if (at->path().extension() == ".grammar") files.push_back(at->path());
    for (const std::string& name : included.names)
        if (fs::path(name).has_parent_path()) files.push_back(folderOf(file) / name);
    std::ranges::sort(files);
    std::vector<FileStamp> stamps;
    for (const fs::path& each : files) stamps.push_back(stampOf(each));
    return stamps;
}

// One of the files that a text includes.
bool includedSince(const std::string& file, const Included& included, fs::file_time_type read) {
    return std::ranges::any_of(
        included.names, [&](const std::string& name) { return writtenSince(stampOf(folderOf(file) / name), read); });
}

}  // namespace

void GrammarFiles::begin(const espalier::scene::Scene& scene, fs::file_time_type read) {
    seen_.clear();
    for (const auto& grammar : scene.grammars) {
        std::string text, error;
        // Stamps before the text: what is written in between is looked at again.
        std::vector<FileStamp> before = stampsAround(grammar.file, {});
        if (!readText(grammar.file, text, error)) text = grammar.text;
        Seen seen{{}, text, included(grammar.file, text)};
        seen.stamps = stampsAround(grammar.file, seen.included);
        if (stampsAround(grammar.file, {}) != before) seen.stamps.clear();
        const bool own = writtenSince(stampOf(grammar.file), read);
        const bool others = includedSince(grammar.file, seen.included, read);
        if (own || others) seen.stamps.clear();  // it is looked at again
        if (own) seen.text = grammar.text;
        if (others) seen.included.text.clear();
        seen_.push_back(std::move(seen));
    }
}

std::vector<GrammarFiles::Change> GrammarFiles::look(const espalier::scene::Scene& scene) {
    std::vector<Change> changes;
    for (uint32_t i = 0; i < seen_.size() && i < scene.grammars.size(); ++i) {
        const auto& grammar = scene.grammars[i];
        Seen& seen = seen_[i];
        Seen now{stampsAround(grammar.file, seen.included), {}, {}};
        std::string error;
        if (now.stamps == seen.stamps || !readText(grammar.file, now.text, error)) continue;
        now.included = included(grammar.file, now.text);
        if (now.included.names != seen.included.names) now.stamps.clear();  // it is looked at again
        // What was written from here, or typed here too, is no news.
        if (now.text != seen.text && now.text != grammar.text)
            changes.push_back({i, now.text, grammar.text != seen.text});
        else if (now.included.text != seen.included.text)
            changes.push_back({i, grammar.text, false});
        seen = std::move(now);
    }
    return changes;
}

// It may include others by now. Where what it included has changed since the last look, that is still to be told.
void GrammarFiles::wrote(const espalier::scene::Scene& scene, uint32_t grammar, const std::string& text) {
    if (grammar >= seen_.size()) return;
    Seen& seen = seen_[grammar];
    const std::string& file = scene.grammars[grammar].file;
    if (included(file, seen.text).text == seen.included.text) seen.included = included(file, text);
    seen.text = text;
}

const std::string* FileText::of(const std::string& file) {
    const FileStamp stamp = stampOf(file);
    std::string ignored;
    if (file != file_ || stamp != stamp_) good_ = readText(file, text_, ignored);
    file_ = file;
    stamp_ = stamp;
    return good_ ? &text_ : nullptr;
}

bool sameText(const std::string& a, const std::string& b) {
    const auto ended = [](const std::string& text) { return text.find_last_not_of('\n') + 1; };
    return a.compare(0, ended(a), b, 0, ended(b)) == 0;
}

bool writeGrammar(const std::string& file, const std::string& text, std::string& error) {
    std::error_code none;
    const fs::path behind = fs::canonical(file, none);
    return espalier::document::writeTextDurably(none ? file : behind.string(), text, error);
}

}  // namespace sample
