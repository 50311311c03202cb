// In: a document with bounded views. Out: accessors as floats or indices, primitives as triangle lists.
// Every index is compared with what it indexes before it is used.
#include <draco/compression/decode.h>

#include <cmath>
#include <cstring>

#include "tools/bake/import.hpp"

namespace espalier::import {
namespace {

constexpr size_t kMaxCount = size_t(1) << 27;  // elements of one accessor

// Where an accessor's elements lie.
struct Strided {
    const uint8_t* data = nullptr;  // null: all zero
    size_t stride = 0, count = 0;
    int componentType = 0, components = 0;
    bool normalized = false;
};

std::string accessorPlace(int accessor) {
    return "accessors[" + std::to_string(accessor) + "]";
}

Result<Bytes> part(const Document& document, int view, size_t offset, size_t length, const std::string& place) {
    if (view < 0 || size_t(view) >= document.views.size())
        return Failure(document.path, place + ": bufferView " + std::to_string(view) + " does not exist");
    Bytes bytes = document.views[size_t(view)];
    if (offset > bytes.size() || length > bytes.size() - offset)
        return Failure(document.path, place + ": reaches past the end of bufferView " + std::to_string(view));
    return bytes.subspan(offset, length);
}

Result<Strided> locate(const Document& document, int index) {
    std::string place = accessorPlace(index);
    if (index < 0 || size_t(index) >= document.gltf.accessors.size())
        return Failure(document.path, place + " does not exist");
    const auto& accessor = document.gltf.accessors[size_t(index)];
    int size = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
    int components = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
    if (size <= 0 || components <= 0) return Failure(document.path, place + ": unknown type");
    if (accessor.count == 0 || accessor.count > kMaxCount)
        return Failure(document.path, place + ": absurd count " + std::to_string(accessor.count));
    if (!document.intake->take(accessor.count * uint64_t(components) * 4))
        return Failure(document.path, place + ": " + std::to_string(accessor.count) +
                                          " elements, absurdly many for a file of its size");
    Strided out;
    out.count = accessor.count;
    out.componentType = accessor.componentType;
    out.components = components;
    out.normalized = accessor.normalized;
    size_t element = size_t(size) * size_t(components);
    out.stride = element;
    if (accessor.bufferView < 0) return out;
    if (size_t(accessor.bufferView) < document.strides.size() && document.strides[size_t(accessor.bufferView)] != 0)
        out.stride = document.strides[size_t(accessor.bufferView)];
    if (out.stride < element) return Failure(document.path, place + ": elements overlap (byteStride too small)");
    auto bytes =
        part(document, accessor.bufferView, accessor.byteOffset, (out.count - 1) * out.stride + element, place);
    if (!bytes) return std::move(bytes.failure());
    out.data = bytes->data();
    return out;
}

template <class T>
T load(const uint8_t* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

float component(const uint8_t* at, int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return load<float>(at);
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return normalized ? std::max(float(load<int8_t>(at)) / 127.0f, -1.0f) : float(load<int8_t>(at));
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return float(*at) / (normalized ? 255.0f : 1.0f);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return normalized ? std::max(float(load<int16_t>(at)) / 32767.0f, -1.0f) : float(load<int16_t>(at));
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return float(load<uint16_t>(at)) / (normalized ? 65535.0f : 1.0f);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return float(load<uint32_t>(at));
        case TINYGLTF_COMPONENT_TYPE_INT:
            return float(load<int32_t>(at));
        case TINYGLTF_COMPONENT_TYPE_DOUBLE:
            return float(load<double>(at));
        default:
            return 0;
    }
}

uint32_t unsignedAt(const uint8_t* at, int type) {
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return *at;
    if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return load<uint16_t>(at);
    return load<uint32_t>(at);
}

bool isIndexType(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

// Puts an accessor's sparse values over `out` (components a piece).
Status applySparse(const Document& document, int index, const Strided& from, int components, std::vector<float>& out) {
    const auto& accessor = document.gltf.accessors[size_t(index)];
    const auto& sparse = accessor.sparse;
    std::string place = accessorPlace(index) + ".sparse";
    if (sparse.count <= 0 || size_t(sparse.count) > from.count) return Failure(document.path, place + ": absurd count");
    if (!isIndexType(sparse.indices.componentType)) return Failure(document.path, place + ": unknown index type");
    size_t count = size_t(sparse.count);
    size_t indexSize = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(sparse.indices.componentType)));
    size_t size = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(from.componentType)));
    size_t element = size * size_t(from.components);
    if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        return Failure(document.path, place + ": negative offset");
    auto at = part(document, sparse.indices.bufferView, size_t(sparse.indices.byteOffset), count * indexSize, place);
    if (!at) return std::move(at.failure());
    auto values = part(document, sparse.values.bufferView, size_t(sparse.values.byteOffset), count * element, place);
    if (!values) return std::move(values.failure());
    for (size_t i = 0; i < count; ++i) {
        size_t target = unsignedAt(at->data() + i * indexSize, sparse.indices.componentType);
        if (target >= from.count)
            return Failure(document.path, place + ": index " + std::to_string(target) + " does not exist");
        for (int c = 0; c < components; ++c)
            out[target * size_t(components) + size_t(c)] =
                component(values->data() + i * element + size_t(c) * size, from.componentType, from.normalized);
    }
    return Done{};
}

