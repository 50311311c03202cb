// Enters: a glTF binary with meshes named KIND[_VARIANT]_lodN. Leaves: TerminalData. The file is taken as hostile:
// every offset, count and index is checked before use.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "runtime/core/glb.hpp"
#include "runtime/emit/terminals.hpp"
#include "runtime/surface/picture.hpp"
#include "shaders/shared/exact.h"

namespace espalier {
namespace {

using nlohmann::json;
constexpr uint32_t kMaxMeshVertices = 1 << 16;
constexpr size_t kMaxFileIndices =
    1 << 24;  // and vertices: meshes may share what lies in the file, not what is made of it

uint32_t wordAt(std::span<const std::byte> bytes, size_t offset) {
    uint32_t w;
    std::memcpy(&w, bytes.data() + offset, 4);
    return w;
}

struct Mistake {
    std::string text;
};

// One file being read; mistakes are thrown inside and caught by readTerminals.
class Reader {
  public:
    Reader(std::span<const std::byte> bytes, TerminalData& data) : bytes_(bytes), data_(data) {}

    void read() {
        open_ = data_.kinds.size() == 1;
        openChunks();
        readMaterials();
        readMeshes();
    }

  private:
    [[noreturn]] static void fail(std::string text) { throw Mistake{std::move(text)}; }
    static void check(bool good, const std::string& text) {
        if (!good) fail(text);
    }

    void openChunks() {
        check(bytes_.size() >= 20 && wordAt(bytes_, 0) == kGlbMagic && wordAt(bytes_, 4) == 2, "not a glTF 2.0 binary");
        const size_t jsonSize = wordAt(bytes_, 12);
        check(wordAt(bytes_, 16) == kGlbJson && jsonSize <= bytes_.size() - 20, "truncated JSON chunk");
        const char* text = reinterpret_cast<const char*>(bytes_.data()) + 20;
        root_ = json::parse(text, text + jsonSize, nullptr, false);
        check(root_.is_object(), "the JSON chunk does not parse");
        size_t at = 20 + jsonSize;
        if (bytes_.size() - at < 8) return;
        const size_t size = wordAt(bytes_, at);
        check(wordAt(bytes_, at + 4) == kGlbBinary && size <= bytes_.size() - at - 8, "truncated binary chunk");
        binary_ = bytes_.subspan(at + 8, size);
    }

    static uint64_t number(const json& object, const char* key, uint64_t missing) {
        auto it = object.find(key);
        if (it == object.end()) return missing;
        check(it->is_number_unsigned(), std::string(key) + " is not a whole number");
        return it->get<uint64_t>();
    }
    static double real(const json& object, const char* key, double missing) {
        auto it = object.find(key);
        return it != object.end() && it->is_number() ? it->get<double>() : missing;
    }
    const json& entry(const char* array, uint64_t index) const {
        auto it = root_.find(array);
        check(it != root_.end() && it->is_array() && index < it->size() && (*it)[index].is_object(),
              std::string(array) + "[" + std::to_string(index) + "] is missing");
        return (*it)[index];
    }

    std::span<const std::byte> view(uint64_t index, uint64_t& stride) const {
        const json& v = entry("bufferViews", index);
        check(number(v, "buffer", 0) == 0, "bufferViews: only the binary chunk can be read");
        const uint64_t offset = number(v, "byteOffset", 0), length = number(v, "byteLength", 0);
        stride = number(v, "byteStride", 0);
        check(offset <= binary_.size() && length <= binary_.size() - offset && stride <= 252,
              "bufferViews[" + std::to_string(index) + "] leaves the file");
        return binary_.subspan(offset, length);
    }

    // Components of an accessor as floats (indices as exact whole numbers).
    std::vector<double> accessor(uint64_t index, const char* type, uint32_t width) const {
        const std::string name = "accessors[" + std::to_string(index) + "]";
        const json& a = entry("accessors", index);
        check(a.value("type", "") == type, name + " is not a " + type);
        check(!a.contains("sparse"), name + " is sparse");
        const uint64_t count = number(a, "count", 0), offset = number(a, "byteOffset", 0);
        const uint64_t kind = number(a, "componentType", 0);
        const uint32_t size = kind == 5126 || kind == 5125 ? 4 : kind == 5123 || kind == 5122 ? 2 : 1;
        check(kind == 5126 || kind == 5125 || kind == 5123 || kind == 5121, name + ": component type can't be read");
        uint64_t stride = 0;
        const std::span<const std::byte> bytes = view(number(a, "bufferView", ~0ull), stride);
        if (stride == 0) stride = size * width;
        check(count <= 4 * kMaxMeshVertices && offset <= bytes.size() && stride >= size * width &&
                  (count == 0 || (bytes.size() - offset >= size * width &&
                                  count - 1 <= (bytes.size() - offset - size * width) / stride)),
              name + " leaves its buffer view");
        const double scale = a.value("normalized", false) ? (kind == 5123   ? 1.0 / 65535
                                                             : kind == 5121 ? 1.0 / 255
                                                                            : 1)
                                                          : 1;
        std::vector<double> out(count * width);
        for (uint64_t i = 0; i < count; ++i)
            for (uint32_t c = 0; c < width; ++c)
                out[i * width + c] = component(bytes.data() + offset + i * stride + c * size, kind) * scale;
        return out;
    }
    static double component(const std::byte* at, uint64_t kind) {
        float f;
        uint32_t w;
        uint16_t h;
        if (kind == 5126) return std::memcpy(&f, at, 4), f;
        if (kind == 5125) return std::memcpy(&w, at, 4), w;
        if (kind == 5123) return std::memcpy(&h, at, 2), h;
        return double(uint8_t(*at));
    }

