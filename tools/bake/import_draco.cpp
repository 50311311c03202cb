// In: a primitive that Draco packs. Out: its attributes and triangles. What Draco holds are numbers; what they mean is
// said by the accessors: encoders store normalised integers with and without Draco's own mark for them.
#include <draco/compression/decode.h>

#include <algorithm>
#include <stdexcept>

#include "tools/bake/import_gltf.hpp"

namespace espalier::import {
namespace {

// The factor from stored integers to values, and whether they end at -1.
struct Scale {
    double one = 1;
    bool normalized = false;
};

Scale scaleOf(const draco::PointAttribute& stored, const tinygltf::Accessor* accessor) {
    if (!draco::IsDataTypeIntegral(stored.data_type())) return {};
    // Where the accessor speaks of floats, the encoder has kept integers: its own mark says what they are.
    if (!accessor || !isInteger(accessor->componentType)) {
        if (!stored.normalized()) return {};
        const int bits = draco::DataTypeLength(stored.data_type()) * 8;
        const bool isSigned = stored.data_type() == draco::DT_INT8 || stored.data_type() == draco::DT_INT16 ||
                              stored.data_type() == draco::DT_INT32 || stored.data_type() == draco::DT_INT64;
        return {double((~uint64_t(0) >> (64 - bits)) >> (isSigned ? 1 : 0)), true};
    }
    if (!accessor->normalized) return {};
    return {normalizedOne(accessor->componentType), true};
}

// Each point's value, `components` numbers of type T; false: damaged.
template <class T, class Put>
bool readValues(const draco::Mesh& mesh, const draco::PointAttribute& stored, int components, Put&& put) {
    T value[4] = {};
    for (uint32_t i = 0; i < mesh.num_points(); ++i) {
        const auto at = stored.mapped_index(draco::PointIndex(i));
        if (at.value() >= stored.size() || !stored.ConvertValue<T>(at, int8_t(components), value)) return false;
        for (int c = 0; c < components; ++c) put(size_t(i) * size_t(components) + size_t(c), value[c]);
    }
    return true;
}

Status readAttribute(const Document& document, const draco::Mesh& mesh, int id, const tinygltf::Accessor* accessor,
                     const Attribute& wanted, const std::string& place) {
    const draco::PointAttribute* stored = id < 0 ? nullptr : mesh.GetAttributeByUniqueId(uint32_t(id));
    if (!stored) return Failure(document.path, place + ": the Draco data has no attribute " + std::to_string(id));
    if (stored->num_components() != wanted.components)
        return Failure(document.path,
                       place + ": a Draco attribute has " + std::to_string(stored->num_components()) + " components");
    std::vector<float>& out = *wanted.into;
    out.resize(size_t(mesh.num_points()) * size_t(wanted.components));
    const Scale scale = scaleOf(*stored, accessor);
    const bool whole = draco::IsDataTypeIntegral(stored->data_type());
    const auto put = [&](size_t i, auto value) {
        out[i] = scale.normalized ? std::max(float(value) / float(scale.one), -1.0f) : float(value);
    };
    const bool read = whole ? readValues<int64_t>(mesh, *stored, wanted.components, put)
                            : readValues<float>(mesh, *stored, wanted.components, put);
    if (!read) return Failure(document.path, place + ": damaged Draco attribute");
    return Done{};
}

const tinygltf::Accessor* accessorOf(const Document& document, const tinygltf::Primitive& primitive,
                                     const std::string& name) {
    auto it = primitive.attributes.find(name);
    if (it == primitive.attributes.end() || it->second < 0 || size_t(it->second) >= document.gltf.accessors.size())
        return nullptr;
    return &document.gltf.accessors[size_t(it->second)];
}

// Draco reports what it has thought of, and lets the standard library throw at counts that it hasn't.
draco::StatusOr<std::unique_ptr<draco::Mesh>> decode(draco::DecoderBuffer* buffer) {
    try {
        draco::Decoder decoder;
        return decoder.DecodeMeshFromBuffer(buffer);
    } catch (const std::length_error&) {
        return draco::Status(draco::Status::DRACO_ERROR, "absurd counts");
    }
}

}  // namespace

Status readDraco(const Document& document, const tinygltf::Primitive& primitive, const PrimitiveRequest& request,
                 const std::string& place, Primitive& out, std::vector<std::string>& remarks) {
    const tinygltf::Value& extension = primitive.extensions.at("KHR_draco_mesh_compression");
    if (!extension.IsObject() || !extension.Get("bufferView").IsInt() || !extension.Get("attributes").IsObject())
        return Failure(document.path, place + ": KHR_draco_mesh_compression is incomplete");
    const int view = extension.Get("bufferView").Get<int>();
    auto exists = viewBytes(document, view, 0, 0, place);
    if (!exists) return std::move(exists.failure());
    Bytes data = document.views[size_t(view)];
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(data.data()), data.size());
    draco::StatusOr<std::unique_ptr<draco::Mesh>> decoded = decode(&buffer);
    if (!decoded.ok())
        return Failure(document.path, place + ": damaged Draco data: " + decoded.status().error_msg_string());
    const draco::Mesh& mesh = *decoded.value();
    const auto wanted = attributesOf(request, out);
    uint64_t vertexBytes = 0;
    for (const Attribute& w : wanted) vertexBytes += uint64_t(w.components) * sizeof(float);
    if (!document.intake->take(uint64_t(mesh.num_points()) * vertexBytes + uint64_t(mesh.num_faces()) * 12))
        return Failure(document.path, place + ": the Draco data holds absurdly much for its size");
    for (const Attribute& w : wanted) {
        const tinygltf::Value& id = extension.Get("attributes").Get(w.name);
        if (!id.IsInt()) continue;
        Status read = readAttribute(document, mesh, id.Get<int>(), accessorOf(document, primitive, w.name), w,
                                    place + "." + w.name);
        if (!read && w.into == &out.positions) return read;
        if (read) continue;
        w.into->clear();
        remarks.push_back(leftOut(w, read.failure()));
    }
    out.indices.resize(size_t(mesh.num_faces()) * 3);
    for (uint32_t f = 0; f < mesh.num_faces(); ++f)
        for (int k = 0; k < 3; ++k)
            out.indices[size_t(f) * 3 + size_t(k)] = mesh.face(draco::FaceIndex(f))[size_t(k)].value();
    return Done{};
}

}  // namespace espalier::import
