// In: parts of geometry as nodes left them. Out: a draw for each.
#include "runtime/render/graph_draw.hpp"

#include <cstring>

#include "runtime/gpu/color_texture.hpp"
#include "shaders/render/graph_records.h"

namespace espalier {

Result<std::unique_ptr<GraphDraw>> GraphDraw::create(Device& device) {
    std::unique_ptr<GraphDraw> draw(new GraphDraw(device));
    const uint8_t white[4] = {255, 255, 255, 255};
    if (Status made = assign(draw->white_, makeColorTexture(device, "white", 1, 1, white)); !made)
        return made.failure();
    if (Status made = assign(draw->sampler_, Sampler::create(device, {.name = "graph"})); !made) return made.failure();
    return draw;
}

// The fragments are those of pieces.
Result<Program> GraphDraw::program(Device& device, const PassFormat& pass, Shading shading) {
    GraphicsDesc desc = inPass(pass, "graph", "render/graph.vert", pass.colors.empty() ? "" : "render/piece.frag",
                               constantsOf(shading, holdsRoots(device)));
    desc.blend = blendOf(shading);
    return Program::graphics(device, desc);
}

Status GraphDraw::view(const BlockRef& block, Views& kept) {
    if (kept.contains(block.get())) return Done{};
    if (const auto known = views_.find(block.get()); known != views_.end()) {
        kept[block.get()] = std::move(known->second);
        views_.erase(known);
        return Done{};
    }
    Result<TexelView> made = TexelView::create(device_, *block->buffer(), VK_FORMAT_R32_UINT);
    if (!made) return made.failure();
    kept[block.get()] = {block, std::move(*made)};
    return Done{};
}

// A part that is described as the one at its place was needs no record of its own.
Status GraphDraw::describe(Part& part, std::vector<Part>& before) {
    const GeometryPart& g = part.geometry;
    const GraphDrawRecord record{g.material.colour, g.extent, g.positions.stride, uint32_t(g.program.size())};
    part.written.resize(sizeof record + std::max<size_t>(g.program.size(), 1) * sizeof(DeformOp));
    std::memcpy(part.written.data(), &record, sizeof record);
    if (!g.program.empty())
        std::memcpy(part.written.data() + sizeof record, g.program.data(), g.program.size() * sizeof(DeformOp));
    for (Part& old : before)
        if (old.record && old.written == part.written) {
            part.record = std::move(old.record);
            return Done{};
        }
    return assign(part.record, makeBuffer(device_, "graph part", std::span<const std::byte>(part.written)));
}

Status GraphDraw::place(Geometry parts, std::span<const NodeBox> boxes) {
    std::vector<Part> placed;
    Views kept;
    for (size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].kind != GeometryPart::Kind::mesh || parts[i].indexCount == 0) continue;
        Part& part = placed.emplace_back();
        part.geometry = std::move(parts[i]);
        part.box = boxes[i];
        if (Status made = view(part.geometry.positionBlock, kept); !made) return made;
        if (Status made = view(part.geometry.normals, kept); !made) return made;
        if (Status made = describe(part, parts_); !made) return made;
    }
    parts_ = std::move(placed);
    views_ = std::move(kept);
    ++revision_;
    return Done{};
}

void GraphDraw::bounds(glm::vec3& low, glm::vec3& high) const {
    for (const Part& part : parts_) {
        low = glm::min(low, part.box.low);
        high = glm::max(high, part.box.high);
    }
}

void GraphDraw::draw(DrawPass& pass, const Buffer& frame, const Program& program, const Binding* shadow) const {
    for (const Part& part : parts_) {
        const GeometryPart& g = part.geometry;
        pass.setIndices(*g.indices->buffer());
        const PiecePush push{0, 0, g.material.roughness, 0};
        const DrawPass::IndexRange range{g.indexCount, 0, 0, uint32_t(g.instances())};
        const Binding positions(views_.at(g.positionBlock.get()).second), normals(views_.at(g.normals.get()).second);
        if (shadow)
            pass.drawIndexed(program, range, push,
                             {{white_, sampler_}, *shadow, frame, positions, normals, part.record});
        else
            pass.drawIndexed(program, range, push, {frame, positions, normals, part.record});
    }
}

uint64_t GraphDraw::triangles() const {
    uint64_t all = 0;
    for (const Part& part : parts_) all += part.geometry.indexCount / 3 * part.geometry.instances();
    return all;
}

}  // namespace espalier
