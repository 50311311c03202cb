// Fields that were computed elsewhere: formulas on the plane, sphere and torus, sampled at points, and read back from
// texels.
#include <doctest/doctest.h>

#include <random>

#include "runtime/field/field_solver.hpp"
#include "runtime/field/triangle_weights.hpp"
#include "tests/field/baked_shapes.hpp"

using namespace espalier;

namespace {

using glm::dvec3;
using Formula = std::function<dvec3(const dvec3&)>;

constexpr double kLarge = 2, kSmall = .7;

dvec3 onPlane(const dvec3& p) {
    const double angle = std::sin(2 * p.x) + .5 * p.z;
    return (1 + p.x * p.x / 4) * dvec3(std::cos(angle), 0, -std::sin(angle));
}
// About an axis; 0 at its poles.
dvec3 onSphere(const dvec3& p) {
    return glm::cross(glm::normalize(dvec3(.2, 1, .1)), p);
}
// A spiral that leans to and fro.
dvec3 onTorus(const dvec3& p) {
    const double a = std::atan2(-p.z, p.x), angle = .6 + .3 * std::sin(2 * a);
    const dvec3 round(-std::sin(a), 0, -std::cos(a)), middle(kLarge * std::cos(a), 0, -kLarge * std::sin(a));
    const dvec3 out = glm::normalize(p - middle), across = glm::cross(out, round);
    return std::cos(angle) * round + std::sin(angle) * across;
}

FieldSamples sampled(const std::vector<glm::vec3>& points, const Formula& formula) {
    FieldSamples samples{points, {}, {}};
    for (const glm::vec3& p : points) samples.vectors.emplace_back(formula(p));
    return samples;
}

FieldDesign holding(FieldSamples samples, uint32_t symmetry) {
    FieldDesign design;
    design.symmetry = symmetry;
    design.samples = std::make_shared<FieldSamples>(std::move(samples));
    return design;
}

struct Errors {
    std::vector<double> degrees, lengths;
    double median() const { return medianOf(degrees); }
    double most() const { return *std::ranges::max_element(degrees); }
};

// Of all texels at which the formula isn't about 0.
Errors errorsOf(const BakedShape& shape, const FieldDesign& design, const Formula& formula) {
    Result<Field> field = designField(shape.mesh, design);
    REQUIRE(field);
    const std::vector<FieldTexel> texels = FieldSampling(shape.surface, shape.mesh).texels(*field);
    Errors errors;
    shape.eachTexel([&](size_t i, const dvec3& place, const dvec3& normal) {
        const dvec3 truth = formula(place);
        if (glm::length(truth) < .3) return;
        errors.degrees.push_back(
            degreesOff(dvec3(unpackOct(texels[i].direction)), truth, normal, design.symmetry % 2 == 0));
        errors.lengths.push_back(std::abs(double(texels[i].deviator) / glm::length(truth) - 1));
    });
    REQUIRE(errors.degrees.size() > 10000);
    return errors;
}

}  // namespace

TEST_CASE("vectors at a model's vertices come back from texels as the formula that they are of") {
    const struct {
        const char* name;
        std::vector<dvec3> corners;
        Formula formula;
        double median, most;
    } rows[] = {{"plane", planeCorners(2, 40), onPlane, .05, .1},
                {"sphere", sphereCorners(1, 24), onSphere, .03, .8},
                {"torus", torusCorners(kLarge, kSmall), onTorus, .04, .2}};
    for (const auto& row : rows)
        for (const uint32_t symmetry : {1u, 2u}) {
            const BakedShape shape(row.corners, 256);
            const Errors errors = errorsOf(shape, holding(sampled(shape.places, row.formula), symmetry), row.formula);
            CAPTURE(row.name);
            CAPTURE(errors.median());
            CAPTURE(errors.most());
            CHECK(errors.median() < row.median);
            CHECK(errors.most() < row.most);
            CHECK(medianOf(errors.lengths) < .001);
        }
}

TEST_CASE("a model that is baked again finds every point of its field by the point's position") {
    std::vector<double> medians;
    for (const uint32_t resolution : {256u, 512u}) {
        const BakedShape shape(torusCorners(kLarge, kSmall), resolution);
        const FieldDesign design = holding(sampled(shape.places, onTorus), 1);
        const Result<Field> field = designField(shape.mesh, design);
        REQUIRE(field);
        CHECK(field.value().unsampled == 0);
        medians.push_back(errorsOf(shape, design, onTorus).median());
    }
    CHECK(medians[0] < .04);
    CHECK(medians[1] < .04);
}

TEST_CASE("vectors of another mesh of the same shape hold within its coarseness, and coarse ones are filled up") {
    const BakedShape shape(torusCorners(kLarge, kSmall, 96, 48), 256);
    std::vector<glm::vec3> fine, coarse;
    for (const dvec3& p : torusCorners(kLarge, kSmall, 250, 130)) fine.emplace_back(p);
    for (const dvec3& p : torusCorners(kLarge, kSmall, 24, 12)) coarse.emplace_back(p);
    const Errors near = errorsOf(shape, holding(sampled(fine, onTorus), 1), onTorus);
    CAPTURE(near.median());
    CAPTURE(near.most());
    CHECK(near.median() < .1);
    CHECK(near.most() < 1);
    const Errors filled = errorsOf(shape, holding(sampled(coarse, onTorus), 1), onTorus);
    CAPTURE(filled.median());
    CAPTURE(filled.most());
    CHECK(filled.median() < .8);
    CHECK(filled.most() < 3);
}