// A strip or fan as a list, as glTF winds them.
std::vector<uint32_t> toList(const std::vector<uint32_t>& in, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES) return {in.begin(), in.begin() + long(in.size() / 3 * 3)};
    std::vector<uint32_t> out;
    for (size_t i = 0; i + 2 < in.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            out.insert(out.end(), {in[i + 1], in[i + 2], in[0]});
        else if (i % 2 == 0)
            out.insert(out.end(), {in[i], in[i + 1], in[i + 2]});
        else
            out.insert(out.end(), {in[i], in[i + 2], in[i + 1]});
    }
    return out;
}

Status readDracoAttribute(const Document& document, const draco::Mesh& mesh, int id, int components,
                          const std::string& place, std::vector<float>& out) {
    const draco::PointAttribute* attribute = id < 0 ? nullptr : mesh.GetAttributeByUniqueId(uint32_t(id));
    if (!attribute) return Failure(document.path, place + ": the Draco data has no attribute " + std::to_string(id));
    if (attribute->num_components() != components)
        return Failure(document.path, place + ": a Draco attribute has " + std::to_string(attribute->num_components()) +
                                          " components");
    out.resize(size_t(mesh.num_points()) * size_t(components));
    for (uint32_t i = 0; i < mesh.num_points(); ++i) {
        auto value = attribute->mapped_index(draco::PointIndex(i));
        if (value.value() >= attribute->size() ||
            !attribute->ConvertValue<float>(value, int8_t(components), out.data() + size_t(i) * size_t(components)))
            return Failure(document.path, place + ": damaged Draco attribute");
    }
    return Done{};
}

// The attributes that are read, and where they go.
struct Wanted {
    std::string name;
    int components;
    std::vector<float>* into;
};
std::vector<Wanted> wantedOf(Primitive& out, UvSets sets) {
    auto uvs = [](int set) { return "TEXCOORD_" + std::to_string(set); };
    std::vector<Wanted> all{{"POSITION", 3, &out.positions},
                            {"NORMAL", 3, &out.normals},
                            {uvs(sets.walk), 2, &out.walkUvs},
                            {uvs(sets.drawn), 2, &out.drawnUvs}};
    if (sets.colour > 0) all.push_back({"COLOR_0", sets.colour, &out.colours});
    return all;
}

Result<Primitive> readDraco(const Document& document, const tinygltf::Value& extension, UvSets sets,
                            const std::string& place) {
    if (!extension.IsObject() || !extension.Get("bufferView").IsInt() || !extension.Get("attributes").IsObject())
        return Failure(document.path, place + ": KHR_draco_mesh_compression is incomplete");
    auto bytes = part(document, extension.Get("bufferView").Get<int>(), 0, 0, place);
    if (!bytes) return std::move(bytes.failure());
    Bytes data = document.views[size_t(extension.Get("bufferView").Get<int>())];
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(data.data()), data.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        return Failure(document.path, place + ": damaged Draco data: " + decoded.status().error_msg_string());
    const draco::Mesh& mesh = *decoded.value();
    if (!document.intake->take(uint64_t(mesh.num_points()) * 40 + uint64_t(mesh.num_faces()) * 12))
        return Failure(document.path, place + ": the Draco data holds absurdly much for its size");
    Primitive out;
    for (const Wanted& w : wantedOf(out, sets)) {
        const tinygltf::Value& id = extension.Get("attributes").Get(w.name);
        if (!id.IsInt()) continue;
        Status read = readDracoAttribute(document, mesh, id.Get<int>(), w.components, place + "." + w.name, *w.into);
        if (!read) return std::move(read.failure());
    }
    out.indices.resize(size_t(mesh.num_faces()) * 3);
    for (uint32_t f = 0; f < mesh.num_faces(); ++f)
        for (int k = 0; k < 3; ++k)
            out.indices[size_t(f) * 3 + size_t(k)] = mesh.face(draco::FaceIndex(f))[size_t(k)].value();
    return out;
}

}  // namespace

