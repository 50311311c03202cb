// In: a glTF file. Out: one triangle list with all nodes' transforms, instances, skins and morph targets applied,
// materials and images.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "tools/bake/import_gltf.hpp"

namespace espalier::import {
namespace {

constexpr int kMaxNodeDepth = 512;

// Carries normals over singular and mirroring transforms alike.
glm::dmat3 normalMatrix(const glm::dmat3& linear) {
    glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                        glm::cross(linear[0], linear[1]));
    return glm::determinant(linear) < 0 ? -cofactor : cofactor;
}

// KHR_node_visibility hides a node with all that hangs below it.
bool isHidden(const tinygltf::Node& node) {
    auto it = node.extensions.find("KHR_node_visibility");
    return it != node.extensions.end() && it->second.IsObject() && it->second.Get("visible").IsBool() &&
           !it->second.Get("visible").Get<bool>();
}

std::string counted(size_t count, const char* one, const char* many) {
    return std::to_string(count) + (count == 1 ? one : many);
}

class Importer {
  public:
    Importer(const Document& document, const ImportOptions& options, Model& model)
        : document_(document), options_(options), model_(model) {}

    Status run() {
        const auto& gltf = document_.gltf;
        for (const std::string& remark : document_.remarks) warn(remark);
        if (options_.scene >= 0 && size_t(options_.scene) >= gltf.scenes.size())
            return Failure(document_.path, "scene " + std::to_string(options_.scene) +
                                               " does not exist: the file has " + std::to_string(gltf.scenes.size()));
        readMaterials(document_, model_, materialUvs_);
        visited_.assign(gltf.nodes.size(), false);
        placed_.assign(gltf.meshes.size(), 0);
        countUses();
        for (int node : roots()) {
            Status done = visit(node, glm::dmat4(1), 0);
            if (!done) return done;
        }
        if (gltf.nodes.empty() && !gltf.meshes.empty()) {
            warn("no node places the file's meshes: each is taken where it was made");
            for (int mesh = 0; size_t(mesh) < gltf.meshes.size(); ++mesh) {
                Status done = place(mesh, {}, gltf.meshes[size_t(mesh)].weights);
                if (!done) return done;
            }
        }
        tell();
        if (model_.indices.empty()) return Failure(document_.path, "the file holds no triangles" + whyNone());
        settle(places_, model_.indices, options_.origin, model_);
        model_.colours.resize(anyColours_ ? places_.size() : 0, glm::vec4(1));
        blendByColours();
        if (!anyUvs_) model_.uvs.clear();
        if (!anyUvs_) model_.materialUvs.clear();
        if (!anyOtherUvs_) model_.otherUvs.clear();
        if (!allNormals_) model_.normals.clear();
        return Done{};
    }

  private:
    void warn(std::string text) { model_.warnings.push_back({document_.path, 0, 0, {}, std::move(text), true}); }

    // What a user may wonder about afterwards.
    void tell() {
        if (skipped_ > 0) warn(std::to_string(skipped_) + " primitives of points or lines left out");
        if (placeless_ > 0) warn(std::to_string(placeless_) + " primitives without POSITION left out");
        if (empty_ > 0) warn(counted(empty_, " primitive has", " primitives have") + " no triangles: left out");
        if (hidden_ > 0)
            warn(counted(hidden_, " node is", " nodes are") +
                 " hidden by KHR_node_visibility: left out with all that hangs below");
        if (document_.gltf.scenes.size() > 1)
            warn("scene " + std::to_string(scene()) + " of the file's " + std::to_string(document_.gltf.scenes.size()) +
                 " is read");
        size_t meshes = 0, places = 0;
        for (size_t n : placed_) meshes += n > 1, places += n > 1 ? n : 0;
        if (meshes > 0)
            warn(std::to_string(meshes) + (meshes == 1 ? " mesh is" : " meshes are") + " placed " +
                 std::to_string(places) + " times: merged into one surface");
    }

    std::string whyNone() const {
        const auto& gltf = document_.gltf;
        if (gltf.meshes.empty()) return ": it has no meshes";
        if (placeless_ > 0) return ": its primitives have no POSITION";
        if (skipped_ > 0) return ": its primitives are points or lines";
        for (size_t n : placed_)
            if (n > 0) return ": its meshes are empty";
        return hidden_ > 0 ? ": all of its meshes are hidden" : ": its scene places no mesh";
    }

