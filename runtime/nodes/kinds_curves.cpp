// Curves: through random subsets of points, through given points, circles.

#include "runtime/nodes/node_work.hpp"
#include "shaders/shared/node_curves.h"

namespace espalier {
namespace {

constexpr float kFar = 1e6f;  // metres
constexpr float kMostCurves = 1000000, kMostSamples = 65536, kMostKeys = 64;

Result<GeometryPart> curvesOf(NodeWork& work, uint32_t curves, uint32_t samples) {
    GeometryPart part;
    part.kind = GeometryPart::Kind::curves;
    part.used = curves;
    part.samples = samples;
    part.row = nodeRow(curves);
    const uint64_t elements = uint64_t(part.row) * samples;
    if (elements > kMostNodeElements)
        return Failure("", std::to_string(uint64_t(curves) * samples) +
                               " samples are more than there is room for; take fewer curves or samples");
    part.elements = curves * samples;
    Result<NodePlanes> planes = work.planes("curves", uint32_t(elements), 3, part.positionBlock);
    if (!planes) return planes.failure();
    part.positions = *planes;
    return part;
}

Status makeSubsets(NodeWork& work) {
    Result<const GeometryPart*> found = work.part("points", GeometryPart::Kind::points);
    if (!found) return found.failure();
    Result<GeometryPart> points = work.realised(**found);
    if (!points) return points.failure();
    const uint32_t curves = work.whole("curves"), keys = work.whole("keys");
    if (points->elements < keys)
        return Failure("", "a curve through " + std::to_string(keys) + " points needs as many, but there are " +
                               std::to_string(points->elements));
    Result<GeometryPart> part = curvesOf(work, curves, work.whole("samples"));
    if (!part) return part.failure();
    // Which points each curve goes through stays while these numbers do, wherever the points go.
    SubsetArgs pick{};
    pick.row = part->row;
    pick.curves = curves;
    pick.keys = keys;
    pick.points = points->elements;
    pick.seed = work.whole("seed");
    Result<NodeWork::Room> picked =
        work.room("subsets", uint64_t(pick.row) * keys * 4, NodeWork::key({curves, keys, pick.points, pick.seed}));
    if (!picked) return picked.failure();
    pick.to = picked->block->as<UintBuf>();
    if (picked->fresh) work.run("nodes/subsets.comp", pick, curves);
    CurveArgs args{};
    args.keys = points->positions;
    args.to = part->positions;
    args.pick = pick.to;
    args.pickRow = args.row = part->row;
    args.curves = curves;
    args.keyCount = keys;
    args.samples = part->samples;
    args.points = points->elements;
    work.run("nodes/curves.comp", args, part->elements);
    part->extent = points->extent;
    work.give(Geometry{*part});
    return Done{};
}

// Curves with another number of samples.
Status makeSamples(NodeWork& work) {
    Geometry out;
    for (const GeometryPart& given : work.geometry("curves")) {
        if (given.kind != GeometryPart::Kind::curves) continue;
        Result<GeometryPart> from = work.realised(given);
        if (!from) return from.failure();
        Result<GeometryPart> part = curvesOf(work, from->used, work.whole("samples"));
        if (!part) return part.failure();
        CurveArgs args{};
        args.keys = from->positions;
        args.to = part->positions;
        args.pickRow = from->row;
        args.row = part->row;
        args.curves = from->used;
        args.keyCount = from->samples;
        args.samples = part->samples;
        args.points = from->positions.count;
        work.run("nodes/curves.comp", args, part->elements);
        part->closed = from->closed;
        part->extent = from->extent;
        part->material = from->material;
        out.push_back(*part);
    }
    if (out.empty()) return Failure("", "'curves' holds no curves");
    work.give(std::move(out));
    return Done{};
}

Status makeCircle(NodeWork& work) {
    Result<GeometryPart> part = curvesOf(work, 1, work.whole("samples"));
    if (!part) return part.failure();
    part->closed = true;
    CircleArgs args{};
    args.to = part->positions;
    args.row = part->row;
    args.samples = part->samples;
    args.radius = work.number("radius");
    args.turn = work.number("turn");
    work.run("nodes/circle.comp", args, part->samples);
    part->extent = 2 * args.radius;
    work.give(Geometry{*part});
    return Done{};
}

// A spline through points that the text gives.
Status makeCurve(NodeWork& work) {
    std::vector<glm::vec3> keys;
    for (const NodeValue* value : work.wires("keys")) keys.push_back(std::get<glm::vec3>(*value));
    if (keys.empty()) keys = {work.vector("from"), work.vector("bend"), work.vector("to")};
    if (keys.size() < 2) return Failure("", "a curve goes through two points or more");
    const uint32_t row = nodeRow(1), count = uint32_t(keys.size());
    std::vector<float> planes(size_t(row) * count * 3);
    for (uint32_t k = 0; k < count; ++k)
        for (uint32_t axis = 0; axis < 3; ++axis) planes[(size_t(axis) * count + k) * row] = keys[k][int(axis)];
    Result<NodeWork::Room> sent = work.sent("keys", planes);
    if (!sent) return sent.failure();
    Result<GeometryPart> part = curvesOf(work, 1, work.whole("samples"));
    if (!part) return part.failure();
    CurveArgs args{};
    args.keys = {sent->block->as<FloatBuf>(), row * count, row * count};
    args.to = part->positions;
    args.pickRow = row;
    args.row = part->row;
    args.curves = 1;
    args.keyCount = count;
    args.samples = part->samples;
    args.points = row * count;
    work.run("nodes/curves.comp", args, part->samples);
    glm::vec3 low = keys[0], high = keys[0];
    for (const glm::vec3& key : keys) low = glm::min(low, key), high = glm::max(high, key);
    part->extent = std::max(glm::length(high - low), 1e-6f);
    work.give(Geometry{*part});
    return Done{};
}

}  // namespace

std::vector<NodeKind> curveKinds() {
    const auto samples = [](float standard) {
        return wholePort("samples", standard, 2, kMostSamples, "places on each curve");
    };
    NodePort keys{"keys",
                  ValueType::vector,
                  glm::vec3(0),
                  -kFar,
                  kFar,
                  "m",
                  "wires to vectors: points that the curve goes through instead"};
    keys.many = true;
    return {
        {"SubsetCurves",
         "Curves through random subsets of points: each goes smoothly through as many different points as it has keys.",
         {wirePort("points", ValueType::points, "what the keys are taken of"),
          wholePort("curves", 100, 1, kMostCurves, "how many"),
          wholePort("keys", 8, 2, kMostKeys, "points that each goes through"), samples(28), seedPort()},
         {{"curves", ValueType::curves}},
         makeSubsets,
         {"nodes/subsets.comp", "nodes/curves.comp"}},
        {"SampleCurve",
         "The same curves with another number of samples.",
         {wirePort("curves", ValueType::curves, "what is sampled"), samples(32)},
         {{"curves", ValueType::curves}},
         makeSamples,
         {"nodes/curves.comp"}},
        {"Circle",
         "A circle in the plane z = 0. Its last sample is its first again.",
         {samples(16), numberPort("radius", 0.5f, 0, kFar, "m", ""),
          numberPort("turn", 0, -1000, 1000, "rad", "where its first sample lies")},
         {{"curve", ValueType::curves}},
         makeCircle,
         {"nodes/circle.comp"}},
        {"Curve",
         "A smooth curve through three points, or through all that are wired to 'keys'.",
         {vectorPort("from", glm::vec3(0), -kFar, kFar, "m", "where it begins"),
          vectorPort("bend", glm::vec3(0, 0.5f, 0), -kFar, kFar, "m", "the point in between"),
          vectorPort("to", glm::vec3(0, 1, 0), -kFar, kFar, "m", "where it ends"), samples(32), keys},
         {{"curve", ValueType::curves}},
         makeCurve,
         {"nodes/curves.comp"}},
    };
}

}  // namespace espalier
