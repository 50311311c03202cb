#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace espalier::scene {

// What a picture's first bytes say of it. No library has seen them yet, and nothing is allocated for its texels.
struct PictureHead {
    const char* format = "";         // "png", "jpeg" or "openexr", as the picture library calls them
    uint64_t width = 0, height = 0;  // texels, 1 or more
    uint64_t scans = 1;              // a progressive JPEG's: each goes over all texels
    uint64_t leastBytes = 0;         // a shorter file can't hold so many texels
};

// PNG, JPEG and OpenEXR are read, told by their first bytes whatever the file is called. False: `error` says why the
// bytes are none of these, or damaged, without naming the file.
bool readPictureHead(std::string_view bytes, PictureHead& out, std::string& error);

}  // namespace espalier::scene
