// Brushes over fields, against what formulas say of them.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "runtime/field/field_picture.hpp"
#include "runtime/field/field_solver.hpp"
#include "runtime/field/field_strokes.hpp"
#include "tests/field/baked_shapes.hpp"

using namespace espalier;

namespace {

using glm::dvec3;
using Complex = std::complex<double>;

FieldStroke straight(FieldBrush brush, const glm::vec3& from, const glm::vec3& to, double radius, double strength) {
    FieldStroke stroke{brush, {}, radius, strength};
    const int steps = int(std::ceil(glm::length(to - from) / (.25 * radius)));
    for (int i = 0; i <= steps; ++i) stroke.points.push_back(glm::mix(from, to, float(i) / float(steps)));
    return stroke;
}

Field designed(const FieldMesh& mesh, const FieldDesign& design) {
    Result<Field> field = designField(mesh, design);
    REQUIRE(field);
    return std::move(*field);
}

double degreesAt(const FieldMesh& mesh, const Field& field, uint32_t v, const dvec3& direction) {
    const double turn = mesh.angleOf(v, direction) * field.symmetry - std::arg(field.power[v]);
    return std::abs(std::remainder(turn, 2 * std::numbers::pi)) / field.symmetry * 180 / std::numbers::pi;
}

FieldDesign drifting(uint32_t symmetry, const dvec3& drift) {
    FieldDesign design;
    design.symmetry = symmetry;
    design.drift = drift;
    return design;
}

}  // namespace

TEST_CASE("a comb turns what lies in its middle by its strength, and nothing beyond its radius") {
    const FieldMesh mesh = makeFieldMesh(planeCorners(4, 80));
    FieldDesign design = drifting(1, {1, 0, 0});
    const Field before = designed(mesh, design);
    for (const double strength : {.25, .5, .75, 1.0}) {
        design.strokes = {straight(FieldBrush::comb, {0, 0, 1.6f}, {0, 0, -1.6f}, .5, strength)};
        const Field after = designed(mesh, design);
        CHECK(after.deviator == before.deviator);
        // Half of the way from x to -z by shares of both.
        const double share = std::min(strength, .98);
        const dvec3 wanted(1 - share, 0, -share);
        size_t middle = 0;
        for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
            const dvec3 p = mesh.positions[v];
            if (std::abs(p.x) > .5) CHECK(after.power[v] == before.power[v]);
            if (std::abs(p.x) > .01 || std::abs(p.z) > .8) continue;
            ++middle;
            CHECK(degreesAt(mesh, after, v, wanted) < 3);
        }
        CHECK(middle > 20);
    }
}

TEST_CASE("on a sphere a combed field runs along the great circle of the stroke, beside it in parallel") {
    const FieldMesh mesh = makeFieldMesh(sphereCorners(1, 40));
    for (const uint32_t symmetry : {1u, 2u, 4u}) {
        FieldDesign design = drifting(symmetry, {0, 1, 0});
        FieldStroke stroke{FieldBrush::comb, {}, .3, 1};
        for (int i = 0; i <= 60; ++i) {
            const float a = .05f * float(i);
            stroke.points.emplace_back(std::cos(a), 0, -std::sin(a));
        }
        design.strokes = {stroke, stroke};
        const Field field = designed(mesh, design);
        std::vector<double> off;
        for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
            const dvec3 p = mesh.positions[v];
            const double a = std::atan2(-p.z, p.x);
            if (std::abs(p.y) < .15 && a > .4 && a < 2.6)
                off.push_back(degreesAt(mesh, field, v, {-std::sin(a), 0, -std::cos(a)}));
        }
        REQUIRE(off.size() > 100);
        CHECK(medianOf(off) < .3);
        CHECK(*std::ranges::max_element(off) < 2.5);
    }
}

