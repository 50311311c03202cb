// In: a baked surface. Out: a .glb that any glTF viewer opens, with the walk's data in our extension.
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <stb_image_write.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>

#include "runtime/core/glb.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/jobs.hpp"
#include "runtime/surface/codec.hpp"
#include "runtime/surface/material_json.hpp"
#include "runtime/surface/surface.hpp"
#include "runtime/surface/surface_file.hpp"

namespace espalier {
namespace {

using nlohmann::ordered_json;
using namespace surface_file;

constexpr int kPositionBits = 16, kUvBits = 16, kNormalBits = 12, kColourBits = 12;
constexpr size_t kMaxBinary = 0xFFFF0000u;

std::string hex(uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

class Writer {
  public:
    Writer(const SurfaceData& data, const std::string& path) : data_(data), path_(path) {}

    Status run() {
        if (data_.images.size() > kMaxImages) return tooMany(data_.images.size(), "images", kMaxImages);
        if (data_.materials.size() > kMaxMaterials) return tooMany(data_.materials.size(), "materials", kMaxMaterials);
        root_["asset"] = {{"version", "2.0"}, {"generator", "espalier-bake " ESPALIER_VERSION}};
        root_["extensionsUsed"] = {kDraco, kExtension};
        root_["extensionsRequired"] = {kDraco};
        root_["scene"] = 0;
        root_["scenes"] = {{{"nodes", {0}}}};
        root_["nodes"] = {{{"mesh", 0}, {"name", "surface"}}};
        root_["bufferViews"] = ordered_json::array();
        root_["accessors"] = ordered_json::array();
        measureMesh();
        packAll();
        writeShared();
        Status done = writeCoarser();
        if (done && data_.coarser.empty()) done = writeMesh(0);
        if (done) done = writeLevels();
        if (done && !data_.coarser.empty()) done = writeMesh(0);
        if (!done) return done;
        writeMaterials();
        const size_t views = root_["bufferViews"].size();
        if (views > kMaxViews) return tooMany(views, "buffer views", kMaxViews);
        root_["extensions"][kExtension] = std::move(walk_);
        binary_.resize((binary_.size() + 3) / 4 * 4, 0);
        if (binary_.size() > kMaxBinary) return Failure(path_, "the surface is larger than a .glb can be (4 GiB)");
        root_["extensions"][kExtension]["binary_hash"] = hex(hashBytes(std::as_bytes(std::span(binary_))));
        root_["buffers"] = {{{"byteLength", binary_.size()}}};
        return writeContainer();
    }

  private:
    Failure tooMany(size_t count, const char* things, size_t most) const {
        return Failure(path_, "the surface has " + std::to_string(count) + " " + things + "; " + std::to_string(most) +
                                  " can be read back");
    }

    int addView(const void* bytes, size_t length) {
        binary_.resize((binary_.size() + 3) / 4 * 4, 0);
        root_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", length}});
        const uint8_t* from = static_cast<const uint8_t*>(bytes);
        binary_.insert(binary_.end(), from, from + length);
        return int(root_["bufferViews"].size()) - 1;
    }

    template <class Get>
    static int addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, int components, Get&& get) {
        draco::GeometryAttribute attribute;
        attribute.Init(type, nullptr, uint8_t(components), draco::DT_FLOAT32, false, int64_t(components) * 4, 0);
        int id = mesh.AddAttribute(attribute, true, mesh.num_points());
        for (uint32_t i = 0; i < mesh.num_points(); ++i)
            mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), get(i));
        return id;
    }

    struct Drawn {
        const std::vector<DrawVertex>& vertices;
        const std::vector<uint32_t>& indices;
        const std::vector<DrawRange>& ranges;
    };

    // A range as Draco's bytes, and what a decoder will find in them.
    struct PackedRange {
        uint32_t material = 0, points = 0, faces = 0;
        draco::EncoderBuffer bytes;
        std::vector<std::pair<const char*, uint32_t>> attributes;  // names and Draco's ids, POSITION first
        glm::vec3 low{3e38f}, high{-3e38f};
        const char* fault = nullptr;
    };

