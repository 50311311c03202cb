// In: a baked surface in memory. Out: its arrays in device memory and the record of their addresses.
#include "runtime/surface/gpu_surface.hpp"

#include <cmath>

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

// No less than what the arrays take together.
size_t sizeOf(const SurfaceData& data) {
    size_t sum = data.crossings.size() * sizeof(Crossing) + data.charts.size() * sizeof(Chart) +
                 data.triangles.size() * sizeof(TrianglePlane) + 4 * kAlignment;
    for (const SurfaceLevelData& level : data.levels)
        sum += level.texels.size() * sizeof(Texel) + level.aux.size() * sizeof(TexelAux) +
               (level.crossingHead.size() + level.crossingRefs.size()) * 4 + 4 * kAlignment;
    return sum;
}

}  // namespace

Result<GpuSurface> GpuSurface::create(Device& device, const SurfaceData& data) {
    GpuSurface out;
    out.hash_ = data.hash;
    out.ref_ = surfaceRef(data);
    std::vector<std::byte> bytes;
    std::vector<std::pair<uint64_t, void*>> places;  // offset of an array, and the address to be set
    auto add = [&](const auto& values, auto& address) {
        static_assert(sizeof(address) == 8);
        setAddress(address, 0);
        if (values.empty()) return;
        bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment);
        places.emplace_back(bytes.size(), &address);
        const auto view = std::as_bytes(std::span(values));
        bytes.insert(bytes.end(), view.begin(), view.end());
    };
    bytes.reserve(sizeOf(data));
    for (size_t i = 0; i < data.levels.size(); ++i) {
        const SurfaceLevelData& level = data.levels[i];
        add(level.texels, out.ref_.levels[i].texels);
        add(level.aux, out.ref_.levels[i].aux);
        add(level.crossingHead, out.ref_.levels[i].crossingHead);
        add(level.crossingRefs, out.ref_.levels[i].crossingRefs);
    }
    add(data.crossings, out.ref_.crossings);
    add(data.charts, out.ref_.charts);
    add(data.triangles, out.ref_.triangles);
    bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment);
    Result<Buffer> buffer = makeBuffer(device, "surface", std::span<const std::byte>(bytes));
    if (!buffer) return std::move(buffer.failure());
    out.data_ = std::move(*buffer);
    for (auto [offset, address] : places) {
        const uint64_t at = out.data_.address() + offset;
        std::memcpy(address, &at, 8);
    }
    return out;
}

SurfaceRef GpuSurface::ref(const glm::mat4& toWorld) const {
    SurfaceRef ref = ref_;
    placeSurface(ref, toWorld);
    return ref;
}

void placeSurface(SurfaceRef& ref, const glm::mat4& toWorld) {
    for (int row = 0; row < 3; ++row)
        ref.toWorld[row] = glm::vec4(toWorld[0][row], toWorld[1][row], toWorld[2][row], toWorld[3][row]);
    ref.scale = float(std::cbrt(std::abs(glm::determinant(glm::dmat3(glm::mat3(toWorld))))));
}

}  // namespace espalier
