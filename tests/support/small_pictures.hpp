#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

namespace espalier::test {

// Beginnings of pictures' files that state a size, whatever follows.

inline std::string bigEndian(uint64_t value, int bytes) {
    std::string text;
    for (int i = bytes; i-- > 0;) text += char(value >> (8 * i));
    return text;
}

inline std::string littleEndian(uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += char(value >> (8 * i));
    return text;
}

inline std::string pngOf(uint64_t width, uint64_t height) {
    return "\x89PNG\r\n\x1A\n" + bigEndian(13, 4) + "IHDR" + bigEndian(width, 4) + bigEndian(height, 4) +
           std::string("\x08\0\0\0\0", 5) + std::string(40, '\0');
}

// With so many scans, which are empty.
inline std::string jpegOf(uint64_t width, uint64_t height, int scans = 1) {
    std::string text = "\xFF\xD8\xFF\xC2" + bigEndian(11, 2) + "\x08" + bigEndian(height, 2) + bigEndian(width, 2) +
                       std::string("\x01\x01\x11\0", 4);
    for (int i = 0; i < scans; ++i) text += "\xFF\xDA" + bigEndian(8, 2) + std::string("\x01\x01\0\0\0\0", 6);
    return text + "\xFF\xD9";
}

inline std::string exrAttribute(const std::string& name, const std::string& type, const std::string& data) {
    return name + '\0' + type + '\0' + littleEndian(data.size(), 4) + data;
}

// One channel of floats in a window whose first texel is `low`. more: further attributes.
inline std::string exrOf(int64_t low, int64_t high, uint32_t flags = 0, const std::string& more = "") {
    std::string window;
    for (const int64_t side : {low, low, high, high}) window += littleEndian(uint64_t(side), 4);
    return "\x76\x2F\x31\x01" + littleEndian(2 | flags, 4) +
           exrAttribute("channels", "chlist",
                        std::string("Y\0", 2) + littleEndian(2, 4) + std::string(4, '\0') + littleEndian(1, 4) +
                            littleEndian(1, 4) + '\0') +
           exrAttribute("compression", "compression", std::string(1, '\0')) +
           exrAttribute("dataWindow", "box2i", window) + exrAttribute("displayWindow", "box2i", window) +
           exrAttribute("lineOrder", "lineOrder", std::string(1, '\0')) +
           exrAttribute("pixelAspectRatio", "float", littleEndian(0x3F800000, 4)) +
           exrAttribute("screenWindowCenter", "v2f", std::string(8, '\0')) +
           exrAttribute("screenWindowWidth", "float", littleEndian(0x3F800000, 4)) + more + '\0' +
           std::string(64, '\0');
}

}  // namespace espalier::test