    int scene() const {
        if (options_.scene >= 0) return options_.scene;
        int standard = document_.gltf.defaultScene;
        return standard >= 0 && size_t(standard) < document_.gltf.scenes.size() ? standard : 0;
    }

    std::vector<int> roots() const {
        const auto& gltf = document_.gltf;
        if (!gltf.scenes.empty()) return gltf.scenes[size_t(scene())].nodes;
        std::vector<bool> child(gltf.nodes.size(), false);
        for (const auto& node : gltf.nodes)
            for (int c : node.children)
                if (c >= 0 && size_t(c) < child.size()) child[size_t(c)] = true;
        std::vector<int> out;
        for (size_t i = 0; i < child.size(); ++i)
            if (!child[i]) out.push_back(int(i));
        return out;
    }

    void countUses() {
        uses_.assign(document_.gltf.meshes.size(), 0);
        for (const auto& node : document_.gltf.nodes)
            if (node.mesh >= 0 && size_t(node.mesh) < uses_.size())
                uses_[size_t(node.mesh)] += 1 + node.extensions.count("EXT_mesh_gpu_instancing");
    }

    Status visit(int index, const glm::dmat4& parent, int depth) {
        std::string where = "nodes[" + std::to_string(index) + "]";
        if (index < 0 || size_t(index) >= visited_.size()) return Failure(document_.path, where + " does not exist");
        if (visited_[size_t(index)])
            return Failure(document_.path, where + " is reached twice: nodes must form a tree");
        if (depth > kMaxNodeDepth) return Failure(document_.path, where + ": nodes are nested too deeply");
        visited_[size_t(index)] = true;
        const auto& node = document_.gltf.nodes[size_t(index)];
        if (isHidden(node)) {
            ++hidden_;
            return Done{};
        }
        glm::dmat4 world = parent * localTransform(node);
        if (!isFinite(world)) return Failure(document_.path, where + ": its transform is not a number");
        if (node.mesh >= 0) {
            Status done = placeNode(node, world, where);
            if (!done) return done;
        }
        for (int child : node.children) {
            Status done = visit(child, world, depth + 1);
            if (!done) return done;
        }
        return Done{};
    }

    Status placeNode(const tinygltf::Node& node, const glm::dmat4& world, const std::string& where) {
        if (size_t(node.mesh) >= document_.gltf.meshes.size())
            return Failure(document_.path, where + ": mesh " + std::to_string(node.mesh) + " does not exist");
        const std::vector<double>& weights =
            node.weights.empty() ? document_.gltf.meshes[size_t(node.mesh)].weights : node.weights;
        if (node.skin >= 0) {
            auto joints = jointsOf(node.skin);
            if (!joints.empty()) {
                if (node.extensions.count("EXT_mesh_gpu_instancing"))
                    warn(where + ": instances of a mesh with a skin are not read: it stands where its joints are");
                return place(node.mesh, {world, std::move(joints)}, weights);
            }
        }
        auto instances = readInstances(document_, node, where);
        if (!instances) return std::move(instances.failure());
        for (const glm::dmat4& instance : *instances) {
            Status done = place(node.mesh, {world * instance, {}}, weights);
            if (!done) return done;
        }
        return Done{};
    }

    // Of a skin that can't be read: none, with a warning.
    std::vector<glm::dmat4> jointsOf(int skin) {
        if (worlds_.empty()) worlds_ = worldTransforms(document_);
        auto joints = readSkin(document_, skin, worlds_);
        if (joints) return std::move(*joints);
        warn("a skin is not applied, its mesh stands where its node is: " +
             joints.failure().diagnostics.front().message);
        return {};
    }

    Status place(int mesh, const Placement& at, const std::vector<double>& weights) {
        ++placed_[size_t(mesh)];
        const auto& primitives = document_.gltf.meshes[size_t(mesh)].primitives;
        for (size_t i = 0; i < primitives.size(); ++i) {
            Status done = add(primitives[i], at, weights, {mesh, i});
            if (!done) return done;
        }
        return Done{};
    }

