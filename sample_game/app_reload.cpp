// A model that has changed on disk: what is open is opened anew over it.
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include "sample_game/app_state.hpp"
#include "sample_game/panels.hpp"
#include "tools/document/project.hpp"

namespace sample {

namespace fs = std::filesystem;
using espalier::document::Work;

// Opened anew, a dialogue would be gone, and what is typed into it meant for the tools: that comes first.
void App::followModels() {
    if (!session_.reload && reloading_.kept.empty()) return;
    const bool waits = usesPanels();
    if (waits && !reloadWaits_) work_.message = "A model has changed on disk: it is read when you are done here";
    reloadWaits_ = waits;
    if (waits || !session_.idle()) return;
    if (session_.reload && session_.autosaves().recovery().empty()) reload();
    if (!reloading_.kept.empty() && !work_.busy && session_.idle()) openReloaded();
}

void App::dropReloaded() {
    std::error_code ignored;
    if (!reloading_.kept.empty()) fs::remove_all(fs::path(reloading_.kept).parent_path(), ignored);
    reloading_ = {};
}

// By way of a project, so that everything that was done stands; only undo doesn't reach behind it. It is saved beside
// the frames; what is done meanwhile isn't in it, so it is then saved again.
void App::reload() {
    session_.reload = false;
    std::error_code failed;
    const fs::path temporary = fs::temp_directory_path(failed);
    if (failed) {
        work_.error = "Not reloaded: TMPDIR is no folder";
        return;
    }
    std::string folder = (temporary / "espalier-reload-XXXXXX").string();
    if (!mkdtemp(folder.data())) {
        work_.error = "Not reloaded: " + temporary.string() + ": " + std::strerror(errno);
        return;
    }
    const std::string kept = (fs::path(folder) / work_.scene().name).string();
    const auto state = std::make_shared<uint64_t>();
    session_.background().ask({"Reloading " + fs::path(session_.file()).filename().string(),
                               [this, kept, state] {
                                   *state = work_.document->state();
                                   return saving(*work_.document, kept);
                               },
                               [this, kept, state](const Work& over) {
                                   const bool done = over.state() == Work::State::done;
                                   std::error_code ignored;
                                   if (done)
                                       reloading_ = {kept, *state};
                                   else
                                       fs::remove_all(fs::path(kept).parent_path(), ignored);
                                   if (!over.error().empty()) work_.error = "Not reloaded: " + over.error();
                               }});
}

void App::openReloaded() {
    const auto [kept, state] = std::exchange(reloading_, {});
    const Session::Origin origin = session_.origin(work_);
    const Workspace::Hands hands = work_.hands();
    const bool recorded = session_.recording();
    session_.reload = state != work_.document->state();
    session_.goesOn = !session_.reload;
    work_.error.clear();
    if (session_.goesOn && showOpening(origin.autosaves.file) && openDocument({kept, {}, {}, {}}, work_.error)) {
        work_.takeUp(hands);
        session_.setOrigin(work_, origin);
        const std::string notes = std::exchange(work_.message, {});
        work_.message = "Its model has changed on disk: " + fs::path(origin.autosaves.file).filename().string() +
                        " was reloaded" + (recorded ? "; the recording has ended" : "") + (notes.empty() ? "" : "\n") +
                        notes;
    }
    session_.goesOn = false;
    std::error_code ignored;
    fs::remove_all(fs::path(kept).parent_path(), ignored);
}

}  // namespace sample
