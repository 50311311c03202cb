// A fluid, which each step follows from the one before. What is given depends on the inputs alone: whichever frames
// were shown before, steps are gone through from the last one that is kept.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "runtime/core/hash.hpp"
#include "runtime/nodes/node_work.hpp"
#include "shaders/shared/node_fluid.h"

namespace espalier {
namespace {

constexpr float kFar = 1e6f;  // metres
constexpr double kMostParticles = 200000;
constexpr double kMostAlong = 1000, kMostCells = 2e6;  // cells: in one direction, and in all
// What a fluid is followed for: its steps, each of which costs as much as so many particles. Half a minute on one core.
constexpr double kMostWork = 6e7;
constexpr uint32_t kKeptEvery = 64;  // steps: by the limit above all that is kept takes 23 MB at most
constexpr double kMostSubsteps = 1000;
constexpr float kFinest = 1e-5f;   // radii of a place's distance from the origin: 80 steps from float to float
constexpr float kMostPressed = 2;  // by its own weight, a column as high as the box: e^2 times as dense at its foot

double stepCost(const FluidArgs& args) {
    return args.count + fluidCells(args) / 32.0 + 1000;
}

// What a fluid follows from. Addresses are still missing.
struct FluidPlan {
    FluidArgs args{};
    FluidStart start{};
    uint32_t step = 0;  // that is wanted
    uint64_t key() const {
        return NodeWork::key(
            {hashBytes(std::as_bytes(std::span(&args, 1))), hashBytes(std::as_bytes(std::span(&start, 1)))});
    }
};

struct FluidMemory : NodeMemory {
    uint64_t key = 0;
    uint32_t step = 0;                  // as the fluid's own planes are
    std::map<uint32_t, BlockRef> kept;  // places and velocities, by step
};

std::string numberOf(double whole) {
    return whole < 1e15 ? std::to_string(uint64_t(whole)) : numberText(float(whole));
}

Status planRoom(const NodeWork& work, FluidPlan& plan) {
    FluidArgs& args = plan.args;
    const float radius = work.number("radius"), apart = radius / 2;
    const glm::vec3 a = work.vector("low"), b = work.vector("high");
    const glm::vec3 middle = (a + b) * 0.5f, inset(apart / 2), farthest = glm::max(glm::abs(a), glm::abs(b));
    if (std::max({farthest.x, farthest.y, farthest.z}) * kFinest > radius)
        return Failure("", "places so far from the origin aren't fine enough for that radius");
    args.low = glm::min(glm::min(a, b) + inset, middle);
    args.high = glm::max(glm::max(a, b) - inset, middle);
    args.perRadius = 1 / radius;
    args.perCell = 0.999f / radius;
    double cells = 1;
    for (int i = 0; i < 3; ++i) {
        const double along = std::floor((double(args.high[i]) - args.low[i]) * args.perCell) + 1;
        cells *= along;
        if (along > kMostAlong || cells > kMostCells)
            return Failure("", "the box is too large for a fluid of that radius: it holds " +
                                   numberOf(std::floor(along)) + " radii in one direction, or " + numberOf(cells) +
                                   " cubes of them; there may be " + numberOf(kMostAlong) + " and " +
                                   numberOf(kMostCells));
        args.cells[i] = uint32_t(along);
    }
    return Done{};
}

Status planParticles(const NodeWork& work, FluidPlan& plan) {
    FluidStart& start = plan.start;
    const glm::vec3 low = glm::min(work.vector("low"), work.vector("high"));
    const glm::vec3 high = glm::max(work.vector("low"), work.vector("high"));
    const glm::vec3 from = glm::max(glm::min(work.vector("from"), work.vector("to")), low);
    const glm::vec3 to = glm::min(glm::max(work.vector("from"), work.vector("to")), high);
    start.apart = work.number("radius") / 2;
    double count = 1;
    for (int i = 0; i < 3; ++i) {
        if (to[i] < from[i]) return Failure("", "'from' and 'to' lie outside of the box, so there is no fluid");
        const double along = std::max(1.0, std::floor((double(to[i]) - from[i]) / start.apart + 1e-3));
        count *= along;
        start.counts[i] = uint32_t(std::min(along, 4e9));
    }
    if (count > kMostParticles)
        return Failure("", numberOf(count) + " particles are more than 200,000; take a larger radius, or less fluid");
    start.first = from + start.apart / 2;
    start.low = plan.args.low;
    start.high = plan.args.high;
    start.seed = work.whole("seed");
    start.count = plan.args.count = uint32_t(count);
    return Done{};
}

// How many steps a frame needs, so that neither sound nor what drags goes too far in one.
double neededSubsteps(const NodeWork& work) {
    const double radius = work.number("radius");
    const double sound = std::sqrt(work.number("stiffness")) / (0.5 * radius);
    const double drag = work.number("viscosity") / (0.1 * radius * radius);
    return std::ceil(work.number("step") * std::max(sound, drag));
}

Status planSteps(const NodeWork& work, FluidPlan& plan) {
    const float soft = glm::dot(glm::abs(work.vector("gravity")), plan.args.high - plan.args.low) / kMostPressed;
    if (work.number("stiffness") < soft)
        return Failure("", "would be crushed by its weight: with this gravity and box it needs a stiffness of " +
                               numberOf(std::ceil(soft)));
    const double substeps = work.whole("substeps"), needed = neededSubsteps(work);
    if (needed > kMostSubsteps)
        return Failure("", "is too stiff or viscous for its radius: it needs " + numberOf(needed) + " substeps");
    if (substeps < needed)
        return Failure("", "would shake itself apart: with this radius, stiffness and viscosity it needs " +
                               numberOf(needed) + " substeps");
    const double frame = std::floor(work.number("time"));
    const double frames = std::floor(kMostWork / (stepCost(plan.args) * substeps));
    if (frame > frames)
        return Failure("", "frame " + numberOf(frame) + " lies beyond frame " + numberOf(frames) + ", to which " +
                               std::to_string(plan.args.count) + " particles with so many substeps are followed");
    FluidArgs& args = plan.args;
    args.step = float(work.number("step") / substeps);
    args.gravity = work.vector("gravity");
    args.stiffness = work.number("stiffness");
    args.viscosity = work.number("viscosity");
    args.bounce = work.number("bounce");
    args.fastest = 0.5f * work.number("radius") / args.step;
    plan.step = uint32_t(frame * substeps);
    return Done{};
}

class FluidRun {
  public:
    FluidRun(NodeWork& work, const FluidPlan& plan) : work_(work), plan_(plan), args_(plan.args) {}