    using PrimitiveId = std::pair<int, size_t>;                         // mesh, primitive
    using Kept = std::tuple<PrimitiveId, size_t, std::vector<double>>;  // for so many joints, morphed by weights

    Status add(const tinygltf::Primitive& from, const Placement& at, const std::vector<double>& weights,
               PrimitiveId id) {
        std::string where = "meshes[" + std::to_string(id.first) + "].primitives[" + std::to_string(id.second) + "]";
        bool packed = from.extensions.count("KHR_draco_mesh_compression") != 0;
        int mode = from.mode < 0 ? TINYGLTF_MODE_TRIANGLES : from.mode;
        if (!packed && mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
            mode != TINYGLTF_MODE_TRIANGLE_FAN) {
            ++skipped_;
            return Done{};
        }
        if (!from.attributes.count("POSITION")) {
            ++placeless_;
            return Done{};
        }
        size_t material = from.material >= 0 ? size_t(from.material) : 0;
        if (material >= model_.materials.size()) {
            warn(where + ": material " + std::to_string(from.material) + " does not exist");
            material = 0;
        }
        // What is placed once is not kept.
        const Kept key{id, at.joints.size(), weights};
        auto known = kept_.find(key);
        Primitive once;
        if (known == kept_.end()) {
            auto read = readRigged(from, at.joints.size(), weights, uint32_t(material), where);
            if (!read) return std::move(read.failure());
            if (uses_[size_t(id.first)] > 1)
                known = kept_.emplace(key, std::move(*read)).first;
            else
                once = std::move(*read);
        }
        const Primitive& primitive = known == kept_.end() ? once : known->second;
        if (primitive.indices.empty()) {
            ++empty_;
            return Done{};
        }
        return append(primitive, at, uint32_t(material), where);
    }

    Result<Primitive> readRigged(const tinygltf::Primitive& from, size_t joints, const std::vector<double>& weights,
                                 uint32_t material, const std::string& where) {
        const MaterialUv& uv = materialUvs_[material];
        const PrimitiveRequest request{options_.uvSet, uv.texCoord, uv.other,
                                       joints > 0,     weights,     colourComponents(document_, from)};
        auto read = readPrimitive(document_, from, request, where, model_.warnings);
        if (!read || joints == 0 || read->indices.empty()) return read;
        if (read->joints[0].empty()) {
            warn(where + ": its vertices name no joints: it stands where its node is");
        } else if (const size_t mended = mendWeights(*read, joints); mended > 0) {
            warn(where + ": " + counted(mended, " vertex has", " vertices have") +
                 " no usable weights, or names joints that its skin doesn't have");
        }
        return read;
    }

    Status append(const Primitive& from, const Placement& at, uint32_t material, const std::string& where) {
        size_t count = from.positions.size() / 3, first = places_.size();
        if (first + count > kMaxVertices) return Failure(document_.path, "more than 67 million vertices");
        if (!document_.intake->take(count * (from.colours.empty() ? 72 : 88) + from.indices.size() * 6))
            return Failure(document_.path, where +
                                               ": placing it so often takes absurdly much for a file of its size; "
                                               "bake it once and place the surface");
        const Placement by = from.joints[0].empty() ? Placement{at.world, {}} : at;
        const std::vector<double> volumes = appendVertices(from, by, materialUvs_[material]);
        for (size_t i = 0; i + 2 < from.indices.size(); i += 3) {
            uint32_t a = from.indices[i], b = from.indices[i + 1], c = from.indices[i + 2];
            if (volumes[a] + volumes[b] + volumes[c] < 0) std::swap(b, c);  // mirrored
            for (uint32_t v : {a, b, c}) model_.indices.push_back(uint32_t(first) + v);
            model_.triangleMaterial.push_back(material);
        }
        return Done{};
    }