    int picture(const json& reference) {
        const uint64_t texture = number(reference, "index", ~0ull);
        const uint64_t image = number(entry("textures", texture), "source", ~0ull);
        if (auto it = pictures_.find(image); it != pictures_.end()) return it->second;
        uint64_t stride = 0;
        const std::span<const std::byte> bytes = view(number(entry("images", image), "bufferView", ~0ull), stride);
        Result<Picture> decoded = decodePicture(bytes, "");
        if (!decoded) fail("images[" + std::to_string(image) + "]: " + decoded.failure().diagnostics.front().message);
        data_.pictures.push_back({decoded->width, decoded->height, std::move(decoded->rgba)});
        return pictures_[image] = int(data_.pictures.size()) - 1;
    }

    // A member, or an empty one of that kind. By reference: copying a deeply nested tree would end the stack.
    static const json& member(const json& object, const char* key, const json& otherwise) {
        auto it = object.find(key);
        return it == object.end() ? otherwise : *it;
    }

    void readMaterials() {
        const json& materials = member(root_, "materials", noList_);
        check(materials.is_array() && materials.size() <= 256, "materials is not a list");
        for (const json& m : materials) {
            check(m.is_object(), "materials holds something else");
            TerminalMaterial out;
            out.name = m.value("name", "");
            const json& pbr = member(m, "pbrMetallicRoughness", noObject_);
            if (const json& factor = member(pbr, "baseColorFactor", noList_); factor.is_array() && factor.size() == 4)
                for (int c = 0; c < 4; ++c)
                    if (factor[c].is_number()) out.baseColor[c] = std::clamp(factor[c].get<float>(), 0.0f, 1.0f);
            out.roughness = float(std::clamp(real(pbr, "roughnessFactor", 1), 0.0, 1.0));
            if (pbr.contains("baseColorTexture")) out.baseColorPicture = picture(pbr["baseColorTexture"]);
            if (m.contains("normalTexture")) out.normalPicture = picture(m["normalTexture"]);
            if (m.value("alphaMode", "OPAQUE") == "MASK")
                out.alphaCutoff = float(std::clamp(real(m, "alphaCutoff", 0.5), 0.01, 1.0));
            data_.materials.push_back(out);
        }
        if (data_.materials.empty()) data_.materials.emplace_back();
    }

    // "leaf_b_lod2" -> "leaf_b", 2.
    static bool splitName(const std::string& name, std::string& variant, uint32_t& lod) {
        const size_t at = name.rfind("_lod");
        if (at == std::string::npos || at == 0 || name.size() != at + 5 || name[at + 4] < '0' || name[at + 4] > '9')
            return false;
        variant = name.substr(0, at);
        lod = uint32_t(name[at + 4] - '0');
        return true;
    }

    void readMeshes() {
        const json& meshes = member(root_, "meshes", noList_);
        check(meshes.is_array() && meshes.size() <= 4096, "meshes is not a list");
        std::map<std::pair<uint32_t, std::string>, std::map<uint32_t, const json*>> found;
        for (const json& mesh : meshes) {
            check(mesh.is_object(), "meshes holds something else");
            std::string variant;
            uint32_t lod = 0;
            if (!splitName(mesh.value("name", ""), variant, lod)) continue;
            const std::string kind = variant.substr(0, variant.find('_'));
            auto it = std::find(data_.kinds.begin(), data_.kinds.end(), kind);
            if (it == data_.kinds.end() && open_ && data_.kinds.size() < kMaxTerminalKinds)
                it = data_.kinds.insert(it, kind);
            if (it != data_.kinds.end()) found[{uint32_t(it - data_.kinds.begin()), variant}][lod] = &mesh;
        }
        check(!found.empty(), "it holds no terminal meshes (KIND_lodN)");
        for (const auto& [key, lods] : found) {
            TerminalVariant variant{key.second, key.first, {}};
            for (const auto& [lod, mesh] : lods) {
                if (variant.lods.size() == kMaxLods) break;
                variant.lods.push_back(readMesh(*mesh));
            }
            data_.variants.push_back(std::move(variant));
        }
    }

