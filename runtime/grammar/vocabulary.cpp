// The tables of the language's words, and the hints made of them.
#include "runtime/grammar/vocabulary.hpp"

#include <algorithm>
#include <numeric>

#include "shaders/shared/rule_map.h"

namespace espalier::grammar {
namespace {

constexpr uint32_t kMany = kMaxSuccessors;

constexpr BlockInfo kBlocks[] = {
    {"Marching", Block::marching, 2, 3, 1, 2, "Marching(length, angle, condition) {TopSucc, ExtrudedSucc}"},
    {"Branch", Block::branch, 0, 1, 1, kMany, "Branch(n) {A, B, ...} with n successors"},
    {"Repeat", Block::repeat, 1, 1, 1, 1, "Repeat(n) {successors}"},
    {"Extrude", Block::later, 0, 16, 0, 64, ""},
    {"Join", Block::later, 0, 16, 0, 64, ""},
    {"Project", Block::later, 0, 16, 0, 64, ""},
    {"Split", Block::later, 0, 16, 0, 64, ""},
    {"Explode", Block::later, 0, 16, 0, 64, ""},
};

constexpr CommandInfo kCommands[] = {
    {"S", Command::size, 1, 1, "S(width)"},
    {"T", Command::translate, 1, 2, "T(along) or T(along, lift)"},
    {"R", Command::rotate, 1, 2, "R(turn) or R(turn, pitch)"},
    {"Tint", Command::tint, 1, 1, "Tint(0..1)"},
    {"Colour", Command::colour, 1, 3, "Colour(param) or Colour(r, g, b)"},
    {"Color", Command::colour, 1, 3, "Color(param) or Color(r, g, b)"},
    {"Shape", Command::shape, 1, 2, "Shape(\"mesh\") or Shape(\"mesh\", discontinuous|C0|C1)"},
    {"[", Command::push, 0, 0, "["},
    {"]", Command::pop, 0, 0, "]"},
    {"NULL", Command::null, 0, 0, "NULL"},
};

constexpr FunctionInfo kFunctions[] = {
    {"rand", Function::random, 0, 2, "rand() or rand(from, to)"},
    {"min", Function::minimum, 2, 2, "min(a, b)"},
    {"max", Function::maximum, 2, 2, "max(a, b)"},
    {"clamp", Function::clamp, 3, 3, "clamp(x, least, greatest)"},
    {"mix", Function::mix, 3, 3, "mix(a, b, t)"},
    {"abs", Function::absolute, 1, 1, "abs(x)"},
    {"floor", Function::floor, 1, 1, "floor(x)"},
    {"ceil", Function::ceil, 1, 1, "ceil(x)"},
    {"fract", Function::fract, 1, 1, "fract(x)"},
    {"sign", Function::sign, 1, 1, "sign(x)"},
    {"sqrt", Function::sqrt, 1, 1, "sqrt(x)"},
    {"sin", Function::sin, 1, 1, "sin(radians)"},
    {"cos", Function::cos, 1, 1, "cos(radians)"},
    {"pow", Function::power, 2, 2, "pow(x, whole number from 0 to 8)"},
    {"smoothstep", Function::smoothstep, 3, 3, "smoothstep(from, to, x)"},
    {"angleTo", Function::angleTo, 1, 3, "angleTo(up) or angleTo(x, y, z)"},
    {"facing", Function::facing, 1, 3, "facing(up) or facing(x, y, z)"},
    {"every", Function::every, 1, 1, "every(distance)"},
};

constexpr AccessorInfo kAccessors[] = {
    {"texCoord.x", kSlotTexCoord, Where::anywhere},
    {"texCoord.y", kSlotTexCoord + 1, Where::anywhere},
    {"normal.x", kSlotNormal, Where::anywhere},
    {"normal.y", kSlotNormal + 1, Where::anywhere},
    {"normal.z", kSlotNormal + 2, Where::anywhere},
    {"heading.x", kSlotHeading, Where::anywhere},
    {"heading.y", kSlotHeading + 1, Where::anywhere},
    {"heading.z", kSlotHeading + 2, Where::anywhere},
    {"position.x", kSlotPosition, Where::anywhere},
    {"position.y", kSlotPosition + 1, Where::anywhere},
    {"position.z", kSlotPosition + 2, Where::anywhere},
    {"curvature", kSlotCurvature, Where::anywhere},
    {"slope", kSlotSlope, Where::anywhere},
    {"height", kSlotHeight, Where::anywhere},
    {"depth", kSlotDepth, Where::anywhere},
    {"step", kSlotStep, Where::anywhere},
    {"arc", kSlotArc, Where::anywhere},
    {"branchLength", kSlotBranchLength, Where::onSpans},
    {"toTip", kSlotToTip, Where::onSpans},
    {"spanLength", kSlotSpanLength, Where::onSpans},
    {"radius", kSlotRadius, Where::onSpans},
    {"index", kSlotIndex, Where::inRepeat},
    {"count", kSlotCount, Where::inRepeat},
};

constexpr DirectionInfo kDirections[] = {
    {"up", 0, 1, 0}, {"down", 0, -1, 0}, {"east", 1, 0, 0}, {"west", -1, 0, 0}, {"south", 0, 0, 1}, {"north", 0, 0, -1},
};

constexpr std::string_view kOtherWords[] = {"pi",  "true",    "false",         "texCoord", "otherwise",
                                            "and", "or",      "not",           "param",    "context",
                                            "let", "include", "discontinuous", "C0",       "C1"};

template <class Row, size_t n>
const Row* findRow(const Row (&rows)[n], std::string_view name) {
    for (const Row& row : rows)
        if (row.name == name) return &row;
    return nullptr;
}

size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t(0));
    auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            size_t replace = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replace, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row[b.size()];
}

}  // namespace

