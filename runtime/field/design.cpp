// Enters: elements and a drift. Leaves: the field's N-th power at vertices. Each vertex wants what elements near it
// and the drift say, as much as they are felt there, and to go on as its neighbours do: the sum of squares is least
// where a sparse linear system says so (Knöppel et al. 2013 §4, with a pull towards given values).
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

#include "runtime/field/field.hpp"
#include "runtime/field/polar_map.hpp"

namespace espalier {
namespace {

using Complex = std::complex<double>;
using Matrix = Eigen::SparseMatrix<Complex>;

constexpr double kElementPull = 40;   // of an element at its centre, against smoothness over its radius
constexpr double kDriftPull = 0.6;    // likewise, over the surface's radius
constexpr double kLeastPull = 1e-7;   // that leaves no vertex undetermined
constexpr double kFelt = 2.5;         // radii beyond which an element isn't felt

// What vertices are pulled to, and how strongly.
struct Pull {
    std::vector<double> weight;
    std::vector<Complex> sum;  // of wishes times weights
};

double cotangent(const FieldMesh& mesh, uint32_t h) {
    const uint32_t opposite = FieldMesh::previous(h);
    const glm::dvec3 at = mesh.positions[mesh.from(opposite)];
    const glm::dvec3 a = mesh.positions[mesh.from(h)] - at, b = mesh.positions[mesh.to(h)] - at;
    const double sine = glm::length(glm::cross(a, b));
    return sine > 0 ? std::clamp(glm::dot(a, b) / sine, -20.0, 20.0) : 0;
}

// Weights of edges are kept above zero, so that the energy has one least value whatever the triangles' shapes.
Matrix smoothness(const FieldMesh& mesh, uint32_t symmetry, const std::vector<double>& pull) {
    std::vector<Eigen::Triplet<Complex>> entries;
    entries.reserve(mesh.twin.size() * 2 + mesh.positions.size());
    for (uint32_t h = 0; h < mesh.twin.size(); ++h) {
        const uint32_t twin = mesh.twin[h];
        if (twin != kNoIndex && twin < h) continue;
        const double both = cotangent(mesh, h) + (twin != kNoIndex ? cotangent(mesh, twin) : 0);
        const double w = std::max(both / 2, .02);
        const int a = int(mesh.from(h)), b = int(mesh.to(h));
        const Complex along = std::polar(1.0, symmetry * mesh.transport(h));
        entries.emplace_back(a, a, w);
        entries.emplace_back(b, b, w);
        entries.emplace_back(b, a, -w * along);
        entries.emplace_back(a, b, -w * std::conj(along));
    }
    for (size_t v = 0; v < pull.size(); ++v) entries.emplace_back(int(v), int(v), pull[v]);
    Matrix matrix(int(mesh.positions.size()), int(mesh.positions.size()));
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

// Along the whole of the surface a little to where the design drifts.
void addDrift(const FieldMesh& mesh, const FieldDesign& design, Pull& pull) {
    const double length = glm::length(design.drift);
    if (!(design.lean > 0) || !(length > 0)) return;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::dvec3 wish = design.drift / length;
        const double steep = glm::length(wish - mesh.normals[v] * glm::dot(wish, mesh.normals[v]));
        const double w = design.lean * kDriftPull * steep * steep * mesh.areas[v] / (mesh.radius * mesh.radius);
        pull.weight[v] += w;
        pull.sum[v] += w * std::polar(1.0, design.symmetry * mesh.angleOf(v, wish));
    }
}

uint32_t nearestVertex(const FieldMesh& mesh, const glm::dvec3& place) {
    const auto distance = [&](const glm::dvec3& p) { return glm::dot(p - place, p - place); };
    const auto best = std::ranges::min_element(mesh.positions, {}, distance);
    return uint32_t(best - mesh.positions.begin());
}

// The angle that parallel transport from the centre adds along the shortest way to each vertex: it is handed on from the
// neighbour that the way passes nearest to.
std::vector<double> carriedAngles(const FieldMesh& mesh, const PolarMap& map) {
    std::vector<double> carried(mesh.positions.size(), 0);
    for (uint32_t v : map.reached) {
        if (map.distance[v] == 0) continue;
        double best = map.distance[v];
        uint32_t h = mesh.first[v];
        do {
            for (const uint32_t edge : {h, FieldMesh::previous(h)}) {
                const bool leaves = mesh.from(edge) == v;
                const uint32_t other = leaves ? mesh.to(edge) : mesh.from(edge);
                if (!(map.distance[other] < best)) continue;
                best = map.distance[other];
                carried[v] = carried[other] + (leaves ? -mesh.transport(edge) : mesh.transport(edge));
            }
            h = mesh.twin[FieldMesh::previous(h)];
        } while (h != kNoIndex && h != mesh.first[v]);
    }
    return carried;
}

// Around a singular element the field turns with the polar angle by the element's index.
void addElement(const FieldMesh& mesh, uint32_t symmetry, const FieldElement& element, Pull& pull) {
    const uint32_t centre = nearestVertex(mesh, element.position);
    const double radius = element.radius > 0 ? element.radius : mesh.radius / 10;
    const PolarMap map = polarMap(mesh, centre, kFelt * radius);
    const std::vector<double> carried = carriedAngles(mesh, map);
    const double index = indexOf(element.kind);
    const double direction = mesh.angleOf(centre, element.direction);
    const double quarter = element.kind == ElementKind::centre ? std::acos(-1.0) / 2 : 0;
    for (uint32_t v : map.reached) {
        const double d = map.distance[v] / radius;
        const double felt = std::exp(-d * d) * (index != 0 ? std::min(d * 4, 1.0) : 1);
        const double w = kElementPull * felt * mesh.areas[v] / (radius * radius);
        const double turned = direction + quarter + index * (map.angle[v] - direction);
        pull.weight[v] += w;
        pull.sum[v] += w * std::polar(1.0, symmetry * ((index != 0 ? turned : direction) + carried[v]));
    }
}

}  // namespace

Result<Field> designField(const FieldMesh& mesh, const FieldDesign& design) {
    if (mesh.triangles.empty()) return Failure("field", "the surface has no triangles to lay a field over");
    for (const FieldElement& element : design.elements)
        if (!fits(element.kind, design.symmetry))
            return Failure("field", "an element of half a turn needs a field of lines or crosses, not of vectors");
    const size_t count = mesh.positions.size();
    Pull pull{std::vector<double>(count, 0), std::vector<Complex>(count, 0)};
    for (uint32_t v = 0; v < count; ++v) {
        pull.weight[v] = kLeastPull;
        pull.sum[v] = kLeastPull;
    }
    addDrift(mesh, design, pull);
    for (const FieldElement& element : design.elements) addElement(mesh, design.symmetry, element, pull);

    const Matrix matrix = smoothness(mesh, design.symmetry, pull.weight);
    Eigen::SimplicialLDLT<Matrix> solver(matrix);
    if (solver.info() != Eigen::Success) return Failure("field", "the mesh gives no field: its triangles are too bad");
    const Eigen::Map<const Eigen::VectorXcd> right(pull.sum.data(), Eigen::Index(count));
    const Eigen::VectorXcd solved = solver.solve(right);

    Field field;
    field.symmetry = design.symmetry;
    field.power.resize(count);
    field.mean.assign(count, 0);
    field.deviator.assign(count, 1);
    for (size_t v = 0; v < count; ++v) {
        const Complex z = solved[Eigen::Index(v)];
        const double length = std::abs(z);
        field.power[v] = length > 1e-300 && std::isfinite(length) ? z / length : Complex(1);
    }
    return field;
}

}  // namespace espalier
