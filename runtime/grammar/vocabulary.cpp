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
    {"Lock", Block::lock, 0, 0, 1, kMaxPieces, "Lock {Piece | Piece | ...}"},
    {"Line", Block::line, 0, 1, 1, 1, "Line(merge) {successors} or Line {successors}"},
    {"else", Block::instead, 0, 0, 1, 1, "else {successors} behind IC, Lock or a symbol that places one mesh"},
    {"Extrude", Block::extrude, 1, 1, 1, 2, "Extrude(height) {Face, Top}"},
    {"Join", Block::join, 3, 3, 1, 3, "Join(height, v1, v2) {Clipped, Support, Top}"},
    {"Project", Block::project, 2, 2, 1, 1, "Project(axis1, axis2) {Projected}"},
    {"Explode", Block::explode, 0, 0, 1, 5, "Explode() {Face, Front, Right, Back, Left}"},
    {"Split", Block::split, 2, 15, 1, 14,
     "Split(X or Y, size, size, ...) {Part, Part, ...} with as many parts as sizes"},
};

constexpr CommandInfo kCommands[] = {
    {"S", Command::size, 1, 1, "S(width)"},
    {"T", Command::translate, 1, 2, "T(along) or T(along, lift)"},
    {"R", Command::rotate, 1, 2, "R(turn) or R(turn, pitch)"},
    {"Rx", Command::rotateX, 1, 1, "Rx(angle)"},
    {"Ry", Command::rotateY, 1, 1, "Ry(angle)"},
    {"Rz", Command::rotateZ, 1, 1, "Rz(angle)"},
    {"RX", Command::rotateX, 1, 1, "RX(angle)"},
    {"RY", Command::rotateY, 1, 1, "RY(angle)"},
    {"RZ", Command::rotateZ, 1, 1, "RZ(angle)"},
    {"RS", Command::rotateZ, 1, 1, "RS(angle)"},
    {"I", Command::place, 1, 1, "I(\"mesh\")"},
    {"IC", Command::placeTested, 1, 1, "IC(\"mesh\")"},
    {"IM", Command::placeMerged, 3, 3, "IM(\"mesh\", distance, turn)"},
    {"LineSeg", Command::lineSegment, 2, 2, "LineSeg(\"mesh\", width) between the braces of a Line"},
    {"omit", Command::omit, 0, 0, "omit behind IC, Lock or a symbol that places one mesh"},
    {"Tint", Command::tint, 1, 1, "Tint(0..1)"},
    {"Colour", Command::colour, 1, 3, "Colour(param) or Colour(r, g, b)"},
    {"Color", Command::colour, 1, 3, "Color(param) or Color(r, g, b)"},
    {"Drop", Command::drop, 1, 1, "Drop(layer), in grammars of roofs"},
    {"Moss", Command::moss, 1, 1, "Moss(layer), in grammars of roofs"},
    {"Shape", Command::shape, 1, 2, "Shape(\"mesh\") or Shape(\"mesh\", discontinuous|C0|C1)"},
    {"[", Command::push, 0, 0, "["},
    {"]", Command::pop, 0, 0, "]"},
    {"NULL", Command::null, 0, 0, "NULL"},
};

