// In: geometry. Out: boxes around it.
#include "runtime/nodes/measure.hpp"

#include <algorithm>
#include <cstring>

#include "runtime/nodes/node_work.hpp"
#include "shaders/shared/node_bounds.h"

namespace espalier {
namespace {

constexpr uint32_t kBoxWords = 6;

class Measuring {
  public:
    explicit Measuring(NodeMachine& machine) : machine_(machine) {}

    Result<std::vector<NodeBox>> run(const Geometry& parts) {
        // Of each part a box of the shape, and one for each group of its instances.
        std::vector<size_t> last;
        size_t count = 0;
        for (const GeometryPart& part : parts) last.push_back((count += 1 + groupsOf(part).size()) - 1);
        Result<BlockRef> boxes = machine_.allocate("bounds", count * kBoxWords * 4);
        if (!boxes) return boxes.failure();
        const uint32_t low = 0xFFFFFFFF, none[kBoxWords] = {low, low, low, 0, 0, 0};
        std::vector<std::byte> empty;
        for (size_t i = 0; i < count; ++i) {
            const auto bytes = std::as_bytes(std::span(none));
            empty.insert(empty.end(), bytes.begin(), bytes.end());
        }
        list_.uploads.push_back({*boxes, std::move(empty)});
        for (size_t i = 0; i < parts.size(); ++i)
            if (Status added = add(parts[i], (*boxes)->as<UintBuf>().v + (i ? last[i - 1] + 1 : 0) * kBoxWords); !added)
                return added.failure();
        if (Status ran = machine_.run(std::move(list_)); !ran) return ran.failure();
        Result<std::vector<std::byte>> bytes = machine_.read(**boxes, count * kBoxWords * 4);
        if (!bytes) return bytes.failure();
        std::vector<NodeBox> out(parts.size());
        for (size_t i = 0; i < parts.size(); ++i) {
            uint32_t words[kBoxWords];
            std::memcpy(words, bytes->data() + last[i] * sizeof words, sizeof words);
            for (int k = 0; k < 3; ++k) {
                out[i].low[k] = floatOfOrdered(words[k]);
                out[i].high[k] = floatOfOrdered(words[3 + k]);
            }
        }
        return out;
    }

  private:
    // Steps of a program whose instances are looked at together, by the first of each group. Of very many instances
    // each step is a group: the boxes of what it places are placed as a whole, which takes a sum of steps and no
    // product. A box that is bent as a whole doesn't hold what is bent within it, so this is for steps that only place.
    static std::vector<uint32_t> groupsOf(const GeometryPart& part) {
        constexpr uint64_t kFew = 65536;
        const auto instances = [](const DeformOp& op) { return op.kind == kDeformInstance; };
        const auto first = std::ranges::find_if(part.program, instances);
        const bool places = std::all_of(first, part.program.end(), [](const DeformOp& op) {
            return op.kind == kDeformInstance || op.kind == kDeformMove;
        });
        std::vector<uint32_t> groups;
        for (uint32_t k = 0; k < part.program.size(); ++k)
            if (instances(part.program[k]) && (groups.empty() || (places && part.instances() > kFew)))
                groups.push_back(k);
        return groups;
    }

    Status add(const GeometryPart& part, uint32_t* boxes) {
        BoundArgs args{};
        args.from = part.positions;
        if (part.normals) args.normals = part.normals->as<UintBuf>();
        if (!part.program.empty()) {
            Result<BlockRef> ops = machine_.allocate("bounds program", part.program.size() * sizeof(DeformOp));
            if (!ops) return ops.failure();
            const auto bytes = std::as_bytes(std::span(part.program));
            list_.uploads.push_back({*ops, {bytes.begin(), bytes.end()}});
            args.ops = (*ops)->as<DeformOpBuf>();
        }
        const std::vector<uint32_t> groups = groupsOf(part);
        const auto endOf = [&](size_t group) {
            return group < groups.size() ? groups[group] : uint32_t(part.program.size());
        };
        args.endOp = endOf(0);
        args.row = part.row;
        args.used = part.used;
        args.items = part.elements;
        args.box.v = boxes;
        run(args);
        for (size_t group = 0; group < groups.size(); ++group) {
            args.shape.v = boxes + group * kBoxWords;
            args.box.v = boxes + (group + 1) * kBoxWords;
            args.firstOp = endOf(group);
            args.endOp = endOf(group + 1);
            uint64_t instances = 1;
            for (uint32_t k = args.firstOp; k < args.endOp; ++k) instances *= instancesOf(part.program[k]);
            args.items = uint32_t(instances * 8);
            run(args);
        }
        return Done{};
    }

    void run(const BoundArgs& args) { addNodeStage(list_, "nodes/bounds.comp", args, args.items); }

    NodeMachine& machine_;
    NodeWorkList list_;
};

}  // namespace

Result<std::vector<NodeBox>> measure(NodeMachine& machine, const Geometry& parts) {
    if (parts.empty()) return std::vector<NodeBox>();
    return Measuring(machine).run(parts);
}

}  // namespace espalier
