#pragma once

// A baked surface on the GPU: what a walk reads. The mesh to draw and its pictures belong to render.

#include <memory>

#include "runtime/gpu/upload.hpp"
#include "runtime/surface/added_crossings.hpp"
#include "runtime/surface/surface.hpp"

namespace espalier {

class GpuSurface {
  public:
    GpuSurface() = default;

    // Uploads levels, crossings, charts and triangles; `data` isn't needed after. Fails when memory has run out.
    static Result<GpuSurface> create(Device& device, const SurfaceData& data);
    // The same in steps: what is to be uploaded, on any thread, and the surface once the upload has been submitted.
    struct Plan;
    static Plan plan(const SurfaceData& data, Upload& upload);
    GpuSurface(const Plan& plan, Upload& upload);
    // The same once more, for another place: shares what was uploaded, and nothing has been added to it.
    GpuSurface another() const { return GpuSurface(baked_); }

    // The record for a table of surfaces: device addresses, valid while this lives, and the place in the world.
    // toWorld must move, turn and scale evenly; it may mirror.
    SurfaceRef ref(const glm::mat4& toWorld = glm::mat4(1)) const;

    // The texels of a level as walks read them now, what others bury included (texelIndex order); waits for the GPU.
    Result<std::vector<Texel>> readTexels(Device& device, size_t level) const;
    // The first `count` crossings as walks read them now: those of the file, then what was added. Waits for the GPU.
    Result<std::vector<Crossing>> readCrossings(Device& device, size_t count) const;
    // What was uploaded of levels (without aux) and crossings; waits for the GPU.
    Status readBack(Device& device, SurfaceData& out) const;
    // What fields over it need: triangles, and of the finest level texels and aux; waits for the GPU.
    Status readForFields(Device& device, SurfaceData& out) const;
    // Adds crossings to those of the file in place of the ones added before, and buries texels in place of those
    // before; none: as it was loaded. `base`: what readBack gave. Records refer to them after the next ref(). On
    // failure all is as before.
    Status addCrossings(Device& device, const SurfaceData& base, std::span<const Crossing> added,
                        const TexelSets& buried = {});

    uint64_t hash() const { return baked_->hash; }
    uint64_t bakedBytes() const { return baked_->data.size(); }  // shared by all places
    uint64_t ownBytes() const { return added_.size(); }
    bool shares(const GpuSurface& other) const { return baked_ == other.baked_; }
    explicit operator bool() const { return bool(baked_); }

  private:
    struct Baked {
        SurfaceRef ref{};
        uint64_t hash = 0;
        Buffer data;
        std::vector<uint32_t> refCounts;  // per level
    };
    explicit GpuSurface(std::shared_ptr<const Baked> baked) : baked_(std::move(baked)), ref_(baked_->ref) {}

    std::shared_ptr<const Baked> baked_;  // what was uploaded; nothing writes to it
    Buffer added_;                        // this place's own tiles, lists and crossings; none: it has none
    SurfaceRef ref_{};                    // baked_->ref with the addresses in added_
};

struct GpuSurface::Plan {
    SurfaceRef ref{};
    uint64_t hash = 0;
    std::vector<uint32_t> refCounts;
    size_t buffer = 0;  // of the upload
    struct Array {
        size_t address;   // byte of `ref`
        uint64_t offset;  // in the buffer
    };
    std::vector<Array> arrays;
};

// The even scale of a placement, as growth reads it.
float scaleOf(const glm::mat4& toWorld);
// Whether a placement turns left into right.
inline bool isMirrored(const glm::mat4& toWorld) {
    return glm::determinant(glm::mat3(toWorld)) < 0;
}
// Puts a placement into a surface's record: rows of the matrix, and its even scale.
void placeSurface(SurfaceRef& ref, const glm::mat4& toWorld);

}  // namespace espalier
