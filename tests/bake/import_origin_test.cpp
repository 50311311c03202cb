// Models far from their origin: an origin is taken off in double precision, and kept.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "tests/bake/model_folder.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// Three steps of 17.5 by 28 cm, seen from the side and 1 m wide, as one polygon a side and a quad a tread.
const std::vector<glm::dvec3> kStairs = [] {
    std::vector<glm::dvec3> side{{0, 0, 0}};
    for (int i = 0; i < 3; ++i) {
        side.push_back({0.28 * i, 0.175 * (i + 1), 0});
        side.push_back({0.28 * (i + 1), 0.175 * (i + 1), 0});
    }
    side.push_back({0.84, 0, 0});
    std::vector<glm::dvec3> all;
    for (double z : {0.0, 1.0})
        for (glm::dvec3 p : side) all.push_back({p.x, p.y, z});
    return all;
}();
constexpr double kArea = 2 * 0.28 * 0.175 * 6 + 2 * (0.84 + 0.525);

std::vector<std::vector<uint32_t>> stairFaces() {
    const uint32_t n = uint32_t(kStairs.size() / 2);
    std::vector<std::vector<uint32_t>> out(2);
    for (uint32_t i = 0; i < n; ++i) {
        out[0].push_back(i);
        out[1].push_back(2 * n - 1 - i);
        out.push_back({i, i + n, (i + 1) % n + n, (i + 1) % n});
    }
    return out;
}

std::string fixedNumber(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6f", value);
    return text;
}

std::string asObj(glm::dvec3 at) {
    std::string text;
    for (glm::dvec3 p : kStairs)
        text += "v " + fixedNumber(p.x + at.x) + " " + fixedNumber(p.y + at.y) + " " + fixedNumber(p.z + at.z) + "\n";
    for (const auto& face : stairFaces()) {
        text += "f";
        for (uint32_t v : face) text += " " + std::to_string(v + 1);
        text += "\n";
    }
    return text;
}

std::string asPly(glm::dvec3 at, bool binary) {
    std::string text = std::string("ply\nformat ") + (binary ? "binary_little_endian" : "ascii") +
                       " 1.0\nelement vertex " + std::to_string(kStairs.size()) +
                       "\nproperty double x\nproperty double y\nproperty double z\n" + "element face " +
                       std::to_string(stairFaces().size()) + "\nproperty list uchar uchar vertex_indices\nend_header\n";
    for (glm::dvec3 p : kStairs) {
        p += at;
        if (binary)
            text.append(reinterpret_cast<const char*>(&p), sizeof p);
        else
            text += fixedNumber(p.x) + " " + fixedNumber(p.y) + " " + fixedNumber(p.z) + "\n";
    }
    for (const auto& face : stairFaces()) {
        text += binary ? std::string(1, char(face.size())) : std::to_string(face.size());
        for (uint32_t v : face) text += binary ? std::string(1, char(v)) : " " + std::to_string(v);
        if (!binary) text += "\n";
    }
    return text;
}

struct FarModel {
    Model model;
    glm::dvec3 low{1e300}, high{-1e300};  // where the file has it
};

FarModel readFar(const ModelFolder& folder, const std::string& name, const std::string& bytes,
                 const ImportOptions& options = {}) {
    FarModel out{folder.read(name, bytes, options)};
    for (uint32_t i : out.model.indices) {
        const glm::dvec3 p = glm::dvec3(out.model.positions[i]) + out.model.origin;
        out.low = glm::min(out.low, p), out.high = glm::max(out.high, p);
    }
    return out;
}

bool isNear(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(a - b) < 1e-6;
}

}  // namespace

