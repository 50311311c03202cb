// In: a town's tables, in which houses that were replaced leave their old atoms behind. Out: tables of some houses, or
// of all, that hold only what these use.
#include "runtime/roof_growth/house_tables.hpp"

#include <numeric>

namespace espalier {

HouseTables::HouseTables(const RoofTables& town, std::span<const uint32_t> which) : houses(which.begin(), which.end()) {
    for (uint32_t house : houses) {
        const RoofTables::House& range = town.houses[house];
        const uint32_t first = uint32_t(tables.atoms.size());
        tables.houses.push_back({first, range.atomCount, range.hidden});
        tables.plots.push_back(town.plots[house]);
        for (uint32_t i = 0; i < range.atomCount; ++i) {
            atoms.push_back(range.firstAtom + i);
            addAtom(town, town.atoms[range.firstAtom + i], first - range.firstAtom);
        }
    }
}

// shift: from the town's numbers of atoms to ours, modulo 2^32.
void HouseTables::addAtom(const RoofTables& town, RoofAtom atom, uint32_t shift) {
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

uint32_t HouseTables::addRegion(const RoofTables& town, uint32_t number) {
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

uint32_t usedAtoms(const RoofTables& town) {
    uint32_t used = 0;
    for (const RoofTables::House& house : town.houses) used += house.atomCount;
    return used;
}

bool mostlyUnused(const RoofTables& town) {
    constexpr size_t kLittle = 512;  // atoms: some 70 KiB with what belongs to them
    return town.atoms.size() > 2 * size_t(usedAtoms(town)) + kLittle;
}

RoofTables withoutUnused(const RoofTables& town) {
    std::vector<uint32_t> all(town.houses.size());
    std::iota(all.begin(), all.end(), 0u);
    return HouseTables(town, all).tables;
}

}  // namespace espalier
