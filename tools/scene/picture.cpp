// Files of pictures, in and out.
#include "tools/scene/picture.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>

#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

constexpr int kMaxSide = 8192, kMaxFrameSide = 16384;  // of layers; of pictures that are compared

std::string systemReason() {
    return std::strerror(errno ? errno : EIO);
}

std::unique_ptr<OIIO::ImageInput> openPicture(const std::string& path, int maxSide, std::string& error) {
    if (refused(path, error)) return nullptr;
    errno = 0;
    if (!std::ifstream(path, std::ios::binary)) {
        error = path + ": can't be read: " + systemReason();
        return nullptr;
    }
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;  // red stays what was painted where alpha is not 1
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &config);
    if (!input) {
        error = path + ": isn't a picture: " + OIIO::geterror();
        return nullptr;
    }
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.width > maxSide || spec.height > maxSide) {
        error = path + ": " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " texels; 1 to " +
                std::to_string(maxSide) + " a side are allowed";
        return nullptr;
    }
    return input;
}

// Whole numbers, which pictures hold as sRGB where they are colours.
bool storesIntegers(const OIIO::ImageSpec& spec) {
    return !spec.format.is_floating_point();
}

// Into what layers hold; limited: how many weren't that. False: some are no numbers.
bool limit(const std::string& path, std::vector<float>& texels, uint64_t& limited, std::string& error) {
    const auto isNumber = [](float texel) { return std::isfinite(texel); };
    if (!std::ranges::all_of(texels, isNumber)) {
        error = path + ": holds what is no finite number";
        return false;
    }
    limited = uint64_t(std::ranges::count_if(texels, [](float texel) { return texel < 0 || texel > 1; }));
    for (float& texel : texels) texel = std::clamp(texel, 0.f, 1.f);
    return true;
}

bool damaged(const std::string& path, const OIIO::ImageInput& input, std::string& error) {
    const std::string why = input.geterror();
    error = path + ": is damaged: " + why.substr(0, why.find('\n'));
    return false;
}

// all: what can't be held of its channels is a mistake.
template <class T>
bool read(const std::string& path, int channels, OIIO::TypeDesc type, uint32_t& width, uint32_t& height,
          std::vector<T>& texels, std::string& error, bool all = false) {
    const std::unique_ptr<OIIO::ImageInput> input = openPicture(path, all ? kMaxFrameSide : kMaxSide, error);
    if (!input) return false;
    const OIIO::ImageSpec& spec = input->spec();
    const int read = std::min(channels, spec.nchannels);
    if (all && spec.nchannels > channels) {
        error = path + ": has " + std::to_string(spec.nchannels) + " channels; " + std::to_string(channels) +
                " at most can be compared";
        return false;
    }
    width = uint32_t(spec.width);
    height = uint32_t(spec.height);
    texels.assign(size_t(width) * height * channels, T(channels < 4 ? 0 : type.is_floating_point() ? 1 : 255));
    if (!input->read_image(0, 0, 0, read, type, texels.data(), channels * sizeof(T)))
        return damaged(path, *input, error);
    const bool greyAlpha = read == 2 && spec.alpha_channel == 1;
    if (channels == 4 && (read == 1 || greyAlpha))
        for (size_t i = 0; i < texels.size(); i += 4) {
            if (greyAlpha) texels[i + 3] = texels[i + 1];
            texels[i + 1] = texels[i + 2] = texels[i];
        }
    return true;
}

}  // namespace

float linearOf(float srgb) {
    return srgb <= .04045f ? srgb / 12.92f : std::pow((srgb + .055f) / 1.055f, 2.4f);
}
float srgbOf(float linear) {
    return linear <= .0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1 / 2.4f) - .055f;
}

bool readGrey(const std::string& path, GreyPicture& out, std::string& error) {
    if (!read(path, 1, OIIO::TypeDesc::FLOAT, out.width, out.height, out.texels, error)) return false;
    return limit(path, out.texels, out.limited, error);
}

