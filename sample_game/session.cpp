// Saves and autosaves by tools/document, files of others by what they hold, runs by the document's listener.
#include "sample_game/session.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "sample_game/folder_list.hpp"
#include "sample_game/settings.hpp"
#include "tools/document/project.hpp"
#include "tools/scene/picture.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using namespace espalier::document;

constexpr double kLookEvery = .3;   // seconds
constexpr uint64_t kNever = ~1ull;  // was saved: no document has this state

std::vector<std::string> modelFiles(const espalier::scene::Scene& scene) {
    std::vector<std::string> files;
    for (const auto& surface : scene.surfaces) files.push_back(surface.file);
    if (scene.town) files.push_back(scene.town->file);
    return files;
}

}  // namespace

void Session::begin(Workspace& work, const std::string& file) {
    file_ = fs::absolute(file).lexically_normal().string();
    fs::path place(file_);
    std::error_code ignored;
    const bool recovered = place.filename() == "autosave.json";
    if (place.filename() == "project.json" || recovered) place = place.parent_path();
    folder_ = fs::exists(place / "project.json", ignored) ? place.string() : "";
    recoveredFrom_ = recovered && folder_.empty() ? place.string() : "";
    savedState_ = recovered ? kNever : work.document->state();
    autosavedState_ = work.document->state();
    recovery_ = recovered ? "" : recoverable(autosaveFolder());
    grammarFiles_.begin(work.scene());
    models_.begin(modelFiles(work.scene()));
    reload = givesUp = replayed_ = false;
    work.document->beforeEdits([this] { background_.settle(); });
    work.document->listen([this](const Action& action, uint32_t gesture) { recorder_.note(action, gesture); });
}

std::string Session::name(const Workspace& work) const {
    if (!folder_.empty()) return fs::path(folder_).filename().string();
    return !recoveredFrom_.empty() ? "recovered work" : work.scene().name;
}

std::string Session::autosaveFolder() const {
    if (replayed_) return {};
    if (!folder_.empty()) return folder_;
    if (!recoveredFrom_.empty()) return recoveredFrom_;
    // Of what was never saved, beside the user's settings, by the file that it was opened from.
    std::string name = file_;
    std::replace(name.begin(), name.end(), '/', '-');
    return configFolder().empty() ? "" : configFolder() + "/unsaved/" + name;
}

bool Session::step(Workspace& work, double now) {
    // A stroke is one step: it is saved when it has ended.
    const bool moved = (background_.started() || !work.document->stroking()) && background_.step();
    if (now >= nextAutosave_ && !background_.busy()) {
        nextAutosave_ = now + autosaveEvery;
        keepSoon(work);
    }
    if (now < nextLook_ || background_.busy()) return moved;
    nextLook_ = now + kLookEvery;
    const bool models = models_.changed(), grammars = watchGrammars(work);
    reload = reload || models;
    return moved || models || grammars;
}

bool Session::idle() {
    background_.giveWay();
    return !background_.busy();
}

void Session::setOrigin(const Workspace& work, const Origin& origin) {
    file_ = origin.file;
    folder_ = origin.folder;
    savedState_ = autosavedState_ = origin.modified ? kNever : work.document->state();
}

bool Session::watchGrammars(Workspace& work) {
    const std::vector<GrammarFiles::Change> changes = grammarFiles_.look(work.scene());
    for (const GrammarFiles::Change& change : changes) {
        if (!work.perform(work.document->withText(change.grammar, change.text))) continue;
        const fs::path file = work.scene().grammars[change.grammar].file;
        work.message = "Read again: " + file.filename().string() +
                       (change.replaces ? "; Ctrl+Z brings back what was typed here" : "");
    }
    return !changes.empty();
}

void Session::end(Workspace& work) {
    if (recording()) stopRecording(work);
    background_.giveWay();
    background_.finish();
    work.document->beforeEdits({});
    if (autosaveFolder().empty() || !recovery_.empty()) return;
    if (givesUp)
        dropKept();
    else
        keepNow(work);
}

bool Session::keeps(const Workspace& work) const {
    return !autosaveFolder().empty() && recovery_.empty() && work.document->state() != autosavedState_;
}

void Session::keepNow(Workspace& work) {
    if (!keeps(work)) return;
    if (!modified(work))
        dropKept();
    else if (!autosave(*work.document, autosaveFolder(), work.error))
        return;
    autosavedState_ = work.document->state();
}

void Session::keepSoon(Workspace& work) {
    if (!keeps(work)) return;
    if (!modified(work)) return keepNow(work);
    const auto state = std::make_shared<uint64_t>();
    background_.ask({"",
                     [this, &work, state] {
                         *state = work.document->state();
                         return autosaving(*work.document, autosaveFolder());
                     },
                     [this, &work, state](const Work& over) {
                         if (over.state() == Work::State::done) autosavedState_ = *state;
                         if (over.state() == Work::State::failed)
                             work.error = "What isn't saved couldn't be kept: " + over.error();
                     }});
}

void Session::dropKept() const {
    std::error_code ignored;
    if (!folder_.empty())
        dropAutosave(folder_);
    else
        fs::remove_all(autosaveFolder(), ignored);
}

void Session::replays() {
    replayed_ = true;
    folder_.clear();
    recovery_.clear();
}

void Session::save(Workspace& work, const std::string& folder, Ended ended) {
    const auto state = std::make_shared<uint64_t>();
    work.error.clear();
    work.message = "Saving ...";
    background_.ask({"Saving " + fs::path(wholePath(folder)).filename().string(),
                     [&work, state, folder] {
                         *state = work.document->state();
                         return saving(*work.document, folder);
                     },
                     [this, &work, state, folder, ended](const Work& over) {
                         const bool good = over.state() == Work::State::done;
                         work.message = good ? "Saved: " + wholePath(folder) : "Not saved";
                         work.error = over.error();
                         if (good) saved(folder, *state);
                         ended(good);
                     }});
}

void Session::saved(const std::string& folder, uint64_t state) {
    if (folder_.empty() && !autosaveFolder().empty()) dropKept();
    replayed_ = false;
    folder_ = wholePath(folder);
    savedState_ = autosavedState_ = state;
    recovery_.clear();
}

void Session::forgetRecovery(bool deleteIt) {
    if (deleteIt) dropAutosave(fs::path(recovery_).parent_path().string());
    recovery_.clear();
}

bool Session::startRecording(Workspace& work, const std::string& path, uint32_t width, uint32_t height) {
    work.error.clear();
    std::string from = file_;
    // What was edited since is part of what the run begins with.
    if (work.document->revision() != 0 || replayed_) {
        from = path + ".project";
        if (!saveProject(*work.document, from, work.error)) return false;
    }
    if (!recorder_.begin(path, {1, from, width, height, 1 / 30.f}, work.error)) return false;
    recordingTo_ = path;
    const EspCamera camera = work.camera.camera(0);
    return work.perform(SetCamera{array(vec(camera.eye)), array(vec(camera.target)), camera.fovY});
}

void Session::stopRecording(Workspace& work) {
    work.message = "Recorded: " + recordingTo_ + ", " + std::to_string(recorder_.frame() + 1) + " frames";
    recorder_.end();
}

}  // namespace sample
