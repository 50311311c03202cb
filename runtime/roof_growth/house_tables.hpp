#pragma once

#include <span>
#include <vector>

#include "runtime/roof_growth/atoms.hpp"

namespace espalier {

// Houses of a town as a town of their own, which holds nothing but what is theirs.
struct HouseTables {
    RoofTables tables;
    std::vector<uint32_t> houses, atoms, regions;  // [of ours]: the town's numbers

    // which: the town's numbers of houses, each once; ours follow each other in that order.
    HouseTables(const RoofTables& town, std::span<const uint32_t> which);

  private:
    void addAtom(const RoofTables& town, RoofAtom atom, uint32_t shift);
    uint32_t addRegion(const RoofTables& town, uint32_t number);
};

// Atoms that houses use.
uint32_t usedAtoms(const RoofTables& town);
// Whether more atoms are left unused by replaceAtoms() than a town of its size is worth taking apart for.
bool mostlyUnused(const RoofTables& town);
// The same houses under the same numbers, without what is left unused. All else has other numbers then.
RoofTables withoutUnused(const RoofTables& town);

}  // namespace espalier
