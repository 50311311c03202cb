#pragma once

// PNG files of one colour.

#include <zlib.h>

#include <array>
#include <cstdint>
#include <string>

namespace espalier::test {

inline std::string rgbPng(uint32_t side, std::array<uint8_t, 3> colour) {
    const auto bigEndian = [](uint32_t value) {
        return std::string{char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
    };
    std::string rows;
    for (uint32_t y = 0; y < side; ++y) {
        rows += '\0';
        for (uint32_t x = 0; x < side; ++x) rows.append(reinterpret_cast<const char*>(colour.data()), 3);
    }
    std::string packed(compressBound(uLong(rows.size())), '\0');
    uLongf size = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()), rows.size());
    packed.resize(size);
    const auto chunk = [&](const std::string& name, const std::string& data) {
        const std::string body = name + data;
        return bigEndian(uint32_t(data.size())) + body +
               bigEndian(uint32_t(crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()))));
    };
    return "\x89PNG\r\n\x1A\n" + chunk("IHDR", bigEndian(side) + bigEndian(side) + std::string("\x08\x02\0\0\0", 5)) +
           chunk("IDAT", packed) + chunk("IEND", "");
}

inline std::string greyPng(uint32_t side, uint8_t grey) {
    return rgbPng(side, {grey, grey, grey});
}

}  // namespace espalier::test
