// In: a file's bytes, as hostile as they come. Out: its format and size. Only the three formats that the docs name go
// on to a decoder: those of other formats are hardly ever tried with damaged files.
#include "tools/scene/picture_head.hpp"

#include <algorithm>
#include <optional>

namespace espalier::scene {
namespace {

using Bytes = std::string_view;

bool fail(std::string& error, const std::string& why) {
    error = why;
    return false;
}

uint64_t bigEndian(Bytes bytes) {
    uint64_t value = 0;
    for (const char byte : bytes) value = value << 8 | uint8_t(byte);
    return value;
}

int32_t littleEndian(Bytes four) {
    uint32_t value = 0;
    for (size_t i = 4; i-- > 0;) value = value << 8 | uint8_t(four[i]);
    return int32_t(value);
}

// A side for products that can't overflow; no larger one is read.
uint64_t kept(uint64_t side) {
    return std::min(side, uint64_t(1) << 20);
}

// ---- PNG: the chunk IHDR comes first.

constexpr uint64_t kMostDeflated = 1032;  // bytes that a byte of deflated data stands for

bool readPng(Bytes bytes, PictureHead& out, std::string& error) {
    constexpr size_t kHeader = 8 + 8 + 13;  // signature, the chunk's length and name, its data
    if (bytes.size() < kHeader || bytes.substr(12, 4) != "IHDR") return fail(error, "is damaged: it has no header");
    out.width = bigEndian(bytes.substr(16, 4));
    out.height = bigEndian(bytes.substr(20, 4));
    const uint64_t depth = uint8_t(bytes[24]), type = uint8_t(bytes[25]);
    const uint64_t samples = type == 2 ? 3 : type == 4 ? 2 : type == 6 ? 4 : 1;
    out.leastBytes = (kept(out.width) * samples * depth + 7) / 8 * kept(out.height) / kMostDeflated;
    return true;
}

// ---- JPEG: segments up to the frame's header.

bool isFrame(uint8_t marker) {
    return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

bool standsAlone(uint8_t marker) {
    return marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
}

bool readJpeg(Bytes bytes, PictureHead& out, std::string& error) {
    constexpr uint64_t kMostTexels = 8 * 16 * 16;  // that a byte stands for: a bit for the largest block
    for (size_t at = 2; at + 4 <= bytes.size();) {
        const uint8_t marker = uint8_t(bytes[at + 1]);
        if (bytes[at] != '\xFF') break;
        if (marker == 0xFF || standsAlone(marker)) {
            at += marker == 0xFF ? 1 : 2;
            continue;
        }
        if (isFrame(marker)) {
            if (at + 9 > bytes.size()) break;
            out.height = bigEndian(bytes.substr(at + 5, 2));
            out.width = bigEndian(bytes.substr(at + 7, 2));
            out.leastBytes = out.width * out.height / kMostTexels;
            // What is no marker has no 0xFF 0xDA: coded data have a 0 after 0xFF.
            out.scans = 0;
            for (size_t scan = bytes.find("\xFF\xDA"); scan != Bytes::npos; scan = bytes.find("\xFF\xDA", scan + 2))
                ++out.scans;
            // The library would take what is missing for grey.
            const size_t end = bytes.rfind("\xFF\xD9"), last = bytes.rfind("\xFF\xDA");
            const bool ends = last == Bytes::npos || (end != Bytes::npos && end > last);
            return ends || fail(error, "is damaged: it is cut off");
        }
        if (marker == 0xD9 || marker == 0xDA) break;  // its end, or texels before the header
        at += 2 + bigEndian(bytes.substr(at + 2, 2));
    }
    return fail(error, "is damaged: it has no header");
}

// ---- OpenEXR: attributes, each with name, type and size; of several parts, several lists of them.

class ExrReader {
  public:
    explicit ExrReader(Bytes bytes) : bytes_(bytes), rest_(bytes.substr(std::min<size_t>(8, bytes.size()))) {}

    bool read(PictureHead& out, std::string& error) {
        constexpr uint32_t kDeep = 0x800, kParts = 0x1000;
        if (bytes_.size() < 8) return fail(error, "is damaged: it has no header");
        const uint32_t flags = uint32_t(littleEndian(bytes_.substr(4, 4)));
        if (flags & kDeep) return fail(error, "holds deep data, which can't be read; save it as a flat picture");
        do {
            if (!readPart(error)) return false;
            out.width = std::max(out.width, width_);
            out.height = std::max(out.height, height_);
        } while ((flags & kParts) && !rest_.empty() && rest_.front() != 0);
        return true;
    }

  private:
    bool readPart(std::string& error) {
        width_ = height_ = channels_ = 0;
        for (;;) {
            const auto name = word();
            if (name && name->empty()) break;
            const auto type = word(), size = take(4);
            const auto data = size ? take(uint32_t(littleEndian(*size))) : std::nullopt;
            if (!name || !type || !data) return fail(error, "is damaged: its header is cut off");
            if (!hasSizeOf(*type, *data)) return fail(error, "is damaged: its header contradicts itself");
            if (*name == "dataWindow" && data->size() == 16) readWindow(*data);
            if (*name == "channels") countChannels(*data);
            if (*name == "tiles" && data->size() == 9 && !readTiles(*data))
                return fail(error, "has tiles of more than " + std::to_string(kMostTile) + " texels a side");
            if (*name == "type" && data->starts_with("deep"))
                return fail(error, "holds deep data, which can't be read; save it as a flat picture");
        }
        if (kept(width_) * channels_ > kMostInRow)
            return fail(error, "has " + std::to_string(channels_) + " channels, too many for its width");
        return true;
    }
    // Up to the next 0.
    std::optional<Bytes> word() {
        const size_t end = rest_.substr(0, 256).find('\0');
        if (end == Bytes::npos) return std::nullopt;
        const Bytes text = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return text;
    }
    std::optional<Bytes> take(size_t size) {
        if (size > rest_.size()) return std::nullopt;
        const Bytes taken = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return taken;
    }
    void readWindow(Bytes box) {
        const auto side = [&](size_t low, size_t high) {
            return uint64_t(std::max<int64_t>(
                0, int64_t(littleEndian(box.substr(high, 4))) - littleEndian(box.substr(low, 4)) + 1));
        };
        width_ = std::max(width_, side(0, 8));  // where it comes twice
        height_ = std::max(height_, side(4, 12));
    }
    bool readTiles(Bytes tiles) {
        const auto fits = [](int32_t side) { return side >= 1 && side <= kMostTile; };
        return fits(littleEndian(tiles.substr(0, 4))) && fits(littleEndian(tiles.substr(4, 4)));
    }
    // Each is a name, a 0, and 16 bytes; an empty name ends the list. What is left behind that.
    static Bytes behindChannels(Bytes list, uint64_t& count) {
        for (size_t end = list.find('\0'); end != Bytes::npos && end + 17 <= list.size(); end = list.find('\0')) {
            if (end == 0) break;
            list.remove_prefix(end + 17);
            ++count;
        }
        return list;
    }
    void countChannels(Bytes list) { (void)behindChannels(list, channels_); }
    // The library reads what the type wants, whatever size is stated, and would take what follows for something else.
    static bool hasSizeOf(Bytes type, Bytes data) {
        uint64_t ignored = 0;
        if (type == "chlist") return behindChannels(data, ignored) == Bytes("\0", 1);
        if (type == "preview")
            return data.size() >= 8 &&
                   uint64_t(uint32_t(littleEndian(data.substr(0, 4)))) * uint32_t(littleEndian(data.substr(4, 4))) ==
                       (data.size() - 8) / 4;
        const auto fixed = std::ranges::find(kSizes, type, &TypeSize::type);
        return fixed == std::end(kSizes) || fixed->bytes == data.size();
    }

    struct TypeSize {
        Bytes type;
        size_t bytes;
    };
    static constexpr TypeSize kSizes[] = {
        {"box2i", 16},
        {"box2f", 16},
        {"chromaticities", 32},
        {"compression", 1},
        {"deepImageState", 1},
        {"double", 8},
        {"envmap", 1},
        {"float", 4},
        {"int", 4},
        {"keycode", 28},
        {"lineOrder", 1},
        {"m33d", 72},
        {"m33f", 36},
        {"m44d", 128},
        {"m44f", 64},
        {"rational", 8},
        {"tiledesc", 9},
        {"timecode", 8},
        {"v2d", 16},
        {"v2f", 8},
        {"v2i", 8},
        {"v3d", 24},
        {"v3f", 12},
        {"v3i", 12},
    };
    static constexpr int32_t kMostTile = 4096;
    static constexpr uint64_t kMostInRow = 1 << 20;  // values
    Bytes bytes_, rest_;
    uint64_t width_ = 0, height_ = 0, channels_ = 0;  // of the part
};

bool readExr(Bytes bytes, PictureHead& out, std::string& error) {
    return ExrReader(bytes).read(out, error);
}

// ---- All formats: those that are read, and those that a message names.

struct Format {
    Bytes begins;
    const char* name;
    bool (*read)(Bytes, PictureHead&, std::string&) = nullptr;  // null: it isn't read
};
const Format kFormats[] = {
    {"\x89PNG\r\n\x1A\n", "png", readPng},
    {"\xFF\xD8\xFF", "jpeg", readJpeg},
    {"\x76\x2F\x31\x01", "openexr", readExr},
    {"GIF", "a GIF"},
    {"BM", "a BMP"},
    {Bytes("II*\0", 4), "a TIFF"},
    {Bytes("MM\0*", 4), "a TIFF"},
    {Bytes("II+\0", 4), "a TIFF"},
    {Bytes("MM\0+", 4), "a TIFF"},
    {"8BPS", "a Photoshop file"},
    {"gimp xcf", "a GIMP file"},
    {"DDS ", "a DDS"},
    {"#?RADIANCE", "a Radiance HDR"},
    {"#?RGBE", "a Radiance HDR"},
    {"\xABKTX", "a KTX"},
    {"qoif", "a QOI"},
    {Bytes("\0\0\0\x0CjP  ", 8), "a JPEG 2000"},
    {"\xFF\x0A", "a JPEG XL"},
    {Bytes("\0\0\0\x0CJXL ", 8), "a JPEG XL"},
    {"%PDF", "a PDF"},
    {"<svg", "an SVG"},
    {"<?xml", "an XML file"},
};

std::string nameOf(Bytes bytes) {
    if (bytes.empty()) return "the file is empty";
    if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP")) return "it is a WebP";
    if (bytes.substr(0, 8).ends_with("ftyp")) return "it is a HEIF, an AVIF or a film";
    for (const Format& format : kFormats)
        if (bytes.starts_with(format.begins)) return std::string("it is ") + format.name;
    return "its first bytes are none of theirs";
}

}  // namespace

bool readPictureHead(Bytes bytes, PictureHead& out, std::string& error) {
    out = {};
    const auto known = std::ranges::find_if(
        kFormats, [&](const Format& format) { return format.read && bytes.starts_with(format.begins); });
    if (known == std::end(kFormats))
        return fail(error, "isn't a picture that can be read: " + nameOf(bytes) + "; PNG, JPEG and OpenEXR are read");
    out.format = known->name;
    if (!known->read(bytes, out, error)) return false;
    if (out.width == 0 || out.height == 0) return fail(error, "is damaged: it has no texels");
    return true;
}

}  // namespace espalier::scene
