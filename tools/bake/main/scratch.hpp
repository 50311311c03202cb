#pragma once

// A folder for what a run has under way.

#include <string>

#include "runtime/core/result.hpp"

namespace espalier::folder {

// Goes with the run. Where that is killed, the next run of this machine takes it away.
class Scratch {
  public:
    Scratch() = default;
    ~Scratch();
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    // Below the folder `at`, which is made if need be.
    Status make(const std::string& at);
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

}  // namespace espalier::folder
