// Saves and autosaves by tools/document, grammars' files by their times, runs by the document's listener.
#include "sample_game/session.hpp"

#include <algorithm>
#include <utility>

#include "sample_game/settings.hpp"
#include "tools/document/project.hpp"
#include "tools/scene/picture.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using namespace espalier::document;

constexpr double kLookEvery = .3;   // seconds
constexpr uint64_t kNever = ~1ull;  // was saved: no document has this state

// Of surfaces and town. A file that isn't there at the moment counts as it was: `before`.
std::vector<fs::file_time_type> modelTimes(const Workspace& work, const std::vector<fs::file_time_type>& before) {
    std::vector<std::string> files;
    for (const auto& surface : work.scene().surfaces) files.push_back(surface.file);
    if (work.scene().town) files.push_back(work.scene().town->file);
    std::vector<fs::file_time_type> times;
    for (size_t i = 0; i < files.size(); ++i) {
        std::error_code missing;
        times.push_back(fs::last_write_time(files[i], missing));
        if (missing) times.back() = i < before.size() ? before[i] : fs::file_time_type::min();
    }
    return times;
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
    modelTimes_ = modelTimes(work, {});
    reload = givesUp = replayed_ = false;
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
    if (now >= nextAutosave_) {
        nextAutosave_ = now + autosaveEvery;
        keep(work);
    }
    if (now < nextLook_) return false;
    nextLook_ = now + kLookEvery;
    const bool models = watchModels(work), grammars = watchGrammars(work);
    return models || grammars;
}

bool Session::watchModels(const Workspace& work) {
    std::vector<fs::file_time_type> times = modelTimes(work, modelTimes_);
    if (times == modelTimes_) return false;
    modelTimes_ = std::move(times);
    return reload = true;
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
    if (autosaveFolder().empty() || !recovery_.empty()) return;
    if (givesUp)
        dropKept();
    else
        keep(work);
}

void Session::keep(Workspace& work) {
    const uint64_t state = work.document->state();
    if (autosaveFolder().empty() || !recovery_.empty() || state == autosavedState_) return;
    if (!modified(work))
        dropKept();
    else if (!autosave(*work.document, autosaveFolder(), work.error))
        return;
    autosavedState_ = state;
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

void Session::save(Workspace& work, const std::string& folder) {
    work.error.clear();
    if (!saveProject(*work.document, folder, work.error)) return;
    if (folder_.empty() && !autosaveFolder().empty()) dropKept();
    replayed_ = false;
    folder_ = fs::absolute(folder).lexically_normal().string();
    savedState_ = autosavedState_ = work.document->state();
    recovery_.clear();
    work.message = "Saved: " + folder_;
}

void Session::saveSoon(Workspace& work) {
    saveSoon_ = true;
    work.error.clear();
    work.message = "Saving ...";
}

bool Session::saveDue(Workspace& work) {
    if (!std::exchange(saveSoon_, false)) return false;
    work.message.clear();
    save(work, folder_);
    return true;
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