Result<std::vector<float>> readFloats(const Document& document, int accessor, int components, const char* what) {
    auto from = locate(document, accessor);
    if (!from) return std::move(from.failure());
    if (from->components != components)
        return Failure(document.path, accessorPlace(accessor) + ": " + what + " has " +
                                          std::to_string(from->components) + " components");
    std::vector<float> out(from->count * size_t(components), 0.0f);
    size_t size = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(from->componentType)));
    for (size_t i = 0; from->data && i < from->count; ++i)
        for (int c = 0; c < components; ++c)
            out[i * size_t(components) + size_t(c)] =
                component(from->data + i * from->stride + size_t(c) * size, from->componentType, from->normalized);
    if (document.gltf.accessors[size_t(accessor)].sparse.isSparse) {
        Status sparse = applySparse(document, accessor, *from, components, out);
        if (!sparse) return std::move(sparse.failure());
    }
    return out;
}

int colourComponents(const Document& document, const tinygltf::Primitive& primitive) {
    auto it = primitive.attributes.find("COLOR_0");
    if (it == primitive.attributes.end() || size_t(it->second) >= document.gltf.accessors.size()) return 0;
    const int type = document.gltf.accessors[size_t(it->second)].type;
    return type == TINYGLTF_TYPE_VEC3 ? 3 : type == TINYGLTF_TYPE_VEC4 ? 4 : 0;
}

Result<std::vector<uint32_t>> readIndices(const Document& document, int accessor) {
    auto from = locate(document, accessor);
    if (!from) return std::move(from.failure());
    if (from->components != 1 || !isIndexType(from->componentType))
        return Failure(document.path, accessorPlace(accessor) + ": indices are not unsigned integers");
    std::vector<uint32_t> out(from->count, 0);
    for (size_t i = 0; from->data && i < from->count; ++i)
        out[i] = unsignedAt(from->data + i * from->stride, from->componentType);
    return out;
}

Result<Primitive> readPrimitive(const Document& document, const tinygltf::Primitive& primitive, UvSets sets,
                                const std::string& place) {
    Primitive out;
    auto packed = primitive.extensions.find("KHR_draco_mesh_compression");
    if (packed != primitive.extensions.end()) {
        auto read = readDraco(document, packed->second, sets, place);
        if (!read) return std::move(read.failure());
        out = std::move(*read);
    } else {
        for (const Wanted& w : wantedOf(out, sets)) {
            auto it = primitive.attributes.find(w.name);
            if (it == primitive.attributes.end()) continue;
            auto read = readFloats(document, it->second, w.components, w.name.c_str());
            if (!read) return std::move(read.failure());
            *w.into = std::move(*read);
        }
        if (primitive.indices >= 0) {
            auto read = readIndices(document, primitive.indices);
            if (!read) return std::move(read.failure());
            out.indices = std::move(*read);
        } else {
            out.indices.resize(out.positions.size() / 3);
            for (size_t i = 0; i < out.indices.size(); ++i) out.indices[i] = uint32_t(i);
        }
        out.indices = toList(out.indices, primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode);
    }
    size_t count = out.positions.size() / 3;
    if (count == 0) return Failure(document.path, place + ": no POSITION");
    for (float x : out.positions)
        if (!std::isfinite(x)) return Failure(document.path, place + ": a position is not a number");
    for (uint32_t i : out.indices)
        if (i >= count)
            return Failure(document.path,
                           place + ": index " + std::to_string(i) + " of " + std::to_string(count) + " vertices");
    for (const Wanted& w : wantedOf(out, sets))
        if (!w.into->empty() && w.into->size() != count * size_t(w.components))
            return Failure(document.path, place + ": " + w.name + " has " +
                                              std::to_string(w.into->size() / size_t(w.components)) +
                                              " elements, POSITION " + std::to_string(count));
    return out;
}

}  // namespace espalier::import
