// In: canvases, the blocks that a brush may reach, dabs. Out: painted texels, and records of what they were.
// Dabs of one dispatch are applied in order by each texel for itself; blocks are kept before they are first touched.
#include "runtime/paint/painter.hpp"

#include <algorithm>
#include <cstring>

#include "shaders/paint/smooth_records.h"

namespace espalier {
namespace {

constexpr uint64_t kBlockBytes = kBlockTexels * sizeof(float);
constexpr uint64_t kPlacesBytes = kSmoothPlaces * kBlockTexels * sizeof(uint32_t);  // of a block
constexpr uint32_t kNoSlot = ~0u;
constexpr float kLeastReach = 3;  // texels: for shorter ways a whole texel is too coarse a place

struct StrokeUniforms {
    BrushRecord brush;
    DabRecord dabs[kDabsAtOnce];
};

template <class Buf, class T>
Buf at(uint64_t address) {
    return Buf{reinterpret_cast<T*>(address)};
}
UintBuf wordsOf(const Buffer& buffer) {
    return at<UintBuf, uint32_t>(buffer.address());
}

PaintEnv environment(const Canvas& canvas, uint64_t blocks, size_t count) {
    PaintEnv env{};
    env.texels = canvas.surface.levels[0].texels;
    env.texelTiles = canvas.surface.levels[0].texelTiles;
    env.aux = canvas.surface.levels[0].aux;
    env.layer = at<FloatBuf, float>(canvas.layer->address());
    env.blocks = at<UintBuf, uint32_t>(blocks);
    for (int row = 0; row < 3; ++row) env.toWorld[row] = canvas.surface.toWorld[row];
    env.perScale = 1 / canvas.surface.scale;
    env.count = uint32_t(count);
    env.instance = canvas.instance;
    env.size = canvas.surface.levels[0].size;
    return env;
}

Status ensure(Device& device, Buffer& buffer, const char* name, uint64_t bytes) {
    if (buffer && buffer.size() >= bytes) return Done{};
    return assign(buffer, Buffer::create(device, name, std::max(bytes, 2 * buffer.size())));
}

// A buffer with room for so many items that holds the first `kept` of `before`; none if `before` has that room.
Result<Buffer> roomier(Commands& commands, const Buffer& before, const char* name, size_t kept, size_t items,
                       uint64_t itemBytes) {
    if (before && before.size() >= items * itemBytes) return Buffer();
    Result<Buffer> made =
        Buffer::create(commands.device(), name, std::max<uint64_t>(items * itemBytes, 2 * before.size()));
    if (made && kept) commands.copy(before, *made, kept * itemBytes);
    return made;
}

}  // namespace

Result<std::unique_ptr<Painter>> Painter::create(Device& device) {
    std::unique_ptr<Painter> painter(new Painter(device));
    Status programs = makeCompute(device, {{painter->dabs_, "paint/dabs.comp", exactly(), kBlockTexels},
                                           {painter->blocks_, "paint/blocks.comp", exactly(), kBlockTexels}});
    if (!programs) return programs.failure();
    Status room = ensure(device, painter->stroke_, "paint stroke", sizeof(StrokeUniforms));
    if (!room) return room.failure();
    return painter;
}

void Painter::move(Pass& pass, BlocksEnv env) {
    pass.dispatchItems(blocks_, env.count * kBlockTexels, env);
}

Status Painter::upload(Commands& commands, const std::vector<uint32_t>& words) {
    Status room = ensure(device_, words_, "paint blocks", words.size() * sizeof(uint32_t));
    return room ? commands.upload(words_, words) : room;
}

Result<std::vector<Painter::Placed>> Painter::begin(Commands& commands, std::span<PaintJob> jobs) {
    std::vector<uint32_t> words;
    std::vector<Placed> placed(jobs.size());
    const auto put = [&](std::span<const uint32_t> list) {
        words.insert(words.end(), list.begin(), list.end());
        return (words.size() - list.size()) * sizeof(uint32_t);
    };
    for (size_t j = 0; j < jobs.size(); ++j) {
        BlockRecord& record = *jobs[j].record;
        Placed& p = placed[j];
        const uint32_t side = jobs[j].canvas.surface.levels[0].size / 8;
        record.slots_.resize(size_t(side) * side, kNoSlot);
        const size_t known = record.blocks_.size();
        std::vector<uint32_t> slots;
        for (uint32_t block : jobs[j].blocks) {
            const bool fresh = record.slots_[block] == kNoSlot;
            slots.push_back(fresh ? uint32_t(known + p.freshBlocks.size()) : record.slots_[block]);
            if (fresh) p.freshBlocks.push_back(block);
        }
        Result<Buffer> room =
            roomier(commands, record.texels_, "stroke record", known, known + p.freshBlocks.size(), kBlockBytes);
        if (!room) return room.failure();
        p.texels = std::move(*room);
        p.blocks = put(jobs[j].blocks);
        p.slots = put(slots);
        p.fresh = put(p.freshBlocks);
    }
    if (Status sent = upload(commands, words); !sent) return sent.failure();
    commands.barrier(Use::transfer, Use::compute);

    Pass pass(commands, "paint save");
    for (size_t j = 0; j < jobs.size(); ++j) {
        Placed& p = placed[j];
        for (uint64_t* list : {&p.blocks, &p.slots, &p.fresh}) *list += words_.address();
        const BlockRecord& record = *jobs[j].record;
        if (!p.freshBlocks.empty())
            move(pass, {wordsOf(*jobs[j].canvas.layer),
                        wordsOf(p.texels ? p.texels : record.texels_),
                        at<UintBuf, uint32_t>(p.fresh),
                        {},
                        uint32_t(p.freshBlocks.size()),
                        uint32_t(record.blocks_.size()),
                        kBlocksSave,
                        0});
    }
    pass.barrier(Use::compute, Use::compute);
    return placed;
}

Status Painter::submit(Commands& commands, std::span<PaintJob> jobs, std::vector<Placed> placed) {
    for (size_t j = 0; j < jobs.size(); ++j)  // the rest doesn't fail once the GPU has been told
        jobs[j].record->blocks_.reserve(jobs[j].record->blocks_.size() + placed[j].freshBlocks.size());
    Result<uint64_t> submitted = commands.submit();
    if (!submitted) return submitted.failure();
    for (size_t j = 0; j < jobs.size(); ++j) {
        BlockRecord& record = *jobs[j].record;
        if (placed[j].texels) record.texels_ = std::move(placed[j].texels);
        if (placed[j].places) record.places_ = std::move(placed[j].places);
        for (uint32_t block : placed[j].freshBlocks) {
            record.slots_[block] = uint32_t(record.blocks_.size());
            record.blocks_.push_back(block);
        }
    }
    return Done{};
}

Status Painter::dabs(std::span<PaintJob> jobs, BrushRecord brush, std::span<const DabRecord> dabs) {
    Result<Commands> commands = Commands::begin(device_, "paint");
    if (!commands) return commands.failure();
    Result<std::vector<Placed>> placed = begin(*commands, jobs);
    if (!placed) return placed.failure();
    for (size_t first = 0; first < dabs.size(); first += kDabsAtOnce) {
        const std::span<const DabRecord> some = dabs.subspan(first, std::min<size_t>(kDabsAtOnce, dabs.size() - first));
        StrokeUniforms uniforms{};
        brush.dabs = uint32_t(some.size());
        uniforms.brush = brush;
        std::copy(some.begin(), some.end(), uniforms.dabs);
        Status uploaded = commands->upload(stroke_, std::as_bytes(std::span(&uniforms, 1)));
        if (!uploaded) return uploaded;
        commands->barrier(Use::transfer, Use::compute);
        Pass pass(*commands, "paint dabs");
        for (size_t j = 0; j < jobs.size(); ++j)
            pass.dispatchItems(dabs_, uint32_t(jobs[j].blocks.size()) * kBlockTexels,
                               environment(jobs[j].canvas, (*placed)[j].blocks, jobs[j].blocks.size()), {stroke_});
        pass.barrier(Use::compute, Use::compute | Use::transfer);
    }
    return submit(*commands, jobs, std::move(*placed));
}

Status Painter::fill(std::span<PaintJob> jobs, float value) {
    Result<Commands> commands = Commands::begin(device_, "paint fill");
    if (!commands) return commands.failure();
    Result<std::vector<Placed>> placed = begin(*commands, jobs);
    if (!placed) return placed.failure();
    {
        Pass pass(*commands, "paint fill");
        for (size_t j = 0; j < jobs.size(); ++j)
            move(pass, {wordsOf(*jobs[j].canvas.layer),
                        {},
                        at<UintBuf, uint32_t>((*placed)[j].blocks),
                        {},
                        uint32_t(jobs[j].blocks.size()),
                        0,
                        kBlocksFill,
                        floatBitsToUint(value)});
    }
    return submit(*commands, jobs, std::move(*placed));
}

Status Painter::makeSmoothing() {
    if (smooth_) return Done{};
    return makeCompute(device_, {{places_, "paint/smooth_places.comp", exactly()},
                                 {walk_, "paint/smooth_walk.comp", exactly()},
                                 {smooth_, "paint/smooth.comp", exactly()}});
}

// Dab by dab, since what one leaves the next one averages.
Status Painter::smooth(PaintJob& job, Reach reach, BrushRecord brush, std::span<const DabRecord> dabs) {
    const uint32_t count = uint32_t(job.blocks.size());
    Status ready = makeSmoothing();
    if (ready) ready = ensure(device_, result_, "paint result", count * kBlockBytes);
    if (!ready) return ready;
    Result<Commands> commands = Commands::begin(device_, "paint");
    if (!commands) return commands.failure();
    Result<std::vector<Placed>> placed = begin(*commands, {&job, 1});
    if (!placed) return placed.failure();
    Status found = findPlaces(*commands, job, placed->front(), reach);
    if (!found) return found;

    PaintEnv env = environment(job.canvas, placed->front().blocks, count);
    env.result = at<FloatBuf, float>(result_.address());
    env.slots = at<UintBuf, uint32_t>(placed->front().slots);
    env.places = wordsOf(placed->front().places ? placed->front().places : job.record->places_);
    brush.fine = reach.texels < kLeastReach;
    brush.dabs = 1;
    for (const DabRecord& dab : dabs)
        for (brush.gutters = 0; brush.gutters < 2; ++brush.gutters) {
            StrokeUniforms uniforms{};
            uniforms.brush = brush;
            uniforms.dabs[0] = dab;
            Status uploaded = commands->upload(stroke_, std::as_bytes(std::span(&uniforms, 1)));
            if (!uploaded) return uploaded;
            commands->barrier(Use::transfer, Use::compute);
            Pass pass(*commands, "paint smooth");
            pass.dispatchItems(smooth_, count * kBlockTexels, env, {stroke_});
            pass.barrier(Use::compute, Use::compute | Use::transfer);
            if (brush.gutters) continue;
            move(pass, {wordsOf(*job.canvas.layer), wordsOf(result_), env.blocks, {}, count, 0, kBlocksTake, 0});
            pass.barrier(Use::compute, Use::compute | Use::transfer);
        }
    return submit(*commands, {&job, 1}, std::move(*placed));
}

Status Painter::findPlaces(Commands& commands, const PaintJob& job, Placed& placed, Reach reach) {
    const uint32_t fresh = uint32_t(placed.freshBlocks.size());
    if (fresh == 0) return Done{};
    const BlockRecord& record = *job.record;
    const size_t known = record.blocks_.size();
    Result<Buffer> room = roomier(commands, record.places_, "places of smoothing", known, known + fresh, kPlacesBytes);
    if (!room) return room.failure();
    placed.places = std::move(*room);
    Status walkers = ensure(device_, walkers_, "texels that walk", 4 + fresh * kBlockBytes);
    if (!walkers) return walkers;
    commands.fill(walkers_, 0, 0, 4);
    commands.barrier(Use::transfer, Use::compute);
    PlacesEnv env{};
    env.texels = job.canvas.surface.levels[0].texels;
    env.texelTiles = job.canvas.surface.levels[0].texelTiles;
    env.blocks = at<UintBuf, uint32_t>(placed.fresh);
    env.places =
        at<UintBuf, uint32_t>((placed.places ? placed.places : record.places_).address() + known * kPlacesBytes);
    env.walkers = wordsOf(walkers_);
    env.surfaces = job.canvas.surfaces;
    env.perScale = 1 / job.canvas.surface.scale;
    env.reach = reach.metres;
    env.quads = reach.texels >= kQuadReach;
    env.count = fresh;
    env.instance = job.canvas.instance;
    env.size = job.canvas.surface.levels[0].size;
    Pass pass(commands, "paint places");
    pass.dispatchItems(places_, fresh * kBlockTexels, env);
    pass.barrier(Use::compute, Use::compute);
    // As many as there may be: those beyond the list end at once.
    pass.dispatchItems(walk_, fresh * kBlockTexels, env);
    pass.barrier(Use::compute, Use::compute | Use::transfer);
    return Done{};
}

Status Painter::replace(PaintJob& job, std::span<const float> texels) {
    Result<Commands> commands = Commands::begin(device_, "paint replace");
    if (!commands) return commands.failure();
    Result<std::vector<Placed>> placed = begin(*commands, {&job, 1});
    if (!placed) return placed.failure();
    commands->barrier(Use::compute, Use::transfer);
    Status uploaded = commands->upload(*job.canvas.layer, std::as_bytes(texels));
    if (!uploaded) return uploaded;
    return submit(*commands, {&job, 1}, std::move(*placed));
}

Result<std::vector<uint64_t>> Painter::differences(const Canvas& canvas, const BlockRecord& record) {
    const uint32_t count = uint32_t(record.blocks_.size());
    if (count == 0) return std::vector<uint64_t>();
    Result<Buffer> marks = Buffer::create(device_, "stroke changes", count * sizeof(uint64_t));
    if (!marks) return marks.failure();
    Result<Commands> commands = Commands::begin(device_, "paint compare");
    if (!commands) return commands.failure();
    Status uploaded = upload(*commands, record.blocks_);
    if (!uploaded) return uploaded.failure();
    commands->fill(*marks, 0);
    commands->barrier(Use::transfer, Use::compute);
    {
        Pass pass(*commands, "paint compare");
        move(pass, {wordsOf(*canvas.layer), wordsOf(record.texels_), wordsOf(words_), wordsOf(*marks), count, 0,
                    kBlocksCompare, 0});
    }
    Status compared = commands->finish();
    if (!compared) return compared.failure();
    return readVector<uint64_t>(device_, *marks, 0, count);
}

Status Painter::swap(std::span<const PaintJob> jobs) {
    std::vector<uint32_t> words;
    for (const PaintJob& job : jobs) words.insert(words.end(), job.record->blocks_.begin(), job.record->blocks_.end());
    if (words.empty()) return Done{};
    Result<Commands> commands = Commands::begin(device_, "paint swap");
    if (!commands) return commands.failure();
    if (Status uploaded = upload(*commands, words); !uploaded) return uploaded;
    commands->barrier(Use::transfer, Use::compute);
    {
        Pass pass(*commands, "paint swap");
        uint64_t blocks = words_.address();
        for (const PaintJob& job : jobs) {
            const uint32_t count = uint32_t(job.record->blocks_.size());
            move(pass, {wordsOf(*job.canvas.layer),
                        wordsOf(job.record->texels_),
                        at<UintBuf, uint32_t>(blocks),
                        {},
                        count,
                        0,
                        kBlocksSwap,
                        0});
            blocks += count * sizeof(uint32_t);
        }
    }
    Result<uint64_t> submitted = commands->submit();
    return submitted ? Status(Done{}) : submitted.failure();
}

void BlockRecord::swapKept(std::span<float> layer) {
    for (size_t i = 0; i < blocks_.size(); ++i)
        std::swap_ranges(kept_.begin() + std::ptrdiff_t(i * kBlockTexels),
                         kept_.begin() + std::ptrdiff_t((i + 1) * kBlockTexels),
                         layer.begin() + std::ptrdiff_t(blocks_[i] * kBlockTexels));
}

void BlockRecord::letGo() {
    texels_ = {};
    places_ = {};
    slots_ = {};
}

Status Painter::keep(const Canvas& canvas, BlockRecord& record, std::span<float> layer) {
    record.kept_.clear();
    const uint32_t count = uint32_t(record.blocks_.size());
    if (count == 0) return Done{};
    Result<Buffer> painted = Buffer::create(device_, "painted blocks", count * kBlockBytes);
    if (!painted) return painted.failure();
    Result<Commands> commands = Commands::begin(device_, "paint keep");
    if (!commands) return commands.failure();
    if (Status uploaded = upload(*commands, record.blocks_); !uploaded) return uploaded;
    commands->barrier(Use::transfer, Use::compute);
    {
        Pass pass(*commands, "paint keep");
        move(pass, {wordsOf(*canvas.layer), wordsOf(*painted), wordsOf(words_), {}, count, 0, kBlocksSave, 0});
    }
    if (Status done = commands->finish(); !done) return done;
    Result<std::vector<float>> texels = readVector<float>(device_, *painted, 0, size_t(count) * kBlockTexels);
    if (!texels) return texels.failure();
    Status before = assign(record.kept_, readVector<float>(device_, record.texels_, 0, size_t(count) * kBlockTexels));
    if (!before) return before;
    for (size_t i = 0; i < count; ++i)
        std::copy_n(texels->begin() + std::ptrdiff_t(i * kBlockTexels), kBlockTexels,
                    layer.begin() + std::ptrdiff_t(record.blocks_[i] * kBlockTexels));
    return Done{};
}

Status Painter::restore(BlockRecord& record) {
    if (record.blocks_.empty()) return Done{};
    return assign(record.texels_, makeBuffer(device_, "stroke record", record.kept_));
}

Result<std::vector<uint64_t>> Painter::close(const Canvas& canvas, BlockRecord& record) {
    record.slots_ = {};
    record.places_ = {};
    record.kept_.clear();
    Result<std::vector<uint64_t>> changed = differences(canvas, record);
    if (!changed) return changed;

    std::vector<uint32_t> blocks, from;
    for (uint32_t i = 0; i < changed->size(); ++i)
        if ((*changed)[i]) {
            blocks.push_back(record.blocks_[i]);
            from.push_back(i);
        }
    std::erase(*changed, 0u);
    if (blocks.empty()) {
        record = {};
        return changed;
    }
    Result<Buffer> packed = Buffer::create(device_, "stroke record", blocks.size() * kBlockBytes);
    Result<Commands> packing = Commands::begin(device_, "paint pack");
    if (!packed || !packing) return (packed ? packing.failure() : packed.failure());
    Status uploaded = upload(*packing, from);
    if (!uploaded) return uploaded.failure();
    packing->barrier(Use::transfer, Use::compute);
    {
        Pass pass(*packing, "paint pack");
        move(
            pass,
            {wordsOf(record.texels_), wordsOf(*packed), wordsOf(words_), {}, uint32_t(from.size()), 0, kBlocksSave, 0});
    }
    Result<uint64_t> submitted = packing->submit();
    if (!submitted) return submitted.failure();
    record.texels_ = std::move(*packed);
    record.blocks_ = std::move(blocks);
    return changed;
}

}  // namespace espalier
