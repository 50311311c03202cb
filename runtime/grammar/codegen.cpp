// Graph nodes -> straight-line code: depth-first order, registers freed at their last use, products folded into
// sums (rounded twice, so that nothing changes), one immediate a word.
#include "runtime/grammar/codegen.hpp"

#include <algorithm>
#include <map>

namespace espalier::grammar {
namespace {

constexpr size_t kMaxCode = 60'000, kMaxUniforms = 4'000;

uint32_t inputBit(uint32_t slot) {
    if (slot == kSlotEaveStart) return kInputEaveStart;
    if (slot > kSlotOne && slot < kMachineSlots) return kInputOfRoofs;
    if (slot >= kSlotAngle && slot < kSlotAngle + kMaxDirections) return kInputAngle << (slot - kSlotAngle);
    if (slot >= kSlotTexCoord && slot < kSlotNormal) return kInputTexCoord;
    if (slot >= kSlotNormal && slot < kSlotHeading) return kInputNormal;
    if (slot >= kSlotHeading && slot < kSlotPosition) return kInputHeading;
    if (slot >= kSlotPosition && slot < kSlotCurvature) return kInputPosition;
    switch (slot) {
        case kSlotCurvature:
            return kInputCurvature;
        case kSlotSlope:
            return kInputSlope;
        case kSlotHeight:
            return kInputHeight;
        case kSlotDepth:
            return kInputDepth;
        case kSlotStep:
            return kInputStep;
        case kSlotArc:
            return kInputArc;
        case kSlotBranchLength:
        case kSlotToTip:
            return kInputBranchLength;
        case kSlotSpanLength:
            return kInputSpanLength;
        case kSlotRadius:
            return kInputRadius;
        default:
            return 0;
    }
}
// A plant's Repeat sets these by itself.
bool isOfRepeat(uint32_t slot) {
    return slot == kSlotIndex || slot == kSlotCount;
}

// One run of code. `uniformMode`: for the host, parameters are slots.
class Emitter {
  public:
    Emitter(Graph& graph, CodeGenerator& all, std::vector<CodeWord>& out, StageReads& sites, StageReads& reads,
            bool uniformMode)
        : graph_(graph), all_(all), out_(out), sites_(sites), reads_(reads), uniformMode_(uniformMode) {}

    std::string error;

    void run(std::span<const Node> roots, std::span<Value> values) {
        for (Node root : roots) count(root);
        for (size_t i = 0; i < roots.size() && error.empty(); ++i) values[i] = value(roots[i]);
    }

  private:
    bool isOperation(Node n) const {
        const GraphNode& g = graph_[n];
        return g.leaf == Leaf::operation && (uniformMode_ || !g.uniform);
    }
    // A product that only one sum needs, to be computed with it.
    bool foldsInto(Node product, const GraphNode& sum) const {
        return sum.op == kOpAdd && isOperation(product) && graph_[product].op == kOpMul && uses_.at(product) == 1 &&
               registers_.find(product) == registers_.end();
    }
    void count(Node n) {
        if (!isOperation(n)) return;
        if (++uses_[n] > 1) return;
        const GraphNode& g = graph_[n];
        std::vector<uint32_t> needs;
        for (uint32_t i = 0; i < g.kidCount; ++i) {
            count(g.kids[i]);
            needs.push_back(needOf(g.kids[i]));
        }
        std::sort(needs.rbegin(), needs.rend());
        uint32_t need = 1;
        for (uint32_t i = 0; i < needs.size(); ++i) need = std::max(need, needs[i] + i);
        needs_[n] = need;
    }
    // Registers that a node's code takes, about (Sethi and Ullman's number, shared nodes aside).
    uint32_t needOf(Node n) const {
        auto found = needs_.find(n);
        return found == needs_.end() ? 0 : found->second;
    }
    void release(Node n) {
        if (!isOperation(n) || --uses_[n] > 0) return;
        auto found = registers_.find(n);
        if (found != registers_.end()) used_[found->second] = false;
    }
    uint32_t allocate() {
        for (uint32_t r = 0; r < kRegisters; ++r)
            if (!used_[r]) {
                used_[r] = true;
                return r;
            }
        error = "the expressions of this rule need more than 16 registers; split it into several rules";
        return 0;
    }