const BlockInfo* findBlock(std::string_view name) {
    return findRow(kBlocks, name);
}
const CommandInfo* findCommand(std::string_view name) {
    return findRow(kCommands, name);
}
const FunctionInfo* findFunction(std::string_view name) {
    return findRow(kFunctions, name);
}
const AccessorInfo* findAccessor(std::string_view name) {
    return findRow(kAccessors, name);
}
const DirectionInfo* findDirection(std::string_view name) {
    return findRow(kDirections, name);
}

std::string reservedFor(std::string_view name) {
    std::string quoted = "'" + std::string(name) + "' ";
    if (findBlock(name) != nullptr) return quoted + "is the name of a rule kind";
    if (findCommand(name) != nullptr) return quoted + "is the name of a command";
    if (findFunction(name) != nullptr) return quoted + "is the name of a function";
    if (findDirection(name) != nullptr) return quoted + "is the name of a direction";
    bool word = std::find(std::begin(kOtherWords), std::end(kOtherWords), name) != std::end(kOtherWords);
    for (const AccessorInfo& a : kAccessors) word = word || a.name.substr(0, a.name.find('.')) == name;
    return word ? quoted + "is a word of the language" : std::string();
}

std::vector<std::string> functionNames() {
    std::vector<std::string> all;
    for (const FunctionInfo& f : kFunctions) all.emplace_back(f.name);
    return all;
}
std::vector<std::string> accessorNames() {
    std::vector<std::string> all = {"pi", "true", "false", "otherwise"};
    for (const AccessorInfo& a : kAccessors) all.emplace_back(a.name);
    return all;
}
std::vector<std::string> successorNames() {
    std::vector<std::string> all;
    for (const BlockInfo& b : kBlocks)
        if (b.kind != Block::later) all.emplace_back(b.name);
    for (const CommandInfo& c : kCommands) all.emplace_back(c.name);
    return all;
}

std::string didYouMean(std::string_view name, std::span<const std::string> candidates) {
    size_t best = name.size() < 4 ? 1 : name.size() < 9 ? 2 : 3;
    const std::string* nearest = nullptr;
    for (const std::string& candidate : candidates) {
        if (candidate.size() > name.size() + best || name.size() > candidate.size() + best) continue;
        if (name.size() < 2 || candidate == name) continue;
        size_t distance = editDistance(name, candidate);
        if (distance > best || (distance == best && nearest != nullptr)) continue;
        best = distance;
        nearest = &candidate;
    }
    return nearest == nullptr ? std::string() : " (did you mean '" + *nearest + "'?)";
}

uint32_t nameHash(std::string_view name) {
    uint32_t hash = 2166136261u;
    for (char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
    return hash;
}

}  // namespace espalier::grammar
