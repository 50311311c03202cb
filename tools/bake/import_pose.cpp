// In: skins, and the weights of morph targets. Out: how a mesh stands before any animation: morph targets are added to
// its vertices, and joints carry them from where the mesh was bound to where their nodes are now.
#include <algorithm>
#include <cmath>

#include "tools/bake/import_gltf.hpp"

namespace espalier::import {
namespace {

Status addTarget(const Document& document, int accessor, const char* name, double weight, std::vector<float>& to) {
    auto read = readFloats(document, accessor, 3, name);
    if (!read) return std::move(read.failure());
    if (read->size() != to.size())
        return Failure(document.path, std::string("a target's ") + name + " has " + std::to_string(read->size() / 3) +
                                          " elements of " + std::to_string(to.size() / 3));
    for (size_t i = 0; i < to.size(); ++i) to[i] = float(double(to[i]) + weight * double((*read)[i]));
    return Done{};
}

}  // namespace

Status applyMorphs(const Document& document, const tinygltf::Primitive& from, const std::vector<double>& weights,
                   Primitive& out) {
    std::vector<float> positions = out.positions, normals = out.normals;
    for (size_t t = 0; t < from.targets.size() && t < weights.size(); ++t) {
        if (weights[t] == 0) continue;
        for (const auto& [name, accessor] : from.targets[t]) {
            Status added = Done{};
            if (name == "POSITION") added = addTarget(document, accessor, "POSITION", weights[t], positions);
            if (name == "NORMAL" && !normals.empty())
                added = addTarget(document, accessor, "NORMAL", weights[t], normals);
            if (!added) return added;
        }
    }
    out.positions = std::move(positions);
    out.normals = std::move(normals);
    return Done{};
}

Result<std::vector<glm::dmat4>> readSkin(const Document& document, int skin, const std::vector<glm::dmat4>& worlds) {
    const std::string place = "skins[" + std::to_string(skin) + "]";
    if (skin < 0 || size_t(skin) >= document.gltf.skins.size())
        return Failure(document.path, place + " does not exist");
    const tinygltf::Skin& from = document.gltf.skins[size_t(skin)];
    if (from.joints.empty()) return Failure(document.path, place + " has no joints");
    if (!document.intake->take(from.joints.size() * sizeof(glm::dmat4)))
        return Failure(document.path, place + ": absurdly many joints");
    std::vector<float> inverse;
    if (from.inverseBindMatrices >= 0) {
        auto read = readFloats(document, from.inverseBindMatrices, 16, "inverseBindMatrices");
        if (!read) return std::move(read.failure());
        inverse = std::move(*read);
        if (inverse.size() < from.joints.size() * 16)
            return Failure(document.path, place + " has " + std::to_string(from.joints.size()) + " joints and " +
                                              std::to_string(inverse.size() / 16) + " inverse bind matrices");
    }
    std::vector<glm::dmat4> joints;
    for (size_t j = 0; j < from.joints.size(); ++j) {
        const int node = from.joints[j];
        if (node < 0 || size_t(node) >= worlds.size())
            return Failure(document.path, place + ": joint node " + std::to_string(node) + " does not exist");
        glm::dmat4 bind(1);
        for (int i = 0; i < 16 && !inverse.empty(); ++i) bind[i / 4][i % 4] = double(inverse[j * 16 + size_t(i)]);
        joints.push_back(worlds[size_t(node)] * bind);
        if (!isFinite(joints.back()))
            return Failure(document.path, place + ": the transform of joint " + std::to_string(j) + " is not a number");
    }
    return joints;
}

size_t mendWeights(Primitive& primitive, size_t joints) {
    size_t mended = 0;
    const size_t count = primitive.positions.size() / 3;
    for (size_t v = 0; v < count; ++v) {
        double sum = 0;
        bool sound = true;
        for (size_t set = 0; set < kJointSets; ++set) {
            for (size_t k = v * 4; k < v * 4 + 4 && !primitive.joints[set].empty(); ++k) {
                float &weight = primitive.weights[set][k], &joint = primitive.joints[set][k];
                const bool usable = weight >= 0 && std::isfinite(weight) && joint >= 0 && joint < float(joints);
                if (!usable) sound = sound && weight == 0, weight = 0, joint = 0;
                sum += double(weight);
            }
        }
        if (!(sum > 0)) {  // as if all of it hung on its first joint
            sound = false;
            primitive.weights[0][v * 4] = 1;
            sum = 1;
        }
        mended += !sound;
        for (std::vector<float>& weights : primitive.weights)
            for (size_t k = v * 4; k < v * 4 + 4 && !weights.empty(); ++k) weights[k] = float(double(weights[k]) / sum);
    }
    return mended;
}

glm::dmat4 Placement::of(const Primitive& from, size_t vertex) const {
    if (joints.empty()) return world;
    glm::dmat4 blended(0);
    for (size_t set = 0; set < kJointSets; ++set)
        for (size_t k = vertex * 4; k < vertex * 4 + 4 && !from.joints[set].empty(); ++k)
            if (from.weights[set][k] > 0) blended += joints[size_t(from.joints[set][k])] * double(from.weights[set][k]);
    return blended;
}

}  // namespace espalier::import
