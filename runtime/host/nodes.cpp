// In: what nodes of the graph are made from. Out: their planes. Loops over lanes call the kernels' own text, which has
// no branch there that a vector couldn't take. Rows are padded, so lanes beyond an element's count work for nobody.
#include <algorithm>
#include <cstring>
#include <mutex>
#include <vector>

#include "runtime/host/kernels.hpp"
#include "runtime/host/node_lanes.hpp"
#include "shaders/shared/node_bounds.h"
#include "shaders/shared/node_curves.h"
#include "shaders/shared/node_joints.h"
#include "shaders/shared/node_loft.h"
#include "shaders/shared/node_points.h"

namespace espalier {
namespace {

using Lanes = NodeLanes;
constexpr size_t kBlocksAtOnce = 64;  // of lanes

// Calls body(first) for each block of lanes; plain: every lane by itself.
template <class Block, class One>
void overLanes(uint32_t count, const HostRun& run, const Block& block, const One& one) {
    const size_t blocks = nodeRow(count) / kNodeLanes;
    run.crew.overRange(blocks, kBlocksAtOnce, [&](size_t begin, size_t end) {
        for (size_t b = begin; b < end; ++b) {
            const uint32_t first = uint32_t(b) * kNodeLanes;
            if (!run.plain) {
                block(first);
                continue;
            }
            for (uint32_t i = first; i < std::min(first + kNodeLanes, count); ++i) one(i);
        }
    });
}

ESPALIER_LANES void particleLanes(const ParticleArgs& given, uint32_t first, Lanes& l) {
    const ParticleArgs a = given;
    for (uint32_t i = 0; i < kNodeLanes; ++i) put(l, i, particleAt(a, first + i));
}
void particles(ParticleArgs a, const HostRun& run) {
    overLanes(
        a.count, run,
        [&](uint32_t first) {
            Lanes l;
            particleLanes(a, first, l);
            store(l, a.to, first);
        },
        [&](uint32_t i) { placeParticle(a, i); });
}

void grid(GridArgs a, const HostRun& run) {
    run.crew.overRange(a.total, 4096, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) placeGridPoint(a, uint32_t(i));
    });
}

void joints(JointArgs a, const HostRun& run) {
    run.crew.overRange(a.count, 256, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) placeJoint(a, uint32_t(i));
    });
}

void subsets(SubsetArgs a, const HostRun& run) {
    run.crew.overRange(a.curves, 256, [&](size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) pickSubset(a, uint32_t(c));
    });
}

struct alignas(64) CurveLanes {
    Lanes before, from, to, after;
};
ESPALIER_LANES void splineLanes(CurveLanes& l, float t) {
    for (uint32_t i = 0; i < kNodeLanes; ++i)
        put(l.from, i,
            sampleSpline(vectorOf(l.before, i), vectorOf(l.from, i), vectorOf(l.to, i), vectorOf(l.after, i), t));
}
void curveBlock(const CurveArgs& a, const CurvePlace& p, uint32_t j, uint32_t first) {
    CurveLanes l;
    const std::pair<Lanes&, uint32_t> keys[] = {
        {l.before, p.before}, {l.from, p.from}, {l.to, p.to}, {l.after, p.after}};
    for (const auto& [lanes, key] : keys)
        for (uint32_t lane = 0; lane < kNodeLanes; ++lane)
            put(lanes, lane, takeVector(a.keys, keyOf(a, key, first + lane)));
    splineLanes(l, p.t);
    store(l.from, a.to, j * a.row + first);
}
void curves(CurveArgs a, const HostRun& run) {
    run.crew.overRange(a.samples, std::max<size_t>(1, 2048 / a.row), [&](size_t begin, size_t end) {
        for (uint32_t j = uint32_t(begin); j < end; ++j) {
            const CurvePlace at = curvePlace(a, j);
            if (run.plain)
                for (uint32_t c = 0; c < a.curves; ++c) sampleCurve(a, at, j, c);
            else
                for (uint32_t first = 0; first < a.row; first += kNodeLanes) curveBlock(a, at, j, first);
        }
    });
}

void circle(CircleArgs a, const HostRun& run) {
    run.crew.overRange(a.samples, 4096, [&](size_t begin, size_t end) {
        for (size_t j = begin; j < end; ++j) sampleCircle(a, uint32_t(j));
    });
}

