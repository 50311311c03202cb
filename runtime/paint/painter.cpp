// In: canvases, the blocks that a brush may reach, dabs. Out: painted texels, and records of what they were.
// Dabs of one dispatch are applied in order by each texel for itself; blocks are kept before they are first touched.
#include "runtime/paint/painter.hpp"

#include <cstring>

#include "runtime/core/check.hpp"
#include "shaders/paint/block_records.h"

namespace espalier {
namespace {

constexpr uint64_t kBlockBytes = kBlockTexels * sizeof(float);

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
    env.aux = canvas.surface.levels[0].aux;
    env.layer = at<FloatBuf, float>(canvas.layer->address());
    env.blocks = at<UintBuf, uint32_t>(blocks);
    for (int row = 0; row < 3; ++row) env.toWorld[row] = canvas.surface.toWorld[row];
    env.perScale = 1 / canvas.surface.scale;
    env.count = uint32_t(count);
    env.instance = canvas.instance;
    env.size = canvas.surface.levels[0].size;
    env.surfaces = canvas.surfaces;
    return env;
}

Status ensure(Device& device, Buffer& buffer, const char* name, uint64_t bytes) {
    if (buffer && buffer.size() >= bytes) return Done{};
    Result<Buffer> made = Buffer::create(device, name, std::max(bytes, 2 * buffer.size()));
    if (!made) return made.failure();
    buffer = std::move(*made);
    return Done{};
}

}  // namespace

Result<std::unique_ptr<Painter>> Painter::create(Device& device) {
    std::unique_ptr<Painter> painter(new Painter(device));
    struct Row {
        Program& program;
        const char* shader;
    };
    for (const Row& row : {Row{painter->dabs_, "paint/dabs.comp"}, Row{painter->blocks_, "paint/blocks.comp"}}) {
        Result<Program> made = Program::compute(device, row.shader, {.exact = true, .constants = {}});
        if (!made) return made.failure();
        requireEqual(made->localSize()[0], kBlockTexels, "local size of a painting kernel");
        row.program = std::move(*made);
    }
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

Status Painter::makeRoom(Commands& commands, BlockRecord& record, size_t blocks) {
    if (record.texels_ && record.texels_.size() >= blocks * kBlockBytes) return Done{};
    Result<Buffer> larger =
        Buffer::create(device_, "stroke record", std::max(blocks * kBlockBytes, 2 * record.texels_.size()));
    if (!larger) return larger.failure();
    if (!record.blocks_.empty()) commands.copy(record.texels_, *larger, record.blocks_.size() * kBlockBytes);
    record.texels_ = std::move(*larger);
    return Done{};
}

Result<std::vector<uint64_t>> Painter::begin(Commands& commands, std::span<PaintJob> jobs) {
    std::vector<uint32_t> words;
    std::vector<std::vector<uint32_t>> fresh(jobs.size());
    for (size_t j = 0; j < jobs.size(); ++j) {
        BlockRecord& record = *jobs[j].record;
        const uint32_t side = jobs[j].canvas.surface.levels[0].size / 8;
        record.known_.resize(size_t(side) * side);
        for (uint32_t block : jobs[j].blocks)
            if (!record.known_[block]) fresh[j].push_back(block);
        Status room = makeRoom(commands, record, record.blocks_.size() + fresh[j].size());
        if (!room) return room.failure();
        words.insert(words.end(), jobs[j].blocks.begin(), jobs[j].blocks.end());
        words.insert(words.end(), fresh[j].begin(), fresh[j].end());
    }
    Status uploaded = upload(commands, words);
    if (!uploaded) return uploaded.failure();
    commands.barrier(Use::transfer, Use::compute);

    std::vector<uint64_t> placed(jobs.size());
    uint64_t next = words_.address();
    Pass pass(commands, "paint save");
    for (size_t j = 0; j < jobs.size(); ++j) {
        BlockRecord& record = *jobs[j].record;
        placed[j] = next;
        next += jobs[j].blocks.size() * sizeof(uint32_t);
        if (!fresh[j].empty())
            move(pass, {wordsOf(*jobs[j].canvas.layer),
                        wordsOf(record.texels_),
                        at<UintBuf, uint32_t>(next),
                        {},
                        uint32_t(fresh[j].size()),
                        uint32_t(record.blocks_.size()),
                        kBlocksSave,
                        0});
        next += fresh[j].size() * sizeof(uint32_t);
        record.blocks_.insert(record.blocks_.end(), fresh[j].begin(), fresh[j].end());
        for (uint32_t block : fresh[j]) record.known_[block] = true;
    }
    pass.barrier(Use::compute, Use::compute);
    return placed;
}

Status Painter::dabs(std::span<PaintJob> jobs, BrushRecord brush, std::span<const DabRecord> dabs) {
    Result<Commands> commands = Commands::begin(device_, "paint");
    if (!commands) return commands.failure();
    Result<std::vector<uint64_t>> placed = begin(*commands, jobs);
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
                               environment(jobs[j].canvas, (*placed)[j], jobs[j].blocks.size()), {stroke_});
        pass.barrier(Use::compute, Use::compute | Use::transfer);
    }
    Result<uint64_t> submitted = commands->submit();
    return submitted ? Status(Done{}) : submitted.failure();
}

