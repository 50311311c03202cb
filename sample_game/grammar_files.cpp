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

std::vector<FileStamp> stampsAround(const fs::path& file) {
    std::vector<fs::path> files{file};
    std::error_code ignored;
    for (fs::directory_iterator at(folderOf(file), ignored), end; !ignored && at != end; at.increment(ignored))
        if (at->path().extension() == ".grammar") files.push_back(at->path());
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

// One of the files that a text includes.
bool includedSince(const std::string& file, const std::string& text, fs::file_time_type read) {
    std::vector<std::string> names;
    (void)included(folderOf(file), text, names);
    return std::ranges::any_of(
        names, [&](const std::string& name) { return writtenSince(stampOf(folderOf(file) / name), read); });
}

}  // namespace

void GrammarFiles::begin(const espalier::scene::Scene& scene, fs::file_time_type read) {
    seen_.clear();
    for (const auto& grammar : scene.grammars) {
        std::string text, error;
        std::vector<FileStamp> stamps = stampsAround(grammar.file);
        if (!readText(grammar.file, text, error)) text = grammar.text;
        Seen seen{std::move(stamps), text, included(grammar.file, text)};
        const bool own = writtenSince(stampOf(grammar.file), read), others = includedSince(grammar.file, text, read);
        if (own || others) seen.stamps.clear();  // it is looked at again
        if (own) seen.text = grammar.text;
        if (others) seen.included.clear();
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
        // What was written from here, or typed here too, is no news.
        if (now.text != seen.text && now.text != grammar.text)
            changes.push_back({i, now.text, grammar.text != seen.text});
        else if (now.included != seen.included)
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
    if (included(file, seen.text) == seen.included) seen.included = included(file, text);
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
