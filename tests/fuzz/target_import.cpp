// In: bytes. Out: nothing, if all goes well; a model that is accepted must hold what it promises.
#include "tests/fuzz/promise.hpp"
#include "tools/bake/import_kind.hpp"
#include "tools/bake/import_model.hpp"

namespace espalier::fuzz {
namespace {

void check(Result<Model> model) {
    if (!model) return checkMessage(model.failure());
    size_t vertices = model->positions.size();
    require(model->indices.size() % 3 == 0 && !model->indices.empty(), "three indices a triangle, one at least");
    for (uint32_t i : model->indices) require(i < vertices, "indices name vertices");
    for (const auto& p : model->positions) require(p.x == p.x && p.y == p.y && p.z == p.z, "positions are numbers");
    require(model->normals.empty() || model->normals.size() == vertices, "a normal a vertex");
    require(model->uvs.empty() || model->uvs.size() == vertices, "a UV a vertex");
    require(model->triangleMaterial.empty() || model->triangleMaterial.size() * 3 == model->indices.size(),
            "a material a triangle");
    require(model->materialUvs.empty() || model->materialUvs.size() == vertices, "a material's UV a vertex");
    require(model->colours.empty() || model->colours.size() == vertices, "a colour a vertex");
    for (uint32_t m : model->triangleMaterial) require(m < model->materials.size(), "materials exist");
    require(model->otherUvs.empty() || model->otherUvs.size() == vertices, "a second UV a vertex");
    const int images = int(model->images.size());
    for (const Material& m : model->materials) {
        for (int image : {m.baseColorImage, m.normalImage, m.emissiveImage, m.roughnessImage})
            require(image < images, "images exist");
        for (const TextureMap* map : {&m.baseColorMap, &m.normalMap, &m.emissiveMap, &m.roughnessMap})
            require(map->set == 0 || (map->set == 1 && !model->otherUvs.empty()) || model->uvs.empty(),
                    "UV sets exist");
    }
}

void importBytes(Bytes bytes, std::string_view ending) {
    MemoryFile file(bytes);
    ImportOptions options;
    options.as = ending;
    check(importModel(file.path(), options));
}

// A model beside its materials.
std::string modelBeside(Bytes materials) {
    static const MemoryFolder memory;
    static const bool set = [] {
        memory.write("a.obj",
                     "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n");
        return true;
    }();
    require(set, "the model is there");
    memory.write("a.mtl", textOf(materials));
    return memory.path / "a.obj";
}

}  // namespace

void gltf(Bytes bytes) {
    importBytes(bytes, ".gltf");
}

void obj(Bytes bytes) {
    importBytes(bytes, ".obj");
}

void ply(Bytes bytes) {
    importBytes(bytes, ".ply");
}

void stl(Bytes bytes) {
    const import::FileKind* kind = import::kindOf(bytes);
    require(!kind || (*kind->name && *kind->advice), "a kind has a name and an advice");
    (void)import::looksLikeObj(bytes);
    importBytes(bytes, ".stl");
}

void mtl(Bytes bytes) {
    check(importModel(modelBeside(bytes)));
}

}  // namespace espalier::fuzz
