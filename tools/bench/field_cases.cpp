// field/…: a field of ten elements on the bunny, from nothing and after one of them turned; beside it the way of the
// paper, a sum of radial basis functions and Laplacian smoothing (Li 2011 §4.2). The same with strokes of brushes over
// the field, and held by vectors of another program. CPU time of all threads.
#include <cmath>

#include "runtime/field/field_picture.hpp"
#include "runtime/field/field_solver.hpp"
#include "runtime/field/field_texels.hpp"
#include "tools/bake/bake.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {
namespace {

constexpr uint32_t kResolution = 512;
constexpr uint32_t kPasses = 300;  // of the paper's smoothing

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
Field summed(const FieldMesh& mesh, FieldDesign design) {
    design.exact = false;
    design.summed = true;
    design.passes = kPasses;
    return *designField(mesh, design);
}

// Fifty strokes of twenty places each, along edges from places that are spread over the mesh; every fifth smooths.
std::vector<FieldStroke> fiftyStrokes(const FieldMesh& mesh) {
    std::vector<FieldStroke> strokes;
    for (size_t i = 0; i < 50; ++i) {
        FieldStroke& stroke = strokes.emplace_back();
        stroke.brush = i % 5 == 4 ? FieldBrush::smooth : FieldBrush::comb;
        uint32_t h = mesh.first[mesh.positions.size() * i / 50];
        while (stroke.points.size() < 20) {
            stroke.points.emplace_back(mesh.positions[mesh.from(h)]);
            for (int k = 0; k < 4; ++k) {
                const uint32_t over = mesh.twin[FieldMesh::next(h)];
                if (over != kNoIndex) h = FieldMesh::next(over);
            }
        }
    }
    return strokes;
}

void strokeRows(Bench& bench, const FieldBench& field, const std::function<double(const std::function<void()>&)>& of) {
    const FieldSampling sampling(field.surface, field.mesh);
    FieldSolver solver(field.mesh);
    FieldDesign design = field.design(false);
    std::vector<FieldTexel> texels;
    const auto make = [&](FieldSolver& by) {
        if (Result<Field> made = by.design(design)) texels = sampling.texels(*made);
    };
    make(solver);
    const double bare = of([&] {
        design.elements[0].direction.y += .1;
        make(solver);
    });
    design.strokes = fiftyStrokes(field.mesh);
    const double first = of([&] {
        FieldSolver another(field.mesh);
        make(another);
    });
    make(solver);
    FieldStroke& last = design.strokes.back();
    size_t step = 0;
    const double longer = of([&] {
        last.points.push_back(last.points[++step % 20]);
        make(solver);
    });
    const double turned = of([&] {
        design.elements[0].direction.y += .1;
        make(solver);
    });
    FieldPicture picture;
    Field before = *solver.design(design);
    const double whole = of([&] { picture = fieldPicture(field.surface, field.mesh, before); });
    const double shown = of([&] {
        last.points.push_back(last.points[++step % 20]);
        Field now = *solver.design(design);
        updateFieldPicture(field.surface, field.mesh, before, now, picture);
        before = std::move(now);
    });
    bench.add({"field/strokes/seen", "a stroke goes on, to the picture of the field", "ms", shown, "the whole picture",
               whole});
    bench.add({"field/strokes/step", "a stroke goes on over 50 others, to texels", "ms", longer, "all anew", first});
    bench.add({"field/strokes/turned", "an element turned below 50 strokes, to texels", "ms", turned, "without strokes",
               bare});
}

void sampleRows(Bench& bench, const FieldBench& field, const std::function<double(const std::function<void()>&)>& of) {
    auto samples = std::make_shared<FieldSamples>();
    for (const glm::dvec3& p : field.mesh.positions) {
        samples->points.emplace_back(p);
        samples->vectors.emplace_back(glm::cross(glm::vec3(0, 1, 0), glm::vec3(p)));
    }
    FieldDesign design;
    const double drifting = of([&] { (void)designField(field.mesh, design); });
    design.samples = samples;
    const double held = of([&] { (void)designField(field.mesh, design); });
    bench.add({"field/samples/first", "vectors at all vertices", "ms", held, "the drift alone", drifting});
}

}  // namespace

void fieldCases(Bench& bench) {
    const std::string group = "field/";
    if (!bench.wants(group + "smooth") && !bench.wants(group + "exact") && !bench.wants(group + "strokes") &&
        !bench.wants(group + "samples"))
        return;
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
    if (bench.wants(group + "strokes")) strokeRows(bench, field, medianOf);
    if (bench.wants(group + "samples")) sampleRows(bench, field, medianOf);
}

}  // namespace espalier