    // All that takes long and needs nothing else, on all cores: drawn meshes, the largest first, and records.
    void packAll() {
        std::vector<std::pair<Drawn, const DrawRange*>> jobs;
        meshes_.resize(data_.coarser.size() + 1);
        for (size_t m = 0; m < meshes_.size(); ++m) {
            const Drawn drawn = m == 0 ? Drawn{data_.vertices, data_.indices, data_.ranges}
                                       : Drawn{data_.coarser[m - 1].vertices, data_.coarser[m - 1].indices,
                                               data_.coarser[m - 1].ranges};
            for (const DrawRange& range : drawn.ranges)
                if (range.indexCount >= 3) jobs.push_back({drawn, &range}), meshes_[m].emplace_back();
        }
        std::vector<PackedRange*> places;
        for (auto& mesh : meshes_)
            for (PackedRange& range : mesh) places.push_back(&range);
        parallelFor(jobs.size() + 2, 1, [&](size_t i, size_t) {
            if (i == 0)
                packedTriangles_ = pack(data_.triangles);
            else if (i == 1)
                packedCrossings_ = pack(data_.crossings);
            else
                packRange(jobs[i - 2].first, *jobs[i - 2].second, *places[i - 2]);
        });
    }

    // One range as a Draco mesh of its own vertices.
    void packRange(const Drawn& drawn, const DrawRange& range, PackedRange& out) const {
        std::vector<uint32_t> local(drawn.vertices.size(), kNoIndex), used;
        draco::Mesh mesh;
        for (uint32_t i = 0; i < range.indexCount; ++i) {
            uint32_t v = drawn.indices[range.firstIndex + i];
            if (local[v] != kNoIndex) continue;
            local[v] = uint32_t(used.size());
            used.push_back(v);
        }
        mesh.set_num_points(uint32_t(used.size()));
        mesh.SetNumFaces(range.indexCount / 3);
        for (uint32_t f = 0; f < range.indexCount / 3; ++f) {
            draco::Mesh::Face face;
            for (uint32_t k = 0; k < 3; ++k) face[k] = local[drawn.indices[range.firstIndex + f * 3 + k]];
            mesh.SetFace(draco::FaceIndex(f), face);
        }
        auto vertex = [&](uint32_t i) -> const DrawVertex& { return drawn.vertices[used[i]]; };
        using Kind = draco::GeometryAttribute;
        std::vector<std::pair<const char*, int>> ids{
            {"POSITION", addAttribute(mesh, Kind::POSITION, 3, [&](uint32_t i) { return &vertex(i).position.x; })},
            {"NORMAL", addAttribute(mesh, Kind::NORMAL, 3, [&](uint32_t i) { return &vertex(i).normal.x; })},
            {"TEXCOORD_0", addAttribute(mesh, Kind::TEX_COORD, 2, [&](uint32_t i) { return &vertex(i).uv.x; })},
            {"TEXCOORD_1", addAttribute(mesh, Kind::TEX_COORD, 2, [&](uint32_t i) { return &vertex(i).walkUv.x; })}};
        if (range.material < data_.materials.size() && usesOtherUv(data_.materials[range.material]))
            ids.emplace_back("TEXCOORD_2",
                             addAttribute(mesh, Kind::TEX_COORD, 2, [&](uint32_t i) { return &vertex(i).otherUv.x; }));
        if (std::ranges::any_of(used, [&](uint32_t v) { return drawn.vertices[v].colour != kWhite; })) {
            glm::vec4 colour;
            ids.emplace_back("COLOR_0", addAttribute(mesh, Kind::COLOR, 4, [&](uint32_t i) {
                                 colour = unpackColour(vertex(i).colour);
                                 return &colour.x;
                             }));
        }
        for (const auto& [name, id] : ids) out.attributes.emplace_back(name, mesh.attribute(id)->unique_id());
        out.material = range.material;
        if (!encode(mesh, out.bytes))
            out.fault = "Draco could not encode the mesh";
        else
            measureRange(out);
    }

