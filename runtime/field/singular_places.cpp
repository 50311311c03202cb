#include "runtime/field/singular_places.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <queue>

namespace espalier {
namespace {

constexpr double kMostTurn = 2.1;  // of the N-th power along an edge around a singular vertex; beyond pi it would alias
constexpr size_t kNearVertices = 48;  // among which one that can carry a whole element is looked for

class Placing {
  public:
    Placing(const FieldMesh& mesh, const MeshTopology& topology, uint32_t symmetry)
        : mesh_(mesh), topology_(topology), symmetry_(symmetry), taken_(mesh.positions.size(), false) {
        for (const MeshPiece& piece : topology.pieces) missing_.push_back(int(symmetry) * piece.euler);
    }

    Result<SingularPlaces> run(const std::vector<AskedElement>& elements, const std::function<Field()>& smooth) {
        for (const AskedElement& asked : elements) {
            const int turns = int(std::lround(indexOf(asked.felt->element.kind) * symmetry_));
            if (turns != 0 && !place(asked.felt->centre, turns)) return tooCoarse();
        }
        std::optional<std::vector<Singularity>> found;
        for (uint32_t p = 0; p < topology_.pieces.size(); ++p) {
            if (!topology_.pieces[p].closed || missing_[p] == 0) continue;
            if (!found) found = singularitiesIn(smooth());
            if (!fillUp(p, *found)) return tooCoarse();
        }
        return std::move(out_);
    }

  private:
    static Failure tooCoarse() {
        return Failure("field", "the mesh has too few vertices for the singularities of an exact field");
    }

    // Whether the field can make so many turns around a vertex, if each edge around it does its share.
    bool carries(uint32_t v, int turns) const {
        if (taken_[v] || mesh_.border[v]) return false;
        int edges = 0;
        double turned = 2 * std::numbers::pi * turns;
        uint32_t h = mesh_.first[v];
        do {
            if (taken_[mesh_.to(h)]) return false;  // what two places share can't turn for both
            ++edges;
            turned -= symmetry_ * mesh_.curvature(h / 3);
            h = mesh_.twin[FieldMesh::previous(h)];
        } while (h != mesh_.first[v]);
        return std::abs(turned) <= kMostTurn * edges;
    }
    void take(uint32_t v, int turns) {
        uint32_t h = mesh_.first[v];
        do {
            taken_[mesh_.to(h)] = true;
            h = mesh_.twin[FieldMesh::previous(h)];
        } while (h != mesh_.first[v]);
        taken_[v] = true;
        missing_[topology_.pieceOf[v]] -= turns;
        out_.all.push_back({v, turns});
    }

    // At the nearest vertex that carries all turns; if none is near, some at each of the nearest ones.
    bool place(uint32_t centre, int turns) {
        const std::vector<uint32_t> near = nearest(centre, kNearVertices);
        const auto whole = std::ranges::find_if(near, [&](uint32_t v) { return carries(v, turns); });
        if (whole != near.end()) {
            take(*whole, turns);
            return true;
        }
        for (uint32_t v : nearest(centre, mesh_.positions.size())) {
            int part = turns;
            while (part != 0 && !carries(v, part)) part -= turns > 0 ? 1 : -1;
            if (part == 0) continue;
            take(v, part);
            turns -= part;
            if (turns == 0) return true;
        }
        return false;
    }
    // Vertices of the centre's piece, roughly the nearest first.
    std::vector<uint32_t> nearest(uint32_t centre, size_t most) const {
        const auto away = [&](uint32_t v) { return glm::length(mesh_.positions[v] - mesh_.positions[centre]); };
        using Reached = std::pair<double, uint32_t>;
        std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
        std::vector<bool> seen(mesh_.positions.size(), false);
        const auto reach = [&](uint32_t v) {
            if (!seen[v]) open.emplace(away(v), v);
            seen[v] = true;
        };
        std::vector<uint32_t> all;
        reach(centre);
        while (!open.empty() && all.size() < most) {
            const uint32_t v = open.top().second;
            open.pop();
            all.push_back(v);
            uint32_t h = mesh_.first[v];
            do {
                reach(mesh_.to(h));
                reach(mesh_.from(FieldMesh::previous(h)));
                h = mesh_.twin[FieldMesh::previous(h)];
            } while (h != kNoIndex && h != mesh_.first[v]);
        }
        return all;
    }

    std::vector<Singularity> singularitiesIn(const Field& field) const {
        return field.power.empty() ? std::vector<Singularity>() : singularitiesOf(mesh_, field);
    }

    // What topology still asks for goes where the smooth field turns that way, else anywhere; each as far as can be
    // from all that is there.
    bool fillUp(uint32_t piece, const std::vector<Singularity>& found) {
        const int missing = missing_[piece];
        out_.unasked += std::abs(missing);
        std::vector<uint32_t> wanted;
        for (const Singularity& s : found) {
            const uint32_t v = mesh_.triangles[s.triangle][0];
            if (topology_.pieceOf[v] == piece && (s.turns > 0) == (missing > 0)) wanted.push_back(v);
        }
        if (wanted.size() < size_t(std::abs(missing))) wanted = topology_.pieces[piece].vertices;
        std::vector<double> away(wanted.size(), 1e300);
        const auto note = [&](const SingularPlace& place) {
            if (topology_.pieceOf[place.vertex] != piece) return;
            for (size_t i = 0; i < wanted.size(); ++i)
                away[i] = std::min(away[i], glm::length(mesh_.positions[wanted[i]] - mesh_.positions[place.vertex]));
        };
        for (const SingularPlace& place : out_.all) note(place);
        for (int i = 0; i < std::abs(missing); ++i) {
            const size_t best = size_t(std::ranges::max_element(away) - away.begin());
            if (!place(wanted[best], missing > 0 ? 1 : -1)) return false;
            note(out_.all.back());
            away[best] = 0;
        }
        return true;
    }

    const FieldMesh& mesh_;
    const MeshTopology& topology_;
    const uint32_t symmetry_;
    std::vector<bool> taken_;   // [vertex]: a place or beside one
    std::vector<int> missing_;  // [piece]: turns
    SingularPlaces out_;
};

}  // namespace

Result<SingularPlaces> singularPlaces(const FieldMesh& mesh, const MeshTopology& topology, uint32_t symmetry,
                                      const std::vector<AskedElement>& elements, const std::function<Field()>& smooth) {
    return Placing(mesh, topology, symmetry).run(elements, smooth);
}

}  // namespace espalier
