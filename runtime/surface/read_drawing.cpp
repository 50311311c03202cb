// In: an opened surface. Out: its materials with their pictures, the mesh, and the coarser ones.
#include <draco/compression/decode.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "runtime/core/jobs.hpp"
#include "runtime/surface/material_json.hpp"
#include "runtime/surface/picture.hpp"
#include "runtime/surface/surface_file.hpp"
#include "runtime/surface/surface_reader.hpp"

namespace espalier::surface_file {
namespace {

// The image of a texture of the material `out`, and by which UVs it is looked up. The first one's sampler says how all
// of the material's are wrapped.
int imageOf(const Container& file, const SurfaceData& data, const json& material, const char* key, Material& out,
            TextureMap& map) {
    if (!material.is_object() || !material.contains(key)) return -1;
    map = textureMapOf(material[key]);
    uint64_t texture = whole(material[key], "index", key, 1 << 20);
    const json& textures = array(file.root(), "textures", "glTF", 1 << 20);
    if (texture >= textures.size()) fail(key, "texture " + std::to_string(texture) + " does not exist");
    uint64_t image = whole(textures[texture], "source", indexed("textures", texture), 1 << 20);
    if (image >= data.images.size()) fail(indexed("textures", texture), "its image does not exist");
    if (!isTextured(out) && textures[texture].contains("sampler")) {
        const json& samplers = array(file.root(), "samplers", "glTF", 1 << 20);
        const uint64_t sampler = whole(textures[texture], "sampler", indexed("textures", texture), 1 << 20);
        if (sampler >= samplers.size()) fail(indexed("textures", texture), "its sampler does not exist");
        std::tie(out.wrapU, out.wrapV) = wrapsOf(samplers[sampler]);
    }
    return int(image);
}

void readPictures(Container& file, SurfaceData& data) {
    if (!file.root().contains("images")) return;
    const json& images = array(file.root(), "images", "glTF", kMaxImages);
    data.images.resize(images.size());
    if (file.partial()) return;  // they stand at the end
    std::vector<std::span<const std::byte>> bytes;
    for (size_t i = 0; i < images.size(); ++i) {
        const std::string place = indexed("images", i);
        bytes.push_back(file.view(whole(images[i], "bufferView", place, 1 << 20), place));
        const Result<uint64_t> texels = texelsOf(bytes.back(), "");
        if (!texels) fail(place, texels.failure().diagnostics.front().message);
        file.takePicture(texels.value() * 4 + bytes.back().size(), place);
    }
    std::vector<Result<Picture>> decoded(images.size(), Picture{});
    parallelFor(images.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) decoded[i] = decodePicture(bytes[i], "");
    });
    for (size_t i = 0; i < decoded.size(); ++i) {
        if (!decoded[i]) fail(indexed("images", i), decoded[i].failure().diagnostics.front().message);
        data.images[i] = std::move(*decoded[i]);
        auto* from = reinterpret_cast<const uint8_t*>(bytes[i].data());
        data.images[i].encoded.assign(from, from + bytes[i].size());
    }
}

void readMaterials(Container& file, SurfaceData& data) {
    readPictures(file, data);
    if (file.root().contains("materials"))
        for (const json& m : array(file.root(), "materials", "glTF", kMaxMaterials)) {
            Material out = materialOf(m);
            const json none = json::object();
            const json& pbr = m.is_object() && m.contains("pbrMetallicRoughness") ? m["pbrMetallicRoughness"] : none;
            out.baseColorImage = imageOf(file, data, pbr, "baseColorTexture", out, out.baseColorMap);
            out.roughnessImage = imageOf(file, data, pbr, "metallicRoughnessTexture", out, out.roughnessMap);
            out.normalImage = imageOf(file, data, m, "normalTexture", out, out.normalMap);
            out.emissiveImage = imageOf(file, data, m, "emissiveTexture", out, out.emissiveMap);
            data.materials.push_back(out);
        }
    if (data.materials.empty()) data.materials.emplace_back();
}

template <class Read>
void readColours(const Read& read, std::span<DrawVertex> vertices) {
    std::vector<glm::vec4> colours(vertices.size());
    read("COLOR_0", 4, [&](DrawVertex& v) { return &colours[size_t(&v - vertices.data())].x; });
    for (size_t i = 0; i < colours.size(); ++i) vertices[i].colour = packColour(colours[i]);
}

