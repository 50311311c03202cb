// In: a document. Out: its materials as far as they are drawn, and the images that those use.
#include <algorithm>
#include <cmath>

#include "tools/bake/import_gltf.hpp"

namespace espalier::import {
namespace {

constexpr int kMaxUvSet = 7;
constexpr float kBrightest = 1e4f;     // of emission: what a sun's picture would need
constexpr float kDarkDiffuse = 0.04f;  // below it a material of specular and glossiness is a metal

float number(const tinygltf::Value& object, const char* key, size_t index, float otherwise) {
    if (!object.IsObject() || !object.Has(key)) return otherwise;
    const tinygltf::Value& value = object.Get(key);
    const tinygltf::Value& item = value.IsArray() ? value.Get(index) : value;
    double d = item.IsNumber() ? item.GetNumberAsDouble() : double(otherwise);
    return std::isfinite(d) ? float(d) : otherwise;
}

float finite(double value, double otherwise) {
    return float(std::isfinite(value) ? value : otherwise);
}

const tinygltf::Value* extensionOf(const tinygltf::ExtensionMap& extensions, const char* name) {
    auto it = extensions.find(name);
    return it == extensions.end() ? nullptr : &it->second;
}

// Does it let anything be seen through? Cut-outs don't count: leaves and grilles are something to climb.
bool isTransparent(const tinygltf::Material& from, const Material& m, const std::vector<Picture>& images) {
    if (m.transmission > 0) return true;
    if (from.alphaMode != "BLEND") return false;
    if (m.baseColor.a < 1) return true;
    if (m.baseColorImage < 0) return false;
    const std::vector<uint8_t>& rgba = images[size_t(m.baseColorImage)].rgba;
    for (size_t i = 3; i < rgba.size(); i += 4)
        if (rgba[i] < 255) return true;
    return false;
}

// One material on its way: its textures keep the sets that the file names until all are known.
class Reader {
  public:
    Reader(const Document& document, const tinygltf::Material& from, Textures& textures, Model& model)
        : document_(document), from_(from), textures_(textures), model_(model) {}

    Material run(MaterialUv& uv) {
        if (const auto* old = extensionOf(from_.extensions, "KHR_materials_pbrSpecularGlossiness"))
            readSpecularGlossiness(*old);
        else
            readMetallicRoughness();
        take(from_.normalTexture.index, from_.normalTexture.texCoord, from_.normalTexture.extensions, m_.normalImage,
             m_.normalMap);
        m_.normalScale = finite(from_.normalTexture.scale, 1);
        m_.doubleSided = from_.doubleSided;
        readEmission();
        readTransparency();
        shareMaps(uv);
        return m_;
    }

  private:
    void warn(std::string text) {
        const std::string name = from_.name.empty() ? "" : " '" + from_.name + "'";
        model_.warnings.push_back({document_.path, 0, 0, {}, "material" + name + ": " + std::move(text), true});
    }

    void readMetallicRoughness() {
        const auto& pbr = from_.pbrMetallicRoughness;
        for (size_t i = 0; i < 4 && i < pbr.baseColorFactor.size(); ++i)
            m_.baseColor[int(i)] = finite(pbr.baseColorFactor[i], 1);
        take(pbr.baseColorTexture.index, pbr.baseColorTexture.texCoord, pbr.baseColorTexture.extensions,
             m_.baseColorImage, m_.baseColorMap);
        m_.roughness = std::clamp(finite(pbr.roughnessFactor, 1), 0.0f, 1.0f);
        m_.metallic = std::clamp(finite(pbr.metallicFactor, 1), 0.0f, 1.0f);
        const auto& rough = pbr.metallicRoughnessTexture;
        take(rough.index, rough.texCoord, rough.extensions, m_.roughnessImage, m_.roughnessMap);
    }

    // What is diffuse there is the base colour of what is no metal; metals have none, and shine in their specular one.
    void readSpecularGlossiness(const tinygltf::Value& old) {
        for (size_t i = 0; i < 4; ++i) m_.baseColor[int(i)] = number(old, "diffuseFactor", i, 1);
        float glossiness = std::clamp(number(old, "glossinessFactor", 0, 1), 0.0f, 1.0f);
        if (old.IsObject() && old.Get("specularGlossinessTexture").IsObject())
            glossiness *= textures_.meanOf(int(number(old.Get("specularGlossinessTexture"), "index", 0, -1))).a;
        m_.roughness = 1 - glossiness;
        if (old.IsObject() && old.Get("diffuseTexture").IsObject()) {
            const tinygltf::Value& info = old.Get("diffuseTexture");
            tinygltf::ExtensionMap extensions;
            if (info.Get("extensions").Has("KHR_texture_transform"))
                extensions["KHR_texture_transform"] = info.Get("extensions").Get("KHR_texture_transform");
            take(int(number(info, "index", 0, -1)), int(number(info, "texCoord", 0, 0)), extensions, m_.baseColorImage,
                 m_.baseColorMap);
        }
        const glm::vec3 specular(number(old, "specularFactor", 0, 1), number(old, "specularFactor", 1, 1),
                                 number(old, "specularFactor", 2, 1));
        const float diffuse = std::max({m_.baseColor.r, m_.baseColor.g, m_.baseColor.b});
        const float shine = std::max({specular.r, specular.g, specular.b});
        if (diffuse < kDarkDiffuse && shine > diffuse && m_.baseColorImage < 0)
            m_.baseColor = glm::vec4(specular, m_.baseColor.a), m_.metallic = 1;
    }

