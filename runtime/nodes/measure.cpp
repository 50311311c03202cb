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
        // Two boxes a part: of the shape, and of all.
        Result<BlockRef> boxes = machine_.allocate("bounds", parts.size() * 2 * kBoxWords * 4);
        if (!boxes) return boxes.failure();
        const uint32_t low = 0xFFFFFFFF, none[kBoxWords] = {low, low, low, 0, 0, 0};
        std::vector<std::byte> empty;
        for (size_t i = 0; i < parts.size() * 2; ++i) {
            const auto bytes = std::as_bytes(std::span(none));
            empty.insert(empty.end(), bytes.begin(), bytes.end());
        }
        list_.uploads.push_back({*boxes, std::move(empty)});
        for (size_t i = 0; i < parts.size(); ++i)
            if (Status added = add(parts[i], (*boxes)->as<UintBuf>().v + i * 2 * kBoxWords); !added)
                return added.failure();
        if (Status ran = machine_.run(std::move(list_)); !ran) return ran.failure();
        Result<std::vector<std::byte>> bytes = machine_.read(**boxes, parts.size() * 2 * kBoxWords * 4);
        if (!bytes) return bytes.failure();
        std::vector<NodeBox> out(parts.size());
        for (size_t i = 0; i < parts.size(); ++i) {
            uint32_t words[kBoxWords];
            const size_t box = 2 * i + (instanced(parts[i]) ? 1 : 0);
            std::memcpy(words, bytes->data() + box * sizeof words, sizeof words);
            for (int k = 0; k < 3; ++k) {
                out[i].low[k] = floatOfOrdered(words[k]);
                out[i].high[k] = floatOfOrdered(words[3 + k]);
            }
        }
        return out;
    }

  private:
    static bool instanced(const GeometryPart& part) {
        return std::ranges::any_of(part.program, [](const DeformOp& op) { return op.kind == kDeformInstance; });
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
        const auto first = std::ranges::find(part.program, kDeformInstance, &DeformOp::kind);
        args.endOp = uint32_t(first - part.program.begin());
        args.row = part.row;
        args.used = part.used;
        args.items = part.elements;
        args.box.v = boxes;
        run(args);
        if (first == part.program.end()) return Done{};
        args.shape.v = boxes;
        args.box.v = boxes + kBoxWords;
        args.firstOp = args.endOp;
        args.endOp = uint32_t(part.program.size());
        args.items = uint32_t(part.instances() * 8);
        run(args);
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
