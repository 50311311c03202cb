// Meshes: lofts and primitives.
#include "runtime/nodes/node_work.hpp"
#include "runtime/surface/surface.hpp"
#include "shaders/shared/node_loft.h"

namespace espalier {
namespace {

constexpr float kFar = 1e6f;  // metres
constexpr float kMostSides = 4096;

// Corners of sheets of quads. They stay while these numbers do.
Status addSheets(NodeWork& work, GeometryPart& part, uint32_t row, uint32_t sheets, uint32_t rows, uint32_t columns) {
    const uint64_t quads = uint64_t(sheets) * (rows - 1) * (columns - 1);
    if (quads > kMostNodeElements)
        return Failure("", std::to_string(2 * quads) + " triangles are more than there is room for");
    Result<NodeWork::Room> room = work.room("corners", quads * 24, NodeWork::key({row, sheets, rows, columns}));
    if (!room) return room.failure();
    SheetArgs args{room->block->as<UintBuf>(), row, sheets, rows, columns, uint32_t(quads), 0};
    if (room->fresh) work.run("nodes/sheet.comp", args, quads);
    part.indices = room->block;
    part.indexCount = uint32_t(quads * 6);
    return Done{};
}

Status loft(NodeWork& work, const GeometryPart& given, const GeometryPart& ring, GeometryPart& part) {
    Result<GeometryPart> path = work.realised(given);
    if (!path) return path.failure();
    const uint64_t elements = uint64_t(path->positions.count) * ring.samples;
    if (elements > kMostNodeElements)
        return Failure("", std::to_string(elements) + " vertices are more than there is room for");
    part.kind = GeometryPart::Kind::mesh;
    part.material = given.material;
    BlockRef frameBlock;
    Result<NodePlanes> frames = work.planes("frames", path->positions.count, 6, frameBlock);
    if (!frames) return frames.failure();
    Result<NodePlanes> vertices = work.planes("loft", uint32_t(elements), 3, part.positionBlock);
    if (!vertices) return vertices.failure();
    Result<NodeWork::Room> normals = work.room("loft normals", nodeRow(uint32_t(elements)) * 4ull);
    if (!normals) return normals.failure();
    part.normals = normals->block;
    part.positions = *vertices;
    part.elements = path->elements * ring.samples;
    part.row = path->row;
    part.used = path->used;
    part.extent = path->extent + ring.extent;
    work.run("nodes/frames.comp",
             FrameArgs{path->positions, *frames, path->row, path->used, path->samples, path->closed ? 1u : 0u},
             path->used);
    LoftArgs args{};
    args.path = path->positions;
    args.frames = *frames;
    args.ring = ring.positions;
    args.to = *vertices;
    args.normals = normals->block->as<UintBuf>();
    args.row = path->row;
    args.ringRow = ring.row;
    args.curves = path->used;
    args.samples = path->samples;
    args.ringSamples = ring.samples;
    args.ringClosed = ring.closed ? 1 : 0;
    args.taper = work.number("taper");
    work.run("nodes/loft.comp", args, part.elements);
    return addSheets(work, part, path->row, path->used, path->samples, ring.samples);
}

Status makeLoft(NodeWork& work) {
    Result<const GeometryPart*> shape = work.part("shape", GeometryPart::Kind::curves);
    if (!shape) return shape.failure();
    Result<GeometryPart> ring = work.realised(**shape);
    if (!ring) return ring.failure();
    Geometry out;
    for (const GeometryPart& given : work.geometry("path")) {
        if (given.kind != GeometryPart::Kind::curves) continue;
        if (Status made = loft(work, given, *ring, out.emplace_back()); !made) return made;
    }
    if (out.empty()) return Failure("", "'path' holds no curves");
    work.give(std::move(out));
    return Done{};
}

// A mesh that the host makes: rows of vertices, each a sheet of quads.
struct HostMesh {
    std::vector<glm::vec3> at, normals;
    std::vector<uint32_t> corners;
    void sheet(uint32_t first, uint32_t rows, uint32_t columns) {
        for (uint32_t r = 0; r + 1 < rows; ++r)
            for (uint32_t c = 0; c + 1 < columns; ++c) {
                const uint32_t a = first + r * columns + c, b = a + columns;
                corners.insert(corners.end(), {a, b, a + 1, a + 1, b, b + 1});
            }
    }
};

Status giveMesh(NodeWork& work, const HostMesh& mesh) {
    std::vector<uint32_t> normals;
    float extent = 0;
    for (const glm::vec3& at : mesh.at) extent = std::max(extent, 2 * glm::length(at));
    for (const glm::vec3& normal : mesh.normals) normals.push_back(packOct(normal));
    normals.resize(nodeRow(uint32_t(normals.size())));
    GeometryPart part;
    Result<NodePlanes> planes = work.sentPlaces("mesh", mesh.at, part.positionBlock);
    if (!planes) return planes.failure();
    Result<NodeWork::Room> outside = work.sent("mesh normals", normals);
    if (!outside) return outside.failure();
    Result<NodeWork::Room> corners = work.sent("mesh corners", mesh.corners);
    if (!corners) return corners.failure();
    part.kind = GeometryPart::Kind::mesh;
    part.positions = *planes;
    part.elements = part.row = part.used = planes->count;
    part.normals = outside->block;
    part.indices = corners->block;
    part.indexCount = uint32_t(mesh.corners.size());
    part.extent = std::max(extent, 1e-6f);
    work.give(Geometry{part});
    return Done{};
}

// A surface of revolution about y: place(v, out, up) gives the profile's place and its outside's direction.
template <class Profile>
HostMesh revolved(uint32_t sides, uint32_t rows, const Profile& profile) {
    HostMesh mesh;
    for (uint32_t r = 0; r < rows; ++r) {
        const glm::vec4 p = profile(float(r) / float(rows - 1));
        for (uint32_t c = 0; c <= sides; ++c) {
            float s, k;
            sinCosExact(6.28318531f * float(c % sides) / float(sides), s, k);
            mesh.at.emplace_back(p.x * k, p.y, p.x * s);
            mesh.normals.emplace_back(p.z * k, p.w, p.z * s);
        }
    }
    mesh.sheet(0, rows, sides + 1);
    return mesh;
}

Status makeSphere(NodeWork& work) {
    const float radius = work.number("radius");
    return giveMesh(work, revolved(work.whole("sides"), work.whole("sides") / 2 + 1, [&](float v) {
                        float s, c;
                        sinCosExact(kPi * v, s, c);
                        return glm::vec4(radius * s, -radius * c, s, -c);
                    }));
}
Status makeTorus(NodeWork& work) {
    const float radius = work.number("radius"), tube = work.number("tube");
    return giveMesh(work, revolved(work.whole("sides"), work.whole("sides") / 2 + 1, [&](float v) {
                        float s, c;
                        sinCosExact(6.28318531f * (v < 1 ? v : 0), s, c);
                        return glm::vec4(radius + tube * c, tube * s, c, s);
                    }));
}
Status makeCylinder(NodeWork& work) {
    const float radius = work.number("radius"), height = work.number("height");
    const uint32_t sides = work.whole("sides"), rows = work.whole("rows") + 1;
    HostMesh mesh = revolved(sides, rows, [&](float v) { return glm::vec4(radius, height * v, 1, 0); });
    for (const float end : {0.0f, 1.0f}) {
        const uint32_t first = uint32_t(mesh.at.size());
        const HostMesh cap = revolved(sides, 2, [&](float v) {
            return glm::vec4(radius * (end > 0 ? 1 - v : v), height * end, 0, end > 0 ? 1 : -1);
        });
        mesh.at.insert(mesh.at.end(), cap.at.begin(), cap.at.end());
        mesh.normals.insert(mesh.normals.end(), cap.normals.begin(), cap.normals.end());
        for (const uint32_t corner : cap.corners) mesh.corners.push_back(first + corner);
    }
    return giveMesh(work, mesh);
}

// A rectangle of `cells` by `cells` quads: centre + a * (-1 .. 1) + b * (-1 .. 1), whose outside is a x b.
void addRectangle(HostMesh& mesh, glm::vec3 centre, glm::vec3 a, glm::vec3 b, uint32_t cells) {
    const uint32_t first = uint32_t(mesh.at.size());
    for (uint32_t r = 0; r <= cells; ++r)
        for (uint32_t c = 0; c <= cells; ++c) {
            mesh.at.push_back(centre + a * (2 * float(c) / float(cells) - 1) + b * (2 * float(r) / float(cells) - 1));
            mesh.normals.push_back(unit3(cross3(a, b)));
        }
    const size_t corners = mesh.corners.size();
    mesh.sheet(first, cells + 1, cells + 1);
    for (size_t i = corners; i + 2 < mesh.corners.size(); i += 3) std::swap(mesh.corners[i + 1], mesh.corners[i + 2]);
}
Status makePlane(NodeWork& work) {
    const glm::vec3 half = work.vector("size") * 0.5f;
    HostMesh mesh;
    addRectangle(mesh, {}, {0, 0, half.z}, {half.x, 0, 0}, work.whole("cells"));
    return giveMesh(work, mesh);
}
Status makeCube(NodeWork& work) {
    const glm::vec3 half = work.vector("size") * 0.5f;
    HostMesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 a{0}, b{0}, centre{0};
            centre[axis] = side * half[axis];
            a[(axis + 1) % 3] = side * half[(axis + 1) % 3];
            b[(axis + 2) % 3] = half[(axis + 2) % 3];
            addRectangle(mesh, centre, a, b, work.whole("cells"));
        }
    return giveMesh(work, mesh);
}

// The drawn mesh of a baked surface.
Status makeMeshFile(NodeWork& work) {
    if (work.text("file").empty()) return Failure("", "'file' names no file");
    Result<NodeFile> file = work.file("file");
    if (!file) return file.failure();
    Result<SurfaceData> surface = parseSurface(std::move(file->bytes), work.text("file"));
    if (!surface) return Failure("", surface.failure().text());
    HostMesh mesh;
    for (const DrawVertex& vertex : surface->vertices) {
        mesh.at.push_back(vertex.position);
        mesh.normals.push_back(vertex.normal);
    }
    mesh.corners = std::move(surface->indices);
    return giveMesh(work, mesh);
}

}  // namespace