    Value value(Node n) {
        const GraphNode& g = graph_[n];
        if (g.leaf == Leaf::constant) return {kSlotImmediate, g.value};
        if (g.uniform && !uniformMode_) {
            reads_.params |= g.params;
            return all_.uniform(n);
        }
        if (g.leaf == Leaf::mistake) return {kSlotZero, 0};  // of a map that is refused
        if (g.leaf == Leaf::param) return {kSlotParam + g.op, 0};
        if (g.leaf == Leaf::draw) return {kSlotDraw + drawSlot(g.op), 0};
        if (g.leaf == Leaf::slot) {
            noteSlot(g.op);
            reads_.params |= g.params;
            return {g.op, 0};
        }
        auto found = registers_.find(n);
        if (found != registers_.end()) return {found->second, 0};
        return {emit(n), 0};
    }
    void noteSlot(uint32_t slot) {
        if (all_.queries != nullptr && slot >= kSlotQuery && slot < kSlotQuery + kMaxQueries)
            reads_.inputs |= kInputFields | (queryOfSlope((*all_.queries)[slot - kSlotQuery]) ? kInputSlopes : 0);
        else
            reads_.inputs |= all_.roofs && isOfRepeat(slot) ? kInputOfRoofs : inputBit(slot);
        if (slot >= kSlotLayer && slot < kSlotLayer + kMaxLayers) reads_.layers |= 1u << (slot - kSlotLayer);
        if (slot >= kSlotArg && slot < kSlotArg + kMaxArgs) reads_.args |= 1u << (slot - kSlotArg);
    }
    uint32_t drawSlot(uint32_t site) {
        auto found = std::find(sites_.sites.begin(), sites_.sites.end(), site);
        if (found != sites_.sites.end()) return static_cast<uint32_t>(found - sites_.sites.begin());
        if (sites_.sites.size() >= kMaxDraws) {
            error = "more than 8 random numbers in one rule; split it into several rules";
            return 0;
        }
        sites_.sites.push_back(site);
        return static_cast<uint32_t>(sites_.sites.size() - 1);
    }

    uint32_t emit(Node n) {
        const GraphNode& g = graph_[n];
        uint32_t op = g.op;
        Node kids[3] = {g.kids[0], g.kids[1], g.kids[2]};
        uint32_t kidCount = g.kidCount;
        Node product = Graph::kNone;
        if (foldsInto(g.kids[0], g) || (kidCount > 1 && foldsInto(g.kids[1], g))) {
            bool first = foldsInto(g.kids[0], g);
            product = g.kids[first ? 0 : 1];
            Node other = g.kids[first ? 1 : 0];
            op = kOpMulAdd;
            kids[0] = graph_[product].kids[0];
            kids[1] = graph_[product].kids[1];
            kids[2] = other;
            kidCount = 3;
        }
        // The neediest first, while all registers are free.
        Value values[3] = {{kSlotZero, 0}, {kSlotZero, 0}, {kSlotZero, 0}};
        uint32_t order[3] = {0, 1, 2};
        std::stable_sort(order, order + kidCount,
                         [&](uint32_t i, uint32_t j) { return needOf(kids[i]) > needOf(kids[j]); });
        for (uint32_t i = 0; i < kidCount; ++i) values[order[i]] = value(kids[order[i]]);
        return finish(n, op, kids, kidCount, values, product);
    }