Status Painter::fill(std::span<PaintJob> jobs, float value) {
    Result<Commands> commands = Commands::begin(device_, "paint fill");
    if (!commands) return commands.failure();
    Result<std::vector<uint64_t>> placed = begin(*commands, jobs);
    if (!placed) return placed.failure();
    {
        Pass pass(*commands, "paint fill");
        for (size_t j = 0; j < jobs.size(); ++j)
            move(pass, {wordsOf(*jobs[j].canvas.layer),
                        {},
                        at<UintBuf, uint32_t>((*placed)[j]),
                        {},
                        uint32_t(jobs[j].blocks.size()),
                        0,
                        kBlocksFill,
                        floatBitsToUint(value)});
    }
    Result<uint64_t> submitted = commands->submit();
    return submitted ? Status(Done{}) : submitted.failure();
}

// Dab by dab, since what one leaves the next one averages: inner texels first, then the gutters that stand for them.
Status Painter::smooth(std::span<PaintJob> jobs, BrushRecord brush, std::span<const DabRecord> dabs) {
    if (!smooth_) {
        Result<Program> made = Program::compute(device_, "paint/smooth.comp", {.exact = true, .constants = {}});
        Result<Program> inside =
            Program::compute(device_, "paint/smooth_inside.comp", {.exact = true, .constants = {}});
        if (!made || !inside) return made ? inside.failure() : made.failure();
        smooth_ = std::move(*made);
        smoothInside_ = std::move(*inside);
    }
    size_t most = 0;
    for (const PaintJob& job : jobs) most = std::max(most, job.blocks.size());
    Status room = ensure(device_, result_, "paint result", most * kBlockBytes);
    if (!room) return room;
    Result<Commands> commands = Commands::begin(device_, "paint");
    if (!commands) return commands.failure();
    Result<std::vector<uint64_t>> placed = begin(*commands, jobs);
    if (!placed) return placed.failure();
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
            for (size_t j = 0; j < jobs.size(); ++j) {
                // Gutters lie beside borders: there are none in blocks that no border is near.
                const uint32_t inside = jobs[j].inside, all = uint32_t(jobs[j].blocks.size());
                const uint32_t first = brush.gutters ? inside : 0;
                const auto smoothBlocks = [&](const Program& program, uint32_t from, uint32_t to) {
                    if (from == to) return;
                    PaintEnv env = environment(jobs[j].canvas, (*placed)[j] + from * sizeof(uint32_t), to - from);
                    env.result = at<FloatBuf, float>(result_.address() + from * kBlockBytes);
                    pass.dispatchItems(program, (to - from) * kBlockTexels, env, {stroke_});
                };
                smoothBlocks(smoothInside_, first, inside);
                smoothBlocks(smooth_, inside, all);
                pass.barrier(Use::compute, Use::compute);
                if (first < all)
                    move(pass, {wordsOf(*jobs[j].canvas.layer),
                                at<UintBuf, uint32_t>(result_.address() + first * kBlockBytes),
                                at<UintBuf, uint32_t>((*placed)[j] + first * sizeof(uint32_t)),
                                {},
                                all - first,
                                0,
                                kBlocksTake,
                                0});
                pass.barrier(Use::compute, Use::compute | Use::transfer);
            }
        }
    Result<uint64_t> submitted = commands->submit();
    return submitted ? Status(Done{}) : submitted.failure();
}

