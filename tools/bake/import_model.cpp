// In: a glTF file. Out: one triangle list with all nodes' transforms applied, materials and images.
#include <cmath>
#include <limits>

#include "tools/bake/bake.hpp"
#include "tools/bake/import.hpp"

namespace espalier {
namespace {

using namespace import;

constexpr size_t kMaxVertices = size_t(1) << 26;
constexpr int kMaxNodeDepth = 512;

class Importer {
  public:
    Importer(const Document& document, int uvSet, Model& model)
        : document_(document), uvSet_(uvSet == 1 ? 1 : 0), model_(model) {}

    Status run() {
        readMaterials(document_, model_.materials, materialUvs_, model_.images, model_.warnings);
        visited_.assign(document_.gltf.nodes.size(), false);
        for (int node : roots()) {
            Status done = visit(node, glm::dmat4(1), 0);
            if (!done) return done;
        }
        if (skipped_ > 0) warn(std::to_string(skipped_) + " primitives of points or lines left out");
        if (model_.indices.empty()) return Failure(document_.path, "the file holds no triangles");
        if (!anyUvs_) model_.uvs.clear();
        if (!anyUvs_) model_.materialUvs.clear();
        if (!allNormals_) model_.normals.clear();
        return Done{};
    }

  private:
    void warn(std::string text) { model_.warnings.push_back({document_.path, 0, 0, {}, std::move(text), true}); }

    std::vector<int> roots() const {
        const auto& gltf = document_.gltf;
        if (!gltf.scenes.empty()) {
            size_t scene = gltf.defaultScene >= 0 ? size_t(gltf.defaultScene) : 0;
            if (scene < gltf.scenes.size()) return gltf.scenes[scene].nodes;
        }
        std::vector<bool> child(gltf.nodes.size(), false);
        for (const auto& node : gltf.nodes)
            for (int c : node.children)
                if (c >= 0 && size_t(c) < child.size()) child[size_t(c)] = true;
        std::vector<int> out;
        for (size_t i = 0; i < child.size(); ++i)
            if (!child[i]) out.push_back(int(i));
        return out;
    }

    static glm::dmat4 localTransform(const tinygltf::Node& node) {
        glm::dmat4 m(1);
        if (node.matrix.size() == 16) {
            for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[size_t(i)];
            return m;
        }
        if (node.rotation.size() == 4) {
            double x = node.rotation[0], y = node.rotation[1], z = node.rotation[2], w = node.rotation[3];
            m[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0};
            m[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0};
            m[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0};
        }
        if (node.scale.size() == 3)
            for (int i = 0; i < 3; ++i) m[i] *= node.scale[size_t(i)];
        if (node.translation.size() == 3)
            for (int i = 0; i < 3; ++i) m[3][i] = node.translation[size_t(i)];
        return m;
    }

    Status visit(int index, const glm::dmat4& parent, int depth) {
        std::string place = "nodes[" + std::to_string(index) + "]";
        if (index < 0 || size_t(index) >= visited_.size()) return Failure(document_.path, place + " does not exist");
        if (visited_[size_t(index)])
            return Failure(document_.path, place + " is reached twice: nodes must form a tree");
        if (depth > kMaxNodeDepth) return Failure(document_.path, place + ": nodes are nested too deeply");
        visited_[size_t(index)] = true;
        const auto& node = document_.gltf.nodes[size_t(index)];
        glm::dmat4 world = parent * localTransform(node);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r)
                if (!std::isfinite(world[c][r]))
                    return Failure(document_.path, place + ": its transform is not a number");
        if (node.extensions.count("EXT_mesh_gpu_instancing"))
            warn(place + ": EXT_mesh_gpu_instancing is not read, one instance is");
        if (node.mesh >= 0) {
            if (size_t(node.mesh) >= document_.gltf.meshes.size())
                return Failure(document_.path, place + ": mesh " + std::to_string(node.mesh) + " does not exist");
            const auto& primitives = document_.gltf.meshes[size_t(node.mesh)].primitives;
            for (size_t i = 0; i < primitives.size(); ++i) {
                Status done = add(primitives[i], world,
                                  "meshes[" + std::to_string(node.mesh) + "].primitives[" + std::to_string(i) + "]");
                if (!done) return done;
            }
        }
        for (int child : node.children) {
            Status done = visit(child, world, depth + 1);
            if (!done) return done;
        }
        return Done{};
    }

    Status add(const tinygltf::Primitive& from, const glm::dmat4& world, const std::string& place) {
        bool packed = from.extensions.count("KHR_draco_mesh_compression") != 0;
        int mode = from.mode < 0 ? TINYGLTF_MODE_TRIANGLES : from.mode;
        if (!packed && mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
            mode != TINYGLTF_MODE_TRIANGLE_FAN) {
            ++skipped_;
            return Done{};
        }
        auto read = readPrimitive(document_, from, place);
        if (!read) return std::move(read.failure());
        size_t count = read->positions.size() / 3, first = model_.positions.size();
        if (first + count > kMaxVertices) return Failure(document_.path, "more than 67 million vertices");
        size_t material = from.material >= 0 ? size_t(from.material) : 0;
        if (material >= model_.materials.size()) {
            warn(place + ": material " + std::to_string(from.material) + " does not exist");
            material = 0;
        }
        appendVertices(*read, world, materialUvs_[material]);
        bool mirrored = glm::determinant(glm::dmat3(world)) < 0;
        for (size_t i = 0; i + 2 < read->indices.size(); i += 3) {
            uint32_t a = read->indices[i], b = read->indices[i + 1], c = read->indices[i + 2];
            if (mirrored) std::swap(b, c);
            for (uint32_t v : {a, b, c}) model_.indices.push_back(uint32_t(first) + v);
            model_.triangleMaterial.push_back(uint32_t(material));
        }
        return Done{};
    }

    void appendVertices(const Primitive& from, const glm::dmat4& world, const MaterialUv& transform) {
        glm::dmat3 linear(world);
        // The cofactor matrix carries normals over singular and mirroring transforms alike.
        glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                            glm::cross(linear[0], linear[1]));
        if (glm::determinant(linear) < 0) cofactor = -cofactor;
        const auto& drawn = from.uvs[transform.texCoord == 1 && !from.uvs[1].empty() ? 1 : 0];
        const auto& walk = from.uvs[uvSet_];
        size_t count = from.positions.size() / 3;
        for (size_t i = 0; i < count; ++i) {
            glm::dvec3 p(from.positions[i * 3], from.positions[i * 3 + 1], from.positions[i * 3 + 2]);
            model_.positions.push_back(glm::vec3(world * glm::dvec4(p, 1)));
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
        if (!walk.empty()) anyUvs_ = true;
        if (from.normals.empty()) allNormals_ = false;
    }

    const Document& document_;
    const size_t uvSet_;
    Model& model_;
    std::vector<MaterialUv> materialUvs_;
    std::vector<bool> visited_;
    size_t skipped_ = 0;
    bool anyUvs_ = false, allNormals_ = true;
};

}  // namespace

Result<Model> importModel(const std::string& path, int uvSet) {
    try {
        auto document = openDocument(path);
        if (!document) return std::move(document.failure());
        Model model;
        model.name = path;
        Status done = Importer(*document, uvSet, model).run();
        if (!done) return std::move(done.failure());
        return model;
    } catch (const std::bad_alloc&) {
        return Failure(path, "states sizes that do not fit into memory");
    } catch (const std::exception& e) {  // from the JSON library, on types that no check of ours foresaw
        return Failure(path, std::string("not glTF 2.0: ") + e.what());
    }
}

}  // namespace espalier