    TerminalLod readMesh(const json& mesh) {
        const std::string name = mesh.value("name", "");
        const json& primitives = member(mesh, "primitives", noList_);
        check(primitives.is_array() && primitives.size() == 1 && primitives[0].is_object(),
              name + ": a terminal mesh must have one primitive");
        const json& p = primitives[0];
        check(number(p, "mode", 4) == 4, name + " is not made of triangles");
        const json& attributes = member(p, "attributes", noObject_);
        const std::vector<double> position = accessor(number(attributes, "POSITION", ~0ull), "VEC3", 3);
        const std::vector<double> normal = accessor(number(attributes, "NORMAL", ~0ull), "VEC3", 3);
        std::vector<double> uv(position.size() / 3 * 2, 0.0);
        if (attributes.contains("TEXCOORD_0")) uv = accessor(number(attributes, "TEXCOORD_0", ~0ull), "VEC2", 2);
        const std::vector<double> index = accessor(number(p, "indices", ~0ull), "SCALAR", 1);
        const size_t vertices = position.size() / 3;
        check(vertices > 0 && vertices <= kMaxMeshVertices && normal.size() == position.size() &&
                  uv.size() == 2 * vertices,
              name + ": attributes of different lengths, or more than 65,536 vertices");
        check(!index.empty() && index.size() % 3 == 0, name + ": indices are not whole triangles");

        check(data_.vertices.size() + vertices <= kMaxFileIndices &&
                  data_.indices.size() + index.size() <= kMaxFileIndices,
              name + ": more than 16 million vertices or indices in all meshes");

        TerminalLod lod;
        lod.firstVertex = uint32_t(data_.vertices.size());
        lod.vertexCount = uint32_t(vertices);
        lod.firstIndex = uint32_t(data_.indices.size());
        lod.indexCount = uint32_t(index.size());
        const uint64_t material = number(p, "material", 0);
        check(material < data_.materials.size(), name + ": its material is missing");
        lod.material = uint32_t(material);
        lod.pixels = float(std::clamp(real(member(mesh, "extras", noObject_), "pixels", 0), 0.0, 1e4));
        for (size_t i = 0; i < vertices; ++i) {
            TerminalVertex v;
            for (int c = 0; c < 3; ++c) v.position[c] = float(position[3 * i + c]);
            for (int c = 0; c < 2; ++c) v.uv[c] = float(uv[2 * i + c]);
            const glm::vec3 n(normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]);
            const float sum = v.position.x + v.position.y + v.position.z + v.uv.x + v.uv.y + n.x + n.y + n.z;
            check(std::isfinite(sum) && std::abs(sum) < 1e6f, name + ": a vertex is not finite");
            v.normal = packOct(glm::dot(n, n) > 1e-12f ? n : glm::vec3(0, 0, 1));
            data_.vertices.push_back(v);
        }
        for (double i : index) {
            check(i >= 0 && i < double(vertices) && i == std::floor(i), name + ": an index is out of range");
            data_.indices.push_back(uint32_t(i));
        }
        return lod;
    }

    std::span<const std::byte> bytes_, binary_;
    TerminalData& data_;
    json root_;
    bool open_ = false;
    const json noList_ = json::array(), noObject_ = json::object();
    std::map<uint64_t, int> pictures_;
};

}  // namespace

std::vector<std::string> standardTerminalKinds() {
    return {"bark", "leaf", "pebble", "oval", "blossom", "tuft"};
}

Result<TerminalData> readTerminals(const std::filesystem::path& path, std::vector<std::string> kinds) {
    Result<std::vector<std::byte>> bytes = readFile(path);
    if (!bytes) return bytes.failure();
    return parseTerminals(*bytes, path.string(), std::move(kinds));
}

Result<TerminalData> parseTerminals(std::span<const std::byte> file, const std::string& name,
                                    std::vector<std::string> kinds) {
    TerminalData data;
    data.kinds = std::move(kinds);
    try {
        Reader(file, data).read();
    } catch (const Mistake& mistake) {
        return Failure(name, mistake.text);
    } catch (const json::exception& mistake) {
        return Failure(name, std::string("malformed glTF: ") + mistake.what());
    } catch (const std::bad_alloc&) {
        return Failure(name, "states sizes that do not fit into memory");
    }
    measureTerminalErrors(data);
    return data;
}

}  // namespace espalier