TEST_CASE("stairs keep their size and area wherever on the globe they are") {
    ModelFolder folder;
    for (glm::dvec3 at : {glm::dvec3(691'603, 519, -5'334'760),
                          {85'032.8, 0, -447'000},
                          {0, 6'378'137, 0},
                          {-40'000, 0, 0},
                          {123'456'789, -9'000, 3}}) {
        const std::string obj = asObj(at);
        for (const auto& [name, bytes] : {std::pair<std::string, std::string>{"a.obj", obj},
                                          {"a.ply", asPly(at, false)},
                                          {"b.ply", asPly(at, true)}}) {
            CAPTURE(name);
            CAPTURE(at.x);
            const FarModel far = readFar(folder, name, bytes);
            CHECK(far.model.origin != glm::dvec3(0));
            CHECK(isNear(far.low, at));
            CHECK(isNear(far.high, at + glm::dvec3(0.84, 0.525, 1)));
            REQUIRE(far.model.warnings.size() == 1);
            CHECK(toString(far.model.warnings[0]).find("kept as the surface's origin") != std::string::npos);
            const Baked baked = bakeOrFail(far.model, 64);
            CHECK(baked.report.walkableArea == doctest::Approx(kArea).epsilon(1e-6));
            CHECK(baked.surface.origin == far.model.origin);
        }
    }
}

TEST_CASE("what float32 can hold stays where it is, to the bit") {
    ModelFolder folder;
    for (glm::dvec3 at : {glm::dvec3(0), {900, 0, 0}, {60, 5, -120}}) {
        const FarModel near = readFar(folder, "a.obj", asObj(at));
        CHECK(near.model.origin == glm::dvec3(0));
        CHECK(near.model.warnings.empty());
        CHECK(near.model.positions[0] == glm::vec3(at));
    }
    // A large model needs no origin where a small one would.
    std::string plain = "v 0 0 0\nv 9e5 0 0\nv 9e5 0 9e5\nf 1 2 3\n";
    CHECK(readFar(folder, "a.obj", plain).model.origin == glm::dvec3(0));
}

TEST_CASE("what stands on the ground still does, and origins are round numbers") {
    ModelFolder folder;
    const FarModel far = readFar(folder, "a.obj", asObj({691'603, 0, -5'334'760}));
    CHECK(far.model.origin == glm::dvec3(691'603, 0, -5'334'760) - glm::dvec3(0, 0, 0));
    ImportOptions options;
    options.origin = glm::dvec3(691'000, 500, -5'334'000);
    const FarModel given = readFar(folder, "a.obj", asObj({691'603, 519, -5'334'760}), options);
    CHECK(given.model.origin == *options.origin);
    CHECK(isNear(given.low, {691'603, 519, -5'334'760}));
    options.origin = glm::dvec3(0);
    CHECK(readFar(folder, "a.obj", asObj({691'603, 519, -5'334'760}), options).model.origin == glm::dvec3(0));
}

TEST_CASE("a surface's file and report keep the origin; without one nothing is written") {
    ModelFolder folder;
    const glm::dvec3 at(691'603, 519, -5'334'760);
    for (glm::dvec3 place : {at, glm::dvec3(0)}) {
        const Baked baked = bakeOrFail(readFar(folder, "a.obj", asObj(place)).model, 64);
        REQUIRE(writeSurface(baked.surface, folder.file("a.glb")));
        auto surface = readSurface(folder.file("a.glb"));
        REQUIRE(surface);
        CHECK(surface->origin == baked.surface.origin);
        const auto report = nlohmann::json::parse(baked.report.json());
        CHECK(report["origin"][2].get<double>() == baked.surface.origin.z);
        auto text = readTextFile(folder.file("a.glb"));
        REQUIRE(text);
        CHECK((text->find("\"origin\"") == std::string::npos) == (place == glm::dvec3(0)));
    }
}

TEST_CASE("glTF: nodes far away are composed in double precision") {
    ModelFolder folder;
    // A square of 7 cm, three of them side by side below two nodes; their transforms cancel out but for a map's place.
    const std::string text = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"translation":[600000,519.25,-5334760],"children":[1]},
                 {"translation":[91603.5,0,0],"scale":[0.07,0.07,0.07],"children":[2,3,4]},
                 {"mesh":0},{"mesh":0,"translation":[1,0,0]},{"mesh":0,"translation":[2,0,0]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
        "buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAAAAAAIC/AAAAAAAAAAAAAIC/AAABAAIAAAACAAMA"}],
        "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
                     {"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}]})";
    const FarModel far = readFar(folder, "a.gltf", text);
    CHECK(isNear(far.low, {691'603.5, 519.25, -5'334'760.07}));
    CHECK(isNear(far.high, {691'603.71, 519.25, -5'334'760}));
    const Baked baked = bakeOrFail(far.model, 64);
    CHECK(baked.report.walkableArea == doctest::Approx(3 * 0.0049).epsilon(1e-5));
    CHECK(baked.report.charts == 1);  // the squares still touch
}
