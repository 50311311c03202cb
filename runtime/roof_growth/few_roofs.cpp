// A few houses grown anew on the CPU. In: houses of a town whose other roofs stand. Out: their records, sent behind
// those of the published set. Submitting waves and waiting for them takes a device longer than such houses take the
// CPU, which runs the kernels' own text, so that records are the same to the bit. Nothing waits: the GPU is sent the
// records in the order of its queue, behind what still draws the old ones.
#include <chrono>

#include "runtime/roof_growth/house_tables.hpp"
#include "runtime/roof_growth/roof_growth.hpp"

namespace espalier {
namespace {

// Records numbered as those behind `last`, and only what was made.
void renumber(RoofRecords& made, const HouseTables& few, const RoofStatus& last, std::span<const RoofPlot> plots) {
    const uint32_t ownRegions = uint32_t(few.tables.regions.size()), ownParts = uint32_t(few.tables.parts.size()),
                   ownPlanes = uint32_t(few.tables.planes.size());
    made.regions.erase(made.regions.begin(), made.regions.begin() + ownRegions);
    made.parts.erase(made.parts.begin(), made.parts.begin() + ownParts);
    made.planes.erase(made.planes.begin(), made.planes.begin() + ownPlanes);
    for (RoofRegion& r : made.regions) r.firstPart += last.parts - ownParts;
    for (RoofPart& p : made.parts) p.firstPlane += last.planes - ownPlanes;
    for (RoofGrid& g : made.grids) {
        const uint32_t house = few.houses[g.house & 0xFFFFFFu];
        g.house = house | plots[house].generation << 24;
        g.atom = few.atoms[g.atom];
        if (g.region != kNoIndex)
            g.region = g.region < ownRegions ? few.regions[g.region] : g.region + last.regions - ownRegions;
        if (g.firstRow != kNoIndex) g.firstRow += last.rows;
    }
}

}  // namespace

Result<RoofGrowth::Outcome> RoofGrowth::growFew(const RoofInputs& inputs, std::span<const uint32_t> houses) {
    const auto begin = std::chrono::steady_clock::now();
    HouseTables few(*inputs.town, houses);
    if (few.tables.regions.empty()) few.tables.regions.emplace_back(), few.regions.push_back(0);  // kernels read one
    std::vector<float> means;
    for (uint32_t house : houses)
        for (float mean : inputs.meansOf(house)) means.push_back(mean);
    RoofInputs ours = inputs;
    ours.town = &few.tables;
    ours.means = means;
    CpuRoofs made = growRoofsOnCpu(ours);
    if (!made.complete) return made.complete.failure();
    renumber(made.records, few, last_, plots_);
    for (size_t i = 0; i < houses.size(); ++i) reads_[houses[i]] = made.reads[i];

    Outcome outcome;
    RoofStatus& s = outcome.status = last_;
    s.grids += uint32_t(made.records.grids.size());
    s.rows += uint32_t(made.records.runs.size());
    s.regions += uint32_t(made.records.regions.size());
    s.parts += uint32_t(made.records.parts.size());
    s.planes += uint32_t(made.records.planes.size());
    s.stopped += made.status.stopped;
    s.deep += made.status.deep;
    s.touched += made.status.touched;
    s.whole += made.status.whole;
    s.terminals += made.status.terminals;
    for (int i : {0, 1}) s.hash[i] += made.status.hash[i];
    outcome.waves = made.waves;
    outcome.complete = fits(s, sets_.drawn());
    if (!outcome.complete) return outcome;

    Set& set = sets_.drawn();
    Result<Commands> commands = Commands::begin(device_, "few roofs");
    if (!commands) return commands.failure();
    commands->barrier(Use::compute | Use::vertex | Use::fragment, Use::transfer);
    if (Status sent =
            allDone({uploadTables(*commands, *inputs.town, set), uploadLayers(*commands, inputs, set),
                     commands->upload(set.grids, made.records.grids, last_.grids * sizeof(RoofGrid)),
                     commands->upload(set.runs, made.records.runs, last_.rows * sizeof(RoofRun)),
                     commands->upload(set.regions.buffer, made.records.regions, last_.regions * sizeof(RoofRegion)),
                     commands->upload(set.parts.buffer, made.records.parts, last_.parts * sizeof(RoofPart)),
                     commands->upload(set.planes.buffer, made.records.planes, last_.planes * sizeof(vec4))});
        !sent)
        return sent.failure();
    for (uint32_t house : houses)
        if (Status sent = uploadPlot(*commands, set, house); !sent) return sent.failure();
    if (Result<uint64_t> sent = commands->submit(); !sent) return sent.failure();
    outcome.grids = std::move(made.records.grids);
    outcome.runs = std::move(made.records.runs);
    outcome.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return outcome;
}

}  // namespace espalier
