// Lines of a run -> actions of the document, each when its frame is due.
#include "sample_game/replay.hpp"

#include <algorithm>
#include <filesystem>

namespace sample {

using namespace espalier::document;

bool Replay::read(const std::string& path, std::string& error) {
    Run run;
    if (!readRun(path, run, error)) return false;
    path_ = path;
    run_ = std::move(run);
    began_ = -1;
    next_ = 0;
    return true;
}

bool Replay::step(Workspace& work, double now) {
    const auto due = uint32_t(std::min((now - began_) / run_->head.step, double(run_->frames())));
    for (; next_ < run_->lines.size() && run_->lines[next_].frame <= due; ++next_) {
        const RunLine& line = run_->lines[next_];
        // Lines of no gesture, such as the camera's, may stand amid those of one.
        if (line.gesture && line.gesture != theirs_) {
            theirs_ = line.gesture;
            ours_ = work.newGesture();
        }
        if (!work.perform(line.action, line.gesture ? ours_ : 0)) {
            const std::string why = path_ + ":" + std::to_string(line.number) + ": " + work.error;
            stop(work);  // which may end a stroke, and then there is no news but that
            work.error = why;
            return false;
        }
        if (std::holds_alternative<SetCamera>(line.action)) work.lookFrom(work.scene().camera);
    }
    const std::string name = std::filesystem::path(path_).filename().string(), all = std::to_string(run_->frames());
    status_ = "Replaying " + name + ": frame " + std::to_string(due) + " of " + all + "   Esc: stop";
    work.underWay = status_.c_str();
    if (next_ < run_->lines.size()) return true;
    const std::string note = run_->note.empty() ? "" : "\n" + run_->note;
    const std::string began = std::filesystem::path(run_->head.scene).filename().string();
    stop(work);
    work.message = "Replayed: " + name + ", " + all + " frames; what it made of " + began + " is open now" + note;
    return false;
}

void Replay::stop(Workspace& work) {
    if (work.document->stroking()) work.perform(StrokeEnd{}, ours_);
    work.underWay = nullptr;
    forget();
}

}  // namespace sample
