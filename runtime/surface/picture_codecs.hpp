#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace espalier {

// The libraries that decode pictures, libpng and libjpeg, each shut into a file: their errors are `why`, in their
// words. bytes: a whole file that begins as one of that format. Checksums aren't compared: a texture whose are wrong is
// seen as it is. Throw std::bad_alloc alone; may be called from any thread.

struct PictureSides {
    uint32_t width = 0, height = 0;
};
// By the first bytes; nothing is decoded.
bool measureJpeg(std::span<const std::byte> bytes, PictureSides& out, std::string& why);
// Red, green, blue and alpha of 8 bits, row by row.
bool decodePng(std::span<const std::byte> bytes, std::vector<uint8_t>& rgba, std::string& why);
bool decodeJpeg(std::span<const std::byte> bytes, std::vector<uint8_t>& rgba, std::string& why);
// Grey of 16 bits.
bool decodePng(std::span<const std::byte> bytes, std::vector<uint16_t>& grey, std::string& why);
bool decodeJpeg(std::span<const std::byte> bytes, std::vector<uint16_t>& grey, std::string& why);

// Of a colour, by the weights of Rec. 601.
inline uint32_t greyOf(uint32_t red, uint32_t green, uint32_t blue) {
    return (red * 77 + green * 150 + blue * 29) >> 8;
}

}  // namespace espalier
