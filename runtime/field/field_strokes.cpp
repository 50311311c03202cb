// Enters: strokes, as points on the surface. Leaves: a field with other directions under them. Each step of a stroke is
// felt in a disc. Combing mixes N-th powers with the step's direction, transported in parallel; so all combing of a
// vertex together is a share of the field below and a sum laid over it. Smoothing adds to an area over which a vertex
// relaxes: at the end one sparse solve lets the field diffuse where that isn't 0, for one implicit step.
#include "runtime/field/field_strokes.hpp"

#include <Eigen/Sparse>
#include <cmath>

#include "runtime/field/element_pull.hpp"
#include "runtime/field/polar_map.hpp"
#include "runtime/surface/box_tree.hpp"

namespace espalier {
namespace {

using Complex = std::complex<double>;
using glm::dvec3;

constexpr double kMostStep = .5;  // radii; points farther from each other leave gaps
constexpr double kClick = .25;    // radii: what the first place of a smoothing stroke counts as
constexpr double kWayThrough =
    15.0 / 16;                      // the falloff below, summed along a way through the middle, is a radius over this
constexpr double kLeastLeft = .02;  // of what was below a stroke of full strength
constexpr double kRelaxed = .25;    // radius², by one stroke of full strength
constexpr double kLeastRelaxed = 1e-4;  // of a vertex's own area: less of it moves nothing
constexpr double kMostRelaxed = 100;    // radius² of the mesh: with more of it the system loses its digits

// What a stroke does at a vertex.
struct Touch {
    uint32_t vertex = 0;
    double keep = 1;   // the share of what was below,
    Complex laid = 0;  // and what is laid over it
    double relax = 0;  // m²
};

struct Layer {
    FieldStroke stroke;
    size_t laid = 0;  // of its points
    size_t felt = 0;  // by vertices: each counts once for each point
    std::vector<Touch> touches;
};

// `longer` begins as `stroke` does.
bool continues(const FieldStroke& longer, const FieldStroke& stroke) {
    return longer.brush == stroke.brush && longer.radius == stroke.radius && longer.strength == stroke.strength &&
           longer.points.size() >= stroke.points.size() &&
           std::equal(stroke.points.begin(), stroke.points.end(), longer.points.begin());
}

}  // namespace

struct FieldStrokes::State {
    const FieldMesh& mesh;
    const size_t mostFelt;
    uint32_t symmetry = 0;
    BoxTree vertices;  // empty until a stroke has points
    std::vector<Layer> layers;
    // Of the layer in hand:
    std::vector<uint32_t> place;  // [vertex]: in its touches; kNoIndex: it has none
    PolarMap map;                 // of its last point
    std::vector<double> carried;

    State(const FieldMesh& of, size_t most) : mesh(of), mostFelt(most) {}

    void begin() {
        if (!vertices.empty()) return;
        std::vector<Box> boxes(mesh.positions.size());
        for (size_t v = 0; v < boxes.size(); ++v) boxes[v].add(mesh.positions[v]);
        vertices = BoxTree(std::move(boxes), {});
    }

    Touch& touch(Layer& layer, uint32_t vertex) {
        if (place[vertex] == kNoIndex) {
            place[vertex] = uint32_t(layer.touches.size());
            layer.touches.push_back({vertex});
        }
        return layer.touches[place[vertex]];
    }

    uint32_t nearest(const dvec3& at) const {
        uint32_t found = 0;
        double least = std::numeric_limits<double>::infinity();
        vertices.nearestSquare(at, [&](uint32_t v) {
            const dvec3 way = mesh.positions[v] - at;
            const double square = glm::dot(way, way);
            if (square < least) least = square, found = v;
            return square;
        });
        return found;
    }

    // One step of a stroke ends at a place. steps: its length in radii. turn: the N-th power of its direction there.
    void dab(Layer& layer, uint32_t centre, double steps, Complex turn) {
        const FieldStroke& stroke = layer.stroke;
        const double radius = stroke.radius > 0 ? stroke.radius : mesh.radius / 10;
        const bool combs = stroke.brush == FieldBrush::comb;
        polarMap(mesh, centre, radius, map);
        if (combs) carryAngles(mesh, map, carried);
        layer.felt += map.reached.size();
        for (const uint32_t v : map.reached) {
            const double d = map.distance[v] / radius, falloff = (1 - d * d) * (1 - d * d);
            const double felt = kWayThrough * falloff * steps;
            Touch& touched = touch(layer, v);
            if (!combs) {
                touched.relax += kRelaxed * stroke.strength * felt * radius * radius;
                continue;
            }
            const double keep = std::pow(std::max(1 - stroke.strength, kLeastLeft), felt);
            touched.laid = keep * touched.laid + (1 - keep) * turn * std::polar(1.0, symmetry * carried[v]);
            touched.keep *= keep;
        }
    }

    void layPoint(Layer& layer) {
        const FieldStroke& stroke = layer.stroke;
        const double radius = stroke.radius > 0 ? stroke.radius : mesh.radius / 10;
        const dvec3 at(stroke.points[layer.laid]);
        const dvec3 way = layer.laid > 0 ? at - dvec3(stroke.points[layer.laid - 1]) : dvec3(0);
        const uint32_t centre = nearest(at);
        const double steps = std::min(glm::length(way) / radius, kMostStep);
        if (stroke.brush == FieldBrush::smooth) return dab(layer, centre, layer.laid > 0 ? steps : kClick, 1);
        const dvec3 normal = mesh.normals[centre], flat = way - normal * glm::dot(way, normal);
        if (glm::length(flat) > 1e-9 * mesh.radius)
            dab(layer, centre, steps, std::polar(1.0, symmetry * mesh.angleOf(centre, flat)));
    }