    // Returns of each vertex what becomes of a unit of volume at it.
    std::vector<double> appendVertices(const Primitive& from, const Placement& at, const MaterialUv& transform) {
        // A set that isn't there is the walk's, as files have it whose materials came from elsewhere.
        const auto& walk = from.walkUvs;
        const auto& drawn = from.drawnUvs.empty() ? walk : from.drawnUvs;
        const auto& other = from.otherUvs.empty() ? drawn : from.otherUvs;
        const auto uvAt = [](const std::vector<float>& uvs, size_t i, glm::vec2 none) {
            return uvs.empty() ? none : glm::vec2(uvs[i * 2], uvs[i * 2 + 1]);
        };
        size_t count = from.positions.size() / 3;
        appendColours(from);
        std::vector<double> volumes(count);
        glm::dmat4 matrix(1);
        glm::dmat3 forNormals(1);
        for (size_t i = 0; i < count; ++i) {
            if (i == 0 || !at.joints.empty()) {
                matrix = at.of(from, i);
                forNormals = normalMatrix(glm::dmat3(matrix));
            }
            volumes[i] = glm::determinant(glm::dmat3(matrix));
            glm::dvec3 p(from.positions[i * 3], from.positions[i * 3 + 1], from.positions[i * 3 + 2]);
            places_.push_back(glm::dvec3(matrix * glm::dvec4(p, 1)));
            glm::vec3 n(0);
            if (!from.normals.empty()) {
                glm::dvec3 m =
                    forNormals * glm::dvec3(from.normals[i * 3], from.normals[i * 3 + 1], from.normals[i * 3 + 2]);
                double length = glm::length(m);
                if (length > 0 && std::isfinite(length)) n = glm::vec3(m / length);
            }
            model_.normals.push_back(n);
            model_.uvs.push_back(uvAt(walk, i, glm::vec2(std::numeric_limits<float>::quiet_NaN())));
            glm::vec3 m = drawn.empty() ? glm::vec3(0) : glm::vec3(uvAt(drawn, i, {}), 1);
            model_.materialUvs.push_back({glm::dot(transform.u, m), glm::dot(transform.v, m)});
            model_.otherUvs.push_back(uvAt(other, i, {}));
        }
        if (!walk.empty() || !drawn.empty()) anyUvs_ = true;
        if (transform.other >= 0 && !other.empty()) anyOtherUvs_ = true;
        if (from.normals.empty()) allNormals_ = false;
        return volumes;
    }

    // Colours of vertices may be what lets something be seen through a material.
    void blendByColours() {
        for (size_t i = 0; i < model_.indices.size() && anyColours_; ++i) {
            const uint32_t material = model_.triangleMaterial[i / 3];
            Material& m = model_.materials[material];
            if (m.blended || !(model_.colours[model_.indices[i]].a < 1)) continue;
            const auto& all = document_.gltf.materials;
            if (material < all.size() && all[material].alphaMode == "BLEND") m.bare = m.blended = true;
        }
    }

    // Vertices of primitives without colours are white, as are those whose colours are not numbers.
    void appendColours(const Primitive& from) {
        if (from.colours.empty()) return;
        const size_t count = from.positions.size() / 3, components = from.colours.size() / count;
        model_.colours.resize(places_.size(), glm::vec4(1));
        for (size_t i = 0; i < count; ++i) {
            glm::vec4 colour(1);
            for (size_t k = 0; k < components; ++k) colour[int(k)] = from.colours[i * components + k];
            if (!(glm::dot(colour, colour) < 1e30f)) colour = glm::vec4(1);
            model_.colours.push_back(colour);
            anyColours_ = anyColours_ || colour != glm::vec4(1);
        }
    }

    const Document& document_;
    const ImportOptions& options_;
    Model& model_;
    std::vector<glm::dvec3> places_;  // of vertices
    std::vector<MaterialUv> materialUvs_;
    std::vector<glm::dmat4> worlds_;  // of all nodes, once a skin asks
    std::vector<bool> visited_;
    std::vector<size_t> uses_, placed_;  // by mesh: nodes that name it; places it was put
    std::map<Kept, Primitive> kept_;
    size_t skipped_ = 0, placeless_ = 0, empty_ = 0, hidden_ = 0;
    bool anyUvs_ = false, anyOtherUvs_ = false, anyColours_ = false, allNormals_ = true;
};

}  // namespace

Status importGltf(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model) {
    try {
        auto document = openDocument(path, file, intake);
        if (!document) return std::move(document.failure());
        return Importer(*document, options, model).run();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {  // from the JSON library, on types that no check of ours foresaw
        return Failure(path, std::string("not glTF 2.0: ") + e.what());
    }
}

}  // namespace espalier::import
