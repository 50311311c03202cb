#pragma once

// Drawing roofs: culled grid by grid and row by row on the GPU, drawn by indirect draws.

#include "runtime/emit/emit.hpp"
#include "runtime/render/pass_format.hpp"
#include "runtime/render/shading.hpp"
#include "runtime/roof_growth/roof_data.hpp"
#include "shaders/render/roof_draw_records.h"

namespace espalier {

struct RoofDrawStats {
    uint32_t tiles = 0, cutTiles = 0, rectangles = 0;  // instances seen
    uint64_t triangles = 0;
    uint32_t overflow = 0;
};

// What roofs are drawn with in one kind of pass.
struct RoofPrograms {
    Program tile, cutTile, rectangle;

    Status make(Device& device, const PassFormat& pass, Shading shading);
};

class RoofDraw {
  public:
    // meshes: by the numbers that grids carry; kind 0 is none.
    static Result<std::unique_ptr<RoofDraw>> create(Device& device, TerminalData meshes);

    // Bounds of the meshes, for RoofInputs.
    const std::vector<RoofMesh>& bounds() const { return bounds_; }

    // Records the culling for a view; what an earlier one left is lost. shadow: patterns instead of cells.
    Status cull(Commands& commands, const RoofView& roofs, const EmitView& view, bool shadow,
                std::string_view passName);
    // Draws what the last cull left. frame: a FrameRecord. Depth only without a shadow map.
    void draw(DrawPass& pass, const Buffer& frame, const RoofPrograms& programs, const Binding* shadow) const;
    // Of the last cull for a picture that has finished.
    RoofDrawStats stats() const;

  private:
    Status reserve(const RoofView& roofs);

    Device* device_ = nullptr;
    Terminals terminals_;
    std::vector<RoofMesh> bounds_;
    Buffer profiles_;  // RoofProfile[kind * kProfileSteps + step]
    Program cullGrids_, cullRows_, scan_, writeRows_;
    Buffer views_, envs_, state_, rows_, tiles_, cuts_, rectangles_, readback_;
    uint64_t env_ = 0;  // of the last cull
    uint32_t slot_ = 0;
};

}  // namespace espalier
