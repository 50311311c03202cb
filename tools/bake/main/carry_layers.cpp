// In: PNG files painted over an earlier surface, and the new one. Out: PNG files for the new one.
#include "tools/bake/main/carry_layers.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "runtime/core/file.hpp"
#include "runtime/surface/carry.hpp"
#include "runtime/surface/picture.hpp"
#include "tools/bake/main/carry_seeds.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMostSide = 8192;

void append32(std::vector<std::byte>& out, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(std::byte(value >> shift & 255u));
}

void appendChunk(std::vector<std::byte>& out, const char (&name)[5], const std::vector<std::byte>& data) {
    append32(out, uint32_t(data.size()));
    const size_t first = out.size();
    for (int i = 0; i < 4; ++i) out.push_back(std::byte(name[i]));
    out.insert(out.end(), data.begin(), data.end());
    append32(out, uint32_t(crc32(0, reinterpret_cast<const Bytef*>(out.data() + first), uInt(out.size() - first))));
}

// 16-bit grey, unfiltered.
std::vector<std::byte> encodePng(const UvPicture& layer) {
    std::vector<std::byte> rows;
    rows.reserve(size_t(layer.height) * (2 * layer.width + 1));
    for (uint32_t y = 0; y < layer.height; ++y) {
        rows.push_back(std::byte(0));
        for (uint32_t x = 0; x < layer.width; ++x) {
            const float value = std::clamp(layer.texels[size_t(y) * layer.width + x], 0.0f, 1.0f);
            const auto bits = uint32_t(std::lround(value * 65535.0f));
            rows.push_back(std::byte(bits >> 8));
            rows.push_back(std::byte(bits & 255u));
        }
    }
    uLongf size = compressBound(uLong(rows.size()));
    std::vector<std::byte> packed(size);
    compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
              uLong(rows.size()), 6);
    packed.resize(size);
    std::vector<std::byte> out, header;
    for (int c : std::array<int, 8>{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'}) out.push_back(std::byte(c));
    append32(header, layer.width);
    append32(header, layer.height);
    for (int c : {16, 0, 0, 0, 0}) header.push_back(std::byte(c));  // bits, grey, and no choice in the rest
    appendChunk(out, "IHDR", header);
    appendChunk(out, "IDAT", packed);
    appendChunk(out, "IEND", {});
    return out;
}

}  // namespace

Result<UvPicture> readLayer(const std::string& path) {
    auto bytes = readFile(path);
    if (!bytes) return std::move(bytes.failure());
    return decodeGrey(*bytes, path, kMostSide);
}

Result<std::vector<CarriedFile>> carryLayers(const CarryArguments& arguments, const SurfaceData& to,
                                             const std::string& output, std::vector<Diagnostic>& notes) {
    std::vector<CarriedFile> files;
    if (arguments.from.empty()) return files;
    auto from = readSurface(arguments.from);
    if (!from) return std::move(from.failure());
    if (from->origin != to.origin) {
        char text[200];
        std::snprintf(text, sizeof text,
                      "it had another origin: to leave it where scenes have it, bake with --origin %.15g %.15g %.15g",
                      from->origin.x, from->origin.y, from->origin.z);
        notes.push_back({arguments.from, 0, 0, {}, text, true});
    }
    if (!arguments.seeds.empty())
        if (Status told = findLostSeeds({arguments.seeds, arguments.from, output}, *from, to, notes); !told)
            return std::move(told.failure());
    if (arguments.layers.empty()) return files;
    const SurfaceMatch match(*from, to);
    for (const std::string& path : arguments.layers) {
        const std::filesystem::path target =
            std::filesystem::path(output).parent_path() / std::filesystem::path(path).filename();
        std::error_code ignored;
        if (std::filesystem::equivalent(path, target, ignored))
            return Failure(target.string(),
                           "the carried layer would overwrite the one that it comes from: bake into "
                           "another folder");
        if (std::ranges::find(files, target.string(), &CarriedFile::path) != files.end())
            return Failure(target.string(), "two carried layers have this name: one would overwrite the other");
        auto layer = readLayer(path);
        if (!layer) return std::move(layer.failure());
        const CarriedLayer carried = match.carry(*layer);
        char text[160];
        std::snprintf(text, sizeof text,
                      "carried: %.3g m² of new ground have no value yet, %.3g m² of what was "
                      "painted are gone",
                      carried.fresh, carried.lost);
        notes.push_back({path, 0, 0, {}, text, carried.fresh > 0 || carried.lost > 0});
        files.push_back({target.string(), encodePng(carried.layer)});
    }
    return files;
}

}  // namespace espalier
