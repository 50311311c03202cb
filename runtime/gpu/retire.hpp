#pragma once

#include <deque>
#include <functional>
#include <new>
#include <vector>

#include "runtime/gpu/functions.hpp"
#include "runtime/gpu/memory.hpp"

namespace espalier {

// Dropped objects wait here until every recording that was begun before the drop has finished or been discarded:
// only those can name the object. Recordings have serial numbers in the order in which they were begun.
class RetireQueue {
  public:
    ~RetireQueue() { flush(); }

    uint64_t beginRecording();
    void recordingSubmitted(uint64_t serial, uint64_t timelineValue);
    void recordingIntoHost(uint64_t serial, uint64_t frame);
    void recordingDiscarded(uint64_t serial);
    // The host has submitted all that it had recorded, so a submission of ours that follows it on the queue, with this
    // value, finishes no earlier.
    void hostSubmitted(uint64_t timelineValue);

    // Called where nothing may be thrown. Without the host's memory for a place to wait in, what no recording can name
    // is destroyed at once, and anything else never.
    template <class Destroy>
    void add(const Destroy& destroy) noexcept {
        try {
            entries_.push_back({lastSerial_, destroy});
        } catch (const std::bad_alloc&) {
            if (recordings_.empty()) destroy();
        }
    }
    // All work up to these points is done.
    void collect(uint64_t timelineValue, uint64_t hostFrame);
    // Nothing runs any more.
    void flush();
    size_t size() const { return entries_.size(); }
    // Whether anything was ever recorded for a host to submit.
    bool knowsHost() const { return knowsHost_; }
    // Recordings before this one have finished.
    uint64_t oldestPending() const { return recordings_.empty() ? lastSerial_ + 1 : recordings_.front().serial; }

  private:
    struct Recording {
        uint64_t serial;
        enum { open, submitted, host } stage;
        uint64_t value;              // of the timeline, or the host's frame
        uint64_t following = ~0ull;  // of the timeline: a submission behind the host's frame
    };
    struct Entry {
        uint64_t serial;  // the newest recording that may use it
        std::function<void()> destroy;
    };
    Recording& find(uint64_t serial);

    uint64_t lastSerial_ = 0;
    bool knowsHost_ = false;
    std::vector<Recording> recordings_;  // not known to be finished, by serial
    std::deque<Entry> entries_;          // by serial
};

}  // namespace espalier
