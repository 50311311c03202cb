// Pictures' files in. Every picture that a scene, a document or a program of ours reads comes through openPicture: what
// its first bytes say is judged before a library sees them, and no library's exception leaves this file.
#include "tools/scene/picture.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "tools/scene/guarded.hpp"
#include "tools/scene/picture_head.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
constexpr uint64_t kMaxSide = 64, kMaxFrameSide = 64;  // what is decoded at all shows all mistakes
#else
constexpr uint64_t kMaxSide = 8192, kMaxFrameSide = 16384;  // of layers; of pictures that are compared
#endif
constexpr uint64_t kMostBytes = uint64_t(1) << 31;  // of a file
constexpr uint64_t kMostWork = uint64_t(1) << 33;   // texels over all scans

// A file in memory. The library's own reader of memory believes any offset that a file states, but its reader of JPEG
// takes no other.
class Memory : public OIIO::Filesystem::IOMemReader {
  public:
    explicit Memory(const std::string& bytes) : IOMemReader(bytes.data(), bytes.size()), bytes_(bytes) {}
    size_t read(void* out, size_t size) override {
        const size_t got = pread(out, size, m_pos);
        m_pos += int64_t(got);
        return got;
    }
    size_t pread(void* out, size_t size, int64_t offset) override {
        if (offset < 0 || uint64_t(offset) >= bytes_.size()) return 0;
        const size_t got = std::min(size, bytes_.size() - size_t(offset));
        std::memcpy(out, bytes_.data() + offset, got);
        return got;
    }

  private:
    const std::string& bytes_;
};

// An open picture, and what it reads from.
struct Source {
    std::string bytes;
    Memory reader;
    std::unique_ptr<OIIO::ImageInput> input;
    explicit Source(std::string all) : bytes(std::move(all)), reader(bytes) {}
    const OIIO::ImageSpec& spec() const { return input->spec(); }
};

bool fail(const std::string& path, const std::string& why, std::string& error) {
    error = path + ": " + why.substr(0, why.find('\n'));
    return false;
}

bool damaged(const std::string& path, const std::string& why, std::string& error) {
    return fail(path, "is damaged: " + why, error);
}

// Whether the sides that the bytes state are worth decoding.
bool judge(const std::string& path, const PictureHead& head, size_t bytes, uint64_t maxSide, std::string& error) {
    const std::string size = std::to_string(head.width) + " x " + std::to_string(head.height) + " texels";
    if (head.width > maxSide || head.height > maxSide)
        return fail(path, size + "; 1 to " + std::to_string(maxSide) + " a side are allowed", error);
    if (bytes < head.leastBytes) return damaged(path, std::to_string(bytes) + " bytes are too few for " + size, error);
    if (head.scans > kMostWork / (head.width * head.height))
        return fail(path, size + " in " + std::to_string(head.scans) + " scans are too many to be decoded", error);
    return true;
}

