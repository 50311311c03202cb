// In: a .glb that the baker wrote, or something that claims to be one. Out: the surface. Sizes, indices and hashes
// are compared before anything is used: kernels follow these records without asking.
#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/jobs.hpp"
#include "runtime/surface/picture.hpp"
#include "runtime/surface/surface.hpp"
#include "runtime/surface/surface_file.hpp"

namespace espalier {
namespace {

using nlohmann::json;
using namespace surface_file;

constexpr uint32_t kMaxSize = 8192;
constexpr uint64_t kMaxRecords = uint64_t(1) << 27;

#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
constexpr bool kComparesHashes = false;  // a fuzzer would never get past them
#else
constexpr bool kComparesHashes = true;
#endif

// The first thing that is wrong, as an exception inside of this file only.
struct Damage {
    std::string place, message;
};

[[noreturn]] void fail(const std::string& place, const std::string& message) {
    throw Damage{place, message};
}

const json& at(const json& object, const char* key, const std::string& place) {
    if (!object.is_object() || !object.contains(key)) fail(place, std::string(key) + " is missing");
    return object[key];
}

uint64_t whole(const json& object, const char* key, const std::string& place, uint64_t most) {
    const json& value = at(object, key, place);
    if (!value.is_number_unsigned() || value.get<uint64_t>() > most)
        fail(place, std::string(key) + " is not a whole number up to " + std::to_string(most));
    return value.get<uint64_t>();
}

uint64_t hexadecimal(const json& object, const char* key, const std::string& place) {
    const json& value = at(object, key, place);
    std::string text = value.is_string() ? value.get<std::string>() : std::string();
    if (text.size() != 16 || text.find_first_not_of("0123456789abcdef") != std::string::npos)
        fail(place, std::string(key) + " is not a hash");
    return std::stoull(text, nullptr, 16);
}

const json& array(const json& object, const char* key, const std::string& place, size_t most) {
    const json& value = at(object, key, place);
    if (!value.is_array() || value.size() > most) fail(place, std::string(key) + " is not an array of sane length");
    return value;
}

float number(const json& object, const char* key, float otherwise) {
    if (!object.is_object() || !object.contains(key) || !object[key].is_number()) return otherwise;
    float f = object[key].get<float>();
    return std::isfinite(f) ? f : otherwise;
}

std::string indexed(const char* name, size_t i) {
    return std::string(name) + "[" + std::to_string(i) + "]";
}

class Reader {
  public:
    Reader(std::vector<std::byte> file) : file_(std::move(file)) {}

    SurfaceData run() {
        split();
        const json& all = at(root_, "extensions", "glTF");
        if (!all.is_object() || !all.contains(kExtension))
            fail("glTF", "not a baked surface: " + std::string(kExtension) + " is missing");
        const json& walk = all[kExtension];
        uint64_t version = whole(walk, "version", kExtension, 0xFFFFFFFFu);
        if (version != kVersion)
            fail(kExtension, "version " + std::to_string(version) + " is not the supported " +
                                 std::to_string(kVersion) + ": bake again");
        if (kComparesHashes && hexadecimal(walk, "binary_hash", kExtension) != hashBytes(std::as_bytes(binary_)))
            fail(kExtension, "damaged: the binary chunk doesn't match its hash");
        readWalk(walk);
        validate();
        if (kComparesHashes && walkHash(data_) != data_.hash)
            fail(kExtension, "damaged: the walk's data don't match their hash");
        readMaterials();
        readMeshes();
        return std::move(data_);
    }

  private:
    uint32_t word(size_t offset) const {
        uint32_t value;
        std::memcpy(&value, file_.data() + offset, 4);
        return value;
    }

    void split() {
        if (file_.size() < 28 || word(0) != kGlbMagic) fail("header", "not a .glb");
        if (word(4) != 2) fail("header", "glTF container version " + std::to_string(word(4)));
        if (word(8) != file_.size())
            fail("header", "truncated or damaged: states " + std::to_string(word(8)) + " bytes, has " +
                               std::to_string(file_.size()));
        size_t text = word(12);
        if (word(16) != kJsonChunk || text > file_.size() - 28) fail("JSON chunk", "reaches past the end of the file");
        root_ = json::parse(reinterpret_cast<const char*>(file_.data()) + 20,
                            reinterpret_cast<const char*>(file_.data()) + 20 + text, nullptr, false);
        if (root_.is_discarded() || !root_.is_object()) fail("JSON chunk", "does not parse");
        size_t binary = word(20 + text);
        if (word(24 + text) != kBinChunk || binary > file_.size() - 28 - text)
            fail("binary chunk", "reaches past the end of the file");
        binary_ = std::span(file_).subspan(28 + text, binary);
    }

