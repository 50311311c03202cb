#pragma once

#include <functional>
#include <string>

namespace espalier::document {

using WriteFile = std::function<bool(const std::string& path, std::string& error)>;

// A file that becomes whole or not at all, whenever the program or the machine stops: it is written beside its place,
// flushed to the disk, and then takes its place, or that of what a link leads to. What doesn't come so far is removed.
class Unfinished {
  public:
    explicit Unfinished(const std::string& path);
    ~Unfinished();
    Unfinished(const Unfinished&) = delete;
    // `make` makes the file of the name that it is given, which has the ending of the path. False: `error` tells file
    // and cause.
    bool write(const WriteFile& make, std::string& error);
    // False: what stood there stands there still, or the new file does and the folder can't be flushed.
    bool take(std::string& error);

  private:
    std::string path_, place_, folder_, beside_;  // place_: behind links
    bool taken_ = false;
};

// Both.
bool writeDurably(const std::string& path, const WriteFile& make, std::string& error);
bool writeTextDurably(const std::string& path, const std::string& text, std::string& error);

// With all folders on the way to it, each known to the disk. False: `error` tells folder and cause.
bool makeFolderDurably(const std::string& folder, std::string& error);

// Whether a file of this name is what an interrupted write left behind: its program has ended.
bool isAbandoned(const std::string& name);

}  // namespace espalier::document
