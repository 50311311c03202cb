#pragma once

// Kernels' lanes on the CPU, together in subgroups of any size: each lane is a stack of its own that runs until it asks
// its subgroup for something (shaders/shared/subgroup.h), and goes on when all lanes of the subgroup have asked for the
// same or have ended. One thread runs them all, so that a seed gives the same order each time.

#include <ucontext.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "shaders/shared/language.h"

namespace espalier::test {

// In which order lanes run between two operations.
struct LaneOrder {
    uint32_t subgroupSize = 32;
    uint32_t seed = 0;  // 0: in lockstep, one after the other; else whichever lane of whichever subgroup comes
};

class EmulatedLane {
  public:
    EmulatedLane() = default;
    EmulatedLane(const EmulatedLane&) = delete;
    virtual ~EmulatedLane() = default;
    virtual void main() = 0;

    bool anyLane(bool x) { return ask(Ask::any, x ? 1 : 0) != 0; }
    uint32_t countLanes(bool x) { return ask(Ask::sum, x ? 1 : 0); }
    uint32_t sumOfLanes(uint32_t x) { return ask(Ask::sum, x); }
    bool isFirstLane() { return ask(Ask::first, number_) == number_; }
    uint32_t lanesTogether() const { return together_; }

    uint32_t index = 0;  // of the dispatch

  private:
    friend class EmulatedDispatch;
    enum class Ask { any, sum, first };
    uint32_t ask(Ask what, uint32_t value) {
        ask_ = what, value_ = value, waits_ = true, asked_ += 1;
        swapcontext(&own_, out_);
        return value_;
    }
    static constexpr size_t kStack = 256 << 10;
    ucontext_t own_{}, *out_ = nullptr;
    std::unique_ptr<std::byte[]> stack_;
    Ask ask_ = Ask::any;
    uint32_t value_ = 0, number_ = 0, together_ = 1, asked_ = 0;
    bool waits_ = false, ended_ = false;
};

class EmulatedDispatch {
  public:
    // Runs groups of `groupSize` lanes, some of them at a time, as `make` gives them. Returns what was wrong, or
    // nothing.
    template <class Make>
    static std::string run(uint32_t groups, uint32_t groupSize, const LaneOrder& order, const Make& make) {
        for (uint32_t first = 0; first < groups; first += kGroupsAtOnce) {
            EmulatedDispatch some(order);
            for (uint32_t g = first; g < std::min(first + kGroupsAtOnce, groups); ++g)
                for (uint32_t at = 0; at < groupSize; at += order.subgroupSize) {
                    const uint32_t lanes = std::min(order.subgroupSize, groupSize - at);
                    some.subgroups_.emplace_back();
                    for (uint32_t i = 0; i < lanes; ++i)
                        some.add(make(), g * groupSize + at + i, i, std::min(order.subgroupSize, groupSize));
                }
            if (std::string wrong = some.runAll(); !wrong.empty()) return wrong;
        }
        return {};
    }

  private:
    static constexpr uint32_t kGroupsAtOnce = 3;
    using Lanes = std::vector<std::unique_ptr<EmulatedLane>>;

    explicit EmulatedDispatch(const LaneOrder& order) : order_(order), random_(order.seed) {}

    void add(std::unique_ptr<EmulatedLane> lane, uint32_t index, uint32_t number, uint32_t together) {
        EmulatedLane& l = *lane;
        l.index = index, l.number_ = number, l.together_ = together;
        l.stack_ = std::make_unique_for_overwrite<std::byte[]>(EmulatedLane::kStack);
        getcontext(&l.own_);
        l.own_.uc_stack.ss_sp = l.stack_.get();
        l.own_.uc_stack.ss_size = EmulatedLane::kStack;
        l.own_.uc_link = &here_;
        l.out_ = &here_;
        const auto address = reinterpret_cast<uintptr_t>(&l);
        makecontext(&l.own_, reinterpret_cast<void (*)()>(&begin), 2, uint32_t(address >> 32), uint32_t(address));
        subgroups_.back().push_back(std::move(lane));
    }
    static void begin(uint32_t high, uint32_t low) {
        EmulatedLane& lane = *reinterpret_cast<EmulatedLane*>(uintptr_t(uint64_t(high) << 32 | low));
        lane.main();
        lane.ended_ = true;
    }
    std::string runAll() {
        for (;;) {
            std::vector<EmulatedLane*> ready;
            for (Lanes& lanes : subgroups_) {
                if (std::string wrong = answer(lanes); !wrong.empty()) return wrong;
                for (const auto& lane : lanes)
                    if (!lane->ended_ && !lane->waits_) ready.push_back(lane.get());
            }
            if (ready.empty()) return {};
            // Independent lanes: some of them run, in any order, before what they have asked for is looked at.
            if (order_.seed != 0) {
                std::shuffle(ready.begin(), ready.end(), random_);
                ready.resize(1 + random_() % ready.size());
            }
            for (EmulatedLane* lane : ready) swapcontext(&here_, &lane->own_);
        }
    }
    // Once all lanes of a subgroup that haven't ended wait.
    static std::string answer(Lanes& lanes) {
        std::vector<EmulatedLane*> waiting;
        for (const auto& lane : lanes) {
            if (lane->ended_) continue;
            if (!lane->waits_) return {};
            waiting.push_back(lane.get());
        }
        if (waiting.empty()) return {};
        uint32_t sum = 0, least = ~0u;
        for (const EmulatedLane* lane : waiting) {
            if (lane->ask_ != waiting[0]->ask_ || lane->asked_ != waiting[0]->asked_)
                return "lanes of a subgroup have come to different operations";
            sum += lane->value_;
            least = std::min(least, lane->value_);
        }
        for (EmulatedLane* lane : waiting) {
            lane->value_ = lane->ask_ == EmulatedLane::Ask::first ? least : sum;
            lane->waits_ = false;
        }
        return {};
    }

    LaneOrder order_;
    std::mt19937 random_;
    ucontext_t here_{};
    std::vector<Lanes> subgroups_;
};

}  // namespace espalier::test
