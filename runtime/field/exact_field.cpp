// In: places of singularities. Out: a field that has them. Each edge has a number, by how much the field turns along it
// beyond parallel transport. Around a triangle they add up to the triangle's singularity less its curvature. Any field
// gives numbers that do so for its own singularities; whole N-ths of turns, moved along a tree of triangles, change
// these to the ones wanted. Then turning the directions at vertices makes the numbers' sum of squares least.
#include "runtime/field/exact_field.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/field/mesh_topology.hpp"
#include "runtime/field/singular_places.hpp"

namespace espalier {
namespace {

using Complex = std::complex<double>;
using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;
using Factors = Eigen::SimplicialLDLT<Matrix>;

constexpr double kPin = 1e-6;      // holds one vertex of each piece, against bonds of edges of about 1
constexpr double kMostTurn = 2.8;  // of the N-th power along an edge; beyond pi it looks like one the other way around
constexpr double kStiffer = 4;     // by which an edge that turns more is bound more
constexpr int kMostRounds = 8;
constexpr size_t kMostLoops = 256;  // whose turns are chosen; a mesh full of holes keeps those of the smooth field

Matrix bonds(const FieldMesh& mesh, const MeshTopology& topology, const std::vector<double>& weight,
             const std::vector<double>* pull) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(mesh.twin.size() * 2 + mesh.positions.size());
    for (uint32_t h = 0; h < mesh.twin.size(); ++h) {
        if (!mesh.ownsEdge(h)) continue;
        const int a = int(mesh.from(h)), b = int(mesh.to(h));
        entries.emplace_back(a, a, weight[h]);
        entries.emplace_back(b, b, weight[h]);
        entries.emplace_back(a, b, -weight[h]);
        entries.emplace_back(b, a, -weight[h]);
    }
    for (const MeshPiece& piece : topology.pieces)
        entries.emplace_back(int(piece.vertices[0]), int(piece.vertices[0]), kPin);
    if (pull)
        for (size_t v = 0; v < pull->size(); ++v) entries.emplace_back(int(v), int(v), (*pull)[v]);
    Matrix matrix(int(mesh.positions.size()), int(mesh.positions.size()));
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

Field anyField(const FieldMesh& mesh, uint32_t symmetry) {
    Field field;
    field.symmetry = symmetry;
    field.power.assign(mesh.positions.size(), 1);
    field.mean.assign(mesh.positions.size(), 0);
    field.deviator.assign(mesh.positions.size(), 1);
    return field;
}

}  // namespace

struct ExactField::State {
    const FieldMesh& mesh;
    MeshTopology topology;
    std::vector<double> weight;  // [half-edge that owns its edge]
    Factors free;                // of the bonds alone
    std::vector<Vector> around;  // [loop]: the turns at vertices that make the loop's numbers smooth
    Eigen::LDLT<Eigen::MatrixXd> loops;
    Field settled;  // with singularities at these places, whatever directions are asked for
    std::vector<SingularPlace> settledAt;
    std::vector<double> stiff;              // bonds of its edges, as `weight`
    std::vector<double> pulled, stiffened;  // what elements ask for, and bonds: that `held` is of
    Factors held;

    explicit State(const FieldMesh& of) : mesh(of), topology(topologyOf(of)), weight(of.twin.size(), 0) {
        for (uint32_t h = 0; h < weight.size(); ++h)
            if (mesh.ownsEdge(h)) weight[h] = mesh.edgeWeight(h);
        free.compute(bonds(mesh, topology, weight, nullptr));
        if (free.info() == Eigen::Success && topology.loops.size() <= kMostLoops) measureLoops();
    }

    // At each vertex what the numbers on its edges push it by.
    Vector pushOf(const std::vector<EdgeNumber>& numbers, const std::vector<double>& weights) const {
        Vector push = Vector::Zero(Eigen::Index(mesh.positions.size()));
        for (const EdgeNumber& n : numbers) {
            push[mesh.from(n.halfEdge)] += weights[n.halfEdge] * n.number;
            push[mesh.to(n.halfEdge)] -= weights[n.halfEdge] * n.number;
        }
        return push;
    }
    double smoothed(const EdgeNumber& n, const Vector& turn) const {
        return n.number + turn[mesh.to(n.halfEdge)] - turn[mesh.from(n.halfEdge)];
    }