    std::span<const std::byte> view(uint64_t index, const std::string& place) const {
        const json& views = array(root_, "bufferViews", "glTF", 1 << 20);
        if (index >= views.size()) fail(place, indexed("bufferViews", index) + " does not exist");
        std::string here = indexed("bufferViews", index);
        uint64_t buffer = whole(views[index], "buffer", here, 0),
                 length = whole(views[index], "byteLength", here, binary_.size());
        uint64_t offset = whole(views[index], "byteOffset", here, binary_.size());
        if (buffer != 0 || length > binary_.size() - offset) fail(here, "reaches past the end of the binary chunk");
        return binary_.subspan(offset, length);
    }

    template <class T>
    void readArray(const json& object, const char* key, const std::string& place, uint64_t expected,
                   std::vector<T>& out) {
        std::string here = place + "." + key;
        const json& field = at(object, key, place);
        uint64_t count = whole(field, "count", here, kMaxRecords);
        if (whole(field, "stride", here, 256) != sizeof(T)) fail(here, "records of another size: bake again");
        if (expected != kMaxRecords && count != expected)
            fail(here, "has " + std::to_string(count) + " records instead of " + std::to_string(expected));
        if (count == 0) return;
        auto bytes = view(whole(field, "bufferView", here, 1 << 20), here);
        // The densest such data is 1/64 of what it decodes to.
        if (count * sizeof(T) > bytes.size() * 64) fail(here, "absurd count");
        take(count * sizeof(T), here);
        out.resize(count);
        if (meshopt_decodeVertexBuffer(out.data(), count, sizeof(T),
                                       reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()) != 0)
            fail(here, "damaged compressed data");
    }

    // What several fields refer to is decoded for each: together they are bounded by the file's size.
    void take(uint64_t bytes, const std::string& place) {
        taken_ += bytes;
        if (taken_ > (uint64_t(256) << 20) + uint64_t(file_.size()) * 256)
            fail(place, "absurdly much for the file's size");
    }

    void readWalk(const json& walk) {
        std::string place = kExtension;
        data_.hash = hexadecimal(walk, "hash", place);
        const json& source = at(walk, "source", place);
        if (source.is_string()) data_.source = source.get<std::string>();
        for (int side = 0; side < 2; ++side) {
            const char* key = side == 0 ? "bounds_min" : "bounds_max";
            const json& bounds = array(walk, key, place, 3);
            for (size_t k = 0; k < 3; ++k) {
                if (k >= bounds.size() || !bounds[k].is_number())
                    fail(place, std::string(key) + " is not three numbers");
                (side == 0 ? data_.boundsMin : data_.boundsMax)[int(k)] = bounds[k].get<float>();
            }
        }
        readArray(walk, "crossings", place, kMaxRecords, data_.crossings);
        readArray(walk, "charts", place, kMaxRecords, data_.charts);
        readArray(walk, "triangles", place, kMaxRecords, data_.triangles);
        const json& levels = array(walk, "levels", place, kMaxLevels);
        if (levels.empty()) fail(place, "no levels");
        for (size_t i = 0; i < levels.size(); ++i) {
            std::string here = place + "." + indexed("levels", i);
            SurfaceLevelData level;
            level.size = uint32_t(whole(levels[i], "size", here, kMaxSize));
            if (level.size < 8 || !std::has_single_bit(level.size)) fail(here, "size " + std::to_string(level.size));
            if (i > 0 && level.size * 2 != data_.levels[i - 1].size)
                fail(here, "is not half as large as the one before");
            uint64_t texels = uint64_t(level.size) * level.size;
            readArray(levels[i], "texels", here, texels, level.texels);
            readArray(levels[i], "aux", here, texels, level.aux);
            readArray(levels[i], "crossing_head", here, texels, level.crossingHead);
            readArray(levels[i], "crossing_refs", here, kMaxRecords, level.crossingRefs);
            data_.levels.push_back(std::move(level));
        }
    }

    static bool inSquare(glm::vec2 uv) { return uv.x >= 0 && uv.y >= 0 && uv.x <= 1 && uv.y <= 1; }
    static bool sane(glm::vec3 p) { return std::abs(p.x) < 1e30f && std::abs(p.y) < 1e30f && std::abs(p.z) < 1e30f; }

