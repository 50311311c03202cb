// In: the path of a .gltf or .glb. Out: its parsed text and, for each buffer view, bytes that are surely there.
// tinygltf sees the text only, without buffers, images and Draco's indices: its own loading trusts the file.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include "tools/bake/import_gltf.hpp"

#include <meshoptimizer.h>

#include <cstring>
#include <filesystem>

#include "runtime/core/file.hpp"
#include "runtime/core/glb.hpp"

namespace espalier::import {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 128;

uint32_t word(Bytes bytes, size_t at) {
    uint32_t value;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
}

// Splits a .glb into text and binary chunk.
Status splitBinary(const std::string& path, Bytes file, std::string& text, std::vector<uint8_t>& binary) {
    if (file.size() < 20) return Failure(path, "truncated: a .glb has at least 20 bytes");
    if (word(file, 4) != 2) return Failure(path, "not glTF 2.0: container version " + std::to_string(word(file, 4)));
    if (word(file, 8) > file.size())
        return Failure(path, "truncated: the header states " + std::to_string(word(file, 8)) + " bytes, the file has " +
                                 std::to_string(file.size()));
    size_t end = word(file, 8), at = 12;
    while (at + 8 <= end) {
        size_t length = word(file, at);
        uint32_t type = word(file, at + 4);
        at += 8;
        if (length > end - at) return Failure(path, "truncated: a chunk reaches past the end of the file");
        if (type == kGlbJson && text.empty()) text.assign(file.begin() + long(at), file.begin() + long(at + length));
        if (type == kGlbBinary && binary.empty())
            binary.assign(file.begin() + long(at), file.begin() + long(at + length));
        at += length;
    }
    if (text.empty()) return Failure(path, "the container has no JSON chunk");
    return Done{};
}

// tinygltf recurses over extras and extensions: a document nested without end would end the stack. And it makes some
// hundred bytes of each value: one that is made of empty objects would become a large multiple of its text.
Status judgeText(const std::string& path, const std::string& text, Intake& intake) {
    int depth = 0;
    uint64_t objects = 0, values = 0;
    bool quoted = false;
    for (size_t i = 0; i < text.size(); ++i) {
        char c = text[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            ++objects;
            if (++depth > kMaxDepth) return Failure(path, "the JSON is nested too deeply");
        } else if (c == '}' || c == ']') {
            --depth;
        } else if (c == ',') {
            ++values;
        }
    }
    if (!intake.take(objects * 768 + values * 256)) return Failure(path, "the JSON holds absurdly many values");
    return Done{};
}

bool getSize(const json& object, const char* key, uint64_t& value, bool required) {
    auto it = object.find(key);
    if (it == object.end()) return !required;
    if (it->is_number_unsigned()) {
        value = it->get<uint64_t>();
        return true;
    }
    // Some writers state sizes as floating-point numbers.
    if (!it->is_number_float()) return false;
    double d = it->get<double>();
    if (!(d >= 0 && d < 1e15) || d != double(uint64_t(d))) return false;
    value = uint64_t(d);
    return true;
}

const json* member(const json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    auto it = object.find(key);
    return it == object.end() ? nullptr : &*it;
}

std::string textOf(const json& object, const char* key) {
    const json* value = member(object, key);
    return value && value->is_string() ? value->get<std::string>() : std::string();
}

const json* extension(const json& object, const char* name) {
    const json* all = member(object, "extensions");
    return all ? member(*all, name) : nullptr;
}

bool hasExtension(const json& object, const char* name) {
    return extension(object, name) != nullptr;
}

Status loadBuffers(Document& document, const json& root, std::vector<uint8_t> binary) {
    const json* buffers = member(root, "buffers");
    if (!buffers) return Done{};
    if (!buffers->is_array()) return Failure(document.path, "buffers: not an array");
    for (size_t i = 0; i < buffers->size(); ++i) {
        const json& buffer = (*buffers)[i];
        std::string place = "buffers[" + std::to_string(i) + "]";
        uint64_t length = 0;
        if (!buffer.is_object() || !getSize(buffer, "byteLength", length, true))
            return Failure(document.path, place + ": no byteLength");
        std::vector<uint8_t> bytes;
        std::string uri = textOf(buffer, "uri");
        if (!uri.empty()) {
            auto read = readUri(document, uri);
            if (!read) return std::move(read.failure());
            bytes = std::move(*read);
        } else if (i == 0 && !binary.empty()) {
            bytes = std::move(binary);
        } else {
            // A buffer without data is legal as the fallback of compressed views only.
            document.storage.emplace_back();
            continue;
        }
        if (bytes.size() < length)
            return Failure(document.path, place + ": states " + std::to_string(length) + " bytes, has " +
                                              std::to_string(bytes.size()));
        bytes.resize(length);
        document.storage.push_back(std::move(bytes));
    }
    return Done{};
}

// The bytes of a view or of a compressed view's source.
Result<Bytes> range(const Document& document, const json& view, const std::string& place) {
    uint64_t buffer = 0, offset = 0, length = 0;
    if (!view.is_object() || !getSize(view, "buffer", buffer, true) || !getSize(view, "byteLength", length, true) ||
        !getSize(view, "byteOffset", offset, false))
        return Failure(document.path, place + ": buffer, byteOffset or byteLength missing or no whole number");
    if (buffer >= document.storage.size())
        return Failure(document.path, place + ": buffer " + std::to_string(buffer) + " does not exist");
    const auto& bytes = document.storage[buffer];
    if (bytes.empty() && length > 0)
        return Failure(document.path, place + ": buffer " + std::to_string(buffer) + " holds nothing: it has no uri");
    if (offset > bytes.size() || length > bytes.size() - offset)
        return Failure(document.path, place + ": bytes " + std::to_string(offset) + " to " +
                                          std::to_string(offset + length) + " lie outside of buffer " +
                                          std::to_string(buffer) + " (" + std::to_string(bytes.size()) + " bytes)");
    return Bytes(bytes).subspan(offset, length);
}

Result<std::vector<uint8_t>> decodeMeshopt(const Document& document, const json& packed, const std::string& place) {
    auto source = range(document, packed, place + ".EXT_meshopt_compression");
    if (!source) return std::move(source.failure());
    uint64_t stride = 0, count = 0;
    if (!getSize(packed, "byteStride", stride, true) || !getSize(packed, "count", count, true))
        return Failure(document.path, place + ": meshopt stride or count missing");
    std::string mode = textOf(packed, "mode"), filter = textOf(packed, "filter");
    bool attributes = mode == "ATTRIBUTES";
    bool fits = attributes ? (stride > 0 && stride <= 256 && stride % 4 == 0) : (stride == 2 || stride == 4);
    // The densest meshopt data is 1/64 of what it decodes to; more is a made-up count.
    if (!fits || count > source->size() * 64 / stride || !document.intake->take(count * stride))
        return Failure(document.path, place + ": absurd meshopt stride or count");
    if (mode == "TRIANGLES" && count % 3 != 0) return Failure(document.path, place + ": meshopt count is not whole");
    std::vector<uint8_t> out(count * stride);
    int rc = -1;
    if (attributes) rc = meshopt_decodeVertexBuffer(out.data(), count, stride, source->data(), source->size());
    if (mode == "TRIANGLES") rc = meshopt_decodeIndexBuffer(out.data(), count, stride, source->data(), source->size());
    if (mode == "INDICES") rc = meshopt_decodeIndexSequence(out.data(), count, stride, source->data(), source->size());
    if (rc != 0) return Failure(document.path, place + ": damaged EXT_meshopt_compression data");
    if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) meshopt_decodeFilterOct(out.data(), count, stride);
    if (filter == "QUATERNION" && stride == 8) meshopt_decodeFilterQuat(out.data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), count, stride);
    return out;
}

