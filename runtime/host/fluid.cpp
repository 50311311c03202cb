// In: a fluid's particles. Out: their order by cells, densities, and where they are a step later. Loops over lanes work
// out neighbours in a row of cells side by side, and look at the cells about all of them.
#include <algorithm>
#include <cstring>
#include <numeric>

#include "runtime/host/kernels.hpp"
#include "runtime/host/node_lanes.hpp"
#include "shaders/shared/node_fluid.h"

namespace espalier {
namespace {

constexpr size_t kParticlesAtOnce = 1024, kRowsAtOnce = 4;

void eachOf(uint32_t count, const HostRun& run, const auto& one) {
    run.crew.overRange(count, kParticlesAtOnce, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) one(uint32_t(i));
    });
}

void startAll(FluidStart a, const HostRun& run) {
    eachOf(a.count, run, [&](uint32_t i) { startFluid(a, i); });
}

void clearCells(FluidArgs a, const HostRun&) {
    std::fill_n(a.words.v, fluidCells(a), 0u);
}

// By their numbers, so that they come to their cells in order.
void countCells(FluidArgs a, const HostRun&) {
    for (uint32_t i = 0; i < a.count; ++i) {
        const uint32_t cell = fluidCell(a, i);
        a.words.v[cellWord(a) + i] = cell;
        a.words.v[turnWord(a) + i] = a.words.v[cell]++;
    }
}

void startCells(FluidArgs a, const HostRun&) {
    const uint32_t* counts = a.words.v;
    std::exclusive_scan(counts, counts + fluidCells(a), a.words.v + startWord(a), 0u);
}

void placeAll(FluidArgs a, const HostRun& run) {
    eachOf(a.count, run, [&](uint32_t i) { placeFluid(a, i); });
}

void orderAll(FluidArgs a, const HostRun& run) {
    eachOf(a.count, run, [&](uint32_t place) {
        run.plain ? orderFluid(a, place) : sortInto(a, a.words.v[cameWord(a) + place], place);
    });
}

// Particles that stand side by side in the order.
struct alignas(64) FluidLanes {
    NodeLanes at, velocity, push, drag;
    float density[kNodeLanes], pushes[kNodeLanes], rooms[kNodeLanes];
};

// What neighbours at these places add to the densities.
ESPALIER_LANES void densityLanes(const FluidArgs& given, glm::uvec2 places, FluidLanes& l) {
    const FluidArgs a = given;
    const NodeLanes at = l.at;
    float sum[kNodeLanes];
    std::memcpy(sum, l.density, sizeof sum);
    for (uint32_t j = places.x; j < places.y; ++j) {
        const vec3 other = takeVector(a.sorted, j);
        for (uint32_t i = 0; i < kNodeLanes; ++i) sum[i] += densityBy((vectorOf(at, i) - other) * a.perRadius);
    }
    std::memcpy(l.density, sum, sizeof sum);
}
// Likewise to the forces.
ESPALIER_LANES void forceLanes(const FluidArgs& given, glm::uvec2 places, FluidLanes& l) {
    const FluidArgs a = given;
    const NodeLanes at = l.at, velocity = l.velocity;
    NodeLanes push = l.push, drag = l.drag;
    float pushes[kNodeLanes];
    std::memcpy(pushes, l.pushes, sizeof pushes);
    for (uint32_t j = places.x; j < places.y; ++j) {
        const vec3 other = takeVector(a.sorted, j), moving = velocityOf(a.sorted, j);
        const float room = planeOf(a.sorted, kSortedRoom).v[j], pushing = planeOf(a.sorted, kSortedPush).v[j];
        for (uint32_t i = 0; i < kNodeLanes; ++i) {
            FluidForce f = {vectorOf(push, i), vectorOf(drag, i)};
            addForce(f, (vectorOf(at, i) - other) * a.perRadius, moving - vectorOf(velocity, i), pushes[i] + pushing,
                     room);
            put(push, i, f.push);
            put(drag, i, f.drag);
        }
    }
    l.push = push;
    l.drag = drag;
}
ESPALIER_LANES void moveLanes(const FluidArgs& given, FluidLanes& l) {
    const FluidArgs a = given;
    for (uint32_t i = 0; i < kNodeLanes; ++i) {
        const FluidMove m = movedBy(a, vectorOf(l.at, i), vectorOf(l.velocity, i), l.pushes[i], l.rooms[i],
                                    {vectorOf(l.push, i), vectorOf(l.drag, i)});
        put(l.at, i, m.at);
        put(l.velocity, i, m.velocity);
    }
}

