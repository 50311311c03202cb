#pragma once

// What can be clicked instead of typing a path.

#include <string>
#include <vector>

namespace sample {

struct FolderEntry {
    enum Kind { folder, project, file };
    std::string name;  // as it is shown; "..": the folder above
    std::string path;  // as it would be typed: of folders with a slash at the end
    Kind kind;
};

// Of the folder that `typed` names or lies in; "" and names without a slash: of the current one. Folders before files,
// each by name; hidden ones and files that end otherwise than `endings` are left out, and all beyond the first 400.
// A folder that can't be read has the one above it only.
std::vector<FolderEntry> listFolder(const std::string& typed, const std::vector<std::string>& endings);

// With the current folder before it, as it is told to the user.
std::string wholePath(const std::string& path);

}  // namespace sample
