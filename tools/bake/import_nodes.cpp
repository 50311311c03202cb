// In: nodes. Out: their transforms, with those of their parents and of their instances.
#include <cmath>

#include "tools/bake/import_gltf.hpp"

namespace espalier::import {
namespace {

// Translation, rotation (a quaternion x, y, z, w) and scale as glTF composes them.
glm::dmat4 compose(const glm::dvec3& t, const glm::dvec4& q, const glm::dvec3& s) {
    double x = q.x, y = q.y, z = q.z, w = q.w;
    glm::dmat4 m(1);
    m[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0};
    m[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0};
    m[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0};
    for (int i = 0; i < 3; ++i) m[i] *= s[i];
    m[3] = glm::dvec4(t, 1);
    return m;
}

}  // namespace

glm::dmat4 localTransform(const tinygltf::Node& node) {
    if (node.matrix.size() == 16) {
        glm::dmat4 m;
        for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[size_t(i)];
        return m;
    }
    glm::dvec3 t(0), s(1);
    glm::dvec4 q(0, 0, 0, 1);
    if (node.translation.size() == 3) t = {node.translation[0], node.translation[1], node.translation[2]};
    if (node.scale.size() == 3) s = {node.scale[0], node.scale[1], node.scale[2]};
    if (node.rotation.size() == 4) q = {node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]};
    return compose(t, q, s);
}

bool isFinite(const glm::dmat4& m) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r])) return false;
    return true;
}

std::vector<glm::dmat4> worldTransforms(const Document& document) {
    const auto& nodes = document.gltf.nodes;
    std::vector<int> parent(nodes.size(), -1);
    for (size_t i = 0; i < nodes.size(); ++i)
        for (int child : nodes[i].children)
            if (child >= 0 && size_t(child) < nodes.size()) parent[size_t(child)] = int(i);
    std::vector<glm::dmat4> worlds(nodes.size(), glm::dmat4(1));
    std::vector<uint8_t> known(nodes.size(), 0);
    std::vector<size_t> chain;
    for (size_t i = 0; i < nodes.size(); ++i) {
        // Up to what is known, or around a ring of parents once: documents with a ring are refused elsewhere.
        chain.clear();
        int at = int(i);
        for (; at >= 0 && known[size_t(at)] == 0; at = parent[size_t(at)])
            chain.push_back(size_t(at)), known[size_t(at)] = 1;
        glm::dmat4 above = at >= 0 ? worlds[size_t(at)] : glm::dmat4(1);
        for (size_t k = chain.size(); k-- > 0;) above = worlds[chain[k]] = above * localTransform(nodes[chain[k]]);
    }
    return worlds;
}

Result<std::vector<glm::dmat4>> readInstances(const Document& document, const tinygltf::Node& node,
                                              const std::string& where) {
    auto it = node.extensions.find("EXT_mesh_gpu_instancing");
    if (it == node.extensions.end()) return std::vector<glm::dmat4>{glm::dmat4(1)};
    std::string place = where + ".EXT_mesh_gpu_instancing";
    if (!it->second.IsObject() || !it->second.Get("attributes").IsObject())
        return Failure(document.path, place + ": no attributes");
    const tinygltf::Value& attributes = it->second.Get("attributes");
    std::vector<float> values[3];
    const char* names[3] = {"TRANSLATION", "ROTATION", "SCALE"};
    size_t count = 0;
    for (int i = 0; i < 3; ++i) {
        if (!attributes.Get(names[i]).IsInt()) continue;
        int components = i == 1 ? 4 : 3;
        auto read = readFloats(document, attributes.Get(names[i]).Get<int>(), components, names[i]);
        if (!read) return std::move(read.failure());
        size_t here = read->size() / size_t(components);
        if (count != 0 && here != count)
            return Failure(document.path, place + ": " + names[i] + " has " + std::to_string(here) + " instances of " +
                                              std::to_string(count));
        count = here;
        values[i] = std::move(*read);
    }
    if (count == 0) return Failure(document.path, place + ": no TRANSLATION, ROTATION or SCALE");
    if (!document.intake->take(count * sizeof(glm::dmat4)))
        return Failure(document.path, place + ": absurdly many instances");
    std::vector<glm::dmat4> out(count);
    for (size_t i = 0; i < count; ++i) {
        glm::dvec3 t(0), s(1);
        glm::dvec4 q(0, 0, 0, 1);
        for (int k = 0; k < 3 && !values[0].empty(); ++k) t[k] = double(values[0][i * 3 + size_t(k)]);
        for (int k = 0; k < 4 && !values[1].empty(); ++k) q[k] = double(values[1][i * 4 + size_t(k)]);
        for (int k = 0; k < 3 && !values[2].empty(); ++k) s[k] = double(values[2][i * 3 + size_t(k)]);
        out[i] = compose(t, q, s);
        if (!isFinite(out[i]))
            return Failure(document.path, place + ": instance " + std::to_string(i) + " is not a number");
    }
    return out;
}

}  // namespace espalier::import
