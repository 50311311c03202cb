// In: materials, or what a file says of them. Out: the other of the two.
#include "runtime/surface/material_json.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/surface/surface_reader.hpp"

namespace espalier::surface_file {
namespace {

using nlohmann::ordered_json;

constexpr const char *kTransform = "KHR_texture_transform", *kTransmission = "KHR_materials_transmission",
                     *kStrength = "KHR_materials_emissive_strength";
constexpr int kWrapModes[kWraps] = {10497, 33071, 33648};  // glTF's, by Wrap
constexpr float kBrightest = 1e6f;
constexpr int kOtherUvSet = 2;  // TEXCOORD_2 is DrawVertex::otherUv, TEXCOORD_1 the walk's

class MaterialWriter {
  public:
    MaterialWriter(const Material& m, Textures& textures, std::vector<std::string>& extensions)
        : m_(m), textures_(textures), extensions_(extensions) {}

    ordered_json run() {
        ordered_json pbr = {{"baseColorFactor", {m_.baseColor.r, m_.baseColor.g, m_.baseColor.b, m_.baseColor.a}},
                            {"metallicFactor", m_.metallic},
                            {"roughnessFactor", m_.roughness}};
        if (m_.baseColorImage >= 0) pbr["baseColorTexture"] = texture(m_.baseColorImage, m_.baseColorMap);
        if (m_.roughnessImage >= 0) pbr["metallicRoughnessTexture"] = texture(m_.roughnessImage, m_.roughnessMap);
        ordered_json material = {{"pbrMetallicRoughness", pbr}, {"doubleSided", m_.doubleSided}};
        if (m_.normalImage >= 0) {
            material["normalTexture"] = texture(m_.normalImage, m_.normalMap);
            material["normalTexture"]["scale"] = m_.normalScale;
        }
        addEmission(material);
        if (m_.alphaCutoff > 0) {
            material["alphaMode"] = "MASK";
            material["alphaCutoff"] = m_.alphaCutoff;
        } else if (m_.blended && !(m_.transmission > 0)) {
            material["alphaMode"] = "BLEND";
        }
        if (m_.transmission > 0) extend(material, kTransmission, {{"transmissionFactor", m_.transmission}});
        if (m_.bare) material["extras"] = {{"bare", true}};
        return material;
    }

  private:
    void extend(ordered_json& object, const char* name, ordered_json value) {
        object["extensions"][name] = std::move(value);
        if (std::ranges::find(extensions_, name) == extensions_.end()) extensions_.push_back(name);
    }

    ordered_json texture(int image, const TextureMap& map) {
        ordered_json info = {{"index", textures_.find(image, {m_.wrapU, m_.wrapV})}};
        if (map.set != 0) info["texCoord"] = kOtherUvSet;
        if (map == TextureMap{.set = map.set}) return info;
        extend(info, kTransform,
               {{"offset", {map.offset.x, map.offset.y}},
                {"rotation", map.rotation},
                {"scale", {map.scale.x, map.scale.y}}});
        return info;
    }

    // Factors end at 1: what is brighter has a strength.
    void addEmission(ordered_json& material) {
        const float most = std::max({m_.emissive.r, m_.emissive.g, m_.emissive.b});
        if (!(most > 0)) return;
        const float strength = std::max(most, 1.0f);
        const glm::vec3 factor = m_.emissive / strength;
        material["emissiveFactor"] = {factor.r, factor.g, factor.b};
        if (m_.emissiveImage >= 0) material["emissiveTexture"] = texture(m_.emissiveImage, m_.emissiveMap);
        if (strength > 1) extend(material, kStrength, {{"emissiveStrength", strength}});
    }

    const Material& m_;
    Textures& textures_;
    std::vector<std::string>& extensions_;
};

const json& memberOf(const json& object, const char* key) {
    static const json none;
    return object.is_object() && object.contains(key) ? object[key] : none;
}

float numberIn(const json& list, size_t index, float otherwise) {
    if (!list.is_array() || index >= list.size() || !list[index].is_number()) return otherwise;
    const float value = list[index].get<float>();
    return std::isfinite(value) ? value : otherwise;
}

}  // namespace

size_t Textures::find(int image, Wraps wraps) {
    const auto [sampler, first] = samplers_.try_emplace(wraps, samplers_.size());
    if (first)
        samplers.push_back({{"magFilter", 9729},
                            {"minFilter", 9987},
                            {"wrapS", kWrapModes[size_t(wraps.first)]},
                            {"wrapT", kWrapModes[size_t(wraps.second)]}});
    const auto [texture, added] = textures_.try_emplace({image, wraps}, textures_.size());
    if (added) textures.push_back({{"source", image}, {"sampler", sampler->second}});
    return texture->second;
}

ordered_json materialJson(const Material& material, Textures& textures, std::vector<std::string>& extensions) {
    return MaterialWriter(material, textures, extensions).run();
}

Material materialOf(const json& object) {
    Material m;
    const json &pbr = memberOf(object, "pbrMetallicRoughness"), &extensions = memberOf(object, "extensions");
    for (size_t k = 0; k < 4; ++k)
        m.baseColor[int(k)] = numberIn(memberOf(pbr, "baseColorFactor"), k, m.baseColor[int(k)]);
    const float strength = number(memberOf(extensions, kStrength), "emissiveStrength", 1);
    for (size_t k = 0; k < 3; ++k)
        m.emissive[int(k)] =
            std::clamp(strength * numberIn(memberOf(object, "emissiveFactor"), k, 0), 0.0f, kBrightest);
    m.normalScale = number(memberOf(object, "normalTexture"), "scale", 1);
    m.roughness = std::clamp(number(pbr, "roughnessFactor", 1), 0.0f, 1.0f);
    m.metallic = std::clamp(number(pbr, "metallicFactor", 0), 0.0f, 1.0f);
    m.transmission = std::clamp(number(memberOf(extensions, kTransmission), "transmissionFactor", 0), 0.0f, 1.0f);
    m.blended = memberOf(object, "alphaMode") == "BLEND" || m.transmission > 0;
    m.alphaCutoff = number(object, "alphaCutoff", 0);
    m.doubleSided = flag(object, "doubleSided");
    m.bare = flag(memberOf(object, "extras"), "bare");
    return m;
}

TextureMap textureMapOf(const json& texture) {
    TextureMap map;
    map.set = number(texture, "texCoord", 0) == kOtherUvSet ? 1 : 0;
    const json& moved = memberOf(memberOf(texture, "extensions"), kTransform);
    map.offset = {numberIn(memberOf(moved, "offset"), 0, 0), numberIn(memberOf(moved, "offset"), 1, 0)};
    map.scale = {numberIn(memberOf(moved, "scale"), 0, 1), numberIn(memberOf(moved, "scale"), 1, 1)};
    map.rotation = number(moved, "rotation", 0);
    return map;
}

// What isn't said, or isn't known, repeats.
Wraps wrapsOf(const json& sampler) {
    const auto along = [&](const char* key) {
        const float mode = number(sampler, key, 0);
        const auto* found = std::ranges::find_if(kWrapModes, [&](int known) { return float(known) == mode; });
        return found == std::end(kWrapModes) ? Wrap::repeat : Wrap(found - kWrapModes);
    };
    return {along("wrapS"), along("wrapT")};
}

}  // namespace espalier::surface_file
