#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "tools/document/action.hpp"

namespace espalier::document {

// A recorded editing run: what was done in which frame, with a fixed time between frames, as lines of JSON
// (docs/frame_capture_tests.md). The first line is the head.
struct RunHead {
    static constexpr uint32_t kVersion = 2;  // 2: layers of colours, houses' looks, what erasing leads to
    uint32_t version = kVersion;
    std::string scene;  // what was opened; in the file relative to its folder
    uint32_t width = 1280, height = 720;
    float step = 1 / 30.f;  // seconds between two frames
    template <class V>
    void fields(V&& v) {
        v("espalier_run", version), v("scene", scene), v("width", width), v("height", height), v("step", step);
    }
};

struct Run {
    RunHead head;                // its scene relative to the caller's folder
    std::vector<RunLine> lines;  // frames never fall
    std::string note;            // what of the file was left out; empty: nothing
    uint32_t frames() const { return lines.empty() ? 1 : lines.back().frame + 1; }
};

// False: `error` is "file:line:column: message" of the first mistake. A last line that is cut off, as a full disk or a
// crash leaves it, is left out and noted.
bool readRun(const std::string& path, Run& out, std::string& error);

// Writes a run line by line, each at once, so that a crash loses nothing of what led to it.
class Recorder {
  public:
    // False: `error` tells file and cause.
    bool begin(const std::string& path, RunHead head, std::string& error);
    // Frame 0 comes first.
    void nextFrame() { ++frame_; }
    void note(const Action& action, uint32_t gesture);
    // The frame in which the last action stands goes on to the present one, so that the replay is as long. False:
    // `error` tells that some of the run isn't in the file.
    bool end(std::string& error);
    bool on() const { return file_ != nullptr; }
    bool failed() const { return failed_ != 0; }  // a line couldn't be written, so none is any more
    uint32_t frame() const { return frame_; }

  private:
    struct Closer {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    void write(const std::string& line);
    std::string beside(const std::string& file) const;

    std::unique_ptr<std::FILE, Closer> file_;
    std::string path_, folder_;
    int failed_ = 0;  // errno of the first line that couldn't be written
    uint32_t frame_ = 0;
    Action camera_;  // of the latest frame
};

}  // namespace espalier::document
