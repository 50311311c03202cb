// In: a baked surface in memory. Out: its arrays in device memory and the record of their addresses.
#include "runtime/surface/gpu_surface.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/gpu/commands.hpp"

namespace espalier {
namespace {

// A kernel's buffer type holds a device address where the CPU build holds a pointer.
template <class Buf>
void setAddress(Buf& buffer, uint64_t address) {
    static_assert(sizeof(Buf) == 8);
    std::memcpy(static_cast<void*>(&buffer), &address, 8);
}

// Arrays begin at multiples of this, so that kernels may read them as texels.
constexpr size_t kAlignment = 16;
constexpr uint32_t kTileTexels = 64;  // 8x8, of which texelIndex numbers all before the next tile's

template <class Buf>
uint64_t addressOf(const Buf& buffer) {
    uint64_t address;
    std::memcpy(&address, &buffer, 8);
    return address;
}

// `count` records that the buffer holds at an array's address.
template <class T, class Buf>
Result<std::vector<T>> readArray(Device& device, const Buffer& holder, const Buf& array, size_t count) {
    std::vector<T> values(count);
    if (count == 0) return values;
    const uint64_t offset = addressOf(array) - holder.address();
    Result<std::vector<std::byte>> bytes = readBuffer(device, holder, offset, count * sizeof(T));
    if (!bytes) return bytes.failure();
    std::memcpy(static_cast<void*>(values.data()), bytes->data(), bytes->size());
    return values;
}

// No less than what the arrays take together.
size_t sizeOf(const SurfaceData& data) {
    size_t sum = data.crossings.size() * sizeof(Crossing) + data.charts.size() * sizeof(Chart) +
                 data.triangles.size() * sizeof(TrianglePlane) + 4 * kAlignment;
    for (const SurfaceLevelData& level : data.levels)
        sum += level.texels.size() * sizeof(Texel) + level.aux.size() * sizeof(TexelAux) +
               (level.crossingHead.size() + level.crossingRefs.size()) * 4 + 4 * kAlignment;
    return sum;
}

// Arrays one after the other, as they will lie in one buffer.
class Arrays {
  public:
    // The byte at which the values begin.
    template <class T>
    size_t append(std::span<const T> values) {
        bytes_.resize((bytes_.size() + kAlignment - 1) / kAlignment * kAlignment);
        const size_t at = bytes_.size();
        const auto view = std::as_bytes(values);
        bytes_.insert(bytes_.end(), view.begin(), view.end());
        return at;
    }
    template <class T>
    size_t append(const std::vector<T>& values) {
        return append(std::span<const T>(values));
    }
    std::span<const std::byte> bytes() const { return bytes_; }
    uint64_t* wordsAt(size_t byte) { return reinterpret_cast<uint64_t*>(bytes_.data() + byte); }