// What a block of lanes is while a program goes over it, step by step.
struct alignas(64) DeformLanes {
    Lanes at, normal;
};
ESPALIER_LANES void moveLanes(const DeformOp& given, DeformLanes& l) {
    const DeformOp op = given;
    for (uint32_t i = 0; i < kNodeLanes; ++i) put(l.at, i, moveStep(op, vectorOf(l.at, i)));
}
ESPALIER_LANES void spherifyLanes(const DeformOp& given, DeformLanes& l) {
    const DeformOp op = given;
    for (uint32_t i = 0; i < kNodeLanes; ++i) put(l.at, i, spherifyStep(op, vectorOf(l.at, i)));
}
ESPALIER_LANES void twistLanes(const DeformOp& given, DeformLanes& l) {
    const DeformOp op = given;
    for (uint32_t i = 0; i < kNodeLanes; ++i) put(l.at, i, twistStep(op, vectorOf(l.at, i)));
}
ESPALIER_LANES void bendLanes(const DeformOp& given, DeformLanes& l) {
    const DeformOp op = given;
    for (uint32_t i = 0; i < kNodeLanes; ++i) put(l.at, i, bendStep(op, vectorOf(l.at, i)));
}
ESPALIER_LANES void noiseLanes(const DeformOp& given, DeformLanes& l) {
    const DeformOp op = given;
    for (uint32_t i = 0; i < kNodeLanes; ++i) put(l.at, i, noiseStep(op, vectorOf(l.at, i)));
}
ESPALIER_LANES void waveLanes(const DeformOp& given, DeformLanes& l) {
    const DeformOp op = given;
    for (uint32_t i = 0; i < kNodeLanes; ++i) put(l.at, i, waveStep(op, vectorOf(l.at, i)));
}
ESPALIER_LANES void displaceLanes(const DeformOp& given, DeformLanes& l) {
    const DeformOp op = given;
    for (uint32_t i = 0; i < kNodeLanes; ++i) put(l.at, i, displaceStep(op, vectorOf(l.at, i), vectorOf(l.normal, i)));
}

// Its words differ from text to text, so it goes lane by lane.
void functionLanes(const DeformOp& op, DeformLanes& l) {
    for (uint32_t lane = 0; lane < kNodeLanes; ++lane) put(l.at, lane, functionStep(op, vectorOf(l.at, lane)));
}
// It reads texels here and there.
void pictureLanes(const DeformOp& op, DeformLanes& l) {
    for (uint32_t lane = 0; lane < kNodeLanes; ++lane)
        put(l.at, lane, pictureStep(op, vectorOf(l.at, lane), vectorOf(l.normal, lane)));
}
// All lanes belong to one instance.
void instanceLanes(const DeformOp& op, uint32_t i, DeformLanes& l) {
    for (uint32_t lane = 0; lane < kNodeLanes; ++lane) put(l.at, lane, instanceStep(op, vectorOf(l.at, lane), i));
}

// By DeformOp::kind; instances are a case of their own.
constexpr void (*kDeformSteps[])(const DeformOp&, DeformLanes&) = {
    moveLanes, spherifyLanes, twistLanes, bendLanes,     noiseLanes,
    waveLanes, displaceLanes, nullptr,    functionLanes, pictureLanes};

void deformBlock(const DeformArgs& a, uint32_t first) {
    DeformLanes l;
    const uint32_t own = first % a.each;
    uint32_t instance = first / a.each;
    load(l.at, a.from, own);
    for (uint32_t lane = 0; lane < kNodeLanes; ++lane) put(l.normal, lane, startNormal(a.normals, own + lane));
    for (uint32_t k = 0; k < a.opCount; ++k) {
        const DeformOp& op = a.ops.v[k];
        if (op.kind != kDeformInstance) {
            kDeformSteps[op.kind](op, l);
            continue;
        }
        instanceLanes(op, instance % op.points.count, l);
        instance /= op.points.count;
    }
    store(l.at, a.to, first);
}
void deform(DeformArgs a, const HostRun& run) {
    overLanes(
        a.to.count, run, [&](uint32_t first) { deformBlock(a, first); }, [&](uint32_t i) { deformElement(a, i); });
    if (a.toNormals.v)
        run.crew.overRange(a.to.count, 1024, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) deformNormal(a, uint32_t(i));
        });
}

struct alignas(64) FrameLanes {
    Lanes at, along, side, other;  // of the frames so far
    Lanes before, next, after;     // samples of the curves about the next frames
};
void loadSamples(FrameLanes& l, const FrameArgs& a, uint32_t j, uint32_t first) {
    load(l.before, a.path, sampleBefore(a, j) * a.row + first);
    load(l.next, a.path, j * a.row + first);
    load(l.after, a.path, sampleAfter(a, j) * a.row + first);
}
void storeFrames(const FrameLanes& l, const FrameArgs& a, uint32_t j, uint32_t first) {
    store(l.side, a.to, j * a.row + first);
    store(l.other, a.to, j * a.row + first, 3);
}
void put(FrameLanes& l, uint32_t i, const SweptFrame& f) {
    put(l.at, i, f.at);
    put(l.along, i, f.along);
    put(l.side, i, f.side);
    put(l.other, i, otherSide(f));
}
// Once a curve, so lane by lane.
void firstFrames(FrameLanes& l) {
    for (uint32_t lane = 0; lane < kNodeLanes; ++lane)
        put(l, lane, frameAt(vectorOf(l.next, lane), alongPath(vectorOf(l.before, lane), vectorOf(l.after, lane))));
}
ESPALIER_LANES void nextFrames(FrameLanes& l) {
    for (uint32_t i = 0; i < kNodeLanes; ++i) {
        const SweptFrame f = {vectorOf(l.at, i), vectorOf(l.along, i), vectorOf(l.side, i)};
        put(l, i, nextFrame(f, vectorOf(l.next, i), alongPath(vectorOf(l.before, i), vectorOf(l.after, i))));
    }
}
void frames(FrameArgs a, const HostRun& run) {
    if (run.plain) {
        for (uint32_t c = 0; c < a.curves; ++c) sweepFrames(a, c);
        return;
    }
    run.crew.overRange(a.row / kNodeLanes, 1, [&](size_t begin, size_t end) {
        FrameLanes l;
        for (size_t b = begin; b < end; ++b) {
            const uint32_t first = uint32_t(b) * kNodeLanes;
            for (uint32_t j = 0; j < a.samples; ++j) {
                loadSamples(l, a, j, first);
                j == 0 ? firstFrames(l) : nextFrames(l);
                storeFrames(l, a, j, first);
            }
        }
    });
}

