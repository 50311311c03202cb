// In: an opened surface. Out: what a walk reads. Kernels follow these records without asking, so each index is compared
// with what it counts into.
#include <bit>
#include <cmath>

#include "runtime/core/hash.hpp"
#include "runtime/surface/codec.hpp"
#include "runtime/surface/surface_file.hpp"
#include "runtime/surface/surface_reader.hpp"

namespace espalier::surface_file {
namespace {

constexpr uint32_t kPlacedBits = 0xFFF0;  // of Crossing::flags: set where surfaces are placed, never in files
constexpr uint32_t kMaxSize = 8192;

template <class T>
void readArray(Container& file, const json& object, const char* key, const std::string& place, std::vector<T>& out) {
    std::string here = place + "." + key;
    const json& field = at(object, key, place);
    uint64_t count = whole(field, "count", here, kMaxRecords);
    if (whole(field, "stride", here, 256) != sizeof(T)) fail(here, "records of another size: bake again");
    if (count == 0) return;
    auto bytes = file.view(whole(field, "bufferView", here, 1 << 20), here);
    file.take(count * sizeof(T), here);
    out.resize(count);
    if (!decodeRecords(bytes, out.data(), count, sizeof(T))) fail(here, "damaged compressed data");
}

// Surfaces near their models' origin have none.
void readOrigin(const json& walk, const std::string& place, glm::dvec3& out) {
    if (!walk.contains("origin")) return;
    const json& origin = array(walk, "origin", place.c_str(), 3);
    for (size_t k = 0; k < 3; ++k) {
        if (k >= origin.size() || !origin[k].is_number()) fail(place, "origin is not three numbers");
        out[int(k)] = origin[k].get<double>();
        if (!(std::abs(out[int(k)]) < 1e18)) fail(place, "origin is not three numbers of sane size");
    }
}

void readShared(Container& file, const json& walk, SurfaceData& data) {
    std::string place = kExtension;
    data.hash = hexadecimal(walk, "hash", place);
    const json& source = at(walk, "source", place);
    if (source.is_string()) data.source = source.get<std::string>();
    for (int side = 0; side < 2; ++side) {
        const char* key = side == 0 ? "bounds_min" : "bounds_max";
        const json& bounds = array(walk, key, kExtension, 3);
        for (size_t k = 0; k < 3; ++k) {
            if (k >= bounds.size() || !bounds[k].is_number()) fail(place, std::string(key) + " is not three numbers");
            (side == 0 ? data.boundsMin : data.boundsMax)[int(k)] = bounds[k].get<float>();
        }
    }
    readOrigin(walk, place, data.origin);
    readArray(file, walk, "crossings", place, data.crossings);
    readArray(file, walk, "charts", place, data.charts);
    readArray(file, walk, "triangles", place, data.triangles);
}

// The finest and all after it; hashes: of each level, as the file states them.
void readLevels(Container& file, const json& walk, uint32_t finest, SurfaceData& data, std::vector<uint64_t>& hashes) {
    const std::string place = kExtension;
    const json& levels = array(walk, "levels", kExtension, kMaxLevels);
    if (levels.empty()) fail(place, "no levels");
    finest = std::min(finest, uint32_t(levels.size() - 1));
    uint32_t before = 0;
    for (size_t i = 0; i < levels.size(); ++i) {
        std::string here = place + "." + indexed("levels", i);
        SurfaceLevelData level;
        level.size = uint32_t(whole(levels[i], "size", here, kMaxSize));
        if (level.size < 8 || !std::has_single_bit(level.size)) fail(here, "size " + std::to_string(level.size));
        if (i > 0 && level.size * 2 != before) fail(here, "is not half as large as the one before");
        before = level.size;
        level.error = number(levels[i], "error", 0);
        hashes.push_back(hexadecimal(levels[i], "hash", here));
        if (i < finest) continue;
        const uint64_t refs = whole(levels[i], "refs", here, kMaxRecords);
        file.take(refs * 4, here);  // texels, which may pack to next to nothing, are bounded by the sizes
        auto bytes = file.view(whole(levels[i], "bufferView", here, 1 << 20), here);
        const std::string wrong = decodeLevel(bytes, data.triangles, refs, level);
        if (!wrong.empty()) fail(here, wrong);
        data.levels.push_back(std::move(level));
    }
    for (Chart& chart : data.charts) {
        if (chart.coarsestLevel >= levels.size()) fail(place, "a chart ends at a level that doesn't exist");
        chart.coarsestLevel -= std::min(chart.coarsestLevel, finest);
    }
}

bool inSquare(glm::vec2 uv) {
    return uv.x >= 0 && uv.y >= 0 && uv.x <= 1 && uv.y <= 1;
}

void validateLevel(const SurfaceData& data, const SurfaceLevelData& level, const std::string& place) {
    for (uint32_t ref : level.crossingRefs)
        if (ref >= data.crossings.size()) fail(place, "a texel lists a crossing that doesn't exist");
    for (size_t i = 0; i < level.texels.size(); ++i) {
        const Texel& t = level.texels[i];
        uint32_t head = level.crossingHead[i];
        if (uint64_t(head >> 8) + (head & 255u) > level.crossingRefs.size())
            fail(place, indexed("crossing_head", i) + " is out of range");
        const uint32_t triangle = level.aux[i].triangle;
        const bool empty = texelClass(t.bits) == kTexelEmpty;
        if (triangle >= data.triangles.size() && !(empty && triangle == kNoIndex))
            fail(place, indexed("aux", i) + " is out of range");
        if (empty) continue;
        if (texelChart(t.bits) >= data.charts.size() || !sane(t.position))
            fail(place, indexed("texels", i) + " is out of range");
    }
}

// Every index that a kernel would follow.
void validate(const SurfaceData& data) {
    std::string place = kExtension;
    size_t charts = data.charts.size();
    if (charts == 0 || charts > 65535) fail(place, std::to_string(charts) + " charts");
    if (!sane(data.boundsMin) || !sane(data.boundsMax)) fail(place, "bounds are not numbers");
    for (size_t i = 0; i < charts; ++i) {
        const Chart& c = data.charts[i];
        if (!inSquare(c.uvMin) || !inSquare(c.uvMax) || (c.orientation != 1 && c.orientation != -1) ||
            c.coarsestLevel >= data.levels.size() || !(c.area > 0) || !(c.metresPerUv > 0) ||
            !std::isfinite(c.metresPerUv) || c.firstTriangle > data.triangles.size() ||
            c.triangleCount > data.triangles.size() - c.firstTriangle)
            fail(place, indexed("charts", i) + " is out of range");
    }
    for (size_t i = 0; i < data.triangles.size(); ++i) {
        const TrianglePlane& t = data.triangles[i];
        if (t.chart >= charts || !sane(t.position) || !sane(t.du) || !sane(t.dv) || !inSquare(t.uv0) ||
            !inSquare(t.uv1) || !inSquare(t.uv2))
            fail(place, indexed("triangles", i) + " is out of range");
    }
    for (size_t i = 0; i < data.crossings.size(); ++i) {
        const Crossing& c = data.crossings[i];
        if (!inSquare(c.a) || !inSquare(c.b) || !inSquare(c.ta) || !inSquare(c.tb) || (c.target & 0xFFFFu) >= charts ||
            (c.flags >> 16) >= charts || (c.flags & kPlacedBits) != 0)
            fail(place, indexed("crossings", i) + " is out of range");
        // What a file says of other instances would be followed into a table that it can't know.
        if ((c.target >> 16) != 0xFFFFu) fail(place, indexed("crossings", i) + " leads to another instance");
    }
    for (size_t l = 0; l < data.levels.size(); ++l)
        validateLevel(data, data.levels[l], place + "." + indexed("levels", l));
}

}  // namespace

void readWalk(Container& file, uint32_t finest, bool comparesHashes, SurfaceData& data) {
    readShared(file, file.walk(), data);
    const uint64_t shared = sharedHash(data);  // before charts are told of missing levels
    std::vector<uint64_t> hashes;
    readLevels(file, file.walk(), finest, data, hashes);
    validate(data);
    if (!comparesHashes) return;
    const size_t skipped = hashes.size() - data.levels.size();
    for (size_t l = 0; l < data.levels.size(); ++l)
        if (levelHash(data.levels[l]) != hashes[l + skipped])
            fail(kExtension, indexed("levels", l + skipped) + " doesn't match its hash: damaged");
    hashes.insert(hashes.begin(), shared);
    if (hashValues(std::span<const uint64_t>(hashes)) != data.hash)
        fail(kExtension, "damaged: the walk's data don't match their hash");
}

}  // namespace espalier::surface_file
