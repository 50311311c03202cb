// The woven sphere of LUNA (Hoetzlein 2010, Appendix A): its counts, and what an oracle in double precision makes of
// the same particles.
#include <array>
#include <cmath>

#include "runtime/gpu/device.hpp"
#include "tests/nodes/graphs.hpp"

using namespace espalier;
using namespace espalier::nodetest;

namespace {

struct Resolution {
    const char* file;
    uint32_t points, curves, samples, sides, vertices, triangles;
};
constexpr Resolution kResolutions[] = {{"woven_sphere_low.graph", 50, 25, 28, 8, 5600, 9450},
                                       {"woven_sphere_medium.graph", 150, 100, 42, 12, 50400, 90200},
                                       {"woven_sphere.graph", 250, 200, 56, 16, 179200, 330000}};

// The definition's steps in double precision, from particles alone. It shares no code with the graph.
using Point = glm::dvec3;
Point splinePlace(const std::vector<Point>& keys, double along) {
    const int segments = int(keys.size()) - 1;
    const int s = std::min(int(std::floor(along)), segments - 1);
    const double t = along - s, u = 1 - t;
    const auto key = [&](int k) { return keys[size_t(std::clamp(k, 0, segments))]; };
    const Point a = key(s), d = key(s + 1), b = a + (d - key(s - 1)) / 6.0, c = d - (key(s + 2) - a) / 6.0;
    return a * (u * u * u) + b * (3 * t * u * u) + c * (3 * t * t * u) + d * (t * t * t);
}

struct Frame {
    Point along, side;
};
// By two reflections a step (Wang et al. 2008).
std::vector<Frame> framesAlong(const std::vector<Point>& path) {
    std::vector<Frame> frames;
    const auto along = [&](size_t j) {
        return glm::normalize(path[std::min(j + 1, path.size() - 1)] - path[j > 0 ? j - 1 : 0]);
    };
    for (size_t j = 0; j < path.size(); ++j) {
        Frame f{along(j), {}};
        if (j == 0) {
            int least = 0;
            for (int k = 1; k < 3; ++k)
                if (std::abs(f.along[k]) < std::abs(f.along[least])) least = k;
            Point axis(0);
            axis[least] = 1;
            f.side = glm::normalize(axis - f.along * glm::dot(axis, f.along));
        } else {
            const Frame& before = frames.back();
            const Point v1 = path[j] - path[j - 1];
            const double c1 = glm::dot(v1, v1);
            const Point side = before.side - v1 * (2 / c1 * glm::dot(v1, before.side));
            const Point turned = before.along - v1 * (2 / c1 * glm::dot(v1, before.along));
            const Point v2 = f.along - turned;
            const double c2 = glm::dot(v2, v2);
            f.side = c2 > 0 ? side - v2 * (2 / c2 * glm::dot(v2, side)) : side;
            f.side = glm::normalize(f.side - f.along * glm::dot(f.along, f.side));
        }
        frames.push_back(f);
    }
    return frames;
}

}  // namespace

TEST_CASE("the woven sphere has the counts of the paper") {
    for (const Resolution& r : kResolutions) {
        CAPTURE(r.file);
        NodeEvaluation e = evaluationOf(contentText(r.file));
        const Geometry shown = e.shown();
        REQUIRE(shown.size() == 1);
        CHECK(shown[0].elements == r.vertices);
        CHECK(shown[0].indexCount == 3 * r.triangles);
        auto positions = e.positions(shown[0]);
        REQUIRE(positions);
        CHECK(positions->size() == r.vertices);
        auto corners = e.corners(shown[0]);
        REQUIRE(corners);
        CHECK(*std::ranges::max_element(*corners) == r.vertices - 1);
    }
}

