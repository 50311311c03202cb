// In: triangles that need charts. Out: regions: clusters of triangles merged pairwise, the cheapest first (hierarchical
// face clustering), then borders straightened triangle by triangle, as creases, length and fit ask for.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "runtime/core/jobs.hpp"
#include "tools/bake/atlas.hpp"

namespace espalier::bakery {
namespace {

constexpr double kBent = 0.45;          // 1 - |mean normal|²: what a region may bend as a whole
constexpr double kMeet = 0.17;          // cosine: regions whose mean normals differ more are not merged
constexpr double kPlainCost = 0.004;    // of a flat region's area: small ones are merged first
constexpr double kCreaseCost = 6;       // how much dearer it is to merge over creases
constexpr double kCrease = 0.8;         // cosine, 37°: edges that are sharper are creases
constexpr int kSweeps = 12;             // of straightening
constexpr size_t kBlock = 4096;         // triangles that a thread merges by themselves
constexpr double kBlockShare = 0.85;    // of a block's merges that are made so
constexpr double kSmallShare = 0.75;    // the same of models below
constexpr size_t kLarge = 65536;        // triangles
constexpr size_t kWorthBlocks = 32768;  // triangles: borders of smaller models' regions had better be straight
constexpr float kNever = std::numeric_limits<float>::infinity();

struct Neighbour {
    uint32_t cluster;
    float length, crease;  // of the shared border, and how much of it is creases
    float cost;            // of merging the two; infinite: they aren't merged
    bool asked;            // by this cluster, of the two the one that changed last
};

struct Cluster {
    glm::dvec3 normal{0};  // sum of area times normal
    double area = 0, border = 0;
    std::vector<Neighbour> neighbours;
};

// Equal costs are settled by who asked whom.
struct Merge {
    float cost = kNever;
    uint32_t a = kNone, b = kNone;
    bool operator<(const Merge& o) const { return std::tie(cost, a, b) < std::tie(o.cost, o.a, o.b); }
};

double edgeLength(const BakeMesh& mesh, uint32_t h) {
    return glm::length(mesh.pointAt(BakeMesh::next(h)) - mesh.pointAt(h));
}

// Triangles that are wanted, and where parts of them begin, with their end: parts can be merged at the same time.
struct Order {
    std::vector<uint32_t> triangles, parts;
};

// Of large models those that lie near each other together, along a Z-order curve: one part.
Order orderByPlace(const BakeMesh& mesh, const std::vector<uint8_t>& wanted) {
    std::vector<uint64_t> keys;
    const glm::dvec3 cell = glm::max(mesh.boundsMax - mesh.boundsMin, glm::dvec3(1e-300)) / 1023.0;
    for (uint32_t t = 0; t < wanted.size(); ++t) {
        if (!wanted[t]) continue;
        const glm::uvec3 at((mesh.pointAt(t * 3) - mesh.boundsMin) / cell);
        uint64_t key = 0;
        for (uint32_t bit = 0; bit < 10; ++bit)
            for (uint32_t k = 0; k < 3; ++k) key |= uint64_t(at[int(k)] >> bit & 1) << (bit * 3 + k);
        keys.push_back(key << 32 | t);
    }
    std::sort(keys.begin(), keys.end());
    return {{keys.begin(), keys.end()}, {0, uint32_t(keys.size())}};
}

// Those of one connected piece together, as they come: a piece's merges know nothing of others.
Order orderByPiece(const BakeMesh& mesh, const std::vector<uint8_t>& wanted) {
    DisjointSets sets(wanted.size());
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (const uint32_t twin = mesh.twin[h]; twin != kNone && twin < h && wanted[h / 3] && wanted[twin / 3])
            sets.join(h / 3, twin / 3);
    std::vector<uint32_t> piece;
    const uint32_t pieces = sets.number(piece);
    std::vector<uint32_t> first(pieces + 1, 0);
    for (uint32_t t = 0; t < wanted.size(); ++t) first[piece[t] + 1] += wanted[t];
    for (uint32_t p = 0; p < pieces; ++p) first[p + 1] += first[p];
    Order order{std::vector<uint32_t>(first.back()), first};
    order.parts.erase(std::unique(order.parts.begin(), order.parts.end()), order.parts.end());  // none wanted
    for (uint32_t t = 0; t < wanted.size(); ++t)
        if (wanted[t]) order.triangles[first[piece[t]]++] = t;
    return order;
}

Order orderOf(const BakeMesh& mesh, const std::vector<uint8_t>& wanted) {
    const bool large = size_t(std::count(wanted.begin(), wanted.end(), 1)) >= kWorthBlocks;
    return large ? orderByPlace(mesh, wanted) : orderByPiece(mesh, wanted);
}

// Who of a range of clusters has the cheapest merge: a knockout tournament. A change is played up only as far as it
// matters. barred: per cluster: no merge with it counts; or empty.
class Tournament {
  public:
    Tournament(const std::vector<Merge>& offers, size_t begin, size_t end, const std::vector<uint8_t>& barred)
        : offers_(offers),
          barred_(barred),
          begin_(begin),
          size_(std::bit_ceil(std::max<size_t>(end - begin, 2))),
          players_(size_ * 2) {
        for (uint32_t i = uint32_t(begin); i < end; ++i) players_[size_ + i - begin] = {costOf(i), i};
        for (size_t n = size_ - 1; n > 0; --n) players_[n] = better(n * 2);
    }
    const Merge& best() const { return offers_[players_[1].who]; }
    bool over() const { return players_[1].cost == kNever; }
    void changed(uint32_t who) {
        size_t n = size_ + who - begin_;
        players_[n].cost = costOf(who);
        for (n /= 2; n > 0; n /= 2) {
            const Player now = better(n * 2);
            if (now.who == players_[n].who && now.who != who) break;
            players_[n] = now;
        }
    }

