// In: parts of the context. Out: accessors that meshes of all colours share, materials, pictures.
#include "tools/export/meshes.hpp"

#include <algorithm>
#include <cmath>

#include "tools/scene/picture.hpp"

namespace espalier::exporting {
namespace {

using Words = std::array<uint16_t, 2>;

uint16_t unorm(float value) {
    return uint16_t(std::lround(std::clamp(value, 0.0f, 1.0f) * 65535));
}

template <class T, class F>
std::vector<T> eachVertex(const ExportPart::Level& level, F&& what) {
    std::vector<T> out;
    out.reserve(level.vertices.size());
    for (const EspPartVertex& v : level.vertices) out.push_back(what(v));
    return out;
}

bool isColoured(const ExportPart::Level& level) {
    return std::ranges::any_of(level.vertices, [](const EspPartVertex& v) {
        return v.colour[0] != 1 || v.colour[1] != 1 || v.colour[2] != 1;
    });
}

size_t indices(GltfFile& file, const ExportPart::Level& level) {
    if (level.vertices.size() > 65535)
        return file.accessor(level.indices, GltfFile::kUint, "SCALAR", false, GltfFile::kIndices);
    const std::vector<uint16_t> small(level.indices.begin(), level.indices.end());
    return file.accessor(small, GltfFile::kUshort, "SCALAR", false, GltfFile::kIndices);
}

size_t colours(GltfFile& file, const ExportPart::Level& level, bool wind) {
    using Colour = std::array<uint16_t, 4>;
    const auto all = eachVertex<Colour>(level, [&](const EspPartVertex& v) {
        return wind ? Colour{unorm(v.wind), unorm(v.age), 0, 65535}
                    : Colour{unorm(v.colour[0]), unorm(v.colour[1]), unorm(v.colour[2]), 65535};
    });
    return file.accessor(all, GltfFile::kUshort, "VEC4", true, GltfFile::kVertices);
}

}  // namespace

bool MeshWriter::addPictures(std::string& error) {
    std::vector<bool> used(gathered_.pictures.size()), cut(gathered_.pictures.size());
    for (const EspPartMaterial& m : gathered_.materials)
        for (int picture : {m.colourPicture, m.normalPicture})
            if (picture >= 0) {
                used[size_t(picture)] = true;
                if (picture == m.colourPicture && m.alphaCutoff > 0) cut[size_t(picture)] = true;
            }
    if (std::ranges::none_of(used, [](bool u) { return u; })) return true;
    // Bark goes round, so pictures repeat.
    file_.add("samplers", {{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}});
    for (size_t i = 0; i < used.size(); ++i) {
        const ExportPicture& picture = gathered_.pictures[i];
        std::vector<uint8_t> bytes;
        if (!scene::encodePng("a picture of a material", picture.rgba.data(), picture.width, picture.height, cut[i], 4,
                              bytes, error))
            return false;
        const size_t view = file_.view(bytes.data(), bytes.size(), GltfFile::kOther);
        const size_t image = file_.add("images", {{"mimeType", "image/png"}, {"bufferView", view}});
        file_.add("textures", {{"source", image}, {"sampler", 0}});
    }
    return true;
}

const Json& MeshWriter::primitive(const ExportPart& part, size_t number) {
    const auto [known, added] = primitives_.try_emplace({&part, number});
    if (!added) return known->second;
    const ExportPart::Level& level = part.levels[number];
    using Pair = std::array<float, 2>;
    using Triple = std::array<float, 3>;
    Json attributes;
    attributes["POSITION"] = file_.points(eachVertex<Triple>(level, [](const EspPartVertex& v) {
        return Triple{v.position[0], v.position[1], v.position[2]};
    }));
    attributes["NORMAL"] = file_.accessor(eachVertex<Triple>(level,
                                                             [](const EspPartVertex& v) {
                                                                 return Triple{v.normal[0], v.normal[1], v.normal[2]};
                                                             }),
                                          GltfFile::kFloat, "VEC3", false, GltfFile::kVertices);
    attributes["TEXCOORD_0"] = file_.accessor(eachVertex<Pair>(level,
                                                               [](const EspPartVertex& v) {
                                                                   return Pair{v.uv[0], v.uv[1]};
                                                               }),
                                              GltfFile::kFloat, "VEC2", false, GltfFile::kVertices);
    attributes["TEXCOORD_1"] = file_.accessor(eachVertex<Words>(level,
                                                                [](const EspPartVertex& v) {
                                                                    return Words{unorm(v.uv2[0]), unorm(v.uv2[1])};
                                                                }),
                                              GltfFile::kUshort, "VEC2", true, GltfFile::kVertices);
    const bool moves = part.kind == ESP_PART_STEMS || part.kind == ESP_PART_LEAF;
    if (moves && options_.wind == WindChannel::own)
        attributes["_WIND"] = file_.accessor(eachVertex<Words>(level,
                                                               [](const EspPartVertex& v) {
                                                                   return Words{unorm(v.wind), unorm(v.age)};
                                                               }),
                                             GltfFile::kUshort, "VEC2", true, GltfFile::kVertices);
    const bool wind = moves && options_.wind == WindChannel::colour;
    if (wind || isColoured(level)) attributes["COLOR_0"] = colours(file_, level, wind);
    known->second = {{"attributes", std::move(attributes)}, {"indices", indices(file_, level)}};
    return known->second;
}

size_t MeshWriter::material(uint32_t number, const std::array<float, 3>& colour) {
    const auto [known, added] = materials_.try_emplace({number, colour}, 0);
    if (!added) return known->second;
    const EspPartMaterial& from = gathered_.materials[number];
    Json pbr = {{"metallicFactor", 0}, {"roughnessFactor", from.roughness}};
    Json factor = Json::array();
    for (size_t i = 0; i < 3; ++i) factor.push_back(std::clamp(from.colour[i] * colour[i], 0.0f, 1.0f));
    factor.push_back(1);
    pbr["baseColorFactor"] = std::move(factor);
    if (from.colourPicture >= 0) pbr["baseColorTexture"] = {{"index", from.colourPicture}};
    const int before = coloursOf_[number]++;
    Json made = {{"name", gathered_.materialNames[number] + (before > 0 ? "_" + std::to_string(before + 1) : "")},
                 {"pbrMetallicRoughness", std::move(pbr)}};
    if (from.normalPicture >= 0) made["normalTexture"] = {{"index", from.normalPicture}};
    if (from.alphaCutoff > 0) made["alphaMode"] = "MASK", made["alphaCutoff"] = from.alphaCutoff;
    if (from.twoSided) made["doubleSided"] = true;
    return known->second = file_.add("materials", std::move(made));
}

std::vector<size_t> MeshWriter::meshes(const ExportPart& part, const std::array<float, 3>& colour,
                                       const std::string& name) {
    std::vector<size_t> out;
    for (size_t level = 0; level < (options_.lods ? part.levels.size() : 1); ++level) {
        Json shown = primitive(part, level);
        shown["material"] = material(part.material, colour);
        out.push_back(file_.add("meshes", {{"name", name + "_LOD" + std::to_string(level)},
                                           {"primitives", Json::array({std::move(shown)})}}));
    }
    return out;
}

}  // namespace espalier::exporting
