#pragma once

// Runs lists of stages on a device: as shaders that are recorded and submitted, or, where a device's memory is the
// process's own and shaders would run on the same cores, at once as native code. Who hands over a list doesn't know.

#include <optional>

#include "runtime/gpu/commands.hpp"
#include "runtime/run/at_once.hpp"
#include "runtime/run/hazards.hpp"
#include "runtime/run/host_runner.hpp"
#include "runtime/run/programs.hpp"

namespace espalier {

// What runs of one owner share: programs, threads, memory of lanes, what is read back. All of it is made when it is
// first needed.
class Runner {
  public:
    // name: of its buffers; outlives it.
    Runner(Device& device, const char* name);

    Device& device() { return device_; }
    bool atOnce(bool wanted, const Buffer& memory) const { return runsAtOnce(device_, wanted, memory); }
    void dropPrograms(uint32_t constant) { programs_.drop(constant); }
    // Keeps memory of lanes only up to so many bytes.
    void trim(uint64_t laneBytes);
    uint64_t reserved() const { return lanes_.size(); }  // bytes

  private:
    friend class Run;
    Device& device_;
    std::string name_;
    Programs programs_;
    HostRunner host_;
    Buffer lanes_, readback_;
};

// One submission, which is waited for.
class Run {
  public:
    // Fails when memory has run out.
    static Result<Run> begin(Runner& runner, std::string_view name, bool atOnce);

    // What stages read is sent by these, before any stage is added.
    Commands& send();
    // The same copied for kernels only, since native code of the stages that follow copies as it looks.
    void sendToKernels(const Buffer& from, const Buffer& to, uint64_t bytes);
    // Makes what shaders of these stages need, and room for what is read back. add() does so too; this is for who wants
    // to know before.
    Status prepare(const StageList& list);
    // Adds stages behind those before: at once, or to the recording. Fails when memory has run out, and where `watch`
    // has stopped native code.
    Status add(StageList list, GrowthWatch* watch = nullptr);
    // The buffer's first bytes, as they are when all stages are done; multiples of 4.
    void readBack(const Buffer& from, uint64_t bytes);
    Status finish();

    // Behind finish(), until the runner's next run: what was read back, in the order in which it was asked for.
    template <class T>
    const T* got(size_t index) const {
        return reinterpret_cast<const T*>(got_[index].memory);
    }
    double milliseconds(std::string_view pass) const {
        const auto known = times_.find(pass);
        return known == times_.end() ? 0 : known->second;
    }
    uint32_t dispatches() const { return dispatches_; }  // of kernels
    bool atOnce() const { return atOnce_; }

  private:
    struct Got {
        const Buffer* from;
        uint64_t bytes;
        const std::byte* memory;
    };
    explicit Run(Runner& runner, bool atOnce) : runner_(runner), atOnce_(atOnce) {}
    Status record(std::span<Stage> group, std::optional<Pass>& pass);
    Status recordOnce(Stage& stage, uint32_t wave, Pass& pass);
    Status makeReadback();
    Status collect();

    Runner& runner_;
    bool atOnce_;
    std::optional<Commands> commands_;
    Hazards hazards_;
    std::vector<Got> got_;
    std::vector<const char*> passes_;
    PassTimes times_;
    uint32_t dispatches_ = 0;
};

}  // namespace espalier
