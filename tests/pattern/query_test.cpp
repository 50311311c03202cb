// How fields change where scopes stand, against formulas.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/pattern/scene.hpp"

using namespace espalier;
using glm::dvec3;
using patterntest::Scene;

namespace {

constexpr double kRound = 2, kTube = .7, kRadius = 1;

// What one place says, and the frame in which it says so: the scope's x axis, and its left on the surface.
struct Said {
    dvec3 at, x, left;
    std::array<double, 3> values;
};

// Asks for three numbers between -kShift and kShift at each place, by the sizes of boxes there.
constexpr double kShift = 16;
std::vector<Said> ask(Scene& scene, const std::string& declarations, const std::array<std::string, 3>& asked,
                      const std::vector<std::pair<std::string, Field>>& fields, const std::vector<dvec3>& places) {
    std::string rule = "A -> S(";
    for (size_t i = 0; i < 3; ++i) rule += "16 + (" + asked[i] + (i < 2 ? "), " : ")) I(\"box\")");
    const uint32_t grammar = scene.addGrammar(declarations + "\n" + rule);
    for (const auto& [name, field] : fields) scene.setField(name, field);
    scene.seeds().clear();
    uint64_t number = 0;
    for (const dvec3& p : places) {
        const double turn = double(++number);
        scene.plant(p, {std::cos(turn), .3 * std::sin(3 * turn), std::sin(turn)}, grammar, number);
    }
    std::vector<Said> all;
    for (const PatternPiece& piece : scene.grow(2).pieces) {
        const dvec3 x = piece.x, y = piece.z, up = piece.y;
        all.push_back({piece.position,
                       glm::normalize(x),
                       -glm::normalize(y),
                       {glm::length(x) - kShift, glm::length(y) - kShift, glm::length(up) - kShift}});
    }
    REQUIRE(all.size() == places.size());
    return all;
}

// A vector field from vectors in space, which lie in the surface but for what its triangles err.
Field vectorsOf(const FieldMesh& mesh, const std::function<dvec3(const dvec3&)>& at) {
    Field field;
    field.symmetry = 1;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const dvec3 d = at(mesh.positions[v]);
        field.power.push_back(std::polar(1.0, mesh.angleOf(v, d)));
        field.mean.push_back(0);
        field.deviator.push_back(float(glm::length(d)));
    }
    return field;
}
// The surface's directions are those of another field; larger and lesser eigenvalue from a formula.
Field tensorsOf(const FieldMesh& mesh, const std::function<dvec3(const dvec3&)>& direction,
                const std::function<std::pair<double, double>(const dvec3&)>& eigenvalues) {
    Field field = vectorsOf(mesh, direction);
    field.symmetry = 2;
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const auto [larger, lesser] = eigenvalues(mesh.positions[v]);
        field.power[v] *= field.power[v];
        field.mean[v] = float((larger + lesser) / 2);
        field.deviator[v] = float((larger - lesser) / 2);
    }
    return field;
}

// The largest error of `said` against `known`, as a share of the largest of the known ones.
struct Worst {
    double error = 0, size = 0;
    void note(double said, double known) {
        error = std::max(error, std::abs(said - known));
        size = std::max(size, std::abs(known));
    }
    double share() const { return error / size; }
};

std::vector<dvec3> placesOn(const Scene& scene, uint32_t step = 997) {
    std::vector<dvec3> all;
    const SurfaceLevelData& level = scene.surface().levels[0];
    for (size_t i = step / 2; i < level.texels.size(); i += step)
        if (texelClass(level.texels[i].bits) == kTexelInner) all.push_back(level.texels[i].position);
    return all;
}

Scene planeScene() {
    return Scene(patterntest::sheet(
                     160, 160, [](float u, float v) { return glm::vec3(4 * (u - .5f), 0, 4 * (.5f - v)); },
                     [](float, float) { return glm::vec3(0, 1, 0); }),
                 256);
}
Scene sphereScene() {
    const auto outside = [](float u, float v) {
        const float a = 2 * std::numbers::pi_v<float> * (u == 1 ? 0 : u), b = 2.4f * (v - .5f);
        return glm::vec3(std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b));
    };
    return Scene(patterntest::sheet(
                     400, 160, [&](float u, float v) { return float(kRadius) * outside(u, v); }, outside),
                 512);
}

// Two vectors that lie in the tangent plane, by their parts: how `said` differs from the formula's Jacobian.
void noteJacobian(Worst& worst, const Said& s, const std::function<dvec3(const dvec3&)>& derivative, bool secondRow) {
    // derivative(d): the derivative of the field along the unit tangent d, laid into the surface.
    const dvec3 row = secondRow ? s.left : s.x;
    worst.note(s.values[0], glm::dot(row, derivative(s.x)));
    worst.note(s.values[1], glm::dot(row, derivative(s.left)));
}

}  // namespace

