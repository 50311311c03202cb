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

// All lists and crossings, those of the file first; sets their addresses in `ref`.
Result<Buffer> makeLists(Device& device, const SurfaceData& base, const std::vector<LevelPatch>& patches,
                         std::span<const Crossing> added, SurfaceRef& ref) {
    std::vector<std::byte> bytes;
    auto append = [&](const auto& values) {
        const auto view = std::as_bytes(std::span(values));
        bytes.insert(bytes.end(), view.begin(), view.end());
    };
    std::vector<size_t> begins;
    for (size_t l = 0; l < patches.size(); ++l) {
        begins.push_back(bytes.size());
        append(base.levels[l].crossingRefs);
        append(patches[l].added);
        bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment);
    }
    begins.push_back(bytes.size());
    append(base.crossings);
    append(added);
    Result<Buffer> buffer = makeBuffer(device, "surface contacts", std::span<const std::byte>(bytes));
    if (!buffer) return buffer;
    for (size_t l = 0; l < patches.size(); ++l) setAddress(ref.levels[l].crossingRefs, buffer->address() + begins[l]);
    setAddress(ref.crossings, buffer->address() + begins.back());
    ref.crossingCount += uint32_t(added.size());
    return buffer;
}

// Writes 8×8 tiles of a level as the patch has them: texels and heads, up to four that follow each other in one go, as
// many as fit into the recording itself.
Status writeTiles(Commands& commands, const Buffer& data, const SurfaceLevel& place, const SurfaceLevelData& base,
                  const LevelPatch& patch, const std::vector<uint32_t>& tiles) {
    std::vector<Texel> texels;
    std::vector<uint32_t> heads;
    size_t next = 0;
    for (size_t i = 0; i < tiles.size();) {
        size_t end = i + 1;
        while (end < tiles.size() && end < i + 4 && tiles[end] == tiles[end - 1] + 1) ++end;
        const size_t first = size_t(tiles[i]) * 64, count = (end - i) * 64;
        texels.assign(base.texels.begin() + std::ptrdiff_t(first), base.texels.begin() + std::ptrdiff_t(first + count));
        heads.assign(base.crossingHead.begin() + std::ptrdiff_t(first),
                     base.crossingHead.begin() + std::ptrdiff_t(first + count));
        for (; next < patch.texels.size() && patch.texels[next] < first + count; ++next) {
            texels[patch.texels[next] - first].bits = patch.bits[next];
            heads[patch.texels[next] - first] = patch.heads[next];
        }
        const uint64_t texelsAt = addressOf(place.texels) - data.address() + first * sizeof(Texel);
        const uint64_t headsAt = addressOf(place.crossingHead) - data.address() + first * 4;
        if (Status s = commands.upload(data, texels, texelsAt); !s) return s;
        if (Status s = commands.upload(data, heads, headsAt); !s) return s;
        i = end;
    }
    return Done{};
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

GpuSurface::GpuSurface(const Plan& plan, Upload& upload)
    : ref_(plan.ref), hash_(plan.hash), data_(upload.takeBuffer(plan.buffer)), refCounts_(plan.refCounts) {
    for (const Plan::Array& array : plan.arrays) {
        const uint64_t at = data_.address() + array.offset;
        std::memcpy(reinterpret_cast<std::byte*>(&ref_) + array.address, &at, 8);
    }
}

Result<GpuSurface> GpuSurface::create(Device& device, const SurfaceData& data) {
    Upload upload;
    const Plan planned = plan(data, upload);
    if (Status done = upload.run(device); !done) return done.failure();
    return GpuSurface(planned, upload);
}

SurfaceRef GpuSurface::ref(const glm::mat4& toWorld) const {
    SurfaceRef ref = lists_ ? listed_ : ref_;
    placeSurface(ref, toWorld);
    return ref;
}

Result<std::vector<Texel>> GpuSurface::readTexels(Device& device, size_t level) const {
    const SurfaceLevel& from = ref_.levels[level];
    return readArray<Texel>(device, data_, from.texels, size_t(from.size) * from.size);
}

Result<std::vector<Crossing>> GpuSurface::readCrossings(Device& device, size_t count) const {
    return lists_ ? readArray<Crossing>(device, lists_, listed_.crossings, count)
                  : readArray<Crossing>(device, data_, ref_.crossings, count);
}

Status GpuSurface::readForFields(Device& device, SurfaceData& out) const {
    const SurfaceLevel& finest = ref_.levels[0];
    const size_t texels = size_t(finest.size) * finest.size;
    out.levels.resize(1);
    out.levels[0].size = finest.size;
    return allDone({assign(out.triangles, readArray<TrianglePlane>(device, data_, ref_.triangles, ref_.triangleCount)),
                    assign(out.levels[0].texels, readArray<Texel>(device, data_, finest.texels, texels)),
                    assign(out.levels[0].aux, readArray<TexelAux>(device, data_, finest.aux, texels))});
}

Status GpuSurface::readBack(Device& device, SurfaceData& out) const {
    auto read = [&](auto& values, auto buffer, size_t count) -> Status {
        using T = typename std::decay_t<decltype(values)>::value_type;
        return assign(values, readArray<T>(device, data_, buffer, count));
    };
    out.levels.resize(ref_.levelCount);
    for (size_t i = 0; i < out.levels.size(); ++i) {
        const SurfaceLevel& from = ref_.levels[i];
        SurfaceLevelData& level = out.levels[i];
        const size_t texels = size_t(from.size) * from.size;
        level.size = from.size;
        if (Status s = read(level.texels, from.texels, texels); !s) return s;
        if (Status s = read(level.crossingHead, from.crossingHead, texels); !s) return s;
        if (Status s = read(level.crossingRefs, from.crossingRefs, refCounts_[i]); !s) return s;
    }
    return read(out.crossings, ref_.crossings, ref_.crossingCount);
}

Status GpuSurface::addCrossings(Device& device, const SurfaceData& base, std::span<const Crossing> added,
                                const TexelSets& buried) {
    Result<std::vector<LevelPatch>> patches = patchLevels(base, added, buried);
    if (!patches) return patches.failure();
    SurfaceRef listed = ref_;
    Buffer lists;
    if (!added.empty()) {
        if (Status made = assign(lists, makeLists(device, base, *patches, added, listed)); !made) return made.failure();
    }
    Result<Commands> commands = Commands::begin(device, "contacts");
    if (!commands) return commands.failure();
    std::vector<std::vector<uint32_t>> tiles(base.levels.size());
    for (size_t l = 0; l < tiles.size(); ++l) {
        const LevelPatch& patch = (*patches)[l];
        for (uint32_t texel : patch.texels)
            if (tiles[l].empty() || tiles[l].back() != texel >> 6) tiles[l].push_back(texel >> 6);
        std::vector<uint32_t> stale = tiles[l];
        if (l < patched_.size()) stale.insert(stale.end(), patched_[l].begin(), patched_[l].end());
        std::sort(stale.begin(), stale.end());
        stale.erase(std::unique(stale.begin(), stale.end()), stale.end());
        if (Status s = writeTiles(*commands, data_, ref_.levels[l], base.levels[l], patch, stale); !s) return s;
    }
    if (Status done = commands->finish(); !done) return done;
    lists_ = std::move(lists);
    listed_ = listed;
    patched_ = std::move(tiles);
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