    Status to(uint32_t step, GeometryPart& part) {
        if (Status made = makeRoom(part); !made) return made;
        goBack(step);
        while (memory_->step < step)
            if (Status gone = goOn(); !gone) return gone;
        over("nodes/fluid_heading.comp", args_.count);
        work_.keep(std::move(memory_));
        return Done{};
    }

  private:
    uint32_t stride() const { return nodeRow(plan_.args.count) + kNodeLanes; }  // lanes begin at any particle

    Status makeRoom(GeometryPart& part) {
        const uint64_t key = plan_.key(), plane = uint64_t(stride()) * sizeof(float);
        memory_ = work_.takeMemory<FluidMemory>();
        stands_ = memory_ && memory_->key == key;
        if (!stands_) {
            memory_ = std::make_unique<FluidMemory>();
            memory_->key = key;
        }
        Result<NodeWork::Room> own = work_.room("fluid", plane * kFluidPlanes, key);
        if (!own) return own.failure();
        Result<NodeWork::Room> sorted = work_.room("fluid by cells", plane * kSortedPlanes, key);
        if (!sorted) return sorted.failure();
        Result<NodeWork::Room> words =
            work_.room("fluid cells", (orderWord(args_) + uint64_t(args_.count)) * sizeof(uint32_t), key);
        if (!words) return words.failure();
        Result<NodeWork::Room> normals = work_.room("fluid headings", nodeRow(args_.count) * sizeof(uint32_t));
        if (!normals) return normals.failure();
        stands_ = stands_ && !own->fresh && !sorted->fresh && !words->fresh;
        args_.own = {own->block->as<FloatBuf>(), stride(), args_.count};
        args_.sorted = {sorted->block->as<FloatBuf>(), stride(), args_.count};
        args_.words = words->block->as<UintBuf>();
        args_.normals = normals->block->as<UintBuf>();
        part.positionBlock = own->block;
        part.normals = normals->block;
        part.positions = args_.own;
        part.elements = part.row = part.used = args_.count;
        return Done{};
    }

    // To the last step that is known and isn't beyond this one.
    void goBack(uint32_t step) {
        const auto behind = memory_->kept.upper_bound(step);
        const uint32_t known = behind == memory_->kept.begin() ? 0 : std::prev(behind)->first;
        if (stands_ && memory_->step <= step && memory_->step >= known) return;
        memory_->step = known;
        if (known > 0) {
            copy(planesOf(std::prev(behind)->second), args_.own);
        } else {
            FluidStart start = plan_.start;
            start.own = args_.own;
            work_.run("nodes/fluid_start.comp", start, start.count);
        }
        settle();
    }

