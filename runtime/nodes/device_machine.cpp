// The graph on a device: its kernels, or native code over the same buffers (runtime/run decides).
#include "runtime/nodes/machine.hpp"

namespace espalier {
namespace {

class DeviceBlock : public NodeBlock {
  public:
    explicit DeviceBlock(Buffer buffer) : NodeBlock(buffer.address(), buffer.size()), buffer_(std::move(buffer)) {}
    const Buffer* buffer() const override { return &buffer_; }

  private:
    Buffer buffer_;
};

class DeviceMachine : public NodeMachine {
  public:
    DeviceMachine(Device& device, bool native) : device_(device), runner_(device, "graph"), native_(native) {}

    Result<BlockRef> allocate(const char* name, uint64_t bytes) override {
        Result<Buffer> made = Buffer::create(device_, name, std::max<uint64_t>(bytes, 64));
        if (!made) return made.failure();
        return BlockRef(std::make_shared<DeviceBlock>(std::move(*made)));
    }
    Status run(NodeWorkList list) override {
        dispatches_ = 0;
        if (list.stages.empty() && list.uploads.empty()) return Done{};
        Result<Run> run = Run::begin(runner_, "graph", atOnce());
        if (!run) return run.failure();
        for (const NodeWorkList::Upload& upload : list.uploads)
            if (Status sent = run->send().upload(*upload.to->buffer(), upload.bytes); !sent) return sent;
        if (Status added = run->add(std::move(list.stages)); !added) return added;
        Status finished = run->finish();
        dispatches_ = run->dispatches();
        return finished;
    }
    Result<std::vector<std::byte>> read(const NodeBlock& block, uint64_t bytes) override {
        return readBuffer(device_, *block.buffer(), 0, bytes);
    }
    uint32_t dispatches() const override { return dispatches_; }

  private:
    bool atOnce() {
        if (!probe_) (void)assign(probe_, Buffer::create(device_, "graph probe", 64));
        return runner_.atOnce(native_, probe_);
    }

    Device& device_;
    Runner runner_;
    Buffer probe_;
    bool native_;
    uint32_t dispatches_ = 0;
};

}  // namespace

std::unique_ptr<NodeMachine> deviceMachine(Device& device, bool native) {
    return std::make_unique<DeviceMachine>(device, native);
}

}  // namespace espalier
