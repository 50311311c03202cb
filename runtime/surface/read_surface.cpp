// In: a .glb that the baker wrote, or something that claims to be one. Out: the surface. Sizes, indices and hashes
// are compared before anything is used: kernels follow these records without asking.
#include <algorithm>
#include <cstring>
#include <fstream>

#include "runtime/core/file.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/surface/surface.hpp"
#include "runtime/surface/surface_file.hpp"
#include "runtime/surface/surface_reader.hpp"

namespace espalier {
namespace {

using namespace surface_file;

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
constexpr bool kComparesHashes = false;  // a fuzzer would never get past them
#else
constexpr bool kComparesHashes = true;
#endif

std::vector<std::byte> firstBytes(const std::string& path, uint64_t count) {
    std::ifstream file(path, std::ios::binary);
    file.seekg(0, std::ios::end);
    const auto there = file.tellg();
    if (!file || there < 0) fail("file", "can't be read");
    std::vector<std::byte> bytes(size_t(std::min<uint64_t>(count, uint64_t(there))));
    file.seekg(0);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()))) fail("file", "can't be read");
    return bytes;
}

// As much of a file as a level needs: its end lies behind all that comes before it.
std::vector<std::byte> readUpTo(const std::string& path, uint32_t finest) {
    uint64_t head = 28;
    std::vector<std::byte> bytes = firstBytes(path, head);
    if (bytes.size() < head) fail("header", "not a .glb");
    uint32_t text;
    std::memcpy(&text, bytes.data() + 12, 4);
    head += text;
    const Container document(firstBytes(path, head), true);
    const json& levels = array(document.walk(), "levels", kExtension, kMaxLevels);
    if (levels.empty()) fail(kExtension, "no levels");
    const size_t last = std::min<size_t>(finest, levels.size() - 1);
    const json& views = array(document.root(), "bufferViews", "glTF", kMaxViews);
    const uint64_t view = whole(levels[last], "bufferView", kExtension, 1 << 20);
    if (view >= views.size()) fail(kExtension, indexed("bufferViews", view) + " does not exist");
    head += whole(views[view], "byteOffset", "bufferViews", 0xFFFFFFFFu) +
            whole(views[view], "byteLength", "bufferViews", 0xFFFFFFFFu);
    return firstBytes(path, head);
}

SurfaceData read(Container file, uint32_t finest) {
    const json& walk = file.walk();
    uint64_t version = whole(walk, "version", kExtension, 0xFFFFFFFFu);
    if (version != kVersion)
        fail(kExtension, "version " + std::to_string(version) + " is not the supported " + std::to_string(kVersion) +
                             ": bake again");
    if (kComparesHashes && !file.partial() && hexadecimal(walk, "binary_hash", kExtension) != hashBytes(file.binary()))
        fail(kExtension, "damaged: the binary chunk doesn't match its hash");
    SurfaceData data;
    readWalk(file, finest, kComparesHashes, data);
    readDrawing(file, data);
    return data;
}

// What `take` returns, or why there is nothing.
template <class Take>
Result<SurfaceData> soundOr(const std::string& path, Take&& take) {
    try {
        return take();
    } catch (const Damage& damage) {
        return Failure(Diagnostic{path, 0, 0, damage.place, damage.message});
    } catch (const std::bad_alloc&) {
        return Failure(path, "states sizes that do not fit into memory");
    } catch (const std::exception& e) {  // from the JSON library
        return Failure(path, std::string("not a baked surface: ") + e.what());
    }
}

}  // namespace

Result<SurfaceData> parseSurface(std::vector<std::byte> file, const std::string& name) {
    return soundOr(name, [&] { return read(Container(std::move(file), false), 0); });
}

Result<SurfaceData> readSurface(const std::string& path, const ReadOptions& options) {
    if (const uint32_t finest = options.finestLevel; finest > 0)
        return soundOr(path, [&] { return read(Container(readUpTo(path, finest), true), finest); });
    auto file = readFile(path);
    if (!file) return std::move(file.failure());
    return parseSurface(std::move(*file), path);
}

}  // namespace espalier