TEST_CASE("smoothing lowers a wave as one implicit step of diffusion does") {
    const FieldMesh mesh = makeFieldMesh(planeCorners(8, 160));
    const double wave = 4, height = .2, radius = 2, strength = .5;
    auto samples = std::make_shared<FieldSamples>();
    for (const dvec3& p : mesh.positions) {
        const double angle = height * std::sin(wave * p.x);
        samples->points.emplace_back(p);
        samples->vectors.emplace_back(std::cos(angle), 0, -std::sin(angle));
    }
    FieldDesign design = drifting(1, {1, 0, 0});
    design.samples = samples;
    const Field before = designed(mesh, design);
    design.strokes = {straight(FieldBrush::smooth, {-3.9f, 0, 0}, {3.9f, 0, 0}, radius, strength)};
    const Field after = designed(mesh, design);
    const double area = .25 * strength * radius * radius, left = 1 / (1 + area * wave * wave);
    double along = 0, count = 0;  // how much of the wave is left in the middle
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const dvec3 p = mesh.positions[v];
        if (std::abs(p.z) > radius + .1) CHECK(after.power[v] == before.power[v]);
        if (std::abs(p.z) > .01 || std::abs(p.x) > 1.6) continue;
        const dvec3 d = mesh.direction(v, std::arg(after.power[v]));
        along += std::atan2(-d.z, d.x) * std::sin(wave * p.x);
        count += height * std::sin(wave * p.x) * std::sin(wave * p.x);
    }
    CAPTURE(along / count);
    CHECK(along / count == doctest::Approx(left).epsilon(.1));
}

TEST_CASE("a stroke that grows, shrinks and is taken back gives the bits that a new solver gives") {
    const FieldMesh mesh = makeFieldMesh(torusCorners(2, .7, 48, 24));
    std::mt19937 random(5);
    const auto chance = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
    FieldSolver kept(mesh);
    FieldDesign design = drifting(2, {0, 1, 0});
    for (int step = 0; step < 60; ++step) {
        const uint32_t what = random() % 8;
        if (design.strokes.empty() || what == 0)
            design.strokes.push_back(
                {random() % 2 ? FieldBrush::comb : FieldBrush::smooth, {}, chance(.2, .8), chance(0, 1)});
        else if (what == 1)
            design.strokes.pop_back();
        else if (what == 2)
            design.elements.push_back({ElementKind::wedge, mesh.positions[random() % mesh.positions.size()]});
        else if (what == 3 && !design.strokes.back().points.empty())
            design.strokes.back().points.pop_back();
        if (!design.strokes.empty()) {
            const double a = .1 * step;
            design.strokes.back().points.emplace_back(2.7 * std::cos(a), 0, -2.7 * std::sin(a));
        }
        Result<Field> mine = kept.design(design);
        REQUIRE(mine);
        CHECK(mine->power == designed(mesh, design).power);
    }
}

TEST_CASE("whatever brushes do, the turns of singularities add up to the Euler characteristic") {
    std::mt19937 random(3);
    const auto any = [&] { return std::uniform_real_distribution<float>(-1, 1)(random); };
    for (const uint32_t symmetry : {1u, 2u, 4u})
        for (const bool exact : {false, true}) {
            const FieldMesh mesh = makeFieldMesh(sphereCorners(1, 16));
            FieldDesign design = drifting(symmetry, {0, 1, 0});
            design.exact = exact;
            for (int i = 0; i < 12; ++i) {
                const glm::vec3 from = glm::normalize(glm::vec3(any(), any(), any()));
                const glm::vec3 to = glm::normalize(from + .8f * glm::vec3(any(), any(), any()));
                design.strokes.push_back(
                    straight(i % 3 == 2 ? FieldBrush::smooth : FieldBrush::comb, from, to, .3, .9));
            }
            const Field field = designed(mesh, design);
            int turns = 0;
            for (const Singularity& s : singularitiesOf(mesh, field)) turns += s.turns;
            CHECK(turns == int(symmetry) * 2);
        }
}

