// Saves and autosaves by tools/document, files of others by what they hold, runs by the document's listener.
#include "sample_game/session.hpp"

#include <memory>
#include <set>
#include <utility>

#include "sample_game/folder_list.hpp"
#include "tools/document/project.hpp"
#include "tools/scene/picture.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using namespace espalier::document;

constexpr double kLookEvery = .3;   // seconds
constexpr uint64_t kNever = ~1ull;  // was saved: no document has this state
constexpr const char* kNoPlace = "neither XDG_CONFIG_HOME nor HOME is set";

std::vector<std::string> modelFiles(const espalier::scene::Scene& scene) {
    std::vector<std::string> files;
    for (const auto& surface : scene.surfaces) files.push_back(surface.file);
    if (scene.town) files.push_back(scene.town->file);
    return files;
}

// Of surfaces and grammars.
std::pair<size_t, size_t> filesOf(const espalier::scene::Scene& scene) {
    return {scene.surfaces.size(), scene.grammars.size()};
}

}  // namespace

void Session::begin(Workspace& work, const std::string& file, fs::file_time_type read, bool whole) {
    const bool recovered = autosaves_.open(file);
    savedState_ = recovered ? kNever : work.document->state();
    // Who knows what lies there by now; but what has lost something on being opened isn't written over it unchanged.
    autosavedState_ = recovered && work.scene().notes.empty() ? kNever : work.document->state();
    toldKept_.clear();
    missing_ = saving_ = false;
    whole_ = whole && !work.scene().project;
    project_ = keptBeside_ = projectNow();
    if (writtenSince(project_, read)) project_ = {};
    const std::string& cannotKeep = autosaves_.origin().cannotKeep;
    if (!cannotKeep.empty()) work.message += (work.message.empty() ? "" : "\n") + cannotKeep;
    grammarFiles_.begin(work.scene(), read);
    models_.begin(modelFiles(work.scene()), read);
    watched_ = filesOf(work.scene());
    reload = givesUp = goesOn = false;
    work.document->beforeEdits([this] { background_.settle(); });
    work.document->listen([this](const Action& action, uint32_t gesture) { recorder_.note(action, gesture); });
}

std::string Session::name(const Workspace& work) const {
    if (!folder().empty()) return fs::path(folder()).filename().string();
    return !autosaves_.origin().recoveredFrom.empty() ? "recovered work" : work.scene().name;
}

FileStamp Session::projectNow() const {
    return folder().empty() ? FileStamp{} : stampOf(fs::path(folder()) / espalier::scene::kProjectFile);
}

bool Session::changedByOthers() const {
    const FileStamp now = projectNow();
    return !folder().empty() && !saving_ && now != FileStamp{} && now != project_;
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
    const bool waits =
        autosaves_.replaying() || !autosaves_.recovery().empty() || work.document->stroking() || work.busy;
    if (now < nextLook_ || background_.busy() || waits) return moved;
    nextLook_ = now + kLookEvery;
    noticeLoss(work);
    followAdditions(work);
    const bool models = models_.changed(), grammars = watchGrammars(work);
    reload = reload || models;
    return moved || models || grammars;
}

// Files that have come with models and grammars, or have gone, since the scene was opened.
void Session::followAdditions(const Workspace& work) {
    if (const auto files = filesOf(work.scene()); files != watched_) {
        watched_ = files;
        grammarFiles_.begin(work.scene());
        models_.begin(modelFiles(work.scene()));
    }
}

// Whoever deletes or moves a project's folder while it is open: what is open is all that is left of it. Who saves over
// the project drops the autosave there, and who puts another project.json in its place makes it one of an earlier
// state: what isn't saved is kept anew.
void Session::noticeLoss(Workspace& work) {
    std::error_code ignored;
    const uint64_t state = work.document->state();
    const bool gone = !fs::exists(fs::path(autosaves_.place()) / espalier::scene::kAutosaveFile, ignored);
    if (state == autosavedState_ && state != savedState_ && (gone || keptBeside_ != projectNow())) {
        autosavedState_ = kNever;
        nextAutosave_ = 0;
    }
    const bool there = folder().empty() || fs::exists(fs::path(folder()) / espalier::scene::kProjectFile, ignored);
    const bool missed = std::exchange(missing_, !there);  // at two looks: others may be writing it anew
    if (there || !missed || savedState_ == kNever) return;
    savedState_ = autosavedState_ = kNever;
    const std::string news = folder() + " holds no project any more: Ctrl+S saves it there anew";
    (void)autosaves_.moveAway(news);
    tellKept(work, news);
    nextAutosave_ = 0;
}

bool Session::idle() {
    background_.giveWay();
    return !background_.busy();
}

Session::Origin Session::origin(const Workspace& work) const {
    return {autosaves_.origin(), project_, whole_, modified(work)};
}