struct alignas(64) LoftLanes {
    Lanes at, side, other, vertex;
    uint32_t normal[kNodeLanes];
};
ESPALIER_LANES void loftLanes(LoftLanes& l, const RingPlace& given) {
    const RingPlace r = given;
    for (uint32_t i = 0; i < kNodeLanes; ++i) {
        const LoftVertex v = loftVertex(r, vectorOf(l.at, i), vectorOf(l.side, i), vectorOf(l.other, i));
        put(l.vertex, i, v.at);
        l.normal[i] = v.normal;
    }
}
void loftSample(const LoftArgs& a, std::span<const RingPlace> ring, uint32_t j, uint32_t first) {
    LoftLanes l;
    const uint32_t from = j * a.row + first;
    load(l.at, a.path, from);
    load(l.side, a.frames, from);
    load(l.other, a.frames, from, 3);
    for (uint32_t u = 0; u < ring.size(); ++u) {
        const uint32_t to = (j * a.ringSamples + u) * a.row + first;
        loftLanes(l, ring[u]);
        store(l.vertex, a.to, to);
        std::memcpy(a.normals.v + to, l.normal, sizeof l.normal);
    }
}
void loft(LoftArgs a, const HostRun& run) {
    run.crew.overRange(a.samples, std::max<size_t>(1, 4096 / (a.row * a.ringSamples)), [&](size_t begin, size_t end) {
        std::vector<RingPlace> ring(a.ringSamples);
        for (uint32_t j = uint32_t(begin); j < end; ++j) {
            for (uint32_t u = 0; u < a.ringSamples; ++u) ring[u] = ringPlace(a, j, u);
            if (run.plain)
                for (uint32_t u = 0; u < a.ringSamples; ++u)
                    for (uint32_t c = 0; c < a.curves; ++c) placeLoftVertex(a, ring[u], j, u, c);
            else
                for (uint32_t first = 0; first < a.row; first += kNodeLanes) loftSample(a, ring, j, first);
        }
    });
}

void sheet(SheetArgs a, const HostRun& run) {
    run.crew.overRange(a.quads, 4096, [&](size_t begin, size_t end) {
        for (size_t q = begin; q < end; ++q) putQuad(a, uint32_t(q));
    });
}

void bounds(BoundArgs a, const HostRun& run) {
    std::mutex guard;
    run.crew.overRange(a.items, 16384, [&](size_t begin, size_t end) {
        vec3 low(1e30f), high(-1e30f);
        for (size_t i = begin; i < end; ++i) {
            const vec3 p = boundPlace(a, uint32_t(i));
            low = {smaller(low.x, p.x), smaller(low.y, p.y), smaller(low.z, p.z)};
            high = {larger(high.x, p.x), larger(high.y, p.y), larger(high.z, p.z)};
        }
        const std::lock_guard lock(guard);
        for (uint32_t k = 0; k < 3; ++k) {
            a.box.v[k] = std::min(a.box.v[k], orderedBits(low[int(k)]));
            a.box.v[3 + k] = std::max(a.box.v[3 + k], orderedBits(high[int(k)]));
        }
    });
}

constexpr HostRow kRows[] = {
    {"nodes/particles.comp", passOf<ParticleArgs, particles>},
    {"nodes/grid.comp", passOf<GridArgs, grid>},
    {"nodes/joints.comp", passOf<JointArgs, joints>},
    {"nodes/subsets.comp", passOf<SubsetArgs, subsets>},
    {"nodes/curves.comp", passOf<CurveArgs, curves>},
    {"nodes/circle.comp", passOf<CircleArgs, circle>},
    {"nodes/deform.comp", passOf<DeformArgs, deform>},
    {"nodes/frames.comp", passOf<FrameArgs, frames>},
    {"nodes/loft.comp", passOf<LoftArgs, loft>},
    {"nodes/sheet.comp", passOf<SheetArgs, sheet>},
    {"nodes/bounds.comp", passOf<BoundArgs, bounds>},
};

}  // namespace

const std::span<const HostRow> kNodeRows = kRows;

}  // namespace espalier
