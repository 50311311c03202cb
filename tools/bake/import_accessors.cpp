// In: a document with bounded views. Out: accessors as floats or indices.
// Every index is compared with what it indexes before it is used.
#include <algorithm>
#include <cstring>

#include "tools/bake/import_gltf.hpp"

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

Result<Strided> locate(const Document& document, int index) {
    std::string place = accessorPlace(index);
    if (index < 0 || size_t(index) >= document.gltf.accessors.size())
        return Failure(document.path, place + " does not exist");
    const auto& accessor = document.gltf.accessors[size_t(index)];
    int size = tinygltf::GetComponentSizeInBytes(uint32_t(accessor.componentType));
    int components = tinygltf::GetNumComponentsInType(uint32_t(accessor.type));
    if (size <= 0 || components <= 0) return Failure(document.path, place + ": unknown type");
    if (accessor.count > kMaxCount)
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
    if (accessor.bufferView < 0 || accessor.count == 0) return out;
    if (size_t(accessor.bufferView) < document.strides.size() && document.strides[size_t(accessor.bufferView)] != 0)
        out.stride = document.strides[size_t(accessor.bufferView)];
    if (out.stride < element) return Failure(document.path, place + ": elements overlap (byteStride too small)");
    auto bytes =
        viewBytes(document, accessor.bufferView, accessor.byteOffset, (out.count - 1) * out.stride + element, place);
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

double number(const uint8_t* at, int type) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return double(load<float>(at));
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return load<int8_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return *at;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return load<int16_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<uint16_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<uint32_t>(at);
        case TINYGLTF_COMPONENT_TYPE_INT:
            return load<int32_t>(at);
        case TINYGLTF_COMPONENT_TYPE_DOUBLE:
            return load<double>(at);
        default:
            return 0;
    }
}

float component(const uint8_t* at, int type, bool normalized) {
    const double value = number(at, type);
    return normalized && isInteger(type) ? std::max(float(value) / float(normalizedOne(type)), -1.0f) : float(value);
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

// Puts an accessor's sparse values over `out`; value(at): one component, at its bytes.
template <class T, class Value>
Status applySparse(const Document& document, int index, const Strided& from, std::vector<T>& out, Value&& value) {
    const auto& sparse = document.gltf.accessors[size_t(index)].sparse;
    if (!sparse.isSparse) return Done{};
    std::string place = accessorPlace(index) + ".sparse";
    if (sparse.count < 0 || size_t(sparse.count) > from.count) return Failure(document.path, place + ": absurd count");
    if (sparse.count == 0) return Done{};
    if (!isIndexType(sparse.indices.componentType)) return Failure(document.path, place + ": unknown index type");
    size_t count = size_t(sparse.count);
    size_t indexSize = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(sparse.indices.componentType)));
    size_t size = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(from.componentType)));
    size_t element = size * size_t(from.components);
    if (int64_t(sparse.indices.byteOffset) < 0 || int64_t(sparse.values.byteOffset) < 0)
        return Failure(document.path, place + ": negative offset");
    auto at =
        viewBytes(document, sparse.indices.bufferView, size_t(sparse.indices.byteOffset), count * indexSize, place);
    if (!at) return std::move(at.failure());
    auto values =
        viewBytes(document, sparse.values.bufferView, size_t(sparse.values.byteOffset), count * element, place);
    if (!values) return std::move(values.failure());
    for (size_t i = 0; i < count; ++i) {
        size_t target = unsignedAt(at->data() + i * indexSize, sparse.indices.componentType);
        if (target >= from.count)
            return Failure(document.path, place + ": index " + std::to_string(target) + " does not exist");
        for (size_t c = 0; c < size_t(from.components); ++c)
            out[target * size_t(from.components) + c] = value(values->data() + i * element + c * size);
    }
    return Done{};
}

// An accessor's components one after another.
template <class T, class Value>
Result<std::vector<T>> readAll(const Document& document, int index, const Strided& from, Value&& value) {
    const size_t components = size_t(from.components);
    const size_t size = size_t(tinygltf::GetComponentSizeInBytes(uint32_t(from.componentType)));
    std::vector<T> out(from.count * components, T(0));
    for (size_t i = 0; from.data && i < from.count; ++i)
        for (size_t c = 0; c < components; ++c) out[i * components + c] = value(from.data + i * from.stride + c * size);
    Status sparse = applySparse(document, index, from, out, value);
    if (!sparse) return std::move(sparse.failure());
    return out;
}

}  // namespace

bool isInteger(int componentType) {
    return componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && componentType != TINYGLTF_COMPONENT_TYPE_DOUBLE;
}

double normalizedOne(int componentType) {
    switch (componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return 127;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 255;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return 32767;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 65535;
        default:
            return 1;  // glTF normalises no others
    }
}

Result<Bytes> viewBytes(const Document& document, int view, size_t offset, size_t length, const std::string& place) {
    if (view < 0 || size_t(view) >= document.views.size())
        return Failure(document.path, place + ": bufferView " + std::to_string(view) + " does not exist");
    Bytes bytes = document.views[size_t(view)];
    if (offset > bytes.size() || length > bytes.size() - offset)
        return Failure(document.path, place + ": reaches past the end of bufferView " + std::to_string(view));
    return bytes.subspan(offset, length);
}

Result<std::vector<float>> readFloats(const Document& document, int accessor, int components, const char* what) {
    auto from = locate(document, accessor);
    if (!from) return std::move(from.failure());
    if (from->components != components)
        return Failure(document.path, accessorPlace(accessor) + ": " + what + " has " +
                                          std::to_string(from->components) + " components");
    return readAll<float>(document, accessor, *from,
                          [&](const uint8_t* at) { return component(at, from->componentType, from->normalized); });
}

Result<std::vector<uint32_t>> readIndices(const Document& document, int accessor) {
    auto from = locate(document, accessor);
    if (!from) return std::move(from.failure());
    if (from->components != 1 || !isIndexType(from->componentType))
        return Failure(document.path, accessorPlace(accessor) + ": indices are not unsigned integers");
    return readAll<uint32_t>(document, accessor, *from,
                             [&](const uint8_t* at) { return unsignedAt(at, from->componentType); });
}

}  // namespace espalier::import
