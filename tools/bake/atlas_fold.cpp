// In: charts, flattened, in metres. Out: fewer: small charts are folded out at an edge that they share with another, as
// a box is unfolded. Rigid motions only: nothing is stretched by it. What fits along several edges is joined along all.
#include <algorithm>
#include <cmath>

#include "tools/bake/atlas.hpp"

namespace espalier::bakery {
namespace {

constexpr double kLargest = 0.04;   // of the model's area: charts don't grow beyond it by folding
constexpr double kLongest = 0.4;    // of the square root of the model's area: nor their boxes
constexpr double kLeastFill = 0.4;  // of their box by the chart
constexpr double kLeastEdge = 0.1;  // of the smaller chart's border that has to fit
constexpr double kFits = 2e-3;      // of an edge's length: ends nearer than that fall together
constexpr int kFoldRounds = 24;

// Shares of something that differ by rounding only, as in kits of equal parts, are made equal: then the order of the
// model decides.
double alike(double share) {
    return std::round(share * 1e6) * 1e-6;
}

// A rigid motion of the plane: turn, then shift.
struct Motion {
    glm::dvec2 turn{1, 0}, shift{0};
    glm::dvec2 operator()(glm::dvec2 p) const {
        return glm::dvec2(turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y) + shift;
    }
};

struct Piece {
    std::vector<uint32_t> triangles;
    double area = 0, border = 0;
};

struct Fold {
    double score;
    uint32_t a, b;                // charts: b is moved
    std::vector<uint32_t> edges;  // half-edges of a along b
    Motion motion;
    bool operator<(const Fold& o) const { return std::tie(o.score, a, b) < std::tie(score, o.a, o.b); }
};

class Folder {
  public:
    Folder(BakeMesh& mesh, uint32_t first, uint32_t count)
        : mesh_(mesh), first_(first), pieces_(count), changed_(count, 1) {
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            if (mesh.triangles[t].chart < first) continue;
            Piece& p = pieces_[mesh.triangles[t].chart - first];
            p.triangles.push_back(t);
            p.area += area3(mesh, mesh.triangles[t]);
            for (uint32_t h = t * 3; h < t * 3 + 3; ++h) {
                if (mesh.joined[h]) continue;
                p.border += length(h);
                if (mesh.twin[h] != kNone && mesh.chartOf(mesh.twin[h]) >= first) open_.push_back(h);
            }
        }
        for (const Triangle& t : mesh.triangles) total_ += area3(mesh, t);
    }

    void run() {
        for (int round = 0; round < kFoldRounds; ++round) {
            std::vector<Fold> folds = findFolds();
            std::sort(folds.begin(), folds.end());
            changed_.assign(pieces_.size(), 0);
            bool any = false;
            for (const Fold& f : folds) {
                if (changed_[f.a] || changed_[f.b] || !isFree(f)) continue;
                changed_[f.a] = changed_[f.b] = 1;
                apply(f);
                any = true;
            }
            if (!any) break;
        }
    }

  private:
    double length(uint32_t h) const { return glm::length(mesh_.uvAt(BakeMesh::next(h)) - mesh_.uvAt(h)); }
    uint32_t pieceOf(uint32_t h) const { return mesh_.chartOf(h) - first_; }

    // The motion that lays the twin of h, of another chart, along h.
    Motion along(uint32_t h) const {
        uint32_t twin = mesh_.twin[h];
        glm::dvec2 to = mesh_.uvAt(BakeMesh::next(h)) - mesh_.uvAt(h);
        glm::dvec2 from = mesh_.uvAt(twin) - mesh_.uvAt(BakeMesh::next(twin));
        Motion m;
        m.turn = {glm::dot(from, to), cross(from, to)};
        m.turn /= glm::length(m.turn);
        m.shift = mesh_.uvAt(h) - m(mesh_.uvAt(BakeMesh::next(twin)));
        return m;
    }
    bool fits(uint32_t h, const Motion& m) const {
        uint32_t twin = mesh_.twin[h];
        double most = kFits * length(h);
        return glm::length(m(mesh_.uvAt(BakeMesh::next(twin))) - mesh_.uvAt(h)) <= most &&
               glm::length(m(mesh_.uvAt(twin)) - mesh_.uvAt(BakeMesh::next(h))) <= most;
    }

