// Two pictures in, or two folders of them, whether they are alike out: the share of pixels whose channels all differ
// by at most the tolerance must reach the wanted share. Exit code 0: all are alike, 1: one isn't, 2: can't tell.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <optional>

#include "tools/command_line.hpp"
#include "tools/compare/comparison.hpp"
#include "tools/compare/folders.hpp"
#include "tools/compare/reports.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/text_file.hpp"

using namespace espalier::compare;
namespace fs = std::filesystem;

namespace {

int fail(const std::string& message) {
    std::fprintf(stderr, "espalier-compare: %s\n", message.c_str());
    return 2;
}

struct Question {
    std::string first, second, diff, junit, json, html;
    Limits limits;
    bool folders = false;
    Kept kept() const { return {!html.empty(), !html.empty() || !diff.empty()}; }
};

// One line, on stderr where nothing could be measured.
void tell(const Question& asked, const Comparison& found) {
    const std::string name = asked.folders ? found.name + ": " : "";
    if (!found.measured)
        std::fprintf(stderr, "espalier-compare: %s%s\n", name.c_str(), found.why.c_str());
    else
        std::printf("%s%s: %s\n", name.c_str(), found.verdict == Verdict::alike ? "alike" : "not alike",
                    figuresOf(found, asked.limits).c_str());
}

// Of folders only pictures that differ get one, each by its name with .png behind it.
bool writeDifference(const Question& asked, const Comparison& found, std::string& error) {
    if (asked.diff.empty() || found.pictures[2].empty()) return true;
    if (asked.folders && found.verdict == Verdict::alike) return true;
    const std::string file = asked.folders ? (fs::path(asked.diff) / (found.name + ".png")).string() : asked.diff;
    std::error_code code;
    if (asked.folders) fs::create_directories(fs::path(file).parent_path(), code);
    return espalier::scene::writePng(file, found.pictures[2].data(), found.width, found.height, error);
}

Comparison compared(const Question& asked, const Pair& pair) {
    Comparison found;
    if (pair.first.empty() || pair.second.empty()) {
        found.verdict = Verdict::different;
        found.why = pair.second.empty() ? asked.second + " has no such picture" : asked.first + " has no such picture";
    } else {
        found = compareFiles(pair.first, pair.second, asked.limits, asked.kept());
    }
    found.name = pair.name;
    return found;
}

int answer(const Question& asked) {
    std::string error;
    std::vector<Pair> pairs{{fs::path(asked.second).filename().string(), asked.first, asked.second}};
    if (asked.folders && (pairs.clear(), !pairsOf(asked.first, asked.second, pairs, error))) return fail(error);
    Page page(asked.html);
    if (!asked.html.empty() && !page.begin(error)) return fail(error);

    std::vector<Comparison> all;
    for (const Pair& pair : pairs) {
        Comparison found = compared(asked, pair);
        tell(asked, found);
        if (!writeDifference(asked, found, error)) return fail(error);
        if (found.verdict == Verdict::alike)
            for (auto& picture : found.pictures) picture.clear();
        if (!asked.html.empty() && !page.add(found, asked.limits, error)) return fail(error);
        for (auto& picture : found.pictures) picture = {};  // there may be thousands of them
        all.push_back(std::move(found));
    }
    if (!asked.html.empty() && !page.finish(error)) return fail(error);
    if (!asked.junit.empty() && !espalier::scene::writeText(asked.junit, junitOf(all), error)) return fail(error);
    if (!asked.json.empty() && !espalier::scene::writeText(asked.json, jsonOf(all, asked.limits), error))
        return fail(error);

    const auto any = [&](Verdict verdict) {
        return std::ranges::any_of(all, [&](auto& one) { return one.verdict == verdict; });
    };
    return any(Verdict::unknown) ? 2 : any(Verdict::different) ? 1 : 0;
}

bool within(const std::string& inner, const std::string& folder) {
    std::error_code ignored;
    const fs::path a = fs::weakly_canonical(fs::absolute(inner), ignored), b = fs::weakly_canonical(folder, ignored);
    return std::mismatch(b.begin(), b.end(), a.begin(), a.end()).first == b.end();
}

// What can't be answered as it is asked; empty: it can.
std::string mistakeOf(const Question& asked) {
    if (asked.folders != fs::is_directory(asked.second))
        return "compares two pictures or two folders, not a picture with a folder";
    if (!asked.folders) {
        const fs::path ending = fs::path(asked.diff).extension();
        if (!ending.empty() && ending != ".png") return "--diff writes .png, not '" + asked.diff + "'";
    }
    const std::string page = asked.html.empty() ? "" : (fs::path(asked.html) / "index.html").string();
    if (const auto lost = espalier::writtenOver({asked.first, asked.second},
                                                {asked.folders ? "" : asked.diff, asked.junit, asked.json, page}))
        return *lost + " would overwrite a picture to compare, or another file that is written";
    for (const std::string& folder : {asked.html, asked.folders ? asked.diff : ""})
        for (const std::string& read : {asked.first, asked.second})
            if (asked.folders && !folder.empty() && within(folder, read))
                return folder + " lies in " + read + ", so its pictures would be compared the next time";
    return {};
}

int compareAsAsked(int argc, char** argv) {
    CLI::App app{
        "Compares two pictures pixel by pixel, alpha too, or all pictures of two folders by their names. Ends with 0: "
        "alike, 1: not alike, also by their sizes or where one is missing, 2: can't tell.",
        "espalier-compare"};
    app.set_version_flag("--version", ESPALIER_VERSION);
    Question asked;
    const auto isShare = [](const std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        return end != text.c_str() && *end == 0 && value >= 0 && value <= 1
                   ? ""
                   : "'" + text + "' isn't a share from 0 to 1";
    };
    app.add_option("A", asked.first, "a picture, or a folder of pictures that are approved")->required();
    app.add_option("B", asked.second, "the picture or folder to compare it with")->required();
    app.add_option("--tolerance", asked.limits.tolerance,
                   "how far a channel may differ, of 255; 0: not by a bit, in EXR too")
        ->capture_default_str()
        ->check(CLI::Range(0, 255));
    app.add_option("--share", asked.limits.share, "the share of pixels that must be within it")
        ->capture_default_str()
        ->check(isShare, "FLOAT in [0 - 1]");
    app.add_option("--diff", asked.diff,
                   "writes a PNG of the differences, brightest where they are largest; of folders a folder of them");
    app.add_option("--report", asked.junit, "writes JUnit's XML: a test case for each picture");
    app.add_option("--json", asked.json, "writes which pictures differ, where and by how much");
    app.add_option("--html", asked.html, "a folder: writes a page there that shows both pictures under a slider");
    if (const auto ends = espalier::parseCommandLine(app, argc, argv)) return *ends;

    asked.folders = fs::is_directory(asked.first);
    if (const std::string mistake = mistakeOf(asked); !mistake.empty()) return fail(mistake);
    try {
        return answer(asked);
    } catch (const std::bad_alloc&) {
        return fail("there is too little memory to compare " + asked.first + " with " + asked.second);
    }
}

}  // namespace

int main(int argc, char** argv) {
    return espalier::runProgram(
        "espalier-compare", [&] { return compareAsAsked(argc, argv); }, 2);
}
