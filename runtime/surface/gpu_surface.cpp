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

}  // namespace

Result<GpuSurface> GpuSurface::create(Device& device, const SurfaceData& data) {
    GpuSurface out;
    out.hash_ = data.hash;
    out.ref_ = surfaceRef(data);
    Status failed = Done{};
    auto upload = [&](const auto& values, std::string name, auto& address) {
        if (!failed) return;
        auto buffer = makeBuffer(device, name, values);
        if (!buffer) {
            failed = std::move(buffer.failure());
            return;
        }
        setAddress(address, values.empty() ? 0 : buffer->address());
        out.buffers_.push_back(std::move(*buffer));
    };
    for (size_t i = 0; i < data.levels.size(); ++i) {
        const SurfaceLevelData& level = data.levels[i];
        std::string name = "surface level " + std::to_string(i);
        upload(level.texels, name + " texels", out.ref_.levels[i].texels);
        upload(level.aux, name + " aux", out.ref_.levels[i].aux);
        upload(level.crossingHead, name + " crossing heads", out.ref_.levels[i].crossingHead);
        upload(level.crossingRefs, name + " crossing refs", out.ref_.levels[i].crossingRefs);
    }
    upload(data.crossings, "surface crossings", out.ref_.crossings);
    upload(data.charts, "surface charts", out.ref_.charts);
    upload(data.triangles, "surface triangles", out.ref_.triangles);
    if (!failed) return std::move(failed.failure());
    return out;
}

SurfaceRef GpuSurface::ref(const glm::mat4& toWorld) const {
    SurfaceRef ref = ref_;
    placeSurface(ref, toWorld);
    return ref;
}

uint64_t GpuSurface::sizeBytes() const {
    uint64_t sum = 0;
    for (const Buffer& buffer : buffers_) sum += buffer.size();
    return sum;
}

void placeSurface(SurfaceRef& ref, const glm::mat4& toWorld) {
    for (int row = 0; row < 3; ++row)
        ref.toWorld[row] = glm::vec4(toWorld[0][row], toWorld[1][row], toWorld[2][row], toWorld[3][row]);
    ref.scale = float(std::cbrt(std::abs(glm::determinant(glm::dmat3(glm::mat3(toWorld))))));
}

}  // namespace espalier
