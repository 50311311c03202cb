// In: models that a user names. Out: whether they are baked, and the work that bakes them.
#include "sample_game/model_bake.hpp"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "tools/baking/bake_program.hpp"
#include "tools/scene/hash.hpp"
#include "tools/scene/scene.hpp"
#include "tools/scene/text_file.hpp"
#include "tools/scene/user_folders.hpp"

namespace sample {

namespace fs = std::filesystem;
using espalier::document::Progress;
using espalier::document::Work;

namespace {

struct Kind {
    const char* ending;  // of what is made of the model
    const char* option;  // of the baker; null: none
    const char* name;
};
constexpr Kind kSurface{".surface.glb", nullptr, "surface"}, kTerminal{".terminal.glb", "--terminal", "terminal"};

std::string madeOf(const std::string& model, const Kind& kind) {
    const fs::path whole = espalier::scene::absolutePath(model).lexically_normal();
    const std::string name = whole.stem().string(), cache = espalier::scene::cacheFolder();
    if (::access(whole.parent_path().c_str(), W_OK) == 0 || cache.empty())
        return (whole.parent_path() / (name + kind.ending)).string();
    const std::string place = whole.string();
    return cache + "/baked/" + name + "-" + espalier::scene::hashName(place.data(), place.size()) + kind.ending;
}

bool isMade(const std::string& model, const std::string& made) {
    std::error_code failed;
    const fs::file_time_type written = fs::last_write_time(made, failed);
    if (failed) return false;
    for (const fs::path& source : {fs::path(model), espalier::baking::bakeProgram()})
        if (fs::last_write_time(source, failed) >= written || failed) return false;
    return true;
}

// Whether the file may be written over: it isn't there, or such a thing was made there before.
bool mayReplace(const std::string& made, const Kind& kind, std::string& error) {
    std::string ignored;
    std::error_code none;
    if (!fs::exists(made, none) || kind.option || espalier::scene::mayOpen(made, ignored)) return true;
    error = made + ": is there and is no " + kind.name + ", so nothing is written over it";
    return false;
}

Work::Plan making(const std::string& model, const Kind& kind) {
    Work::Plan plan;
    plan.beside = [model = espalier::scene::absolutePath(model).string(), &kind](Progress& progress,
                                                                                 std::string& error) {
        const std::string made = madeOf(model, kind);
        const std::vector<std::string> options =
            kind.option ? std::vector<std::string>{kind.option} : std::vector<std::string>{};
        return mayReplace(made, kind, error) && espalier::baking::bake(model, made, options, progress, error);
    };
    return plan;
}

}  // namespace

bool isModel(const std::string& file) {
    std::string ending = fs::path(file).extension().string(), text, ignored;
    std::ranges::transform(ending, ending.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    if (std::ranges::find(kModelEndings, ending) == std::end(kModelEndings)) return false;
    return ending != ".glb" || !espalier::scene::mayOpen(file, ignored);
}

std::string surfaceOf(const std::string& model) {
    return madeOf(model, kSurface);
}
std::string terminalOf(const std::string& model) {
    return madeOf(model, kTerminal);
}

bool isBaked(const std::string& model) {
    return isMade(model, surfaceOf(model));
}
bool isTerminalBaked(const std::string& model) {
    return isMade(model, terminalOf(model));
}

Work::Plan baking(const std::string& model) {
    return making(model, kSurface);
}
Work::Plan bakingTerminal(const std::string& model) {
    return making(model, kTerminal);
}

}  // namespace sample