  private:
    struct Player {
        float cost = kNever;
        uint32_t who = 0;
    };
    float costOf(uint32_t who) const {
        const Merge& m = offers_[who];
        return m.cost == kNever || (!barred_.empty() && (barred_[m.a] || barred_[m.b])) ? kNever : m.cost;
    }
    Player better(size_t first) const {
        const Player &a = players_[first], &b = players_[first + 1];
        if (a.cost != b.cost) return a.cost < b.cost ? a : b;
        return a.cost != kNever && offers_[b.who] < offers_[a.who] ? b : a;
    }

    const std::vector<Merge>& offers_;
    const std::vector<uint8_t>& barred_;
    size_t begin_, size_;
    std::vector<Player> players_;  // the winner, its two last opponents, and so on down to all
};

// Each cluster knows its cheapest merge. Clusters begin as single triangles.
class Merger {
  public:
    Merger(const BakeMesh& mesh, const Facets& facets, const std::vector<uint8_t>& wanted)
        : order_(orderOf(mesh, wanted)),
          place_(wanted.size(), kNone),
          sets_(size()),
          clusters_(size()),
          cheapest_(size()) {
        for (uint32_t c = 0; c < size(); ++c) place_[order_.triangles[c]] = c;
        parallelFor(size(), kBlock, [&](size_t begin, size_t end) {
            for (size_t c = begin; c < end; ++c) clusters_[c] = clusterOf(mesh, facets, order_.triangles[c]);
        });
        parallelFor(size(), kBlock, [&](size_t begin, size_t end) {
            for (uint32_t c = uint32_t(begin); c < end; ++c) {
                for (Neighbour& n : clusters_[c].neighbours) n.cost = costOf(c, n);
                cheapest_[c] = cheapestOf(c);
            }
        });
    }

    // Of large models first most of what lies within blocks, each by itself, clusters at its border left out; then all.
    void run() {
        if (size() >= kWorthBlocks) mergeBlocks();
        parallelFor(order_.parts.size() - 1, 1, [&](size_t part, size_t) {
            const size_t begin = order_.parts[part], end = order_.parts[part + 1];
            mergeCheapest(begin, end, {}, end - begin);
        });
    }
    // A number that the triangles of a cluster share.
    uint32_t clusterOf(uint32_t triangle) { return sets_.find(place_[triangle]); }

  private:
    size_t size() const { return order_.triangles.size(); }

    void mergeBlocks() {
        const double share = size() < kLarge ? kSmallShare : kBlockShare;
        std::vector<uint8_t> barred(size(), 0);
        parallelFor(size(), kBlock, [&](size_t begin, size_t end) {
            for (size_t c = begin; c < end; ++c)
                for (const Neighbour& n : clusters_[c].neighbours)
                    barred[c] = barred[c] || n.cluster < begin || n.cluster >= end;
            mergeCheapest(begin, end, barred, size_t(double(end - begin) * share));
        });
    }

    void mergeCheapest(size_t begin, size_t end, const std::vector<uint8_t>& barred, size_t most) {
        Tournament tournament(cheapest_, begin, end, barred);
        for (size_t i = 0; i < most && !tournament.over(); ++i) {
            const Merge next = tournament.best();
            merge(next.a, next.b, tournament);
        }
    }

