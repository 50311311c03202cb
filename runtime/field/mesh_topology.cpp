// A tree over the vertices, a tree over the triangles that crosses none of its edges, and what edges both leave over
// (Eppstein 2003, "Dynamic generators of topologically embedded graphs").
#include "runtime/field/mesh_topology.hpp"

namespace espalier {
namespace {

template <class Visit>
void aroundVertex(const FieldMesh& mesh, uint32_t v, const Visit& visit) {
    uint32_t h = mesh.first[v];
    do {
        visit(h);
        // At a border one edge more arrives than leaves.
        const uint32_t before = FieldMesh::previous(h);
        if (mesh.twin[before] == kNoIndex) visit(before);
        h = mesh.twin[before];
    } while (h != kNoIndex && h != mesh.first[v]);
}

class Tracing {
  public:
    explicit Tracing(const FieldMesh& mesh) : mesh_(mesh), used_(mesh.twin.size(), false) {}

    MeshTopology run() {
        vertices();
        triangles();
        for (uint32_t h = 0; h < mesh_.twin.size(); ++h)
            if (mesh_.ownsEdge(h) && !used_[h]) out_.loops.push_back(loopThrough(h));
        return std::move(out_);
    }

  private:
    uint32_t owner(uint32_t h) const { return mesh_.ownsEdge(h) ? h : mesh_.twin[h]; }

    void vertices() {
        out_.pieceOf.assign(mesh_.positions.size(), kNoIndex);
        for (uint32_t seed = 0; seed < mesh_.positions.size(); ++seed) {
            if (out_.pieceOf[seed] != kNoIndex) continue;
            const uint32_t number = uint32_t(out_.pieces.size());
            MeshPiece& piece = out_.pieces.emplace_back();
            piece.vertices = {seed};
            out_.pieceOf[seed] = number;
            for (size_t i = 0; i < piece.vertices.size(); ++i) {
                const uint32_t v = piece.vertices[i];
                piece.closed = piece.closed && !mesh_.border[v];
                aroundVertex(mesh_, v, [&](uint32_t h) {
                    const uint32_t to = mesh_.from(h) == v ? mesh_.to(h) : mesh_.from(h);
                    if (out_.pieceOf[to] != kNoIndex) return;
                    out_.pieceOf[to] = number;
                    used_[owner(h)] = true;
                    piece.vertices.push_back(to);
                });
            }
            piece.euler = int(piece.vertices.size());
        }
        for (uint32_t h = 0; h < mesh_.twin.size(); ++h)
            if (mesh_.ownsEdge(h)) --out_.pieces[out_.pieceOf[mesh_.from(h)]].euler;
        for (const auto& triangle : mesh_.triangles) ++out_.pieces[out_.pieceOf[triangle[0]]].euler;
    }

    void triangles() {
        out_.upward.assign(mesh_.triangles.size(), kNoIndex);
        seen_.assign(mesh_.triangles.size(), false);
        for (uint32_t h = 0; h < mesh_.twin.size(); ++h)
            if (mesh_.twin[h] == kNoIndex && !used_[h]) enter(h);
        spread(0);
        for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
            if (seen_[t]) continue;
            seen_[t] = true;
            out_.order.push_back(t);
            spread(out_.order.size() - 1);
        }
    }
    // A triangle over its half-edge towards what is above it.
    void enter(uint32_t h) {
        if (seen_[h / 3]) return;
        seen_[h / 3] = true;
        used_[owner(h)] = true;
        out_.upward[h / 3] = h;
        out_.order.push_back(h / 3);
    }
    void spread(size_t from) {
        for (size_t i = from; i < out_.order.size(); ++i)
            for (uint32_t k = 0; k < 3; ++k) {
                const uint32_t h = 3 * out_.order[i] + k;
                if (mesh_.twin[h] != kNoIndex && !used_[owner(h)]) enter(mesh_.twin[h]);
            }
    }

    // Out of the triangle over the edge, and back through the tree.
    std::vector<EdgeNumber> loopThrough(uint32_t h) const {
        std::vector<uint32_t> back = wayUp(h / 3), on;
        if (mesh_.twin[h] != kNoIndex) on = wayUp(mesh_.twin[h] / 3);
        while (!back.empty() && !on.empty() && back.back() == on.back()) back.pop_back(), on.pop_back();
        std::vector<EdgeNumber> loop{{h, 1}};
        for (uint32_t up : back) loop.push_back({owner(up), mesh_.ownsEdge(up) ? -1.0 : 1.0});
        for (uint32_t up : on) loop.push_back({owner(up), mesh_.ownsEdge(up) ? 1.0 : -1.0});
        return loop;
    }
    std::vector<uint32_t> wayUp(uint32_t t) const {
        std::vector<uint32_t> way;
        for (uint32_t h = out_.upward[t]; h != kNoIndex;) {
            way.push_back(h);
            h = mesh_.twin[h] == kNoIndex ? kNoIndex : out_.upward[mesh_.twin[h] / 3];
        }
        return way;
    }

    const FieldMesh& mesh_;
    std::vector<bool> used_;  // [half-edge that owns its edge]: by one of the trees
    std::vector<bool> seen_;  // [triangle]
    MeshTopology out_;
};

}  // namespace

MeshTopology topologyOf(const FieldMesh& mesh) {
    return Tracing(mesh).run();
}

}  // namespace espalier
