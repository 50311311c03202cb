// Pictures as hostile as they come: each is refused with its name and the cause, without much memory, and no library's
// exception ends the program.
#include "tools/scene/picture.hpp"

#include <OpenImageIO/imageio.h>
#include <doctest/doctest.h>
#include <stb_image_write.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <vector>

#include "runtime/surface/picture.hpp"
#include "tests/support/data.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/small_pictures.hpp"
#include "tools/scene/text_file.hpp"

using namespace espalier;
using namespace espalier::scene;
using namespace espalier::test;

namespace {

constexpr size_t kFew = size_t(64) << 20;  // bytes: what refusing a picture may take at most

long peakKiB() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return used.ru_maxrss;
}

struct Reader {
    const char* name;
    std::function<bool(const std::string&, std::string&)> read;
};
const Reader kReaders[] = {
    {"grey",
     [](const std::string& path, std::string& error) {
         GreyPicture out;
         return readGrey(path, out, error);
     }},
    {"colours",
     [](const std::string& path, std::string& error) {
         std::vector<GreyPicture> out;
         return readColours(path, out, error);
     }},
    {"colour",
     [](const std::string& path, std::string& error) {
         ColourPicture out;
         return readColour(path, out, error);
     }},
    {"floats",
     [](const std::string& path, std::string& error) {
         FloatPicture out;
         return readFloats(path, out, error);
     }},
    {"shape",
     [](const std::string& path, std::string& error) {
         PictureShape out;
         return readShape(path, out, error);
     }},
};

// By every reader, and by that of surfaces and the baker, which reads no EXR.
void refused(const std::string& path, const std::string& cause) {
    [[maybe_unused]] const long before = peakKiB();
    CAPTURE(path);
    for (const Reader& reader : kReaders) {
        CAPTURE(reader.name);
        std::string error;
        const bool read = reader.read(path, error);
        const bool headAlone = read && std::string(reader.name) == "shape";  // what is damaged comes later
        CHECK((!read || headAlone));
        if (!read) CHECK_MESSAGE(error.find(path) == 0, error);
        if (!read) CHECK_MESSAGE(error.find(cause) != std::string::npos, error);
        CHECK(error.find('\n') == std::string::npos);
    }
    std::string bytes, error;
    REQUIRE(readText(path, bytes, error));
    const auto all = std::as_bytes(std::span(bytes));
    CHECK_FALSE(decodePicture(all, path));
    CHECK_FALSE(decodeGrey(all, path, 8192));
#ifndef __SANITIZE_ADDRESS__  // which keeps what was freed
    CHECK((peakKiB() - before) * 1024 < long(kFew));
#endif
}

void refusedBytes(const ScratchFolder& folder, const std::string& name, const std::string& bytes,
                  const std::string& cause) {
    const std::string path = folder.file(name);
    std::ofstream(path, std::ios::binary) << bytes;
    refused(path, cause);
}

}  // namespace

TEST_CASE("a picture is told by its first bytes, and only PNG, JPEG and OpenEXR are read") {
    const ScratchFolder folder;
    const auto other = [&](const std::string& bytes, const char* kind) {
        for (const char* name : {"a.png", "a.jpg", "a.exr", "a"})
            refusedBytes(folder, name, bytes + std::string(64, '\x18'),
                         std::string(kind) + "; PNG, JPEG and OpenEXR are read");
    };
    other(std::string("GIF\xFF"
                      "9a\x18\xFF\xFF\xFF\x7F",
                      11),
          "it is a GIF");
    other("BM\x0C\x05", "it is a BMP");
    other(std::string("II*\0\x08", 5), "it is a TIFF");
    other(std::string("MM\0*", 4), "it is a TIFF");
    other("8BPS", "it is a Photoshop file");
    other("DDS ", "it is a DDS");
    other("#?RADIANCE\n", "it is a Radiance HDR");
    other("RIFF\x24\x01\x01\x01WEBPVP8 ", "it is a WebP");
    other(std::string("\0\0\0\x1C"
                      "ftypheic",
                      12),
          "it is a HEIF, an AVIF or a film");
    other("no picture", "its first bytes are none of theirs");
    refusedBytes(folder, "empty.png", "", "the file is empty");
    refusedBytes(folder, "short.png", "\x89PNG\r\n\x1A\n", "is damaged: it has no header");
    refusedBytes(folder, "short.jpg", "\xFF\xD8\xFF\xE0", "is damaged: it has no header");
    refusedBytes(folder, "short.exr", "\x76\x2F\x31\x01\x02", "is damaged: it has no header");

    // Under a false name it is read all the same.
    GreyPicture written{2, 1, {0, 1}}, read;
    std::string error;
    REQUIRE_MESSAGE(writeGrey(folder.file("right.exr"), written, error), error);
    std::filesystem::rename(folder.path / "right.exr", folder.path / "false.png");
    CHECK_MESSAGE(readGrey(folder.file("false.png"), read, error), error);
    CHECK(read.texels == written.texels);
}

