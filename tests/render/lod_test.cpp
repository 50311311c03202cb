// Models at every level of detail: closed ones let no background through, and one level takes over from another without
// a jump. The silhouette comes from rays on the CPU.
#include <doctest/doctest.h>

#include <cmath>

#include "runtime/surface/mesh_tree.hpp"
#include "tests/bake/small_models.hpp"
#include "tests/render/drawn.hpp"
#include "tests/support/data.hpp"

using namespace espalier;

namespace {

constexpr uint32_t kWidth = 320, kHeight = 240;
using Pixels = std::vector<uint8_t>;

class Walls : public test::Drawn {
  public:
    Walls() { background(4); }

    // From the front, at this many radii.
    void look(const SurfaceData& data, float radii) {
        const glm::vec3 middle = (data.boundsMin + data.boundsMax) * 0.5f;
        const float radius = glm::length(data.boundsMax - data.boundsMin) / 2;
        inputs.camera = {middle + glm::normalize(glm::vec3(0.5f, 0.3f, 1)) * radius * radii, middle, {0, 1, 0}};
        inputs.camera.nearPlane = radius * 0.01f;
        const glm::vec3 eye = inputs.camera.eye;
        metresPerPixel_ = glm::length(eye - glm::clamp(eye, data.boundsMin, data.boundsMax)) * 2 *
                          std::tan(inputs.camera.fovY / 2) / float(kHeight);
    }
    void background(float light) { inputs.look.background = inputs.look.horizon = glm::vec3(light); }
    // So many metres of error are allowed.
    void allow(float error) { inputs.look.lodPixels = error / metresPerPixel_; }

    void place(const SurfaceData& data) { REQUIRE(renderer().setSurface(0, data, glm::mat4(1))); }
    void clear() { renderer().removeSurface(0); }

    Pixels frame() { return Drawn::frame(kWidth, kHeight); }
    RenderStats stats() { return renderer().stats(); }

    // Which pixels lie inside the mesh's silhouette by two pixels or more.
    std::vector<bool> inside(const MeshTree& mesh) const {
        const glm::vec3 forward = glm::normalize(inputs.camera.target - inputs.camera.eye);
        const glm::vec3 right = glm::normalize(glm::cross(forward, inputs.camera.up)), up = glm::cross(right, forward);
        const float tangent = std::tan(inputs.camera.fovY / 2);
        std::vector<bool> hit(kWidth * kHeight), all(kWidth * kHeight);
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
                const float sx = (2 * (float(x) + 0.5f) / kWidth - 1) * tangent * kWidth / kHeight;
                const float sy = (1 - 2 * (float(y) + 0.5f) / kHeight) * tangent;
                hit[y * kWidth + x] = mesh.pick(inputs.camera.eye, forward + right * sx + up * sy).has_value();
            }
        for (uint32_t y = 2; y + 2 < kHeight; ++y)
            for (uint32_t x = 2; x + 2 < kWidth; ++x) {
                bool whole = true;
                for (uint32_t v = y - 2; v <= y + 2; ++v)
                    for (uint32_t u = x - 2; u <= x + 2; ++u) whole = whole && hit[v * kWidth + u];
                all[y * kWidth + x] = whole;
            }
        return all;
    }

  private:
    float metresPerPixel_ = 1;
};

double meanDifference(const Pixels& a, const Pixels& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += std::abs(int(a[i]) - int(b[i]));
    return sum / double(a.size()) * 4 / 3;  // alpha is always 255
}

MeshTree treeOf(const std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices) {
    std::vector<glm::vec3> positions;
    for (const DrawVertex& v : vertices) positions.push_back(v.position);
    return MeshTree(positions, indices);
}

// A closed model: Spot, or a bumpy ball where the data aren't there.
SurfaceData closedModel() {
    Model model;
    if (auto file = test::dataFile("scans/spot.obj")) {
        auto read = importModel(*file);
        REQUIRE(read);
        model = std::move(*read);
    } else {
        model = test::cube(32);
        for (glm::vec3& p : model.positions)
            p = glm::normalize(p) * (1 + 0.08f * std::sin(7 * p.x) * std::sin(6 * p.y + p.z));
    }
    BakeOptions options;
    options.resolution = 256;
    auto baked = bake(model, options);
    REQUIRE(baked);
    return std::move(baked->surface);
}

}  // namespace