TEST_CASE("vectors, Jacobian, divergence and curl on a plane are those of the formula") {
    Scene scene = planeScene();
    const std::vector<dvec3> places = placesOn(scene);
    REQUIRE(places.size() > 40);
    const auto vectors = [](const dvec3& p) { return dvec3(1.5 + std::sin(p.x), 0, .5 * std::cos(p.z) + .4 * p.x); };
    const auto along = [](const dvec3& p, const dvec3& d) {
        return dvec3(std::cos(p.x) * d.x, 0, -.5 * std::sin(p.z) * d.z + .4 * d.x);
    };
    const Field field = vectorsOf(scene.mesh(), vectors);
    Worst vector, jacobian, rates;
    const auto answers = [&](const std::array<std::string, 3>& asked) {
        return ask(scene, "field f : vector", asked, {{"f", field}}, places);
    };
    for (const Said& s : answers({"f.vector1.x", "f.vector1.y", "f.vector2.x"})) {
        vector.note(s.values[0], glm::dot(vectors(s.at), s.x));
        vector.note(s.values[1], glm::dot(vectors(s.at), s.left));
        vector.note(s.values[2], -glm::dot(vectors(s.at), s.left));
    }
    for (const Said& s : answers({"f.jacobian1.xx", "f.jacobian1.xy", "f.divergence1"})) {
        noteJacobian(
            jacobian, s, [&](const dvec3& d) { return along(s.at, d); }, false);
        rates.note(s.values[2], std::cos(s.at.x) - .5 * std::sin(s.at.z));
    }
    for (const Said& s : answers({"f.jacobian1.yx", "f.jacobian1.yy", "f.curl1"})) {
        noteJacobian(
            jacobian, s, [&](const dvec3& d) { return along(s.at, d); }, true);
        // Seen from above: left of +x is -z.
        rates.note(s.values[2], -.4);
    }
    MESSAGE("vectors " << vector.share() << ", Jacobian " << jacobian.share() << ", rates " << rates.share());
    CHECK(vector.share() < .002);
    CHECK(jacobian.share() < .02);
    CHECK(rates.share() < .02);
}

TEST_CASE("Jacobian, divergence and curl on a sphere are those of the formula") {
    Scene scene = sphereScene();
    const std::vector<dvec3> places = placesOn(scene);
    REQUIRE(places.size() > 40);
    // Turning about an axis, and leading to a pole: the derivative of the one is a turn, of the other a scaling.
    const dvec3 axis(.3, .8, -.4), pole(-.6, .5, .7);
    const auto vectors = [&](const dvec3& p) {
        const dvec3 n = glm::normalize(p);
        return kRadius * glm::cross(axis, n) + pole - n * glm::dot(pole, n);
    };
    const Field field = vectorsOf(scene.mesh(), vectors);
    Worst jacobian, rates;
    const auto answers = [&](const std::array<std::string, 3>& asked) {
        return ask(scene, "field f : vector", asked, {{"f", field}}, places);
    };
    const auto derivative = [&](const Said& s) {
        return [&](const dvec3& d) {
            const dvec3 n = glm::normalize(s.at);
            return glm::dot(axis, n) * glm::cross(n, d) - glm::dot(pole, n) / kRadius * d;
        };
    };
    for (const Said& s : answers({"f.jacobian1.xx", "f.jacobian1.xy", "f.divergence1"})) {
        noteJacobian(jacobian, s, derivative(s), false);
        rates.note(s.values[2], -2 * glm::dot(pole, glm::normalize(s.at)) / kRadius);
    }
    for (const Said& s : answers({"f.jacobian1.yx", "f.jacobian1.yy", "f.curl1"})) {
        noteJacobian(jacobian, s, derivative(s), true);
        rates.note(s.values[2], 2 * glm::dot(axis, glm::normalize(s.at)));
    }
    MESSAGE("Jacobian " << jacobian.share() << ", rates " << rates.share());
    CHECK(jacobian.share() < .02);
    CHECK(rates.share() < .02);
}

