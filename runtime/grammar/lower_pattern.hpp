#pragma once

// The lowering of a grammar of patterns (lower_pattern.cpp says how productions are laid out): symbols and commands
// there, what places pieces in lower_pattern_pieces.cpp.

#include <span>
#include <vector>

#include "runtime/grammar/compilation.hpp"

namespace espalier::grammar {

class PatternLowering {
  public:
    explicit PatternLowering(Compilation& c) : c_(c), g_(c.graph) {
        for (uint32_t i = 0; i < kMaxArgs; ++i) args_[i] = g_.leaf(Leaf::slot, kSlotArg + i);
    }

    void run();

  private:
    struct Step {
        uint32_t kind;
        Node values[3];
        Place place;
    };
    // What stands in front of an element: commands, colour, the set that has to stand.
    struct State {
        std::vector<Step> chain;
        Node colour[3];
        uint32_t begin = kNoIndex;  // steps to where the next segment of a line begins; kNoIndex: there is no line
        bool merges = false;        // segments end at those that they cross
    };
    // The set that an element has tried to place, and what parts waited for before; kNoIndex: none.
    struct Trial {
        uint32_t before = kNoIndex, set = kNoIndex;
    };
    struct Production {
        std::vector<PatternPart> parts;
        uint32_t sets = 0, pieces = 0;
        uint32_t prereq = kNoIndex;
        uint32_t openSet = kNoIndex;  // of the Lock that goes on
        uint32_t inlined = 0;         // symbols put in place so far: each has draws of its own
    };

    void error(const Place& place, const Env& env, const std::string& message) {
        c_.reporter.error(place, env.rule, message);
    }
    void addRecord(Symbol& symbol);
    // Of its rules, the highest.
    uint32_t priorityOf(const Symbol& symbol);
    void lowerSymbol(const Symbol& symbol);
    RuleRecord store(const Production& production, const Place& place, const Env& env);
    void walk(const Sequence& sequence, Env& env, State& state, Production& production);
    void apply(const CommandInfo& info, const Element& e, Env& env, State& state, Production& production);
    // One number of S is a size in all directions, two leave the third; T moves by 0 where none is given.
    void step(uint32_t kind, const Element& e, Env& env, State& state);
    // Li 2011 names files, as "cylinder.obj": the mesh is meant, whatever its file.
    void piece(uint32_t kind, const Element& e, std::vector<Node> measures, Env& env, const State& state,
               Production& production);
    // A piece that goes into a like one: what stands behind it, or in its braces, is made where it doesn't.
    void merged(const CommandInfo& info, const Element& e, Env& env, const State& state, Production& production);
    // From where the line has come to so far to where the scope stands.
    void segment(const CommandInfo& info, const Element& e, Env& env, State& state, Production& production);
    // Segments between the braces hang on each other; what stands behind them doesn't hang on them.
    void line(const BlockInfo& info, const Element& e, Env& env, const State& state, Production& production);
    void lock(const BlockInfo& info, const Element& e, Env& env, State& state, Production& production);
    // What stands behind is made whether or not the piece is.
    void omit(const CommandInfo& info, const Element& e, Env& env, const Trial& last, Production& production);
    // What is made in a piece's place where it can't stand.
    void instead(const BlockInfo& info, const Element& e, Env& env, const Trial& last, const State& state,
                 Production& production);
    // The one rule of a symbol that only places a piece, with at most one symbol or mesh in it.
    const Rule* simpleRule(const Symbol& symbol) const;
    // Whether the symbol leads to one piece by simple rules alone.
    bool isSimple(const Symbol& symbol, uint32_t depth) const;
    void call(const Element& e, Env& env, State& state, Production& production);
    void putInPlace(const Symbol& symbol, const std::vector<Node>& given, const State& state, Production& production);
    PatternPart partOf(const State& state, const Production& production, const Place& place, const Env& env);
    void arguments(PatternPart& part, std::span<const Node> nodes, const Place& place, const Env& env);

    Compilation& c_;
    Graph& g_;
    Node args_[kMaxArgs];
};

}  // namespace espalier::grammar
