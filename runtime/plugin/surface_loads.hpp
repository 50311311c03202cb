#pragma once

// A context's surfaces that load beside its frames: their tickets, and the thread that reads and unpacks files.

#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "runtime/plugin/surface_read.hpp"

namespace espalier {

class SurfaceLoads {
  public:
    struct Limits {
        uint64_t bytesPerUpdate = 64ull << 20, bytesAhead = 256ull << 20;
    };
    struct State {
        EspLoadState state = ESP_LOAD_READING;
        EspSurface surface{};
        EspResult result = ESP_OK;
        std::string message;
        uint64_t bytes = 0;
    };

    explicit SurfaceLoads(EspContext& context) : context_(context) {}
    ~SurfaceLoads();  // waits for what the thread is at
    SurfaceLoads(const SurfaceLoads&) = delete;

    // file: nothing where it is still to be read from the disk. into: the streamed surface that it is for; 0: a new
    // one.
    uint32_t begin(SurfaceRequest request, std::optional<std::vector<std::byte>> file, uint32_t into = 0);
    const State* find(uint32_t id) const;
    bool end(uint32_t id);
    void limit(const Limits& limits);

    // What isn't placed yet begins anew: the device is about to go.
    void beginAnew();

    // Takes memory for what has been read, and places what has been uploaded.
    void advance();

  private:
    // Who may touch a load's file and what was read of it: the thread while it `reads` and `fills`, else the context's.
    enum class Step { waits, reads, hasRead, fills, filled, over };
    struct Load {
        Step step = Step::waits;  // under mutex_
        bool ended = false;       // under mutex_
        uint32_t into = 0;
        SurfaceRequest request;
        std::optional<std::vector<std::byte>> file;
        std::optional<SurfaceRead> read;
        std::optional<Failure> failure;  // of reading
        EspResult failed = ESP_OK;
        State state;
    };

    void startThread();
    void stopThread();
    void work(std::stop_token stop);
    Load* nextJob();  // under mutex_
    void read(Load& load) noexcept;
    void take(Load& load);
    void place(Load& load);
    void fail(Load& load, EspResult result, std::string message);

    EspContext& context_;
    bool roots_ = rootsOf(context_);
    static bool rootsOf(const EspContext& context);
    Limits limits_;       // under mutex_
    bool rests_ = false;  // the thread takes no more jobs; under mutex_
    uint64_t ahead_ = 0;  // bytes that have been read and aren't on their way; under mutex_
    uint32_t last_ = 0;   // id
    std::map<uint32_t, std::unique_ptr<Load>> loads_;  // in the order in which they were begun; its shape under mutex_
    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    std::jthread thread_;  // from the first load on
};

// Made when they are first asked for.
SurfaceLoads& loadsOf(EspContext& context);

}  // namespace espalier
