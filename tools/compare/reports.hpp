#pragma once

#include <string>
#include <vector>

#include "tools/compare/comparison.hpp"

namespace espalier::compare {

// JUnit's XML, as continuous integration reads it: a test case for each picture, a failure for one that differs, an
// error for one that can't be compared.
std::string junitOf(const std::vector<Comparison>& all);

// {"tolerance", "share", "alike", "different", "unknown", "pictures": [{"name", "verdict", ...}]}, see
// docs/frame_capture_tests.md.
std::string jsonOf(const std::vector<Comparison>& all, const Limits& limits);

// A page that shows pairs side by side, under a slider. Pictures lie beside it; nothing is loaded from elsewhere.
// Written as index.html into a folder, one pair after the other, so that not all pictures are in memory.
class Page {
  public:
    explicit Page(std::string folder) : folder_(std::move(folder)) {}
    // Each returns false where something can't be written: `error` names file and cause.
    bool begin(std::string& error) const;
    bool add(const Comparison& found, const Limits& limits, std::string& error);  // with the pictures that it kept
    bool finish(std::string& error) const;

  private:
    std::string folder_, rows_;
    size_t pictures_ = 0, shown_ = 0, different_ = 0;
};

}  // namespace espalier::compare
