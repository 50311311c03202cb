// field/…: a field of ten elements on the bunny, from nothing and after one of them turned; beside it the way of the
// paper, a sum of radial basis functions and Laplacian smoothing (Li 2011 §4.2). CPU time of all threads.
#include <cmath>

#include "runtime/field/element_pull.hpp"
#include "runtime/field/field_solver.hpp"
#include "runtime/field/field_texels.hpp"
#include "tools/bake/bake.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {
namespace {

constexpr uint32_t kResolution = 512;
constexpr int kPasses = 300;  // of the paper's smoothing

struct FieldBench {
    SurfaceData surface;
    FieldMesh mesh;

    Status begin(const std::string& model) {
        Result<Model> imported = importModel(model);
        if (!imported) return imported.failure();
        BakeOptions options;
        options.resolution = kResolution;
        Result<Baked> baked = bake(*imported, options);
        if (!baked) return baked.failure();
        surface = std::move(baked->surface);
        mesh = makeFieldMesh(surface);
        return Done{};
    }

    FieldDesign design(bool exact) const {
        constexpr ElementKind kKinds[] = {ElementKind::wedge, ElementKind::regular, ElementKind::trisector,
                                          ElementKind::wedge, ElementKind::node};
        FieldDesign design;
        design.exact = exact;
        for (size_t i = 0; i < 10; ++i)
            design.elements.push_back(
                {kKinds[i % 5], mesh.positions[mesh.positions.size() * (2 * i + 1) / 20], {1, .2, .1}});
        return design;
    }
};

// What the paper does with the same elements.
Field summed(const FieldMesh& mesh, const FieldDesign& design) {
    Pull pull(mesh.positions.size());
    FeltElements felt;
    for (const FieldElement& e : design.elements)
        addElement(askedElement(mesh, design.symmetry, felt.of(mesh, design.symmetry, e), e), pull);
    addDrift(mesh, design, pull);
    std::vector<std::complex<double>> along(mesh.twin.size());
    for (uint32_t h = 0; h < along.size(); ++h) along[h] = std::polar(1.0, design.symmetry * mesh.transport(h));
    std::vector<std::complex<double>> power = pull.sum;
    for (int pass = 0; pass < kPasses; ++pass) {
        std::vector<std::complex<double>> next = power;
        for (uint32_t h = 0; h < along.size(); ++h) next[mesh.to(h)] += power[mesh.from(h)] * along[h];
        for (auto& z : next) z = std::abs(z) > 0 ? z / std::abs(z) : 1;
        power = std::move(next);
    }
    Field field;
    field.symmetry = design.symmetry;
    field.power = std::move(power);
    return field;
}

}  // namespace

void fieldCases(Bench& bench) {
    const std::string group = "field/";
    if (!bench.wants(group + "smooth") && !bench.wants(group + "exact")) return;
    FieldBench field;
    const std::string model = bench.options().dataFolder + "/derived/bunny_unwrap.glb";
    if (Status begun = field.begin(model); !begun) return bench.skip(group, "needs " + model);
    const FieldSampling sampling(field.surface, field.mesh);
    const auto medianOf = [&](const std::function<void()>& work) {
        std::vector<double> all;
        for (int i = 0; i < bench.options().repeats; ++i) all.push_back(1e3 * cpuSeconds(work));
        return median(all);
    };
    for (const bool exact : {false, true}) {
        const std::string row = group + (exact ? "exact" : "smooth");
        if (!bench.wants(row)) continue;
        FieldDesign design = field.design(exact);
        size_t got = 0, paper = 0;
        const double first = medianOf([&] {
            Result<Field> made = designField(field.mesh, design);
            if (made) got = singularitiesOf(field.mesh, *made).size();
        });
        const double sum = medianOf([&] { paper = singularitiesOf(field.mesh, summed(field.mesh, design)).size(); });
        bench.add({row + "/first", "a field of ten elements", "ms", first, "RBF and 300 passes", sum});
        bench.add({row + "/singularities", "of the field", "places", double(got), "RBF and 300 passes", double(paper)});
        FieldSolver solver(field.mesh);
        std::vector<FieldTexel> texels;
        int step = 0;
        const auto turn = [&](FieldSolver& by) {
            design.elements[0].direction = {1, .1 * ++step, 0};
            if (Result<Field> made = by.design(design)) texels = sampling.texels(*made);
        };
        turn(solver);
        const double kept = medianOf([&] { turn(solver); });
        const double anew = medianOf([&] {
            FieldSolver another(field.mesh);
            turn(another);
        });
        bench.add({row + "/turned", "an element turned, to texels", "ms", kept, "all anew", anew});
    }
}

}  // namespace espalier