TEST_CASE("a size is judged from the header, before anything is decoded or allocated") {
    const ScratchFolder folder;
    const char* many = "a side are allowed";
    for (const uint64_t side : {16385ull, 60000ull, 65535ull}) {
        refusedBytes(folder, "bomb.png", pngOf(side, side), many);
        refusedBytes(folder, "bomb.jpg", jpegOf(side, side), many);
        refusedBytes(folder, "bomb.exr", exrOf(-5, int64_t(side) - 6), many);
    }
    refusedBytes(folder, "wide.png", pngOf(0x7FFFFFFF, 1), many);
    refusedBytes(folder, "wide.png", pngOf(0xFFFFFFFF, 0xFFFFFFFF), many);
    refusedBytes(folder, "whole.exr", exrOf(INT32_MIN, INT32_MAX), many);
    refusedBytes(folder, "none.png", pngOf(0, 5), "is damaged: it has no texels");
    refusedBytes(folder, "none.jpg", jpegOf(5, 0), "is damaged: it has no texels");
    refusedBytes(folder, "none.exr", exrOf(4, 3), "is damaged: it has no texels");
    // So many texels don't fit into so few bytes.
    refusedBytes(folder, "thin.png", pngOf(8000, 8000), "bytes are too few for 8000 x 8000 texels");
    refusedBytes(folder, "thin.jpg", jpegOf(8000, 8000), "bytes are too few for 8000 x 8000 texels");
    // All rows are stated, and none of them is there.
    refusedBytes(folder, "thin.exr", exrOf(0, 8191) + std::string(8192 * 8, '\0'), "is damaged");
    // Each scan goes over all texels, though it takes ten bytes.
    refusedBytes(folder, "scans.jpg", jpegOf(8000, 8000, 5000), "in 5000 scans are too many to be decoded");
}

TEST_CASE("an OpenEXR's header is judged in all its parts") {
    const ScratchFolder folder;
    refusedBytes(folder, "deep.exr", exrOf(0, 7, 0x800), "deep data");
    refusedBytes(folder, "deep.exr", exrOf(0, 7, 0, exrAttribute("type", "string", "deepscanline")), "deep data");
    const std::string tiles = littleEndian(1 << 30, 4) + littleEndian(1 << 30, 4) + '\0';
    refusedBytes(folder, "tiles.exr", exrOf(0, 7, 0x200, exrAttribute("tiles", "tiledesc", tiles)),
                 "has tiles of more");
    refusedBytes(folder, "cut.exr", exrOf(0, 7).substr(0, 100), "its header is cut off");
    std::string channels;
    for (int i = 0; i < 300000; ++i) channels += std::string("Y\0", 2) + std::string(16, '\1');
    refusedBytes(folder, "channels.exr", exrOf(0, 7, 0, exrAttribute("channels", "chlist", channels + '\0')),
                 "channels, too many");
    // The second of two parts.
    const std::string first = exrOf(0, 7, 0x1000), second = exrOf(0, 99999);
    const size_t end = first.size() - 64;
    refusedBytes(folder, "parts.exr", first.substr(0, end) + second.substr(8), "a side are allowed");
    refusedBytes(folder, "size.exr", exrOf(0, 7, 0, exrAttribute("a", "b", "").substr(0, 4) + "\xFF\xFF\xFF\xFF"),
                 "its header is cut off");
}

TEST_CASE("the pictures that were reported are refused by every reader") {
    for (const auto& [name, cause] : {std::pair("gif_32_bytes.gif", "it is a GIF"),
                                      {"bomb_60000.bmp", "it is a BMP"},
                                      {"bomb_2GB.bmp", "it is a BMP"}})
        if (const auto file = dataFile(std::string("reports/") + name)) refused(*file, cause);
}

TEST_CASE("a picture that is cut off or changed anywhere is read or refused, and nothing else happens") {
    const ScratchFolder folder;
    GreyPicture noise{64, 32, std::vector<float>(64 * 32)};
    uint32_t state = 1;
    for (float& texel : noise.texels) texel = float((state = state * 1664525 + 1013904223) >> 8) / float(1 << 24);
    for (const char* name : {"a.png", "a.exr"}) {
        std::string whole, error;
        REQUIRE_MESSAGE(writeGrey(folder.file(name), noise, error), error);
        REQUIRE(readText(folder.file(name), whole, error));
        const auto tried = [&](const std::string& bytes) {
            std::ofstream(folder.file(name), std::ios::binary) << bytes;
            for (const Reader& reader : kReaders) {
                error.clear();
                if (!reader.read(folder.file(name), error)) CHECK(error.find(folder.file(name)) == 0);
            }
            const auto all = std::as_bytes(std::span(bytes));
            (void)decodePicture(all, name);
            (void)decodeGrey(all, name, 8192);
        };
        for (size_t i = 0; i < 64; ++i) tried(whole.substr(0, whole.size() * i / 64));
        for (size_t i = 0; i < 256; ++i) {
            std::string changed = whole;
            state = state * 1664525 + 1013904223;
            changed[(state >> 4) % std::min<size_t>(whole.size(), i < 128 ? 400 : whole.size())] ^=
                char(1 << (state & 7));
            tried(changed);
        }
    }
}

