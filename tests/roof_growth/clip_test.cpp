// Tiles of faces that eight planes can't bound, drawn and written out: judged by the structure's faces, which know
// neither parts nor planes. Written out, every point of a roof lies under exactly one triangle, at its face's height;
// drawn from straight above, the roof fills its footprint's pixels and no others.
#include <algorithm>
#include <cmath>
#include <random>

#include "runtime/emit/roof_triangles.hpp"
#include "runtime/render/renderer.hpp"
#include "tests/emit/fixture.hpp"
#include "tests/roof/structure_judge.hpp"
#include "tests/roof_growth/grow_support.hpp"

using namespace roof_test;

namespace {

// A straight eave under a bow of 24 edges: the face over it is convex, with more borders than a part may have.
std::vector<glm::dvec2> bow() {
    std::vector<glm::dvec2> ring;
    for (int i = 0; i <= 24; ++i) {
        const double angle = 3.14159265358979 * i / 24;
        ring.push_back({12 * std::cos(angle), 0.7 * 12 * std::sin(angle)});
    }
    return ring;  // begins at its right end
}
// A straight eave under teeth: its face's ridge goes up and down.
std::vector<glm::dvec2> comb() {
    std::vector<glm::dvec2> ring;
    for (int i = 0; i <= 12; ++i) ring.push_back({36 - 3 * i, i % 2 ? 13.5 : 8});
    ring.push_back({0, 0});
    ring.push_back({36, 0});
    return ring;
}

// One flat quad over its cell: what is left of it shows the cuts and nothing else.
TerminalData sheet() {
    TerminalData data;
    data.kinds = {"slate", "ridge", "panel"};
    data.materials.resize(1);
    for (uint32_t i = 0; i < 4; ++i)
        data.vertices.push_back({{float(i & 1), float(i >> 1), 0}, packOct({0, 0, 1}), {1, 1}});
    data.indices = {0, 1, 3, 0, 3, 2};
    for (uint32_t kind = 0; kind < 3; ++kind)
        data.variants.push_back({data.kinds[kind], kind, {TerminalLod{0, 4, 0, 6, 0, 0}}});
    return data;
}

struct Sheeted {
    Roofs roofs_;
    TerminalData meshes = sheet();
    std::vector<RoofMesh> bounds = terminalBounds(meshes);
    explicit Sheeted(const std::vector<glm::dvec2>& ring, double slope)
        : roofs_(roofs({footprint(ring, RoofShape::hip, slope)}, kSlates)) {}
    RoofInputs inputs() const {
        RoofInputs in = roofs_.inputs();
        in.meshes = bounds;
        return in;
    }
};

RoofTriangles writtenOut(const Sheeted& town, CpuRoofs& grown) {
    RoofLayer layers[kRoofLayers] = {};
    RoofEnv env{};
    env.grids.v = grown.records.grids.data();
    env.runs.v = grown.records.runs.data();
    env.regions.v = grown.records.regions.data();
    env.parts.v = grown.records.parts.data();
    env.planes.v = grown.records.planes.data();
    env.meshes.v = const_cast<RoofMesh*>(town.bounds.data());
    env.layers.v = layers;
    env.plots.v = grown.records.plots.data();
    RoofTriangles out;
    for (const RoofGrid& grid : grown.records.grids) CHECK(appendGrid(env, grid, town.meshes, out));
    RoofTriangles few;  // one that is given no room stops at once
    const auto& grids = grown.records.grids;
    CHECK_FALSE(
        std::ranges::all_of(grids, [&](const RoofGrid& g) { return appendGrid(env, g, town.meshes, few, 999); }));
    CHECK(few.bytes() < out.bytes());
    return out;
}

double side(glm::dvec2 a, glm::dvec2 b, glm::dvec2 p) {
    return ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / glm::length(b - a);
}
// How far p lies within the ring; below 0 outside.
double depthIn(const std::vector<glm::dvec2>& ring, glm::dvec2 p) {
    double nearest = INFINITY;
    bool in = false;
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const glm::dvec2 a = ring[j], d = ring[i] - a;
        const double t = glm::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0, 1.0);
        nearest = std::min(nearest, glm::length(p - a - d * t));
        if ((ring[i].y > p.y) != (a.y > p.y) && p.x < d.x * (p.y - a.y) / d.y + a.x) in = !in;
    }
    return in ? nearest : -nearest;
}

const std::vector<std::vector<glm::dvec2>> kRings = {bow(), comb()};

}  // namespace