TEST_CASE("tensors give the direction of their larger eigenvalue, and both eigenvalues") {
    const BakedShape shape(torusCorners(kLarge, kSmall), 256);
    FieldSamples samples{shape.places, {}, {}};
    for (const glm::vec3& place : shape.places) {
        const dvec3 p(place), along = onTorus(p);
        const dvec3 middle = kLarge * glm::normalize(dvec3(p.x, 0, p.z)), out = (p - middle) / kSmall;
        const glm::dmat3 tensor = 3.0 * glm::outerProduct(along, along) +
                                  glm::outerProduct(glm::cross(out, along), glm::cross(out, along)) +
                                  7.0 * glm::outerProduct(out, out);  // which isn't in the surface
        samples.tensors.push_back({float(tensor[0][0]), float(tensor[1][1]), float(tensor[2][2]), float(tensor[0][1]),
                                   float(tensor[0][2]), float(tensor[1][2])});
    }
    const FieldDesign design = holding(samples, 2);
    const Errors errors = errorsOf(shape, design, onTorus);
    CHECK(errors.median() < .04);
    CHECK(errors.most() < .2);
    Result<Field> field = designField(shape.mesh, design);
    std::vector<double> off;
    for (size_t v = 0; v < shape.mesh.positions.size(); ++v) {
        off.push_back(std::abs(double(field->mean[v] + field->deviator[v]) - 3));
        off.push_back(std::abs(double(field->mean[v] - field->deviator[v]) - 1));
    }
    CHECK(medianOf(off) < 1e-4);
    CHECK_FALSE(designField(shape.mesh, holding(samples, 1)));
}

TEST_CASE("a picture over the walk's UVs says what its texels' places have") {
    const BakedShape shape(sphereCorners(1, 24), 256);
    VectorPicture picture{256, 256, std::vector<glm::vec3>(256 * 256)};
    const SurfaceLevelData& level = shape.surface.levels[0];
    REQUIRE(level.size == 256);
    for (uint32_t y = 0; y < 256; ++y)
        for (uint32_t x = 0; x < 256; ++x) {
            const uint32_t triangle = level.aux[texelIndex(256, x, y)].triangle;
            if (triangle == kNoIndex) continue;
            const dvec3 place(placeOn(shape.surface.triangles[triangle], (glm::vec2(x, y) + .5f) / 256.f));
            picture.texels[y * 256 + x] = glm::vec3(onSphere(place));
        }
    const Errors errors = errorsOf(shape, holding(samplesOf(shape.surface, shape.mesh, picture), 1), onSphere);
    CAPTURE(errors.median());
    CAPTURE(errors.most());
    CHECK(errors.median() < .03);
    CHECK(errors.most() < .8);
}

TEST_CASE("an element has its singularity within a field that holds all around") {
    const BakedShape shape(planeCorners(2, 40), 256);
    FieldDesign design = holding(sampled(shape.places, onPlane), 2);
    CHECK(singularitiesOf(shape.mesh, *designField(shape.mesh, design)).empty());
    design.elements.push_back({ElementKind::wedge, {.2, 0, .1}, {1, 0, 0}, .3});
    Result<Field> field = designField(shape.mesh, design);
    REQUIRE(field);
    int near = 0;
    for (const Singularity& s : singularitiesOf(shape.mesh, *field))
        if (glm::length(placeOf(shape.mesh, s) - dvec3(.2, 0, .1)) < .1) near += s.turns;
    CHECK(near == 1);
    for (uint32_t v = 0; v < shape.mesh.positions.size(); ++v) {
        const dvec3 p = shape.mesh.positions[v];
        if (glm::length(p - dvec3(.2, 0, .1)) < .35) continue;
        const dvec3 d = shape.mesh.direction(v, std::arg(field->power[v]) / 2);
        CHECK(degreesOff(d, onPlane(p), shape.mesh.normals[v], true) < .5);
    }
}

TEST_CASE("points of another model are refused, and those that lie near by are told from those that don't") {
    const FieldMesh mesh = makeFieldMesh(planeCorners(2, 20));
    FieldSamples samples{{{9, 9, 9}}, {{1, 0, 0}}, {}};
    Result<Field> far = designField(mesh, holding(samples, 1));
    REQUIRE_FALSE(far);
    CHECK(far.failure().text().find("none of its 1 points lies near the surface") != std::string::npos);
    samples.points[0] = glm::vec3(mesh.positions[0]);
    Result<Field> one = designField(mesh, holding(samples, 1));
    REQUIRE(one);
    CHECK(one->unsampled == mesh.positions.size() - 1);
    // The largest that floats hold stay numbers, up to texels.
    const BakedShape shape(planeCorners(2, 8), 64);
    FieldSamples huge = sampled(shape.places, [](const dvec3&) { return dvec3(3e38, 0, 3e38); });
    const Result<Field> largest = designField(shape.mesh, holding(huge, 2));
    REQUIRE(largest);
    for (const FieldTexel& texel : FieldSampling(shape.surface, shape.mesh).texels(largest.value()))
        CHECK(std::isfinite(texel.deviator));
    // Vectors that say nothing leave the field to the drift.
    samples.vectors[0] = {0, 0, 0};
    FieldDesign silent = holding(samples, 1), plain;
    silent.drift = plain.drift = {1, 0, 0};
    plain.symmetry = 1;
    Result<Field> left = designField(mesh, silent), drifting = designField(mesh, plain);
    REQUIRE(left);
    CHECK(left->power == drifting->power);
}
