// Functions that a text gives: a postfix program over a stack of eight numbers. The stack moves instead of a pointer into
// it, so a GPU keeps all of it in registers.
#ifndef ESPALIER_SHARED_NODE_FUNCTION_H
#define ESPALIER_SHARED_NODE_FUNCTION_H
#include "shaders/shared/exact.h"
#include "shaders/shared/node_noise.h"
#include "shaders/shared/node_records.h"

ESPALIER_BEGIN

CONST_UINT(kFunctionDepth, 8u);      // numbers on the stack at most
CONST_UINT(kMostFunction, 512u);     // words of a program
// Words. A number's bits stand in the word behind kFunctionNumber.
CONST_UINT(kFunctionNumber, 0u);
CONST_UINT(kFunctionInput, 1u);      // to 6: x, y, z, a, b, c
CONST_UINT(kFunctionAdd, 7u);        // of two
CONST_UINT(kFunctionSubtract, 8u);
CONST_UINT(kFunctionMultiply, 9u);
CONST_UINT(kFunctionDivide, 10u);
CONST_UINT(kFunctionLeast, 11u);
CONST_UINT(kFunctionMost, 12u);
CONST_UINT(kFunctionModulo, 13u);
CONST_UINT(kFunctionNegate, 14u);    // of one
CONST_UINT(kFunctionAbsolute, 15u);
CONST_UINT(kFunctionFloor, 16u);
CONST_UINT(kFunctionRoot, 17u);
CONST_UINT(kFunctionSine, 18u);
CONST_UINT(kFunctionCosine, 19u);
CONST_UINT(kFunctionNoise, 20u);     // of three

FN float functionOfOne(uint word, float v) {
    if (word == kFunctionNegate) return 0.0f - v;
    if (word == kFunctionAbsolute) return absolute(v);
    if (word == kFunctionFloor) return floorExact(within(v, 1e9f));
    if (word == kFunctionRoot) return sqrtExact(larger(v, 0.0f));
    float s;
    float c;
    sinCosExact(within(v, 1e4f), s, c);
    return word == kFunctionSine ? s : c;
}
FN float functionOfTwo(uint word, float a, float b) {
    if (word == kFunctionAdd) return a + b;
    if (word == kFunctionSubtract) return a - b;
    if (word == kFunctionMultiply) return a * b;
    if (word == kFunctionLeast) return smaller(a, b);
    if (word == kFunctionMost) return larger(a, b);
    float quotient = divExact(a, b);
    if (word == kFunctionDivide) return quotient;
    return a - b * floorExact(within(quotient, 1e9f));
}

// A place -> the three numbers that the program leaves. abc: its further inputs.
FN vec3 runFunction(UintBuf code, uint words, vec3 p, vec3 abc) {
    float s0 = 0.0f;   // the top
    float s1 = 0.0f;
    float s2 = 0.0f;
    float s3 = 0.0f;
    float s4 = 0.0f;
    float s5 = 0.0f;
    float s6 = 0.0f;
    float s7 = 0.0f;
    for (uint at = 0u; at < words; ++at) {
        uint word = code.v[at];
        if (word < kFunctionAdd) {
            s7 = s6;
            s6 = s5;
            s5 = s4;
            s4 = s3;
            s3 = s2;
            s2 = s1;
            s1 = s0;
            if (word == kFunctionNumber) {
                ++at;
                s0 = uintBitsToFloat(code.v[at]);
            } else {
                uint which = word - kFunctionInput;
                s0 = which == 0u ? p.x : which == 1u ? p.y : which == 2u ? p.z : which == 3u ? abc.x : which == 4u ? abc.y : abc.z;
            }
        } else if (word >= kFunctionNegate && word < kFunctionNoise) {
            s0 = functionOfOne(word, s0);
        } else {
            bool three = word == kFunctionNoise;
            s0 = three ? latticeNoise(1u, vec3(s2, s1, s0)) : functionOfTwo(word, s1, s0);
            s1 = three ? s3 : s2;
            s2 = three ? s4 : s3;
            s3 = three ? s5 : s4;
            s4 = three ? s6 : s5;
            s5 = three ? s7 : s6;
            s6 = s7;
        }
    }
    return vec3(s2, s1, s0);
}

ESPALIER_END
#endif