std::vector<NodeKind> meshKinds() {
    const auto sides = [](float standard) { return wholePort("sides", standard, 3, kMostSides, "around"); };
    const auto radius = [](float standard) { return numberPort("radius", standard, 0, kFar, "m", ""); };
    const auto size = [] { return vectorPort("size", glm::vec3(1), 0, kFar, "m", "along each axis"); };
    const auto cells = [] { return wholePort("cells", 1, 1, 1000, "quads along each side"); };
    const std::vector<NodeOutput> mesh{{"mesh", ValueType::mesh}};
    return {
        {"Loft",
         "A shape is swept along each path: tubes, ribbons, mouldings. Frames turn as little as they can.",
         {wirePort("path", ValueType::curves, "what it is swept along"),
          wirePort("shape", ValueType::curves, "what is swept: x and y lie across the path"),
          numberPort("taper", 1, 0, 100, "", "its size at a path's end, of that at the beginning")},
         mesh,
         makeLoft,
         {"nodes/frames.comp", "nodes/loft.comp", "nodes/sheet.comp"}},
        {"Sphere", "A sphere about the origin.", {radius(0.5f), sides(32)}, mesh, makeSphere},
        {"Torus",
         "A ring about the y axis.",
         {radius(0.5f), numberPort("tube", 0.15f, 0, kFar, "m", "the ring's own radius"), sides(48)},
         mesh,
         makeTorus},
        {"Cylinder",
         "A cylinder that stands on the origin, with both ends closed.",
         {radius(0.5f), numberPort("height", 1, 0, kFar, "m", ""), sides(32),
          wholePort("rows", 1, 1, 4096, "quads along its height")},
         mesh,
         makeCylinder},
        {"Plane", "A rectangle in the plane y = 0.", {size(), cells()}, mesh, makePlane},
        {"Cube", "A box about the origin.", {size(), cells()}, mesh, makeCube},
        {"MeshFile",
         "The mesh of a surface that espalier-bake wrote, without its textures.",
         {{"file", ValueType::file, "", 0, 0, "", "beside the graph's own file"}},
         mesh,
         makeMeshFile},
    };
}

}  // namespace espalier
