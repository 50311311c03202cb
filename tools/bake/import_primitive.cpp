// In: a primitive. Out: its vertices and a triangle list, every index compared with what it indexes. A mesh needs its
// positions; anything else that is wrong is left out with a warning.
#include <algorithm>
#include <cmath>

#include "tools/bake/import_gltf.hpp"

namespace espalier::import {
namespace {

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

Status readPlain(const Document& document, const tinygltf::Primitive& from, const PrimitiveRequest& request,
                 Primitive& out, std::vector<std::string>& remarks) {
    for (const Attribute& a : attributesOf(request, out)) {
        auto it = from.attributes.find(a.name);
        if (it == from.attributes.end()) continue;
        auto read = readFloats(document, it->second, a.components, a.name.c_str());
        if (!read && a.into == &out.positions) return std::move(read.failure());
        if (read)
            *a.into = std::move(*read);
        else
            remarks.push_back(leftOut(a, read.failure()));
    }
    if (const int indices = indicesOf(from); indices >= 0) {
        auto read = readIndices(document, indices);
        if (!read) return std::move(read.failure());
        out.indices = std::move(*read);
    } else {
        out.indices.resize(out.positions.size() / 3);
        for (size_t i = 0; i < out.indices.size(); ++i) out.indices[i] = uint32_t(i);
    }
    out.indices = toList(out.indices, from.mode < 0 ? TINYGLTF_MODE_TRIANGLES : from.mode);
    return Done{};
}

// Vertices that no triangle names may be anything; others have to be somewhere. Returns how many aren't numbers.
Result<size_t> judgePositions(const Document& document, const std::string& place, Primitive& out) {
    const auto isNumber = [&](size_t v) {
        return std::all_of(&out.positions[v * 3], &out.positions[v * 3] + 3, [](float x) { return std::isfinite(x); });
    };
    for (uint32_t v : out.indices)
        if (!isNumber(v))
            return Failure(document.path, place + ": the position of vertex " + std::to_string(v) + " is not a number");
    size_t count = 0;
    for (size_t v = 0; v < out.positions.size() / 3; ++v) {
        if (isNumber(v)) continue;
        std::fill_n(&out.positions[v * 3], 3, 0.0f);
        ++count;
    }
    return count;
}

// Leaves out attributes that don't tell of each vertex. Returns what to say of it.
std::vector<std::string> judgeAttributes(const PrimitiveRequest& request, Primitive& out) {
    const size_t count = out.positions.size() / 3;
    std::vector<std::string> remarks;
    for (const Attribute& a : attributesOf(request, out)) {
        const size_t elements = a.into->size() / size_t(a.components);
        if (elements == count || a.into->empty()) continue;
        remarks.push_back(a.name + " has " + std::to_string(elements) + " elements, POSITION " + std::to_string(count) +
                          ": left out");
        a.into->clear();
    }
    for (size_t set = 0; set < kJointSets; ++set)
        if (out.joints[set].empty() || out.weights[set].empty()) out.joints[set].clear(), out.weights[set].clear();
    const auto tellOf = [&](const std::vector<float>& values, const std::string& text) {
        if (!std::ranges::all_of(values, [](float x) { return std::isfinite(x); })) remarks.push_back(text);
    };
    tellOf(out.normals, "normals that are not numbers are made from the triangles");
    tellOf(out.colours, "colours that are not numbers count as white");
    for (const auto* uvs : {&out.walkUvs, &out.drawnUvs, &out.otherUvs})
        tellOf(*uvs, "UVs that are not numbers count as none");
    return remarks;
}

// Colours are shares of one. Some writers forget to say so of integers.
bool judgeColours(const Document& document, const tinygltf::Primitive& from, Primitive& out) {
    const size_t index = out.colours.empty() ? SIZE_MAX : size_t(from.attributes.at("COLOR_0"));
    if (index >= document.gltf.accessors.size()) return true;
    const tinygltf::Accessor& accessor = document.gltf.accessors[index];
    if (accessor.normalized || !isInteger(accessor.componentType)) return true;
    for (float& x : out.colours) x = float(double(x) / normalizedOne(accessor.componentType));
    return false;
}

}  // namespace

int indicesOf(const tinygltf::Primitive& primitive) {
    const tinygltf::Value& extras = primitive.extras;
    return extras.IsObject() && extras.Get("indices").IsInt() ? extras.Get("indices").Get<int>() : -1;
}

int colourComponents(const Document& document, const tinygltf::Primitive& primitive) {
    auto it = primitive.attributes.find("COLOR_0");
    if (it == primitive.attributes.end()) return 0;
    const bool exists = size_t(it->second) < document.gltf.accessors.size();
    return exists && document.gltf.accessors[size_t(it->second)].type == TINYGLTF_TYPE_VEC3 ? 3 : 4;
}

std::string leftOut(const Attribute& attribute, const Failure& why) {
    return attribute.name + " is left out: " + why.diagnostics.front().message;
}

std::vector<Attribute> attributesOf(const PrimitiveRequest& request, Primitive& out) {
    std::vector<Attribute> all{{"POSITION", 3, &out.positions}, {"NORMAL", 3, &out.normals}};
    const auto addUvs = [&](int set, std::vector<float>& into) {
        if (set >= 0) all.push_back({"TEXCOORD_" + std::to_string(set), 2, &into});
    };
    addUvs(request.walkUv, out.walkUvs);
    addUvs(request.drawnUv, out.drawnUvs);
    addUvs(request.otherUv, out.otherUvs);
    if (request.colour > 0) all.push_back({"COLOR_0", request.colour, &out.colours});
    for (size_t set = 0; request.joints && set < kJointSets; ++set) {
        all.push_back({"JOINTS_" + std::to_string(set), 4, &out.joints[set]});
        all.push_back({"WEIGHTS_" + std::to_string(set), 4, &out.weights[set]});
    }
    return all;
}

Result<Primitive> readPrimitive(const Document& document, const tinygltf::Primitive& primitive,
                                const PrimitiveRequest& request, const std::string& place,
                                std::vector<Diagnostic>& warnings) {
    std::vector<std::string> remarks;
    const auto warn = [&](const std::string& text) {  // once, though the materials may share the walk's UVs
        if (std::ranges::find(remarks, text) != remarks.end()) return;
        remarks.push_back(text);
        warnings.push_back({document.path, 0, 0, {}, place + ": " + text, true});
    };
    Primitive out;
    std::vector<std::string> unread;
    const bool packed = primitive.extensions.count("KHR_draco_mesh_compression") != 0;
    Status read = packed ? readDraco(document, primitive, request, place, out, unread)
                         : readPlain(document, primitive, request, out, unread);
    if (!read) return std::move(read.failure());
    if (out.indices.empty()) return Primitive();
    const size_t count = out.positions.size() / 3;
    for (uint32_t i : out.indices)
        if (i >= count)
            return Failure(document.path,
                           place + ": index " + std::to_string(i) + " of " + std::to_string(count) + " vertices");
    for (const std::string& remark : unread) warn(remark);
    for (const std::string& remark : judgeAttributes(request, out)) warn(remark);
    if (!judgeColours(document, primitive, out))
        warn("COLOR_0 holds integers that aren't normalized: taken as if they were");
    if (request.joints && primitive.attributes.count("JOINTS_" + std::to_string(kJointSets)))
        warn("only JOINTS_0 and JOINTS_1 are read: a vertex follows eight joints at most");
    if (!request.morph.empty() && !primitive.targets.empty()) {
        Status moved = applyMorphs(document, primitive, request.morph, out);
        if (!moved) warn("its morph targets are not applied: " + moved.failure().diagnostics.front().message);
    }
    auto homeless = judgePositions(document, place, out);
    if (!homeless) return std::move(homeless.failure());
    if (*homeless > 0)
        warn("the positions of " + std::to_string(*homeless) + " vertices are not numbers: no triangle names them");
    return out;
}

}  // namespace espalier::import
