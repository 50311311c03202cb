// The rule map: what a grammar compiles to (runtime/grammar writes it, expand and emit read it).
//
// How a shape is derived (Buron 2015 §5, §7), all code being straight-line (interpreter.h):
//   1. symbol = symbols[shape.symbol]. Draw its sites, give it its inputs (both below), run `select`; the rule is
//      firstRule + selected, or none (selected < 0: the shape vanishes). ruleCount 0 vanishes too.
//   2. rule kind March: draw the rule's sites, run `start` at the place where the shape stands -> distance, angle.
//      Turn, step; at the destination (or at a candidate's) give the rule's arrive inputs, run `arrive`; the step
//      is made if holds(condition). The node is recorded with extrudes[rule.extrude - 1] to draw on its span
//      (0: nothing). Then the successors, of which there is at most one (Top; its `args` stage is part of `arrive`,
//      so its own code range is empty), whose arguments are read from the machine directly after `arrive`.
//      rule kind List: draw the rule's sites, give it its start inputs, then for each successor run its code and
//      read its arguments. The one marked kSuccessorContinues carries the branch on (same walk, same branch);
//      each other begins a branch at the same place (depth + 1, step 0, arc 0). At most one is marked.
//      rule kind Null: the branch ends.
//   3. successor's key = childKey(shape's key, nameHash, ordinal).
//   4. Second pass, for the span of a recorded node: per terminal of its extrude program draw the gate sites, run
//      `gate` -> count; for i below min(count, kMaxRepeat): draw the body sites, set kSlotIndex to i, run `body`
//      -> size, t, lift, turn, pitch, tint; with a size of 0 or less this instance isn't drawn. A bark terminal
//      (kTerminalBark) sets the span's radius (= size), and kSlotRadius for what follows it; the first bark with
//      count >= 1 counts. Bark stands first in a program.
// "Draw" means: for j < siteCount: machine slot kSlotDraw + j = uniformRandom(key, sites[firstSite + j]), see
// drawSite. "Give inputs" means: fill the slots that the masks name; unnamed ones need not be filled.
#ifndef ESPALIER_SHARED_RULE_MAP_H
#define ESPALIER_SHARED_RULE_MAP_H
#include "shaders/shared/constants.h"
#include "shaders/shared/growth_records.h"

ESPALIER_BEGIN

CONST_UINT(kMaxParams, 32u);        // slots of parameters; a colour takes three
CONST_UINT(kMaxDirections, 4u);     // world directions that angleTo is asked for, per grammar
CONST_UINT(kMaxDraws, 8u);          // random numbers per stage
CONST_UINT(kMaxRepeat, 64u);        // instances that one terminal makes on one span
CONST_UINT(kMaxSuccessors, 16u);
CONST_UINT(kMaxExtrudes, 255u);
CONST_UINT(kMaxListDepth, 8u);      // List rules applied in a row, at most, before a March or Null (guaranteed)