    void measureLoops() {
        const size_t count = topology.loops.size();
        for (const auto& loop : topology.loops) around.push_back(free.solve(pushOf(loop, weight)));
        if (count == 0) return;
        Eigen::MatrixXd products(count, count);
        for (size_t i = 0; i < count; ++i) {
            std::vector<double> own(weight.size(), 0);
            for (const EdgeNumber& n : topology.loops[i]) own[n.halfEdge] = n.number;
            for (size_t j = 0; j < count; ++j) {
                double sum = 0;
                for (const EdgeNumber& n : topology.loops[j])
                    sum += weight[n.halfEdge] * n.number * smoothed({n.halfEdge, own[n.halfEdge]}, around[i]);
                products(Eigen::Index(i), Eigen::Index(j)) = sum;
            }
        }
        loops.compute(products);
    }

    // By how much any field turns along each edge, and then what moves its singularities to the places wanted.
    std::vector<EdgeNumber> numbersFor(const Field& any, const std::vector<SingularPlace>& places) const {
        const double step = 2 * std::numbers::pi / any.symmetry;
        std::vector<double> number(mesh.twin.size(), 0);
        const auto add = [&](uint32_t h, double more) {
            if (mesh.ownsEdge(h))
                number[h] += more;
            else
                number[mesh.twin[h]] -= more;
        };
        for (uint32_t h = 0; h < number.size(); ++h)
            if (mesh.ownsEdge(h)) number[h] = turnAlong(mesh, any, h) / any.symmetry;

        std::vector<int> missing(mesh.triangles.size(), 0);
        for (const Singularity& s : singularitiesOf(mesh, any)) missing[s.triangle] -= s.turns;
        for (const SingularPlace& place : places) missing[mesh.first[place.vertex] / 3] += place.turns;
        for (size_t i = topology.order.size(); i-- > 0;) {
            const uint32_t t = topology.order[i], up = topology.upward[t];
            if (up == kNoIndex || missing[t] == 0) continue;
            add(up, step * missing[t]);
            if (mesh.twin[up] != kNoIndex) missing[mesh.twin[up] / 3] += missing[t];
        }
        for (const SingularPlace& place : places) shareOut(place, step, add);

        std::vector<EdgeNumber> all;
        for (uint32_t h = 0; h < number.size(); ++h)
            if (mesh.ownsEdge(h)) all.push_back({h, number[h]});
        return all;
    }
    // The first triangle around a vertex has all of its turns; now each gets the same part.
    template <class Add>
    void shareOut(const SingularPlace& place, double step, const Add& add) const {
        std::vector<uint32_t> corners;
        for (uint32_t h = mesh.first[place.vertex]; corners.empty() || h != corners[0];) {
            corners.push_back(h);
            h = mesh.twin[FieldMesh::previous(h)];
        }
        const double part = step * place.turns / double(corners.size());
        for (size_t i = 0; i + 1 < corners.size(); ++i)
            add(FieldMesh::previous(corners[i]), -part * double(corners.size() - 1 - i));
    }

    // The turns at vertices that make the numbers' sum of squares least. Around handles and holes the field turns by
    // the whole N-ths that are nearest to the least of all, whatever it was that the numbers began with.
    Vector smoothest(std::vector<EdgeNumber>& numbers, uint32_t symmetry) const {
        Vector turn = free.solve(pushOf(numbers, weight));
        if (around.empty()) return turn;
        std::vector<double> smooth(mesh.twin.size(), 0);
        for (const EdgeNumber& n : numbers) smooth[n.halfEdge] = smoothed(n, turn);
        Vector along(Eigen::Index(around.size()));
        for (size_t i = 0; i < around.size(); ++i) {
            double sum = 0;
            for (const EdgeNumber& n : topology.loops[i]) sum += weight[n.halfEdge] * n.number * smooth[n.halfEdge];
            along[Eigen::Index(i)] = sum;
        }
        const double step = 2 * std::numbers::pi / symmetry;
        const Vector best = loops.solve(along);
        for (size_t i = 0; i < around.size(); ++i) {
            const double less = step * std::round(best[Eigen::Index(i)] / step);
            turn -= less * around[i];
            for (const EdgeNumber& n : topology.loops[i])
                std::ranges::lower_bound(numbers, n.halfEdge, {}, &EdgeNumber::halfEdge)->number -= less * n.number;
        }
        return turn;
    }

