// Places by the names of what is open, taken by locking their folders.
#include "sample_game/autosaves.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <utility>
#include <vector>

#include "sample_game/folder_list.hpp"
#include "sample_game/settings.hpp"
#include "tools/document/project.hpp"
#include "tools/scene/hash.hpp"
#include "tools/scene/user_folders.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using namespace espalier::document;

constexpr int kMostPlaces = 99;  // editors of one scene

// Where folders of what was never saved lie; empty: nowhere.
fs::path allUnsaved() {
    return espalier::scene::configFolder().empty() ? "" : fs::path(espalier::scene::configFolder()) / "unsaved";
}

// An autosave that isn't needed any more. A folder that isn't one of ours is left but for that.
void removeKept(const fs::path& folder) {
    std::error_code ignored;
    if (!allUnsaved().empty() && folder.parent_path() == allUnsaved())
        fs::remove_all(folder, ignored);
    else
        dropAutosave(folder.string());
}

}  // namespace

bool Autosaves::open(const std::string& file) {
    fs::path place(wholePath(file));
    at_ = {};
    at_.file = place.string();
    std::error_code ignored;
    const bool recovered = place.filename() == espalier::scene::kAutosaveFile;
    if (place.filename() == espalier::scene::kProjectFile || recovered) place = place.parent_path();
    if (fs::exists(place / espalier::scene::kProjectFile, ignored))
        at_.folder = place.string();
    else if (recovered)
        at_.recoveredFrom = place.string();
    refused_.clear();
    replaying_ = false;
    unsavedLock_.release();
    claim();
    recovery_ = recovered ? "" : leftBehind();
    return recovered;
}

void Autosaves::setOrigin(const Origin& origin) {
    at_ = origin;
    if (at_.putOff.contains(recovery_)) putOffRecovery();
    claim();
    // What an editor that had the project has left there since it was opened isn't this one's.
    std::error_code ignored;
    if (!at_.folder.empty() && !at_.cannotKeep.empty() && lock_.held() && fs::exists(own(), ignored))
        at_.putOff.insert(own());
    if (!at_.unsaved.empty() && !unsavedLock_.take(at_.unsaved)) at_.unsaved.clear();
}

void Autosaves::saved(const std::string& folder) {
    drop();
    at_.folder = wholePath(folder);
    at_.recoveredFrom.clear();
    at_.run.clear();
    at_.cannotKeep.clear();
    at_.putOff.erase(own());
    replaying_ = false;
    claim();
    recovery_.clear();
}

void Autosaves::replays(const std::string& run) {
    replaying_ = true;
    at_.run = wholePath(run);
    at_.folder.clear();
    at_.recoveredFrom.clear();
    recovery_.clear();
    release();
}

void Autosaves::endReplay() {
    replaying_ = false;
    recovery_ = leftBehind();
}

bool Autosaves::end() {
    const bool waits = !recovery_.empty() && recovery_ == own();
    recovery_.clear();
    return !waits;
}

void Autosaves::release() {
    lock_.release();
    unsavedLock_.release();
}

std::string Autosaves::own() const {
    return (fs::path(at_.folder) / espalier::scene::kAutosaveFile).string();
}

// By what it was opened from, or is the project of: its name, and a number for where that is.
std::string Autosaves::unsavedFolder(int number) const {
    const std::string& of = !at_.run.empty() ? at_.run : at_.folder.empty() ? at_.file : at_.folder;
    std::string name = fs::path(of).filename().string() + "-" + espalier::scene::hashName(of.data(), of.size());
    if (number > 1) name += "-" + std::to_string(number);
    return allUnsaved().empty() ? "" : (allUnsaved() / name).string();
}

std::string Autosaves::place() const {
    if (replaying_) return {};
    if (!at_.folder.empty() && at_.cannotKeep.empty()) return at_.folder;
    if (!at_.recoveredFrom.empty()) return at_.recoveredFrom;
    return at_.unsaved.empty() ? unsavedFolder() : at_.unsaved;
}

