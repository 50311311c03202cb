#pragma once

#include <string>
#include <string_view>

#include "tools/scene/folder.hpp"

namespace espalier::scene {

// A file that becomes whole or not at all: it is written under a name that nobody can foresee, where nothing was, and
// then takes its place. What doesn't come so far is removed. `error` names the file and the cause.
class Unfinished {
  public:
    // A file that the user has named: what a link leads to is replaced, not the link.
    explicit Unfinished(const std::string& path);
    // A file in a folder: a link in its place is replaced. The folder is in use until this is gone.
    Unfinished(const Folder& folder, std::string name);
    ~Unfinished();
    Unfinished(const Unfinished&) = delete;

    bool write(std::string_view bytes, std::string& error);
    // After writing: so that a machine that stops has it.
    bool flush(std::string& error);
    // False: what stood there stands there still. Who may read and write the file stays as it was.
    bool take(std::string& error);
    const Folder& folder() const { return *folder_; }

    // Whether a file of this name is what an interrupted write left behind: its program has ended.
    static bool isAbandoned(const std::string& name);

  private:
    bool make(std::string& error);
    bool fail(std::string& error) const;  // by errno; false

    Folder own_;
    const Folder* folder_;
    std::string path_, name_, beside_;  // path_: for messages
    std::string why_;                   // the folder can't be opened
    int file_ = -1;
};

}  // namespace espalier::scene
