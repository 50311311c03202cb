// Enters: strokes, as points on the surface. Leaves: a field with other directions under them. Each step of a stroke is
// felt in a disc. Combing mixes N-th powers with the step's direction, transported in parallel; so all combing of a
// vertex together is a share of the field below and a sum laid over it. Smoothing adds to an area over which a vertex
// relaxes: at the end one sparse solve lets the field diffuse where that isn't 0, for one implicit step.
#include "runtime/field/field_strokes.hpp"

#include <Eigen/Sparse>
#include <cmath>
#include <unordered_map>

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
    std::vector<Touch> touches;
    std::unordered_map<uint32_t, size_t> at;  // [vertex]: place in touches

    Touch& touch(uint32_t vertex) {
        const auto [found, fresh] = at.try_emplace(vertex, touches.size());
        if (fresh) touches.push_back({vertex});
        return touches[found->second];
    }
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
    uint32_t symmetry = 0;
    BoxTree vertices;
    std::vector<Layer> layers;

    explicit State(const FieldMesh& of) : mesh(of) {
        std::vector<Box> boxes(mesh.positions.size());
        for (size_t v = 0; v < boxes.size(); ++v) boxes[v].add(mesh.positions[v]);
        vertices = BoxTree(std::move(boxes), {});
    }

    uint32_t nearest(const dvec3& place) const {
        uint32_t found = 0;
        double least = std::numeric_limits<double>::infinity();
        vertices.nearestSquare(place, [&](uint32_t v) {
            const dvec3 way = mesh.positions[v] - place;
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
        const PolarMap map = polarMap(mesh, centre, radius);
        const std::vector<double> carried = combs ? carriedAngles(mesh, map) : std::vector<double>();
        for (const uint32_t v : map.reached) {
            const double d = map.distance[v] / radius, falloff = (1 - d * d) * (1 - d * d);
            const double felt = kWayThrough * falloff * steps;
            Touch& touch = layer.touch(v);
            if (!combs) {
                touch.relax += kRelaxed * stroke.strength * felt * radius * radius;
                continue;
            }
            const double keep = std::pow(std::max(1 - stroke.strength, kLeastLeft), felt);
            touch.laid = keep * touch.laid + (1 - keep) * turn * std::polar(1.0, symmetry * carried[v]);
            touch.keep *= keep;
        }
    }

    // The points from `layer.laid` on.
    void goOn(Layer& layer) {
        const FieldStroke& stroke = layer.stroke;
        const double radius = stroke.radius > 0 ? stroke.radius : mesh.radius / 10;
        for (; layer.laid < stroke.points.size(); ++layer.laid) {
            const dvec3 at(stroke.points[layer.laid]);
            const dvec3 way = layer.laid > 0 ? at - dvec3(stroke.points[layer.laid - 1]) : dvec3(0);
            const uint32_t centre = nearest(at);
            if (stroke.brush == FieldBrush::smooth) {
                const double steps = layer.laid > 0 ? std::min(glm::length(way) / radius, kMostStep) : kClick;
                dab(layer, centre, steps, 1);
                continue;
            }
            const dvec3 normal = mesh.normals[centre], flat = way - normal * glm::dot(way, normal);
            if (glm::length(flat) > 1e-9 * mesh.radius)
                dab(layer, centre, std::min(glm::length(way) / radius, kMostStep),
                    std::polar(1.0, symmetry * mesh.angleOf(centre, flat)));
        }
    }

    void keepUp(const std::vector<FieldStroke>& strokes, uint32_t wanted) {
        if (symmetry != wanted) layers.clear();
        symmetry = wanted;
        layers.resize(strokes.size());
        for (size_t i = 0; i < strokes.size(); ++i) {
            if (!continues(strokes[i], layers[i].stroke)) layers[i] = {};
            layers[i].stroke = strokes[i];
            goOn(layers[i]);
        }
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
            const double hold = mesh.areas[v] / relax[v];
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

FieldStrokes::FieldStrokes(const FieldMesh& mesh) : state_(std::make_unique<State>(mesh)) {}
FieldStrokes::~FieldStrokes() = default;

bool FieldStrokes::lay(const std::vector<FieldStroke>& strokes, Field& field) {
    State& s = *state_;
    s.keepUp(strokes, field.symmetry);
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
    return s.relaxField(relax, field);
}

}  // namespace espalier
