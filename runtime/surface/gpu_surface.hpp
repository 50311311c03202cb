#pragma once

// A baked surface on the GPU: what a walk reads. The mesh to draw and its pictures belong to render.

#include "runtime/gpu/buffer.hpp"
#include "runtime/surface/surface.hpp"

namespace espalier {

class GpuSurface {
  public:
    GpuSurface() = default;

    // Uploads levels, crossings, charts and triangles; ready when the call returns, `data` isn't needed after.
    // Fails when memory has run out.
    static Result<GpuSurface> create(Device& device, const SurfaceData& data);

    // The record for a table of surfaces: device addresses, valid while this lives, and the place in the world.
    // toWorld must move, turn and scale evenly.
    SurfaceRef ref(const glm::mat4& toWorld = glm::mat4(1)) const;

    uint64_t hash() const { return hash_; }
    uint64_t sizeBytes() const { return data_.size(); }
    // All its arrays, each at a multiple of 16 bytes; see GrowthInputs::surfaceData.
    const Buffer& data() const { return data_; }
    explicit operator bool() const { return bool(data_); }

  private:
    SurfaceRef ref_{};
    uint64_t hash_ = 0;
    Buffer data_;
};

// Puts a placement into a surface's record: rows of the matrix, and its even scale.
void placeSurface(SurfaceRef& ref, const glm::mat4& toWorld);

}  // namespace espalier
