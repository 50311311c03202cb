#pragma once

// What stands, as a binary glTF 2.0 that engines and Blender import (docs/export.md).

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "plugin_api/espalier.hpp"

namespace espalier::exporting {

// Which attribute of vertices tells how they move and how old they are.
enum class WindChannel {
    none,
    own,    // _WIND: wind and age
    colour  // COLOR_0: wind in red, age in green; of what doesn't move, its colour
};

struct Options {
    bool ivy = true, roofs = true, patterns = true;
    bool instancing = false;  // EXT_mesh_gpu_instancing in place of a node for each leaf, tile and piece
    bool lods = false;        // coarser levels too, as MSFT_lod
    bool collision = false;   // meshes of what is solid, too
    WindChannel wind = WindChannel::own;
    float stemError = esp::defaults<EspPartsDef>().stemError;
};

// A part of the context's, copied, so that a thread may write it while the context goes on.
struct ExportPart {
    EspPartKind kind = ESP_PART_STEMS;
    std::string name;
    uint32_t material = 0;
    uint32_t house = 0;
    uint32_t seed = 0;  // id
    struct Level {
        std::vector<EspPartVertex> vertices;
        std::vector<uint32_t> indices;
        float error = 0;
    };
    std::vector<Level> levels;
    std::vector<EspPartInstance> instances;
};
struct ExportPicture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgba;
};
// What espalier-bake wrote, and where it stands.
struct ExportSurface {
    std::string name;   // for messages
    std::string bytes;  // of the file
    EspTransform place{};
};
struct Gathered {
    std::vector<ExportPart> parts;
    std::vector<EspPartMaterial> materials;
    std::vector<std::string> materialNames;
    std::vector<ExportPicture> pictures;
    std::vector<ExportSurface> surfaces;  // that are to be in the file, too; gather() leaves it alone
    uint64_t triangles = 0;               // of the finest level
};

struct Written {
    uint64_t nodes = 0, meshes = 0, materials = 0, instances = 0, triangles = 0, bytes = 0;
};

// On the context's thread. False: `error` says why; also where nothing has grown that the options want.
bool gather(EspContext* context, const Options& options, Gathered& out, std::string& error);

// The file's bytes. goOn: told how far it is, 0 to 1; where it returns false, nothing comes of it and `error` is empty.
bool encode(const Gathered& gathered, const Options& options, const std::function<bool(float)>& goOn,
            std::string& bytes, Written& written, std::string& error);

}  // namespace espalier::exporting
