// Points: particles and grids.
#include "runtime/nodes/node_work.hpp"
#include "shaders/shared/node_joints.h"
#include "shaders/shared/node_points.h"

namespace espalier {
namespace {

constexpr float kFar = 1e6f;  // metres
constexpr float kMostPoints = 4000000;

Status makeParticles(NodeWork& work) {
    const uint32_t count = work.whole("count");
    GeometryPart part;
    Result<NodePlanes> planes = work.planes("particles", count, 3, part.positionBlock);
    if (!planes) return planes.failure();
    ParticleArgs args{};
    args.to = part.positions = *planes;
    const glm::vec3 a = work.vector("low"), b = work.vector("high");
    args.low = glm::min(a, b);
    args.size = glm::max(a, b) - args.low;
    for (int i = 0; i < 3; ++i) args.perSize[i] = args.size[i] > 0 ? 1 / args.size[i] : 0;
    args.way = work.number("speed") * work.number("time");
    args.seed = work.whole("seed");
    args.count = part.elements = part.row = part.used = count;
    work.run("nodes/particles.comp", args, count);
    part.extent = glm::length(args.size);
    work.give(Geometry{part});
    return Done{};
}

Status makeGrid(NodeWork& work) {
    const glm::vec3 counts = work.vector("counts"), step = work.vector("step");
    GridArgs args{};
    uint64_t total = 1;
    for (int i = 0; i < 3; ++i) total *= args.counts[i] = uint32_t(counts[i]);
    if (total > uint64_t(kMostPoints))
        return Failure("", std::to_string(total) + " points are more than 4,000,000; make 'counts' smaller");
    GeometryPart part;
    Result<NodePlanes> planes = work.planes("grid", uint32_t(total), 3, part.positionBlock);
    if (!planes) return planes.failure();
    args.to = part.positions = *planes;
    args.step = step;
    args.low = work.vector("centre") - step * (glm::vec3(args.counts[0], args.counts[1], args.counts[2]) - 1.0f) * 0.5f;
    args.total = part.elements = part.row = part.used = uint32_t(total);
    work.run("nodes/grid.comp", args, total);
    part.extent = glm::length(step * counts);
    work.give(Geometry{part});
    return Done{};
}

// Words of elements, such as normals, that a filter keeps where all that is filtered has them.
struct KeptWords {
    const char* name;
    BlockRef GeometryPart::*block;
    std::vector<uint32_t> words;
    bool allHave = true;
};

// How many are kept follows from where they lie, so they are looked at on the host.
Status makeFilter(NodeWork& work) {
    const glm::vec3 low = work.vector("low"), high = work.vector("high");
    const float share = work.number("share");
    const uint32_t seed = work.whole("seed");
    std::vector<glm::vec3> kept;
    KeptWords attributes[] = {{"kept normals", &GeometryPart::normals, {}}, {"kept sizes", &GeometryPart::sizes, {}}};
    size_t given = 0;
    for (const GeometryPart& part : work.geometry("points")) {
        Result<std::vector<glm::vec3>> places = work.placesNow(part);
        if (!places) return places.failure();
        std::vector<uint32_t> which;
        for (uint32_t i = 0; i < places->size(); ++i, ++given) {
            const glm::vec3 p = (*places)[i];
            const bool within =
                p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
            if (!within || nodeRandom(seed, uint32_t(given), 0) >= share) continue;
            kept.push_back(p);
            which.push_back(i);
        }
        for (KeptWords& each : attributes) {
            Result<std::vector<uint32_t>> words = work.wordsNow(part, part.*each.block);
            if (!words) return words.failure();
            each.allHave = each.allHave && !words->empty();
            if (each.allHave)
                for (const uint32_t i : which) each.words.push_back((*words)[i]);
        }
    }
    if (kept.empty()) return Failure("", "keeps none of " + std::to_string(given) + " points");
    GeometryPart part;
    Result<NodePlanes> planes = work.sentPlaces("kept points", kept, part.positionBlock);
    if (!planes) return planes.failure();
    part.positions = *planes;
    part.elements = part.row = part.used = planes->count;
    for (KeptWords& each : attributes) {
        if (!each.allHave) continue;
        each.words.resize(nodeRow(uint32_t(each.words.size())));
        Result<NodeWork::Room> sent = work.sent(each.name, each.words);
        if (!sent) return sent.failure();
        part.*each.block = sent->block;
    }
    for (const GeometryPart& from : work.geometry("points")) part.extent = std::max(part.extent, from.extent);
    work.give(Geometry{part});
    return Done{};
}

Status makeJoints(NodeWork& work) {
    JointArgs args{};
    args.branches = work.whole("branches");
    double joints = 0, level = 1;
    for (uint32_t k = 0; k < work.whole("levels"); ++k, level *= args.branches) joints += level;
    if (joints > double(kMostPoints))
        return Failure(
            "", numberText(float(joints)) + " joints are more than 4,000,000; make 'levels' or 'branches' smaller");
    args.count = uint32_t(joints);
    args.firstEnd = args.count - uint32_t(level / args.branches);
    args.seed = work.whole("seed");
    args.trunk = work.number("length");
    args.shrink = work.number("shrink");
    args.angle = work.number("angle");
    args.spread = work.number("spread");
    args.perBranch = 1 / float(args.branches);
    GeometryPart all, ends;
    const auto points = [&](GeometryPart& part, const char* name, uint32_t count, NodePlanes& planes,
                            UintBuf& normals) {
        Result<NodePlanes> places = work.planes(name, count, 3, part.positionBlock);
        if (!places) return Status(places.failure());
        Result<NodeWork::Room> along = work.room(name, uint64_t(nodeRow(count)) * sizeof(uint32_t));
        if (!along) return Status(along.failure());
        part.normals = along->block;
        planes = part.positions = *places;
        normals = along->block->as<UintBuf>();
        part.elements = part.row = part.used = count;
        part.extent = args.trunk * 3;
        return Status(Done{});
    };
    if (Status made = points(all, "joints", args.count, args.to, args.normals); !made) return made;
    if (Status made = points(ends, "ends", args.count - args.firstEnd, args.ends, args.endNormals); !made) return made;
    Result<NodeWork::Room> sizes = work.room("joint sizes", uint64_t(nodeRow(args.count)) * sizeof(float));
    if (!sizes) return sizes.failure();
    all.sizes = sizes->block;
    args.sizes = sizes->block->as<FloatBuf>();
    work.run("nodes/joints.comp", args, args.count);
    work.give(Geometry{all});
    work.give(Geometry{ends}, 1);
    return Done{};
}

}  // namespace

std::vector<NodeKind> pointKinds() {
    return {
        {"Particles",
         "Points that begin anywhere in a box, each moves straight on in a direction of its own, and the box throws "
         "them back.",
         {wholePort("count", 100, 1, kMostPoints, "how many"),
          vectorPort("low", glm::vec3(-1), -kFar, kFar, "m", "the box's low corner"),
          vectorPort("high", glm::vec3(1), -kFar, kFar, "m", "the box's high corner"),
          numberPort("speed", 0.0025f, -kFar, kFar, "m", "the way in one step of time"), seedPort(),
          numberPort("time", 0, -1e6f, 1e6f, "steps", "the steps that have gone by: wire it to time.frame")},
         {{"points", ValueType::points}},
         makeParticles,
         {"nodes/particles.comp"}},
        {"PointGrid",
         "Points in rows along x, y and z.",
         {vectorPort("counts", glm::vec3(10, 1, 10), 1, kMostPoints, "", "how many along each axis"),
          vectorPort("step", glm::vec3(1), -kFar, kFar, "m", "from one to the next along each axis"),
          vectorPort("centre", glm::vec3(0), -kFar, kFar, "m", "the middle of all")},
         {{"points", ValueType::points}},
         makeGrid,
         {"nodes/grid.comp"}},
        {"JointTree",
         "A tree of joints, each of which carries smaller ones at its end. Scatter a cylinder of height 1 over them "
         "with 'up' as \"normal\": sizes are the joints' lengths.",
         {wholePort("levels", 6, 1, 16, "from the trunk to the last twigs"),
          wholePort("branches", 3, 1, 16, "that each joint carries"),
          numberPort("length", 1, 0, kFar, "m", "of the trunk"),
          numberPort("shrink", 0.75f, 0, 2, "", "a branch's length, of that which carries it"),
          numberPort("angle", 0.5f, -4, 4, "rad", "from a joint to those that it carries"),
          numberPort("spread", 0.3f, 0, 1, "", "how far angles, turns and lengths differ"), seedPort()},
         {{"joints", ValueType::points}, {"ends", ValueType::points}},
         makeJoints,
         {"nodes/joints.comp"}},
        {"Filter",
         "The points that lie in a box, or a random share of them. Of curves and meshes it takes samples and vertices.",
         {wirePort("points", ValueType::geometry, "what is chosen from"),
          vectorPort("low", glm::vec3(-kFar), -kFar, kFar, "m", "the box's low corner"),
          vectorPort("high", glm::vec3(kFar), -kFar, kFar, "m", "the box's high corner"),
          numberPort("share", 1, 0, 1, "", "of those in the box; more of them keeps those that were kept"), seedPort()},
         {{"points", ValueType::points}},
         makeFilter},
    };
}

}  // namespace espalier