void readPrimitive(Container& file, const json& primitive, const std::vector<Material>& materials,
                   const std::string& place, CoarserMesh& into) {
    const json& packed = at(at(primitive, "extensions", place), kDraco, place);
    auto bytes = file.view(whole(packed, "bufferView", place, 1 << 20), place);
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) fail(place, std::string("damaged Draco data: ") + decoded.status().error_msg());
    const draco::Mesh& mesh = *decoded.value();
    uint32_t base = uint32_t(into.vertices.size()), count = mesh.num_points();
    if (uint64_t(base) + count > kMaxRecords) fail(place, "absurd vertex count");
    if (into.indices.size() + uint64_t(mesh.num_faces()) * 3 > kMaxRecords) fail(place, "absurd index count");
    file.take(count * sizeof(DrawVertex) + uint64_t(mesh.num_faces()) * 12, place);
    into.vertices.resize(size_t(base) + count, DrawVertex{});
    const json& ids = at(packed, "attributes", place);
    auto read = [&](const char* name, int components, auto&& field) {
        const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(uint32_t(whole(ids, name, place, 255)));
        if (!attribute || attribute->num_components() != components) fail(place, std::string("no usable ") + name);
        for (uint32_t i = 0; i < count; ++i) {
            auto value = attribute->mapped_index(draco::PointIndex(i));
            if (value.value() >= attribute->size() ||
                !attribute->ConvertValue<float>(value, int8_t(components), field(into.vertices[base + i])))
                fail(place, std::string("damaged ") + name);
        }
    };
    read("POSITION", 3, [](DrawVertex& v) { return &v.position.x; });
    for (uint32_t i = 0; i < count; ++i)
        if (!sane(into.vertices[base + i].position)) fail(place, "a POSITION is not a number");
    read("NORMAL", 3, [](DrawVertex& v) { return &v.normal.x; });
    read("TEXCOORD_0", 2, [](DrawVertex& v) { return &v.uv.x; });
    read("TEXCOORD_1", 2, [](DrawVertex& v) { return &v.walkUv.x; });
    if (ids.contains("COLOR_0")) readColours(read, std::span(into.vertices).subspan(base));
    if (ids.contains("TEXCOORD_2")) read("TEXCOORD_2", 2, [](DrawVertex& v) { return &v.otherUv.x; });
    uint64_t material = primitive.contains("material") ? whole(primitive, "material", place, materials.size() - 1) : 0;
    into.ranges.push_back({uint32_t(into.indices.size()), mesh.num_faces() * 3, uint32_t(material)});
    for (uint32_t f = 0; f < mesh.num_faces(); ++f)
        for (uint32_t k = 0; k < 3; ++k) {
            uint32_t v = mesh.face(draco::FaceIndex(f))[k].value();
            if (v >= count) fail(place, "index " + std::to_string(v) + " of " + std::to_string(count) + " vertices");
            into.indices.push_back(base + v);
        }
}

CoarserMesh readMesh(Container& file, uint64_t index, const std::vector<Material>& materials) {
    const json& meshes = array(file.root(), "meshes", "glTF", 1 << 16);
    const std::string place = indexed("meshes", index);
    if (index >= meshes.size()) fail(place, "does not exist");
    CoarserMesh mesh;
    const json& primitives = array(meshes[index], "primitives", place.c_str(), 1 << 16);
    for (size_t p = 0; p < primitives.size(); ++p)
        readPrimitive(file, primitives[p], materials, place + "." + indexed("primitives", p), mesh);
    addTangents(mesh.vertices, mesh.indices, mesh.ranges, materials);
    return mesh;
}

}  // namespace

void readDrawing(Container& file, SurfaceData& data) {
    readMaterials(file, data);
    for (const json& coarser : array(file.walk(), "coarser", kExtension, kMaxCoarser)) {
        const float before = data.coarser.empty() ? 0 : data.coarser.back().error;
        data.coarser.push_back(readMesh(file, whole(coarser, "mesh", "coarser", 1 << 16), data.materials));
        data.coarser.back().error = number(coarser, "error", -1);
        if (!(data.coarser.back().error >= before)) fail("coarser", "errors don't rise");
    }
    CoarserMesh mesh;
    if (file.partial() && !data.coarser.empty()) {
        mesh = std::move(data.coarser.front());
        data.coarser.erase(data.coarser.begin());
    } else {
        mesh = readMesh(file, 0, data.materials);
    }
    data.vertices = std::move(mesh.vertices);
    data.indices = std::move(mesh.indices);
    data.ranges = std::move(mesh.ranges);
    markColoured(data.vertices, data.indices, data.ranges, data.materials);
    markBareTriangles(data);
}

}  // namespace espalier::surface_file
