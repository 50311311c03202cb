// Materials through a surface's file: what they look like, and by which UVs their textures are looked up.
#include <doctest/doctest.h>

#include "runtime/surface/surface.hpp"
#include "tests/bake/small_models.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// A square of one material, whose second UVs are the first ones doubled.
Model square(const Material& material) {
    Model model = openQuad(2);
    Picture picture;
    picture.width = picture.height = 2;
    picture.rgba.assign(16, 200);
    model.images.push_back(picture);
    model.materials = {material};
    model.materialUvs = model.otherUvs = model.uvs;
    for (glm::vec2& uv : model.otherUvs) uv *= 2;
    return model;
}

SurfaceData throughFile(const Material& material) {
    BakeOptions options;
    options.resolution = 64;
    auto baked = bake(square(material), options);
    if (!baked) FAIL(baked.failure().text());
    ScratchFolder folder;
    REQUIRE(writeSurface(baked->surface, folder.file("a.glb")));
    auto read = readSurface(folder.file("a.glb"));
    if (!read) FAIL(read.failure().text());
    return std::move(*read);
}

}  // namespace

TEST_CASE("a surface's file keeps emission, transparency, metal and where textures are looked up") {
    Material m;
    m.baseColor = {0.25f, 0.5f, 0.75f, 0.5f};
    m.emissive = {6, 1.5f, 0};
    m.transmission = 0.75f;
    m.blended = true;
    m.baseColorImage = m.normalImage = m.emissiveImage = m.roughnessImage = 0;
    m.metallic = 0.625f;
    m.normalScale = 0.5f;
    m.baseColorMap = {.offset = {0.125f, -3}, .scale = {2, -4}, .rotation = 0.5f};
    m.normalMap = {.set = 1};
    m.emissiveMap = {.set = 1, .rotation = -1.25f};
    m.roughnessMap = {.offset = {0, 0.25f}, .scale = {3, 1}};
    const SurfaceData surface = throughFile(m);
    const Material& read = surface.materials.at(0);
    CHECK(read.baseColor == m.baseColor);
    CHECK(read.emissive == m.emissive);
    CHECK(read.transmission == m.transmission);
    CHECK(read.blended);
    CHECK(read.alphaCutoff == 0);
    CHECK(read.normalScale == m.normalScale);
    CHECK(read.emissiveImage == 0);
    CHECK(read.baseColorMap == m.baseColorMap);
    CHECK(read.normalMap == m.normalMap);
    CHECK(read.emissiveMap == m.emissiveMap);
    CHECK(read.metallic == m.metallic);
    CHECK(read.roughnessImage == 0);
    CHECK(read.roughnessMap == m.roughnessMap);
    for (const DrawVertex& v : surface.vertices) CHECK(glm::length(v.otherUv - v.uv * 2.0f) < 1e-3f);

    Material dim;
    dim.emissive = {0.5f, 0, 0};
    dim.blended = true;
    const SurfaceData plain = throughFile(dim);
    CHECK(plain.materials.at(0).emissive == dim.emissive);
    CHECK(plain.materials.at(0).emissiveImage == -1);
    CHECK(plain.materials.at(0).blended);
    CHECK(plain.materials.at(0).transmission == 0);
    CHECK(plain.materials.at(0).metallic == 0);
    CHECK(plain.materials.at(0).roughnessImage == -1);
    CHECK(plain.materials.at(0).normalMap == TextureMap());
    for (const DrawVertex& v : plain.vertices)
        CHECK(v.otherUv == glm::vec2(0));  // isn't kept where nothing asks for it
}

TEST_CASE("tangents run along the normal map's own UVs") {
    Material turned;
    turned.normalImage = 0;
    turned.normalMap = {.rotation = 1.5707963f};
    for (const DrawVertex& v : throughFile(turned).vertices) {
        // Its u grows along the UVs' v, which is the square's y.
        CHECK(glm::length(glm::vec3(v.tangent) - glm::vec3(0, 1, 0)) < 1e-2f);
    }
    turned.normalMap = {.set = 1, .scale = {-1, 1}};
    for (const DrawVertex& v : throughFile(turned).vertices)
        CHECK(glm::length(glm::vec3(v.tangent) - glm::vec3(-1, 0, 0)) < 1e-2f);
}
