#pragma once

// Meshes of the procedural graph, drawn from the very blocks that its nodes left: planes of positions, octahedral
// normals, corners. Programs that geometry carries run in the vertex shader, instances are decoded by their number.

#include <array>
#include <map>
#include <memory>
#include <span>

#include "runtime/gpu/commands.hpp"
#include "runtime/graph/node.hpp"
#include "runtime/nodes/measure.hpp"
#include "runtime/render/pass_format.hpp"
#include "runtime/render/shading.hpp"

namespace espalier {

class GraphDraw {
  public:
    static Result<std::unique_ptr<GraphDraw>> create(Device& device);
    // What it is drawn with in one kind of pass.
    static Result<Program> program(Device& device, const PassFormat& pass, Shading shading);

    // In place of all that stood: parts and a box around each. Parts that aren't meshes aren't drawn. Blocks are
    // shared, so what nodes write into them is drawn; whoever writes says so by another call.
    Status place(Geometry parts, std::span<const NodeBox> boxes);
    bool empty() const { return parts_.empty(); }
    uint64_t revision() const { return revision_; }      // another one whenever something else stands
    void bounds(glm::vec3& low, glm::vec3& high) const;  // of what stands; leaves them alone if nothing does

    // Depth only without a shadow map.
    void draw(DrawPass& pass, const Buffer& frame, const Program& program, const Binding* shadow) const;

    uint64_t triangles() const;  // of all that stands, instances too

  private:
    explicit GraphDraw(Device& device) : device_(device) {}
    struct Part {
        GeometryPart geometry;
        NodeBox box;
        Buffer record;                   // GraphDrawRecord and the program
        std::vector<std::byte> written;  // what is in there
    };
    using Views = std::map<const NodeBlock*, std::pair<BlockRef, TexelView>>;
    Status view(const BlockRef& block, Views& kept);
    Status describe(Part& part, std::vector<Part>& before);

    Device& device_;
    Image white_;
    Sampler sampler_;
    std::vector<Part> parts_;
    Views views_;
    uint64_t revision_ = 0;
};

}  // namespace espalier
