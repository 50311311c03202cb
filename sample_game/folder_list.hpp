#pragma once

// What can be clicked instead of typing a path.

#include <cstdint>
#include <string>
#include <vector>

namespace sample {

struct FolderEntry {
    enum Kind { folder, project, file };
    std::string name;  // as it is shown; "..": the folder above
    std::string
        path;  // as it would be typed: of folders with a slash at the end, which leads into them; not of projects
    Kind kind;
    std::string detail = {};  // when it was written and, of a file, how large it is; empty: that isn't known
};

// Of the folder that `typed` names or lies in; "" and names without a slash: of the current one. Folders before files,
// each by name; hidden ones and files that end otherwise than `endings` are left out, and all beyond the first 400.
// A folder that can't be read has the one above it only.
std::vector<FolderEntry> listFolder(const std::string& typed, const std::vector<std::string>& endings);

// "640 B", "12 KB", "3.4 MB": in powers of 1000.
std::string sizeInWords(uint64_t bytes);

// A path as a shell takes it: ~ and what begins with ~/ lie in the user's folder.
std::string expanded(const std::string& typed);

// With the current folder before it, as it is told to the user.
std::string wholePath(const std::string& path);

// The path, or else NAME-2, NAME-3 ... before the ending that it has: the first where nothing lies.
std::string freeName(const std::string& path, const std::string& ending = {});

}  // namespace sample
