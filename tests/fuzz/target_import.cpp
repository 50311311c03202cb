// In: bytes. Out: nothing, if all goes well; a model that is accepted must hold what it promises.
#include "tests/fuzz/promise.hpp"
#include "tools/bake/import_model.hpp"

namespace espalier::fuzz {
namespace {

void import(Bytes bytes, std::string_view ending) {
    MemoryFile file(bytes);
    ImportOptions options;
    options.as = ending;
    auto model = importModel(file.path(), options);
    if (!model) return checkMessage(model.failure());
    size_t vertices = model->positions.size();
    require(model->indices.size() % 3 == 0 && !model->indices.empty(), "three indices a triangle, one at least");
    for (uint32_t i : model->indices) require(i < vertices, "indices name vertices");
    for (const auto& p : model->positions) require(p.x == p.x && p.y == p.y && p.z == p.z, "positions are numbers");
    require(model->normals.empty() || model->normals.size() == vertices, "a normal a vertex");
    require(model->uvs.empty() || model->uvs.size() == vertices, "a UV a vertex");
    require(model->triangleMaterial.empty() || model->triangleMaterial.size() * 3 == model->indices.size(),
            "a material a triangle");
    for (uint32_t m : model->triangleMaterial) require(m < model->materials.size(), "materials exist");
    require(model->otherUvs.empty() || model->otherUvs.size() == vertices, "a second UV a vertex");
    const int images = int(model->images.size());
    for (const Material& m : model->materials) {
        for (int image : {m.baseColorImage, m.normalImage, m.emissiveImage}) require(image < images, "images exist");
        for (const TextureMap* map : {&m.baseColorMap, &m.normalMap, &m.emissiveMap})
            require(map->set == 0 || (map->set == 1 && !model->otherUvs.empty()) || model->uvs.empty(),
                    "UV sets exist");
    }
}

}  // namespace

void gltf(Bytes bytes) {
    import(bytes, ".gltf");
}

void obj(Bytes bytes) {
    import(bytes, ".obj");
}

void ply(Bytes bytes) {
    import(bytes, ".ply");
}

}  // namespace espalier::fuzz
