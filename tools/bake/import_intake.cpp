// In: paths. Out: bytes, a record of what was read, and a bound on what is made of them.
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "runtime/core/file.hpp"
#include "runtime/core/file_beside.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/surface/picture.hpp"
#include "tools/bake/import.hpp"

namespace espalier::import {
namespace {

constexpr uint64_t kMultiple = 256;  // of a file's bytes: what decoding it may allocate

Result<std::vector<uint8_t>> unpack(std::span<const std::byte> packed, const std::string& path, Intake& intake) {
    z_stream stream{};
    if (packed.size() > UINT32_MAX || inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK)
        return Failure(path, "its gzip data cannot be unpacked");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data()));
    stream.avail_in = uInt(packed.size());
    std::vector<uint8_t> out;
    int state = Z_OK;
    while (state == Z_OK) {
        size_t have = out.size(), piece = std::clamp<size_t>(have, 65536, size_t(1) << 26);
        if (!intake.take(piece)) break;
        out.resize(have + piece);
        stream.next_out = out.data() + have;
        stream.avail_out = uInt(piece);
        state = inflate(&stream, Z_NO_FLUSH);
        out.resize(have + piece - stream.avail_out);
    }
    inflateEnd(&stream);
    if (state == Z_OK) return Failure(path, "its gzip data unpacks to absurdly much");
    if (state != Z_STREAM_END) return Failure(path, "its gzip data is damaged or cut off");
    return out;
}

}  // namespace

bool Intake::take(uint64_t bytes) {
    if (bytes > left()) return false;
    taken_ += bytes;
    return true;
}

Result<std::vector<uint8_t>> Intake::read(const std::string& path, const std::string& blame) {
    std::error_code error;
    auto refuse = [&](const std::string& why) {
        if (inputs_) inputs_->push_back({path, 0});
        return path == blame ? Failure(path, why) : Failure(blame, "cannot read '" + path + "': " + why);
    };
    // A pipe or a device that a model names could keep us for ever.
    auto type = std::filesystem::status(path, error).type();
    using Type = std::filesystem::file_type;
    if (type == Type::character || type == Type::block || type == Type::fifo || type == Type::socket)
        return refuse("is no ordinary file");
    auto bytes = readFile(path);
    if (!bytes) return refuse(bytes.failure().diagnostics.front().message);
    // A file that is named often widens the bound once.
    if (std::find(known_.begin(), known_.end(), path) == known_.end()) {
        known_.push_back(path);
        allowed_ += bytes->size() * kMultiple;
        if (inputs_) inputs_->push_back({path, std::max<uint64_t>(hashBytes(*bytes), 1)});
    }
    if (bytes->size() > 2 && (*bytes)[0] == std::byte(0x1F) && (*bytes)[1] == std::byte(0x8B))
        return unpack(*bytes, blame, *this);
    if (!take(bytes->size())) return Failure(blame, "names '" + path + "' absurdly often");
    std::vector<uint8_t> out(bytes->size());
    if (!out.empty()) std::memcpy(out.data(), bytes->data(), out.size());
    return out;
}

Result<std::vector<uint8_t>> Intake::readBeside(const std::string& document, const std::string& name) {
    auto place = placeBeside(document, name);
    if (!place) return std::move(place.failure());
    return read(place->string(), document);
}

bool Intake::isBeside(const std::string& document, const std::string& name) {
    auto place = placeBeside(document, name);
    std::error_code ignored;
    if (!place || std::filesystem::is_regular_file(*place, ignored)) return bool(place);
    if (inputs_) inputs_->push_back({place->string(), 0});
    return false;
}

void Intake::note(const std::string& path) {
    if (!inputs_) return;
    auto bytes = readFile(path);
    inputs_->push_back({path, bytes ? std::max<uint64_t>(hashBytes(*bytes), 1) : 0});
}

Result<Picture> readPicture(std::vector<uint8_t> bytes, const std::string& file, Intake& intake) {
    // Twice four bytes a texel, while it is decoded.
    const uint64_t most = intake.left() / 8;
    if (isWebp(bytes)) {
        auto decoded = decodeWebp(bytes, file, most);
        if (decoded) intake.take(decoded->rgba.size());
        return decoded;
    }
    auto decoded = decodePicture(std::as_bytes(std::span(bytes)), file, most);
    if (!decoded) return decoded;
    intake.take(decoded->rgba.size());
    decoded->encoded = std::move(bytes);
    return decoded;
}

}  // namespace espalier::import
