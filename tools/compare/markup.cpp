#include "tools/compare/markup.hpp"

#include <cstdint>

namespace espalier::compare {
namespace {

// Bytes of the UTF-8 character at `at`; 0: there is none.
size_t lengthAt(const std::string& text, size_t at) {
    const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : uint8_t(0); };
    const uint8_t first = byte(at);
    const size_t length = first < 0x80                    ? 1
                          : first >= 0xC2 && first < 0xE0 ? 2
                          : (first & 0xF0) == 0xE0        ? 3
                          : first >= 0xF0 && first < 0xF5 ? 4
                                                          : 0;
    uint32_t code = length == 1 ? first : first & (0xFFu >> (length + 1));
    for (size_t i = 1; i < length; ++i) {
        if ((byte(at + i) & 0xC0) != 0x80) return 0;
        code = code << 6 | (byte(at + i) & 0x3F);
    }
    const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
    const bool none = code == 0xFFFE || code == 0xFFFF || (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF;
    const bool control = code < 0x20 && code != '\t' && code != '\n' && code != '\r';
    return overlong || none || control ? 0 : length;
}

}  // namespace

std::string escaped(const std::string& text) {
    std::string out;
    for (size_t at = 0; at < text.size();) {
        const size_t length = lengthAt(text, at);
        if (length == 0) {
            out += "\xEF\xBF\xBD";
            ++at;
            continue;
        }
        switch (text[at]) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\'':
                out += "&#39;";
                break;
            default:
                out += text.substr(at, length);
        }
        at += length;
    }
    return out;
}

}  // namespace espalier::compare
