// In: the bytes of a WebP picture. Out: its texels. OpenImageIO, which the tools need anyway, brings libwebp along but
// not its headers, and takes 0.4 s to load itself: so libwebp is asked for by name when a picture needs it, by the
// three functions that every version of its interface 7 has.
#include <dlfcn.h>

#include <cstring>
#include <memory>

#include "tools/bake/import.hpp"

namespace espalier::import {
namespace {

constexpr int kMaxSide = 16383;  // of the format

struct Library {
    int (*getInfo)(const uint8_t*, size_t, int* width, int* height) = nullptr;
    uint8_t* (*decode)(const uint8_t*, size_t, int* width, int* height) = nullptr;
    void (*free)(void*) = nullptr;

    Library() {
        void* library = ::dlopen("libwebp.so.7", RTLD_NOW | RTLD_LOCAL);  // stays for the program's life
        if (!library) return;
        find(library, "WebPGetInfo", getInfo);
        find(library, "WebPDecodeRGBA", decode);
        find(library, "WebPFree", free);
    }
    bool complete() const { return getInfo && decode && free; }

  private:
    template <class Function>
    static void find(void* library, const char* name, Function& function) {
        function = reinterpret_cast<Function>(::dlsym(library, name));
    }
};

}  // namespace

bool isWebp(Bytes bytes) {
    return bytes.size() >= 12 && std::memcmp(bytes.data(), "RIFF", 4) == 0 &&
           std::memcmp(bytes.data() + 8, "WEBP", 4) == 0;
}

Result<Picture> decodeWebp(Bytes bytes, const std::string& file, uint64_t maxTexels) {
    static const Library library;
    if (!library.complete()) return Failure(file, "is WebP, and this machine has no libwebp to read it");
    int width = 0, height = 0;
    if (!library.getInfo(bytes.data(), bytes.size(), &width, &height)) return Failure(file, "damaged WebP picture");
    if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
        return Failure(file, std::to_string(width) + "×" + std::to_string(height) + " texels; 1 to " +
                                 std::to_string(kMaxSide) + " a side are read");
    const uint64_t count = uint64_t(width) * uint64_t(height);
    if (count > maxTexels) return Failure(file, std::to_string(count) + " texels, absurdly many here");
    const std::unique_ptr<uint8_t, void (*)(void*)> texels(library.decode(bytes.data(), bytes.size(), &width, &height),
                                                           library.free);
    if (!texels || uint64_t(width) * uint64_t(height) != count) return Failure(file, "damaged WebP picture");
    Picture out;
    out.width = uint32_t(width);
    out.height = uint32_t(height);
    out.rgba.assign(texels.get(), texels.get() + count * 4);
    return out;
}

}  // namespace espalier::import
