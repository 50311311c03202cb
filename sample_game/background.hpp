#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "tools/document/work.hpp"

namespace sample {

// Work on files between the frames: one after another, in the order in which it was asked for.
class Background {
  public:
    struct Job {
        std::string title;  // such as "Saving garden"; empty: nobody sees it, and it gives way to whatever is asked for
        std::function<espalier::document::Work::Plan()> plan;  // of the document as it is when its turn comes
        std::function<void(const espalier::document::Work&)> ended;
        bool cancelled = false;           // before its turn has come
        bool leavesWithDocument = false;  // it brings something to the document, and is called off with it
    };
    // A job that waits and has the same title is what was asked for now.
    void ask(Job job);
    // Once a frame. True: it has come further, or is over.
    bool step();
    // Before the document changes.
    void settle();
    void cancel();      // what is under way
    void cancelLast();  // what was asked for last, under way or not
    void giveWay();     // what nobody sees
    void leave();       // the document goes: what would bring something to it is called off
    void finish();      // all of it, waiting
    bool busy() const { return !jobs_.empty(); }
    bool started() const { return work_ != nullptr; }

    // What is under way, or comes next; busy().
    const std::string& title() const { return jobs_.front().title; }
    float progress() const { return work_ ? work_->progress() : 0; }
    // It takes so long by now that the user is to see it.
    bool slow() const;

  private:
    void begin();
    void end();

    std::deque<Job> jobs_;  // the first is under way, if there is work
    std::unique_ptr<espalier::document::Work> work_;
    double asked_ = 0;  // when the first came to be the first
};

}  // namespace sample
