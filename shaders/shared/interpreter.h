// The machine that runs a rule map's straight-line code, on GPU and CPU alike; see rule_map.h for when what runs.
//
// The machine is an array of floats. In GLSL it is one global per invocation (arrays handed to functions would be
// copied); in C++ it is handed on. So that one text serves both, functions that use it begin their parameters with
// MACHINE_PARAM and are called with MACHINE first, both without a comma: runCode(MACHINE map, first, count).
// (MACHINE_ONLY where the machine is the sole argument.) A C++ function at the root declares `Machine machine;`;
// both begin with resetMachine(MACHINE_ONLY).
//
// Every value a word leaves is finite, of magnitude below 1e18 and zero or above 1e-30: hostile code can't make
// NaN, and devices that flush denormals agree with those that don't.
#ifndef ESPALIER_SHARED_INTERPRETER_H
#define ESPALIER_SHARED_INTERPRETER_H
#include "shaders/shared/exact.h"
#include "shaders/shared/random.h"
#include "shaders/shared/rule_map.h"

ESPALIER_BEGIN

#ifdef __cplusplus
struct Machine {
    float slots[kMachineSlots] = {};
};
#define MACHINE machine,
#define MACHINE_PARAM Machine &machine,
#define MACHINE_ONLY machine
#define MACHINE_ONLY_PARAM Machine &machine
#define SLOT(i) machine.slots[i]
#define SET_SLOT(i, value) machine.slots[i] = value
#else
#define MACHINE
#define MACHINE_PARAM
#define MACHINE_ONLY
#define MACHINE_ONLY_PARAM
#ifndef SLOT   // else a kernel keeps slots elsewhere
float machineSlots[kMachineSlots];
#define SLOT(i) machineSlots[i]
#define SET_SLOT(i, value) machineSlots[i] = value
#endif
#endif

CONST_UINT(kOpMove, 0u);      // x
CONST_UINT(kOpAdd, 1u);       // x + y
CONST_UINT(kOpSub, 2u);       // x - y
CONST_UINT(kOpMul, 3u);       // x * y
CONST_UINT(kOpMulAdd, 4u);    // x * y + z, rounded twice
CONST_UINT(kOpMin, 5u);
CONST_UINT(kOpMax, 6u);
CONST_UINT(kOpLess, 7u);      // x < y ? 1 : 0
CONST_UINT(kOpLessEq, 8u);    // x <= y ? 1 : 0
CONST_UINT(kOpEqual, 9u);     // x = y ? 1 : 0
CONST_UINT(kOpSelect, 10u);   // holds(x) ? y : z
CONST_UINT(kOpFloor, 11u);
CONST_UINT(kOpAbs, 12u);
CONST_UINT(kOpDiv, 13u);      // x / y, rounded once; by zero: 0
CONST_UINT(kOpSqrt, 14u);     // of negative numbers: 0
CONST_UINT(kOpSin, 15u);
CONST_UINT(kOpCos, 16u);
CONST_UINT(kOpCount, 17u);
FN bool isHardOperation(uint op) { return op >= kOpFloor && op != kOpAbs; }

// What a number means as a condition. Painted masks are filtered, so that their edge lies at one half.
FN bool holds(float x) { return x >= 0.5f; }

FN float tamed(float x) {
    float y = x > -1e18f ? (x < 1e18f ? x : 1e18f) : -1e18f;
    return absolute(y) < 1e-30f ? 0.0f : y;
}

FN float applyHardOperation(uint op, float x, float y) {
    float r = x;
    switch (op) {
        case kOpFloor: {
            float whole = floorExact(limited(x, -8388608.0f, 8388608.0f));
            r = absolute(x) < 8388608.0f ? whole : x;
            break;
        }
        case kOpDiv: r = y == 0.0f ? 0.0f : ratioExact(x, y); break;
        case kOpSqrt: r = sqrtExact(x); break;
        case kOpSin:
        case kOpCos: {
            float s = 0.0f;
            float c = 0.0f;
            sinCosExact(limited(x, -8000.0f, 8000.0f), s, c);
            r = op == kOpSin ? s : c;
            break;
        }
        default: break;
    }
    return r;
}

// One operation. Angles are taken within ±8000 radians, floors within ±2^23 (beyond, floats are whole).
FN float applyOperation(uint op, float x, float y, float z) {
    float r = x;
    switch (op) {
        case kOpAdd: r = x + y; break;
        case kOpSub: r = x - y; break;
        case kOpMul: r = x * y; break;
        case kOpMulAdd: r = x * y + z; break;
        case kOpMin: r = smaller(x, y); break;
        case kOpMax: r = larger(x, y); break;
        case kOpLess: r = x < y ? 1.0f : 0.0f; break;
        case kOpLessEq: r = x <= y ? 1.0f : 0.0f; break;
        case kOpEqual: r = x == y ? 1.0f : 0.0f; break;
        case kOpSelect: r = holds(x) ? y : z; break;
        case kOpAbs: r = absolute(x); break;
        case kOpFloor:
        case kOpDiv:
        case kOpSqrt:
        case kOpSin:
        case kOpCos:
            if ((kFeatures & kFeatureHardCode) != 0u) r = applyHardOperation(op, x, y);
            break;
        default: break;
    }
    return tamed(r);
}

FN void resetMachine(MACHINE_ONLY_PARAM) {
    SET_SLOT(kSlotZero, 0.0f);
    SET_SLOT(kSlotOne, 1.0f);
}

// Runs one word of code.
FN void runWord(MACHINE_PARAM uint bits, float immediate) {
    uint sx = (bits >> 9u) & 127u;
    uint sy = (bits >> 16u) & 127u;
    uint sz = (bits >> 23u) & 127u;
    float x = sx == kSlotImmediate ? immediate : SLOT(sx);
    float y = sy == kSlotImmediate ? immediate : SLOT(sy);
    float z = sz == kSlotImmediate ? immediate : SLOT(sz);
    SET_SLOT((bits >> 5u) & 15u, applyOperation(bits & 31u, x, y, z));
}

FN void runCode(MACHINE_PARAM CodeBuf code, CodeRange range) {
    uint i = 0u;
    if (range.count != 0u) do {   // software devices go through a body once more where the test comes first
            CodeWord word = code.v[range.first + i];
            runWord(MACHINE word.bits, word.immediate);
        } while (++i < range.count);
}

FN float valueOf(MACHINE_PARAM Value value) {
    return value.slot == kSlotImmediate ? value.immediate : SLOT(value.slot);
}

// After `select` has run: the number of the chosen rule among the symbol's, or -1. Within bounds whatever a map says.
FN int selectedRule(MACHINE_PARAM SymbolRecord symbol) {
    float n = valueOf(MACHINE symbol.selected);
    return n < 0.0f ? -1 : int(smaller(n, float(symbol.ruleCount) - 1.0f));
}

// What a draw slot of a stage gets. instanceKey: for sites inside a Repeat; elsewhere hand the same key twice.
FN float drawSite(uint site, u64 key, u64 instanceKey) {
    return uniformRandom((site & kSiteOfInstance) != 0u ? instanceKey : key, site & 0x7FFFFFFFu);
}

// Signed angle from `heading` to `direction` laid into the surface, positive to the left as seen from outside;
// 0 where the direction stands upright on the surface.
FN float angleInSurface(vec3 heading, vec3 normal, vec3 direction) {
    float x = dot3(heading, direction);
    float y = dot3(cross3(heading, direction), normal);
    return x * x + y * y < 1e-6f ? 0.0f : atan2Exact(y, x);
}

ESPALIER_END
#endif
