// In C++, names of GLSL that the text of the binding and culling kernels uses.
#ifndef ESPALIER_EMIT_GLSL_NAMES_H
#define ESPALIER_EMIT_GLSL_NAMES_H
#include "shaders/emit/emit_records.h"

#ifdef __cplusplus
namespace espalier {
using glm::clamp, glm::floor, glm::inversesqrt, glm::log2, glm::max, glm::min, glm::mix;
using glm::packHalf2x16, glm::unpackHalf2x16, glm::uvec3, glm::uvec4;
}  // namespace espalier
#endif
#endif
