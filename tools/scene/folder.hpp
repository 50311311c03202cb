#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace espalier::scene {

// A folder that is held open. Names are looked up in it and nowhere else: one that would lead on ("a/b", "..") is
// refused, and what is a link is told as one and never followed. `error` names the path and the cause.
class Folder {
  public:
    Folder() = default;
    ~Folder();
    Folder(Folder&& other) noexcept;
    Folder& operator=(Folder&& other) noexcept;

    // By a path that the user has named: links on the way to it and at its end are followed.
    static Folder at(const std::string& path, std::string& error);
    // A folder in this one. make: where there is none.
    Folder in(const std::string& name, bool make, std::string& error) const;

    explicit operator bool() const { return handle_ >= 0; }
    int handle() const { return handle_; }
    const std::string& path() const { return path_; }
    std::string pathOf(const std::string& name) const;

    bool holdsFile(const std::string& name) const;  // an ordinary one
    bool holdsLink(const std::string& name) const;
    std::vector<std::string> names() const;
    // A file or a link; nothing where there is neither.
    void remove(const std::string& name) const;
    // A folder in this one, if it is empty.
    void removeFolder(const std::string& name) const;
    // Makes what was renamed and removed in it known to the disk.
    bool flush(std::string& error) const;

    // Whether it can be the name of something in a folder.
    static bool isName(std::string_view text);

  private:
    int handle_ = -1;
    std::string path_;
};

}  // namespace espalier::scene
