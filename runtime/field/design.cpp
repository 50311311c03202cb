// Enters: elements and a drift. Leaves: the field's N-th power at vertices. Each vertex wants what elements near it
// and the drift say, as much as they are felt there, and to go on as its neighbours do: the sum of squares is least
// where a sparse linear system says so (Knöppel et al. 2013 §4, with a pull towards given values). Samples hold their
// vertices; strokes of brushes come last.
#include <Eigen/Sparse>
#include <cmath>
#include <optional>

#include "runtime/field/element_pull.hpp"
#include "runtime/field/exact_field.hpp"
#include "runtime/field/field_solver.hpp"
#include "runtime/field/field_strokes.hpp"
#include "runtime/field/summed_field.hpp"

namespace espalier {
namespace {

using Complex = std::complex<double>;
using Matrix = Eigen::SparseMatrix<Complex>;

constexpr double kLeastPull = 1e-7;  // that leaves no vertex undetermined
constexpr double kSampleHold = 1e4;  // of a sample on its vertex, against bonds of edges of about 1

Matrix smoothness(const FieldMesh& mesh, uint32_t symmetry, const std::vector<double>& pull) {
    std::vector<Eigen::Triplet<Complex>> entries;
    entries.reserve(mesh.twin.size() * 2 + mesh.positions.size());
    for (uint32_t h = 0; h < mesh.twin.size(); ++h) {
        if (!mesh.ownsEdge(h)) continue;
        const double w = mesh.edgeWeight(h);
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

bool sameBelowStrokes(const FieldDesign& a, const FieldDesign& b) {
    return a.symmetry == b.symmetry && a.elements == b.elements && a.drift == b.drift && a.lean == b.lean &&
           a.exact == b.exact && a.samples == b.samples && a.summed == b.summed && a.passes == b.passes;
}

Failure tooBad() {
    return Failure("field", "the mesh gives no field: its triangles are too bad");
}

}  // namespace

struct FieldSolver::State {
    const FieldMesh& mesh;
    uint32_t symmetry = 0;
    FeltElements felt;
    FieldDesign drifting;  // whose drift, lean and symmetry `drift` is of
    std::optional<Pull> drift;
    std::vector<double> weight;  // that the factors are of
    Eigen::SimplicialLDLT<Matrix> factors;
    std::optional<ExactField> exact;
    std::shared_ptr<const FieldSamples> samples;  // that `sampled` is of
    SampledVertices sampled;
    std::optional<FieldDesign> made;  // but for its strokes: what `plain` is of
    Field plain;
    FieldStrokes strokes;

    explicit State(const FieldMesh& of) : mesh(of), strokes(of) {}

    void take(uint32_t wanted) {
        if (symmetry == wanted) return;
        symmetry = wanted;
        felt = {};
        weight.clear();
        samples.reset();
    }
    bool factorise(const std::vector<double>& pull) {
        if (pull == weight) return true;
        const bool known = !weight.empty();  // then the matrix has the same entries, with other values
        weight.clear();
        const Matrix matrix = smoothness(mesh, symmetry, pull);
        if (!known) factors.analyzePattern(matrix);
        factors.factorize(matrix);
        if (factors.info() != Eigen::Success) return false;
        weight = pull;
        return true;
    }
    const Pull& driftOf(const FieldDesign& design) {
        if (drift && drifting.symmetry == design.symmetry && drifting.drift == design.drift &&
            drifting.lean == design.lean)
            return *drift;
        drift.emplace(mesh.positions.size());
        addDrift(mesh, design, *drift);
        for (double& w : drift->weight) w += kLeastPull;
        for (Complex& sum : drift->sum) sum += kLeastPull;
        drifting = design;
        return *drift;
    }
    Status sample(const FieldDesign& design) {
        if (!design.samples || samples == design.samples) return Done{};
        Result<SampledVertices> taken = sampleVertices(mesh, *design.samples, symmetry);
        if (!taken) return taken.failure();
        sampled = std::move(*taken);
        samples = design.samples;
        return Done{};
    }
    // Where elements are felt most, samples leave the field to them.
    void hold(const std::vector<AskedElement>& elements, Pull& pull) const {
        std::vector<bool> left(mesh.positions.size(), false);
        for (const AskedElement& asked : elements)
            for (size_t i = 0; i < asked.felt->within; ++i) left[asked.felt->vertices[i]] = true;
        for (size_t v = 0; v < left.size(); ++v) {
            if (left[v] || sampled.wish[v] == 0.0) continue;
            pull.weight[v] += kSampleHold;
            pull.sum[v] += kSampleHold * sampled.wish[v];
        }
    }
    // Empty: the triangles are too bad.
    Field smooth(const Pull& pull) {
        if (!factorise(pull.weight)) return {};
        const size_t count = mesh.positions.size();
        const Eigen::Map<const Eigen::VectorXcd> right(pull.sum.data(), Eigen::Index(count));
        const Eigen::VectorXcd solved = factors.solve(right);
        Field field;
        field.symmetry = symmetry;
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

    Result<Field> withoutStrokes(const FieldDesign& design) {
        if (mesh.triangles.empty()) return Failure("field", "the surface has no triangles to lay a field over");
        for (const FieldElement& element : design.elements)
            if (!fits(element.kind, design.symmetry))
                return Failure("field", "an element of half a turn needs a field of lines or crosses, not of vectors");
        take(design.symmetry);
        felt.keepOnly(design.elements);
        Pull all = driftOf(design);
        std::vector<AskedElement> asked;
        for (const FieldElement& element : design.elements) {
            asked.push_back(askedElement(mesh, symmetry, felt.of(mesh, symmetry, element), element));
            addElement(asked.back(), all);
        }
        if (Status taken = sample(design); !taken) return taken.failure();
        if (design.samples) hold(asked, all);
        Result<Field> field = solved(design, asked, all);
        if (!field || !design.samples) return field;
        field->mean = sampled.mean;
        field->deviator = sampled.deviator;
        field->unsampled = mesh.positions.size() - sampled.near;
        return field;
    }
    Result<Field> solved(const FieldDesign& design, const std::vector<AskedElement>& asked, const Pull& all) {
        if (design.summed) return summedField(mesh, symmetry, all, design.passes);
        if (design.exact) {
            if (!exact) exact.emplace(mesh);
            return exact->design(symmetry, asked, all, [&] { return smooth(all); });
        }
        Field field = smooth(all);
        if (field.power.empty()) return tooBad();
        return field;
    }
};

FieldSolver::FieldSolver(const FieldMesh& mesh) : state_(std::make_unique<State>(mesh)) {}
FieldSolver::~FieldSolver() = default;

Result<Field> FieldSolver::design(const FieldDesign& design) {
    State& s = *state_;
    if (!s.made || !sameBelowStrokes(*s.made, design)) {
        s.made.reset();
        Result<Field> plain = s.withoutStrokes(design);
        if (!plain) return plain;
        s.plain = std::move(*plain);
        s.made = design;
        s.made->strokes.clear();
    }
    if (design.strokes.empty()) return s.plain;
    Field field = s.plain;
    if (Status laid = s.strokes.lay(design.strokes, field); !laid) return laid.failure();
    return field;
}

Result<Field> designField(const FieldMesh& mesh, const FieldDesign& design) {
    return FieldSolver(mesh).design(design);
}

}  // namespace espalier
