// In: the welded mesh. Out: the model with triangles turned. Triangles that run along one edge the same way disagree;
// a union-find that carries parity gathers pieces and which of their triangles are against the rest.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "tools/bake/repair.hpp"

namespace espalier::bakery {
namespace {

constexpr double kAgainst = -0.5;  // of a piece's area: normals that say so are against its winding

// Sets whose members are alike (parity 0) or opposed (1) to their root.
class ParitySets {
  public:
    explicit ParitySets(size_t n) : parent_(n), parity_(n, 0) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::pair<uint32_t, uint8_t> find(uint32_t i) {
        uint8_t p = 0;
        uint32_t root = i;
        while (parent_[root] != root) p ^= parity_[root], root = parent_[root];
        for (uint8_t q = p; parent_[i] != root && i != root;) {
            uint32_t next = parent_[i];
            uint8_t step = parity_[i];
            parent_[i] = root, parity_[i] = q;
            q ^= step, i = next;
        }
        return {root, p};
    }
    // False: the two are in one set already, the other way.
    bool join(uint32_t a, uint32_t b, uint8_t opposed) {
        auto [ra, pa] = find(a);
        auto [rb, pb] = find(b);
        uint8_t parity = pa ^ pb ^ opposed;
        if (ra == rb) return parity == 0;
        parent_[std::max(ra, rb)] = std::min(ra, rb);
        parity_[std::max(ra, rb)] = parity;
        return true;
    }

  private:
    std::vector<uint32_t> parent_;
    std::vector<uint8_t> parity_;
};

// Pairs of border half-edges that run the same way along an edge which no others share.
std::vector<std::pair<uint32_t, uint32_t>> unlikePairs(const BakeMesh& mesh) {
    struct Half {
        uint64_t key;
        uint32_t half;
    };
    std::vector<Half> halves;
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (mesh.twin[h] == kNone) {
            uint64_t a = mesh.triangles[h / 3].point[h % 3], b = mesh.triangles[h / 3].point[(h + 1) % 3];
            halves.push_back({a << 32 | b, h});
        }
    std::sort(halves.begin(), halves.end(),
              [](const Half& x, const Half& y) { return std::tie(x.key, x.half) < std::tie(y.key, y.half); });
    std::vector<std::pair<uint32_t, uint32_t>> pairs;
    for (size_t i = 0; i < halves.size();) {
        size_t j = i + 1;
        while (j < halves.size() && halves[j].key == halves[i].key) ++j;
        if (j - i == 2) pairs.emplace_back(halves[i].half, halves[i + 1].half);
        i = j;
    }
    return pairs;
}

// How the model's own normals judge a triangle's winding: 1 agree, -1 oppose; 1 where there are none.
double agreement(const Model& model, uint32_t source, glm::dvec3 normal) {
    if (model.normals.empty()) return 1;
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) {
        glm::dvec3 n(model.normals[model.indices[size_t(source) * 3 + k]]);
        double d = glm::dot(n, normal);
        if (std::isfinite(d)) sum += d > 0 ? 1 : d < 0 ? -1 : 0;
    }
    return sum / 3;
}

// Whether the model's own normals say that a triangle is right as it is. It isn't turned then, whatever is around it:
// a floor that ends at the walls of a tower without an inside runs along its edges as they do, and both are right.
bool isRight(const Model& model, const BakeMesh& mesh, uint32_t t) {
    if (model.normals.empty()) return false;
    const auto& p = mesh.triangles[t].point;
    const glm::dvec3 a = mesh.points[p[0]], n = glm::cross(mesh.points[p[1]] - a, mesh.points[p[2]] - a);
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) {
        const double d = glm::dot(glm::dvec3(model.normals[vertexAt(model, mesh.triangles[t], k)]), n);
        if (std::isfinite(d)) sum += d;
    }
    return sum > 0;
}