    void readEmission() {
        float strength = 1;
        if (const auto* more = extensionOf(from_.extensions, "KHR_materials_emissive_strength"))
            strength = number(*more, "emissiveStrength", 0, 1);
        for (size_t i = 0; i < 3 && i < from_.emissiveFactor.size(); ++i)
            m_.emissive[int(i)] = std::clamp(finite(from_.emissiveFactor[i], 0) * strength, 0.0f, kBrightest);
        if (m_.emissive == glm::vec3(0)) return;
        const auto& texture = from_.emissiveTexture;
        take(texture.index, texture.texCoord, texture.extensions, m_.emissiveImage, m_.emissiveMap);
        // A texture that is lost would leave all of it shining.
        if (texture.index >= 0 && m_.emissiveImage < 0) m_.emissive = glm::vec3(0);
    }

    void readTransparency() {
        if (from_.alphaMode == "MASK") m_.alphaCutoff = finite(from_.alphaCutoff, 0.5);
        if (const auto* glass = extensionOf(from_.extensions, "KHR_materials_transmission")) {
            m_.transmission = std::clamp(number(*glass, "transmissionFactor", 0, 0), 0.0f, 1.0f);
            if (m_.transmission > 0 && glass->Has("transmissionTexture"))
                warn("its texture of transmission is not read: all of it lets light through");
        }
        m_.bare = m_.blended = isTransparent(from_, m_, model_.images);
    }

    // The image of a texture, and its map, `set` being a TEXCOORD still.
    void take(int texture, int texCoord, const tinygltf::ExtensionMap& extensions, int& image, TextureMap& map) {
        image = textures_.find(texture);
        if (image < 0) return;
        if (maps_.empty()) takeWrap(document_.gltf.textures[size_t(texture)].sampler);
        if (const auto* moved = extensionOf(extensions, "KHR_texture_transform")) {
            map.offset = {number(*moved, "offset", 0, 0), number(*moved, "offset", 1, 0)};
            map.scale = {number(*moved, "scale", 0, 1), number(*moved, "scale", 1, 1)};
            map.rotation = number(*moved, "rotation", 0, 0);
            texCoord = int(std::clamp(number(*moved, "texCoord", 0, float(texCoord)), -1.0f, kMaxUvSet + 1.0f));
        }
        if (texCoord < 0 || texCoord > kMaxUvSet) {
            warn("a texCoord is beyond 7: TEXCOORD_0 is taken");
            texCoord = 0;
        }
        map.set = uint32_t(texCoord);
        maps_.push_back(&map);
    }

    // All pictures of a material are wrapped as its first is.
    void takeWrap(int sampler) {
        if (sampler < 0 || size_t(sampler) >= document_.gltf.samplers.size()) return;
        const auto wrapOf = [](int named) {
            return named == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::clamp
                   : named == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror
                                                                    : Wrap::repeat;
        };
        m_.wrapU = wrapOf(document_.gltf.samplers[size_t(sampler)].wrapS);
        m_.wrapV = wrapOf(document_.gltf.samplers[size_t(sampler)].wrapT);
    }

    // A map that all textures share is applied to the vertices. Otherwise these keep two sets as they are.
    void shareMaps(MaterialUv& uv) {
        if (maps_.empty()) return;
        const TextureMap first = *maps_.front();
        uv.texCoord = int(first.set);
        if (std::ranges::all_of(maps_, [&](const TextureMap* map) { return *map == first; })) {
            const auto rows = rowsOf(first);
            uv.u = rows[0], uv.v = rows[1];
            for (TextureMap* map : maps_) *map = TextureMap();
            return;
        }
        for (TextureMap* map : maps_) {
            const int set = int(map->set);
            if (set != uv.texCoord && uv.other < 0) uv.other = set;
            if (set != uv.texCoord && set != uv.other)
                warn("its textures lie in more than two UV sets: TEXCOORD_" + std::to_string(uv.texCoord) +
                     " is taken for TEXCOORD_" + std::to_string(set));
            map->set = set == uv.other ? 1 : 0;
        }
    }

    const Document& document_;
    const tinygltf::Material& from_;
    Textures& textures_;
    Model& model_;
    Material m_;
    std::vector<TextureMap*> maps_;  // of textures that were found
};

}  // namespace

void readMaterials(const Document& document, Model& model, std::vector<MaterialUv>& uvs) {
    Textures textures(document, model.images, model.warnings);
    for (const tinygltf::Material& from : document.gltf.materials) {
        MaterialUv uv;
        model.materials.push_back(Reader(document, from, textures, model).run(uv));
        model.materialNames.push_back(from.name);
        uvs.push_back(uv);
    }
    if (model.materials.empty()) {
        model.materials.emplace_back();
        model.materialNames.emplace_back();
        uvs.emplace_back();
    }
}

}  // namespace espalier::import
