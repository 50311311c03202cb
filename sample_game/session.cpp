// Saves and autosaves by tools/document, files of others by what they hold, runs by the document's listener.
#include "sample_game/session.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <set>
#include <utility>

#include "sample_game/folder_list.hpp"
#include "sample_game/settings.hpp"
#include "tools/document/project.hpp"
#include "tools/scene/hash.hpp"
#include "tools/scene/picture.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using namespace espalier::document;

constexpr double kLookEvery = .3;   // seconds
constexpr uint64_t kNever = ~1ull;  // was saved: no document has this state
constexpr int kMostPlaces = 99;     // editors of one scene
constexpr const char* kProject = "project.json";
constexpr const char* kAutosave = "autosave.json";
constexpr const char* kNoPlace = "neither XDG_CONFIG_HOME nor HOME is set";

std::vector<std::string> modelFiles(const espalier::scene::Scene& scene) {
    std::vector<std::string> files;
    for (const auto& surface : scene.surfaces) files.push_back(surface.file);
    if (scene.town) files.push_back(scene.town->file);
    return files;
}

// Where folders of what was never saved lie; empty: nowhere.
fs::path allUnsaved() {
    return configFolder().empty() ? "" : fs::path(configFolder()) / "unsaved";
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

void Session::begin(Workspace& work, const std::string& file, fs::file_time_type read, bool whole) {
    file_ = wholePath(file);
    fs::path place(file_);
    std::error_code ignored;
    const bool recovered = place.filename() == kAutosave;
    if (place.filename() == kProject || recovered) place = place.parent_path();
    folder_ = fs::exists(place / kProject, ignored) ? place.string() : "";
    recoveredFrom_ = recovered && folder_.empty() ? place.string() : "";
    savedState_ = recovered ? kNever : work.document->state();
    // Who knows what lies there by now; but what has lost something on being opened isn't written over it unchanged.
    autosavedState_ = recovered && work.scene().notes.empty() ? kNever : work.document->state();
    cannotKeep_.clear();
    toldKept_.clear();
    unsaved_.clear();
    run_.clear();
    putOff_.clear();
    refused_.clear();
    missing_ = replaying_ = saving_ = false;
    whole_ = whole && !work.scene().project;
    project_ = keptBeside_ = projectNow();
    if (writtenSince(project_, read)) project_ = {};
    unsavedLock_.release();
    claim();
    if (!cannotKeep_.empty()) work.message += (work.message.empty() ? "" : "\n") + cannotKeep_;
    recovery_ = recovered ? "" : leftBehind();
    grammarFiles_.begin(work.scene(), read);
    models_.begin(modelFiles(work.scene()), read);
    reload = givesUp = goesOn = false;
    work.document->beforeEdits([this] { background_.settle(); });
    work.document->listen([this](const Action& action, uint32_t gesture) { recorder_.note(action, gesture); });
}

std::string Session::name(const Workspace& work) const {
    if (!folder_.empty()) return fs::path(folder_).filename().string();
    return !recoveredFrom_.empty() ? "recovered work" : work.scene().name;
}

FileStamp Session::projectNow() const {
    return folder_.empty() ? FileStamp{} : stampOf(fs::path(folder_) / kProject);
}

std::string Session::ownAutosave() const {
    return (fs::path(folder_) / kAutosave).string();
}

std::string Session::autosaveFolder() const {
    if (replaying_) return {};
    if (!folder_.empty() && cannotKeep_.empty()) return folder_;
    if (!recoveredFrom_.empty()) return recoveredFrom_;
    return unsaved_.empty() ? unsavedFolder() : unsaved_;
}

// By what it was opened from, or is the project of: its name, and a number for where that is.
std::string Session::unsavedFolder(int number) const {
    const std::string& of = !run_.empty() ? run_ : folder_.empty() ? file_ : folder_;
    std::string name = fs::path(of).filename().string() + "-" + espalier::scene::hashName(of.data(), of.size());
    if (number > 1) name += "-" + std::to_string(number);
    return allUnsaved().empty() ? "" : (allUnsaved() / name).string();
}

// Two editors of one project, or of one autosave: the second keeps what is its own elsewhere.
void Session::claim() {
    lock_.release();
    const std::string& own = folder_.empty() ? recoveredFrom_ : folder_;
    if (own.empty() || lock_.take(own)) return;
    if (folder_.empty())
        recoveredFrom_.clear();
    else
        cannotKeep_ = folder_ + " is open in another editor";
}

void Session::takePlace() {
    if (!unsaved_.empty() || autosaveFolder() != unsavedFolder()) return;
    for (int i = 1; i <= kMostPlaces && !unsavedFolder().empty(); ++i) {
        std::error_code failed;
        const fs::path place = unsavedFolder(i);
        fs::create_directories(place, failed);
        if (failed) {  // which saving there will tell
            unsaved_ = place.string();
            return unsavedLock_.release();
        }
        if (!unsavedLock_.take(place.string()) || fs::exists(place / kAutosave, failed)) continue;
        unsaved_ = place.string();
        return;
    }
}

// Of editors that are gone, which may have kept what they had in the project's folder until that took no more.
std::string Session::leftBehind() {
    std::vector<std::pair<fs::file_time_type, std::string>> found;
    const auto look = [&](const std::string& place) {
        const std::string kept = recoverable(place);
        std::error_code ignored;
        if (!kept.empty() && !putOff_.contains(kept)) found.push_back({fs::last_write_time(kept, ignored), kept});
    };
    if (!folder_.empty() && cannotKeep_.empty()) look(folder_);
    for (int i = 1; i <= kMostPlaces && !unsavedFolder().empty(); ++i) look(unsavedFolder(i));
    std::ranges::stable_sort(found, std::greater(), [](const auto& one) { return one.first; });
    for (const auto& [time, kept] : found)
        if (kept == ownAutosave() || unsavedLock_.take(fs::path(kept).parent_path().string())) return kept;
    return {};
}

bool Session::changedByOthers() const {
    const FileStamp now = projectNow();
    return !folder_.empty() && !saving_ && now != FileStamp{} && now != project_;
}

bool Session::step(Workspace& work, double now) {
    if (const auto written = std::exchange(work.written, {}))
        grammarFiles_.wrote(work.scene(), written->first, written->second);
    // A stroke is one step, as is what any tool has in hand: it is saved when it has ended.
    const bool moved = (background_.started() || !(work.document->stroking() || work.busy)) && background_.step();
    if (now >= nextAutosave_ && !background_.busy()) {
        nextAutosave_ = now + autosaveEvery;
        keepSoon(work);
    }
    // What others write waits for a tool in use, since its Esc takes back the latest step, for a replay's end, and for
    // what is to be opened instead of this.
    const bool waits = replaying_ || !recovery_.empty() || work.document->stroking() || work.busy;
    if (now < nextLook_ || background_.busy() || waits) return moved;
    nextLook_ = now + kLookEvery;
    noticeLoss(work);
    const bool models = models_.changed(), grammars = watchGrammars(work);
    reload = reload || models;
    return moved || models || grammars;
}

// Whoever deletes or moves a project's folder while it is open: what is open is all that is left of it. Who saves over
// the project drops the autosave there, and who puts another project.json in its place makes it one of an earlier
// state: what isn't saved is kept anew.
void Session::noticeLoss(Workspace& work) {
    std::error_code ignored;
    const uint64_t state = work.document->state();
    const bool gone = !fs::exists(fs::path(autosaveFolder()) / kAutosave, ignored);
    if (state == autosavedState_ && state != savedState_ && (gone || keptBeside_ != projectNow())) {
        autosavedState_ = kNever;
        nextAutosave_ = 0;
    }
    const bool there = folder_.empty() || fs::exists(fs::path(folder_) / kProject, ignored);
    const bool missed = std::exchange(missing_, !there);  // at two looks: others may be writing it anew
    if (there || !missed || savedState_ == kNever) return;
    savedState_ = autosavedState_ = kNever;
    const std::string news = folder_ + " holds no project any more: Ctrl+S saves it there anew";
    (void)keepElsewhere(news);
    tellKept(work, news);
    nextAutosave_ = 0;
}

bool Session::idle() {
    background_.giveWay();
    return !background_.busy();
}

Session::Origin Session::origin(const Workspace& work) const {
    return {file_, folder_, cannotKeep_, recoveredFrom_, unsaved_, run_, putOff_, project_, whole_, modified(work)};
}

void Session::setOrigin(const Workspace& work, const Origin& origin) {
    file_ = origin.file;
    folder_ = origin.folder;
    cannotKeep_ = origin.cannotKeep;
    recoveredFrom_ = origin.recoveredFrom;
    unsaved_ = origin.unsaved;
    run_ = origin.run;
    project_ = origin.project;
    whole_ = origin.whole;
    putOff_ = origin.putOff;
    if (putOff_.contains(recovery_)) putOffRecovery();
    claim();
    // What an editor that had the project has left there since it was opened isn't this one's.
    std::error_code ignored;
    if (!folder_.empty() && !cannotKeep_.empty() && lock_.held() && fs::exists(ownAutosave(), ignored))
        putOff_.insert(ownAutosave());
    if (!unsaved_.empty() && !unsavedLock_.take(unsaved_)) unsaved_.clear();
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
    // What lies in the project and is to be decided on isn't written over, nor what is opened now instead of this.
    const bool waits = !recovery_.empty() && recovery_ == ownAutosave();
    recovery_.clear();
    if (!goesOn && !replaying_ && !waits) {
        if (givesUp)
            dropKept();
        else
            keepNow(work);
    }
    lock_.release();
    unsavedLock_.release();
}

bool Session::keeps(const Workspace& work) const {
    return !replaying_ && recovery_.empty() && work.document->state() != autosavedState_;
}

void Session::keepNow(Workspace& work) {
    std::string why;
    if (!keeps(work)) return;
    if (!modified(work)) {
        dropKept();
        autosavedState_ = work.document->state();
        return;
    }
    takePlace();
    if (autosaveFolder().empty()) {
        notKept(work, kNoPlace);
    } else if (autosave(*work.document, autosaveFolder(), why)) {
        kept(work, work.document->state());
    } else if (keepElsewhere(why)) {
        keepNow(work);
    } else {
        notKept(work, why);
    }
}

void Session::keepSoon(Workspace& work) {
    if (!keeps(work)) return;
    if (!modified(work) || autosaveFolder().empty()) return keepNow(work);
    const auto state = std::make_shared<uint64_t>();
    background_.ask({"",
                     [this, &work, state] {
                         *state = work.document->state();
                         takePlace();
                         return autosaving(*work.document, autosaveFolder());
                     },
                     [this, &work, state](const Work& over) {
                         if (over.state() == Work::State::done) return kept(work, *state);
                         if (over.state() == Work::State::cancelled) return;
                         keepElsewhere(over.error()) ? keepSoon(work) : notKept(work, over.error());
                     }});
}

void Session::kept(Workspace& work, uint64_t state) {
    autosavedState_ = state;
    keptBeside_ = projectNow();
    // What the project's folder took before isn't the latest any more.
    if (!cannotKeep_.empty() && !folder_.empty() && lock_.held() && !holdsBack()) dropAutosave(folder_);
    tellKept(work, cannotKeep_.empty() ? "" : cannotKeep_ + "; what isn't saved is kept in " + autosaveFolder());
}

void Session::notKept(Workspace& work, const std::string& why) {
    toldKept_.clear();  // told each time
    tellKept(work, "What isn't saved couldn't be kept: " + why);
}

bool Session::keepElsewhere(std::string why) {
    if (folder_.empty() || !cannotKeep_.empty() || unsavedFolder().empty()) return false;
    cannotKeep_ = std::move(why);
    return true;
}

// Once, while it is the same; what is mended isn't an error any more.
void Session::tellKept(Workspace& work, const std::string& news) {
    const std::string before = std::exchange(toldKept_, news);
    if (news == before) return;
    work.remedied(before);
    if (!news.empty()) work.error = news;
}

void Session::dropKept() {
    const bool own = !folder_.empty() && lock_.held() && !holdsBack();
    if (own) dropAutosave(folder_);
    if (folder_.empty() && !recoveredFrom_.empty()) removeKept(recoveredFrom_);
    if (!unsaved_.empty()) removeKept(unsaved_);
    unsaved_.clear();
    unsavedLock_.release();
    if (folder_.empty() || own) cannotKeep_.clear();
}

void Session::replays(const std::string& run) {
    replaying_ = true;
    whole_ = false;
    run_ = wholePath(run);
    folder_.clear();
    recoveredFrom_.clear();
    recovery_.clear();
    lock_.release();
    unsavedLock_.release();
}

void Session::endReplay() {
    replaying_ = false;
    recovery_ = leftBehind();
}

void Session::save(Workspace& work, const std::string& folder, Ended ended) {
    const auto state = std::make_shared<uint64_t>();
    work.error.clear();
    work.message = "Saving ...";
    background_.ask({"Saving " + fs::path(wholePath(folder)).filename().string(),
                     [this, &work, state, folder] {
                         *state = work.document->state();
                         saving_ = true;
                         return saving(*work.document, folder);
                     },
                     [this, &work, state, folder, ended](const Work& over) {
                         saving_ = false;
                         const bool good = over.state() == Work::State::done;
                         work.message =
                             good ? "Saved: " + wholePath(folder) : "Saving was cancelled: on disk all is as it was";
                         work.error = over.error();
                         if (good) saved(folder, *state);
                         ended(good);
                     }});
}

void Session::saved(const std::string& folder, uint64_t state) {
    dropKept();
    recoveredFrom_.clear();
    toldKept_.clear();
    run_.clear();
    cannotKeep_.clear();
    missing_ = replaying_ = whole_ = false;
    folder_ = wholePath(folder);
    putOff_.erase(ownAutosave());
    project_ = projectNow();
    claim();
    savedState_ = autosavedState_ = state;
    recovery_.clear();
}

void Session::forgetRecovery(bool deleteIt) {
    if (deleteIt) removeKept(fs::path(recovery_).parent_path());
    recovery_.clear();
    refused_.clear();
    unsavedLock_.release();
    if (deleteIt) recovery_ = leftBehind();
}

bool Session::holdsBack() const {
    std::error_code ignored;
    if (folder_.empty()) return false;
    return putOff_.contains(ownAutosave()) || (!lock_.held() && fs::exists(ownAutosave(), ignored));
}

bool Session::recoveryWaits() const {
    return !recovery_.empty() && (recovery_ != ownAutosave() || !unsavedFolder().empty());
}

void Session::putOffRecovery() {
    if (recovery_ == ownAutosave()) (void)keepElsewhere("What was left unsaved waits in " + folder_);
    putOff_.insert(recovery_);
    forgetRecovery(false);
    recovery_ = leftBehind();
}

void Session::startRecording(Workspace& work, const std::string& path, uint32_t width, uint32_t height, Ended ended) {
    work.error.clear();
    const RunHead head{RunHead::kVersion, file_, width, height, 1 / 30.f};
    // What was edited since is part of what the run begins with, and a project may be saved while it is recorded.
    const bool asOpened = whole_ && folder_.empty() && work.document->revision() == 0 && !modified(work);
    if (asOpened) return ended(record(work, path, head));
    RunHead edited = head;
    edited.scene = freeName(path + ".project", ".project");
    background_.ask({"Saving what the run begins with",
                     [&work, edited] { return saving(*work.document, edited.scene); },
                     [this, &work, path, edited, ended](const Work& over) {
                         work.error = over.error();
                         const bool good = over.state() == Work::State::done && record(work, path, edited);
                         if (good) beginRun(work);
                         ended(good);
                     }});
}

bool Session::record(Workspace& work, const std::string& path, RunHead head) {
    if (!recorder_.begin(path, std::move(head), work.error)) return false;
    recordingTo_ = path;
    const EspCamera camera = work.camera.camera();
    const auto& look = work.scene().look;
    if (look.view != ESP_VIEW_SHADED) work.perform(SetView{espalier::scene::nameOf(look.view), work.scene().viewLayer});
    return work.perform(SetCamera{array(vec(camera.eye)), array(vec(camera.target)), camera.fovY});
}

// Who replays the run opens the project that it begins with: the document is made what that is.
void Session::beginRun(Workspace& work) {
    const std::vector<uint32_t> before = work.document->beginAnew();
    const std::set<uint32_t> chosen = std::exchange(work.selected, {});
    for (size_t i = 0; i < before.size(); ++i)
        if (chosen.contains(before[i])) work.selected.insert(work.scene().seeds[i].key);
    work.forgetBarren();
}

void Session::stopRecording(Workspace& work) {
    const std::string frames = std::to_string(recorder_.frame() + 1) + " frames";
    if (recorder_.end(work.error)) work.message = "Recorded: " + recordingTo_ + ", " + frames;
    work.document->reachBack();
}

}  // namespace sample