    // For every two charts that share edges, one of them changed by the last round (else they didn't fit then, and
    // don't now): the smaller one folded out at the longest of them.
    std::vector<Fold> findFolds() {
        struct Shared {
            uint64_t pair;
            double share;  // its length, of the square root of the model's area
            uint32_t half;
            bool operator<(const Shared& o) const {
                return pair != o.pair ? pair < o.pair : share != o.share ? share > o.share : half < o.half;
            }
        };
        std::vector<Shared> shared;
        std::erase_if(open_, [&](uint32_t h) {
            const uint32_t a = pieceOf(h), b = pieceOf(mesh_.twin[h]);
            if (a == b || pieces_[a].area + pieces_[b].area > kLargest * total_) return true;
            const bool larger = std::tie(pieces_[b].area, a) < std::tie(pieces_[a].area, b);
            if (larger && (changed_[a] || changed_[b]))
                shared.push_back({uint64_t(a) << 32 | b, alike(length(h) / std::sqrt(total_)), h});
            return false;
        });
        std::sort(shared.begin(), shared.end());
        std::vector<Fold> folds;
        for (size_t i = 0, j; i < shared.size(); i = j) {
            Fold f{0, uint32_t(shared[i].pair >> 32), uint32_t(shared[i].pair), {}, along(shared[i].half)};
            double fitting = 0;
            for (j = i; j < shared.size() && shared[j].pair == shared[i].pair; ++j)
                if (fits(shared[j].half, f.motion))
                    fitting += length(shared[j].half), f.edges.push_back(shared[j].half);
            f.score = alike(fitting / std::min(pieces_[f.a].border, pieces_[f.b].border));
            if (f.score >= kLeastEdge && isCompact(f, shared[i].half)) folds.push_back(std::move(f));
        }
        return folds;
    }

    bool isCompact(const Fold& f, uint32_t h) const {
        glm::dvec2 axis = glm::normalize(mesh_.uvAt(BakeMesh::next(h)) - mesh_.uvAt(h)), low(1e300), high(-1e300);
        auto grow = [&](glm::dvec2 p) {
            glm::dvec2 q(glm::dot(axis, p), cross(axis, p));
            low = glm::min(low, q), high = glm::max(high, q);
        };
        for (uint32_t t : pieces_[f.a].triangles)
            for (glm::dvec2 p : mesh_.triangles[t].uv) grow(p);
        for (uint32_t t : pieces_[f.b].triangles)
            for (glm::dvec2 p : mesh_.triangles[t].uv) grow(f.motion(p));
        glm::dvec2 size = high - low;
        return std::max(size.x, size.y) <= kLongest * std::sqrt(total_) &&
               pieces_[f.a].area + pieces_[f.b].area >= kLeastFill * size.x * size.y;
    }

    // A border as it lies, and middles that must not lie within another: of triangles, and of border edges that aren't
    // joined by the fold. reach: how far inside they have to lie to count.
    struct Line {
        glm::dvec2 a, b;
    };
    struct Middle {
        glm::dvec2 at;
        double reach;
    };
    struct Outline {
        std::vector<Line> lines;
        std::vector<Middle> middles;
        glm::dvec2 low{1e300}, high{-1e300};
    };
    Outline outlineOf(const Piece& piece, const Motion& m, const std::vector<uint32_t>& joining) const {
        Outline out;
        for (uint32_t t : piece.triangles) {
            const auto& uv = mesh_.triangles[t].uv;
            out.middles.push_back({m((uv[0] + uv[1] + uv[2]) / 3.0), 0});
            for (uint32_t h = t * 3; h < t * 3 + 3; ++h) {
                if (mesh_.joined[h]) continue;
                Line line{m(mesh_.uvAt(h)), m(mesh_.uvAt(BakeMesh::next(h)))};
                out.low = glm::min(out.low, line.a), out.high = glm::max(out.high, line.a);
                out.lines.push_back(line);
                auto names = [&](uint32_t edge) { return edge == h || mesh_.twin[edge] == h; };
                if (std::none_of(joining.begin(), joining.end(), names))
                    out.middles.push_back({(line.a + line.b) / 2.0, kFits * glm::length(line.b - line.a)});
            }
        }
        return out;
    }
    static bool anyInside(const Outline& what, const Outline& of) {
        for (const auto& [p, reach] : what.middles) {
            if (p.x < of.low.x || p.y < of.low.y || p.x > of.high.x || p.y > of.high.y) continue;
            bool inside = false;
            for (const Line& l : of.lines)
                if ((l.a.y > p.y) != (l.b.y > p.y) && p.x < l.a.x + (l.b.x - l.a.x) * (p.y - l.a.y) / (l.b.y - l.a.y))
                    inside = !inside;
            if (inside && std::none_of(of.lines.begin(), of.lines.end(), [&, at = p, far = reach](const Line& l) {
                    glm::dvec2 d = l.b - l.a, c = at - l.a;
                    return glm::length(c - d * std::clamp(glm::dot(c, d) / glm::dot(d, d), 0.0, 1.0)) <= far;
                }))
                return true;
        }
        return false;
    }

