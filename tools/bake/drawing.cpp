// In: the model and the baked mesh. Out: vertices, indices and ranges for drawing. Triangles that were left out of
// the walk are drawn all the same.
#include <algorithm>

#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {

void makeDrawing(const Model& model, const BakeMesh& mesh, SurfaceData& surface) {
    size_t triangles = model.indices.size() / 3;
    std::vector<uint32_t> baked(triangles, kNone);  // the mesh's triangle of each of the model's
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) baked[mesh.triangles[t].source] = t;
    surface.materials = model.materials;
    surface.images = model.images;
    if (surface.materials.empty()) surface.materials.emplace_back();
    auto materialOf = [&](size_t t) {
        uint32_t m = model.triangleMaterial.empty() ? 0 : model.triangleMaterial[t];
        return m < surface.materials.size() ? m : 0u;
    };
    std::vector<uint32_t> order(triangles);
    for (uint32_t t = 0; t < triangles; ++t) order[t] = t;
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return materialOf(a) < materialOf(b); });
    // A vertex of the model becomes one of ours per place on the walk's UV square and normal; mostly one.
    struct Known {
        uint32_t corner, vertex, next;  // corner: of the mesh, kNone for triangles that aren't baked
    };
    std::vector<uint32_t> first(model.positions.size(), kNone);
    std::vector<Known> known;
    auto samePlace = [&](uint32_t a, uint32_t b) {
        if (a == kNone || b == kNone) return a == b;
        return mesh.chartOf(a) == mesh.chartOf(b) && mesh.uvAt(a) == mesh.uvAt(b) && mesh.normals[a] == mesh.normals[b];
    };
    std::vector<glm::vec3> flat;
    if (model.normals.empty()) {
        flat.assign(model.positions.size(), glm::vec3(0));
        for (size_t t = 0; t < triangles; ++t) {
            const uint32_t* v = &model.indices[t * 3];
            glm::vec3 n = glm::cross(model.positions[v[1]] - model.positions[v[0]],
                                     model.positions[v[2]] - model.positions[v[0]]);
            for (int k = 0; k < 3; ++k) flat[v[k]] += n;
        }
    }
    auto vertexFor = [&](uint32_t v, uint32_t corner) {
        for (uint32_t i = first[v]; i != kNone; i = known[i].next)
            if (samePlace(known[i].corner, corner)) return known[i].vertex;
        known.push_back({corner, uint32_t(surface.vertices.size()), first[v]});
        first[v] = uint32_t(known.size() - 1);
        DrawVertex d{};
        d.position = model.positions[v];
        d.normal = model.normals.empty() ? flat[v] : model.normals[v];
        if (corner != kNone) {
            d.normal = mesh.normals[corner];
            // What the weld has joined is to stay closed when it is simplified.
            d.position = glm::vec3(mesh.points[mesh.triangles[corner / 3].point[corner % 3]]);
        }
        float length = glm::length(d.normal);
        d.normal = length > 0 ? d.normal / length : glm::vec3(0, 1, 0);
        const auto& uvs = model.materialUvs.empty() ? model.uvs : model.materialUvs;
        glm::vec2 uv = uvs.empty() ? glm::vec2(0) : uvs[v];
        const auto orZero = [](glm::vec2 p) { return std::abs(p.x) < 1e6f && std::abs(p.y) < 1e6f ? p : glm::vec2(0); };
        d.uv = orZero(uv);
        if (!model.otherUvs.empty()) d.otherUv = orZero(model.otherUvs[v]);
        if (!model.colours.empty()) d.colour = packColour(model.colours[v]);
        if (corner != kNone) d.walkUv = glm::vec2(mesh.triangles[corner / 3].uv[corner % 3]);
        surface.vertices.push_back(d);
        return uint32_t(surface.vertices.size() - 1);
    };
    for (uint32_t t : order) {
        uint32_t material = materialOf(t);
        if (surface.ranges.empty() || surface.ranges.back().material != material)
            surface.ranges.push_back({uint32_t(surface.indices.size()), 0, material});
        for (uint32_t k = 0; k < 3; ++k) {
            uint32_t corner = kNone;
            if (uint32_t b = baked[t]; b != kNone) corner = b * 3 + (mesh.triangles[b].turned && k > 0 ? 3 - k : k);
            surface.indices.push_back(vertexFor(model.indices[size_t(t) * 3 + k], corner));
        }
        surface.ranges.back().indexCount += 3;
    }
    markBareTriangles(surface);
    markColoured(surface.vertices, surface.indices, surface.ranges, surface.materials);
    addTangents(surface.vertices, surface.indices, surface.ranges, surface.materials);
}

}  // namespace espalier::bakery
