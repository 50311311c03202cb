// A few houses grown anew on the CPU. In: houses of a town whose other roofs stand. Out: their records, sent behind
// those of the published set. Submitting waves and waiting for them takes a device longer than such houses take the
// CPU, which runs the kernels' own text, so that records are the same to the bit. Nothing waits: the GPU is sent the
// records in the order of its queue, behind what still draws the old ones.
#include <chrono>

#include "runtime/roof/gpu_roofs.hpp"

namespace espalier {
namespace {

// Houses of a town as a town of their own.
struct FewHouses {
    RoofTables tables;
    std::vector<uint32_t> houses, atoms, regions;  // [of ours]: the town's numbers

    explicit FewHouses(const RoofTables& town, std::span<const uint32_t> which) : houses(which.begin(), which.end()) {
        for (uint32_t house : houses) {
            const RoofTables::House& range = town.houses[house];
            const uint32_t first = uint32_t(tables.atoms.size());
            tables.houses.push_back({first, range.atomCount});
            for (uint32_t i = 0; i < range.atomCount; ++i) {
                atoms.push_back(range.firstAtom + i);
                addAtom(town, town.atoms[range.firstAtom + i], first - range.firstAtom);
            }
        }
        // Kernels read a region in any case.
        if (tables.regions.empty()) tables.regions.push_back({}), regions.push_back(0);
    }

  private:
    // shift: from the town's numbers of atoms to ours, modulo 2^32.
    void addAtom(const RoofTables& town, RoofAtom atom, uint32_t shift) {
        const auto pieces = std::span(town.pieces).subspan(atom.firstPiece, atom.pieceCount);
        atom.firstPiece = uint32_t(tables.pieces.size());
        atom.house = uint32_t(tables.houses.size() - 1);
        for (RoofPiece piece : pieces) {
            if (piece.upper != kNoIndex) piece.upper += shift;
            tables.pieces.push_back(piece);
        }
        if (atom.region != kNoIndex) atom.region = addRegion(town, atom.region);
        tables.atoms.push_back(atom);
    }
    uint32_t addRegion(const RoofTables& town, uint32_t number) {
        RoofRegion region = town.regions[number];
        const auto parts = std::span(town.parts).subspan(region.firstPart, region.partCount);
        region.firstPart = uint32_t(tables.parts.size());
        for (RoofPart part : parts) {
            const auto planes = std::span(town.planes).subspan(part.firstPlane, part.counts & 255u);
            part.firstPlane = uint32_t(tables.planes.size());
            tables.planes.insert(tables.planes.end(), planes.begin(), planes.end());
            tables.parts.push_back(part);
        }
        regions.push_back(number);
        tables.regions.push_back(region);
        return uint32_t(tables.regions.size() - 1);
    }
};

// Records numbered as those behind `last`, and only what was made.
void renumber(RoofRecords& made, const FewHouses& few, const RoofStatus& last, std::span<const uint32_t> generationOf) {
    const uint32_t ownRegions = uint32_t(few.tables.regions.size()), ownParts = uint32_t(few.tables.parts.size()),
                   ownPlanes = uint32_t(few.tables.planes.size());
    made.regions.erase(made.regions.begin(), made.regions.begin() + ownRegions);
    made.parts.erase(made.parts.begin(), made.parts.begin() + ownParts);
    made.planes.erase(made.planes.begin(), made.planes.begin() + ownPlanes);
    for (RoofRegion& r : made.regions) r.firstPart += last.parts - ownParts;
    for (RoofPart& p : made.parts) p.firstPlane += last.planes - ownPlanes;
    for (RoofGrid& g : made.grids) {
        const uint32_t house = few.houses[g.house & 0xFFFFFFu];
        g.house = house | generationOf[house] << 24;
        g.atom = few.atoms[g.atom];
        if (g.region != kNoIndex)
            g.region = g.region < ownRegions ? few.regions[g.region] : g.region + last.regions - ownRegions;
        if (g.firstRow != kNoIndex) g.firstRow += last.rows;
    }
}

}  // namespace

Result<GpuRoofs::Outcome> GpuRoofs::growFew(const RoofInputs& inputs, std::span<const uint32_t> houses) {
    const auto begin = std::chrono::steady_clock::now();
    const FewHouses few(*inputs.town, houses);
    std::vector<float> means;
    for (uint32_t house : houses)
        for (float mean : inputs.meansOf(house)) means.push_back(mean);
    RoofInputs ours = inputs;
    ours.town = &few.tables;
    ours.means = means;
    CpuRoofs made = growRoofsOnCpu(ours);
    renumber(made.records, few, last_, generationOf_);
    for (size_t i = 0; i < houses.size(); ++i) reads_[houses[i]] = made.reads[i];

    Outcome outcome;
    RoofStatus& s = outcome.status = last_;
    s.grids += uint32_t(made.records.grids.size());
    s.rows += uint32_t(made.records.runs.size());
    s.regions += uint32_t(made.records.regions.size());
    s.parts += uint32_t(made.records.parts.size());
    s.planes += uint32_t(made.records.planes.size());
    s.stopped += made.status.stopped;
    s.touched += made.status.touched;
    s.whole += made.status.whole;
    s.terminals += made.status.terminals;
    for (int i : {0, 1}) s.hash[i] += made.status.hash[i];
    outcome.waves = made.waves;
    outcome.complete = fits(s, sets_[front_]);
    if (!outcome.complete) return outcome;

    Set& set = sets_[front_];
    Result<Commands> commands = Commands::begin(device_, "few roofs");
    if (!commands) return commands.failure();
    commands->barrier(Use::compute | Use::vertex | Use::fragment, Use::transfer);
    const auto generations = std::as_bytes(std::span(generationOf_));
    Status steps[] = {uploadTables(*commands, *inputs.town, set),
                      uploadLayers(*commands, inputs),
                      commands->upload(set.grids, made.records.grids, last_.grids * sizeof(RoofGrid)),
                      commands->upload(set.runs, made.records.runs, last_.rows * sizeof(RoofRun)),
                      commands->upload(set.regions.buffer, made.records.regions, last_.regions * sizeof(RoofRegion)),
                      commands->upload(set.parts.buffer, made.records.parts, last_.parts * sizeof(RoofPart)),
                      commands->upload(set.planes.buffer, made.records.planes, last_.planes * sizeof(vec4))};
    for (Status& step : steps)
        if (!step) return step.failure();
    for (uint32_t house : houses)
        if (Status sent = commands->upload(generations_, generations.subspan(house * 4, 4), house * 4); !sent)
            return sent.failure();
    if (Result<uint64_t> sent = commands->submit(); !sent) return sent.failure();
    outcome.grids = std::move(made.records.grids);
    outcome.runs = std::move(made.records.runs);
    outcome.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return outcome;
}

}  // namespace espalier