Status loadViews(Document& document, const json& root) {
    const json* views = member(root, "bufferViews");
    if (!views) return Done{};
    if (!views->is_array()) return Failure(document.path, "bufferViews: not an array");
    size_t buffers = document.storage.size();
    document.storage.reserve(buffers + views->size());  // spans into it stay valid
    for (size_t i = 0; i < views->size(); ++i) {
        const json& view = (*views)[i];
        std::string place = "bufferViews[" + std::to_string(i) + "]";
        uint64_t stride = 0;
        if (!view.is_object() || !getSize(view, "byteStride", stride, false) || stride > 65535)
            return Failure(document.path, place + ": not a buffer view");
        const json* packed = extension(view, "EXT_meshopt_compression");
        if (packed && packed->is_object()) {
            auto bytes = decodeMeshopt(document, *packed, place);
            if (!bytes) return std::move(bytes.failure());
            document.storage.push_back(std::move(*bytes));
            document.views.push_back(document.storage.back());
        } else {
            auto bytes = range(document, view, place);
            if (!bytes) return std::move(bytes.failure());
            document.views.push_back(*bytes);
        }
        document.strides.push_back(uint32_t(stride));
    }
    return Done{};
}

// What readSkin() asks for. tinygltf refuses a file for a skin that is damaged; it is only left out.
void stripSkins(json& root) {
    auto skins = root.find("skins");
    if (skins == root.end()) return;
    json kept = json::array();
    for (const json& skin : skins->is_array() ? *skins : json::array()) {
        json joints = json::array();
        if (const json* all = member(skin, "joints"); all && all->is_array())
            for (const json& joint : *all) joints.push_back(joint.is_number_integer() ? joint : json(-1));
        kept.push_back({{"joints", std::move(joints)}});
        const json* matrices = member(skin, "inverseBindMatrices");
        if (matrices && matrices->is_number_integer()) kept.back()["inverseBindMatrices"] = *matrices;
    }
    *skins = std::move(kept);
}