void Session::setOrigin(const Workspace& work, const Origin& origin) {
    autosaves_.setOrigin(origin.autosaves);
    project_ = origin.project;
    whole_ = origin.whole;
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
    background_.leave();
    background_.finish();
    work.document->beforeEdits({});
    // What lies in the project and is to be decided on isn't written over, nor what is opened now instead of this.
    if (autosaves_.end() && !goesOn && !autosaves_.replaying()) {
        if (givesUp)
            autosaves_.drop();
        else
            keepNow(work);
    }
    autosaves_.release();
    if (work.error.empty()) work.error = std::exchange(lostRun_, {});
}

bool Session::keeps(const Workspace& work) const {
    return !autosaves_.replaying() && autosaves_.recovery().empty() && work.document->state() != autosavedState_;
}

void Session::keepNow(Workspace& work) {
    std::string why;
    if (!keeps(work)) return;
    if (!modified(work)) {
        autosaves_.drop();
        autosavedState_ = work.document->state();
        return;
    }
    autosaves_.take();
    if (autosaves_.place().empty()) {
        notKept(work, kNoPlace);
    } else if (autosave(*work.document, autosaves_.place(), why)) {
        kept(work, work.document->state());
    } else if (autosaves_.moveAway(why)) {
        keepNow(work);
    } else {
        notKept(work, why);
    }
}

void Session::keepSoon(Workspace& work) {
    if (!keeps(work)) return;
    if (!modified(work) || autosaves_.place().empty()) return keepNow(work);
    const auto state = std::make_shared<uint64_t>();
    background_.ask({"",
                     [this, &work, state] {
                         *state = work.document->state();
                         autosaves_.take();
                         return autosaving(*work.document, autosaves_.place());
                     },
                     [this, &work, state](const Work& over) {
                         if (over.state() == Work::State::done) return kept(work, *state);
                         if (over.state() == Work::State::cancelled) return;
                         autosaves_.moveAway(over.error()) ? keepSoon(work) : notKept(work, over.error());
                     }});
}

void Session::kept(Workspace& work, uint64_t state) {
    autosavedState_ = state;
    keptBeside_ = projectNow();
    autosaves_.kept();
    if (state == savedState_) return autosaves_.drop();  // it was taken back meanwhile
    const std::string& cannotKeep = autosaves_.origin().cannotKeep;
    tellKept(work, cannotKeep.empty() ? "" : cannotKeep + "; what isn't saved is kept in " + autosaves_.place());
}

void Session::notKept(Workspace& work, const std::string& why) {
    toldKept_.clear();  // told each time
    tellKept(work, "What isn't saved couldn't be kept: " + why);
}

// Once, while it is the same; what is mended isn't an error any more.
void Session::tellKept(Workspace& work, const std::string& news) {
    const std::string before = std::exchange(toldKept_, news);
    if (news == before) return;
    work.remedied(before);
    if (!news.empty()) work.error = news;
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
                         if (good) saved(folder, *state), work.layout.noteRecent(wholePath(folder));
                         ended(good);
                     }});
}

void Session::replays(const std::string& run) {
    whole_ = false;
    autosaves_.replays(run);
}

void Session::saved(const std::string& folder, uint64_t state) {
    autosaves_.saved(folder);
    toldKept_.clear();
    missing_ = whole_ = false;
    project_ = projectNow();
    savedState_ = autosavedState_ = state;
}

void Session::startRecording(Workspace& work, const std::string& path, uint32_t width, uint32_t height, Ended ended) {
    work.error.clear();
    const RunHead head{RunHead::kVersion, file(), width, height, 1 / 30.f};
    // What was edited since is part of what the run begins with, and a project may be saved while it is recorded.
    const bool asOpened = whole_ && folder().empty() && work.document->revision() == 0 && !modified(work);
    if (asOpened) return ended(record(work, path, head));
    RunHead edited = head;
    edited.scene = freeName(path + ".project", ".project");
    background_.ask({"Saving what the run begins with",
                     [&work, edited] { return saving(*work.document, edited.scene); },
                     [this, &work, path, edited, ended](const Work& over) {
                         work.error = over.error();
                         const bool good = over.state() == Work::State::done && record(work, path, edited);
                         if (good) {
                             beginRun(work);
                             work.say(
                                 "Recording: undo reaches back to here; what was done before can be undone when "
                                 "the recording has ended");
                         }
                         ended(good);
                     }});
}

bool Session::record(Workspace& work, const std::string& path, RunHead head) {
    if (!recorder_.begin(path, std::move(head), work.error)) return false;
    recordingTo_ = path;
    lostRun_.clear();
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

void Session::nextFrame(Workspace& work) {
    recorder_.nextFrame();
    if (!recorder_.failed() || !recording()) return;
    stopRecording(work);
    lostRun_ = work.error;
}

void Session::stopRecording(Workspace& work) {
    const std::string frames = std::to_string(recorder_.frame() + 1) + " frames";
    if (recorder_.end(work.error)) work.message = "Recorded: " + recordingTo_ + ", " + frames;
    work.document->reachBack();
}

}  // namespace sample
