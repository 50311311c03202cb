// glTF's extensions: what is read, what is named, and what a model can't be read without.
#include <doctest/doctest.h>

#include "tests/bake/gltf_maker.hpp"
#include "tests/bake/tiny_pictures.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

using Json = nlohmann::json;

// A square with a material, and an image of these bytes for each given.
GltfMaker painted(const Json& material, std::initializer_list<std::vector<uint8_t>> images = {}) {
    GltfMaker maker = squareMaker();
    maker.primitive()["attributes"]["TEXCOORD_0"] = maker.add(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
    maker.primitive()["material"] = 0;
    maker.root["materials"] = {material};
    maker.root["images"] = Json::array();
    for (const auto& image : images)
        maker.root["images"].push_back({{"bufferView", maker.addValues(image)}, {"mimeType", "image/any"}});
    return maker;
}

const Json kTextured = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};

// libwebp comes with OpenImageIO, but nothing says that it must be there.
bool readsWebp() {
    GltfMaker maker = painted(kTextured, {kTinyWebp});
    maker.root["textures"] = {{{"source", 0}}};
    return maker.importOrFail().materials[0].baseColorImage >= 0;
}

}  // namespace

TEST_CASE("a required extension that may change the shape is refused by name; one of looks is a warning") {
    GltfMaker maker = squareMaker();
    maker.root["extensionsRequired"] = {"EXT_unheard_of"};
    CHECK(says(messageOf(maker.import()), "EXT_unheard_of is not supported"));
    maker.root["extensionsRequired"] = {"KHR_meshopt_compression"};
    CHECK(says(messageOf(maker.import()), "KHR_meshopt_compression is not supported"));

    maker.root["extensionsRequired"] = {"KHR_materials_clearcoat", "KHR_lights_punctual"};
    Model model = maker.importOrFail();
    CHECK(says(warningsOf(model.warnings), "KHR_materials_clearcoat is not read"));
    CHECK(says(warningsOf(model.warnings), "KHR_lights_punctual is not read"));
    CHECK(model.warnings.size() == 2);
    // Not required: looks are named, lights are none of a surface's.
    maker.root.erase("extensionsRequired");
    maker.root["extensionsUsed"] = {"KHR_materials_sheen", "KHR_lights_punctual", "KHR_texture_transform",
                                    "KHR_materials_emissive_strength", "KHR_node_visibility"};
    model = maker.importOrFail();
    REQUIRE(model.warnings.size() == 1);
    CHECK(says(warningsOf(model.warnings), "KHR_materials_sheen is not read"));
}

TEST_CASE("a material's pictures are wrapped as the sampler of the first one says, and repeat without one") {
    GltfMaker maker = painted(kTextured, {kTinyPng});
    maker.root["textures"] = {{{"source", 0}}};
    CHECK(maker.importOrFail().materials[0].wrapU == Wrap::repeat);
    maker.root["textures"][0]["sampler"] = 0;
    maker.root["samplers"] = Json::array({Json{{"wrapS", 33071}, {"wrapT", 33648}}});
    const Material material = maker.importOrFail().materials[0];
    CHECK(material.wrapU == Wrap::clamp);
    CHECK(material.wrapV == Wrap::mirror);
    maker.root["samplers"][0]["wrapT"] = 10497;
    CHECK(maker.importOrFail().materials[0].wrapV == Wrap::repeat);
}

TEST_CASE("nodes that are hidden are left out with what hangs below them, and carry skins all the same") {
    GltfMaker maker = squareMaker();
    const Json hidden = {{"KHR_node_visibility", {{"visible", false}}}};
    maker.root["nodes"] = {{{"mesh", 0}},
                           {{"mesh", 0}, {"translation", {5, 0, 0}}, {"extensions", hidden}, {"children", {2}}},
                           {{"mesh", 0}, {"translation", {0, 5, 0}}},
                           {{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}}};
    maker.root["scenes"] = {{{"nodes", {0, 1, 3}}}};
    const Model model = maker.importOrFail();
    CHECK(triangleArea(model) == 2);
    CHECK(says(warningsOf(model.warnings), "1 node is hidden by KHR_node_visibility"));
    for (int node : {0, 3}) maker.root["nodes"][size_t(node)]["extensions"] = hidden;
    CHECK(says(messageOf(maker.import()), "all of its meshes are hidden"));
}