    // Particles by cells, and their densities.
    void settle() {
        over("nodes/fluid_clear.comp", fluidCells(args_));
        over("nodes/fluid_count.comp", args_.count);
        over("nodes/fluid_rows.comp", args_.cells[1] * args_.cells[2]);
        over("nodes/fluid_place.comp", args_.count);
        over("nodes/fluid_order.comp", args_.count);
        over("nodes/fluid_density.comp", args_.count);
    }

    Status goOn() {
        over("nodes/fluid_move.comp", args_.count);
        settle();
        const uint32_t step = ++memory_->step;
        if (step % kKeptEvery != 0) return Done{};
        if (!memory_->kept.contains(step)) {
            Result<BlockRef> kept = work_.block("fluid kept", uint64_t(stride()) * kFluidDensity * sizeof(float));
            if (!kept) return kept.failure();
            copy(args_.own, planesOf(*kept));
            memory_->kept.emplace(step, std::move(*kept));
        }
        return work_.runNow();  // so that a list of all steps isn't longer than a device takes
    }

    NodePlanes planesOf(const BlockRef& block) const { return {block->as<FloatBuf>(), stride(), args_.count}; }
    // Places and velocities, by a program without steps.
    void copy(const NodePlanes& from, const NodePlanes& to) {
        for (const uint32_t first : {0u, kFluidVelocity}) {
            DeformArgs all{};
            all.from = {planeOf(from, first), from.stride, from.count};
            all.to = {planeOf(to, first), to.stride, to.count};
            all.each = nodeRow(from.count);
            work_.run("nodes/deform.comp", all, all.to.count);
        }
    }
    void over(const char* kernel, uint64_t items) { work_.run(kernel, args_, items); }

    NodeWork& work_;
    const FluidPlan& plan_;
    FluidArgs args_;
    std::unique_ptr<FluidMemory> memory_;
    bool stands_ = false;  // the fluid is as it was left at memory_->step
};

Status makeFluid(NodeWork& work) {
    FluidPlan plan;
    for (Status (*each)(const NodeWork&, FluidPlan&) : {planRoom, planParticles, planSteps})
        if (Status planned = each(work, plan); !planned) return planned;
    GeometryPart part;
    if (Status run = FluidRun(work, plan).to(plan.step, part); !run) return run;
    part.extent = glm::length(plan.args.high - plan.args.low);
    work.give(Geometry{part});
    return Done{};
}

}  // namespace

std::vector<NodeKind> fluidKinds() {
    return {
        {"Fluid",
         "Particles of a fluid that fills a part of a box at first and then flows. Each frame follows from the one "
         "before; going back or far ahead takes a moment. A particle's normal is where it is heading.",
         {vectorPort("low", glm::vec3(-1, 0, -0.5f), -kFar, kFar, "m", "the box's low corner"),
          vectorPort("high", glm::vec3(1, 1, 0.5f), -kFar, kFar, "m", "the box's high corner"),
          vectorPort("from", glm::vec3(-1, 0, -0.5f), -kFar, kFar, "m", "one corner of the fluid at first"),
          vectorPort("to", glm::vec3(-0.4f, 0.8f, 0.5f), -kFar, kFar, "m", "the other; it fills all in between"),
          numberPort("radius", 0.1f, 0.001f, 1000, "m", "how far particles feel each other; they lie half of it apart"),
          vectorPort("gravity", glm::vec3(0, -9.81f, 0), -1000, 1000, "m/s²", "what pulls"),
          numberPort("stiffness", 60, 0, 1e6f, "m²/s²", "the more, the less it can be pressed; needs more substeps"),
          numberPort("viscosity", 0.05f, 0, 1000, "m²/s", "water has little, honey much"),
          numberPort("bounce", 0.1f, 0, 1, "", "speed that a wall gives back"),
          numberPort("step", 0.03125f, 1e-4f, 1, "s", "what goes by in one step of time"),
          wholePort("substeps", 8, 1, float(kMostSubsteps),
                    "in one step of time: more of them keep a stiff fluid calm"),
          seedPort(), numberPort("time", 0, 0, 1e6f, "steps", "the steps that have gone by: wire it to time.frame")},
         {{"points", ValueType::points}},
         makeFluid,
         {"nodes/fluid_start.comp", "nodes/fluid_clear.comp", "nodes/fluid_count.comp", "nodes/fluid_rows.comp",
          "nodes/fluid_place.comp", "nodes/fluid_order.comp", "nodes/fluid_density.comp", "nodes/fluid_move.comp",
          "nodes/fluid_heading.comp"}},
    };
}

}  // namespace espalier
