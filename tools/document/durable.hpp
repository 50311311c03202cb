#pragma once

#include <functional>
#include <string>

namespace espalier::document {

// Makes a file whole or not at all, whenever the program or the machine stops: it is written beside its place, flushed
// to the disk, and then takes its place. `write` makes the file of the name it is given, which has the ending of
// `path`. False: `error` tells file and cause, what stood at `path` stands there still.
bool writeDurably(const std::string& path, const std::function<bool(const std::string&, std::string&)>& write,
                  std::string& error);
bool writeTextDurably(const std::string& path, const std::string& text, std::string& error);

// Names of files that an interrupted write left behind begin with this.
extern const char* const kUnfinished;

}  // namespace espalier::document