constexpr FunctionInfo kFunctions[] = {
    {"rand", Function::random, 0, 2, "rand() or rand(from, to)"},
    {"Rand", Function::random, 0, 2, "Rand() or Rand(from, to)"},
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

// Of grammars of roofs. A vector's name without its part stands for the whole where a vector is wanted.
constexpr AccessorInfo kRoofAccessors[] = {
    {"currentPos0.x", kSlotPos0, Where::onRoofs},
    {"currentPos0.y", kSlotPos0 + 1, Where::onRoofs},
    {"currentPos0.z", kSlotPos0 + 2, Where::onRoofs},
    {"currentPos1.x", kSlotPos1, Where::onRoofs},
    {"currentPos1.y", kSlotPos1 + 1, Where::onRoofs},
    {"currentPos1.z", kSlotPos1 + 2, Where::onRoofs},
    {"localNormal.x", kSlotLocalNormal, Where::onRoofs},
    {"localNormal.y", kSlotLocalNormal + 1, Where::onRoofs},
    {"localNormal.z", kSlotLocalNormal + 2, Where::onRoofs},
    {"localTangent.x", kSlotLocalTangent, Where::onRoofs},
    {"localTangent.y", kSlotLocalTangent + 1, Where::onRoofs},
    {"localTangent.z", kSlotLocalTangent + 2, Where::onRoofs},
    {"globalTangent.x", kSlotEaveTangent, Where::onRoofs},
    {"globalTangent.y", kSlotEaveTangent + 1, Where::onRoofs},
    {"globalTangent.z", kSlotEaveTangent + 2, Where::onRoofs},
    {"roofPos1.x", kSlotRoofPos1, Where::onRoofs},
    {"roofPos1.y", kSlotRoofPos1 + 1, Where::onRoofs},
    {"roofPos1.z", kSlotRoofPos1 + 2, Where::onRoofs},
    {"roofPos2.x", kSlotRoofPos2, Where::onRoofs},
    {"roofPos2.y", kSlotRoofPos2 + 1, Where::onRoofs},
    {"roofPos2.z", kSlotRoofPos2 + 2, Where::onRoofs},
    {"roofHeight", kSlotRoofHeight, Where::onRoofs},
    {"roofSlope", kSlotRoofSlope, Where::onRoofs},
    {"projectHeight", kSlotProjectHeight, Where::onRoofs},
    {"projectionHeight", kSlotProjectHeight, Where::onRoofs},
    {"fold", kSlotProjectHeight, Where::onRoofs},
    {"sizeX", kSlotSizeX, Where::onRoofs},
    {"sizeY", kSlotSizeY, Where::onRoofs},
    {"eaveStart", kSlotEaveStart, Where::onRoofs},
    {"eaveLength", kSlotEaveLength, Where::onRoofs},
    {"joint", kSlotJoint, Where::onRoofs},
    {"owner", kSlotOwner, Where::onRoofs},
    {"faceKind", kSlotFaceKind, Where::onRoofs},
    {"tier", kSlotTier, Where::onRoofs},
    {"wallHeight", kSlotWallHeight, Where::onRoofs},
    {"houseRandom", kSlotHouseRandom, Where::onRoofs},
    {"houseShape", kSlotHouseShape, Where::onRoofs},
    {"houseMaterial", kSlotHouseMaterial, Where::onRoofs},
    {"houseColour.r", kSlotHouseColour, Where::onRoofs},
    {"houseColour.g", kSlotHouseColour + 1, Where::onRoofs},
    {"houseColour.b", kSlotHouseColour + 2, Where::onRoofs},
    {"houseTinted", kSlotHouseTinted, Where::onRoofs},
    {"houseOverhang", kSlotHouseOverhang, Where::onRoofs},
    {"houseChimneys", kSlotHouseChimneys, Where::onRoofs},
    {"houseOpen", kSlotHouseOpen, Where::onRoofs},
    {"wallShared", kSlotWallShared, Where::onRoofs},
    {"cornerStart", kSlotCorners, Where::onRoofs},
    {"cornerEnd", kSlotCorners + 1, Where::onRoofs},
    {"index", kSlotIndex, Where::onRoofs},
    {"count", kSlotCount, Where::onRoofs},
};

// As RoofShape, FaceKind and JointKind of runtime/roof/structure.hpp count them (joints from 1; a test compares them).
constexpr struct {
    std::string_view name;
    float value;
} kRoofWords[] = {
    {"slopeFace", 0}, {"gableFace", 1},   {"flatFace", 2},    {"wallFace", 3},    {"hip", 1},
    {"valley", 2},    {"ridge", 3},       {"verge", 4},       {"breakLine", 5},   {"border", 6},
    {"cut", 7},       {"hipRoof", 0},     {"gableRoof", 1},   {"halfHipRoof", 2}, {"pyramidRoof", 3},
    {"shedRoof", 4},  {"gambrelRoof", 5}, {"mansardRoof", 6}, {"flatRoof", 7},
};

// Some have the names of Li 2011 §4.3, too.
constexpr QueryInfo kQueryWords[] = {
    {"value1", Asked::value, 0},
    {"value2", Asked::value, 1},
    {"length1", Asked::value, 0},
    {"length2", Asked::value, 1},
    {"maxcurv", Asked::value, 0},
    {"mincurv", Asked::value, 1},
    {"Xangle1", Asked::angle, 0},
    {"Xangle2", Asked::angle, 1},
    {"sure", Asked::sure},
    {"vector1.x", Asked::vector, 0, 0},
    {"vector1.y", Asked::vector, 0, 1},
    {"vector2.x", Asked::vector, 1, 0},
    {"vector2.y", Asked::vector, 1, 1},
    {"gradient1.x", Asked::gradient, 0, 0},
    {"gradient1.y", Asked::gradient, 0, 1},
    {"gradient2.x", Asked::gradient, 1, 0},
    {"gradient2.y", Asked::gradient, 1, 1},
    {"turn.x", Asked::turn, 0, 0},
    {"turn.y", Asked::turn, 0, 1},
    {"jacobian1.xx", Asked::jacobian, 0, 0, 0},
    {"jacobian1.xy", Asked::jacobian, 0, 0, 1},
    {"jacobian1.yx", Asked::jacobian, 0, 1, 0},
    {"jacobian1.yy", Asked::jacobian, 0, 1, 1},
    {"jacobian2.xx", Asked::jacobian, 1, 0, 0},
    {"jacobian2.xy", Asked::jacobian, 1, 0, 1},
    {"jacobian2.yx", Asked::jacobian, 1, 1, 0},
    {"jacobian2.yy", Asked::jacobian, 1, 1, 1},
    {"divergence1", Asked::divergence, 0},
    {"divergence2", Asked::divergence, 1},
    {"curl1", Asked::curl, 0},
    {"curl2", Asked::curl, 1},
};

constexpr RelationInfo kRelations[] = {
    {"angleTo", Relation::angle, "flow.angleTo(lie), of two fields"},
    {"gradient1Along", Relation::gradient1, "flow.gradient1Along(lie), of two fields"},
    {"gradient2Along", Relation::gradient2, "flow.gradient2Along(lie), of two fields"},
    {"turnAlong", Relation::turn, "flow.turnAlong(lie), of two fields"},
};

constexpr DirectionInfo kDirections[] = {
    {"up", 0, 1, 0}, {"down", 0, -1, 0}, {"east", 1, 0, 0}, {"west", -1, 0, 0}, {"south", 0, 0, 1}, {"north", 0, 0, -1},
};

constexpr std::string_view kOtherWords[] = {"pi",    "true",          "false", "texCoord", "otherwise", "and",
                                            "or",    "not",           "param", "context",  "let",       "include",
                                            "field", "discontinuous", "C0",    "C1"};

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
const AccessorInfo* findRoofAccessor(std::string_view name) {
    return findRow(kRoofAccessors, name);
}
const float* findRoofWord(std::string_view name) {
    const auto* row = findRow(kRoofWords, name);
    return row != nullptr ? &row->value : nullptr;
}
const QueryInfo* findQuery(std::string_view name) {
    return findRow(kQueryWords, name);
}
const RelationInfo* findRelation(std::string_view name) {
    return findRow(kRelations, name);
}
std::vector<std::string> queryNames() {
    std::vector<std::string> all;
    for (const auto& q : kQueryWords) all.emplace_back(q.name);
    return all;
}
const DirectionInfo* findDirection(std::string_view name) {
    return findRow(kDirections, name);
}

const BlockInfo* findBlock(const Element& element) {
    const BlockInfo* block = findBlock(element.name);
    return block != nullptr && block->kind == Block::line && !element.hasItems ? nullptr : block;
}

namespace {

std::vector<WordInfo> gatherWords(GrammarKind kind) {
    const bool roofs = kind == GrammarKind::roofs, patterns = kind == GrammarKind::patterns;
    std::vector<WordInfo> words;
    for (const BlockInfo& b : kBlocks) {
        const bool marches = b.kind == Block::marching || b.kind == Block::branch;
        if (marches ? !roofs && !patterns : isOfPatterns(b.kind) ? patterns : b.kind == Block::repeat || roofs)
            words.push_back({b.name, b.usage});
    }
    for (const CommandInfo& c : kCommands) {
        const bool ofRoofs = c.kind == Command::drop || c.kind == Command::moss;
        if (c.name.size() > 1 || (c.name[0] != '[' && c.name[0] != ']'))
            if (ofRoofs ? roofs : !isOfPatterns(c.kind) || patterns) words.push_back({c.name, c.usage});
    }
    for (const FunctionInfo& f : kFunctions) words.push_back({f.name, f.usage});
    if (roofs) {
        for (const AccessorInfo& a : kRoofAccessors) words.push_back({a.name, {}});
        for (const auto& word : kRoofWords) words.push_back({word.name, {}});
    } else {
        for (const AccessorInfo& a : kAccessors) words.push_back({a.name, {}});
    }
    if (patterns) {
        for (const QueryInfo& query : kQueryWords) words.push_back({query.name, {}});
        for (const RelationInfo& relation : kRelations)
            if (findFunction(relation.name) == nullptr) words.push_back({relation.name, relation.usage});
    }
    for (const DirectionInfo& d : kDirections) words.push_back({d.name, {}});
    for (const std::string_view word : kOtherWords)
        if (word != "field" || patterns) words.push_back({word, {}});
    return words;
}

}  // namespace

const std::vector<WordInfo>& wordsOf(GrammarKind kind) {
    static const std::vector<WordInfo> all[] = {gatherWords(GrammarKind::plants), gatherWords(GrammarKind::roofs),
                                                gatherWords(GrammarKind::patterns)};
    return all[size_t(kind)];
}

std::string reservedFor(std::string_view name) {
    std::string quoted = "'" + std::string(name) + "' ";
    const BlockInfo* block = findBlock(name);
    if (block != nullptr && block->kind != Block::line) return quoted + "is the name of a rule kind";
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
std::vector<std::string> roofAccessorNames() {
    std::vector<std::string> all = {"pi", "true", "false", "otherwise"};
    for (const AccessorInfo& a : kRoofAccessors) all.emplace_back(a.name);
    for (const auto& w : kRoofWords) all.emplace_back(w.name);
    return all;
}
std::vector<std::string> successorNames() {
    std::vector<std::string> all;
    for (const BlockInfo& b : kBlocks) all.emplace_back(b.name);
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
