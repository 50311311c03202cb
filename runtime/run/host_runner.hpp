#pragma once

// Runs lists of stages as native code.

#include <map>
#include <string>

#include "runtime/core/growth_watch.hpp"
#include "runtime/core/jobs.hpp"
#include "runtime/run/stage.hpp"

namespace espalier {

using PassTimes = std::map<std::string, double, std::less<>>;  // milliseconds of passes by their names

class HostRunner {
  public:
    // threads: as a Crew's. plain: items go one by one, as a debugger likes it, and not side by side in the processor's
    // vectors; the result is the same.
    explicit HostRunner(unsigned threads = 0, bool plain = false) : crew_(threads), plain_(plain) {}

    // Runs each stage to its end. All addresses in its environment are pointers, and nothing else uses that memory
    // meanwhile. False: `watch` has stopped it, and what a stage has begun may not be whole. times: wall time is added
    // there.
    bool run(StageList& list, GrowthWatch* watch = nullptr, PassTimes* times = nullptr);

  private:
    bool runOnce(Stage& stage, uint32_t wave, GrowthWatch* watch);

    Crew crew_;
    bool plain_;
};

}  // namespace espalier
