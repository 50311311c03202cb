#include "runtime/core/glb.hpp"

#include <cstring>

#include "runtime/core/file.hpp"

namespace espalier {
namespace {

constexpr uint64_t kHeaders = 12 + 8 + 8;

uint64_t padded(uint64_t size) {
    return (size + 3) / 4 * 4;
}

}  // namespace

std::vector<std::byte> glbContainer(std::string json, std::span<const std::byte> binary) {
    json.resize(padded(json.size()), ' ');
    const uint64_t total = kHeaders + json.size() + padded(binary.size());
    std::vector<std::byte> file(total);
    size_t at = 0;
    const auto put = [&](const void* data, size_t size) {
        if (size != 0) std::memcpy(&file[at], data, size);
        at += size;
    };
    const uint32_t head[] = {kGlbMagic, 2, uint32_t(total), uint32_t(json.size()), kGlbJson};
    const uint32_t middle[] = {uint32_t(padded(binary.size())), kGlbBinary};
    put(head, sizeof head);
    put(json.data(), json.size());
    put(middle, sizeof middle);
    put(binary.data(), binary.size());
    return file;
}

Status writeGlb(const std::filesystem::path& path, std::string json, std::span<const std::byte> binary) {
    if (kHeaders + padded(json.size()) + padded(binary.size()) > 0xFFFFFFFFu)
        return Failure(path.string(), "larger than a .glb can be (4 GiB)");
    return writeFile(path, glbContainer(std::move(json), binary));
}

}  // namespace espalier