// The machine's slots. Code reads any of them and writes registers only.
CONST_UINT(kRegisters, 16u);
CONST_UINT(kSlotArg, 16u);          // 4: the shape's arguments. In an extrude program: Chunk::args (see argMask)
CONST_UINT(kSlotDraw, 20u);         // 8: random numbers in [0, 1)
CONST_UINT(kSlotLayer, 28u);        // 16: painted layers at texCoord, by the grammar's own numbering (layerOf)
CONST_UINT(kSlotAngle, 44u);        // 4: signed angle from the heading to directions[i] laid into the surface
CONST_UINT(kSlotTexCoord, 48u);     // 2
CONST_UINT(kSlotNormal, 50u);       // 3, world, outward
CONST_UINT(kSlotHeading, 53u);      // 3, world, unit tangent
CONST_UINT(kSlotPosition, 56u);     // 3, world, metres
CONST_UINT(kSlotCurvature, 59u);    // 1/m in the world, positive on bulges
CONST_UINT(kSlotSlope, 60u);        // angle between normal and up: 0 floor, pi/2 wall, pi ceiling
CONST_UINT(kSlotHeight, 61u);       // metres above the lowest point of the surface instance
CONST_UINT(kSlotDepth, 62u);        // 0 on the seed's own branch
CONST_UINT(kSlotStep, 63u);         // marching steps since the branch began (at a step's destination: counting it)
CONST_UINT(kSlotArc, 64u);          // metres since the branch began (likewise)
CONST_UINT(kSlotBranchLength, 65u); // extrude programs only, as are the next five
CONST_UINT(kSlotToTip, 66u);        // branchLength - arc
CONST_UINT(kSlotSpanLength, 67u);   // arc of this node - arc of the node before
CONST_UINT(kSlotRadius, 68u);       // radius of the bark on this span; 0 before the bark terminal has run
CONST_UINT(kSlotIndex, 69u);        // number of the instance in its Repeat
CONST_UINT(kSlotCount, 70u);        // how many the Repeat makes (the gate's count, limited); set before the body
CONST_UINT(kSlotZero, 71u);         // constants, set by resetMachine
CONST_UINT(kSlotOne, 72u);
CONST_UINT(kMachineSlots, 94u);
CONST_UINT(kSlotImmediate, 127u);   // the word's own constant

// What the same slots hold for roofs (roof_expand.h fills them; Buron 2013 §3.2): a grammar of roofs has no walk.
// Positions in metres in the world; directions are unit vectors.
CONST_UINT(kSlotPos0, 44u);         // 3: the shape's first corner, a segment's begin
CONST_UINT(kSlotPos1, 47u);         // 3: its second corner, a segment's end
CONST_UINT(kSlotLocalNormal, 50u);  // 3 (= kSlotNormal)
CONST_UINT(kSlotLocalTangent, 53u); // 3
CONST_UINT(kSlotEaveTangent, 56u);  // 3: along the eave of the atom
CONST_UINT(kSlotRoofPos1, 59u);     // 3: ends of the face's highest piece, 1 on the side of the eave's begin
CONST_UINT(kSlotRoofPos2, 62u);     // 3
CONST_UINT(kSlotRoofHeight, 65u);   // metres from the eave up to them
CONST_UINT(kSlotRoofSlope, 66u);    // tangent of the pitch
CONST_UINT(kSlotProjectHeight, 67u);
CONST_UINT(kSlotSizeX, 68u);        // kSlotIndex and kSlotCount as above
CONST_UINT(kSlotSizeY, 73u);
CONST_UINT(kSlotEaveStart, 74u);    // where the eave begins along the rectangle of the face
CONST_UINT(kSlotEaveLength, 75u);
CONST_UINT(kSlotJoint, 76u);        // kind of the segment: JointKind + 1, 0: none of a roof's
CONST_UINT(kSlotOwner, 77u);        // 1 for one of the two faces that share the segment
CONST_UINT(kSlotFaceKind, 78u);
CONST_UINT(kSlotTier, 79u);
CONST_UINT(kSlotWallHeight, 80u);
CONST_UINT(kSlotHouseRandom, 81u);  // 0..1, one a house
CONST_UINT(kSlotHouseShape, 82u);
CONST_UINT(kSlotHouseMaterial, 83u);
CONST_UINT(kSlotHouseColour, 84u);  // 3, linear
CONST_UINT(kSlotHouseTinted, 87u);  // 1: the house has a colour of its own
CONST_UINT(kSlotCorners, 88u);      // 2: RoofAtom::corners
CONST_UINT(kSlotHouseOverhang, 90u);   // metres; 0: as the grammar says
CONST_UINT(kSlotHouseChimneys, 91u);   // 0: as the grammar says, 1: none, 2: on every ridge
CONST_UINT(kSlotHouseOpen, 92u);       // 1: a roof on posts, without walls
CONST_UINT(kSlotWallShared, 93u);      // metres from the wall's foot that a neighbour covers; wallHeight: it ends the roof

