// Coverings leave no gap and no course cuts through the next; what stands on houses fills its box the right way out.

#include <doctest/doctest.h>
#include <map>

#include "shaders/emit/emit_records.h"
#include "tools/content/roof_mesh.hpp"

using namespace espalier::content;

namespace {

const Mesh& meshNamed(const RoofMeshes& all, const std::string& name) {
    for (const RoofMeshes::Entry& e : all.all)
        if (e.name == name) return e.mesh;
    FAIL("there is no mesh " << name);
    return all.all.front().mesh;
}

// Heights at which a plumb line at `p` meets the mesh moved by `by`: the highest, or -1.
float highest(const Mesh& mesh, glm::vec2 by, glm::vec2 p) {
    float best = -1;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        glm::vec3 v[3];
        for (size_t k = 0; k < 3; ++k) v[k] = mesh.positions[mesh.indices[i + k]] + glm::vec3(by, 0);
        auto area = [](glm::vec2 a, glm::vec2 b, glm::vec2 c) {
            return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        };
        const float whole = area(v[0], v[1], v[2]);
        if (std::abs(whole) < 1e-9f) continue;
        const float a = area(p, v[1], v[2]) / whole, b = area(v[0], p, v[2]) / whole, c = 1 - a - b;
        if (a < -1e-5f || b < -1e-5f || c < -1e-5f) continue;
        best = std::max(best, a * v[0].z + b * v[1].z + c * v[2].z);
    }
    return best;
}

}  // namespace

TEST_CASE("coverings leave no gap, laid straight or in bond") {
    const RoofMeshes all = makeRoofMeshes();
    for (auto [name, bond] : std::map<std::string, bool>{
             {"slate", true}, {"plain", true}, {"pan", false}, {"barrel", false}, {"seam", false}})
        for (const char* lod : {"_lod0", "_lod1"}) {
            const Mesh& mesh = meshNamed(all, name + lod);
            int open = 0;
            for (int y = 0; y < 20; ++y)
                for (int x = 0; x < 40; ++x) {
                    const glm::vec2 p((float(x) + 0.5f) / 40, (float(y) + 0.5f) / 20);
                    float top = -1;
                    for (int row = -1; row <= 1; ++row)
                        for (int column = -1; column <= 2; ++column)
                            top = std::max(
                                top, highest(mesh, {float(column) - (bond && row != 0 ? 0.5f : 0.0f), float(row)}, p));
                    open += top < 0 ? 1 : 0;
                }
            CAPTURE(name);
            CAPTURE(lod);
            // Slates have gaps between them of a few millimetres.
            CHECK(open <= (name == "slate" ? 48 : name == "plain" ? 4 : 0));
        }
}

TEST_CASE("caps are closed at both ends: their neighbours may have faded into a pattern") {
    const RoofMeshes all = makeRoofMeshes();
    for (const char* name : {"ridge_lod0", "ridge_lod1"}) {
        CAPTURE(name);
        const Mesh& cap = meshNamed(all, name);
        double ends[2] = {0, 0};  // areas that face along the joint
        for (size_t i = 0; i < cap.indices.size(); i += 3) {
            glm::vec3 p[3];
            for (size_t k = 0; k < 3; ++k) p[k] = cap.positions[cap.indices[i + k]];
            if (p[0].x != p[1].x || p[1].x != p[2].x) continue;
            const float along = 0.5f * glm::cross(p[1] - p[0], p[2] - p[0]).x;
            ends[along > 0] += std::abs(along);
        }
        CHECK(ends[0] > 0.4);
        CHECK(ends[1] > 0.4);
    }
}

TEST_CASE("the next course lies on the head of the one below") {
    const RoofMeshes all = makeRoofMeshes();
    for (const char* name : {"plain", "pan", "barrel"}) {
        const Mesh& mesh = meshNamed(all, std::string(name) + "_lod0");
        for (int i = 0; i < 40; ++i) {
            const glm::vec2 p((float(i) + 0.5f) / 40, 1.04f);
            const float below = highest(mesh, {0, 0}, p), above = highest(mesh, {0, 1}, p);
            CAPTURE(name);
            CAPTURE(i);
            if (above >= 0 && below >= 0) CHECK(above > below + 0.008f);
        }
    }
}

TEST_CASE("meshes are sound and no more than the drawing has room for") {
    const RoofMeshes all = makeRoofMeshes();
    std::map<std::string, int> kinds;
    for (const RoofMeshes::Entry& e : all.all) {
        CAPTURE(e.name);
        kinds[e.name.substr(0, e.name.find('_'))] += 1;
        REQUIRE(e.mesh.positions.size() == e.mesh.normals.size());
        REQUIRE(e.mesh.positions.size() == e.mesh.uvs.size());
        size_t turned = 0;
        for (size_t i = 0; i < e.mesh.indices.size(); i += 3) {
            glm::vec3 p[3], n(0);
            for (size_t k = 0; k < 3; ++k) {
                REQUIRE(e.mesh.indices[i + k] < e.mesh.positions.size());
                p[k] = e.mesh.positions[e.mesh.indices[i + k]];
                n += e.mesh.normals[e.mesh.indices[i + k]];
            }
            turned += glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), n) < -1e-9f ? 1 : 0;
        }
        CHECK(turned == 0);
        for (size_t i = 0; i < e.mesh.normals.size(); ++i) {
            CHECK(std::abs(glm::length(e.mesh.normals[i]) - 1) < 1e-3f);
            CHECK(e.mesh.uvs[i].x > 0);
        }
    }
    CHECK(kinds.size() < espalier::kMaxTerminalKinds);  // bark is one of them
    CHECK(all.all.size() <= espalier::kMaxBuckets);
}
