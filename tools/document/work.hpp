#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

namespace espalier::document {

// What a thread that works beside tells of itself, and is told.
class Progress {
  public:
    // How far it is, 0 to 1. False: it was called off, and is to end with nothing done.
    bool at(float part) {
        part_ = part;
        return !calledOff_;
    }

  private:
    friend class Work;
    std::atomic<float> part_ = 0;
    std::atomic<bool> calledOff_ = false;
};

// Work on files that takes long and holds nobody up: what needs the document is done on its thread, a part a step; what
// lies between, encoding and decoding and the disk, in a thread of its own. Calls come on the document's thread.
class Work {
  public:
    using Part = std::function<bool(std::string& error)>;
    struct Plan {
        std::vector<Part> before;                                   // of the document as it is when the work begins
        std::function<bool(Progress&, std::string& error)> beside;  // touches no document
        std::vector<Part> after;
        std::function<void()> takeBack = {};          // what some of `after` have done, when not all of them can
        std::shared_ptr<std::string> note = nullptr;  // for the user, when it is done
    };
    enum class State { underWay, done, failed, cancelled };

    explicit Work(Plan plan) : plan_(std::move(plan)) {}
    ~Work();  // cancels what runs beside, and waits for it
    Work(const Work&) = delete;

    // The next part, or a look at the thread. False: it is over.
    bool step();
    // What is left to be read of the document is read now, since it is about to change.
    void settle();
    // Soon it is over, with nothing changed; what can't be stopped any more is done.
    void cancel() { progress_.calledOff_ = true; }
    // All that is left, waiting for the thread. False: `error` tells why.
    bool finish(std::string& error);

    State state() const { return state_; }
    bool reading() const { return state_ == State::underWay && !thread_.valid() && !besideDone_; }
    // When it failed; before, a thread may be writing it.
    std::string error() const { return state_ == State::failed ? error_ : ""; }
    std::string note() const { return plan_.note ? *plan_.note : ""; }
    float progress() const;  // 0 to 1

  private:
    bool stepBefore();
    bool stepBeside();
    bool stepAfter();
    bool end(State state);  // false

    Plan plan_;
    Progress progress_;
    std::future<bool> thread_;  // valid: it runs
    bool besideDone_ = false;
    size_t next_ = 0;  // of `before`, then of `after`
    State state_ = State::underWay;
    std::string error_;
};

}  // namespace espalier::document
