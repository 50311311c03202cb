// What pictures may take: no more than a file of its size lets them, and what there is.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <cstring>
#include <fstream>
#include <new>
#include <span>

#include "runtime/core/file.hpp"
#include "runtime/core/glb.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/bake/bake.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

std::string bigEndian(uint32_t value) {
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

// A square PNG of that many grey texels a side, all black; the checksums are nobody's.
std::string png(uint32_t side) {
    const std::string rows(size_t(side + 1) * side, '\0');
    std::string packed(compressBound(uLong(rows.size())), '\0');
    uLongf size = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()), rows.size());
    packed.resize(size);
    const auto chunk = [](const std::string& name, const std::string& data) {
        return bigEndian(uint32_t(data.size())) + name + data + std::string(4, '\0');
    };
    return "\x89PNG\r\n\x1A\n" + chunk("IHDR", bigEndian(side) + bigEndian(side) + std::string("\x08\0\0\0\0", 5)) +
           chunk("IDAT", packed) + chunk("IEND", "");
}

// What `call` returns in a process that may take `room` bytes more than this one has; -1: it crashed.
template <class Call>
int withRoom(size_t room, const Call& call) {
    const pid_t child = ::fork();
    if (child == 0) {
        size_t pages = 0;
        std::ifstream("/proc/self/statm") >> pages;
        const rlim_t most = pages * size_t(::sysconf(_SC_PAGESIZE)) + room;
        const rlimit limit{most, most};
        ::setrlimit(RLIMIT_AS, &limit);
        ::_exit(call());
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("a picture that there is no memory for is no damaged one, but want of memory") {
    ScratchFolder folder;
    REQUIRE(writeFile(folder.file("a.obj"), std::string_view("mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                                             "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")));
    REQUIRE(writeFile(folder.file("a.mtl"), std::string_view("newmtl a\nmap_Kd a.png\n")));
    REQUIRE(writeFile(folder.file("a.png"), std::string_view(png(4096))));
    enum { kRead, kLeftOut, kRefused, kNoMemory };
    const auto outcome = [&]() -> int {
        try {
            auto model = importModel(folder.file("a.obj"));
            return !model ? kRefused : model->images.empty() ? kLeftOut : kRead;
        } catch (const std::bad_alloc&) {
            return kNoMemory;
        }
    };
    CHECK(outcome() == kRead);
#ifndef __SANITIZE_ADDRESS__  // it ends the program
    CHECK(withRoom(size_t(32) << 20, outcome) == kNoMemory);
#endif
}

TEST_CASE("pictures that share a part of the file count each, and those beyond its bound are left out") {
    constexpr size_t kImages = 2048, kView = size_t(256) << 10;
    std::string binary = png(1);
    binary.resize(kView + 36);
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::memcpy(binary.data() + kView, corners, sizeof corners);
    std::string images, textures, materials;
    for (size_t i = 0; i < kImages; ++i) {
        const std::string comma = i > 0 ? "," : "", index = std::to_string(i);
        images += comma + R"({"bufferView":0,"mimeType":"image/png"})";
        textures += comma + R"({"source":)" + index + "}";
        materials += comma + R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":)" + index + "}}}";
    }
    const std::string view = std::to_string(kView);
    const std::string text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
                             R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
                             R"("accessors":[{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3"}],)"
                             R"("buffers":[{"byteLength":)" +
                             std::to_string(binary.size()) + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + view +
                             R"(},{"buffer":0,"byteOffset":)" + view + R"(,"byteLength":36}],"images":[)" + images +
                             R"(],"textures":[)" + textures + R"(],"materials":[)" + materials + "]}";
    ScratchFolder folder;
    REQUIRE(writeGlb(folder.file("many.glb"), text, std::as_bytes(std::span(binary))));
    auto model = importModel(folder.file("many.glb"));
    if (!model) FAIL(model.failure().text());
    CHECK(model->images.size() > 512);
    CHECK(model->images.size() * kView < (size_t(256) << 20) + 256 * (text.size() + binary.size() + 64));
    REQUIRE(!model->warnings.empty());
    CHECK(toString(model->warnings.back()).find("absurdly much for a file of its size") != std::string::npos);
}
