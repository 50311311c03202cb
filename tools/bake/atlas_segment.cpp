// In: triangles that need charts. Out: regions: clusters of triangles merged pairwise, the cheapest first (hierarchical
// face clustering), then borders straightened triangle by triangle, as creases, length and fit ask for.
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "tools/bake/atlas.hpp"

namespace espalier::bakery {
namespace {

constexpr double kBent = 0.45;        // 1 - |mean normal|²: what a region may bend as a whole
constexpr double kMeet = 0.17;        // cosine: regions whose mean normals differ more are not merged
constexpr double kPlainCost = 0.004;  // of a flat region's area: small ones are merged first
constexpr double kCreaseCost = 6;     // how much dearer it is to merge over creases
constexpr double kCrease = 0.8;       // cosine, 37°: edges that are sharper are creases
constexpr int kSweeps = 12;           // of straightening
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
    bool operator==(const Merge&) const = default;
};

double edgeLength(const BakeMesh& mesh, uint32_t h) {
    return glm::length(mesh.pointAt(BakeMesh::next(h)) - mesh.pointAt(h));
}

// Each cluster knows its cheapest merge; a queue holds those, and earlier ones that are passed over.
class Merger {
  public:
    Merger(const BakeMesh& mesh, const Facets& facets, const std::vector<uint8_t>& wanted)
        : sets_(wanted.size()), clusters_(wanted.size()), cheapest_(wanted.size()) {
        for (uint32_t t = 0; t < wanted.size(); ++t) {
            if (!wanted[t]) continue;
            Cluster& c = clusters_[t];
            c.normal = facets.normal[t] * facets.area[t];
            c.area = facets.area[t];
            for (uint32_t h = t * 3; h < t * 3 + 3; ++h) {
                double length = edgeLength(mesh, h);
                c.border += length;
                uint32_t twin = mesh.twin[h];
                if (twin == kNone || !wanted[twin / 3] || twin / 3 == t) continue;
                bool crease = glm::dot(facets.normal[t], facets.normal[twin / 3]) < kCrease;
                addNeighbour(c, {twin / 3, float(length), crease ? float(length) : 0.0f, kNever, t < twin / 3});
            }
        }
        std::vector<Entry> all;
        for (uint32_t t = 0; t < wanted.size(); ++t) {
            for (Neighbour& n : clusters_[t].neighbours) n.cost = costOf(t, n);
            cheapest_[t] = cheapestOf(t);
            if (cheapest_[t].cost < kNever) all.push_back({cheapest_[t], t});
        }
        queue_ = Queue({}, std::move(all));
    }

    void run() {
        while (!queue_.empty()) {
            const Entry e = queue_.top();
            queue_.pop();
            if (cheapest_[e.cluster] == e.merge) merge(e.merge.a, e.merge.b);
        }
    }
    uint32_t clusterOf(uint32_t triangle) { return sets_.find(triangle); }

  private:
    struct Entry {
        Merge merge;
        uint32_t cluster;                                                 // whose cheapest it was
        bool operator<(const Entry& o) const { return o.merge < merge; }  // the cheapest on top
    };
    using Queue = std::priority_queue<Entry>;

    static void addNeighbour(Cluster& c, const Neighbour& n) {
        for (Neighbour& have : c.neighbours)
            if (have.cluster == n.cluster) {
                have.length += n.length, have.crease += n.crease;
                return;
            }
        c.neighbours.push_back(n);
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
        for (const Neighbour& n : clusters_[c].neighbours) best = std::min(best, mergeOf(c, n));
        return best;
    }
    void propose(uint32_t c, const Merge& merge) {
        cheapest_[c] = merge;
        if (merge.cost < kNever) queue_.push({merge, c});
    }

    void merge(uint32_t a, uint32_t b) {
        if (a > b) std::swap(a, b);  // as DisjointSets does
        sets_.join(a, b);
        Cluster &x = clusters_[a], &y = clusters_[b];
        x.normal += y.normal;
        x.area += y.area;
        x.border += y.border;
        std::erase_if(x.neighbours, [&](const Neighbour& n) {
            if (n.cluster == b) x.border -= 2 * double(n.length);
            return n.cluster == b;
        });
        for (const Neighbour& n : y.neighbours) {
            if (n.cluster == a) continue;
            addNeighbour(x, n);
            auto& back = clusters_[n.cluster].neighbours;
            std::erase_if(back, [&](const Neighbour& m) { return m.cluster == b; });
            addNeighbour(clusters_[n.cluster], {a, n.length, n.crease, kNever, false});
        }
        y.neighbours = {};
        cheapest_[b] = {};
        for (Neighbour& n : x.neighbours) {
            n.cost = costOf(a, n);
            n.asked = true;
            for (Neighbour& m : clusters_[n.cluster].neighbours)
                if (m.cluster == a) m.cost = n.cost, m.asked = false;
            const Merge &had = cheapest_[n.cluster], now = mergeOf(a, n);
            const bool gone = had.a == a || had.a == b || had.b == a || had.b == b;
            if (gone)
                propose(n.cluster, cheapestOf(n.cluster));
            else if (now < had)
                propose(n.cluster, now);
        }
        propose(a, cheapestOf(a));
    }

    DisjointSets sets_;
    std::vector<Cluster> clusters_;
    std::vector<Merge> cheapest_;  // per cluster
    Queue queue_;
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
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        size_t moved = 0;
        for (uint32_t t = 0; t < label.size(); ++t) {
            uint32_t own = label[t];
            if (own == kNone || members[own] < 2) continue;
            uint32_t other[3];
            bool border = false;
            for (uint32_t k = 0; k < 3; ++k) {
                uint32_t twin = mesh.twin[t * 3 + k];
                other[k] = twin == kNone ? kNone : label[twin / 3];
                border = border || (other[k] != kNone && other[k] != own);
            }
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
