// Displacement by a picture, against sums in double precision; and pictures that are none.
#include <cmath>

#include "runtime/gpu/device.hpp"
#include "runtime/surface/picture.hpp"
#include "tests/nodes/graphs.hpp"

using namespace espalier;
using namespace espalier::nodetest;

namespace {

const std::string kRippled =
    "graph 1\nball = Sphere(radius: 1, sides: 24)\n"
    "out = Displace(ball, amount: 0.3, scale: 0.7, offset: (0.2, -3.4, 0.55), picture: \"ripples.png\", level: 0.25)\n"
    "all = Filter(out)\nshow all\n";

std::vector<std::byte> ripples() {
    Result<std::vector<std::byte>> file = readFile("content/ripples.png");
    REQUIRE(file);
    return std::move(*file);
}

// A graph whose file holds these bytes.
NodeEvaluation withPicture(const std::string& text, const std::vector<std::byte>& bytes,
                           std::unique_ptr<NodeMachine> machine = hostMachine(1)) {
    NodeEvaluation e(std::move(machine), [&bytes](const std::string&, const std::string& name) {
        return Result<NodeFile>(NodeFile{name, bytes});
    });
    REQUIRE(e.load(parsed(text)));
    REQUIRE(e.evaluate());
    return e;
}

std::vector<glm::vec3> placesOf(NodeEvaluation& e, const char* node) {
    return *e.positions(geometryOf(e, node).front());
}

// Between the four texels around a place, of a picture that repeats; u to the right, v upwards.
double greyAt(const UvPicture& picture, double u, double v) {
    const auto texel = [&](int x, int y) {
        const int w = int(picture.width), h = int(picture.height);
        return double(picture.texels[size_t((y % h + h) % h) * picture.width + size_t((x % w + w) % w)]);
    };
    const double x = u * picture.width - 0.5, y = -v * picture.height - 0.5;
    const int left = int(std::floor(x)), over = int(std::floor(y));
    const double s = x - left, t = y - over;
    return (texel(left, over) * (1 - s) + texel(left + 1, over) * s) * (1 - t) +
           (texel(left, over + 1) * (1 - s) + texel(left + 1, over + 1) * s) * t;
}

}  // namespace

TEST_CASE("a picture moves vertices along their normals as far as it is light there") {
    const std::vector<std::byte> bytes = ripples();
    Result<UvPicture> picture = decodeGrey(bytes, "ripples.png", 4096);
    REQUIRE(picture);
    NodeEvaluation e = withPicture(kRippled, bytes);
    REQUIRE(e.failures().empty());
    const std::vector<glm::vec3> from = placesOf(e, "ball"), to = placesOf(e, "all");
    REQUIRE(from.size() == to.size());
    double apart = 0, least = 9, most = 0;
    for (size_t i = 0; i < from.size(); ++i) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(from[i]));
        const glm::dvec3 q = glm::dvec3(from[i]) * double(0.7f) + glm::dvec3(0.2f, -3.4f, 0.55f);
        const double grey = n.x * n.x * greyAt(*picture, q.z, q.y) + n.y * n.y * greyAt(*picture, q.x, q.z) +
                            n.z * n.z * greyAt(*picture, q.x, q.y);
        const glm::dvec3 wanted = glm::dvec3(from[i]) + n * double(0.3f) * (grey - 0.25);
        apart = std::max(apart, glm::length(wanted - glm::dvec3(to[i])));
        least = std::min(least, glm::length(wanted));
        most = std::max(most, glm::length(wanted));
    }
    // Normals have 16 bits a direction, which is a few millionths of the way that a vertex goes.
    CHECK(apart < 2e-5);
    CHECK(least < 0.97);
    CHECK(most > 1.15);
    // In another place of a plane, the next picture's same texel.
    REQUIRE(e.setInput("out", "offset", Literal(glm::vec3(1.2f, -2.4f, 5.55f))));
    REQUIRE(e.evaluate());
    const std::vector<glm::vec3> again = placesOf(e, "all");
    double moved = 0;
    for (size_t i = 0; i < to.size(); ++i) moved = std::max(moved, double(glm::length(to[i] - again[i])));
    CHECK(moved < 1e-4);
}

TEST_CASE("a picture's displacement has the same bits by kernels, lanes and scalar code") {
    const std::vector<std::byte> bytes = ripples();
    const auto places = [&](std::unique_ptr<NodeMachine> machine) {
        NodeEvaluation e = withPicture(kRippled, bytes, std::move(machine));
        return placesOf(e, "all");
    };
    Result<std::unique_ptr<Device>> device = Device::create();
    REQUIRE(device);
    const std::vector<glm::vec3> plain = places(hostMachine(1, true));
    CHECK(places(hostMachine(2)) == plain);
    CHECK(places(deviceMachine(**device, false)) == plain);
}

TEST_CASE("what is no picture is told by its node, and the last good one stays") {
    std::vector<std::byte> bytes = ripples();
    NodeEvaluation e = withPicture(kRippled, bytes);
    const std::vector<glm::vec3> good = placesOf(e, "all");
    const auto toldOf = [&](std::vector<std::byte> other, const char* amount) {
        bytes = std::move(other);
        REQUIRE(e.setInput("out", "amount", Literal(float(std::atof(amount)))));
        REQUIRE(e.evaluate());
        REQUIRE(e.failures().size() == 1);
        CHECK(e.failures().front().rule == "out");
        CHECK(placesOf(e, "all") == good);
        return e.failures().front().message;
    };
    const std::vector<std::byte> whole = bytes;
    const auto part = [&](size_t size) { return std::vector<std::byte>(whole.begin(), whole.begin() + long(size)); };
    CHECK(toldOf({}, "0.1").find("ripples.png") != std::string::npos);
    CHECK(toldOf(part(20), "0.2").find("ripples.png") != std::string::npos);
    CHECK(toldOf(part(1000), "0.35").find("ripples.png") != std::string::npos);
    CHECK(toldOf(std::vector<std::byte>(500, std::byte('x')), "0.4").find("ripples.png") != std::string::npos);
    std::vector<std::byte> wide = whole;  // 16,777,344 texels wide
    wide[16] = std::byte(1);
    CHECK(toldOf(wide, "0.5").find("ripples.png") != std::string::npos);
    bytes = whole;
    REQUIRE(e.setInput("out", "amount", Literal(0.3f)));
    REQUIRE(e.evaluate());
    CHECK(e.failures().empty());
    CHECK(placesOf(e, "all") == good);
}
