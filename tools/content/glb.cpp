// Encodes pictures and glTF binaries. In: meshes, materials, encoded images. Out: a .glb with one buffer, written
// beside its target and renamed.

#include "tools/content/glb.hpp"

#include <nlohmann/json.hpp>
#include <span>

#include "runtime/core/file.hpp"
#include "runtime/core/glb.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace espalier::content {
namespace {

using Json = nlohmann::ordered_json;

void append(void* context, void* data, int size) {
    auto* out = static_cast<std::vector<uint8_t>*>(context);
    auto* bytes = static_cast<uint8_t*>(data);
    out->insert(out->end(), bytes, bytes + size);
}

std::vector<uint8_t> channelsOf(const Picture& picture, int channels) {
    std::vector<uint8_t> out;
    out.reserve(picture.rgba.size() / 4 * static_cast<size_t>(channels));
    for (size_t i = 0; i < picture.rgba.size(); i += 4)
        for (size_t k = 0; k < static_cast<size_t>(channels); ++k) out.push_back(picture.rgba[i + k]);
    return out;
}

class Writer {
  public:
    Json json;
    std::vector<uint8_t> blob;

    int view(const void* data, size_t bytes, int target) {
        while (blob.size() % 4 != 0) blob.push_back(0);
        Json v = {{"buffer", 0}, {"byteOffset", blob.size()}, {"byteLength", bytes}};
        if (target != 0) v["target"] = target;
        auto* from = static_cast<const uint8_t*>(data);
        blob.insert(blob.end(), from, from + bytes);
        json["bufferViews"].push_back(std::move(v));
        return static_cast<int>(json["bufferViews"].size()) - 1;
    }
    int accessor(int bufferView, int type, size_t count, const char* shape) {
        json["accessors"].push_back(
            {{"bufferView", bufferView}, {"componentType", type}, {"count", count}, {"type", shape}});
        return static_cast<int>(json["accessors"].size()) - 1;
    }
    void addMesh(const GlbMesh& m) {
        const Mesh& mesh = *m.mesh;
        constexpr int kFloat = 5126, kUint = 5125, kArray = 34962, kElements = 34963;
        int position = accessor(view(mesh.positions.data(), mesh.positions.size() * 12, kArray), kFloat,
                                mesh.positions.size(), "VEC3");
        glm::vec3 low = mesh.positions.at(0), high = low;
        for (glm::vec3 p : mesh.positions) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        Json& bounds = json["accessors"][static_cast<size_t>(position)];
        bounds["min"] = {low.x, low.y, low.z};
        bounds["max"] = {high.x, high.y, high.z};
        int normal =
            accessor(view(mesh.normals.data(), mesh.normals.size() * 12, kArray), kFloat, mesh.normals.size(), "VEC3");
        int uv = accessor(view(mesh.uvs.data(), mesh.uvs.size() * 8, kArray), kFloat, mesh.uvs.size(), "VEC2");
        int index = accessor(view(mesh.indices.data(), mesh.indices.size() * 4, kElements), kUint, mesh.indices.size(),
                             "SCALAR");
        Json primitive = {{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}},
                          {"indices", index},
                          {"material", m.material},
                          {"mode", 4}};
        json["nodes"].push_back({{"name", m.name}, {"mesh", json["nodes"].size()}});
        json["meshes"].push_back({{"name", m.name}, {"primitives", Json::array({std::move(primitive)})}});
        if (m.pixels > 0) json["meshes"].back()["extras"] = {{"pixels", m.pixels}};
    }
};

Json materialJson(const GlbMaterial& m) {
    // Sampler 0 clamps, 1 repeats; an image has a texture for each.
    auto texture = [&](int image) { return Json{{"index", image * 2 + (m.repeat ? 1 : 0)}}; };
    Json pbr = {{"metallicFactor", 0}, {"roughnessFactor", m.roughness}};
    if (m.colorImage >= 0) pbr["baseColorTexture"] = texture(m.colorImage);
    Json out = {{"name", m.name}, {"pbrMetallicRoughness", std::move(pbr)}};
    if (m.normalImage >= 0) out["normalTexture"] = texture(m.normalImage);
    if (m.alphaCutoff > 0) {
        out["alphaMode"] = "MASK";
        out["alphaCutoff"] = m.alphaCutoff;
    }
    if (m.doubleSided) out["doubleSided"] = true;
    return out;
}

}  // namespace

std::vector<uint8_t> encodePng(const Picture& picture, int channels) {
    std::vector<uint8_t> out, data = channelsOf(picture, channels);
    stbi_write_png_to_func(append, &out, picture.width, picture.height, channels, data.data(),
                           picture.width * channels);
    return out;
}

std::vector<uint8_t> encodeJpeg(const Picture& picture, int quality) {
    std::vector<uint8_t> out, data = channelsOf(picture, 3);
    stbi_write_jpg_to_func(append, &out, picture.width, picture.height, 3, data.data(), quality);
    return out;
}

Status writeBytes(const std::string& path, const std::vector<uint8_t>& bytes) {
    return writeFile(path, std::as_bytes(std::span(bytes)));
}

Status writeGlb(const std::string& path, const Glb& glb) {
    Writer w;
    w.json["asset"] = {{"version", "2.0"}, {"generator", "espalier-content " ESPALIER_VERSION}};
    w.json["scene"] = 0;
    for (auto& m : glb.meshes) w.addMesh(m);
    Json roots = Json::array();
    for (size_t i = 0; i < glb.meshes.size(); ++i) roots.push_back(i);
    w.json["scenes"] = Json::array({Json{{"nodes", std::move(roots)}}});
    for (auto& m : glb.materials) w.json["materials"].push_back(materialJson(m));
    for (auto& image : glb.images) {
        size_t index = w.json["images"].size();
        int view = w.view(image.bytes.data(), image.bytes.size(), 0);
        w.json["images"].push_back(
            {{"name", image.name}, {"mimeType", image.png ? "image/png" : "image/jpeg"}, {"bufferView", view}});
        for (int sampler = 0; sampler < 2; ++sampler)
            w.json["textures"].push_back({{"source", index}, {"sampler", sampler}});
    }
    for (int wrap : {33071, 10497})
        w.json["samplers"].push_back({{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", wrap}, {"wrapT", wrap}});
    while (w.blob.size() % 4 != 0) w.blob.push_back(0);
    w.json["buffers"].push_back({{"byteLength", w.blob.size()}});
    return espalier::writeGlb(path, w.json.dump(), std::as_bytes(std::span(w.blob)));
}

}  // namespace espalier::content