// Masks of inputs. Layers have a mask of their own (bit i: kSlotLayer + i).
CONST_UINT(kInputAngle, 1u);            // bits 0..3: kSlotAngle + i
CONST_UINT(kInputTexCoord, 1u << 4u);
CONST_UINT(kInputNormal, 1u << 5u);
CONST_UINT(kInputHeading, 1u << 6u);
CONST_UINT(kInputPosition, 1u << 7u);
CONST_UINT(kInputCurvature, 1u << 8u);
CONST_UINT(kInputSlope, 1u << 9u);
CONST_UINT(kInputHeight, 1u << 10u);
CONST_UINT(kInputDepth, 1u << 11u);
CONST_UINT(kInputStep, 1u << 12u);
CONST_UINT(kInputArc, 1u << 13u);
CONST_UINT(kInputBranchLength, 1u << 14u);   // or toTip
CONST_UINT(kInputSpanLength, 1u << 15u);
CONST_UINT(kInputRadius, 1u << 16u);
CONST_UINT(kInputOfRoofs, 1u << 17u);        // roofs fill all their slots or, where nothing is asked, none; but for
// roofPos1, roofPos2 (which lie where a plant's slots have these bits) and eaveStart:
CONST_UINT(kInputEaveStart, 1u << 18u);
CONST_UINT(kInputsOfTargets, kInputEaveStart | kInputCurvature | kInputSlope | kInputHeight | kInputDepth | kInputStep | kInputArc);

// A word of code: bits 4..0 operation, 8..5 destination register, 15..9 slot x, 22..16 slot y, 29..23 slot z.
struct CodeWord {
    uint bits;
    float immediate;   // what kSlotImmediate means in this word
};
STATIC_SIZE(CodeWord, 8);
RECORD_WORDS(CodeWord)
RECORD_OFFSETS(CodeWord)

// A result: a machine slot after its code has run, or (kSlotImmediate) a constant. Read it with valueOf.
struct Value {
    uint slot;
    float immediate;
};
STATIC_SIZE(Value, 8);
RECORD_WORDS(Value)
RECORD_OFFSETS(Value)

struct CodeRange {
    uint first, count;   // in RuleMapRef::code
};
STATIC_SIZE(CodeRange, 8);
RECORD_OFFSETS(CodeRange)

struct SymbolRecord {
    uint nameHash;       // FNV-1a 32
    uint argCount;
    uint firstRule, ruleCount;
    CodeRange select;
    Value selected;      // rule number below ruleCount, or negative: none holds
    uint firstSite, siteCount;   // drawn before `select`
    uint inputs, layers;         // needed by `select`
    uint uses;                   // bit i: the choice depends on parameter slot i; or the symbol's own (symbolBit)
    uint spare;
};
STATIC_SIZE(SymbolRecord, 56);
RECORD_WORDS(SymbolRecord)
RECORD_OFFSETS(SymbolRecord)

CONST_UINT(kRuleNull, 0u);
CONST_UINT(kRuleList, 1u);
CONST_UINT(kRuleMarch, 2u);

// Rules of roofs (Buron 2013 §3). `values`: their numbers in the map's values, all worked out by `start`.
// A successor's `part` says to which of the rule's shapes it goes.
CONST_UINT(kRuleExtrude, 3u);   // values: height. Parts: face, top
CONST_UINT(kRuleJoin, 4u);      // height, v1 xyz, v2 xyz; detail 1: to the roof's targets. Parts: clipped, support, top
CONST_UINT(kRuleProject, 5u);   // two axes. Parts: projected
CONST_UINT(kRuleExplode, 6u);   // Parts: face, front, right, back, left
CONST_UINT(kRuleSplit, 7u);     // kMaxSplit sizes; detail: bit 0 along y, then 2 bits a part: kSplit..., 3: no such part
CONST_UINT(kRuleRepeat, 8u);    // size x, y; detail: kRepeat...
CONST_UINT(kRuleScope, 9u);     // kScopeValues. Part: the changed shape
CONST_UINT(kRuleShape, 10u);    // kScopeValues; detail: mesh. No successors
CONST_UINT(kMaxSplit, 14u);     // values of a Split, whatever the number of its parts
CONST_UINT(kSplitAbsolute, 0u);
CONST_UINT(kSplitRelative, 1u); // to the shape's size
CONST_UINT(kSplitRest, 2u);     // a share of what is left
CONST_UINT(kRepeatX, 1u);
CONST_UINT(kRepeatY, 2u);
CONST_UINT(kRepeatClip, 4u);    // cells keep their size, those on the border are clipped; else they are fitted
CONST_UINT(kRepeatBond, 8u);    // every second row begins half a cell earlier
CONST_UINT(kRepeatGrid, 16u);   // context-free: all cells stay one shape
// S x y z, T x y z, R turn pitch, tint, colour, layer + 1 of Drop and of Moss; a size, tint, colour or layer below 0 stays
// what it is.
CONST_UINT(kScopeValues, 14u);