bool readColours(const std::string& path, std::vector<GreyPicture>& channels, std::string& error) {
    const std::unique_ptr<OIIO::ImageInput> input = openPicture(path, kMaxSide, error);
    if (!input) return false;
    const OIIO::ImageSpec& spec = input->spec();
    const int count = spec.nchannels < 3 ? 1 : 3;
    const size_t texels = size_t(spec.width) * size_t(spec.height);
    std::vector<float> all(texels * size_t(count));
    if (!input->read_image(0, 0, 0, count, OIIO::TypeDesc::FLOAT, all.data())) return damaged(path, *input, error);
    uint64_t limited = 0;
    if (!limit(path, all, limited, error)) return false;
    if (storesIntegers(spec)) std::ranges::transform(all, all.begin(), linearOf);
    channels.assign(3, {uint32_t(spec.width), uint32_t(spec.height), std::vector<float>(texels)});
    channels[0].limited = limited;
    for (size_t c = 0; c < 3; ++c)
        for (size_t i = 0; i < texels; ++i) channels[c].texels[i] = all[i * size_t(count) + (count == 3 ? c : 0)];
    return true;
}

bool readShape(const std::string& path, PictureShape& out, std::string& error) {
    const std::unique_ptr<OIIO::ImageInput> input = openPicture(path, kMaxSide, error);
    if (!input) return false;
    out = {uint32_t(input->spec().width), uint32_t(input->spec().height), uint32_t(input->spec().nchannels)};
    return true;
}

bool readFloats(const std::string& path, FloatPicture& out, std::string& error) {
    return read(path, 4, OIIO::TypeDesc::FLOAT, out.width, out.height, out.rgba, error, true);
}

bool readColour(const std::string& path, ColourPicture& out, std::string& error) {
    return read(path, 4, OIIO::TypeDesc::UINT8, out.width, out.height, out.rgba, error);
}

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

bool writeChannels(const std::string& path, Channels channels, std::string& error,
                   const std::function<bool(float)>& goOn) {
    const bool floats = std::filesystem::path(path).extension() == ".exr";
    // By way of memory: the picture library doesn't tell of a disk that is full. It outlives the output, which writes
    // into it to its own end where it wasn't closed.
    OIIO::Filesystem::IOVecOutput bytes;
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path);
    OIIO::ImageSpec spec(int(channels[0].width), int(channels[0].height), int(channels.size()),
                         floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT16);
    spec["png:compressionLevel"] = 1;
    spec["compression"] = "zips";
    spec["DateTime"] = "1970:01:01 00:00:00";  // else EXR holds when it was written, and no two files are the same
    if (channels.size() == 1) spec.channelnames = {"Y"};
    const bool good = output && output->set_ioproxy(&bytes) && output->open(path, spec) &&
                      writeRows(*output, channels, channels.size() > 1 && !floats, goOn) && output->close();
    if (!good) {
        error = path + ": can't be written: " + (output ? output->geterror() : OIIO::geterror());
        return false;
    }
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.buffer().data()), std::streamsize(bytes.buffer().size()));
    file.close();
    if (!file) error = path + ": can't be written: " + systemReason();
    return bool(file);
}

}  // namespace

bool writeGrey(const std::string& path, const GreyPicture& picture, std::string& error,
               const std::function<bool(float)>& goOn) {
    return writeChannels(path, {&picture, 1}, error, goOn);
}

bool writeColours(const std::string& path, const std::vector<GreyPicture>& channels, std::string& error,
                  const std::function<bool(float)>& goOn) {
    return writeChannels(path, channels, error, goOn);
}

bool writePng(const std::string& path, const uint8_t* rgba, uint32_t width, uint32_t height, std::string& error) {
    OIIO::Filesystem::IOVecOutput bytes;  // as in writeGrey
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("png");
    OIIO::ImageSpec spec(int(width), int(height), 3, OIIO::TypeDesc::UINT8);
    spec["png:compressionLevel"] = 1;
    const bool good = output && output->set_ioproxy(&bytes) && output->open(path, spec) &&
                      output->write_image(OIIO::TypeDesc::UINT8, rgba, 4, OIIO::stride_t(width) * 4) && output->close();
    if (!good) {
        error = path + ": can't be written: " + (output ? output->geterror() : OIIO::geterror());
        return false;
    }
    return writeText(path, {reinterpret_cast<const char*>(bytes.buffer().data()), bytes.buffer().size()}, error);
}

}  // namespace espalier::scene
