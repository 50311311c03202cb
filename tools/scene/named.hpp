#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>

namespace espalier::scene {

// The value of an enum by its name in files; `names` are in the order of its values. False: none has this name.
template <class Enum, size_t N>
bool valueNamed(const char* const (&names)[N], const std::string& name, Enum& out) {
    const auto found = std::find(std::begin(names), std::end(names), name);
    if (found == std::end(names)) return false;
    out = Enum(found - std::begin(names));
    return true;
}

}  // namespace espalier::scene