    // Every index that a kernel would follow.
    void validate() const {
        std::string place = kExtension;
        size_t charts = data_.charts.size();
        if (charts == 0 || charts > 65535) fail(place, std::to_string(charts) + " charts");
        if (!sane(data_.boundsMin) || !sane(data_.boundsMax)) fail(place, "bounds are not numbers");
        for (size_t i = 0; i < charts; ++i) {
            const Chart& c = data_.charts[i];
            if (!inSquare(c.uvMin) || !inSquare(c.uvMax) || (c.orientation != 1 && c.orientation != -1) ||
                c.coarsestLevel >= data_.levels.size() || !(c.area > 0) || !(c.metresPerUv > 0) ||
                !std::isfinite(c.metresPerUv) || c.firstTriangle > data_.triangles.size() ||
                c.triangleCount > data_.triangles.size() - c.firstTriangle)
                fail(place, indexed("charts", i) + " is out of range");
        }
        for (size_t i = 0; i < data_.triangles.size(); ++i) {
            const TrianglePlane& t = data_.triangles[i];
            if (t.chart >= charts || !sane(t.position) || !sane(t.du) || !sane(t.dv) || !inSquare(t.uv0))
                fail(place, indexed("triangles", i) + " is out of range");
        }
        for (size_t i = 0; i < data_.crossings.size(); ++i) {
            const Crossing& c = data_.crossings[i];
            if (!inSquare(c.a) || !inSquare(c.b) || !inSquare(c.ta) || !inSquare(c.tb) ||
                (c.target & 0xFFFFu) >= charts || (c.flags >> 16) >= charts)
                fail(place, indexed("crossings", i) + " is out of range");
            // What a file says of other instances would be followed into a table that it can't know.
            if ((c.target >> 16) != 0xFFFFu) fail(place, indexed("crossings", i) + " leads to another instance");
        }
        for (size_t l = 0; l < data_.levels.size(); ++l)
            validateLevel(data_.levels[l], place + "." + indexed("levels", l));
    }

    void validateLevel(const SurfaceLevelData& level, const std::string& place) const {
        for (uint32_t ref : level.crossingRefs)
            if (ref >= data_.crossings.size()) fail(place, "a texel lists a crossing that doesn't exist");
        for (size_t i = 0; i < level.texels.size(); ++i) {
            const Texel& t = level.texels[i];
            uint32_t head = level.crossingHead[i];
            if (uint64_t(head >> 8) + (head & 255u) > level.crossingRefs.size())
                fail(place, indexed("crossing_head", i) + " is out of range");
            if (texelClass(t.bits) == kTexelEmpty) continue;
            if (texelChart(t.bits) >= data_.charts.size() || !sane(t.position))
                fail(place, indexed("texels", i) + " is out of range");
            if (level.aux[i].triangle >= data_.triangles.size()) fail(place, indexed("aux", i) + " is out of range");
        }
    }

    int imageOf(const json& material, const char* key) const {
        if (!material.is_object() || !material.contains(key)) return -1;
        uint64_t texture = whole(material[key], "index", key, 1 << 20);
        const json& textures = array(root_, "textures", "glTF", 1 << 20);
        if (texture >= textures.size()) fail(key, "texture " + std::to_string(texture) + " does not exist");
        uint64_t image = whole(textures[texture], "source", indexed("textures", texture), 1 << 20);
        if (image >= data_.images.size()) fail(indexed("textures", texture), "its image does not exist");
        return int(image);
    }

    void readMaterials() {
        if (root_.contains("images")) {
            const json& images = array(root_, "images", "glTF", 4096);
            data_.images.resize(images.size());
            std::vector<std::span<const std::byte>> bytes;
            for (size_t i = 0; i < images.size(); ++i)
                bytes.push_back(
                    view(whole(images[i], "bufferView", indexed("images", i), 1 << 20), indexed("images", i)));
            std::vector<Result<Picture>> decoded(images.size(), Picture{});
            parallelFor(images.size(), 1, [&](size_t begin, size_t end) {
                for (size_t i = begin; i < end; ++i) decoded[i] = decodePicture(bytes[i], "");
            });
            for (size_t i = 0; i < decoded.size(); ++i) {
                if (!decoded[i]) fail(indexed("images", i), decoded[i].failure().diagnostics.front().message);
                data_.images[i] = std::move(*decoded[i]);
                auto* from = reinterpret_cast<const uint8_t*>(bytes[i].data());
                data_.images[i].encoded.assign(from, from + bytes[i].size());
            }
        }
        if (root_.contains("materials"))
            for (const json& m : array(root_, "materials", "glTF", 1 << 16)) {
                Material out;
                json none = json::object();
                const json& pbr =
                    m.is_object() && m.contains("pbrMetallicRoughness") ? m["pbrMetallicRoughness"] : none;
                if (pbr.is_object() && pbr.contains("baseColorFactor") && pbr["baseColorFactor"].is_array())
                    for (size_t k = 0; k < 4 && k < pbr["baseColorFactor"].size(); ++k)
                        if (pbr["baseColorFactor"][k].is_number())
                            out.baseColor[int(k)] = pbr["baseColorFactor"][k].get<float>();
                out.baseColorImage = imageOf(pbr, "baseColorTexture");
                out.normalImage = imageOf(m, "normalTexture");
                out.normalScale = out.normalImage >= 0 ? number(m["normalTexture"], "scale", 1) : 1;
                out.roughness = number(pbr, "roughnessFactor", 1);
                out.alphaCutoff = number(m, "alphaCutoff", 0);
                out.doubleSided = m.is_object() && m.contains("doubleSided") && m["doubleSided"].is_boolean() &&
                                  m["doubleSided"].get<bool>();
                data_.materials.push_back(out);
            }
        if (data_.materials.empty()) data_.materials.emplace_back();
    }

