// In: lists of stages. Out: what they leave in memory, and what of it was asked for. Barriers follow from what the
// stages read and write (hazards.hpp).
#include "runtime/run/runner.hpp"

namespace espalier {
namespace {

// Of what is read back, so that the next begins where any record may.
uint64_t roomOf(uint64_t bytes) {
    return (bytes + 15) / 16 * 16;
}

}  // namespace

Runner::Runner(Device& device, const char* name) : device_(device), name_(name), programs_(device) {}

void Runner::trim(uint64_t laneBytes) {
    if (lanes_.size() > laneBytes) lanes_ = {};
}

Result<Run> Run::begin(Runner& runner, std::string_view name, bool atOnce) {
    Run run(runner, atOnce);
    Result<Commands> commands = Commands::begin(runner.device_, name);
    if (!commands) return commands.failure();
    run.commands_.emplace(std::move(*commands));
    return run;
}

Commands& Run::send() {
    require(commands_.has_value(), "what stages read is sent before they run");
    hazards_.sent();
    return *commands_;
}

void Run::sendToKernels(const Buffer& from, const Buffer& to, uint64_t bytes) {
    if (!atOnce_) send().copy(from, to, bytes);
}

Status Run::prepare(const StageList& list) {
    if (atOnce_) return Done{};
    if (Status made = makeReadback(); !made) return made;
    uint64_t lanes = 0;
    for (const Stage& stage : list) {
        lanes = std::max(lanes, stage.laneBytes);
        if (auto made = runner_.programs_.of(stage.kernel, stage.constants); !made) return made.failure();
    }
    if (runner_.lanes_.size() >= lanes) return Done{};
    runner_.lanes_ = {};  // before the new one, for which there may be no room beside it
    return makeAtLeast(runner_.device_, runner_.lanes_, runner_.name_ + " lanes", lanes);
}

Status Run::add(StageList list, GrowthWatch* watch) {
    if (Status ready = prepare(list); !ready) return ready;
    if (!atOnce_) {
        std::optional<Pass> pass;
        for (size_t i = 0; i < list.size(); i += list[i].together)
            if (Status s = record({&list[i], list[i].together}, pass); !s) return s;
        return Done{};
    }
    if (commands_) {
        Status sent = commands_->finish();
        commands_.reset();
        if (!sent) return sent;
    }
    if (!runner_.host_.run(list, watch, &times_)) return stoppedFailure();
    return Done{};
}

// Stages that run together in each wave: usually one.
Status Run::record(std::span<Stage> group, std::optional<Pass>& pass) {
    const bool follows = pass && std::string_view(passes_.back()) == group[0].pass;
    if (!follows) {
        pass.reset();  // ends before the next one begins
        pass.emplace(*commands_, group[0].pass);
        passes_.push_back(group[0].pass);
    }
    for (uint32_t wave = group[0].firstWave; wave < group[0].lastWave; ++wave)
        for (Stage& stage : group)
            if (Status s = recordOnce(stage, wave, *pass); !s) return s;
    return Done{};
}

Status Run::recordOnce(Stage& stage, uint32_t wave, Pass& pass) {
    Result<const Program*> program = runner_.programs_.of(stage.kernel, stage.constants);
    if (!program) return program.failure();
    if (stage.turn) stage.turn(stage, wave);
    std::vector<Binding> bindings = stage.bindings;
    if (stage.laneBytes > 0) bindings.emplace_back(runner_.lanes_);
    const Push push(stage.push.data(), stage.push.size());
    for (uint32_t round = 0; round < stage.rounds; ++round) {
        const Hazards::Wait wait = hazards_.add(stage.kernel, stage.groups);
        if (wait.any) pass.barrier(wait.before, Hazards::kAfter);
        if (stage.groups.from)
            pass.dispatchIndirect(**program, *stage.groups.from, stage.groups.offset, push, bindings);
        else
            pass.dispatch(**program, stage.groups.count, push, bindings);
        ++dispatches_;
    }
    return Done{};
}

void Run::readBack(const Buffer& from, uint64_t bytes) {
    got_.push_back({&from, bytes, from.mapped()});
}

Status Run::makeReadback() {
    uint64_t bytes = 0;
    for (const Got& got : got_) bytes += roomOf(got.bytes);
    return makeAtLeast(runner_.device_, runner_.readback_, runner_.name_ + " readback", bytes, BufferUse::readback);
}

// Copies what was asked for, one behind the other.
Status Run::collect() {
    if (Status made = makeReadback(); !made) return made;
    commands_->barrier(Use::compute | Use::transfer, Use::transfer);
    uint64_t at = 0;
    for (Got& got : got_) {
        if (got.bytes > 0) commands_->copy(*got.from, runner_.readback_, got.bytes, 0, at);
        got.memory = runner_.readback_.mapped() + at;
        at += roomOf(got.bytes);
    }
    commands_->barrier(Use::transfer, Use::host);
    return Done{};
}

Status Run::finish() {
    if (!commands_) return Done{};  // native code has run
    if (!atOnce_ && !got_.empty())
        if (Status s = collect(); !s) return s;
    if (Status finished = commands_->finish(); !finished) return finished;
    runner_.device_.collect();
    for (const char* pass : passes_) times_[pass] = runner_.device_.milliseconds(pass);
    return Done{};
}

}  // namespace espalier