TEST_CASE("a JPEG is read by every reader, and one that is cut off by none") {
    const ScratchFolder folder;
    const std::string path = folder.file("a.jpg");
    constexpr uint32_t kWidth = 64, kHeight = 32;
    std::vector<uint8_t> texels(kWidth * kHeight * 3);
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = i % 3 == 0 ? 200 : i % 3 == 1 ? 100 : 50;
    REQUIRE(stbi_write_jpg(path.c_str(), kWidth, kHeight, 3, texels.data(), 95));
    std::string error, whole;
    REQUIRE(readText(path, whole, error));
    ColourPicture colour;
    REQUIRE_MESSAGE(readColour(path, colour, error), error);
    CHECK((colour.width == kWidth && colour.height == kHeight));
    for (size_t i = 0; i < colour.rgba.size(); ++i)
        REQUIRE(std::abs(colour.rgba[i] - (i % 4 == 3 ? 255 : texels[i % 4])) <= 2);
    GreyPicture grey;
    REQUIRE_MESSAGE(readGrey(path, grey, error), error);
    CHECK(grey.texels.back() == doctest::Approx(200 / 255.f).epsilon(.02));
    std::vector<GreyPicture> colours;
    REQUIRE_MESSAGE(readColours(path, colours, error), error);
    CHECK(colours[2].texels.back() == doctest::Approx(linearOf(50 / 255.f)).epsilon(.1));
    FloatPicture floats;
    REQUIRE_MESSAGE(readFloats(path, floats, error), error);
    CHECK(floats.rgba[1] == doctest::Approx(100 / 255.f).epsilon(.02));
    PictureShape shape;
    REQUIRE_MESSAGE(readShape(path, shape, error), error);
    CHECK(shape.channels == 3);
    const auto all = std::as_bytes(std::span(whole));
    CHECK(decodePicture(all, path));
    for (const size_t left : {whole.size() - 20, whole.size() - 60})
        refusedBytes(folder, "cut.jpg", whole.substr(0, left), "is damaged: it is cut off");
}

TEST_CASE("an OpenEXR of tiles, wherever its window lies, is read as one of rows") {
    const ScratchFolder folder;
    constexpr int kWidth = 40, kHeight = 600;  // rows are read in several steps
    std::vector<float> texels(size_t(kWidth) * kHeight * 3);
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = float(i) / float(texels.size());
    for (const int tile : {0, 16, 64}) {
        CAPTURE(tile);
        const std::string path = folder.file("a.exr");
        OIIO::ImageSpec spec(kWidth, kHeight, 3, OIIO::TypeDesc::FLOAT);
        spec.x = -5, spec.y = 7;
        spec.tile_width = spec.tile_height = tile;
        spec.tile_depth = 1;
        const auto output = OIIO::ImageOutput::create("openexr");
        REQUIRE(output->open(path, spec));
        REQUIRE(output->write_image(OIIO::TypeDesc::FLOAT, texels.data()));
        REQUIRE(output->close());
        std::string error;
        FloatPicture floats;
        REQUIRE_MESSAGE(readFloats(path, floats, error), error);
        REQUIRE(floats.rgba.size() == size_t(kWidth) * kHeight * 4);
        size_t unlike = 0;
        for (size_t i = 0; i < floats.rgba.size(); ++i)
            unlike += floats.rgba[i] != (i % 4 == 3 ? 1 : texels[i / 4 * 3 + i % 4]);
        CHECK(unlike == 0);
        GreyPicture grey;
        REQUIRE_MESSAGE(readGrey(path, grey, error), error);
        CHECK(grey.texels.back() == texels[texels.size() - 3]);
    }
}

TEST_CASE("grey of 8 and 16 bits is read as 0 to 1 by both readers") {
    const ScratchFolder folder;
    const GreyPicture written{3, 1, {0, .25f, 1}};
    GreyPicture read;
    std::string bytes, error;
    REQUIRE(writeGrey(folder.file("a.png"), written, error));
    REQUIRE_MESSAGE(readGrey(folder.file("a.png"), read, error), error);
    REQUIRE(readText(folder.file("a.png"), bytes, error));
    const auto grey = decodeGrey(std::as_bytes(std::span(bytes)), "a.png", 8192);
    REQUIRE(grey);
    REQUIRE(grey.value().texels.size() == 3);
    for (size_t i = 0; i < 3; ++i) {
        CHECK(std::abs(read.texels[i] - written.texels[i]) < 1e-5f);
        CHECK(std::abs(grey.value().texels[i] - written.texels[i]) < 1e-5f);
    }
}