Status Painter::replace(PaintJob& job, std::span<const float> texels) {
    Result<Commands> commands = Commands::begin(device_, "paint replace");
    if (!commands) return commands.failure();
    Result<std::vector<uint64_t>> placed = begin(*commands, {&job, 1});
    if (!placed) return placed.failure();
    commands->barrier(Use::compute, Use::transfer);
    Status uploaded = commands->upload(*job.canvas.layer, std::as_bytes(texels));
    if (!uploaded) return uploaded;
    Result<uint64_t> submitted = commands->submit();
    return submitted ? Status(Done{}) : submitted.failure();
}

Status Painter::swap(const Canvas& canvas, BlockRecord& record) {
    if (record.blocks_.empty()) return Done{};
    Result<Commands> commands = Commands::begin(device_, "paint swap");
    if (!commands) return commands.failure();
    Status uploaded = upload(*commands, record.blocks_);
    if (!uploaded) return uploaded;
    commands->barrier(Use::transfer, Use::compute);
    {
        Pass pass(*commands, "paint swap");
        move(pass, {wordsOf(*canvas.layer),
                    wordsOf(record.texels_),
                    wordsOf(words_),
                    {},
                    uint32_t(record.blocks_.size()),
                    0,
                    kBlocksSwap,
                    0});
    }
    Result<uint64_t> submitted = commands->submit();
    return submitted ? Status(Done{}) : submitted.failure();
}

Status Painter::close(const Canvas& canvas, BlockRecord& record) {
    record.known_ = {};
    if (record.blocks_.empty()) return Done{};
    const uint32_t count = uint32_t(record.blocks_.size());
    Result<Buffer> marks = Buffer::create(device_, "stroke changes", count * 4);
    if (!marks) return marks.failure();
    Result<Commands> commands = Commands::begin(device_, "paint compare");
    if (!commands) return commands.failure();
    Status uploaded = upload(*commands, record.blocks_);
    if (!uploaded) return uploaded;
    commands->fill(*marks, 0);
    commands->barrier(Use::transfer, Use::compute);
    {
        Pass pass(*commands, "paint compare");
        move(pass, {wordsOf(*canvas.layer), wordsOf(record.texels_), wordsOf(words_), wordsOf(*marks), count, 0,
                    kBlocksCompare, 0});
    }
    Status compared = commands->finish();
    if (!compared) return compared;
    Result<std::vector<uint32_t>> changed = readVector<uint32_t>(device_, *marks, 0, count);
    if (!changed) return changed.failure();

    std::vector<uint32_t> blocks, from;
    for (uint32_t i = 0; i < count; ++i)
        if ((*changed)[i]) {
            blocks.push_back(record.blocks_[i]);
            from.push_back(i);
        }
    if (blocks.empty()) {
        record = {};
        return Done{};
    }
    Result<Buffer> packed = Buffer::create(device_, "stroke record", blocks.size() * kBlockBytes);
    Result<Commands> packing = Commands::begin(device_, "paint pack");
    if (!packed || !packing) return (packed ? packing.failure() : packed.failure());
    uploaded = upload(*packing, from);
    if (!uploaded) return uploaded;
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
    return Done{};
}

}  // namespace espalier
