#include "runtime/nodes/node_work.hpp"

#include <algorithm>
#include <utility>

#include "runtime/core/check.hpp"
#include "runtime/nodes/read_back.hpp"
#include "shaders/shared/random.h"

namespace espalier {

std::span<const NodeValue* const> NodeWork::wires(const char* port) const {
    const int at = given_.kind.port(port);
    require(at >= 0, "a kind's row names its own ports");
    return given_.wires[size_t(at)];
}

float NodeWork::number(const char* port) const {
    const int at = given_.kind.port(port);
    require(at >= 0, "a kind's row names its own ports");
    const NodePort& info = given_.kind.inputs[size_t(at)];
    if (given_.wires[size_t(at)].empty()) return given_.constants[size_t(at)].numbers.x;
    const float value = std::get<float>(*given_.wires[size_t(at)].front());
    return value >= info.low ? std::min(value, info.high) : info.low;
}

glm::vec3 NodeWork::vector(const char* port) const {
    const int at = given_.kind.port(port);
    require(at >= 0, "a kind's row names its own ports");
    const NodePort& info = given_.kind.inputs[size_t(at)];
    if (given_.wires[size_t(at)].empty()) return given_.constants[size_t(at)].numbers;
    glm::vec3 value = std::get<glm::vec3>(*given_.wires[size_t(at)].front());
    for (int i = 0; i < 3; ++i) value[i] = value[i] >= info.low ? std::min(value[i], info.high) : info.low;
    return value;
}

const std::string& NodeWork::text(const char* port) const {
    return given_.constants[size_t(given_.kind.port(port))].text;
}

uint32_t NodeWork::choice(const char* port) const {
    const NodePort& info = given_.kind.inputs[size_t(given_.kind.port(port))];
    return uint32_t(std::ranges::find(info.words, text(port)) - info.words.begin());
}

uint64_t NodeWork::key(std::initializer_list<uint64_t> more) {
    uint64_t all = 1;
    for (const uint64_t word : more) all = combineKeys(all, word);
    return all | 1;
}

std::array<uint32_t, 3> nodeGroups(uint64_t items) {
    constexpr uint64_t kMostGroups = 65535;
    const uint64_t groups = std::max<uint64_t>((items + kNodeGroup - 1) / kNodeGroup, 1);
    if (groups <= kMostGroups) return {uint32_t(groups), 1, 1};
    return {uint32_t(kMostGroups), uint32_t((groups + kMostGroups - 1) / kMostGroups), 1};
}

Result<NodeWork::Room> NodeWork::room(const char* name, uint64_t bytes, uint64_t madeFrom) {
    if (nextSlot_ == kept_.slots.size()) kept_.slots.emplace_back();
    NodeSlot& slot = kept_.slots[nextSlot_++];
    const bool fits = slot.block && slot.block->bytes() == std::max<uint64_t>(bytes, 64);
    if (!fits) {
        Result<BlockRef> made = machine_.allocate(name, bytes);
        if (!made) return made.failure();
        slot.block = std::move(*made);
    }
    const bool fresh = !fits || madeFrom == 0 || slot.madeFrom != madeFrom;
    slot.madeFrom = madeFrom;
    return Room{slot.block, fresh};
}

Result<NodePlanes> NodeWork::planes(const char* name, uint32_t elements, uint32_t planeCount, BlockRef& into) {
    const uint32_t stride = nodeRow(elements);
    Result<Room> made = room(name, uint64_t(stride) * planeCount * sizeof(float));
    if (!made) return made.failure();
    into = made->block;
    return NodePlanes{into->as<FloatBuf>(), stride, elements};
}

Result<NodePlanes> NodeWork::sentPlaces(const char* name, std::span<const glm::vec3> places, BlockRef& into) {
    const uint32_t count = uint32_t(places.size()), stride = nodeRow(count);
    std::vector<float> planes(size_t(stride) * 3);
    for (uint32_t i = 0; i < count; ++i)
        for (uint32_t axis = 0; axis < 3; ++axis) planes[size_t(axis) * stride + i] = places[i][int(axis)];
    Result<Room> made = sent(name, planes);
    if (!made) return made.failure();
    into = made->block;
    return NodePlanes{into->as<FloatBuf>(), stride, count};
}

Result<GeometryPart> NodeWork::realised(const GeometryPart& part, bool normals) {
    if (part.program.empty()) return part;
    if (std::ranges::any_of(part.program, [](const DeformOp& op) { return op.kind == kDeformInstance; }))
        return Failure("", "needs positions of its own, but is given instances");
    return deformed(part, normals);
}

// Its instances lie one behind the other, each in whole rows.
Result<GeometryPart> NodeWork::deformed(const GeometryPart& part, bool normals) {
    GeometryPart out = part;
    const uint64_t copies = part.instances(), each = nodeRow(part.positions.count);
    if (copies * each > kMostNodeElements)
        return Failure("", std::to_string(copies * part.elements) + " vertices are more than there is room for");
    const uint32_t count = copies == 1 ? part.positions.count : uint32_t(copies * each);
    Result<NodePlanes> planes = this->planes("deformed", count, 3, out.positionBlock);
    if (!planes) return planes.failure();
    Result<Room> ops = sent("deform program", part.program);
    if (!ops) return ops.failure();
    DeformArgs args{};
    args.from = part.positions;
    args.to = out.positions = *planes;
    if (part.normals) args.normals = part.normals->as<UintBuf>();
    args.ops = ops->block->as<DeformOpBuf>();
    args.opCount = uint32_t(part.program.size());
    args.each = uint32_t(each);
    if (normals && part.normals) {
        Result<Room> turned = room("deformed normals", uint64_t(nodeRow(count)) * sizeof(uint32_t));
        if (!turned) return turned.failure();
        out.normals = turned->block;
        args.toNormals = turned->block->as<UintBuf>();
        args.step = std::max(1e-3f * part.extent, 1e-9f);
        args.perStep = 1 / args.step;
        args.headings = part.kind == GeometryPart::Kind::points ? 1 : 0;
    }
    run("nodes/deform.comp", args, args.to.count);
    out.elements = uint32_t(copies * part.elements);
    if (copies > 1 && part.elements == part.used) out.row = uint32_t(each);
    out.program.clear();
    out.held.clear();
    return out;
}

Status NodeWork::runNow() {
    return machine_.run(std::exchange(list_, {}));
}

Result<std::vector<glm::vec3>> NodeWork::placesNow(const GeometryPart& part) {
    Result<GeometryPart> moved = realised(part);
    if (!moved) return moved.failure();
    if (Status ran = runNow(); !ran) return ran.failure();
    return readPlaces(machine_, *moved);
}

Result<std::vector<uint32_t>> NodeWork::wordsNow(const GeometryPart& part, const BlockRef& block) {
    if (Status ran = runNow(); !ran) return ran.failure();
    return readWords(machine_, part, block);
}

Result<NodeWork::WholeMesh> NodeWork::wholeMeshNow(const GeometryPart& mesh) {
    const uint32_t copies = uint32_t(mesh.instances());
    const uint64_t corners = uint64_t(mesh.indexCount) * copies;
    if (corners > kMostNodeElements)
        return Failure("", std::to_string(corners / 3) + " triangles are more than there is room for");
    GeometryPart all = mesh;
    if (!mesh.program.empty()) {
        Result<GeometryPart> made = deformed(mesh);
        if (!made) return made.failure();
        all = std::move(*made);
    }
    if (Status ran = runNow(); !ran) return ran.failure();
    WholeMesh out;
    if (Status read = assign(out.places, readPlaces(machine_, all)); !read) return read.failure();
    if (Status read = assign(out.corners, readCorners(machine_, mesh)); !read) return read.failure();
    const size_t once = out.corners.size();
    out.corners.reserve(corners);
    for (uint32_t copy = 1; copy < copies; ++copy)
        for (size_t i = 0; i < once; ++i) out.corners.push_back(out.corners[i] + copy * mesh.elements);
    return out;
}

Result<const GeometryPart*> NodeWork::part(const char* port, GeometryPart::Kind kind) const {
    constexpr const char* kNames[] = {"points", "curves", "a mesh"};
    for (const GeometryPart& part : geometry(port))
        if (part.kind == kind) return &part;
    return Failure("", std::string("'") + port + "' holds nothing that is " + kNames[size_t(kind)]);
}

}  // namespace espalier
