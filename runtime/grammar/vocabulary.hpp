#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/grammar/ast.hpp"
#include "runtime/grammar/grammar.hpp"

// The words of the language, as tables. A new rule kind, command, function or accessor is a row here and a case in
// the lowering; lexer and parser stay as they are.
namespace espalier::grammar {

enum class Block : uint8_t { marching, branch, repeat, lock, line, instead, extrude, join, project, explode, split };
// Kinds that only grammars of patterns have.
inline bool isOfPatterns(Block kind) {
    return kind == Block::lock || kind == Block::line || kind == Block::instead;
}
// Kinds that make a grammar one of roofs; Repeat with an axis does so too.
inline bool isRoofBlock(Block kind) {
    return kind >= Block::extrude;
}
// Name(args) {items}
struct BlockInfo {
    std::string_view name;
    Block kind;
    uint32_t minArgs, maxArgs, minItems, maxItems;
    std::string_view usage;
};
const BlockInfo* findBlock(std::string_view name);
// Of what stands in a production. A Line without braces is a symbol of the grammar's own, as in older ones of roofs.
const BlockInfo* findBlock(const Element& element);

enum class Command : uint8_t {
    size,
    translate,
    rotate,
    rotateX,
    rotateY,
    rotateZ,
    tint,
    colour,
    drop,
    moss,
    shape,
    place,
    placeTested,
    placeMerged,
    lineSegment,
    omit,
    push,
    pop,
    null
};
// Commands that only grammars of patterns have.
inline bool isOfPatterns(Command kind) {
    return kind == Command::rotateX || kind == Command::rotateY || kind == Command::rotateZ || kind == Command::place ||
           kind == Command::placeTested || kind == Command::placeMerged || kind == Command::lineSegment ||
           kind == Command::omit;
}
struct CommandInfo {
    std::string_view name;
    Command kind;
    uint32_t minArgs, maxArgs;
    std::string_view usage;
};
const CommandInfo* findCommand(std::string_view name);

enum class Function : uint8_t {
    random,
    minimum,
    maximum,
    clamp,
    mix,
    absolute,
    floor,
    ceil,
    fract,
    sign,
    sqrt,
    sin,
    cos,
    power,
    smoothstep,
    angleTo,
    facing,
    every
};
struct FunctionInfo {
    std::string_view name;
    Function kind;
    uint32_t minArgs, maxArgs;
    std::string_view usage;
};
const FunctionInfo* findFunction(std::string_view name);

enum class Where : uint8_t { anywhere, onSpans, inRepeat, onRoofs };
struct AccessorInfo {
    std::string_view name;
    uint32_t slot;
    Where where;
};
const AccessorInfo* findAccessor(std::string_view name);
// Likewise in grammars of roofs, where slots hold other things.
const AccessorInfo* findRoofAccessor(std::string_view name);
// Words that stand for a number there: joint == ridge.
const float* findRoofWord(std::string_view name);

struct DirectionInfo {
    std::string_view name;
    float x, y, z;
};
const DirectionInfo* findDirection(std::string_view name);

// A name that declarations and rules may not take, and why; empty if free.
std::string reservedFor(std::string_view name);

// What F.name asks of a field F. `which` of its two directions or values, 0 or 1; of vectors and what is asked for each
// axis the `row`, of a Jacobian the `column`: 0 along the scope's x axis, 1 to its left.
enum class Asked { value, angle, sure, vector, gradient, turn, jacobian, divergence, curl };
struct QueryInfo {
    std::string_view name;
    Asked asked;
    uint32_t which = 0, row = 0, column = 0;
};
const QueryInfo* findQuery(std::string_view name);
std::vector<std::string> queryNames();

// What F.name(G) says of two fields: the least angle from F to G, or how F changes along G.
enum class Relation { angle, gradient1, gradient2, turn };
struct RelationInfo {
    std::string_view name;
    Relation relation;
    std::string_view usage;
};
const RelationInfo* findRelation(std::string_view name);

// A word for who writes a grammar of a kind, and how it is written; the texts end in zeros and stay.
struct WordInfo {
    std::string_view name, usage;  // usage: may be empty
};
const std::vector<WordInfo>& wordsOf(GrammarKind kind);

std::vector<std::string> functionNames();
std::vector<std::string> accessorNames();
std::vector<std::string> roofAccessorNames();
std::vector<std::string> successorNames();  // blocks and commands

// " (did you mean 'x'?)" for the candidate nearest to `name`, or nothing if none is near.
std::string didYouMean(std::string_view name, std::span<const std::string> candidates);

// FNV-1a, 32 bits: how names enter keys.
uint32_t nameHash(std::string_view name);

}  // namespace espalier::grammar