TEST_CASE("a tensor's gradients, and divergence and curl of its eigenvectors, on a torus are those of the formula") {
    Scene scene(patterntest::torus(kRound, kTube, 400, 200), 512);
    const std::vector<dvec3> places = placesOn(scene);
    REQUIRE(places.size() > 40);
    // The first eigenvector leads 40 degrees off the circles about the axis.
    const double turn = 40 * std::numbers::pi / 180;
    const auto round = [](const dvec3& p) { return glm::normalize(dvec3(p.z, 0, -p.x)); };
    const auto outside = [](const dvec3& p) { return glm::normalize(p - kRound * glm::normalize(dvec3(p.x, 0, p.z))); };
    const auto upward = [&](const dvec3& p) { return glm::cross(outside(p), round(p)); };
    const auto first = [&](const dvec3& p) { return std::cos(turn) * round(p) + std::sin(turn) * upward(p); };
    const auto second = [&](const dvec3& p) { return -std::sin(turn) * round(p) + std::cos(turn) * upward(p); };
    const auto values = [](const dvec3& p) { return std::pair(3 + p.y, -1 + .5 * p.x); };
    const Field field = tensorsOf(scene.mesh(), first, values);
    // A circle about the axis turns to its left, upward, by the sine of the latitude over its radius.
    const auto turns = [&](const dvec3& p, const dvec3& d) {
        const dvec3 n = outside(p);
        return n.y / std::hypot(p.x, p.z) * glm::dot(d, round(p));
    };
    Worst gradient, turned, rates, jacobian;
    const auto answers = [&](const std::array<std::string, 3>& asked) {
        return ask(scene, "field f : tensor", asked, {{"f", field}}, places);
    };
    for (const Said& s : answers({"f.gradient1.x", "f.gradient1.y", "f.gradient2.x"})) {
        gradient.note(s.values[0], s.x.y);
        gradient.note(s.values[1], s.left.y);
        gradient.note(s.values[2], .5 * s.x.x);
    }
    for (const Said& s : answers({"f.turn.x", "f.turn.y", "f.gradient2.y"})) {
        turned.note(s.values[0], turns(s.at, s.x));
        turned.note(s.values[1], turns(s.at, s.left));
        gradient.note(s.values[2], .5 * s.left.x);
    }
    // Of the two senses of an eigenvector the one within a quarter turn of the scope's x axis is meant.
    const auto sense = [](const Said& s, const dvec3& v) { return glm::dot(v, s.x) < 0 ? -1.0 : 1.0; };
    for (const Said& s : answers({"f.divergence1", "f.curl1", "f.jacobian1.yx"})) {
        const dvec3 v = sense(s, first(s.at)) * first(s.at), left = glm::cross(outside(s.at), v);
        rates.note(s.values[0], turns(s.at, left));
        rates.note(s.values[1], turns(s.at, v));
        jacobian.note(s.values[2], turns(s.at, s.x) * glm::dot(left, s.left));
    }
    for (const Said& s : answers({"f.divergence2", "f.curl2", "f.jacobian2.xy"})) {
        const dvec3 v = sense(s, second(s.at)) * second(s.at), left = glm::cross(outside(s.at), v);
        rates.note(s.values[0], turns(s.at, left));
        rates.note(s.values[1], turns(s.at, v));
        jacobian.note(s.values[2], turns(s.at, s.left) * glm::dot(left, s.x));
    }
    MESSAGE("gradients " << gradient.share() << ", turns " << turned.share() << ", rates " << rates.share()
                         << ", Jacobian " << jacobian.share());
    CHECK(gradient.share() < .02);
    CHECK(turned.share() < .02);
    CHECK(rates.share() < .02);
    CHECK(jacobian.share() < .02);
}

TEST_CASE("one field is asked about along another") {
    Scene scene = planeScene();
    const std::vector<dvec3> places = placesOn(scene);
    const dvec3 way(std::cos(.5), 0, -std::sin(.5));
    const Field vectors = vectorsOf(scene.mesh(), [](const dvec3& p) {
        const double angle = .3 + .2 * p.x;
        return (2 + .3 * p.z) * dvec3(std::cos(angle), 0, -std::sin(angle));
    });
    const Field lines = tensorsOf(
        scene.mesh(), [&](const dvec3&) { return way; }, [](const dvec3&) { return std::pair(1.0, -1.0); });
    Worst angle, growth, turn;
    for (const Said& s :
         ask(scene, "field f : vector\nfield g : tensor", {"f.angleTo(g)", "f.gradient1Along(g)", "f.turnAlong(g)"},
             {{"f", vectors}, {"g", lines}}, places)) {
        const dvec3 along = glm::dot(way, s.x) < 0 ? -way : way;
        angle.note(s.values[0], std::remainder(.5 - .3 - .2 * s.at.x, std::numbers::pi));
        growth.note(s.values[1], .3 * along.z);
        turn.note(s.values[2], .2 * along.x);
    }
    MESSAGE("angle " << angle.share() << ", growth " << growth.share() << ", turn " << turn.share());
    CHECK(angle.share() < .01);
    CHECK(growth.share() < .02);
    CHECK(turn.share() < .02);
}
