#pragma once

// What is fuzzed: functions that take any bytes as the content of a file and must neither crash nor leak, hang, or
// allocate beyond their stated bound, whatever the bytes are.

#include <cstdint>
#include <span>

namespace espalier::fuzz {

using Bytes = std::span<const uint8_t>;

void gltf(Bytes bytes);       // the glTF importer: text or container
void obj(Bytes bytes);        // the OBJ importer
void ply(Bytes bytes);        // the PLY importer, packed or not
void stl(Bytes bytes);        // the STL importer, and telling a file's kind
void mtl(Bytes bytes);        // the materials of an OBJ file
void surface(Bytes bytes);    // the surface reader; its hashes are not compared in a fuzzing build
void grammar(Bytes bytes);    // the grammar compiler, and loading what it made
void roof(Bytes bytes);       // the reader of footprints, and the roofs over them
void plant(Bytes bytes);      // the reader of frozen plants
void scene(Bytes bytes);      // the reader of scene files, and reading what it wrote
void terminals(Bytes bytes);  // the reader of meshes that are drawn, and measuring their levels of detail
void run(Bytes bytes);        // the reader of recorded editing runs, and reading what was written of one
void picture(Bytes bytes);    // both readers of pictures, of scenes and of surfaces
void rulemap(Bytes bytes);    // loading a compiled grammar, and setting its parameters
void site(Bytes bytes);       // the reader of a scene's furniture
void town(Bytes bytes);       // the reader of GeoJSON and plans alone, without the roofs
void project(Bytes bytes);    // reading a project, and saving it into a folder that may hold links
void graph(Bytes bytes);      // the reader of procedural graphs, reading what it wrote, and running small ones
void field(Bytes bytes);      // the readers of fields that other programs have computed
void preset(Bytes bytes);     // the readers of a preset and of the window's layout

struct Target {
    const char* name;
    void (*run)(Bytes);
};
inline constexpr Target kTargets[] = {
    {"gltf", gltf},           {"obj", obj},         {"ply", ply},         {"stl", stl},         {"mtl", mtl},
    {"surface", surface},     {"grammar", grammar}, {"roof", roof},       {"plant", plant},     {"scene", scene},
    {"terminals", terminals}, {"run", run},         {"picture", picture}, {"rulemap", rulemap}, {"site", site},
    {"town", town},           {"project", project}, {"preset", preset},   {"graph", graph},     {"field", field}};

}  // namespace espalier::fuzz