// Calls block(first, end, cells) for up to as many particles as there are lanes, all of one row of cells; plain:
// one(place) for every particle.
void overRows(const FluidArgs& a, const HostRun& run, const auto& block, const auto& one) {
    run.crew.overRange(size_t(a.cells[1]) * a.cells[2], kRowsAtOnce, [&](size_t begin, size_t end) {
        for (uint32_t row = uint32_t(begin); row < end; ++row) {
            const uint32_t y = row % a.cells[1], z = row / a.cells[1];
            const uvec2 all = placesOf(a, 0, a.cells[0] - 1, y, z);
            for (uint32_t first = all.x; first < all.y; first += kNodeLanes) {
                const uint32_t last = std::min(first + kNodeLanes, all.y) - 1;
                if (run.plain)
                    for (uint32_t place = first; place <= last; ++place) one(place);
                else
                    block(first, last + 1,
                          cellsAbout(a, cellAlong(a, takeVector(a.sorted, first), 0),
                                     cellAlong(a, takeVector(a.sorted, last), 0), y, z));
            }
        }
    });
}
void overNeighbours(const FluidArgs& a, const CellRange& c, FluidLanes& l,
                    void (*add)(const FluidArgs&, glm::uvec2, FluidLanes&)) {
    for (uint32_t z = c.z0; z <= c.z1; ++z)
        for (uint32_t y = c.y0; y <= c.y1; ++y) add(a, placesOf(a, c.x0, c.x1, y, z), l);
}

void findDensities(FluidArgs a, const HostRun& run) {
    overRows(
        a, run,
        [&](uint32_t first, uint32_t end, const CellRange& cells) {
            FluidLanes l{};
            load(l.at, a.sorted, first);
            overNeighbours(a, cells, l, densityLanes);
            for (uint32_t place = first; place < end; ++place) putDensity(a, place, l.density[place - first]);
        },
        [&](uint32_t place) { findDensity(a, place); });
}

void moveAll(FluidArgs a, const HostRun& run) {
    overRows(
        a, run,
        [&](uint32_t first, uint32_t end, const CellRange& cells) {
            FluidLanes l{};
            load(l.at, a.sorted, first);
            load(l.velocity, a.sorted, first, kFluidVelocity);
            std::memcpy(l.pushes, planeOf(a.sorted, kSortedPush).v + first, sizeof l.pushes);
            std::memcpy(l.rooms, planeOf(a.sorted, kSortedRoom).v + first, sizeof l.rooms);
            overNeighbours(a, cells, l, forceLanes);
            moveLanes(a, l);
            for (uint32_t place = first, lane = 0; place < end; ++place, ++lane)
                putMoved(a, place, {vectorOf(l.at, lane), vectorOf(l.velocity, lane)});
        },
        [&](uint32_t place) { moveFluid(a, place); });
}

void findHeadings(FluidArgs a, const HostRun& run) {
    eachOf(a.count, run, [&](uint32_t i) { findHeading(a, i); });
}

constexpr HostRow kSteps[] = {
    {"nodes/fluid_start.comp", passOf<FluidStart, startAll>},
    {"nodes/fluid_clear.comp", passOf<FluidArgs, clearCells>},
    {"nodes/fluid_count.comp", passOf<FluidArgs, countCells>},
    {"nodes/fluid_rows.comp", passOf<FluidArgs, startCells>},
    {"nodes/fluid_place.comp", passOf<FluidArgs, placeAll>},
    {"nodes/fluid_order.comp", passOf<FluidArgs, orderAll>},
    {"nodes/fluid_density.comp", passOf<FluidArgs, findDensities>},
    {"nodes/fluid_move.comp", passOf<FluidArgs, moveAll>},
    {"nodes/fluid_heading.comp", passOf<FluidArgs, findHeadings>},
};

}  // namespace

const std::span<const HostRow> kFluidRows = kSteps;

}  // namespace espalier
