#pragma once

// Patterns derived on a device: waves recorded ahead as indirect dispatches, until nothing waits.

#include <memory>

#include "runtime/pattern/pattern_room.hpp"
#include "runtime/pattern/pattern_stages.hpp"
#include "runtime/run/runner.hpp"

namespace espalier {

class PatternGrowth {
  public:
    static Result<std::unique_ptr<PatternGrowth>> create(Device& device);

    // Addresses in `inputs` are the device's, but for grammars and fieldTable, which are uploaded. native: on a
    // software device whose addresses are the process's, the same text as native code. Waits for the result.
    Result<GrownPattern> grow(const PatternInputs& inputs, std::span<const FieldRef> fieldTable, bool native);
    // Dispatches of the last derivation by kernels that waited for each other.
    uint32_t dispatches() const { return dispatches_; }

  private:
    explicit PatternGrowth(Device& device) : device_(device), runner_(device, "pattern") {}
    Status makeRoom(const PatternInputs& inputs, std::span<const FieldRef> fieldTable);
    Status upload(Commands& commands, const PatternInputs& inputs, std::span<const FieldRef> fieldTable,
                  const PatternEnv& env);
    PatternEnv environment(const PatternInputs& inputs) const;
    PatternShaders shaders() const;
    // All waves with the room there is. The status tells whether that was enough.
    Result<PatternStatus> attempt(const PatternInputs& inputs, std::span<const FieldRef> fieldTable, bool native);
    Result<GrownPattern> readBack(const PatternInputs& inputs, bool native);

    Device& device_;
    Runner runner_;
    PatternRoom room_;
    Buffer items_, shapes_, sets_, pieces_, edges_, pairs_, cells_, meshes_, clusters_, corners_, status_, env_,
        grammars_, fields_;
    uint32_t dispatches_ = 0;
};

}  // namespace espalier
