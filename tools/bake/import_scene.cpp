// In: a glTF file. Out: one triangle list with all nodes' transforms and instances applied, materials and images.
#include <cmath>
#include <limits>
#include <map>

#include "tools/bake/import.hpp"

namespace espalier::import {
namespace {

constexpr int kMaxNodeDepth = 512;
constexpr int kMaxUvSet = 7;

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

class Importer {
  public:
    Importer(const Document& document, const ImportOptions& options, Model& model)
        : document_(document), options_(options), model_(model) {}

    Status run() {
        const auto& gltf = document_.gltf;
        if (options_.scene >= 0 && size_t(options_.scene) >= gltf.scenes.size())
            return Failure(document_.path, "scene " + std::to_string(options_.scene) +
                                               " does not exist: the file has " + std::to_string(gltf.scenes.size()));
        readMaterials(document_, model_, materialUvs_);
        for (MaterialUv& uv : materialUvs_) {
            if (uv.texCoord >= 0 && uv.texCoord <= kMaxUvSet) continue;
            warn("a material's texCoord " + std::to_string(uv.texCoord) + " is beyond 7: TEXCOORD_0 is taken");
            uv.texCoord = 0;
        }
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
                Status done = place(mesh, glm::dmat4(1));
                if (!done) return done;
            }
        }
        tell();
        if (model_.indices.empty()) return Failure(document_.path, "the file holds no triangles" + whyNone());
        settle(places_, model_.indices, options_.origin, model_);
        model_.colours.resize(anyColours_ ? places_.size() : 0, glm::vec4(1));
        if (!anyUvs_) model_.uvs.clear();
        if (!anyUvs_) model_.materialUvs.clear();
        if (!allNormals_) model_.normals.clear();
        return Done{};
    }

  private:
    void warn(std::string text) { model_.warnings.push_back({document_.path, 0, 0, {}, std::move(text), true}); }

    // What a user may wonder about afterwards.
    void tell() {
        if (skipped_ > 0) warn(std::to_string(skipped_) + " primitives of points or lines left out");
        if (placeless_ > 0) warn(std::to_string(placeless_) + " primitives without POSITION left out");
        if (skinned_) warn("skins are not applied: meshes are taken as they are stored");
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
        return ": its scene places no mesh";
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
        glm::dmat4 world = parent * localTransform(node);
        if (!isFinite(world)) return Failure(document_.path, where + ": its transform is not a number");
        if (node.mesh >= 0) {
            if (size_t(node.mesh) >= document_.gltf.meshes.size())
                return Failure(document_.path, where + ": mesh " + std::to_string(node.mesh) + " does not exist");
            if (node.skin >= 0) skinned_ = true;
            auto instances = readInstances(node, where);
            if (!instances) return std::move(instances.failure());
            for (const glm::dmat4& instance : *instances) {
                Status done = place(node.mesh, world * instance);
                if (!done) return done;
            }
        }
        for (int child : node.children) {
            Status done = visit(child, world, depth + 1);
            if (!done) return done;
        }
        return Done{};
    }

    // The transforms of EXT_mesh_gpu_instancing below a node's own; one that changes nothing without it.
    Result<std::vector<glm::dmat4>> readInstances(const tinygltf::Node& node, const std::string& where) {
        auto it = node.extensions.find("EXT_mesh_gpu_instancing");
        if (it == node.extensions.end()) return std::vector<glm::dmat4>{glm::dmat4(1)};
        std::string place = where + ".EXT_mesh_gpu_instancing";
        if (!it->second.IsObject() || !it->second.Get("attributes").IsObject())
            return Failure(document_.path, place + ": no attributes");
        const tinygltf::Value& attributes = it->second.Get("attributes");
        std::vector<float> values[3];
        const char* names[3] = {"TRANSLATION", "ROTATION", "SCALE"};
        size_t count = 0;
        for (int i = 0; i < 3; ++i) {
            if (!attributes.Get(names[i]).IsInt()) continue;
            int components = i == 1 ? 4 : 3;
            auto read = readFloats(document_, attributes.Get(names[i]).Get<int>(), components, names[i]);
            if (!read) return std::move(read.failure());
            size_t here = read->size() / size_t(components);
            if (count != 0 && here != count)
                return Failure(document_.path, place + ": " + names[i] + " has " + std::to_string(here) +
                                                   " instances of " + std::to_string(count));
            count = here;
            values[i] = std::move(*read);
        }
        if (count == 0) return Failure(document_.path, place + ": no TRANSLATION, ROTATION or SCALE");
        if (!document_.intake->take(count * sizeof(glm::dmat4)))
            return Failure(document_.path, place + ": absurdly many instances");
        std::vector<glm::dmat4> out(count);
        for (size_t i = 0; i < count; ++i) {
            glm::dvec3 t(0), s(1);
            glm::dvec4 q(0, 0, 0, 1);
            for (int k = 0; k < 3 && !values[0].empty(); ++k) t[k] = double(values[0][i * 3 + size_t(k)]);
            for (int k = 0; k < 4 && !values[1].empty(); ++k) q[k] = double(values[1][i * 4 + size_t(k)]);
            for (int k = 0; k < 3 && !values[2].empty(); ++k) s[k] = double(values[2][i * 3 + size_t(k)]);
            out[i] = compose(t, q, s);
            if (!isFinite(out[i]))
                return Failure(document_.path, place + ": instance " + std::to_string(i) + " is not a number");
        }
        return out;
    }