    // The points from `layer.laid` on, as long as no more is felt than may be.
    void goOn(Layer& layer, size_t mayBeFelt) {
        if (layer.laid == layer.stroke.points.size()) return;
        begin();
        place.assign(mesh.positions.size(), kNoIndex);
        for (uint32_t i = 0; i < layer.touches.size(); ++i) place[layer.touches[i].vertex] = i;
        for (; layer.laid < layer.stroke.points.size() && layer.felt <= mayBeFelt; ++layer.laid) layPoint(layer);
    }

    Status keepUp(const std::vector<FieldStroke>& strokes, uint32_t wanted) {
        if (symmetry != wanted) layers.clear();
        symmetry = wanted;
        layers.resize(strokes.size());
        size_t left = mostFelt;
        for (size_t i = 0; i < strokes.size(); ++i) {
            Layer& layer = layers[i];
            if (!continues(strokes[i], layer.stroke)) layer = {};
            layer.stroke = strokes[i];
            goOn(layer, left);
            if (layer.felt > left)
                return Failure("field",
                               "with stroke " + std::to_string(i) + " the strokes are felt by more than " +
                                   std::to_string(mostFelt) +
                                   " vertices, each counted for each point of a stroke; lay fewer or smaller ones");
            left -= layer.felt;
        }
        return Done{};
    }

    // The field diffuses; around the places that relax it stays. relax: [vertex], m².
    bool relaxField(const std::vector<double>& relax, Field& field) const {
        std::vector<uint32_t> free;
        std::vector<int> row(relax.size(), -1);
        for (uint32_t v = 0; v < relax.size(); ++v)
            if (relax[v] > kLeastRelaxed * mesh.areas[v] && mesh.areas[v] > 0) {
                row[v] = int(free.size());
                free.push_back(v);
            }
        if (free.empty()) return true;
        std::vector<Eigen::Triplet<Complex>> entries;
        Eigen::VectorXcd right(Eigen::Index(free.size()));
        for (const uint32_t v : free) {
            const double hold = mesh.areas[v] / std::min(relax[v], kMostRelaxed * mesh.radius * mesh.radius);
            entries.emplace_back(row[v], row[v], hold);
            right[row[v]] = hold * field.power[v];
        }
        for (uint32_t h = 0; h < mesh.twin.size(); ++h) {
            const uint32_t a = mesh.from(h), b = mesh.to(h);
            if (!mesh.ownsEdge(h) || (row[a] < 0 && row[b] < 0)) continue;
            const double w = mesh.edgeWeight(h);
            const Complex along = std::polar(1.0, symmetry * mesh.transport(h));
            if (row[a] >= 0) entries.emplace_back(row[a], row[a], w);
            if (row[b] >= 0) entries.emplace_back(row[b], row[b], w);
            if (row[a] >= 0 && row[b] >= 0) {
                entries.emplace_back(row[b], row[a], -w * along);
                entries.emplace_back(row[a], row[b], -w * std::conj(along));
            } else if (row[a] >= 0) {
                right[row[a]] += w * std::conj(along) * field.power[b];
            } else {
                right[row[b]] += w * along * field.power[a];
            }
        }
        Eigen::SparseMatrix<Complex> matrix(int(free.size()), int(free.size()));
        matrix.setFromTriplets(entries.begin(), entries.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<Complex>> factors(matrix);
        if (factors.info() != Eigen::Success) return false;
        const Eigen::VectorXcd solved = factors.solve(right);
        for (const uint32_t v : free) setDirection(field.power[v], solved[row[v]]);
        return true;
    }

    static void setDirection(Complex& power, Complex to) {
        const double length = std::abs(to);
        if (length > 1e-300 && std::isfinite(length)) power = to / length;
    }
};

FieldStrokes::FieldStrokes(const FieldMesh& mesh, size_t mostFelt) : state_(std::make_unique<State>(mesh, mostFelt)) {}
FieldStrokes::~FieldStrokes() = default;

Status FieldStrokes::lay(const std::vector<FieldStroke>& strokes, Field& field) {
    State& s = *state_;
    if (Status kept = s.keepUp(strokes, field.symmetry); !kept) return kept;
    const size_t count = field.power.size();
    std::vector<double> keep(count, 1), relax(count, 0);
    std::vector<Complex> laid(count, 0);
    for (const Layer& layer : s.layers)
        for (const Touch& touch : layer.touches) {
            keep[touch.vertex] *= touch.keep;
            laid[touch.vertex] = laid[touch.vertex] * touch.keep + touch.laid;
            relax[touch.vertex] = relax[touch.vertex] * touch.keep + touch.relax;
        }
    for (size_t v = 0; v < count; ++v)
        if (keep[v] < 1) State::setDirection(field.power[v], keep[v] * field.power[v] + laid[v]);
    if (!s.relaxField(relax, field))
        return Failure("field", "the triangles under strokes that smooth are too bad to be smoothed over");
    return Done{};
}

}  // namespace espalier
