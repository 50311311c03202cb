#pragma once

// What a file is by its bytes, whatever its name says.

#include "tools/bake/import.hpp"

namespace espalier::import {

enum class ReadBy : uint8_t {
    none,    // not a model, or of a kind that nothing here reads
    stl,     // importStl
    assimp,  // by another program, see import_foreign.hpp
};

struct FileKind {
    const char* name;  // "FBX"
    ReadBy reader;
    const char* ending;  // by which other programs know it: ".fbx"
    const char* advice;  // what to do instead, where there is no reader
};

// Kinds that are neither glTF, OBJ nor PLY; null: it is none of those that are known.
const FileKind* kindOf(Bytes file);

// Has it vertices and faces as OBJ has them?
bool looksLikeObj(Bytes file);

}  // namespace espalier::import
