#pragma once

#include <charconv>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

namespace espalier::scene {

// What JSON can hold.
inline bool isUtf8(const std::string& text) {
    try {
        (void)nlohmann::ordered_json(text).dump();
    } catch (const nlohmann::ordered_json::type_error&) {
        return false;
    }
    return true;
}

// In one line, or with so much indent. Bytes that aren't UTF-8 become U+FFFD: such a letter in a grammar's remark must
// not keep anybody from saving.
inline std::string textOf(const nlohmann::ordered_json& json, int indent = -1) {
    return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

// A float as the shortest decimal that reads as the same float: 0.1, not 0.10000000149011612.
inline nlohmann::ordered_json shortest(float value) {
    if (value > -1e6f && value < 1e6f && value == float(int(value))) return int(value);
    char text[32];
    *std::to_chars(text, text + 31, value).ptr = 0;
    return std::strtod(text, nullptr);
}

template <class Floats>
nlohmann::ordered_json shortestList(const Floats& values) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (float value : values) list.push_back(shortest(value));
    return list;
}

}  // namespace espalier::scene