    Status place(int mesh, const glm::dmat4& world) {
        ++placed_[size_t(mesh)];
        const auto& primitives = document_.gltf.meshes[size_t(mesh)].primitives;
        for (size_t i = 0; i < primitives.size(); ++i) {
            Status done = add(primitives[i], world, {mesh, i});
            if (!done) return done;
        }
        return Done{};
    }

    using PrimitiveId = std::pair<int, size_t>;  // mesh, primitive

    Status add(const tinygltf::Primitive& from, const glm::dmat4& world, PrimitiveId id) {
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
        auto known = kept_.find(id);
        Primitive once;
        if (known == kept_.end()) {
            auto read = readPrimitive(
                document_, from, {options_.uvSet, materialUvs_[material].texCoord, colourComponents(document_, from)},
                where);
            if (!read) return std::move(read.failure());
            if (uses_[size_t(id.first)] > 1)
                known = kept_.emplace(id, std::move(*read)).first;
            else
                once = std::move(*read);
        }
        return append(known == kept_.end() ? once : known->second, world, uint32_t(material), where);
    }

    Status append(const Primitive& from, const glm::dmat4& world, uint32_t material, const std::string& where) {
        size_t count = from.positions.size() / 3, first = places_.size();
        if (first + count > kMaxVertices) return Failure(document_.path, "more than 67 million vertices");
        if (!document_.intake->take(count * (from.colours.empty() ? 64 : 80) + from.indices.size() * 6))
            return Failure(document_.path, where +
                                               ": placing it so often takes absurdly much for a file of its size; "
                                               "bake it once and place the surface");
        appendVertices(from, world, materialUvs_[material]);
        bool mirrored = glm::determinant(glm::dmat3(world)) < 0;
        for (size_t i = 0; i + 2 < from.indices.size(); i += 3) {
            uint32_t a = from.indices[i], b = from.indices[i + 1], c = from.indices[i + 2];
            if (mirrored) std::swap(b, c);
            for (uint32_t v : {a, b, c}) model_.indices.push_back(uint32_t(first) + v);
            model_.triangleMaterial.push_back(material);
        }
        return Done{};
    }

    void appendVertices(const Primitive& from, const glm::dmat4& world, const MaterialUv& transform) {
        glm::dmat3 linear(world);
        // The cofactor matrix carries normals over singular and mirroring transforms alike.
        glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                            glm::cross(linear[0], linear[1]));
        if (glm::determinant(linear) < 0) cofactor = -cofactor;
        // A set that isn't there is the walk's, as files have it whose materials came from elsewhere.
        const auto& walk = from.walkUvs;
        const auto& drawn = from.drawnUvs.empty() ? walk : from.drawnUvs;
        size_t count = from.positions.size() / 3;
        appendColours(from);
        for (size_t i = 0; i < count; ++i) {
            glm::dvec3 p(from.positions[i * 3], from.positions[i * 3 + 1], from.positions[i * 3 + 2]);
            places_.push_back(glm::dvec3(world * glm::dvec4(p, 1)));
            glm::vec3 n(0);
            if (!from.normals.empty()) {
                glm::dvec3 m =
                    cofactor * glm::dvec3(from.normals[i * 3], from.normals[i * 3 + 1], from.normals[i * 3 + 2]);
                double length = glm::length(m);
                if (length > 0 && std::isfinite(length)) n = glm::vec3(m / length);
            }
            model_.normals.push_back(n);
            float none = std::numeric_limits<float>::quiet_NaN();
            glm::vec2 uv = walk.empty() ? glm::vec2(none) : glm::vec2(walk[i * 2], walk[i * 2 + 1]);
            glm::vec3 m = drawn.empty() ? glm::vec3(0) : glm::vec3(drawn[i * 2], drawn[i * 2 + 1], 1);
            model_.uvs.push_back(uv);
            model_.materialUvs.push_back({glm::dot(transform.u, m), glm::dot(transform.v, m)});
        }
        if (!walk.empty() || !drawn.empty()) anyUvs_ = true;
        if (from.normals.empty()) allNormals_ = false;
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
    std::vector<bool> visited_;
    std::vector<size_t> uses_, placed_;  // by mesh: nodes that name it; places it was put
    std::map<PrimitiveId, Primitive> kept_;
    size_t skipped_ = 0, placeless_ = 0;
    bool anyUvs_ = false, anyColours_ = false, allNormals_ = true, skinned_ = false;
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