TEST_CASE("faces of more than eight borders are written out without gaps or overlaps") {
    for (const auto& ring : kRings) {
        const Sheeted town(ring, 0.8);
        uint32_t most = 0, planes = 0;
        for (const RoofAtom& atom : town.roofs_.tables.atoms) most = std::max(most, atom.pieceCount);
        for (const RoofPart& part : town.roofs_.tables.parts) planes = std::max(planes, part.counts & 255u);
        CHECK(most > 10);
        CHECK(planes <= kPartPlanes);
        CpuRoofs grown = growRoofsOnCpu(town.inputs());
        const RoofTriangles out = writtenOut(town, grown);
        const RoofHouse& house = town.roofs_.structure.houses[0];
        std::mt19937 random(5);
        std::uniform_real_distribution<double> x(-13, 37), y(-1, 14);
        size_t judged = 0, wrong = 0;
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec2 p(x(random), y(random));
            const double height = test::heightAt(town.roofs_.structure, 0, p - house.origin);
            if (std::abs(depthIn(ring, p)) < 0.005) continue;
            uint32_t covers = 0;
            bool border = false;
            double error = 0;
            for (size_t t = 0; t < out.indices.size(); t += 3) {
                glm::dvec3 c[3];
                glm::dvec2 q[3];
                for (int k = 0; k < 3; ++k) c[k] = out.positions[out.indices[t + k]], q[k] = {c[k].x, -c[k].z};
                if (std::max({q[0].x, q[1].x, q[2].x}) < p.x - 0.01 || std::min({q[0].x, q[1].x, q[2].x}) > p.x + 0.01)
                    continue;
                if (std::abs((q[1].x - q[0].x) * (q[2].y - q[0].y) - (q[1].y - q[0].y) * (q[2].x - q[0].x)) < 1e-9)
                    continue;
                const double least = std::min({side(q[0], q[1], p), side(q[1], q[2], p), side(q[2], q[0], p)});
                if (least < -2e-4) continue;
                if (least < 2e-4) border = true;
                ++covers;
                const glm::dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
                const double z = c[0].y - (n.x * (p.x - c[0].x) + n.z * (-p.y - c[0].z)) / n.y;
                error = std::max(error, std::abs(z - house.eaveHeight - height));
            }
            if (border) continue;  // between two triangles
            ++judged;
            const bool right = std::isfinite(height) ? covers == 1 && error < 2e-3 : covers == 0;
            if (!right && wrong++ < 3)
                MESSAGE("at " << p.x << ", " << p.y << ": " << covers << " triangles, roof at " << height << ", off by "
                              << error);
        }
        CHECK(judged > 1500);
        CHECK(wrong == 0);
    }
}

TEST_CASE("faces of more than eight borders are drawn up to their borders") {
    DeviceOptions options;
    options.validation = true;
    Result<std::unique_ptr<Device>> device = Device::create(options);
    REQUIRE(device);
    auto renderer = Renderer::create(**device, test::simpleTerminals());
    REQUIRE(renderer);
    for (const auto& ring : kRings) {
        const Sheeted town(ring, 0.8);
        if (&ring == &kRings[0]) REQUIRE((*renderer)->loadRoofMeshes(sheet()));
        auto growth = RoofGrowth::create(**device);
        REQUIRE(growth);
        REQUIRE((*growth)->grow(town.inputs()));
        const RoofView view = (*growth)->view();
        // From far the whole roof, whose tiles have gone over into their pattern, and from near the tiles of its
        // border.
        for (const bool near : {false, true}) {
            const glm::dvec2 middle = near ? glm::dvec2(ring[0].x - 2, ring[4].y) : glm::dvec2(ring[0].x - 12, 4);
            const double up = near ? 11 : 70;
            DrawTarget target;
            target.width = target.height = 160;
            DrawInputs inputs;
            inputs.camera.eye = glm::vec3(middle.x, up, -middle.y);
            inputs.camera.target = glm::vec3(middle.x, 0, -middle.y);
            inputs.camera.up = {0, 0, -1};
            inputs.look.shadows = false;
            std::vector<uint8_t> pictures[2];
            for (int with = 0; with < 2; ++with) {
                inputs.roofs = with ? &view : nullptr;
                Result<Commands> commands = Commands::begin(**device, "roof from above");
                REQUIRE(commands);
                REQUIRE((*renderer)->draw(*commands, inputs, target));
                REQUIRE(commands->finish());
                auto pixels = (*renderer)->readPixels();
                REQUIRE(pixels);
                pictures[with] = std::move(*pixels);
            }
            (*device)->collect();
            const RoofDrawStats drawnTiles = (*renderer)->stats().roofs;
            INFO(drawnTiles.tiles << " tiles, " << drawnTiles.cutTiles << " cut, " << drawnTiles.rectangles
                                  << " patterns");
            CHECK((near ? drawnTiles.cutTiles : drawnTiles.rectangles) > 5);
            const RoofHouse& house = town.roofs_.structure.houses[0];
            size_t inside = 0, missing = 0, outside = 0, strays = 0;
            const double scale = 2 * std::tan(inputs.camera.fovY / 2) / double(target.height);
            for (uint32_t row = 0; row < target.height; ++row)
                for (uint32_t column = 0; column < target.width; ++column) {
                    const glm::dvec2 ray =
                        glm::dvec2(column + 0.5 - target.width / 2.0, target.height / 2.0 - row - 0.5) * scale;
                    // Where the ray meets the roof, found by going down to it.
                    double height = 3, before = 0;
                    glm::dvec2 p;
                    for (int step = 0; step < 12 && std::abs(height - before) > 1e-3; ++step) {
                        p = middle + ray * (up - height);
                        const double above = test::heightAt(town.roofs_.structure, 0, p - house.origin);
                        before = height;
                        height = house.eaveHeight + (std::isfinite(above) ? above : 0);
                    }
                    const double depth = depthIn(ring, p), pixel = scale * (up - height);
                    if (std::abs(depth) < 2 * pixel) continue;
                    const size_t at = 4 * (size_t(row) * target.width + column);
                    const bool drawn = std::memcmp(&pictures[0][at], &pictures[1][at], 3) != 0;
                    (depth > 0 ? inside : outside)++;
                    if (depth > 0 && !drawn) ++missing;
                    if (depth < 0 && drawn) ++strays;
                }
            CHECK(inside > 1000);
            CHECK(outside > 1000);
            CHECK(missing == 0);
            CHECK(strays == 0);
        }
    }
}
