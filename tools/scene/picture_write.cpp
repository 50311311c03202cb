// Pictures' files out: encoded in memory first, since the picture library doesn't tell of a disk that is full.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "tools/scene/picture.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

using Channels = std::span<const GreyPicture>;

// Rows y to end, channels beside each other.
std::vector<float> rowsOf(Channels channels, uint32_t y, uint32_t end, bool srgb) {
    const size_t first = size_t(y) * channels[0].width, count = size_t(end - y) * channels[0].width;
    std::vector<float> rows(count * channels.size());
    for (size_t i = 0; i < count; ++i)
        for (size_t c = 0; c < channels.size(); ++c) {
            const float texel = channels[c].texels[first + i];
            rows[i * channels.size() + c] = srgb ? srgbOf(texel) : texel;
        }
    return rows;
}

bool writeRows(OIIO::ImageOutput& output, Channels channels, bool srgb, const std::function<bool(float)>& goOn) {
    constexpr uint32_t kRows = 256;
    const uint32_t height = channels[0].height;
    for (uint32_t y = 0; y < height; y += kRows) {
        if (goOn && !goOn(float(y) / float(height))) return false;
        const uint32_t end = std::min(y + kRows, height);
        if (!output.write_scanlines(int(y), int(end), 0, OIIO::TypeDesc::FLOAT, rowsOf(channels, y, end, srgb).data()))
            return false;
    }
    return true;
}

// `output` writes into `bytes`, which outlive it: what isn't closed is written to its own end.
template <class F>
bool encode(const std::string& path, const char* format, const OIIO::ImageSpec& spec, std::vector<uint8_t>& out,
            std::string& error, F&& write) {
    OIIO::Filesystem::IOVecOutput bytes(out);
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    if (!output || !output->set_ioproxy(&bytes) || !output->open(path, spec) || !write(*output) || !output->close()) {
        error = path + ": can't be written: " + (output ? output->geterror() : OIIO::geterror());
        return false;
    }
    return true;
}

}  // namespace

bool encodeChannels(const std::string& path, std::span<const GreyPicture> channels, std::vector<uint8_t>& out,
                    std::string& error, const std::function<bool(float)>& goOn) {
    const bool floats = std::filesystem::path(path).extension() == ".exr";
    OIIO::ImageSpec spec(int(channels[0].width), int(channels[0].height), int(channels.size()),
                         floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT16);
    spec["png:compressionLevel"] = 1;
    spec["compression"] = "zips";
    spec["DateTime"] = "1970:01:01 00:00:00";  // else EXR holds when it was written, and no two files are the same
    if (channels.size() == 1) spec.channelnames = {"Y"};
    return encode(path, floats ? "openexr" : "png", spec, out, error, [&](OIIO::ImageOutput& output) {
        return writeRows(output, channels, channels.size() > 1 && !floats, goOn);
    });
}

bool writeGrey(const std::string& path, const GreyPicture& picture, std::string& error) {
    std::vector<uint8_t> bytes;
    return encodeChannels(path, {&picture, 1}, bytes, error) && writeText(path, asText(bytes), error);
}

bool encodePng(const std::string& path, const uint8_t* rgba, uint32_t width, uint32_t height, bool alpha, int effort,
               std::vector<uint8_t>& out, std::string& error) {
    OIIO::ImageSpec spec(int(width), int(height), alpha ? 4 : 3, OIIO::TypeDesc::UINT8);
    spec["png:compressionLevel"] = effort;
    if (alpha) spec["oiio:UnassociatedAlpha"] = 1;
    return encode(path, "png", spec, out, error, [&](OIIO::ImageOutput& output) {
        return output.write_image(OIIO::TypeDesc::UINT8, rgba, 4, OIIO::stride_t(width) * 4);
    });
}

bool writePng(const std::string& path, const uint8_t* rgba, uint32_t width, uint32_t height, std::string& error) {
    std::vector<uint8_t> bytes;
    return encodePng(path, rgba, width, height, false, 1, bytes, error) && writeText(path, asText(bytes), error);
}

}  // namespace espalier::scene
