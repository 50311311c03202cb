// The files that the tool writes: the same on every run, valid in their frame, and nothing half-written.

#include <doctest/doctest.h>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tools/content/content.hpp"
#include "tools/content/delaunay.hpp"
#include "tools/content/noise.hpp"

using namespace espalier;

namespace {

std::vector<char> bytesOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

struct Folder {
    std::filesystem::path path;
    explicit Folder(const char* name) : path(std::filesystem::temp_directory_path() / name) {
        std::filesystem::remove_all(path);
    }
    ~Folder() { std::filesystem::remove_all(path); }
};

}  // namespace

TEST_CASE("two runs write the same bytes, and the binaries' frames are right") {
    Folder first("espalier_content_1"), second("espalier_content_2");
    for (const Folder* f : {&first, &second}) REQUIRE(content::generate({f->path.string(), "", 256}));
    for (const char* name : {"ruin.glb", "mask.png", "ivy.png", "terminals.glb", "roofs.glb", "props.glb", "pieces.glb",
                             "cuirass.glb", "vase.glb", "knot.glb", "pear.glb", "torus.glb", "tori.glb", "plane.glb"}) {
        CAPTURE(name);
        std::vector<char> a = bytesOf(first.path / name);
        CHECK(a.size() > 1000);
        CHECK(a == bytesOf(second.path / name));
        if (std::string(name).ends_with(".glb")) {
            uint32_t head[3];
            std::memcpy(head, a.data(), 12);
            CHECK(head[0] == 0x46546C67u);
            CHECK(head[1] == 2);
            CHECK(head[2] == a.size());
        }
    }
    CHECK(std::distance(std::filesystem::directory_iterator(first.path), std::filesystem::directory_iterator()) == 14);
}

TEST_CASE("a folder that can't be made is reported by name") {
    Status status = content::generate({"/proc/nowhere/content", "", 256});
    REQUIRE(!status);
    CHECK(status.failure().text().find("/proc/nowhere") != std::string::npos);
}

TEST_CASE("Delaunay triangles cover the hull and hold no point in their circles") {
    std::vector<glm::dvec2> points;
    for (uint32_t i = 0; i < 300; ++i) points.push_back({content::random01(i, 1), content::random01(i, 2)});
    for (glm::dvec2 corner : {glm::dvec2(-1, -1), glm::dvec2(2, -1), glm::dvec2(2, 2), glm::dvec2(-1, 2)})
        points.push_back(corner);
    double area = 0;
    size_t within = 0;
    for (auto& t : content::delaunay(points)) {
        glm::dvec2 a = points[t[0]], b = points[t[1]] - a, c = points[t[2]] - a;
        double twice = b.x * c.y - b.y * c.x;
        area += twice / 2;
        CHECK(twice > 0);
        glm::dvec2 centre =
            glm::dvec2(c.y * glm::dot(b, b) - b.y * glm::dot(c, c), b.x * glm::dot(c, c) - c.x * glm::dot(b, b)) /
            (2 * twice);
        for (auto& p : points) within += glm::distance(p, a + centre) > glm::length(centre) - 1e-5 ? 0u : 1u;
    }
    CHECK(within == 0);
    CHECK(area == doctest::Approx(9).epsilon(1e-6));
}