Model turned(const Model& model, const std::vector<uint32_t>& triangles) {
    Model out = model;
    for (uint32_t t : triangles) {
        uint32_t* v = &out.indices[size_t(t) * 3];
        std::swap(v[1], v[2]);
        if (out.normals.empty()) continue;
        glm::vec3 n = glm::cross(out.positions[v[1]] - out.positions[v[0]], out.positions[v[2]] - out.positions[v[0]]);
        for (int k = 0; k < 3; ++k) {
            if (!(glm::dot(out.normals[v[k]], n) < 0)) continue;
            // Others may share the vertex as it is.
            uint32_t from = v[k];
            v[k] = uint32_t(out.positions.size());
            out.positions.push_back(glm::vec3(out.positions[from]));
            out.normals.push_back(-glm::vec3(out.normals[from]));
            if (!out.uvs.empty()) out.uvs.push_back(glm::vec2(out.uvs[from]));
            if (!out.colours.empty()) out.colours.push_back(glm::vec4(out.colours[from]));
            if (!out.materialUvs.empty()) out.materialUvs.push_back(glm::vec2(out.materialUvs[from]));
            if (!out.otherUvs.empty()) out.otherUvs.push_back(glm::vec2(out.otherUvs[from]));
        }
    }
    return out;
}

}  // namespace

std::optional<Model> repairOrientation(const Model& model, const BakeMesh& mesh, std::vector<Diagnostic>& warnings) {
    size_t count = mesh.triangles.size(), twisted = 0;
    ParitySets sets(count);
    std::vector<uint8_t> paired(mesh.twin.size(), 0);
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (mesh.twin[h] != kNone) {
            sets.join(h / 3, mesh.twin[h] / 3, 0);
            paired[h] = 1;
        }
    std::vector<uint8_t> right(count);
    for (uint32_t t = 0; t < count; ++t) right[t] = isRight(model, mesh, t);
    for (auto [a, b] : unlikePairs(mesh)) {
        paired[a] = paired[b] = 1;
        if (!right[a / 3] || !right[b / 3]) twisted += !sets.join(a / 3, b / 3, 1);
    }

    struct Piece {
        double vote = 0, area = 0, volume = 0;  // of its triangles, those of parity 1 counted as turned
        bool closed = true, mixed = false;
    };
    std::vector<Piece> pieces(count);
    for (uint32_t t = 0; t < count; ++t) {
        auto [root, parity] = sets.find(t);
        Piece& piece = pieces[root];
        const auto& p = mesh.triangles[t].point;
        glm::dvec3 a = mesh.points[p[0]], n = glm::cross(mesh.points[p[1]] - a, mesh.points[p[2]] - a);
        double sign = parity ? -1 : 1, area = glm::length(n) / 2;
        piece.area += area;
        piece.mixed = piece.mixed || parity;
        piece.vote += sign * area * agreement(model, mesh.triangles[t].source, n);
        piece.volume += sign * glm::dot(a - mesh.points[0], n) / 6;
        for (int k = 0; k < 3; ++k) piece.closed = piece.closed && paired[t * 3 + uint32_t(k)];
    }
    std::vector<uint32_t> turn;
    double area = 0;
    for (uint32_t t = 0; t < count; ++t) {
        auto [root, parity] = sets.find(t);
        const Piece& piece = pieces[root];
        bool whole = piece.vote < (piece.mixed ? 0 : kAgainst * piece.area);
        if (model.normals.empty() && piece.closed && std::abs(piece.volume) > 1e-9 * std::pow(piece.area, 1.5))
            whole = piece.volume < 0;
        if ((parity != 0) == whole || right[t]) continue;
        turn.push_back(mesh.triangles[t].source);
        area += area3(mesh, mesh.triangles[t]);
    }
    auto warn = [&](std::string text) { warnings.push_back({model.name, 0, 0, {}, std::move(text), true}); };
    if (twisted > 0)
        warn(std::to_string(twisted) + " edges where a piece can't agree which side is out, as on a Möbius strip");
    if (turn.empty()) return std::nullopt;
    char share[32];
    std::snprintf(share, sizeof share, "%.3g %%", area / mesh.area * 100);
    warn(std::to_string(turn.size()) + " triangles faced the wrong way and were turned, " + share + " of the area");
    return turned(model, turn);
}

}  // namespace espalier::bakery
