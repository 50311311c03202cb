// The culling kernels by themselves, with more groups than there is work for.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/emit/pipeline.hpp"

using namespace espalier;

namespace {

constexpr uint32_t kBlocks = 3, kGroups = 6, kUntouched = 0xA5A5A5A5u;

Buffer filled(Device& device, size_t words, uint32_t value) {
    Result<Buffer> made = makeBuffer(device, "filled", std::vector<uint32_t>(words, value));
    REQUIRE(made);
    return std::move(*made);
}

// How many words of blocks beyond the last one a kernel has written that was dispatched over kGroups groups.
// lanes: that rank a block's items.
size_t wordsBeyond(test::EmitPipeline& gpu, const char* shader, bool leaves, uint32_t lanes) {
    Device& device = *gpu.device;
    Result<Program> program = Program::compute(device, shader, {.constants = {{kConstantLanes, lanes}}});
    REQUIRE(program);
    EmitState given{};
    given.listed[leaves] = kBlocks * kBlockItems - 7;
    given.blocks[leaves] = kBlocks;
    EmitView full{};
    full.flags = kFullDetail;
    Result<Buffer> state = makeBuffer(device, "state", std::vector{given}),
                   view = makeBuffer(device, "view", std::vector{full});
    REQUIRE((state && view));
    const Buffer list = filled(device, kGroups * kBlockItems, 0);  // one instance, over and over
    const Buffer rows = filled(device, kGroups * kMaxBuckets, kUntouched);
    const Buffer notes = filled(device, kGroups * kBlockItems * sizeof(DrawnItem) / 4, kUntouched);
    const Buffer instance = filled(device, sizeof(SpanInstance) / 4, 0);
    Result<TexelView> texels = TexelView::create(device, instance, VK_FORMAT_R32G32B32A32_UINT);
    REQUIRE(texels);

    EmitPush push{};
    push.state = addressOf<EmitStateBuf>(*state);
    push.list = addressOf<UintBuf>(list);
    push.rows = addressOf<UintBuf>(rows);
    push.notes = addressOf<DrawnBuf>(notes);
    Result<Commands> commands = Commands::begin(device, "overhang");
    REQUIRE(commands);
    // As list_blocks.comp spreads them.
    Pass(*commands, "overhang")
        .dispatch(*program, {kGroups / 2, 2, 1}, push, {gpu.terminals.tableBuffer(), *view, *texels});
    REQUIRE(commands->finish());

    const auto written = [&](const Buffer& buffer, size_t from) {
        const auto words = *readVector<uint32_t>(device, buffer, 0, buffer.size() / 4);
        CHECK(words[0] != kUntouched);
        return size_t(
            std::count_if(words.begin() + long(from), words.end(), [](uint32_t w) { return w != kUntouched; }));
    };
    return written(rows, kBlocks * kMaxBuckets) + written(notes, kBlocks * kBlockItems * sizeof(DrawnItem) / 4);
}

}  // namespace

TEST_CASE("groups that overhang the blocks of a large view write nothing") {
    test::EmitPipeline gpu;
    for (const uint32_t lanes : {1u, 64u}) {
        CHECK(wordsBeyond(gpu, "emit/classify_spans.comp", false, lanes) == 0);
        CHECK(wordsBeyond(gpu, "emit/classify_leaves.comp", true, lanes) == 0);
    }
}