// Two editors of one project, or of one autosave: the second keeps what is its own elsewhere.
void Autosaves::claim() {
    lock_.release();
    const std::string& own = at_.folder.empty() ? at_.recoveredFrom : at_.folder;
    if (own.empty() || lock_.take(own)) return;
    if (at_.folder.empty())
        at_.recoveredFrom.clear();
    else
        at_.cannotKeep = at_.folder + " is open in another editor";
}

void Autosaves::take() {
    if (!at_.unsaved.empty() || place() != unsavedFolder()) return;
    for (int i = 1; i <= kMostPlaces && !unsavedFolder().empty(); ++i) {
        std::error_code failed;
        const fs::path place = unsavedFolder(i);
        fs::create_directories(place, failed);
        if (failed) {  // which saving there will tell
            at_.unsaved = place.string();
            return unsavedLock_.release();
        }
        if (!unsavedLock_.take(place.string()) || fs::exists(place / espalier::scene::kAutosaveFile, failed)) continue;
        at_.unsaved = place.string();
        return;
    }
}

bool Autosaves::moveAway(std::string why) {
    if (at_.folder.empty() || !at_.cannotKeep.empty() || unsavedFolder().empty()) return false;
    at_.cannotKeep = std::move(why);
    return true;
}

void Autosaves::kept() {
    if (!at_.cannotKeep.empty() && !at_.folder.empty() && lock_.held() && !holdsBack()) dropAutosave(at_.folder);
}

void Autosaves::drop() {
    const bool ours = !at_.folder.empty() && lock_.held() && !holdsBack();
    if (ours) dropAutosave(at_.folder);
    if (at_.folder.empty() && !at_.recoveredFrom.empty()) removeKept(at_.recoveredFrom);
    if (!at_.unsaved.empty()) removeKept(at_.unsaved);
    at_.unsaved.clear();
    unsavedLock_.release();
    if (at_.folder.empty() || ours) at_.cannotKeep.clear();
}

// Of editors that are gone, which may have kept what they had in the project's folder until that took no more.
std::string Autosaves::leftBehind() {
    std::vector<std::pair<fs::file_time_type, std::string>> found;
    const auto look = [&](const std::string& place) {
        const std::string kept = recoverable(place);
        std::error_code ignored;
        if (!kept.empty() && !at_.putOff.contains(kept)) found.push_back({fs::last_write_time(kept, ignored), kept});
    };
    if (!at_.folder.empty() && at_.cannotKeep.empty()) look(at_.folder);
    for (int i = 1; i <= kMostPlaces && !unsavedFolder().empty(); ++i) look(unsavedFolder(i));
    std::ranges::stable_sort(found, std::greater(), [](const auto& one) { return one.first; });
    for (const auto& [time, kept] : found)
        if (kept == own() || unsavedLock_.take(fs::path(kept).parent_path().string())) return kept;
    return {};
}

void Autosaves::forgetRecovery(bool deleteIt) {
    if (deleteIt) removeKept(fs::path(recovery_).parent_path());
    recovery_.clear();
    refused_.clear();
    unsavedLock_.release();
    if (deleteIt) recovery_ = leftBehind();
}

bool Autosaves::recoveryWaits() const {
    return !recovery_.empty() && (recovery_ != own() || !unsavedFolder().empty());
}

void Autosaves::putOffRecovery() {
    if (recovery_ == own()) (void)moveAway("What was left unsaved waits in " + at_.folder);
    at_.putOff.insert(recovery_);
    forgetRecovery(false);
    recovery_ = leftBehind();
}

bool Autosaves::holdsBack() const {
    std::error_code ignored;
    if (at_.folder.empty()) return false;
    return at_.putOff.contains(own()) || (!lock_.held() && fs::exists(own(), ignored));
}

}  // namespace sample
