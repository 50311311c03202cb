#pragma once

#include <string>
#include <string_view>

#include "tools/scene/unfinished.hpp"

namespace espalier::document {

// Files and folders that are known to the disk before these return: whenever the program or the machine stops, a file
// is the old one or the whole new one. False: `error` names path and cause, and what stood there stands there still, or
// the new file does and its folder can't be flushed.

// Of a path that the user has named: what a link leads to is replaced.
bool writeTextDurably(const std::string& path, std::string_view text, std::string& error);
// In a folder: a link in its place is replaced.
bool writeTextDurably(const scene::Folder& folder, const std::string& name, std::string_view text, std::string& error);

// With all folders on the way to it.
bool makeFolderDurably(const std::string& folder, std::string& error);

}  // namespace espalier::document