    static bool isImmediate(const Value& v) { return v.slot == kSlotImmediate || v.slot >= kSlotUniform; }
    // Zero and one have slots; the first other constant is the word's; further ones are moved to registers.
    uint32_t finish(Node n, uint32_t op, const Node* kids, uint32_t kidCount, Value* values, Node product) {
        const Value* immediate = nullptr;
        uint32_t temporaries[3];
        uint32_t temporaryCount = 0;
        for (uint32_t i = 0; i < kidCount; ++i) {
            Value& v = values[i];
            if (v.slot == kSlotImmediate && v.immediate == 0.0f) v = {kSlotZero, 0};
            if (v.slot == kSlotImmediate && v.immediate == 1.0f) v = {kSlotOne, 0};
            if (!isImmediate(v)) continue;
            if (immediate == nullptr) {
                immediate = &v;
            } else if (immediate->slot != v.slot ||
                       floatBitsToUint(immediate->immediate) != floatBitsToUint(v.immediate)) {
                uint32_t r = allocate();
                word(kOpMove, r, v, {kSlotZero, 0}, {kSlotZero, 0}, &v);
                v = {r, 0};
                temporaries[temporaryCount++] = r;
            }
        }
        Value constant = immediate != nullptr ? *immediate : Value{kSlotZero, 0};
        for (uint32_t i = 0; i < kidCount; ++i) release(kids[i]);
        if (product != Graph::kNone) --uses_[product];
        for (uint32_t i = 0; i < temporaryCount; ++i) used_[temporaries[i]] = false;
        uint32_t r = allocate();
        word(op, r, values[0], values[1], values[2], immediate != nullptr ? &constant : nullptr);
        registers_[n] = r;
        return r;
    }
    void word(uint32_t op, uint32_t destination, Value x, Value y, Value z, const Value* immediate) {
        auto slot = [](const Value& v) { return isImmediate(v) ? kSlotImmediate : v.slot; };
        CodeWord w;
        w.bits = op | (destination << 5u) | (slot(x) << 9u) | (slot(y) << 16u) | (slot(z) << 23u);
        w.immediate = immediate != nullptr ? immediate->immediate : 0.0f;
        if (immediate != nullptr && immediate->slot >= kSlotUniform)
            all_.codePatches.emplace_back(static_cast<uint32_t>(out_.size()), immediate->slot - kSlotUniform);
        if (out_.size() >= kMaxCode)
            error = "the grammar is too long: more than 60,000 operations";
        else
            out_.push_back(w);
    }

    Graph& graph_;
    CodeGenerator& all_;
    std::vector<CodeWord>& out_;
    StageReads& sites_;
    StageReads& reads_;
    bool uniformMode_;
    std::map<Node, uint32_t> uses_, registers_, needs_;
    bool used_[kRegisters] = {};
};

}  // namespace

std::string CodeGenerator::generate(std::span<const Node> roots, StageReads& sites, StageReads& reads, CodeRange& range,
                                    std::span<Value> values) {
    uint32_t first = static_cast<uint32_t>(code.size());
    Emitter emitter(graph_, *this, code, sites, reads, false);
    emitter.run(roots, values);
    range = {first, static_cast<uint32_t>(code.size()) - first};
    return emitter.error.empty() ? failure : emitter.error;
}

Value CodeGenerator::uniform(Node node) {
    auto found = std::find(uniformNodes.begin(), uniformNodes.end(), node);
    uint32_t index = static_cast<uint32_t>(found - uniformNodes.begin());
    if (found == uniformNodes.end() && uniforms.size() == kMaxUniforms) {
        failure = "the grammar computes more than 4,000 values from parameters alone";
        return {kSlotUniform, 0};  // of the map that is refused
    }
    if (found == uniformNodes.end()) {
        StageReads reads;
        UniformRecord record;
        uint32_t first = static_cast<uint32_t>(uniformCode.size());
        Emitter emitter(graph_, *this, uniformCode, reads, reads, true);
        emitter.run({&node, 1}, {&record.value, 1});
        record.code = {first, static_cast<uint32_t>(uniformCode.size()) - first};
        if (failure.empty()) failure = emitter.error;
        uniforms.push_back(record);
        uniformNodes.push_back(node);
    }
    return {kSlotUniform + index, 0};
}

}  // namespace espalier::grammar