TEST_CASE("specular and glossiness become base colour and roughness, and come before metal and roughness") {
    const auto materialOf = [](const Json& old, std::initializer_list<std::vector<uint8_t>> images = {}) {
        GltfMaker maker = painted({{"pbrMetallicRoughness", {{"baseColorFactor", {0, 1, 0, 1}}}},
                                   {"extensions", {{"KHR_materials_pbrSpecularGlossiness", old}}}},
                                  images);
        maker.root["textures"] = {{{"source", 0}}, {{"source", 0}}};
        maker.root["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
        return maker.importOrFail();
    };
    Model model = materialOf({{"diffuseFactor", {0.8, 0.05, 0.02, 0.5}}, {"glossinessFactor", 0.25}});
    CHECK(model.materials[0].baseColor == glm::vec4(0.8f, 0.05f, 0.02f, 0.5f));
    CHECK(model.materials[0].roughness == 0.75f);
    CHECK(model.warnings.empty());
    // A metal has no diffuse colour; what it is seen by is its specular one.
    model = materialOf({{"diffuseFactor", {0, 0, 0, 1}}, {"specularFactor", {1, 0.75, 0.25}}});
    CHECK(model.materials[0].baseColor == glm::vec4(1, 0.75f, 0.25f, 1));
    CHECK(materialOf(Json::object()).materials[0].baseColor == glm::vec4(1));

    model = materialOf({{"diffuseTexture", {{"index", 0}}}}, {kTinyPng});
    REQUIRE(model.materials[0].baseColorImage == 0);
    CHECK(model.images[0].rgba == kTinyTexels);
    // Of the other texture only the mean is kept: three texels shine, one shines half.
    model = materialOf({{"specularGlossinessTexture", {{"index", 0}}}}, {kTinyPng});
    CHECK(model.images.empty());
    CHECK(model.materials[0].roughness == doctest::Approx(1 - (3 + 128.0 / 255) / 4).epsilon(1e-4));
    model = materialOf({{"diffuseTexture", {{"index", 0}}}, {"specularGlossinessTexture", {{"index", 1}}}}, {kTinyPng});
    CHECK(model.images.size() == 1);
    CHECK(model.materials[0].baseColorImage == 0);
}

TEST_CASE("WebP is read, or named with its extension and image") {
    for (bool plain : {false, true}) {
        GltfMaker maker = painted(kTextured, {kTinyWebp, kTinyPng});
        Json texture = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
        if (plain) texture["source"] = 1;
        maker.root["textures"] = {texture};
        maker.root["extensionsRequired"] = {"EXT_texture_webp"};
        Model model = maker.importOrFail();
        if (readsWebp()) {
            REQUIRE(model.images.size() == 1);
            CHECK(model.images[0].rgba == kTinyTexels);
            CHECK(model.images[0].encoded.empty());  // surfaces hold no WebP
            CHECK(model.warnings.empty());
        } else {
            CHECK(says(warningsOf(model.warnings), "EXT_texture_webp: images[0]"));
            CHECK(model.materials[0].baseColorImage == (plain ? 0 : -1));
        }
    }
    // A damaged one falls back to the plain source.
    std::vector<uint8_t> damaged = kTinyWebp;
    damaged.resize(30);
    GltfMaker maker = painted(kTextured, {damaged, kTinyPng});
    maker.root["textures"] = {{{"source", 1}, {"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
    const Model model = maker.importOrFail();
    CHECK(says(warningsOf(model.warnings), "EXT_texture_webp: images[0]"));
    CHECK(says(warningsOf(model.warnings), "images[1] is taken in its place"));
    REQUIRE(model.materials[0].baseColorImage == 0);
    CHECK(model.images[0].rgba == kTinyTexels);
}

TEST_CASE("a texture that is stored as Basis Universal is named, and its plain source taken where it has one") {
    for (const char* name : {"KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"})
        for (bool plain : {false, true}) {
            CAPTURE(name);
            GltfMaker maker = painted(kTextured, {kTinyWebp, kTinyPng});
            Json texture = {{"extensions", {{name, {{"source", 0}}}}}};
            if (plain) texture["source"] = 1;
            maker.root["textures"] = {texture};
            maker.root["extensionsRequired"] = {name};
            const Model model = maker.importOrFail();
            REQUIRE(model.warnings.size() == 1);
            CHECK(says(warningsOf(model.warnings), std::string(name) + " is not read, images[0] neither"));
            CHECK(says(warningsOf(model.warnings), plain ? "images[1] is taken" : "the texture is left out"));
            CHECK(model.materials[0].baseColorImage == (plain ? 0 : -1));
        }
    GltfMaker none = painted(kTextured);
    none.root["textures"] = {Json::object()};
    CHECK(says(warningsOf(none.importOrFail().warnings), "textures[0] names no image"));
}

TEST_CASE("emission has a factor, a strength and a texture; without its texture it is dark") {
    Json material = {{"emissiveFactor", {1, 0.5, 0}},
                     {"emissiveTexture", {{"index", 0}}},
                     {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}};
    GltfMaker maker = painted(material, {kTinyPng});
    maker.root["textures"] = {{{"source", 0}}};
    Model model = maker.importOrFail();
    CHECK(model.materials[0].emissive == glm::vec3(4, 2, 0));
    CHECK(model.materials[0].emissiveImage == 0);
    maker.root["textures"] = {{{"source", 7}}};
    model = maker.importOrFail();
    CHECK(model.materials[0].emissive == glm::vec3(0));
    CHECK(says(warningsOf(model.warnings), "images[7]"));
    // A texture that is multiplied by nothing isn't read.
    maker.root["materials"][0]["emissiveFactor"] = {0, 0, 0};
    CHECK(maker.importOrFail().warnings.empty());
}

TEST_CASE("metal and roughness have factors and a texture, and a material that says nothing of it is of metal") {
    const Json factors = {
        {"metallicFactor", 0.75}, {"roughnessFactor", 0.25}, {"metallicRoughnessTexture", {{"index", 0}}}};
    GltfMaker maker = painted({{"pbrMetallicRoughness", factors}}, {kTinyPng});
    maker.root["textures"] = {{{"source", 0}}};
    const Model model = maker.importOrFail();
    CHECK(model.materials[0].metallic == 0.75f);
    CHECK(model.materials[0].roughness == 0.25f);
    CHECK(model.materials[0].roughnessImage == 0);
    CHECK(model.images[0].rgba == kTinyTexels);
    CHECK(painted(Json::object()).importOrFail().materials[0].metallic == 1);
    CHECK(painted({{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}).importOrFail().materials[0].metallic == 0);
}

TEST_CASE("what is transparent is drawn so: by alpha, or by transmission") {
    const auto materialOf = [](const Json& material) { return painted(material).importOrFail().materials[0]; };
    const Json half = {{"baseColorFactor", {1, 1, 1, 0.5}}};
    CHECK(materialOf({{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", half}}).blended);
    CHECK(!materialOf({{"alphaMode", "BLEND"}}).blended);
    CHECK(!materialOf({{"pbrMetallicRoughness", half}}).blended);
    const Material glass =
        materialOf({{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.75}}}}}});
    CHECK(glass.blended);
    CHECK(glass.transmission == 0.75f);
    CHECK(glass.alphaCutoff == 0);
}

TEST_CASE("what is blended is transparent where its vertices' colours are, too") {
    for (float alpha : {0.25f, 1.0f}) {
        GltfMaker maker = painted({{"alphaMode", "BLEND"}});
        std::vector<float> colours(16, 1.0f);
        for (size_t v = 0; v < 4; ++v) colours[v * 4 + 3] = alpha;
        maker.primitive()["attributes"]["COLOR_0"] = maker.add(colours, "VEC4");
        CHECK(maker.importOrFail().materials[0].blended == (alpha < 1));
        maker.root["materials"] = {Json::object()};
        CHECK(!maker.importOrFail().materials[0].blended);
    }
}

TEST_CASE("an empty primitive is left out, and said so") {
    GltfMaker maker = squareMaker();
    const Json full = maker.primitive();
    const int none = maker.addAccessor({{"componentType", 5123}, {"count", 0}, {"type", "SCALAR"}});
    const int nowhere = maker.addAccessor({{"componentType", 5126}, {"count", 0}, {"type", "VEC3"}});
    const int two = maker.add(std::vector<uint16_t>{0, 1}, "SCALAR");
    Json noIndices = full, noPlaces = full, tooFew = full, nothing = full;
    noIndices["indices"] = none;
    noPlaces["attributes"]["POSITION"] = nowhere;
    noPlaces["indices"] = none;
    tooFew["indices"] = two;
    nothing["attributes"]["POSITION"] = nowhere;
    nothing.erase("indices");
    maker.root["meshes"][0]["primitives"] = {full, noIndices, noPlaces, tooFew, nothing};
    const Model model = maker.importOrFail();
    CHECK(model.indices.size() == 6);
    REQUIRE(model.warnings.size() == 1);
    CHECK(says(warningsOf(model.warnings), "4 primitives have no triangles"));
    maker.root["meshes"][0]["primitives"] = {noIndices};
    CHECK(says(messageOf(maker.import()), "its meshes are empty"));
}

TEST_CASE("accessors without a buffer view are zero but for their sparse values") {
    GltfMaker maker = squareMaker();
    const auto sparse = [&](const Json& accessor, int indices, int values, size_t count) {
        Json out = accessor;
        out["sparse"] = {{"count", count},
                         {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                         {"values", {{"bufferView", values}}}};
        return maker.addAccessor(out);
    };
    const int places = maker.addValues(std::vector<uint16_t>{1, 2, 4, 5}),
              named = maker.addValues(std::vector<uint16_t>{1, 2, 2, 3}),
              corners = maker.addValues(std::vector<uint16_t>{1, 2, 3}),
              at = maker.addValues(std::vector<float>{2, 0, 0, 2, 2, 0, 0, 2, 0});
    maker.primitive()["indices"] =
        sparse({{"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}, places, named, 4);
    maker.primitive()["attributes"]["POSITION"] =
        sparse({{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}}, corners, at, 3);
    const Model model = maker.importOrFail();
    CHECK(model.indices == std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
    CHECK(triangleArea(model) == 4);
    CHECK(model.warnings.empty());
    // Without any: all indices are 0.
    maker.primitive()["indices"] = maker.addAccessor({{"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}});
    CHECK(triangleArea(maker.importOrFail()) == 0);
    // One too many.
    maker.root["accessors"].back()["sparse"] = {{"count", 7},
                                                {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                                                {"values", {{"bufferView", named}}}};
    CHECK(says(messageOf(maker.import()), ".sparse: absurd count"));
}

TEST_CASE("attributes of another count than the positions, and vertices that nothing names, are warnings") {
    GltfMaker maker = squareMaker();
    maker.primitive()["attributes"]["NORMAL"] = maker.add(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC3");
    maker.primitive()["attributes"]["TEXCOORD_0"] = maker.add(std::vector<float>{0, 0}, "VEC2");
    Model model = maker.importOrFail();
    CHECK(model.normals.empty());
    CHECK(model.uvs.empty());
    CHECK(says(warningsOf(model.warnings), "NORMAL has 2 elements, POSITION 4"));
    CHECK(says(warningsOf(model.warnings), "TEXCOORD_0 has 1 elements"));

    // Nor need an accessor be right that a mesh can do without.
    const int wide = maker.add(std::vector<float>(16, 0.0f), "VEC4");
    maker.primitive()["attributes"].update({{"NORMAL", wide}, {"TEXCOORD_0", 99}, {"COLOR_0", 98}});
    model = maker.importOrFail();
    CHECK(triangleArea(model) == 1);
    CHECK(model.normals.empty());
    CHECK(model.uvs.empty());
    CHECK(model.colours.empty());
    CHECK(model.warnings.size() == 3);
    CHECK(says(warningsOf(model.warnings), "NORMAL is left out: accessors[4]: NORMAL has 4 components"));
    CHECK(says(warningsOf(model.warnings), "TEXCOORD_0 is left out: accessors[99] does not exist"));
    CHECK(says(warningsOf(model.warnings), "COLOR_0 is left out: accessors[98] does not exist"));

    // What isn't a number is told of, too.
    GltfMaker blank = squareMaker();
    const std::vector<float> blanks(12, std::numeric_limits<float>::quiet_NaN());
    blank.primitive()["attributes"]["COLOR_0"] = blank.add(blanks, "VEC3");
    blank.primitive()["attributes"]["TEXCOORD_0"] =
        blank.add(std::vector<float>(blanks.begin(), blanks.begin() + 8), "VEC2");
    model = blank.importOrFail();
    CHECK(triangleArea(model) == 1);
    CHECK(model.warnings.size() == 2);
    CHECK(says(warningsOf(model.warnings), "colours that are not numbers count as white"));
    CHECK(says(warningsOf(model.warnings), "UVs that are not numbers count as none"));

    std::vector<float> places = kSquare;
    for (int k = 0; k < 3; ++k) places.push_back(std::numeric_limits<float>::quiet_NaN());
    GltfMaker spare = squareMaker();
    spare.primitive()["attributes"]["POSITION"] = spare.add(places, "VEC3");
    model = spare.importOrFail();
    CHECK(triangleArea(model) == 1);
    CHECK(says(warningsOf(model.warnings), "the positions of 1 vertices are not numbers"));
    spare.primitive()["indices"] = spare.add(std::vector<uint16_t>{0, 1, 4}, "SCALAR");
    CHECK(says(messageOf(spare.import()), "the position of vertex 4 is not a number"));
}

namespace {

// By which UVs a model's vertex 2, the upper right corner, looks up a texture.
glm::vec2 lookedUp(const Model& model, const TextureMap& map) {
    const auto rows = rowsOf(map);
    const glm::vec2 uv = map.set == 0 ? model.materialUvs[2] : model.otherUvs[2];
    return {glm::dot(rows[0], glm::vec3(uv, 1)), glm::dot(rows[1], glm::vec3(uv, 1))};
}

}  // namespace

TEST_CASE("each texture is looked up by its own UV set and transform") {
    GltfMaker maker = painted(Json::object(), {kTinyPng});
    maker.root["textures"] = {{{"source", 0}}};
    for (int set : {1, 2})
        maker.primitive()["attributes"]["TEXCOORD_" + std::to_string(set)] =
            maker.add(std::vector<float>{0, 0, 0, 0, float(set) * 10, float(set), 0, 0}, "VEC2");
    const auto texture = [](int set, const Json& transform = {}) {
        Json out = {{"index", 0}, {"texCoord", set}};
        if (!transform.is_null()) out["extensions"] = {{"KHR_texture_transform", transform}};
        return out;
    };
    const auto modelOf = [&](const Json& base, const Json& normal, const Json& emissive) {
        Json material = {{"emissiveFactor", {1, 1, 1}}};
        if (!base.is_null()) material["pbrMetallicRoughness"] = {{"baseColorTexture", base}};
        if (!normal.is_null()) material["normalTexture"] = normal;
        if (!emissive.is_null()) material["emissiveTexture"] = emissive;
        maker.root["materials"] = {material};
        return maker.importOrFail();
    };
    // All alike: the vertices have it, and nothing is left to do.
    const Json shifted = {{"offset", {0.5, 0.25}}, {"scale", {2, 2}}};
    Model model = modelOf(texture(1, shifted), texture(1, shifted), {});
    CHECK(model.otherUvs.empty());
    CHECK(model.materials[0].normalMap == TextureMap());
    CHECK(model.materialUvs[2] == glm::vec2(20.5f, 2.25f));
    model = modelOf({}, texture(1), {});  // a normal map alone
    CHECK(lookedUp(model, model.materials[0].normalMap) == glm::vec2(10, 1));
    CHECK(model.otherUvs.empty());

    // One set, three transforms.
    model = modelOf(texture(1, shifted), texture(1), texture(1, {{"rotation", 1.5707963267948966}}));
    const Material one = model.materials[0];
    CHECK(lookedUp(model, one.baseColorMap) == glm::vec2(20.5f, 2.25f));
    CHECK(lookedUp(model, one.normalMap) == glm::vec2(10, 1));
    CHECK(glm::length(lookedUp(model, one.emissiveMap) - glm::vec2(1, -10)) < 1e-5f);
    CHECK(model.otherUvs.empty());

    // Two sets; a transform's texCoord comes before the texture's own.
    model = modelOf(texture(0), texture(0, {{"texCoord", 2}, {"offset", {1, 0}}}), texture(2));
    const Material two = model.materials[0];
    CHECK(lookedUp(model, two.baseColorMap) == glm::vec2(1, 0));
    CHECK(lookedUp(model, two.normalMap) == glm::vec2(21, 2));
    CHECK(lookedUp(model, two.emissiveMap) == glm::vec2(20, 2));
    CHECK(model.warnings.empty());

    // Three are one too many.
    model = modelOf(texture(0), texture(1), texture(2));
    CHECK(says(warningsOf(model.warnings), "more than two UV sets"));
    CHECK(lookedUp(model, model.materials[0].emissiveMap) == glm::vec2(1, 0));
    CHECK(says(warningsOf(modelOf(texture(9), {}, {}).warnings), "beyond 7"));
}