  private:
    std::vector<std::byte> bytes_;
};

// Where a touched level's arrays begin in the buffer of what is added; tables lead to tiles that are still to be
// placed.
struct TouchedLevel {
    size_t refs = 0, texelTable = 0, headTable = 0;
    size_t texels = 0, heads = 0;  // of its own tiles
    std::vector<uint32_t> tiles;   // which these are, ascending
};

// The tiles of a level that the patch changes, with the patch.
TouchedLevel appendLevel(Arrays& arrays, const SurfaceLevelData& base, const LevelPatch& patch) {
    TouchedLevel level;
    for (const uint32_t texel : patch.texels)
        if (level.tiles.empty() || level.tiles.back() != texel / kTileTexels)
            level.tiles.push_back(texel / kTileTexels);
    std::vector<Texel> texels;
    std::vector<uint32_t> heads;
    size_t next = 0;
    for (const uint32_t tile : level.tiles) {
        const size_t first = size_t(tile) * kTileTexels, begin = texels.size();
        texels.insert(texels.end(), &base.texels[first], &base.texels[first] + kTileTexels);
        heads.insert(heads.end(), &base.crossingHead[first], &base.crossingHead[first] + kTileTexels);
        for (; next < patch.texels.size() && patch.texels[next] < first + kTileTexels; ++next) {
            texels[begin + patch.texels[next] - first].bits = patch.bits[next];
            heads[begin + patch.texels[next] - first] = patch.heads[next];
        }
    }
    std::vector<uint32_t> refs = base.crossingRefs;
    refs.insert(refs.end(), patch.added.begin(), patch.added.end());
    level.refs = arrays.append(refs);
    level.texels = arrays.append(texels);
    level.heads = arrays.append(heads);
    const std::vector<uint64_t> table(base.texels.size() / kTileTexels);
    level.texelTable = arrays.append(table);
    level.headTable = arrays.append(table);
    return level;
}

// Each tile's address: where it was baked, or in the buffer at `added` that the arrays will lie in.
void fillTables(Arrays& arrays, const TouchedLevel& level, const SurfaceLevel& baked, uint64_t added) {
    uint64_t* const texels = arrays.wordsAt(level.texelTable);
    uint64_t* const heads = arrays.wordsAt(level.headTable);
    const uint64_t bakedTexels = addressOf(baked.texels), bakedHeads = addressOf(baked.crossingHead);
    for (uint32_t tile = 0; tile < baked.size * baked.size / kTileTexels; ++tile) {
        texels[tile] = bakedTexels + uint64_t(tile) * kTileTexels * sizeof(Texel);
        heads[tile] = bakedHeads + uint64_t(tile) * kTileTexels * sizeof(uint32_t);
    }
    for (size_t i = 0; i < level.tiles.size(); ++i) {
        texels[level.tiles[i]] = added + level.texels + i * kTileTexels * sizeof(Texel);
        heads[level.tiles[i]] = added + level.heads + i * kTileTexels * sizeof(uint32_t);
    }
}

}  // namespace

GpuSurface::Plan GpuSurface::plan(const SurfaceData& data, Upload& upload) {
    Plan plan;
    plan.hash = data.hash;
    plan.ref = surfaceRef(data);
    std::vector<std::byte> bytes;
    const auto add = [&](const auto& values, auto& address) {
        static_assert(sizeof(address) == 8);
        setAddress(address, 0);
        if (values.empty()) return;
        bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment);
        const auto* field = reinterpret_cast<const std::byte*>(&address);
        plan.arrays.push_back({size_t(field - reinterpret_cast<const std::byte*>(&plan.ref)), bytes.size()});
        const auto view = std::as_bytes(std::span(values));
        bytes.insert(bytes.end(), view.begin(), view.end());
    };
    bytes.reserve(sizeOf(data));
    for (size_t i = 0; i < data.levels.size(); ++i) {
        const SurfaceLevelData& level = data.levels[i];
        add(level.texels, plan.ref.levels[i].texels);
        add(level.aux, plan.ref.levels[i].aux);
        add(level.crossingHead, plan.ref.levels[i].crossingHead);
        add(level.crossingRefs, plan.ref.levels[i].crossingRefs);
        plan.refCounts.push_back(uint32_t(level.crossingRefs.size()));
    }
    add(data.crossings, plan.ref.crossings);
    add(data.charts, plan.ref.charts);
    add(data.triangles, plan.ref.triangles);
    bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment);
    plan.buffer = upload.addBuffer("surface", std::move(bytes));
    return plan;
}

GpuSurface::GpuSurface(const Plan& plan, Upload& upload) {
    auto baked = std::make_shared<Baked>();
    baked->ref = plan.ref;
    baked->hash = plan.hash;
    baked->data = upload.takeBuffer(plan.buffer);
    baked->refCounts = plan.refCounts;
    for (const Plan::Array& array : plan.arrays) {
        const uint64_t at = baked->data.address() + array.offset;
        std::memcpy(reinterpret_cast<std::byte*>(&baked->ref) + array.address, &at, 8);
    }
    baked_ = std::move(baked);
    ref_ = baked_->ref;
}

Result<GpuSurface> GpuSurface::create(Device& device, const SurfaceData& data) {
    Upload upload;
    const Plan planned = plan(data, upload);
    if (Status done = upload.run(device); !done) return done.failure();
    return GpuSurface(planned, upload);
}

SurfaceRef GpuSurface::ref(const glm::mat4& toWorld) const {
    SurfaceRef ref = ref_;
    placeSurface(ref, toWorld);
    return ref;
}

Result<std::vector<Texel>> GpuSurface::readTexels(Device& device, size_t level) const {
    const SurfaceLevel& from = ref_.levels[level];
    const size_t count = size_t(from.size) * from.size;
    Result<std::vector<Texel>> texels = readArray<Texel>(device, baked_->data, from.texels, count);
    if (!texels || !from.touched) return texels;
    Result<std::vector<uint64_t>> tiles = readArray<uint64_t>(device, added_, from.texelTiles, count / kTileTexels);
    if (!tiles) return tiles.failure();
    // Its own tiles are few, and lie one after the other.
    const uint64_t begin = added_.address(), end = begin + added_.size();
    std::vector<size_t> own;
    for (size_t tile = 0; tile < tiles->size(); ++tile)
        if ((*tiles)[tile] >= begin && (*tiles)[tile] < end) own.push_back(tile);
    if (own.empty()) return texels;
    Result<std::vector<Texel>> changed =
        readArray<Texel>(device, added_, (*tiles)[own.front()], own.size() * kTileTexels);
    if (!changed) return changed;
    for (size_t i = 0; i < own.size(); ++i)
        std::copy_n(changed->begin() + std::ptrdiff_t(i * kTileTexels), kTileTexels,
                    texels->begin() + std::ptrdiff_t(own[i] * kTileTexels));
    return texels;
}