TEST_CASE("a closed model over a bright background shows none of it inside its silhouette, at any level") {
    const SurfaceData data = closedModel();
    REQUIRE(data.coarser.size() >= 3);
    Walls stage;
    stage.look(data, 2.4f);
    for (size_t level = 0; level <= data.coarser.size(); ++level) {
        CAPTURE(level);
        const auto& vertices = level == 0 ? data.vertices : data.coarser[level - 1].vertices;
        const auto& indices = level == 0 ? data.indices : data.coarser[level - 1].indices;
        stage.place(data);
        stage.allow(level == 0 ? 0 : data.coarser[level - 1].error * 1.00001f);
        stage.background(4);
        const Pixels bright = stage.frame();
        stage.background(0);
        const Pixels dark = stage.frame();
        CHECK(stage.stats().modelTriangles == indices.size() / 3);
        const std::vector<bool> inside = stage.inside(treeOf(vertices, indices));
        size_t counted = 0, through = 0;
        for (size_t i = 0; i < inside.size(); ++i) {
            if (!inside[i]) continue;
            ++counted;
            // The smoothing of edges looks along them, out of the silhouette: it changes a pixel by a few steps.
            through += std::abs(int(bright[i * 4]) - int(dark[i * 4])) > 24;
        }
        CHECK(counted > 8000);
        CHECK(through == 0);
        stage.clear();
    }
}

TEST_CASE("where a level takes over, no frame's mean changes by more than a fiftieth, and it ends") {
    const SurfaceData data = closedModel();
    Walls stage;
    for (size_t level = 0; level < data.coarser.size(); ++level) {
        CAPTURE(level);
        const float error = data.coarser[level].error;
        // Where the coarser one's error is a pixel, as the default asks, but no further than it can be seen.
        stage.look(data, 2.4f);
        const float near = error * 0.999f, far = error * 1.001f;
        stage.allow(1);
        const float perMetre = stage.inputs.look.lodPixels;
        stage.look(data, std::clamp(1 + 1.4f * perMetre * error, 2.4f, 60.0f));
        stage.place(data);
        stage.allow(near);
        Pixels before = stage.frame();
        CHECK(stage.stats().modelsFading == 0);
        stage.allow(far);
        for (int i = 1; i <= 9; ++i) {
            const Pixels now = stage.frame();
            CHECK(meanDifference(before, now) <= 5);
            CHECK(stage.stats().modelsFading == (i < 8 ? 1 : 0));
            before = now;
        }
        CHECK(stage.stats().modelTriangles == data.coarser[level].indices.size() / 3);
        // Back from the middle of a change: the same frames the other way.
        stage.allow(near);
        std::vector<Pixels> down;
        for (int i = 0; i < 3; ++i) down.push_back(stage.frame());
        stage.allow(far);
        CHECK(meanDifference(stage.frame(), down[1]) == 0);
        CHECK(meanDifference(stage.frame(), down[0]) == 0);
        stage.clear();
    }
}

// As in a split screen or a mirror: what the other one shows is no reason to go on from.
TEST_CASE("two cameras that take turns each show what they would alone") {
    const SurfaceData data = closedModel();
    Walls stage;
    stage.look(data, 2.4f);
    stage.allow(data.coarser.front().error * 0.999f);
    stage.place(data);
    const Camera near = stage.inputs.camera;
    const Pixels alone = stage.frame();
    const uint64_t fine = stage.stats().modelTriangles;
    stage.look(data, 40);
    const Camera far = stage.inputs.camera;
    for (int i = 0; i < 4; ++i) {
        stage.inputs.camera = far;
        (void)stage.frame();
        CHECK(stage.stats().modelTriangles < fine);
        CHECK(stage.stats().modelsFading == 0);
        stage.inputs.camera = near;
        CHECK(stage.frame() == alone);
    }
}

TEST_CASE("a model beside or behind the view isn't drawn, one that reaches into it is, and comes back as it was") {
    const SurfaceData data = closedModel();
    const float radius = glm::length(data.boundsMax - data.boundsMin) / 2;
    Walls stage;
    stage.look(data, 2.4f);
    stage.allow(0);
    stage.place(data);
    const Camera front = stage.inputs.camera;
    const glm::vec3 forward = glm::normalize(front.target - front.eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, front.up)), up = glm::cross(right, forward);
    const Pixels before = stage.frame();
    const auto triangles = [&](glm::vec3 aside) {
        stage.inputs.camera = {front.eye + aside, front.target + aside, front.up};
        stage.inputs.camera.nearPlane = front.nearPlane;
        (void)stage.frame();
        return stage.stats().modelTriangles;
    };
    for (glm::vec3 to : {right, -right, up, -up}) {
        CAPTURE(to.x);
        CHECK(triangles(to * (10 * radius)) == 0);
        // Half of it is in the view where the eye has gone by half of the view's width there.
        CHECK(triangles(to * (radius * 2.4f * std::tan(front.fovY / 2))) == data.indices.size() / 3);
    }
    CHECK(triangles(forward * (4.8f * radius)) == 0);
    stage.inputs.camera = front;
    CHECK(stage.frame() == before);
    CHECK(stage.stats().modelsFading == 0);
}

