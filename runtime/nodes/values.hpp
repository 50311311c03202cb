#pragma once

// What goes from node to node of the procedural graph: numbers, vectors, texts, materials, geometry.

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "shaders/shared/node_deform.h"

namespace espalier {

class Buffer;

enum class ValueType : uint8_t {
    number,
    whole,  // a number without a fraction
    vector,
    colour,  // linear, 0 to 1 each
    choice,  // one of the port's words
    text,
    file,  // a file's name, relative to the graph's
    material,
    rules,   // a grammar with its parameters
    ground,  // a baked surface
    plants,
    town,
    cover,   // what a painted layer holds
    points,  // places, maybe with normals
    curves,  // each of as many samples
    mesh,
    geometry,  // any of the three, maybe several parts
};
constexpr uint32_t kValueTypes = 17;
const char* nameOf(ValueType type);
inline bool isGeometry(ValueType type) {
    return type >= ValueType::points;
}
// Whether a port takes what an output gives as it is. Nothing is converted silently but a whole number to a number.
bool accepts(ValueType port, ValueType given);

// A constant as a text has it.
struct Literal {
    enum class Kind : uint8_t { none, number, vector, text };
    Kind kind = Kind::none;
    glm::vec3 numbers{0};  // of a number: x
    std::string text;

    Literal() = default;
    Literal(float number) : kind(Kind::number), numbers(number, 0, 0) {}
    Literal(glm::vec3 vector) : kind(Kind::vector), numbers(vector) {}
    Literal(std::string_view word) : kind(Kind::text), text(word) {}
    Literal(const char* word) : Literal(std::string_view(word)) {}
    bool operator==(const Literal&) const = default;
};

// Memory that kernels know by its address: a device's, or the process's own.
class NodeBlock {
  public:
    virtual ~NodeBlock() = default;
    uint64_t address() const { return address_; }
    uint64_t bytes() const { return bytes_; }
    virtual const Buffer* buffer() const { return nullptr; }  // null: the address is a pointer

    template <class Buf>
    Buf as() const {
        return Buf{reinterpret_cast<decltype(Buf::v)>(address_)};
    }

  protected:
    NodeBlock(uint64_t address, uint64_t bytes) : address_(address), bytes_(bytes) {}

  private:
    uint64_t address_, bytes_;
};
using BlockRef = std::shared_ptr<const NodeBlock>;

struct MaterialLook {
    glm::vec3 colour{0.3f, 0.26f, 0.2f};  // linear
    float roughness = 0.6f;
    bool operator==(const MaterialLook&) const = default;
};

// Points, curves or a mesh, as kernels know them (shaders/shared/node_records.h). Its blocks are shared: modifiers
// leave them alone and add steps to the program.
struct GeometryPart {
    enum class Kind : uint8_t { points, curves, mesh };
    Kind kind = Kind::points;
    uint32_t elements = 0;  // points, samples of all curves, or vertices
    // Of each `row` elements in memory the first `used` are meant, the others are padding. Of curves a row holds one
    // sample of each.
    uint32_t row = 0, used = 0;
    uint32_t samples = 0;                      // of each curve; there are `used` curves
    bool closed = false;                       // of curves: the last sample is the first again
    NodePlanes positions{};                    // count: elements with the padding
    BlockRef positionBlock, normals, indices;  // normals: octahedral, or null; indices: of a mesh
    BlockRef sizes;                            // of points: times as large is what stands there; null: all alike
    uint32_t indexCount = 0;
    MaterialLook material;
    std::vector<DeformOp> program;
    std::vector<BlockRef> held;  // what steps of the program refer to
    float extent = 1;            // metres: about how large it is, before its program

    uint64_t instances() const;  // of all steps that place some
};
using Geometry = std::vector<GeometryPart>;

// What a graph asks of stages outside of it (wishes.hpp).
struct RulesWish;
struct GroundWish;
struct PlantsWish;
struct TownWish;
struct CoverWish;
using RulesRef = std::shared_ptr<const RulesWish>;
using GroundRef = std::shared_ptr<const GroundWish>;
using PlantsRef = std::shared_ptr<const PlantsWish>;
using TownRef = std::shared_ptr<const TownWish>;
using CoverRef = std::shared_ptr<const CoverWish>;

using NodeValue = std::variant<std::monostate, float, glm::vec3, std::string, MaterialLook, RulesRef, GroundRef,
                               PlantsRef, TownRef, CoverRef, Geometry>;

}  // namespace espalier