    bool encode(const draco::Mesh& mesh, draco::EncoderBuffer& out) const {
        // Edgebreaker gives up on meshes of degenerate triangles only; the sequential method takes all.
        for (int method : {int(draco::MESH_EDGEBREAKER_ENCODING), int(draco::MESH_SEQUENTIAL_ENCODING)}) {
            draco::Encoder encoder;
            encoder.SetSpeedOptions(5, 5);
            encoder.SetEncodingMethod(method);
            // One grid for all: what ranges and levels of detail share stays in one place.
            encoder.SetAttributeExplicitQuantization(draco::GeometryAttribute::POSITION, kPositionBits, 3, &low_.x,
                                                     extent_);
            encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, kNormalBits);
            encoder.SetAttributeQuantization(draco::GeometryAttribute::TEX_COORD, kUvBits);
            encoder.SetAttributeQuantization(draco::GeometryAttribute::COLOR, kColourBits);
            out.Clear();
            if (encoder.EncodeMeshToBuffer(mesh, &out).ok()) return true;
        }
        return false;
    }

    // Accessors state what a decoder will find: counts and bounds are those of the decoded mesh.
    static void measureRange(PackedRange& out) {
        draco::DecoderBuffer buffer;
        buffer.Init(out.bytes.data(), out.bytes.size());
        draco::Decoder decoder;
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok()) {
            out.fault = "Draco does not read back what it wrote";
            return;
        }
        const draco::Mesh& mesh = *decoded.value();
        out.points = mesh.num_points(), out.faces = uint32_t(mesh.num_faces());
        const draco::PointAttribute* position = mesh.GetAttributeByUniqueId(out.attributes.front().second);
        for (uint32_t i = 0; i < out.points; ++i) {
            glm::vec3 p;
            position->ConvertValue<float, 3>(position->mapped_index(draco::PointIndex(i)), &p.x);
            out.low = glm::min(out.low, p), out.high = glm::max(out.high, p);
        }
    }

    void describeRange(const PackedRange& range, ordered_json& primitives) {
        if (range.faces == 0) return;  // triangles without area only
        int view = addView(range.bytes.data(), range.bytes.size());
        ordered_json attributes, packed;
        for (const auto& [name, id] : range.attributes) {
            const std::string_view kind = name;
            packed[name] = id;
            attributes[name] = root_["accessors"].size();
            ordered_json accessor = {{"componentType", 5126}, {"count", range.points}};
            accessor["type"] = kind == "COLOR_0" ? "VEC4" : kind.starts_with("TEXCOORD") ? "VEC2" : "VEC3";
            if (kind == "POSITION") {
                accessor["min"] = {range.low.x, range.low.y, range.low.z};
                accessor["max"] = {range.high.x, range.high.y, range.high.z};
            }
            root_["accessors"].push_back(std::move(accessor));
        }
        size_t indices = root_["accessors"].size();
        root_["accessors"].push_back({{"componentType", 5125}, {"count", size_t(range.faces) * 3}, {"type", "SCALAR"}});
        primitives.push_back({{"attributes", attributes},
                              {"indices", indices},
                              {"material", range.material},
                              {"mode", 4},
                              {"extensions", {{kDraco, {{"bufferView", view}, {"attributes", packed}}}}}});
    }

    Status writeMesh(size_t place) {
        ordered_json primitives = ordered_json::array();
        for (const PackedRange& range : meshes_[place]) {
            if (range.fault) return Failure(path_, range.fault);
            describeRange(range, primitives);
        }
        if (primitives.empty()) return Failure(path_, "the surface has no mesh to draw");
        root_["meshes"][place] = {{"primitives", primitives}, {"name", place == 0 ? "surface" : "coarser"}};
        return Done{};
    }

    void measureMesh() {
        glm::vec3 high(-3e38f);
        low_ = -high;
        for (const DrawVertex& v : data_.vertices) low_ = glm::min(low_, v.position), high = glm::max(high, v.position);
        extent_ = std::max({high.x - low_.x, high.y - low_.y, high.z - low_.z, 1e-30f});
    }

    // The coarsest first in the file.
    Status writeCoarser() {
        walk_["coarser"] = ordered_json::array();
        for (size_t i = data_.coarser.size(); i-- > 0;) {
            Status done = writeMesh(i + 1);
            if (!done) return done;
        }
        for (size_t i = 0; i < data_.coarser.size(); ++i)
            walk_["coarser"].push_back({{"mesh", i + 1}, {"error", data_.coarser[i].error}});
        return Done{};
    }

    void writeMaterials() {
        ordered_json materials = ordered_json::array();
        std::vector<std::string> extensions;
        Textures textures;
        for (const Material& m : data_.materials) materials.push_back(materialJson(m, textures, extensions));
        for (const std::string& name : extensions) root_["extensionsUsed"].push_back(name);
        if (!materials.empty()) root_["materials"] = std::move(materials);
        if (!textures.textures.empty()) root_["samplers"] = std::move(textures.samplers);
        if (!textures.textures.empty()) root_["textures"] = std::move(textures.textures);
        for (size_t i = 0; i < data_.images.size(); ++i) {
            const Picture& image = data_.images[i];
            std::vector<uint8_t> png;
            const std::vector<uint8_t>* bytes = &image.encoded;
            if (bytes->empty()) {
                stbi_write_png_to_func(
                    [](void* out, void* data, int size) {
                        auto* from = static_cast<uint8_t*>(data);
                        static_cast<std::vector<uint8_t>*>(out)->insert(static_cast<std::vector<uint8_t>*>(out)->end(),
                                                                        from, from + size);
                    },
                    &png, int(image.width), int(image.height), 4, image.rgba.data(), int(image.width) * 4);
                bytes = &png;
            }
            bool isPng = bytes->size() > 4 && (*bytes)[0] == 0x89 && (*bytes)[1] == 'P';
            int view = addView(bytes->data(), bytes->size());
            root_["images"].push_back({{"bufferView", view}, {"mimeType", isPng ? "image/png" : "image/jpeg"}});
        }
    }

    template <class T>
    static std::vector<uint8_t> pack(const std::vector<T>& records) {
        return records.empty() ? std::vector<uint8_t>{} : encodeRecords(records.data(), records.size(), sizeof(T));
    }
    template <class T>
    ordered_json writeRecords(const std::vector<T>& records, const std::vector<uint8_t>& bytes) {
        ordered_json field = {{"count", records.size()}, {"stride", sizeof(T)}};
        if (records.empty()) return field;
        field["bufferView"] = addView(bytes.data(), bytes.size());
        return field;
    }

    // What all levels need.
    void writeShared() {
        walk_ = {{"version", kVersion},
                 {"source", data_.source},
                 {"hash", hex(data_.hash)},
                 {"bounds_min", {data_.boundsMin.x, data_.boundsMin.y, data_.boundsMin.z}},
                 {"bounds_max", {data_.boundsMax.x, data_.boundsMax.y, data_.boundsMax.z}},
                 {"uv_set", 1}};
        if (data_.origin != glm::dvec3(0)) walk_["origin"] = {data_.origin.x, data_.origin.y, data_.origin.z};
        walk_["crossings"] = writeRecords(data_.crossings, packedCrossings_);
        walk_["charts"] = writeRecords(data_.charts, pack(data_.charts));
        walk_["triangles"] = writeRecords(data_.triangles, packedTriangles_);
    }

    // Coarse ones first in the file, the finest first in the list.
    Status writeLevels() {
        std::vector<ordered_json> levels(data_.levels.size());
        for (size_t i = levels.size(); i-- > 0;) {
            const SurfaceLevelData& level = data_.levels[i];
            const auto bytes = encodeLevel(level, data_.triangles);
            if (!bytes) return Failure(path_, "level " + std::to_string(i) + " has arrays of unlike lengths");
            levels[i] = {{"size", level.size},
                         {"error", level.error},
                         {"hash", hex(levelHash(level))},
                         {"refs", level.crossingRefs.size()},
                         {"bufferView", addView(bytes->data(), bytes->size())}};
        }
        walk_["levels"] = levels;
        return Done{};
    }

    Status writeContainer() {
        return writeGlb(path_, root_.dump(-1, ' ', false, ordered_json::error_handler_t::replace),
                        std::as_bytes(std::span(binary_)));
    }

    const SurfaceData& data_;
    const std::string& path_;
    glm::vec3 low_{0};  // of the mesh
    float extent_ = 1;
    ordered_json root_, walk_;
    std::vector<uint8_t> binary_, packedCrossings_, packedTriangles_;
    std::vector<std::vector<PackedRange>> meshes_;  // ranges of the drawn mesh, then of each coarser one
};

}  // namespace

Status writeSurface(const SurfaceData& data, const std::string& path) {
    return Writer(data, path).run();
}

}  // namespace espalier
