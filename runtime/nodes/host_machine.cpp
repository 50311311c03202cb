// The graph without a device: native code over memory of the process.
#include <cstring>
#include <new>

#include "runtime/nodes/machine.hpp"

namespace espalier {
namespace {

constexpr std::align_val_t kAligned{64};

class HostBlock : public NodeBlock {
  public:
    explicit HostBlock(uint64_t bytes)
        : NodeBlock(reinterpret_cast<uint64_t>(::operator new(bytes, kAligned)), bytes) {}
    ~HostBlock() override { ::operator delete(reinterpret_cast<void*>(address()), kAligned); }
};

class HostMachine : public NodeMachine {
  public:
    HostMachine(unsigned threads, bool plain) : runner_(threads, plain) {}

    Result<BlockRef> allocate(const char*, uint64_t bytes) override {
        return BlockRef(std::make_shared<HostBlock>(std::max<uint64_t>(bytes, 64)));
    }
    Status run(NodeWorkList list) override {
        for (const NodeWorkList::Upload& upload : list.uploads)
            std::memcpy(reinterpret_cast<void*>(upload.to->address()), upload.bytes.data(), upload.bytes.size());
        runner_.run(list.stages);
        return Done{};
    }
    Result<std::vector<std::byte>> read(const NodeBlock& block, uint64_t bytes) override {
        const auto* first = reinterpret_cast<const std::byte*>(block.address());
        return std::vector<std::byte>(first, first + bytes);
    }

  private:
    HostRunner runner_;
};

}  // namespace

std::unique_ptr<NodeMachine> hostMachine(unsigned threads, bool plain) {
    return std::make_unique<HostMachine>(threads, plain);
}

}  // namespace espalier
