// Blocks' counts become places in their buckets: the kernels that do so against sums on the CPU.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <string_view>
#include <utility>

#include "shaders/emit/batches.h"
#include "tests/emit/pipeline.hpp"

using namespace espalier;

namespace {

void scanned(const EmitTable& table, std::vector<uint32_t>& rows, EmitState& state) {
    uint32_t start = 0;
    for (uint32_t b = 0; b < kMaxBuckets; ++b) {
        const bool bark = b < table.barkBuckets;
        const uint32_t first = bark ? 0 : state.blocks[0];
        const uint32_t blocks = b < table.bucketCount ? state.blocks[bark ? 0 : 1] : 0;
        uint32_t count = 0;
        for (uint32_t block = first; block < first + blocks; ++block)
            count += std::exchange(rows[block * kMaxBuckets + b], count);
        state.counts[b] = count;
        state.starts[b] = start;
        start += count;
        (bark ? state.spanCount : state.leafCount) += count;
        state.drawnTriangles += count * (table.buckets[b].indexCount / 3);
        drawBatches(table.buckets[b], count, state.draws[2 * b], state.draws[2 * b + 1]);
    }
}

}  // namespace

TEST_CASE("blocks' counts become the same places whether one lane or many go through a bucket's") {
    test::EmitPipeline gpu;
    Device& device = *gpu.device;
    const VkPhysicalDeviceLimits& limits = device.info().limits;
    const bool wide = std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]) >= 1024;
    const EmitTable& table = gpu.terminals.kernelTable();
    REQUIRE(table.barkBuckets > 0);
    REQUIRE(table.bucketCount > table.barkBuckets);
    const Buffer view = std::move(*makeBuffer(device, "view", std::vector<EmitView>(1)));
    std::mt19937 random(5);
    for (const std::string_view shader : {"emit/scan.comp", "emit/scan_wide.comp"}) {
        if (shader == "emit/scan_wide.comp" && !wide) continue;
        CAPTURE(shader);
        Result<Program> program = Program::compute(device, shader);
        REQUIRE(program);
        for (const uint32_t spans : {0u, 1u, 15u, 16u, 17u, 1000u})
            for (const uint32_t leaves : {0u, 1u, 63u, 64u, 65u}) {
                CAPTURE(spans);
                CAPTURE(leaves);
                EmitState state{};
                state.blocks[0] = spans;
                state.blocks[1] = leaves;
                std::vector<uint32_t> rows((spans + leaves + 1) * kMaxBuckets);
                for (uint32_t& count : rows) count = uint32_t(random() % (kBlockItems + 1));
                const Buffer states = std::move(*makeBuffer(device, "state", std::vector{state})),
                             counts = std::move(*makeBuffer(device, "rows", rows));
                EmitPush push{};
                push.state = addressOf<EmitStateBuf>(states);
                push.rows = addressOf<UintBuf>(counts);
                Result<Commands> commands = Commands::begin(device, "scan");
                REQUIRE(commands);
                Pass(*commands, "scan").dispatch(*program, {1, 1, 1}, push, {gpu.terminals.tableBuffer(), view});
                REQUIRE(commands->finish());
                scanned(table, rows, state);
                CHECK(*readVector<uint32_t>(device, counts, 0, rows.size()) == rows);
                const EmitState found = readVector<EmitState>(device, states, 0, 1)->at(0);
                CHECK(std::memcmp(&found, &state, sizeof state) == 0);
            }
    }
}