TEST_CASE("a picture of a field that is brought up to date is the picture that is made anew") {
    for (const uint32_t symmetry : {1u, 2u, 4u}) {
        const BakedShape shape(sphereCorners(1, 12), 128);
        FieldDesign design = drifting(symmetry, {0, 1, 0});
        Field before = designed(shape.mesh, design);
        FieldPicture picture = fieldPicture(shape.surface, shape.mesh, before);
        const FieldPicture first = picture;
        // Along, and then against all else, which makes singularities.
        for (const float side : {1.f, -1.f}) {
            FieldStroke stroke{FieldBrush::comb, {}, .25, 1};
            for (int i = 0; i <= 12; ++i)
                stroke.points.push_back(glm::normalize(glm::vec3(1, side * (.05f * float(i) - .3f), .1f * side)));
            design.strokes.push_back(stroke);
            const Field now = designed(shape.mesh, design);
            updateFieldPicture(shape.surface, shape.mesh, before, now, picture);
            const FieldPicture anew = fieldPicture(shape.surface, shape.mesh, now);
            CHECK(picture.channels == anew.channels);
            before = now;
        }
        CHECK(picture.channels != first.channels);
    }
}

TEST_CASE("strokes without points, of one point, beside the surface and over all of it do no harm") {
    const FieldMesh mesh = makeFieldMesh(sphereCorners(1, 8));
    FieldDesign design = drifting(1, {0, 1, 0});
    const Field before = designed(mesh, design);
    design.strokes = {
        {FieldBrush::comb, {}, .5, 1}, {FieldBrush::comb, {{1, 0, 0}}, .5, 1}, {FieldBrush::smooth, {}, .5, 1}};
    CHECK(designed(mesh, design).power == before.power);
    design.strokes = {{FieldBrush::smooth, {{1, 0, 0}, {1, 0, 0}}, 100, 1},
                      {FieldBrush::comb, {{5, 5, 5}, {5, 5, 5}}, .1, 1},
                      {FieldBrush::comb, {{9, 0, 0}, {-9, 0, 0}}, 100, 1}};
    for (const Complex& power : designed(mesh, design).power) CHECK(std::abs(power) == doctest::Approx(1));
}

TEST_CASE("strokes that are felt too often together are refused by their number, and fewer then go on") {
    const FieldMesh mesh = makeFieldMesh(planeCorners(4, 20));
    const size_t count = mesh.positions.size();
    const Field below = designed(mesh, drifting(1, {1, 0, 0}));
    // Each point of a wide stroke is felt by all vertices.
    const FieldStroke wide{FieldBrush::smooth, std::vector<glm::vec3>(20, glm::vec3(0)), 1000, .5};
    FieldStrokes kept(mesh, count * 100);
    const std::vector<FieldStroke> most(5, wide), more(6, wide);
    Field before = below, refused = below, after = below;
    REQUIRE(kept.lay(most, before));
    for (int time = 0; time < 2; ++time) {
        const Status laid = kept.lay(more, refused);
        REQUIRE_FALSE(laid);
        CHECK(laid.failure().diagnostics.front().message.find(
                  "with stroke 5 the strokes are felt by more than 44100 vertices") == 0);
        CHECK(refused.power == below.power);
    }
    REQUIRE(kept.lay(most, after));
    CHECK(after.power == before.power);
    CHECK_FALSE(FieldStrokes(mesh, count * 100 - 1).lay(most, refused));
}

TEST_CASE("smoothing with a brush far larger than the surface evens all of it out, and leaves what is even") {
    const FieldMesh mesh = makeFieldMesh(planeCorners(8, 80));
    const dvec3 even = glm::normalize(dvec3(2, 0, -1));
    for (const double height : {0.0, .3})
        for (const double radius : {1e2, 1e5, 1e9}) {
            auto samples = std::make_shared<FieldSamples>();
            for (const dvec3& p : mesh.positions) {
                const double angle =
                    height * std::sin(3 * p.x) + std::atan2(1, 2);  // as often to one side as the other
                samples->points.emplace_back(p);
                samples->vectors.emplace_back(std::cos(angle), 0, -std::sin(angle));
            }
            FieldDesign design = drifting(1, even);
            design.samples = samples;
            design.strokes = {{FieldBrush::smooth, {{0, 0, 0}}, radius, 1}};
            const Field field = designed(mesh, design);
            double most = 0;
            for (uint32_t v = 0; v < mesh.positions.size(); ++v) most = std::max(most, degreesAt(mesh, field, v, even));
            CAPTURE(height);
            CAPTURE(radius);
            CHECK(most < (height > 0 ? .5 : 1e-5));
        }
}
