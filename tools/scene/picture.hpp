#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace espalier::scene {

struct GreyPicture {
    uint32_t width = 0, height = 0;
    std::vector<float> texels;  // rows top to bottom, as stored: no colour space is undone
    uint64_t limited = 0;       // of the numbers in its file, which lay beyond 0 to 1; of colours with the red
};
struct PictureShape {
    uint32_t width = 0, height = 0, channels = 0;
};
struct ColourPicture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgba;  // rows top to bottom
};
struct FloatPicture {
    uint32_t width = 0, height = 0;
    std::vector<float> rgba;  // rows top to bottom
};

// PNG, JPEG and OpenEXR are read, told by their first bytes; other formats, damage, and more than 8192 texels a side
// are refused, the latter before anything is decoded. `error` names file and cause; no exception leaves these
// functions.

// The first channel of a picture (of a grey one the only, of a coloured one red), limited to [0, 1].
bool readGrey(const std::string& path, GreyPicture& out, std::string& error);
// Red, green and blue (of a grey picture thrice its only channel), limited to [0, 1] and linear: whole numbers are
// sRGB, floats are as they are. Else as readGrey.
bool readColours(const std::string& path, std::vector<GreyPicture>& channels, std::string& error);
// What readGrey would find, from the file's beginning.
bool readShape(const std::string& path, PictureShape& out, std::string& error);
bool readColour(const std::string& path, ColourPicture& out, std::string& error);
// Up to 16384 texels a side with all the precision that the file has; whole numbers as parts of their greatest.
bool readFloats(const std::string& path, FloatPicture& out, std::string& error);

// sRGB's curve: from linear, and to it.
float srgbOf(float linear);
float linearOf(float srgb);

// A picture's file in memory, of one channel, or of red, green and blue, linear and of one size: as .png with 16 bits,
// colours as sRGB; as .exr with floats as they are. path: by its ending, and for `error`. `goOn` is told now and then
// how much is encoded, 0 to 1; when it returns false nothing comes of it.
bool encodeChannels(const std::string& path, std::span<const GreyPicture> channels, std::vector<uint8_t>& bytes,
                    std::string& error, const std::function<bool(float)>& goOn = {});

// Writes one channel so, as writeText does (text_file.hpp).
bool writeGrey(const std::string& path, const GreyPicture& picture, std::string& error);

// A PNG's file in memory, of rows top to bottom, with alpha or without. path: for `error`. effort: 1, quick, to 9,
// small.
bool encodePng(const std::string& path, const uint8_t* rgba, uint32_t width, uint32_t height, bool alpha, int effort,
               std::vector<uint8_t>& bytes, std::string& error);
// Writes a PNG as writeText does (text_file.hpp).
bool writePng(const std::string& path, const uint8_t* rgba, uint32_t width, uint32_t height, std::string& error);

}  // namespace espalier::scene