// Opened by the library's reader of just this format, which sees the bytes that were judged.
std::unique_ptr<Source> openPicture(const std::string& path, uint64_t maxSide, std::string& error) {
    std::string bytes;
    if (!readText(path, bytes, error, kMostBytes)) return nullptr;
    PictureHead head;
    std::string why;
    if (!readPictureHead(bytes, head, why)) fail(path, why, error);
    if (!why.empty() || !judge(path, head, bytes.size(), maxSide, error)) return nullptr;
    auto source = std::make_unique<Source>(std::move(bytes));
    source->input = OIIO::ImageInput::create(head.format);
    if (!source->input || !source->input->set_ioproxy(&source->reader)) {
        fail(path, std::string("can't be read: this machine's OpenImageIO has no reader of ") + head.format, error);
        return nullptr;
    }
    OIIO::ImageSpec config, spec;
    config["oiio:UnassociatedAlpha"] = 1;  // red stays what was painted where alpha is not 1
    if (!source->input->open(path, spec, config)) {
        damaged(path, source->input->geterror(), error);
        return nullptr;
    }
    if (spec.width < 1 || spec.height < 1 || uint64_t(spec.width) > head.width || uint64_t(spec.height) > head.height ||
        spec.depth > 1 || spec.nchannels < 1) {
        damaged(path, "its header contradicts itself", error);
        return nullptr;
    }
    return source;
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

// Rows from y to end, counted from the picture's first, of the first `channels`.
bool readRows(Source& source, int y, int end, int channels, OIIO::TypeDesc type, void* out, OIIO::stride_t step) {
    const OIIO::ImageSpec& s = source.spec();
    return s.tile_width > 0 ? source.input->read_tiles(0, 0, s.x, s.x + s.width, s.y + y, s.y + end, s.z, s.z + 1, 0,
                                                       channels, type, out, step)
                            : source.input->read_scanlines(0, 0, s.y + y, s.y + end, s.z, 0, channels, type, out, step);
}

// The first `channels` of a picture that is open, or as many as it has; of what it hasn't got, `missing`. Room is made
// only as rows are there: a header may state many that never come.
template <class T>
bool readTexels(const std::string& path, Source& source, int channels, OIIO::TypeDesc type, T missing,
                std::vector<T>& texels, std::string& error) {
    constexpr int kRows = 256;  // that some compressions pack together
    const OIIO::ImageSpec& spec = source.spec();
    const int read = std::min(channels, spec.nchannels), rows = spec.tile_width > 0 ? spec.tile_height : kRows;
    const auto step = OIIO::stride_t(channels * sizeof(T));
    // As they are stored first, where all channels are alike: asked to convert them, the library takes 64 MB for any
    // picture.
    const bool alike = spec.channelformats.empty();
    const size_t inRow = size_t(spec.width) * size_t(channels);
    std::vector<uint8_t> stored;
    texels.clear();
    texels.reserve(inRow * size_t(spec.height));
    for (int y = 0; y < spec.height; y += rows) {
        const int end = std::min(y + rows, spec.height);
        stored.resize(alike ? size_t(spec.width) * size_t(end - y) * size_t(read) * spec.format.size() : 0);
        texels.resize(inRow * size_t(end), missing);
        T* to = texels.data() + inRow * size_t(y);
        if (!(alike ? readRows(source, y, end, read, OIIO::TypeDesc::UNKNOWN, stored.data(), OIIO::AutoStride)
                    : readRows(source, y, end, read, type, to, step)))
            return damaged(path, source.input->geterror(), error);
        if (alike && !OIIO::convert_image(read, spec.width, end - y, 1, stored.data(), spec.format, OIIO::AutoStride,
                                          OIIO::AutoStride, OIIO::AutoStride, to, type, step, OIIO::AutoStride,
                                          OIIO::AutoStride))
            return damaged(path, "its texels are of an unknown kind", error);
    }
    return true;
}

// Red, green, blue and alpha; of a grey picture thrice its grey.
template <class T>
bool readRgba(const std::string& path, Source& source, OIIO::TypeDesc type, T most, uint32_t& width, uint32_t& height,
              std::vector<T>& rgba, std::string& error) {
    const OIIO::ImageSpec& spec = source.spec();
    width = uint32_t(spec.width);
    height = uint32_t(spec.height);
    if (!readTexels(path, source, 4, type, most, rgba, error)) return false;
    const bool greyAlpha = spec.nchannels == 2 && spec.alpha_channel == 1;
    if (spec.nchannels == 1 || greyAlpha)
        for (size_t i = 0; i < rgba.size(); i += 4) {
            if (greyAlpha) rgba[i + 3] = rgba[i + 1];
            rgba[i + 1] = rgba[i + 2] = rgba[i];
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
    return guarded(path + ": can't be read: ", error, [&] {
        const std::unique_ptr<Source> source = openPicture(path, kMaxSide, error);
        if (!source) return false;
        out.width = uint32_t(source->spec().width);
        out.height = uint32_t(source->spec().height);
        return readTexels(path, *source, 1, OIIO::TypeDesc::FLOAT, 0.f, out.texels, error) &&
               limit(path, out.texels, out.limited, error);
    });
}

bool readColours(const std::string& path, std::vector<GreyPicture>& channels, std::string& error) {
    return guarded(path + ": can't be read: ", error, [&] {
        const std::unique_ptr<Source> source = openPicture(path, kMaxSide, error);
        if (!source) return false;
        const OIIO::ImageSpec& spec = source->spec();
        const int count = spec.nchannels < 3 ? 1 : 3;
        const size_t texels = size_t(spec.width) * size_t(spec.height);
        std::vector<float> all;
        uint64_t limited = 0;
        if (!readTexels(path, *source, count, OIIO::TypeDesc::FLOAT, 0.f, all, error) ||
            !limit(path, all, limited, error))
            return false;
        if (storesIntegers(spec)) std::ranges::transform(all, all.begin(), linearOf);
        channels.assign(3, {uint32_t(spec.width), uint32_t(spec.height), std::vector<float>(texels)});
        channels[0].limited = limited;
        for (size_t c = 0; c < 3; ++c)
            for (size_t i = 0; i < texels; ++i) channels[c].texels[i] = all[i * size_t(count) + (count == 3 ? c : 0)];
        return true;
    });
}

bool readShape(const std::string& path, PictureShape& out, std::string& error) {
    return guarded(path + ": can't be read: ", error, [&] {
        const std::unique_ptr<Source> source = openPicture(path, kMaxSide, error);
        if (!source) return false;
        const OIIO::ImageSpec& spec = source->spec();
        out = {uint32_t(spec.width), uint32_t(spec.height), uint32_t(spec.nchannels)};
        return true;
    });
}

bool readFloats(const std::string& path, FloatPicture& out, std::string& error) {
    return guarded(path + ": can't be read: ", error, [&] {
        const std::unique_ptr<Source> source = openPicture(path, kMaxFrameSide, error);
        if (!source) return false;
        if (const int channels = source->spec().nchannels; channels > 4)
            return fail(path, "has " + std::to_string(channels) + " channels; 4 at most can be compared", error);
        return readRgba(path, *source, OIIO::TypeDesc::FLOAT, 1.f, out.width, out.height, out.rgba, error);
    });
}

bool readColour(const std::string& path, ColourPicture& out, std::string& error) {
    return guarded(path + ": can't be read: ", error, [&] {
        const std::unique_ptr<Source> source = openPicture(path, kMaxSide, error);
        return source &&
               readRgba(path, *source, OIIO::TypeDesc::UINT8, uint8_t(255), out.width, out.height, out.rgba, error);
    });
}

}  // namespace espalier::scene
