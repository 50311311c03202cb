// In: bytes. Out: nothing, if all goes well; of a picture that is accepted every texel is there, and a number.
#include <zlib.h>

#include <cmath>
#include <vector>

#include "runtime/surface/picture.hpp"
#include "tests/fuzz/promise.hpp"
#include "tools/scene/picture.hpp"

namespace espalier::fuzz {
namespace {

// The same with the checksum that belongs to each chunk of a PNG: nearly every change would else be refused for it.
std::vector<uint8_t> repaired(Bytes bytes) {
    std::vector<uint8_t> out(bytes.begin(), bytes.end());
    const auto put = [&](size_t at, uint32_t value) {
        for (size_t i = 0; i < 4; ++i) out[at + i] = uint8_t(value >> (24 - 8 * i));
    };
    for (size_t at = 8; at + 12 <= out.size();) {
        const size_t size = size_t(out[at]) << 24 | size_t(out[at + 1]) << 16 | size_t(out[at + 2]) << 8 | out[at + 3];
        if (size > out.size() - at - 12) break;
        put(at + 8 + size, uint32_t(crc32(0, out.data() + at + 4, uInt(size + 4))));
        at += 12 + size;
    }
    return out;
}

bool areNumbers(const scene::GreyPicture& picture) {
    for (const float texel : picture.texels)
        if (!(texel >= 0 && texel <= 1)) return false;
    return picture.texels.size() == size_t(picture.width) * picture.height && picture.width > 0 && picture.height > 0;
}

void checkScenes(Bytes bytes) {
    const MemoryFile file(bytes);
    std::string error;
    scene::GreyPicture grey;
    std::vector<scene::GreyPicture> colours;
    scene::ColourPicture colour;
    scene::FloatPicture floats;
    const auto told = [&](bool read) {
        require(read || error.starts_with(file.path()), "a failure names the file");
        error.clear();
        return read;
    };
    if (told(scene::readGrey(file.path(), grey, error))) require(areNumbers(grey), "a layer has its texels, of 0 to 1");
    if (told(scene::readColours(file.path(), colours, error)))
        for (const scene::GreyPicture& channel : colours) require(areNumbers(channel), "so has each channel");
    if (told(scene::readColour(file.path(), colour, error)))
        require(colour.rgba.size() == size_t(colour.width) * colour.height * 4, "a picture has its texels");
    if (told(scene::readFloats(file.path(), floats, error)))
        require(floats.rgba.size() == size_t(floats.width) * floats.height * 4, "a frame has its texels");
}

void checkSurfaces(Bytes bytes) {
    constexpr uint64_t kMostTexels = 1 << 12;
    const auto all = std::as_bytes(bytes);
    const auto picture = decodePicture(all, "fuzzed", kMostTexels);
    if (!picture)
        checkMessage(picture.failure());
    else
        require(picture.value().rgba.size() == size_t(picture.value().width) * picture.value().height * 4,
                "a texture has its texels");
    const auto grey = decodeGrey(all, "fuzzed", 64);
    if (!grey)
        checkMessage(grey.failure());
    else
        require(grey.value().texels.size() == size_t(grey.value().width) * grey.value().height, "a map has its texels");
}

}  // namespace

void picture(Bytes bytes) {
    checkSurfaces(bytes);
    if (!textOf(bytes).starts_with("\x89PNG\r\n\x1A\n")) return checkScenes(bytes);
    checkScenes(repaired(bytes));
}

}  // namespace espalier::fuzz
