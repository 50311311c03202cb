// In: the bytes of a picture's file, as hostile as they come. Out: its texels.
#include "runtime/surface/picture.hpp"

#include <stb_image.h>

#include <cstring>
#include <memory>
#include <new>

namespace espalier {
namespace {

constexpr int kMaxSide = 16384;

// By the library's words, as it was built for programs or for users.
bool wantsMemory(std::string_view reason) {
    return reason == "outofmem" || reason == "Out of memory";
}

}  // namespace

bool isPicture(std::span<const std::byte> bytes) {
    auto beginsWith = [&](std::string_view magic) {
        return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
    };
    return beginsWith("\x89PNG\r\n\x1A\n") || beginsWith("\xFF\xD8\xFF");
}

Result<uint64_t> texelsOf(std::span<const std::byte> bytes, std::string_view file) {
    int width = 0, height = 0, channels = 0;
    if (!isPicture(bytes)) return Failure(file, "neither PNG nor JPEG");
    if (bytes.size() > size_t(INT32_MAX)) return Failure(file, "more than 2 GiB");
    if (!stbi_info_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), int(bytes.size()), &width, &height,
                               &channels))
        return Failure(file, std::string("damaged image: ") + stbi_failure_reason());
    if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
        return Failure(file,
                       std::to_string(width) + "×" + std::to_string(height) + " texels; 1 to 16384 a side are read");
    return uint64_t(width) * uint64_t(height);
}

Result<Picture> decodePicture(std::span<const std::byte> bytes, std::string_view file, uint64_t maxTexels) {
    const Result<uint64_t> count = texelsOf(bytes, file);
    if (!count) return count.failure();
    if (count.value() > maxTexels) return Failure(file, std::to_string(count.value()) + " texels, absurdly many here");
    int width = 0, height = 0, channels = 0;
    std::unique_ptr<stbi_uc, void (*)(void*)> texels(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), int(bytes.size()), &width, &height,
                              &channels, 4),
        stbi_image_free);
    if (!texels && wantsMemory(stbi_failure_reason())) throw std::bad_alloc();
    if (!texels) return Failure(file, std::string("damaged image: ") + stbi_failure_reason());
    Picture out;
    out.width = uint32_t(width);
    out.height = uint32_t(height);
    out.rgba.assign(texels.get(), texels.get() + size_t(width) * size_t(height) * 4);
    return out;
}

}  // namespace espalier