    Cluster clusterOf(const BakeMesh& mesh, const Facets& facets, uint32_t t) const {
        Cluster c;
        c.normal = facets.normal[t] * facets.area[t];
        c.area = facets.area[t];
        c.neighbours.reserve(4);
        for (uint32_t h = t * 3; h < t * 3 + 3; ++h) {
            double length = edgeLength(mesh, h);
            c.border += length;
            uint32_t twin = mesh.twin[h];
            if (twin == kNone || place_[twin / 3] == kNone || twin / 3 == t) continue;
            bool crease = glm::dot(facets.normal[t], facets.normal[twin / 3]) < kCrease;
            addNeighbour(c, {place_[twin / 3], float(length), crease ? float(length) : 0.0f, kNever,
                             place_[t] < place_[twin / 3]});
        }
        return c;
    }

    static Neighbour* find(Cluster& c, uint32_t cluster) {
        for (Neighbour& n : c.neighbours)
            if (n.cluster == cluster) return &n;
        return nullptr;
    }
    static void addNeighbour(Cluster& c, const Neighbour& n) {
        if (Neighbour* have = find(c, n.cluster))
            have->length += n.length, have->crease += n.crease;
        else
            c.neighbours.push_back(n);
    }
    static void forget(Cluster& c, Neighbour* n) {
        *n = c.neighbours.back();
        c.neighbours.pop_back();
    }

    float costOf(uint32_t a, const Neighbour& n) const {
        const Cluster &x = clusters_[a], &y = clusters_[n.cluster];
        double area = x.area + y.area;
        glm::dvec3 sum = x.normal + y.normal;
        double bent = 1 - glm::dot(sum, sum) / (area * area);
        double meet = glm::dot(x.normal, y.normal);
        if (bent > kBent || meet < 0 ||
            meet * meet < kMeet * kMeet * glm::dot(x.normal, x.normal) * glm::dot(y.normal, y.normal))
            return kNever;
        double border = std::max(0.0, x.border + y.border - 2 * double(n.length));
        double round = std::min(border * border / (4 * 3.14159265 * area), 12.0);
        double crease = n.length > 0 ? n.crease / n.length : 0;
        return float(area * (bent + kPlainCost) * (1 + round) * (1 + kCreaseCost * crease));
    }

    static Merge mergeOf(uint32_t c, const Neighbour& n) {
        return n.asked ? Merge{n.cost, c, n.cluster} : Merge{n.cost, n.cluster, c};
    }
    Merge cheapestOf(uint32_t c) const {
        Merge best;
        for (const Neighbour& n : clusters_[c].neighbours)
            if (n.cost <= best.cost) best = std::min(best, mergeOf(c, n));
        return best;
    }

    void merge(uint32_t a, uint32_t b, Tournament& tournament) {
        if (a > b) std::swap(a, b);  // as DisjointSets does
        sets_.join(a, b);
        Cluster &x = clusters_[a], &y = clusters_[b];
        x.normal += y.normal;
        x.area += y.area;
        x.border += y.border;
        Neighbour* shared = find(x, b);
        x.border -= 2 * double(shared->length);
        forget(x, shared);
        for (const Neighbour& n : y.neighbours) {
            if (n.cluster == a) continue;
            addNeighbour(x, n);
            Cluster& other = clusters_[n.cluster];
            Neighbour* back = find(other, b);
            if (Neighbour* had = find(other, a)) {
                had->length += n.length, had->crease += n.crease;
                forget(other, back);
            } else {
                *back = {a, n.length, n.crease, kNever, false};
            }
        }
        y.neighbours = {};
        cheapest_[b] = {};
        tournament.changed(b);
        for (Neighbour& n : x.neighbours) {
            n.cost = costOf(a, n);
            n.asked = true;
            Neighbour* back = find(clusters_[n.cluster], a);
            back->cost = n.cost, back->asked = false;
            Merge& had = cheapest_[n.cluster];
            const Merge now = mergeOf(a, n);
            const bool gone = had.a == a || had.a == b || had.b == a || had.b == b;
            if (!gone && !(now < had)) continue;
            had = gone ? cheapestOf(n.cluster) : now;
            tournament.changed(n.cluster);
        }
        cheapest_[a] = cheapestOf(a);
        tournament.changed(a);
    }

