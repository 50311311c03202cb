// In: the bytes of a picture's file, as hostile as they come. Out: its texels.
#include "runtime/surface/picture.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include "runtime/surface/picture_codecs.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMaxSide = 16384;

bool beginsWith(std::span<const std::byte> bytes, std::string_view magic) {
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

bool isJpeg(std::span<const std::byte> bytes) {
    return beginsWith(bytes, "\xFF\xD8\xFF");
}

uint32_t bigEndian(std::span<const std::byte> bytes, size_t at) {
    uint32_t value = 0;
    for (size_t i = 0; i < 4; ++i) value = value << 8 | uint32_t(bytes[at + i]);
    return value;
}

// By the header, which comes first.
bool measurePng(std::span<const std::byte> bytes, PictureSides& out, std::string& why) {
    constexpr size_t kWidth = 16, kHeight = 20, kEnd = 33;  // of the header, with its checksum
    if (bytes.size() < kEnd) {
        why = "it has no header";
        return false;
    }
    out = {bigEndian(bytes, kWidth), bigEndian(bytes, kHeight)};
    return true;
}

uint64_t texelsOf(PictureSides sides) {
    return uint64_t(sides.width) * sides.height;
}

// A progressive JPEG goes over all texels once a scan. Coded data have no 0xFF 0xDA, which begins one.
uint64_t scansOf(std::span<const std::byte> bytes) {
    if (!isJpeg(bytes)) return 1;
    constexpr std::byte kMark[] = {std::byte(0xFF), std::byte(0xDA)};
    uint64_t scans = 0;
    for (auto at = bytes.begin();
         (at = std::search(at, bytes.end(), std::begin(kMark), std::end(kMark))) != bytes.end(); at += 2)
        ++scans;
    return scans;
}

// Behind the last scan's beginning stands the mark of the end.
bool isCutOff(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const size_t end = text.rfind("\xFF\xD9"), last = text.rfind("\xFF\xDA");
    return isJpeg(bytes) && last != text.npos && (end == text.npos || end < last);
}

// What the first bytes say; nothing is decoded yet.
Result<PictureSides> sidesOf(std::span<const std::byte> bytes, std::string_view file, uint32_t maxSide) {
    constexpr uint64_t kMostWork = uint64_t(1) << 33;  // texels over all scans
    constexpr uint64_t kMostTexels = 8 * 16 * 16;      // that a byte of a JPEG stands for: a bit for the largest block
    if (!isPicture(bytes)) return Failure(file, "neither PNG nor JPEG");
    if (bytes.size() > size_t(INT32_MAX)) return Failure(file, "more than 2 GiB");
    PictureSides sides;
    std::string why;
    if (!(isJpeg(bytes) ? measureJpeg(bytes, sides, why) : measurePng(bytes, sides, why)))
        return Failure(file, "damaged image: " + why);
    const std::string size = std::to_string(sides.width) + "×" + std::to_string(sides.height) + " texels";
    if (sides.width < 1 || sides.height < 1 || sides.width > maxSide || sides.height > maxSide)
        return Failure(file, size + "; 1 to " + std::to_string(maxSide) + " a side are read");
    const uint64_t texels = texelsOf(sides), scans = scansOf(bytes);
    // libjpeg takes missing ones for grey.
    if (isCutOff(bytes)) return Failure(file, "damaged image: it is cut off");
    if (isJpeg(bytes) && bytes.size() < texels / kMostTexels)
        return Failure(file, "damaged image: " + std::to_string(bytes.size()) + " bytes are too few for " + size);
    if (scans > kMostWork / texels)
        return Failure(file, size + " in " + std::to_string(scans) + " scans are too many to be decoded");
    return sides;
}

template <class T>
Result<std::vector<T>> decode(std::span<const std::byte> bytes, std::string_view file) {
    std::vector<T> texels;
    std::string why;
    if (!(isJpeg(bytes) ? decodeJpeg(bytes, texels, why) : decodePng(bytes, texels, why)))
        return Failure(file, "damaged image: " + why);
    return texels;
}

}  // namespace

bool isPicture(std::span<const std::byte> bytes) {
    return beginsWith(bytes, "\x89PNG\r\n\x1A\n") || isJpeg(bytes);
}

Result<uint64_t> texelsOf(std::span<const std::byte> bytes, std::string_view file) {
    const Result<PictureSides> sides = sidesOf(bytes, file, kMaxSide);
    if (!sides) return sides.failure();
    return texelsOf(sides.value());
}

Result<Picture> decodePicture(std::span<const std::byte> bytes, std::string_view file, uint64_t maxTexels) {
    const Result<PictureSides> sides = sidesOf(bytes, file, kMaxSide);
    if (!sides) return sides.failure();
    if (const uint64_t texels = texelsOf(sides.value()); texels > maxTexels)
        return Failure(file, std::to_string(texels) + " texels, absurdly many here");
    Result<std::vector<uint8_t>> texels = decode<uint8_t>(bytes, file);
    if (!texels) return texels.failure();
    Picture out;
    out.width = sides.value().width;
    out.height = sides.value().height;
    out.rgba = std::move(*texels);
    return out;
}

Result<UvPicture> decodeGrey(std::span<const std::byte> bytes, std::string_view file, uint32_t maxSide) {
    const Result<PictureSides> sides = sidesOf(bytes, file, maxSide);
    if (!sides) return sides.failure();
    const Result<std::vector<uint16_t>> texels = decode<uint16_t>(bytes, file);
    if (!texels) return texels.failure();
    UvPicture out{sides.value().width, sides.value().height, {}};
    out.texels.assign(texels.value().begin(), texels.value().end());
    for (float& value : out.texels) value /= 65535.0f;
    return out;
}

}  // namespace espalier