struct RuleRecord {
    uint kind;
    uint firstSuccessor, successorCount;
    uint extrude;                // index of the extrude program + 1; 0: none. Of roofs: the kind's detail
    uint firstSite, siteCount;   // drawn once, for all stages of the rule
    CodeRange start;
    Value distance;              // metres; the expander limits it from below (GLSL reads no member named length)
    Value angle;                 // radians, positive to the left as seen from outside
    CodeRange arrive;
    Value condition;
    uint startInputs, startLayers;     // List: of the successors' arguments
    uint arriveInputs, arriveLayers;
    uint params;                 // parameter slots that the rule depends on
    uint values;                 // of roofs: the first of its numbers. Of a March: slot + 1 of the part of its
                                 // condition that is the same in every direction, after `arrive`; 0: none
};
STATIC_SIZE(RuleRecord, 88);
RECORD_WORDS(RuleRecord)
RECORD_OFFSETS(RuleRecord)

CONST_UINT(kSuccessorContinues, 1u);
// Of roofs: the symbol's only rule is a terminal that changes nothing; bits 15..8 its mesh.
CONST_UINT(kSuccessorTerminal, 2u);
CONST_UINT(kSuccessorMesh, 8u);
struct SuccessorRecord {
    uint symbol;
    uint nameHash;       // of that symbol
    uint ordinal;        // which of the successors of that name in its rule
    uint flags;
    CodeRange code;
    uint argCount;
    Value args[4];
    uint part;           // of roofs: which of the rule's shapes it takes
};
STATIC_SIZE(SuccessorRecord, 64);
RECORD_WORDS(SuccessorRecord)
RECORD_OFFSETS(SuccessorRecord)

// What is drawn on a span. Key of its draws: childKey(key, nameHash, step), key being the branch's.
// argMask: kSlotArg + i is read; the compiler allows it only for arguments that a branch hands on unchanged, so
// that Chunk::args of the node's chunk serves.
struct ExtrudeRecord {
    uint nameHash;
    uint firstTerminal, terminalCount;
    uint inputs, layers, params;
    uint argMask;
    uint spare;
};
STATIC_SIZE(ExtrudeRecord, 32);

CONST_UINT(kTerminalBark, 1u);      // bent along the span; else a loose instance on it
CONST_UINT(kSiteOfInstance, 0x80000000u);   // a site drawn with the instance's key, see drawSite
struct TerminalRecord {
    uint mesh;           // index into the compile options' terminal meshes
    uint smoothness;     // kSmooth...
    uint flags;
    uint site;           // instance key = childKey(extrude key, site, index)
    CodeRange gate;
    Value count;         // below 1: nothing
    uint gateFirstSite, gateSiteCount;
    CodeRange body;
    uint bodyFirstSite, bodySiteCount;
    Value size;          // metres: bark's radius, else the terminal's length
    Value t;             // along the span, 0..1
    Value lift;          // metres above the surface
    Value turn;          // radians about the normal, from the heading to the left
    Value pitch;         // radians, away from the surface
    Value tint;          // 0..1
    Value colour[3];     // linear, 0..1
};
STATIC_SIZE(TerminalRecord, 128);