    void readMeshes() {
        const json& meshes = array(root_, "meshes", "glTF", 1 << 16);
        for (size_t m = 0; m < meshes.size(); ++m) {
            const json& primitives = array(meshes[m], "primitives", indexed("meshes", m), 1 << 16);
            for (size_t p = 0; p < primitives.size(); ++p)
                readPrimitive(primitives[p], indexed("meshes", m) + "." + indexed("primitives", p));
        }
        addTangents(data_.vertices, data_.indices);
    }

    void readPrimitive(const json& primitive, const std::string& place) {
        const json& packed = at(at(primitive, "extensions", place), kDraco, place);
        auto bytes = view(whole(packed, "bufferView", place, 1 << 20), place);
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        draco::Decoder decoder;
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok()) fail(place, std::string("damaged Draco data: ") + decoded.status().error_msg());
        const draco::Mesh& mesh = *decoded.value();
        uint32_t base = uint32_t(data_.vertices.size()), count = mesh.num_points();
        if (uint64_t(base) + count > kMaxRecords) fail(place, "absurd vertex count");
        if (data_.indices.size() + uint64_t(mesh.num_faces()) * 3 > kMaxRecords) fail(place, "absurd index count");
        take(count * sizeof(DrawVertex) + uint64_t(mesh.num_faces()) * 12, place);
        data_.vertices.resize(size_t(base) + count, DrawVertex{});
        const json& ids = at(packed, "attributes", place);
        auto read = [&](const char* name, int components, auto&& into) {
            const draco::PointAttribute* attribute =
                mesh.GetAttributeByUniqueId(uint32_t(whole(ids, name, place, 255)));
            if (!attribute || attribute->num_components() != components) fail(place, std::string("no usable ") + name);
            for (uint32_t i = 0; i < count; ++i) {
                auto value = attribute->mapped_index(draco::PointIndex(i));
                if (value.value() >= attribute->size() ||
                    !attribute->ConvertValue<float>(value, int8_t(components), into(data_.vertices[base + i])))
                    fail(place, std::string("damaged ") + name);
            }
        };
        read("POSITION", 3, [](DrawVertex& v) { return &v.position.x; });
        for (uint32_t i = 0; i < count; ++i)
            if (!sane(data_.vertices[base + i].position)) fail(place, "a POSITION is not a number");
        read("NORMAL", 3, [](DrawVertex& v) { return &v.normal.x; });
        read("TEXCOORD_0", 2, [](DrawVertex& v) { return &v.uv.x; });
        read("TEXCOORD_1", 2, [](DrawVertex& v) { return &v.walkUv.x; });
        uint64_t material =
            primitive.contains("material") ? whole(primitive, "material", place, data_.materials.size() - 1) : 0;
        data_.ranges.push_back({uint32_t(data_.indices.size()), mesh.num_faces() * 3, uint32_t(material)});
        for (uint32_t f = 0; f < mesh.num_faces(); ++f)
            for (uint32_t k = 0; k < 3; ++k) {
                uint32_t v = mesh.face(draco::FaceIndex(f))[k].value();
                if (v >= count)
                    fail(place, "index " + std::to_string(v) + " of " + std::to_string(count) + " vertices");
                data_.indices.push_back(base + v);
            }
    }

    std::vector<std::byte> file_;
    std::span<const std::byte> binary_;
    uint64_t taken_ = 0;  // bytes decoded so far
    json root_;
    SurfaceData data_;
};

}  // namespace

Result<SurfaceData> readSurface(const std::string& path) {
    auto file = readFile(path);
    if (!file) return std::move(file.failure());
    try {
        return Reader(std::move(*file)).run();
    } catch (const Damage& damage) {
        return Failure(Diagnostic{path, 0, 0, damage.place, damage.message});
    } catch (const std::bad_alloc&) {
        return Failure(path, "states sizes that do not fit into memory");
    } catch (const std::exception& e) {  // from the JSON library
        return Failure(path, std::string("not a baked surface: ") + e.what());
    }
}

}  // namespace espalier
