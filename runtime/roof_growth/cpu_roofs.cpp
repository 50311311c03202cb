// Expansion of roofs on the CPU (Buron 2013 §3), wave by wave as on the GPU: reference, debugger and what the GPU is
// measured against. And how room for both is found.
#include <algorithm>

#include "runtime/machine/waves.hpp"
#include "runtime/roof_growth/roof_data.hpp"
#include "runtime/roof_growth/roof_stages.hpp"
#include "runtime/run/host_runner.hpp"
#include "shaders/shared/roof_tables.h"

namespace espalier {

std::vector<float> RoofInputs::filledMeans(size_t houses) const {
    std::vector<float> all;
    all.reserve(houses * kRoofLayers);
    for (size_t h = 0; h < houses; ++h) {
        const Means values = meansOf(h);
        all.insert(all.end(), values.begin(), values.end());
    }
    return all;
}

RoofInputs::Means RoofInputs::meansOf(size_t house) const {
    Means values;
    for (uint32_t i = 0; i < kRoofLayers; ++i) {
        const size_t at = house * kRoofLayers + i;
        values[i] = at < means.size() ? means[at] : fill(i);
    }
    return values;
}

namespace {

constexpr uint32_t kMostScopes = 65'535 * kRoofGroup;  // what one dispatch goes through
// Of grammars whose rules lead on beyond the limit on depth: what a chain for each start takes, and some more. Two
// chains that part again and again take twice as much with every rule.
constexpr uint32_t kEndlessScopes = 1u << 14, kEndlessOfStart = 128;

}  // namespace

Failure tooManyShapes() {
    return Failure("roofs", "the grammar makes more shapes of these houses than memory holds");
}

Result<bool> RoofRoom::hold(const RoofStatus& status, uint32_t widestWave, uint32_t starts) {
    bool good = true;
    auto fit = [&](uint32_t& room, uint32_t wanted) {
        if (wanted <= room) return;
        room = uint32_t(std::min<uint64_t>(wanted + wanted / 4ull, UINT32_MAX));
        good = false;
    };
    const bool endless = status.deep > 0;
    const uint32_t most =
        endless ? std::min(std::max(kEndlessScopes, starts * kEndlessOfStart), kMostScopes) : kMostScopes;
    if (widestWave > most && endless)
        return Failure("roofs", "a rule leads to itself without end: more than " + std::to_string(kMaxRoofDepth) +
                                    " follow each other, and their shapes are too many");
    if (widestWave > most) return tooManyShapes();
    // What follows an endless grammar's wave without room isn't known.
    fit(scopes, endless && widestWave > scopes ? most : widestWave);
    scopes = std::min(scopes, kMostScopes);
    fit(grids, status.grids);
    fit(rows, status.rows);
    fit(regions, status.regions);
    fit(parts, status.parts);
    fit(planes, status.planes);
    return good;
}

namespace {

struct CpuRun {
    explicit CpuRun(const RoofInputs& inputs) : in(inputs), map(inputs.grammar->ref()) {}
    const RoofInputs& in;
    RuleMapRef map;
    std::vector<RoofScope> scopes[2];
    std::vector<uint32_t> starts;  // atoms of the first wave
    std::vector<Wave> waves;
    std::vector<float> means;
    RoofLayer layers[kRoofLayers] = {};
    CpuRoofs out;

    RoofEnv prepare(const RoofRoom& room) {
        const RoofTables& t = *in.town;
        out.records.regions = t.regions;
        out.records.parts = t.parts;
        out.records.planes = t.planes;
        out.records.regions.resize(t.regions.size() + room.regions);
        out.records.parts.resize(t.parts.size() + room.parts);
        out.records.planes.resize(t.planes.size() + room.planes);
        out.records.grids.resize(room.grids);
        out.records.runs.resize(room.rows);
        scopes[0].resize(room.scopes);
        scopes[1].resize(room.scopes);
        out.records.plots = t.plots;
        waves = wavesBefore(kRoofWaves, uint32_t(starts.size()), 0);
        out.status = {};
        out.status.regions = uint32_t(t.regions.size());
        out.status.parts = uint32_t(t.parts.size());
        out.status.planes = uint32_t(t.planes.size());
        RoofEnv env{};
        env.map.v = &map;
        env.atoms.v = const_cast<RoofAtom*>(t.atoms.data());
        env.pieces.v = const_cast<RoofPiece*>(t.pieces.data());
        env.regions.v = out.records.regions.data();
        env.parts.v = out.records.parts.data();
        env.planes.v = out.records.planes.data();
        for (int i : {0, 1}) env.queues[i].v = scopes[i].data();
        env.grids.v = out.records.grids.data();
        env.runs.v = out.records.runs.data();
        env.meshes.v = const_cast<RoofMesh*>(in.meshes.data());
        env.status.v = &out.status;
        env.waves.v = waves.data();
        env.plots.v = out.records.plots.data();
        for (uint32_t i = 0; i < kRoofLayers; ++i)
            layers[i] = {{const_cast<float*>(in.layers[i].texels)}, in.fill(i), 0};
        means = in.filledMeans(t.houses.size());
        out.reads.assign(t.houses.size(), 0);
        env.layers.v = layers;
        env.means.v = means.data();
        env.reads.v = out.reads.data();
        env.site = in.site;
        env.starts.v = starts.data();
        env.startSymbol = in.grammar->startSymbol();
        env.shapeRoom = room.scopes;
        env.gridRoom = room.grids;
        env.rowRoom = room.rows;
        env.regionRoom = uint32_t(out.records.regions.size());
        env.partRoom = uint32_t(out.records.parts.size());
        env.planeRoom = uint32_t(out.records.planes.size());
        return env;
    }
    // The widest wave.
    uint32_t derive(const RoofEnv& env, unsigned threads) {
        StageList stages = roofStages({}, env, 0, kRoofWaves - 1);
        HostRunner(threads, true).run(stages);
        const std::span<const Wave> run = std::span(waves).first(kRoofWaves - 1);
        out.waves = wavesOf(run);
        return widestOf(run);
    }
};

}  // namespace

CpuRoofs growRoofsOnCpu(const RoofInputs& inputs, unsigned threads) {
    CpuRun run(inputs);
    for (uint32_t h = 0; h < inputs.town->houses.size(); ++h) appendStarts(*inputs.town, h, run.starts);
    const uint32_t count = uint32_t(run.starts.size()), some = std::min(count * 4 + 16, 1024u);
    RoofRoom room{count * 4 + 16, count * 8 + 16, count * 64 + 64, some, some, 3 * some};
    run.out.complete = tooManyShapes();
    for (int attempt = 0; attempt < 12; ++attempt) {
        RoofEnv env = run.prepare(room);
        const uint32_t widest = run.derive(env, threads);
        RoofStatus made = run.out.status;
        made.regions -= uint32_t(inputs.town->regions.size());
        made.parts -= uint32_t(inputs.town->parts.size());
        made.planes -= uint32_t(inputs.town->planes.size());
        Result<bool> held = room.hold(made, widest, count);
        if (!held || *held) {
            run.out.complete = held ? Status(Done{}) : Status(held.failure());
            break;
        }
    }
    auto trim = [](auto& records, uint32_t made) { records.resize(std::min<size_t>(made, records.size())); };
    RoofRecords& made = run.out.records;
    trim(made.grids, run.out.status.grids);
    trim(made.runs, run.out.status.rows);
    trim(made.regions, run.out.status.regions);
    trim(made.parts, run.out.status.parts);
    trim(made.planes, run.out.status.planes);
    return std::move(run.out);
}

}  // namespace espalier