    // Whether the folded chart lies beside the other, nowhere over it. Borders may touch.
    bool isFree(const Fold& f) const {
        const Outline here = outlineOf(pieces_[f.a], {}, f.edges), there = outlineOf(pieces_[f.b], f.motion, f.edges);
        double slack = 1e-9 * std::sqrt(total_);
        for (const Line& s : here.lines) {
            glm::dvec2 low = glm::min(s.a, s.b), high = glm::max(s.a, s.b);
            if (low.x > there.high.x || low.y > there.high.y || high.x < there.low.x || high.y < there.low.y) continue;
            for (const Line& t : there.lines) {
                glm::dvec2 d = s.b - s.a, e = t.b - t.a;
                double ld = glm::length(d) * slack, le = glm::length(e) * slack;
                double p = cross(d, t.a - s.a), q = cross(d, t.b - s.a), u = cross(e, s.a - t.a),
                       v = cross(e, s.b - t.a);
                if (((p > ld && q < -ld) || (p < -ld && q > ld)) && ((u > le && v < -le) || (u < -le && v > le)))
                    return false;
            }
        }
        return !anyInside(there, here) && !anyInside(here, there);
    }

    void apply(const Fold& f) {
        Piece &a = pieces_[f.a], &b = pieces_[f.b];
        for (uint32_t t : b.triangles) {
            for (glm::dvec2& uv : mesh_.triangles[t].uv) uv = f.motion(uv);
            mesh_.triangles[t].chart = first_ + f.a;
        }
        for (uint32_t h : f.edges) {
            uint32_t twin = mesh_.twin[h];
            a.border -= length(h);
            b.border -= length(twin);
            mesh_.joined[h] = mesh_.joined[twin] = 1;
        }
        for (uint32_t h : f.edges) {
            moveVertex(mesh_.twin[h], mesh_.uvAt(BakeMesh::next(h)));
            moveVertex(BakeMesh::next(mesh_.twin[h]), mesh_.uvAt(h));
        }
        a.triangles.insert(a.triangles.end(), b.triangles.begin(), b.triangles.end());
        a.area += b.area, a.border += b.border;
        b = {};
    }

    // Moves the vertex at a corner, with all triangles around it that are joined there, both ways.
    void moveVertex(uint32_t corner, glm::dvec2 to) {
        for (bool left : {true, false}) {
            uint32_t h = corner;
            do {
                mesh_.triangles[h / 3].uv[h % 3] = to;
                uint32_t edge = left ? BakeMesh::next(BakeMesh::next(h)) : h;
                if (!mesh_.joined[edge]) break;
                h = left ? mesh_.twin[edge] : BakeMesh::next(mesh_.twin[edge]);
            } while (h != corner);
        }
    }

    BakeMesh& mesh_;
    uint32_t first_;
    std::vector<Piece> pieces_;
    std::vector<uint8_t> changed_;  // per piece: by the last round
    std::vector<uint32_t> open_;    // half-edges between pieces that might be joined there, ascending
    double total_ = 0;
};

}  // namespace

uint32_t foldOut(BakeMesh& mesh, uint32_t first, uint32_t charts) {
    if (charts - first < 2) return charts;
    Folder(mesh, first, charts - first).run();
    std::vector<uint32_t> number(charts, kNone);
    uint32_t count = first;
    for (Triangle& t : mesh.triangles) {
        if (t.chart < first) continue;
        uint32_t& n = number[t.chart];
        if (n == kNone) n = count++;
        t.chart = n;
    }
    return count;
}

}  // namespace espalier::bakery