    // Where triangles are bad the field may turn by more than half a turn along an edge, which no one could tell from a
    // singularity. Such edges are made stiffer until none is left. About a handle of a few triangles some always are:
    // as few edges can't hold the turns that it takes.
    void stiffen(const std::vector<EdgeNumber>& numbers, Vector& turn) {
        std::vector<bool> open(mesh.positions.size(), false);
        for (const SingularPlace& place : settledAt) open[place.vertex] = true;
        stiff = weight;
        for (int round = 0; round < kMostRounds; ++round) {
            bool any = false;
            for (const EdgeNumber& n : numbers) {
                if (open[mesh.from(n.halfEdge)] || open[mesh.to(n.halfEdge)]) continue;
                if (std::abs(smoothed(n, turn)) * settled.symmetry < kMostTurn) continue;
                stiff[n.halfEdge] *= kStiffer;
                any = true;
            }
            if (!any) break;
            const Factors factors(bonds(mesh, topology, stiff, nullptr));
            if (factors.info() != Eigen::Success) break;
            turn = factors.solve(pushOf(numbers, stiff));
        }
    }

    void settle(uint32_t symmetry, const std::vector<SingularPlace>& places, const std::function<Field()>& smooth) {
        const bool chosen = topology.loops.size() == around.size();
        if (chosen && settled.symmetry == symmetry && settledAt == places && !settled.power.empty()) return;
        settledAt = places;
        settled = chosen ? anyField(mesh, symmetry) : smooth();
        if (settled.power.empty()) settled = anyField(mesh, symmetry);
        std::vector<EdgeNumber> numbers = numbersFor(settled, places);
        Vector turn = smoothest(numbers, symmetry);
        stiffen(numbers, turn);
        turnBy(settled, turn);
    }

    // Each piece as a whole turns to what elements and the drift ask for.
    void turnPieces(Field& field, const Pull& pull) const {
        for (const MeshPiece& piece : topology.pieces) {
            Complex sum = 0;
            for (uint32_t v : piece.vertices) sum += pull.sum[v] * std::conj(field.power[v]);
            if (!(std::abs(sum) > 0)) continue;
            for (uint32_t v : piece.vertices) field.power[v] *= sum / std::abs(sum);
        }
    }

    // Bends the field to what the elements ask for. To wish for a sine of the angle between, beyond what the element's
    // whole surroundings wish for, tears the field nowhere, not even where both turn about places beside each other.
    bool bend(Field& field, const std::vector<AskedElement>& elements) {
        std::vector<double> pull(field.power.size(), 0);
        Vector push = Vector::Zero(Eigen::Index(field.power.size()));
        for (const AskedElement& asked : elements) {
            const FeltElement& felt = *asked.felt;
            const auto off = [&](size_t i) {
                return felt.wishes[i] * asked.turn * std::conj(field.power[felt.vertices[i]]);
            };
            Complex sum = 0;
            for (size_t i = 0; i < felt.vertices.size(); ++i) sum += felt.weights[i] * off(i);
            const double whole = std::arg(sum);
            for (size_t i = 0; i < felt.vertices.size(); ++i) {
                const double beyond = (off(i) * std::polar(1.0, -whole)).imag();
                pull[felt.vertices[i]] += felt.weights[i];
                push[felt.vertices[i]] += felt.weights[i] * (whole + beyond) / field.symmetry;
            }
        }
        if (pull != pulled || stiff != stiffened) {
            const bool known = !pulled.empty();
            pulled.clear();
            const Matrix matrix = bonds(mesh, topology, stiff, &pull);
            if (!known) held.analyzePattern(matrix);
            held.factorize(matrix);
            if (held.info() != Eigen::Success) return false;
            pulled = std::move(pull);
            stiffened = stiff;
        }
        turnBy(field, held.solve(push));
        return true;
    }
    static void turnBy(Field& field, const Vector& turn) {
        for (size_t v = 0; v < field.power.size(); ++v)
            field.power[v] *= std::polar(1.0, field.symmetry * turn[Eigen::Index(v)]);
    }
};

ExactField::ExactField(const FieldMesh& mesh) : state_(std::make_unique<State>(mesh)) {}
ExactField::~ExactField() = default;

Result<Field> ExactField::design(uint32_t symmetry, const std::vector<AskedElement>& elements, const Pull& all,
                                 const std::function<Field()>& smooth) {
    State& s = *state_;
    const Failure bad("field", "the mesh gives no exact field: its triangles are too bad");
    if (s.free.info() != Eigen::Success) return bad;
    Result<SingularPlaces> places = singularPlaces(s.mesh, s.topology, symmetry, elements, smooth);
    if (!places) return places.failure();
    s.settle(symmetry, places->all, smooth);
    Field field = s.settled;
    s.turnPieces(field, all);
    if (!elements.empty() && !s.bend(field, elements)) return bad;
    for (const SingularPlace& place : places->all) field.power[place.vertex] = 0;
    field.unasked = places->unasked;
    return field;
}

}  // namespace espalier