// Of samplers only the wrap modes count.
void stripSamplers(json& root) {
    auto samplers = root.find("samplers");
    if (samplers == root.end()) return;
    json kept = json::array();
    if (samplers->is_array())
        for (const json& sampler : *samplers) {
            json& modes = kept.emplace_back(json::object());
            for (const char* key : {"wrapS", "wrapT"})
                if (const json* mode = member(sampler, key); mode && mode->is_number_integer()) modes[key] = *mode;
        }
    *samplers = std::move(kept);
}

// Takes out of the text what tinygltf would load by itself.
void strip(json& root) {
    stripSkins(root);
    stripSamplers(root);
    for (const char* key : {"buffers", "images", "animations", "cameras", "extras"}) root.erase(key);
    auto meshes = root.find("meshes");
    if (meshes == root.end() || !meshes->is_array()) return;
    for (json& mesh : *meshes) {
        if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) continue;
        for (json& primitive : mesh["primitives"]) {
            if (!primitive.is_object()) continue;
            // tinygltf refuses indices without a buffer view, which sparse ones and Draco's are: indicesOf() finds
            // them.
            primitive.erase("extras");
            const json* indices = member(primitive, "indices");
            if (!indices || !indices->is_number_integer()) continue;
            if (!hasExtension(primitive, "KHR_draco_mesh_compression")) primitive["extras"] = {{"indices", *indices}};
            primitive.erase("indices");
        }
    }
}

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string decodePercent(std::string_view text) {
    std::string out;
    for (size_t i = 0; i < text.size(); ++i) {
        bool coded = text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0;
        out += coded ? char(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2])) : text[i];
        if (coded) i += 2;
    }
    return out;
}

std::vector<uint8_t> decodeBase64(std::string_view text) {
    std::vector<uint8_t> out;
    out.reserve(text.size() / 4 * 3);
    uint32_t bits = 0;
    int have = 0;
    for (char c : text) {
        int v = c >= 'A' && c <= 'Z'   ? c - 'A'
                : c >= 'a' && c <= 'z' ? c - 'a' + 26
                : c >= '0' && c <= '9' ? c - '0' + 52
                : c == '+' || c == '-' ? 62
                : c == '/' || c == '_' ? 63
                                       : -1;
        if (v < 0) continue;
        bits = bits << 6 | uint32_t(v);
        have += 6;
        if (have >= 8) {
            have -= 8;
            out.push_back(uint8_t(bits >> have));
        }
    }
    return out;
}

}  // namespace

Result<std::vector<uint8_t>> readUri(const Document& document, const std::string& uri) {
    if (uri.rfind("data:", 0) == 0) {
        size_t comma = uri.find(',');
        if (comma == std::string::npos) return Failure(document.path, "a data URI without data");
        std::string data = uri.substr(comma + 1);
        if (std::string_view(uri).substr(0, comma).ends_with(";base64")) return decodeBase64(data);
        data = decodePercent(data);
        return std::vector<uint8_t>(data.begin(), data.end());
    }
    return document.intake->readBeside(document.path, decodePercent(uri));
}

Result<Document> openDocument(const std::string& path, Bytes file, Intake& intake) {
    Document document;
    document.path = path;
    document.intake = &intake;
    std::string text;
    std::vector<uint8_t> binary;
    if (file.size() >= 4 && word(file, 0) == kGlbMagic) {
        Status split = splitBinary(path, file, text, binary);
        if (!split) return std::move(split.failure());
    } else {
        text.assign(file.begin(), file.end());
    }
    Status judged = judgeText(path, text, intake);
    if (!judged) return std::move(judged.failure());
    json root = json::parse(text, nullptr, false);
    if (root.is_discarded() || !root.is_object()) return Failure(path, "not glTF: the JSON does not parse");
    std::string version = root.contains("asset") ? textOf(root["asset"], "version") : std::string();
    if (version.rfind("2.", 0) != 0) return Failure(path, "not glTF 2.0: asset.version is '" + version + "'");
    Status known = judgeExtensions(root, document);
    if (!known) return std::move(known.failure());
    Status buffers = loadBuffers(document, root, std::move(binary));
    if (!buffers) return std::move(buffers.failure());
    Status views = loadViews(document, root);
    if (!views) return std::move(views.failure());
    if (root.contains("images")) document.images = root["images"];
    strip(root);
    std::string stripped = root.dump(-1, ' ', false, json::error_handler_t::replace), error, warning;
    tinygltf::TinyGLTF loader;
    if (!loader.LoadASCIIFromString(&document.gltf, &error, &warning, stripped.c_str(), unsigned(stripped.size()), "",
                                    tinygltf::REQUIRE_VERSION))
        return Failure(path, error.empty() ? "not glTF 2.0" : error);
    return document;
}

}  // namespace espalier::import