// Patterns (Li 2011 §3, §4.3): a rule of kind kRulePattern is a production, a row of parts. Each part has a chain of
// scope commands that leads from the production's own scope to the part's; the commands' numbers are worked out one
// after the other, each where the ones before have led. RuleRecord: firstSuccessor and successorCount name the parts,
// `extrude` holds how many sets they make in bits 15..0 and of how many pieces in bits 31..16.
CONST_UINT(kRulePattern, 11u);
CONST_UINT(kMaxParts, 64u);
CONST_UINT(kMaxOps, 64u);
CONST_UINT(kMaxPriority, 7u);
CONST_UINT(kMaxFields, 4u);      // that a grammar reads
CONST_UINT(kMaxSymmetry, 12u);
CONST_UINT(kMaxPieces, 16u);     // of one set

// Scope commands. T: metres along x and y over the surface, z off it; R: radians; S: metres.
CONST_UINT(kOpTranslate, 0u);
CONST_UINT(kOpRotateX, 1u);
CONST_UINT(kOpRotateY, 2u);
CONST_UINT(kOpRotateZ, 3u);
CONST_UINT(kOpSize, 4u);
CONST_UINT(kOpKinds, 5u);
struct PatternOp {
    uint kind;
    CodeRange code;
    Value values[3];
    uint inputs, layers;         // needed by `code`
    uint firstSite, siteCount;   // drawn before `code`, with the production's key
};
STATIC_SIZE(PatternOp, 52);

CONST_UINT(kPartSymbol, 0u);     // args: the symbol's
CONST_UINT(kPartPlaced, 1u);     // a piece that stands whatever is there; args: its colour, negative: the mesh's own
CONST_UINT(kPartTested, 2u);     // a piece that stands if it meets nothing that stands
CONST_UINT(kPartLine, 3u);       // a segment of a line that crosses others; args: its colour, and its width in metres
CONST_UINT(kPartMergedLine, 4u); // one that ends at the first that it crosses
CONST_UINT(kPartMerged, 5u);     // a piece that goes into a like one; args: its colour, the distance in metres, the turn
CONST_UINT(kPartKinds, 6u);
CONST_UINT(kPartArgs, 5u);
CONST_UINT(kIfFallen, 0x80000000u);
struct PatternPart {
    uint kind;
    uint firstOp, opCount;
    uint symbol, nameHash, ordinal, argCount;
    uint mesh;
    uint set;            // of a piece: the number of its set in the production; pieces of a set follow each other
    uint prereq;         // the part is made only if this set of the production stands, or with kIfFallen only if it has
                         // been tried and doesn't; kNoIndex: in any case
    CodeRange code;      // of args, where the chain has led
    Value args[5];
    uint inputs, layers;
    uint firstSite, siteCount;
    uint begin;          // of a line's segment: how many of the ops lead to where it begins; else kNoIndex
    uint priority;       // of a symbol: the higher, the earlier it is derived
};
STATIC_SIZE(PatternPart, 112);

// What is asked of a field: bits 7..0 the field, 15..8 a quantity. Query i stands in slot kSlotQuery + i.
CONST_UINT(kMaxQueries, 20u);
CONST_UINT(kSlotQuery, 73u);
CONST_UINT(kInputFields, 1u << 19u);   // the queries' slots
CONST_UINT(kInputSlopes, 1u << 20u);   // those, too, that say how a field changes
CONST_UINT(kQueryValue1, 0u);    // the larger eigenvalue; of vectors their length
CONST_UINT(kQueryValue2, 1u);    // the lesser one
CONST_UINT(kQueryAngle1, 2u);    // from the scope's x axis to the direction of the first, radians, (-pi / N, pi / N]
CONST_UINT(kQueryAngle2, 3u);    // and to a quarter turn from it
CONST_UINT(kQuerySure, 4u);      // 1 where directions around agree, 0 at a singularity
// For each metre along the scope's x axis (X) and to its left (Y):
CONST_UINT(kQueryTurnX, 5u);     // how the field's direction turns, radians
CONST_UINT(kQueryTurnY, 6u);
CONST_UINT(kQueryGrowth1X, 7u);  // how value1 grows
CONST_UINT(kQueryGrowth1Y, 8u);
CONST_UINT(kQueryGrowth2X, 9u);
CONST_UINT(kQueryGrowth2Y, 10u);
CONST_UINT(kQuantities, 11u);
FN uint queryField(uint q) { return q & 255u; }
FN uint queryQuantity(uint q) { return q >> 8u; }
FN bool queryOfSlope(uint q) { return queryQuantity(q) >= kQueryTurnX; }

