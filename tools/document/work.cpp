// Parts on the document's thread, a thread, parts on the document's thread.
#include "tools/document/work.hpp"

#include <algorithm>
#include <chrono>

#include "tools/scene/guarded.hpp"

namespace espalier::document {

// Many large layers may be more than there is memory for, and folders may change while they are read.
using scene::guarded;

Work::~Work() {
    cancel();
    if (thread_.valid()) thread_.wait();
}

// What was called off has failed at nothing, though a writer that stops half-way says so.
bool Work::end(State state) {
    state_ = state;
    if (state == State::cancelled) error_.clear();
    return false;
}

bool Work::step() {
    if (state_ != State::underWay) return false;
    return besideDone_ ? stepAfter() : thread_.valid() ? stepBeside() : stepBefore();
}

bool Work::stepBefore() {
    if (progress_.calledOff_) return end(State::cancelled);
    if (next_ < plan_.before.size()) {
        if (!guarded("", error_, [&] { return plan_.before[next_](error_); })) return end(State::failed);
        if (++next_ < plan_.before.size()) return true;
    }
    thread_ = std::async(std::launch::async,
                         [this] { return guarded("", error_, [&] { return plan_.beside(progress_, error_); }); });
    return true;
}

bool Work::stepBeside() {
    if (thread_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return true;
    if (!thread_.get()) return end(progress_.calledOff_ ? State::cancelled : State::failed);
    besideDone_ = true;
    next_ = 0;
    return plan_.after.empty() ? end(State::done) : true;
}

bool Work::stepAfter() {
    const bool good = !progress_.calledOff_ && guarded("", error_, [&] { return plan_.after[next_](error_); });
    if (!good && next_ > 0 && plan_.takeBack) plan_.takeBack();
    if (!good) return end(progress_.calledOff_ ? State::cancelled : State::failed);
    return ++next_ < plan_.after.size() ? true : end(State::done);
}

void Work::settle() {
    while (reading() && step()) continue;
}

bool Work::finish(std::string& error) {
    while (step())
        if (thread_.valid()) thread_.wait();
    error = error_;
    return state_ == State::done;
}

// Reading and taking over are short beside encoding and decoding.
float Work::progress() const {
    constexpr float kReading = .15f, kTaking = .3f;
    const float reading = plan_.before.empty() ? 0 : kReading, taking = plan_.after.empty() ? 0 : kTaking;
    const auto share = [&](const std::vector<Part>& parts) {
        return float(next_) / float(std::max<size_t>(parts.size(), 1));
    };
    if (state_ == State::done) return 1;
    if (besideDone_) return 1 - taking + taking * share(plan_.after);
    if (!thread_.valid()) return reading * share(plan_.before);
    return reading + (1 - reading - taking) * progress_.part_;
}

}  // namespace espalier::document