    Order order_;                  // per cluster its first triangle
    std::vector<uint32_t> place_;  // per triangle the cluster that it was
    DisjointSets sets_;
    std::vector<Cluster> clusters_;
    std::vector<Merge> cheapest_;  // per cluster
};

// Moves triangles at borders to the neighbouring region where that shortens the border or fits better. Creases are
// borders that cost little.
void straighten(const BakeMesh& mesh, const Facets& facets, std::vector<uint32_t>& label, uint32_t count) {
    std::vector<glm::dvec3> sum(count, glm::dvec3(0));
    std::vector<double> area(count, 0);
    std::vector<uint32_t> members(count, 0);
    for (size_t t = 0; t < label.size(); ++t)
        if (label[t] != kNone)
            sum[label[t]] += facets.normal[t] * facets.area[t], area[label[t]] += facets.area[t], ++members[label[t]];
    auto misfit = [&](size_t t, uint32_t l) {
        double length = glm::length(sum[l]);
        if (length <= 0) return 2.0;
        return 1 - glm::dot(facets.normal[t], sum[l]) / length;
    };
    // Triangles that may lie at a border.
    std::vector<uint8_t> open(label.size(), 0);
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (uint32_t twin = mesh.twin[h]; twin != kNone && label[twin / 3] != label[h / 3]) open[h / 3] = 1;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        size_t moved = 0;
        for (uint32_t t = 0; t < label.size(); ++t) {
            if (!open[t]) continue;
            uint32_t own = label[t];
            if (own == kNone || members[own] < 2) continue;
            uint32_t other[3];
            bool border = false;
            for (uint32_t k = 0; k < 3; ++k) {
                uint32_t twin = mesh.twin[t * 3 + k];
                other[k] = twin == kNone ? kNone : label[twin / 3];
                border = border || (other[k] != kNone && other[k] != own);
            }
            open[t] = border;
            if (!border) continue;
            double weight[3], all = 0;
            for (uint32_t k = 0; k < 3; ++k) {
                weight[k] = 0;
                if (other[k] == kNone) continue;
                double dot = glm::dot(facets.normal[t], facets.normal[mesh.twin[t * 3 + k] / 3]);
                weight[k] = edgeLength(mesh, t * 3 + k) * (0.05 + 0.95 * std::max(0.0, (dot - 0.5) * 2));
                all += weight[k];
            }
            auto cost = [&](uint32_t l) {
                double same = 0;
                for (int k = 0; k < 3; ++k)
                    if (other[k] == l) same += weight[k];
                return all - same + misfit(t, l) * facets.area[t] / std::sqrt(area[l]) * 4;
            };
            uint32_t best = own;
            double least = cost(own) - 1e-9 * all;
            for (int k = 0; k < 3; ++k)
                if (other[k] != kNone && other[k] != own && cost(other[k]) < least)
                    best = other[k], least = cost(other[k]);
            if (best == own) continue;
            glm::dvec3 n = facets.normal[t] * facets.area[t];
            sum[own] -= n, sum[best] += n;
            area[own] -= facets.area[t], area[best] += facets.area[t];
            --members[own], ++members[best];
            label[t] = best;
            for (uint32_t h = t * 3; h < t * 3 + 3; ++h)
                if (mesh.twin[h] != kNone) open[mesh.twin[h] / 3] = 1;
            ++moved;
        }
        if (moved == 0) break;
    }
}

// Numbers connected pieces of equal label.
uint32_t renumber(const BakeMesh& mesh, std::vector<uint32_t>& label) {
    DisjointSets sets(label.size());
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (uint32_t twin = mesh.twin[h]; twin != kNone && label[h / 3] != kNone && label[h / 3] == label[twin / 3])
            sets.join(h / 3, twin / 3);
    std::vector<uint32_t> number(label.size(), kNone);
    uint32_t count = 0;
    for (uint32_t t = 0; t < label.size(); ++t) {
        if (label[t] == kNone) continue;
        uint32_t& n = number[sets.find(t)];
        if (n == kNone) n = count++;
        label[t] = n;
    }
    return count;
}

}  // namespace

Facets measureFacets(const BakeMesh& mesh) {
    Facets out;
    out.normal.resize(mesh.triangles.size());
    out.area.resize(mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& p = mesh.triangles[t].point;
        glm::dvec3 n = glm::cross(mesh.points[p[1]] - mesh.points[p[0]], mesh.points[p[2]] - mesh.points[p[0]]);
        double twice = glm::length(n);
        out.normal[t] = n / twice;
        out.area[t] = twice / 2;
        out.total += twice / 2;
    }
    return out;
}

uint32_t segment(const BakeMesh& mesh, const Facets& facets, const std::vector<uint8_t>& wanted,
                 std::vector<uint32_t>& label) {
    Merger merger(mesh, facets, wanted);
    merger.run();
    label.assign(wanted.size(), kNone);
    std::vector<uint32_t> number(wanted.size(), kNone);
    uint32_t count = 0;
    for (uint32_t t = 0; t < wanted.size(); ++t) {
        if (!wanted[t]) continue;
        uint32_t& n = number[merger.clusterOf(t)];
        if (n == kNone) n = count++;
        label[t] = n;
    }
    straighten(mesh, facets, label, count);
    return renumber(mesh, label);
}

}  // namespace espalier::bakery