CONST_UINT(kGuideNone, 0u);      // straight on
CONST_UINT(kGuideNearest, 1u);   // along the first field; behind a singularity along the nearest of its directions
CONST_UINT(kGuideJumps, 2u);     // along the first field; over singularities as in Li 2011 §4.3

BUFFER(PatternOpBuf, PatternOp)
BUFFER(PatternPartBuf, PatternPart)
BUFFER(CodeBuf, CodeWord)
BUFFER(SymbolRecordBuf, SymbolRecord)
BUFFER(RuleRecordBuf, RuleRecord)
BUFFER(SuccessorRecordBuf, SuccessorRecord)
BUFFER(ExtrudeRecordBuf, ExtrudeRecord)
BUFFER(TerminalRecordBuf, TerminalRecord)
BUFFER(ValueBuf, Value)

// What a grammar uses of all that rules may ask and do. Kernels of growth are specialised to what a scene's grammars
// use together, since a software device runs code for what none uses all the same.
CONST_UINT(kFeatureKnown, 1u);
CONST_UINT(kFeatureWorld, 2u);      // inputs that take the place in the world: normal, heading, angles, slope, height
CONST_UINT(kFeatureSurface, 4u);    // layers, curvature
CONST_UINT(kFeatureHardCode, 8u);   // operations from kOpFloor on that aren't a single instruction
CONST_UINT(kFeatureColours, 16u);   // leaves whose colour isn't the same wherever their shape is drawn
CONST_UINT(kFeatureDensity, 32u);   // these two are asked for by GrowthLimits: a cap on leaves,
CONST_UINT(kFeatureJoints, 64u);    // and the paper's tangents
CONST_UINT(kFeatureAvoid, 128u);    // stems that keep a distance: GrowthInputs::avoid
CONST_UINT(kRuleFeatures, 31u);
CONST_UINT(kAllFeatures, 255u);
#if !defined(__cplusplus) && defined(ESPALIER_TABLES)
layout(constant_id = kConstantFeatures) const uint kFeatures = kAllFeatures;
#else
CONST_UINT(kFeatures, kAllFeatures);
#endif
CONST_UINT(kInputsOfWorld, kInputNormal | kInputHeading | kInputPosition | kInputSlope | kInputHeight | 15u);

// One grammar of a scene. layerOf[i]: the scene's layer that the grammar's layer i is bound to.
struct RuleMapRef {
    SymbolRecordBuf symbols;
    RuleRecordBuf rules;
    SuccessorRecordBuf successors;
    ExtrudeRecordBuf extrudes;
    TerminalRecordBuf terminals;
    CodeBuf code;
    UintBuf sites;
    uint symbolCount, ruleCount, successorCount, extrudeCount, terminalCount;
    uint codeCount;      // words of code
    uint siteCount;
    uint features;       // kFeature... that its rules use; 0: not known, all of them
    vec4 directions[4];
    uint layerOf[16];
    ValueBuf values;
    uint valueCount;
    uint kind;           // GrammarKind
    PatternPartBuf parts;
    PatternOpBuf ops;
    UintBuf queries;
    uint queryCount;
    uint guide;          // kGuide...: how a grammar of patterns leads T
};
STATIC_SIZE(RuleMapRef, 264);
BUFFER(RuleMapBuf, RuleMapRef)     // [grammar]

ESPALIER_END
#endif