TEST_CASE("in a moving picture another level takes over at once, and the mean changes by less than one in 255") {
    const SurfaceData data = closedModel();
    Walls stage;
    stage.inputs.look.quick = true;
    for (size_t level = 0; level < data.coarser.size(); ++level) {
        CAPTURE(level);
        const float error = data.coarser[level].error;
        stage.look(data, 2.4f);
        stage.allow(1);
        stage.look(data, std::clamp(1 + 1.4f * stage.inputs.look.lodPixels * error, 2.4f, 60.0f));
        stage.place(data);
        stage.allow(error * 0.999f);
        const Pixels before = stage.frame();
        stage.allow(error * 1.001f);
        const Pixels after = stage.frame();
        CHECK(stage.stats().modelsFading == 0);
        CHECK(stage.stats().modelTriangles == data.coarser[level].indices.size() / 3);
        CHECK(meanDifference(before, after) < 1);
        // Nor does one that has begun go on.
        stage.inputs.look.quick = false;
        stage.frame();
        stage.allow(error * 0.999f);
        stage.frame();
        CHECK(stage.stats().modelsFading == 1);
        stage.inputs.look.quick = true;
        stage.frame();
        CHECK(stage.stats().modelsFading == 0);
        stage.clear();
    }
}

TEST_CASE("backs of a solid model's faces aren't drawn, and nobody sees it") {
    const SurfaceData solid = closedModel();
    // The same with a sliver in its middle that nobody sees, but by which it isn't closed.
    SurfaceData open = solid;
    const glm::vec3 middle = (solid.boundsMin + solid.boundsMax) * 0.5f;
    const auto first = uint32_t(open.vertices.size());
    for (int i = 0; i < 3; ++i) {
        DrawVertex v = open.vertices[0];
        v.position = middle;
        v.position[i] += 1e-3f;
        open.vertices.push_back(v);
        open.indices.push_back(first + uint32_t(i));
    }
    open.ranges.back().indexCount += 3;
    Walls stage;
    stage.inputs.look.lodPixels = 0;
    const auto drawn = [&](const SurfaceData& data, ViewMode view) {
        stage.place(data);
        stage.inputs.look.view = view;
        return stage.frame();
    };
    for (float radii : {2.4f, 6.0f}) {
        stage.look(solid, radii);
        CHECK(drawn(solid, ViewMode::shaded) == drawn(open, ViewMode::shaded));
        CHECK(drawn(solid, ViewMode::overdraw) != drawn(open, ViewMode::overdraw));
    }
    // Who means them to be seen sees them from within.
    stage.look(solid, 2.4f);
    std::swap(stage.inputs.camera.eye, stage.inputs.camera.target);
    const Pixels through = drawn(solid, ViewMode::shaded);
    SurfaceData twoSided = solid;
    for (Material& material : twoSided.materials) material.doubleSided = true;
    const Pixels within = drawn(twoSided, ViewMode::shaded);
    CHECK(within == drawn(open, ViewMode::shaded));
    CHECK(meanDifference(within, through) > 50);
}

TEST_CASE("what a model hides is not drawn while one of its levels takes over, either") {
    Walls stage;
    const test::Plant ivy = test::upload(stage.device(), test::wallIvy(8, 2, 1.5f));
    stage.inputs.growth = ivy.view;
    stage.inputs.surfaces = ivy.surfaceBuf;
    // A screen before the lower part of the ivy, in two levels of the same shape.
    SurfaceData screen;
    screen.boundsMin = {-3, -1, 0.5f};
    screen.boundsMax = {3, 0.9f, 0.5f};
    for (int i = 0; i < 4; ++i) {
        const glm::vec2 at(i & 1, i >> 1);
        screen.vertices.push_back({glm::vec3(-3 + 6 * at.x, -1 + 1.9f * at.y, 0.5f), {0, 0, 1}, {1, 0, 0, 1}, at, at});
    }
    screen.indices = {0, 1, 2, 1, 3, 2};
    screen.materials.resize(1);
    screen.ranges.push_back({0, 6, 0});
    CoarserMesh coarser;
    coarser.vertices = screen.vertices;
    coarser.indices = screen.indices;
    coarser.ranges = screen.ranges;
    coarser.error = 0.0018f;  // seen as a sixth of a pixel
    screen.coarser.push_back(coarser);
    stage.look(screen, 1.2f);
    stage.inputs.camera.eye = {0, 1, 4};
    stage.inputs.camera.target = {0, 0.7f, 0};
    const auto drawn = [&] { return stage.stats().emit.leaves + stage.stats().emit.spans; };
    stage.inputs.look.lodPixels = 0.1f;
    stage.frame();
    const uint32_t open = drawn();
    stage.place(screen);
    stage.frame();
    const uint32_t hidden = drawn();
    CHECK(hidden > 0);
    CHECK(hidden < open / 2);
    stage.inputs.look.lodPixels = 1;
    for (int i = 0; i < 9; ++i) {
        stage.frame();
        CAPTURE(i);
        CHECK(stage.stats().modelsFading == (i < 7 ? 1 : 0));
        CHECK(drawn() <= hidden);
    }
}
