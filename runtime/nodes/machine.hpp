#pragma once

// Where nodes of the graph keep what they make, and what runs their kernels: a device, or this process alone.

#include <memory>

#include "runtime/nodes/values.hpp"
#include "runtime/run/runner.hpp"

namespace espalier {

// What one evaluation runs, and what it needs beforehand.
struct NodeWorkList {
    struct Upload {
        BlockRef to;
        std::vector<std::byte> bytes;
    };
    std::vector<Upload> uploads;
    StageList stages;
};

// Groups of a kernel that finds its item by itemIndex() of shaders/shared/dispatch.glsl.
std::array<uint32_t, 3> nodeGroups(uint64_t items);
// A kernel over so many items, behind all before it.
template <class Args>
void addNodeStage(NodeWorkList& list, const char* kernel, const Args& args, uint64_t items) {
    static_assert(sizeof(Args) <= 128);  // push data that every device takes
    constexpr Things kAll = 1;
    Stage& stage = list.stages.emplace_back();
    stage.kernel = {kernel, kAll, kAll, kNodeGroup};
    stage.pass = "graph";
    stage.push.set(args);
    stage.groups.count = nodeGroups(items);
}

class NodeMachine {
  public:
    virtual ~NodeMachine() = default;
    // Contents are undefined at first. Fails when memory has run out.
    virtual Result<BlockRef> allocate(const char* name, uint64_t bytes) = 0;
    // Returns when all is done.
    virtual Status run(NodeWorkList list) = 0;
    // Bytes from the block's beginning on. Waits for all that has been submitted.
    virtual Result<std::vector<std::byte>> read(const NodeBlock& block, uint64_t bytes) = 0;
    // Dispatches of the last run; 0: it was native code.
    virtual uint32_t dispatches() const { return 0; }
};

// On a device: as kernels, or as native code where its memory is the process's own and `native` allows it.
std::unique_ptr<NodeMachine> deviceMachine(Device& device, bool native);
// Native code over memory of the process; plain: element by element, as a reference. threads: as a Crew's.
std::unique_ptr<NodeMachine> hostMachine(unsigned threads = 0, bool plain = false);

}  // namespace espalier
