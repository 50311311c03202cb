#pragma once

#include <string>
#include <vector>

namespace espalier::compare {

// Pictures of one name in two folders and the folders in these. A name that only one of them has has one empty file.
struct Pair {
    std::string name, first, second;
};
// By name. False: `error` says which folder can't be read, or that neither has a picture.
bool pairsOf(const std::string& first, const std::string& second, std::vector<Pair>& out, std::string& error);

}  // namespace espalier::compare
