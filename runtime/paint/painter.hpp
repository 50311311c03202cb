#pragma once

// Painting on layers: dabs on the texels of all surfaces that they reach, and the records that take strokes back.
// Work is submitted and not waited for, but where it says so; later recordings of the device see its results.

#include <memory>
#include <span>
#include <vector>

#include "runtime/gpu/buffer.hpp"
#include "runtime/gpu/commands.hpp"
#include "runtime/gpu/program.hpp"
#include "runtime/paint/block_bounds.hpp"
#include "shaders/paint/block_records.h"

namespace espalier {

// One layer over one placed surface; what it points at stays the caller's.
struct Canvas {
    const Buffer* layer = nullptr;  // size² floats in texelIndex order
    SurfaceRef surface{};           // by device addresses; the layer is as large as its level 0
    uint32_t instance = 0;
    SurfaceBuf surfaces{};  // the table that holds it, needed for smoothing only
};

// What blocks of one layer held before a stroke touched them: 256 bytes each and 4 for its number; as much again for
// the host's copy, from which another device gets it.
class BlockRecord {
  public:
    const std::vector<uint32_t>& blocks() const { return blocks_; }  // in the order in which they were first touched
    uint64_t bytes() const { return texels_.size() + blocks_.size() * 4 + kept_.size() * sizeof(float); }

    bool isKept() const { return kept_.size() == blocks_.size() * kBlockTexels; }  // by the host
    // Exchanges the host's copies of blocks as Painter::swap does on the device. layer: size² floats.
    void swapKept(std::span<float> layer);
    void dropKept() { kept_.clear(); }
    // What lies on a device goes.
    void letGo();

  private:
    friend class Painter;
    std::vector<uint32_t> blocks_;
    Buffer texels_;
    std::vector<float> kept_;  // the host's copy of these texels; empty: there is none
    // While the stroke goes on:
    std::vector<uint32_t> slots_;  // [block]: where it is among blocks_, or kNoSlot
    Buffer places_;                // where smoothing looks, 1,536 bytes a block
};

// The part of a stroke that falls on one canvas.
struct PaintJob {
    Canvas canvas;
    BlockRecord* record = nullptr;
    std::vector<uint32_t> blocks;  // that its dabs may reach, each once
};

// How far smoothing looks.
struct Reach {
    float metres = 0, texels = 0;  // the same on one surface
};

class Painter {
  public:
    // Fails when memory has run out.
    static Result<std::unique_ptr<Painter>> create(Device& device);

    // Applies the dabs in order. Blocks that a record doesn't hold yet are kept in it first.
    Status dabs(std::span<PaintJob> jobs, BrushRecord brush, std::span<const DabRecord> dabs);
    // Smooths by the dabs, one after the other: texels go towards the mean of places reach.texels away over the
    // surface, which are found when a stroke comes to a block. All dabs of a record have one reach. The canvases need
    // their table of surfaces.
    Status smooth(PaintJob& job, Reach reach, BrushRecord brush, std::span<const DabRecord> dabs);
    // Sets all texels of the jobs' blocks, likewise.
    Status fill(std::span<PaintJob> jobs, float value);
    // Sets all texels of one canvas: size² floats in texelIndex order. The job's blocks are those to be kept.
    Status replace(PaintJob& job, std::span<const float> texels);
    // Drops from a record the blocks that are as they were, and gives back the room it doesn't need; from then on it
    // takes no more dabs. Gives of each block that is left the texels that changed, bit 8 y + x. Waits for the GPU.
    Result<std::vector<uint64_t>> close(const Canvas& canvas, BlockRecord& record);
    // Copies to the host what a closed record holds, and what the layer now has in the record's blocks: into `layer`,
    // size² floats. Waits for the GPU. On failure the record has no copy, and `layer` is as it was.
    Status keep(const Canvas& canvas, BlockRecord& record, std::span<float> layer);
    // Puts on the device what the host has kept of a closed record.
    Status restore(BlockRecord& record);
    // Of each block of a record the texels that differ from the layer's, bit 8 y + x. Waits for the GPU.
    Result<std::vector<uint64_t>> differences(const Canvas& canvas, const BlockRecord& record);
    // Exchanges the layers' blocks with the records', bit for bit: twice is as before. All of them or none. The jobs'
    // own blocks are of no account.
    Status swap(std::span<const PaintJob> jobs);

  private:
    explicit Painter(Device& device) : device_(device) {}
    // Where a job's lists lie on the GPU: addresses of numbers of blocks, and of their places in the record.
    struct Placed {
        uint64_t blocks = 0, slots = 0;
        uint64_t fresh = 0;  // those that are new to the record, and become its last
        std::vector<uint32_t> freshBlocks;
        Buffer texels, places;  // roomier ones, where the record's don't suffice
    };
    // Puts the jobs' blocks on the GPU, and records that those are kept that are new to their records. These know of it
    // only once all is submitted: what is dropped before has kept nothing.
    Result<std::vector<Placed>> begin(Commands& commands, std::span<PaintJob> jobs);
    static Status submit(Commands& commands, std::span<PaintJob> jobs, std::vector<Placed> placed);
    Status makeSmoothing();
    // The same for all dabs of a stroke: where texels of the new blocks look.
    Status findPlaces(Commands& commands, const PaintJob& job, Placed& placed, Reach reach);
    Status upload(Commands& commands, const std::vector<uint32_t>& words);
    void move(Pass& pass, BlocksEnv env);

    Device& device_;
    Program dabs_, blocks_;
    Program smooth_, places_, walk_;  // made when first asked for
    Buffer stroke_;                   // BrushRecord and its dabs
    Buffer words_;                    // numbers of blocks
    Buffer result_, walkers_;         // of smoothing
};

}  // namespace espalier