TEST_CASE("the woven sphere is what an oracle in double precision makes of the same particles") {
    for (const Resolution& r : kResolutions) {
        CAPTURE(r.file);
        NodeEvaluation e = evaluationOf(contentText(r.file));
        e.setTime({1000, 1.0 / 30});
        REQUIRE(e.evaluate());
        auto particles = e.positions(geometryOf(e, "points").front());
        REQUIRE(particles);
        for (const glm::vec3& p : *particles)
            for (int k = 0; k < 3; ++k) CHECK(std::abs(p[k]) <= 1);
        auto samples = e.positions(geometryOf(e, "curves").front());
        auto vertices = e.positions(e.shown().front());
        REQUIRE(samples);
        REQUIRE(vertices);
        double apartSamples = 0, apartVertices = 0, offSphere = 0;
        for (uint32_t c = 0; c < r.curves; ++c) {
            // Its keys follow from a hash, which is worked out once more here.
            std::vector<Point> keys;
            std::vector<uint32_t> taken;
            for (uint32_t k = 0; k < 8; ++k) {
                uint32_t point = mixed(c + mixed(1 + mixed(k + 0x51ED2701))) % r.points;
                while (std::ranges::find(taken, point) != taken.end()) point = (point + 1) % r.points;
                taken.push_back(point);
                keys.push_back(Point((*particles)[point]));
            }
            std::vector<Point> path;
            for (uint32_t j = 0; j < r.samples; ++j) {
                const Point at = splinePlace(keys, 7.0 * j / (r.samples - 1));
                apartSamples = std::max(apartSamples, glm::length(at - Point((*samples)[j * r.curves + c])));
                path.push_back(glm::normalize(at));
            }
            const std::vector<Frame> frames = framesAlong(path);
            for (uint32_t j = 0; j < r.samples; ++j)
                for (uint32_t u = 0; u < r.sides; ++u) {
                    const double angle = 2 * M_PI * u / (r.sides - 1);
                    const Point other = glm::cross(frames[j].along, frames[j].side);
                    const Point at =
                        path[j] + frames[j].side * (0.025 * std::cos(angle)) + other * (0.025 * std::sin(angle));
                    const Point is((*vertices)[(j * r.sides + u) * r.curves + c]);
                    apartVertices = std::max(apartVertices, glm::length(at - is));
                }
        }
        // What the modifier makes of samples, as loft takes them.
        NodeEvaluation flat = evaluationOf(
            contentText(r.file) + "\nthin = Circle(samples: 2, radius: 0)\non = Loft(sphere, thin)\nshow on\n");
        auto on = flat.positions(geometryOf(flat, "on").front());
        REQUIRE(on);
        for (const glm::vec3& p : *on) offSphere = std::max(offSphere, std::abs(glm::length(Point(p)) - 1));
        MESSAGE(std::string(r.file) << ": samples " << apartSamples << ", vertices " << apartVertices
                                    << " m apart, samples " << offSphere << " m off the sphere");
        CHECK(apartSamples < 2e-6);
        CHECK(apartVertices < 2e-5);
        CHECK(offSphere < 2e-6);
    }
}

TEST_CASE("lanes, threads and kernels make the same bits") {
    DeviceOptions options;
    Result<std::unique_ptr<Device>> device = Device::create(options);
    REQUIRE(device);
    for (const char* file : {"woven_sphere_low.graph", "woven_sphere.graph"}) {
        const std::string text = contentText(file);
        const auto hashBy = [&](std::unique_ptr<NodeMachine> machine) {
            NodeEvaluation e = evaluationOf(text, std::move(machine));
            e.setTime({77, 1.0 / 30});
            REQUIRE(e.evaluate());
            return hashOf(e);
        };
        const uint64_t plain = hashBy(hostMachine(1, true));
        for (const unsigned threads : {1u, 2u, 4u}) CHECK(hashBy(hostMachine(threads)) == plain);
        CHECK(hashBy(deviceMachine(**device, true)) == plain);
        CHECK(hashBy(deviceMachine(**device, false)) == plain);
    }
}
