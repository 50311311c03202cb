// In: a document. Out: its materials as far as they are drawn, and the images that those use, decoded.
// What is missing or damaged becomes a warning: a model without its textures can still be baked.
#include <algorithm>
#include <cmath>
#include <map>

#include "tools/bake/import.hpp"

namespace espalier::import {
namespace {

using nlohmann::json;

Result<std::vector<uint8_t>> imageBytes(const Document& document, int index, const std::string& place) {
    if (!document.images.is_array() || index < 0 || size_t(index) >= document.images.size() ||
        !document.images[size_t(index)].is_object())
        return Failure(document.path, place + " does not exist");
    const json& image = document.images[size_t(index)];
    if (image.contains("uri") && image["uri"].is_string()) return readUri(document, image["uri"].get<std::string>());
    if (!image.contains("bufferView") || !image["bufferView"].is_number_unsigned() ||
        image["bufferView"].get<uint64_t>() >= document.views.size())
        return Failure(document.path, place + ": neither a file nor a buffer view");
    Bytes bytes = document.views[image["bufferView"].get<size_t>()];
    if (!document.intake->take(bytes.size()))
        return Failure(document.path, place + ": absurdly much for a file of its size");
    return std::vector<uint8_t>(bytes.begin(), bytes.end());
}

Result<Picture> decodeImage(const Document& document, int index) {
    std::string place = "images[" + std::to_string(index) + "]";
    auto bytes = imageBytes(document, index, place);
    if (!bytes) return std::move(bytes.failure());
    auto decoded = readPicture(std::move(*bytes), document.path, *document.intake);
    if (!decoded) return Failure(document.path, place + ": " + decoded.failure().diagnostics.front().message);
    return decoded;
}

// Decodes each image once, when a material first asks for it.
class Images {
  public:
    Images(const Document& document, std::vector<Picture>& images, std::vector<Diagnostic>& warnings)
        : document_(document), images_(images), warnings_(warnings) {}

    int find(int texture) {
        if (texture < 0) return -1;
        if (size_t(texture) >= document_.gltf.textures.size()) {
            warn("textures[" + std::to_string(texture) + "] does not exist");
            return -1;
        }
        int source = document_.gltf.textures[size_t(texture)].source;
        auto known = known_.find(source);
        if (known != known_.end()) return known->second;
        auto image = decodeImage(document_, source);
        int index = -1;
        if (image) {
            index = int(images_.size());
            images_.push_back(std::move(*image));
        } else {
            warn("texture left out: " + image.failure().diagnostics.front().message);
        }
        return known_[source] = index;
    }

  private:
    void warn(std::string text) { warnings_.push_back({document_.path, 0, 0, {}, std::move(text), true}); }

    const Document& document_;
    std::vector<Picture>& images_;
    std::vector<Diagnostic>& warnings_;
    std::map<int, int> known_;
};

float number(const tinygltf::Value& object, const char* key, size_t index, float otherwise) {
    if (!object.IsObject() || !object.Has(key)) return otherwise;
    const tinygltf::Value& value = object.Get(key);
    const tinygltf::Value& item = value.IsArray() ? value.Get(index) : value;
    double d = item.IsNumber() ? item.GetNumberAsDouble() : double(otherwise);
    return std::isfinite(d) ? float(d) : otherwise;
}

MaterialUv readTransform(const tinygltf::TextureInfo& info) {
    MaterialUv out;
    out.texCoord = info.texCoord;
    auto it = info.extensions.find("KHR_texture_transform");
    if (it == info.extensions.end()) return out;
    const tinygltf::Value& t = it->second;
    float ox = number(t, "offset", 0, 0), oy = number(t, "offset", 1, 0);
    float sx = number(t, "scale", 0, 1), sy = number(t, "scale", 1, 1);
    float r = number(t, "rotation", 0, 0), c = std::cos(r), s = std::sin(r);
    out.texCoord = int(std::clamp(number(t, "texCoord", 0, float(info.texCoord)), 0.0f, 8.0f));
    out.u = {c * sx, s * sy, ox};
    out.v = {-s * sx, c * sy, oy};
    return out;
}

// Does it let anything be seen through? Cut-outs don't count: leaves and grilles are something to climb.
bool isTransparent(const tinygltf::Material& from, const Material& m, const std::vector<Picture>& images) {
    const auto transmission = from.extensions.find("KHR_materials_transmission");
    if (transmission != from.extensions.end() && number(transmission->second, "transmissionFactor", 0, 0) > 0)
        return true;
    if (from.alphaMode != "BLEND") return false;
    if (m.baseColor.a < 1) return true;
    if (m.baseColorImage < 0) return false;
    const std::vector<uint8_t>& rgba = images[size_t(m.baseColorImage)].rgba;
    for (size_t i = 3; i < rgba.size(); i += 4)
        if (rgba[i] < 255) return true;
    return false;
}

float finite(double value, double otherwise) {
    return float(std::isfinite(value) ? value : otherwise);
}

}  // namespace

void readMaterials(const Document& document, Model& model, std::vector<MaterialUv>& uvs) {
    std::vector<Material>& materials = model.materials;
    Images found(document, model.images, model.warnings);
    for (const tinygltf::Material& from : document.gltf.materials) {
        Material m;
        const auto& pbr = from.pbrMetallicRoughness;
        for (size_t i = 0; i < 4 && i < pbr.baseColorFactor.size(); ++i)
            m.baseColor[int(i)] = finite(pbr.baseColorFactor[i], 1);
        m.baseColorImage = found.find(pbr.baseColorTexture.index);
        m.normalImage = found.find(from.normalTexture.index);
        m.normalScale = finite(from.normalTexture.scale, 1);
        m.roughness = std::clamp(finite(pbr.roughnessFactor, 1), 0.0f, 1.0f);
        m.doubleSided = from.doubleSided;
        // Blending is drawn as a cut-out at one half.
        if (from.alphaMode == "MASK") m.alphaCutoff = finite(from.alphaCutoff, 0.5);
        if (from.alphaMode == "BLEND" && m.baseColorImage >= 0) m.alphaCutoff = 0.5f;
        m.bare = isTransparent(from, m, model.images);
        materials.push_back(m);
        model.materialNames.push_back(from.name);
        uvs.push_back(readTransform(pbr.baseColorTexture));
    }
    if (materials.empty()) {
        materials.emplace_back();
        model.materialNames.emplace_back();
        uvs.emplace_back();
    }
}

}  // namespace espalier::import
