#pragma once

#include <string>

#include "tools/document/work.hpp"

namespace sample {

// Of models that the baker reads, some of them by other programs.
inline constexpr const char* kModelEndings[] = {".glb", ".gltf", ".obj", ".ply", ".stl", ".fbx",
                                                ".dae", ".off",  ".x",   ".lwo", ".3ds"};
// Whether a file is a model that the baker may read, and no surface yet. By its ending, and of .glb by what is in it.
bool isModel(const std::string& file);

// Where the surface of a model is kept: beside it as NAME.surface.glb, or in the user's cache where that folder can't
// be written into.
std::string surfaceOf(const std::string& model);

// Whether that surface is there, and younger than the model and the baker.
bool isBaked(const std::string& model);

// Bakes the model into that surface, beside the frames, by the program espalier-bake that lies beside this one: what
// takes all memory or finds a fault costs a message. The surface is written whole or not at all.
espalier::document::Work::Plan baking(const std::string& model);

// The same of the mesh that plants draw in place of a leaf: NAME.terminal.glb.
std::string terminalOf(const std::string& model);
bool isTerminalBaked(const std::string& model);
espalier::document::Work::Plan bakingTerminal(const std::string& model);

}  // namespace sample
