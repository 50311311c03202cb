#pragma once

// A baked surface on the GPU: what a walk reads. The mesh to draw and its pictures belong to render.

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

    // The record for a table of surfaces: device addresses, valid while this lives, and the place in the world.
    // toWorld must move, turn and scale evenly.
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

    uint64_t hash() const { return hash_; }
    uint64_t sizeBytes() const { return data_.size() + lists_.size(); }
    explicit operator bool() const { return bool(data_); }

  private:
    SurfaceRef ref_{};
    uint64_t hash_ = 0;
    Buffer data_;
    Buffer lists_;                                // while crossings are added: lists of all levels and all crossings
    std::vector<uint32_t> refCounts_;             // per level, as uploaded
    std::vector<std::vector<uint32_t>> patched_;  // per level: tiles that differ from what was uploaded
    SurfaceRef listed_{};                         // ref_ with the addresses in lists_
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
// Puts a placement into a surface's record: rows of the matrix, and its even scale.
void placeSurface(SurfaceRef& ref, const glm::mat4& toWorld);

}  // namespace espalier
