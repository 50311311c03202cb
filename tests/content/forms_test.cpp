// Bodies that patterns lie on: closed, outside out, and of the genus that they are said to be of.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "tools/content/forms.hpp"

using namespace espalier::content;

namespace {

using Place = std::tuple<float, float, float>;

struct Topology {
    size_t vertices = 0, edges = 0, triangles = 0;
    size_t openEdges = 0;    // that belong to one triangle
    size_t brokenEdges = 0;  // to more than two, or to two that disagree about their outside
    double volume = 0;       // enclosed, m^3
};

// Vertices at one place are one, and triangles without area none.
Topology topologyOf(const Mesh& mesh) {
    Topology out;
    std::map<std::pair<Place, Place>, int> sides;  // directed edges
    std::set<Place> places;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        std::array<glm::vec3, 3> p;
        std::array<Place, 3> at;
        for (size_t k = 0; k < 3; ++k) {
            p[k] = mesh.positions[mesh.indices[i + k]];
            at[k] = {p[k].x + 0.f, p[k].y + 0.f, p[k].z + 0.f};  // no negative zero
        }
        if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) continue;
        ++out.triangles;
        out.volume += double(glm::dot(p[0], glm::cross(p[1], p[2]))) / 6;
        for (size_t k = 0; k < 3; ++k) places.insert(at[k]), ++sides[{at[k], at[(k + 1) % 3]}];
    }
    out.vertices = places.size();
    for (const auto& [edge, count] : sides) {
        const auto back = sides.find({edge.second, edge.first});
        if (count > 1) ++out.brokenEdges;
        if (back == sides.end()) ++out.openEdges, ++out.edges;
        if (back != sides.end() && edge.first < edge.second) ++out.edges;
    }
    return out;
}

}  // namespace

TEST_CASE("forms are closed and of their genus") {
    const std::map<std::string, int> characteristics{{"cuirass", 2}, {"vase", 2},  {"knot", 0},
                                                     {"pear", 2},    {"torus", 0}, {"tori", -12}};
    size_t seen = 0;
    for (const FormMeshes::Entry& form : makeForms().all) {
        CAPTURE(form.name);
        const Topology t = topologyOf(form.mesh);
        CHECK(t.brokenEdges == 0);
        const int characteristic = int(t.vertices) - int(t.edges) + int(t.triangles);
        if (form.name == "plane") {
            CHECK(characteristic == 1);
            CHECK(t.openEdges == 4 * 32);
            continue;
        }
        REQUIRE(characteristics.count(form.name));
        ++seen;
        CHECK(t.openEdges == 0);
        CHECK(characteristic == characteristics.at(form.name));
        CHECK(t.volume > 0.05);
        const auto lowest = std::ranges::min_element(form.mesh.positions, {}, &glm::vec3::y);
        CHECK(std::abs(lowest->y) < 0.05f);
    }
    CHECK(seen == characteristics.size());
}

TEST_CASE("normals of the three tori point out of their tubes") {
    const Mesh tori = makeLinkedTori();
    REQUIRE(tori.normals.size() == tori.positions.size());
    const float middle = 0.62f + 0.15f + 0.0225f;
    size_t inward = 0;
    for (size_t i = 0; i < tori.positions.size(); ++i) {
        // The nearest of the three circles' points.
        const glm::vec3 p = tori.positions[i] - glm::vec3(0, middle, 0);
        float nearest = 1e9f;
        glm::vec3 from(0);
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 flat = p;
            flat[axis] = 0;
            flat *= 0.62f / glm::length(flat);
            if (glm::distance(p, flat) < nearest) nearest = glm::distance(p, flat), from = p - flat;
        }
        CHECK(nearest < 0.24f);
        inward += glm::dot(from, tori.normals[i]) <= 0 ? 1u : 0u;
    }
    CHECK(inward == 0);
}
