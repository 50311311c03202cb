#pragma once

// What a graph asks of stages outside of it. A node says what there should be and makes nothing: runtime/plugin lets it
// stand in the scene, and takes it away when no shown node asks for it any more.

#include "runtime/nodes/values.hpp"

namespace espalier {

struct WishedParam {
    std::string name;
    glm::vec3 value{0};
    uint32_t count = 1;  // numbers of the value: 3 of a colour
    bool operator==(const WishedParam&) const = default;
};

struct RulesWish {
    std::string file, text;           // what it includes lies beside the file
    std::vector<WishedParam> params;  // later ones win
    bool operator==(const RulesWish&) const = default;
};

// A mesh that is to become ground for plants.
struct GroundWish {
    uint64_t key = 0;  // of all below but `shown`: alike meshes have one key
    std::vector<glm::vec3> places;
    std::vector<uint32_t> corners;  // three a triangle
    MaterialLook material;
    uint32_t resolution = 512;  // texels a side
    Geometry shown;             // the mesh as the graph has it: it stands in for the surface until that is baked
};

struct PlantsWish {
    RulesRef rules;
    GroundRef ground;  // null: whatever stands in the scene
    std::vector<glm::vec3> points;
    glm::vec3 direction{0};  // of their first stems; zero: upwards
    float reach = 1;         // metres from a point to the ground
    uint32_t seed = 1;
};

struct TownWish {
    std::string file, text;  // footprints
    RulesRef rules;          // of its roofs
};

// What a layer over the town holds at a place of the ground.
struct CoverWish {
    std::string layer;
    std::vector<uint32_t> code;  // of function_text.hpp; its first number counts, drawn to 0 to 1
    glm::vec3 inputs{0};         // a, b, c
    bool operator==(const CoverWish&) const = default;
};

}  // namespace espalier