Result<std::vector<Crossing>> GpuSurface::readCrossings(Device& device, size_t count) const {
    return readArray<Crossing>(device, added_ ? added_ : baked_->data, ref_.crossings, count);
}

Status GpuSurface::readForFields(Device& device, SurfaceData& out) const {
    const SurfaceRef& from = baked_->ref;
    const SurfaceLevel& finest = from.levels[0];
    const size_t texels = size_t(finest.size) * finest.size;
    const Buffer& data = baked_->data;
    out.levels.resize(1);
    out.levels[0].size = finest.size;
    return allDone({assign(out.triangles, readArray<TrianglePlane>(device, data, from.triangles, from.triangleCount)),
                    assign(out.levels[0].texels, readArray<Texel>(device, data, finest.texels, texels)),
                    assign(out.levels[0].aux, readArray<TexelAux>(device, data, finest.aux, texels))});
}

Status GpuSurface::readBack(Device& device, SurfaceData& out) const {
    auto read = [&](auto& values, auto buffer, size_t count) -> Status {
        using T = typename std::decay_t<decltype(values)>::value_type;
        return assign(values, readArray<T>(device, baked_->data, buffer, count));
    };
    out.levels.resize(baked_->ref.levelCount);
    for (size_t i = 0; i < out.levels.size(); ++i) {
        const SurfaceLevel& from = baked_->ref.levels[i];
        SurfaceLevelData& level = out.levels[i];
        const size_t texels = size_t(from.size) * from.size;
        level.size = from.size;
        if (Status s = read(level.texels, from.texels, texels); !s) return s;
        if (Status s = read(level.crossingHead, from.crossingHead, texels); !s) return s;
        if (Status s = read(level.crossingRefs, from.crossingRefs, baked_->refCounts[i]); !s) return s;
    }
    return read(out.crossings, baked_->ref.crossings, baked_->ref.crossingCount);
}

Status GpuSurface::addCrossings(Device& device, const SurfaceData& base, std::span<const Crossing> added,
                                const TexelSets& buried) {
    if (added.empty() && std::ranges::all_of(buried, &std::vector<uint32_t>::empty)) {
        added_ = {};
        ref_ = baked_->ref;
        return Done{};
    }
    Result<std::vector<LevelPatch>> patches = patchLevels(base, added, buried);
    if (!patches) return patches.failure();
    Arrays arrays;
    std::vector<TouchedLevel> levels;
    for (size_t l = 0; l < patches->size(); ++l) levels.push_back(appendLevel(arrays, base.levels[l], (*patches)[l]));
    std::vector<Crossing> crossings = base.crossings;
    crossings.insert(crossings.end(), added.begin(), added.end());
    const size_t crossingsAt = arrays.append(crossings);
    Result<Buffer> buffer = Buffer::create(device, "surface contacts", arrays.bytes().size());
    if (!buffer) return buffer.failure();
    SurfaceRef ref = baked_->ref;
    const uint64_t begin = buffer->address();
    for (size_t l = 0; l < levels.size(); ++l) {
        SurfaceLevel& to = ref.levels[l];
        fillTables(arrays, levels[l], baked_->ref.levels[l], begin);
        setAddress(to.crossingRefs, begin + levels[l].refs);
        setAddress(to.texelTiles, begin + levels[l].texelTable);
        setAddress(to.headTiles, begin + levels[l].headTable);
        to.touched = 1;
    }
    setAddress(ref.crossings, begin + crossingsAt);
    ref.crossingCount += uint32_t(added.size());
    Result<Commands> commands = Commands::begin(device, "contacts");
    if (!commands) return commands.failure();
    if (Status uploaded = commands->upload(*buffer, arrays.bytes(), 0); !uploaded) return uploaded;
    if (Status done = commands->finish(); !done) return done;
    added_ = std::move(*buffer);
    ref_ = ref;
    return Done{};
}

float scaleOf(const glm::mat4& toWorld) {
    return float(std::cbrt(std::abs(glm::determinant(glm::dmat3(glm::mat3(toWorld))))));
}

void placeSurface(SurfaceRef& ref, const glm::mat4& toWorld) {
    for (int row = 0; row < 3; ++row)
        ref.toWorld[row] = glm::vec4(toWorld[0][row], toWorld[1][row], toWorld[2][row], toWorld[3][row]);
    ref.scale = scaleOf(toWorld);
}

}  // namespace espalier
