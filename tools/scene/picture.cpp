// Files of pictures, in and out.
#include "tools/scene/picture.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

constexpr int kMaxSide = 8192;

std::string systemReason() {
    return std::strerror(errno ? errno : EIO);
}

std::unique_ptr<OIIO::ImageInput> openPicture(const std::string& path, std::string& error) {
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
    if (spec.width < 1 || spec.height < 1 || spec.width > kMaxSide || spec.height > kMaxSide) {
        error = path + ": " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                " texels; 1 to 8192 a side are allowed";
        return nullptr;
    }
    return input;
}

template <class T>
bool read(const std::string& path, int channels, OIIO::TypeDesc type, uint32_t& width, uint32_t& height,
          std::vector<T>& texels, std::string& error) {
    const std::unique_ptr<OIIO::ImageInput> input = openPicture(path, error);
    if (!input) return false;
    const OIIO::ImageSpec& spec = input->spec();
    const int read = std::min(channels, spec.nchannels);
    width = uint32_t(spec.width);
    height = uint32_t(spec.height);
    texels.assign(size_t(width) * height * channels, T(channels < 4 ? 0 : type.is_floating_point() ? 1 : 255));
    if (!input->read_image(0, 0, 0, read, type, texels.data(), channels * sizeof(T))) {
        const std::string why = input->geterror();
        error = path + ": is damaged: " + why.substr(0, why.find('\n'));
        return false;
    }
    const bool greyAlpha = read == 2 && spec.alpha_channel == 1;
    if (channels == 4 && read < 3)
        for (size_t i = 0; i < texels.size(); i += 4) {
            if (greyAlpha) texels[i + 3] = texels[i + 1];
            texels[i + 1] = texels[i + 2] = texels[i];
        }
    return true;
}

}  // namespace

bool readGrey(const std::string& path, GreyPicture& out, std::string& error) {
    if (!read(path, 1, OIIO::TypeDesc::FLOAT, out.width, out.height, out.texels, error)) return false;
    for (float& texel : out.texels) texel = texel > 0 ? std::min(texel, 1.f) : 0;  // what is no number is 0, too
    return true;
}

bool readShape(const std::string& path, PictureShape& out, std::string& error) {
    const std::unique_ptr<OIIO::ImageInput> input = openPicture(path, error);
    if (!input) return false;
    out = {uint32_t(input->spec().width), uint32_t(input->spec().height), uint32_t(input->spec().nchannels)};
    return true;
}

bool readFloats(const std::string& path, FloatPicture& out, std::string& error) {
    return read(path, 4, OIIO::TypeDesc::FLOAT, out.width, out.height, out.rgba, error);
}

bool readColour(const std::string& path, ColourPicture& out, std::string& error) {
    return read(path, 4, OIIO::TypeDesc::UINT8, out.width, out.height, out.rgba, error);
}

namespace {

bool writeRows(OIIO::ImageOutput& output, const GreyPicture& picture, const std::function<bool(float)>& goOn) {
    constexpr uint32_t kRows = 256;
    for (uint32_t y = 0; y < picture.height; y += kRows) {
        if (goOn && !goOn(float(y) / float(picture.height))) return false;
        const uint32_t end = std::min(y + kRows, picture.height);
        if (!output.write_scanlines(int(y), int(end), 0, OIIO::TypeDesc::FLOAT,
                                    &picture.texels[size_t(y) * picture.width]))
            return false;
    }
    return true;
}

}  // namespace

bool writeGrey(const std::string& path, const GreyPicture& picture, std::string& error,
               const std::function<bool(float)>& goOn) {
    const bool floats = std::filesystem::path(path).extension() == ".exr";
    // By way of memory: the picture library doesn't tell of a disk that is full. It outlives the output, which writes
    // into it to its own end where it wasn't closed.
    OIIO::Filesystem::IOVecOutput bytes;
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path);
    OIIO::ImageSpec spec(int(picture.width), int(picture.height), 1,
                         floats ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT16);
    spec["png:compressionLevel"] = 1;
    spec["compression"] = "zips";
    spec["DateTime"] = "1970:01:01 00:00:00";  // else EXR holds when it was written, and no two files are the same
    spec.channelnames = {"Y"};
    const bool good = output && output->set_ioproxy(&bytes) && output->open(path, spec) &&
                      writeRows(*output, picture, goOn) && output->close();
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
