// Real models of many pieces: how much of the length along which they run into each other can be crossed, and how
// many walks end where the model doesn't.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "shaders/shared/exact.h"
#include "shaders/shared/walk.h"
#include "tests/contact/oracle.hpp"
#include "tests/support/data.hpp"

using namespace espalier;
using namespace espalier::contacttest;

namespace {

constexpr int kSamples = 400, kWalks = 1000;

// The 3D line of a contact on its own side.
ContactLine lineOf(const SurfaceData& surface, const Crossing& c) {
    const uint32_t size = surface.levels[0].size;
    auto at = [&](glm::vec2 uv) {
        const glm::uvec2 texel = glm::min(glm::uvec2(uv * float(size)), glm::uvec2(size - 1));
        uint32_t triangle = surface.levels[0].aux[texelIndex(size, texel.x, texel.y)].triangle;
        if (triangle == kNoIndex || surface.triangles[triangle].chart != c.flags >> 16)
            triangle = surface.charts[c.flags >> 16].firstTriangle;
        const TrianglePlane& t = surface.triangles[triangle];
        return Vec3(t.position) + Vec3(t.du) * double(uv.x - t.uv0.x) + Vec3(t.dv) * double(uv.y - t.uv0.y);
    };
    return {at(c.a), at(c.b)};
}

double toSegment(Vec3 p, const ContactLine& l) {
    Vec3 d = l.b - l.a;
    double t = std::clamp(glm::dot(p - l.a, d) / std::max(glm::dot(d, d), 1e-300), 0.0, 1.0);
    return glm::length(p - (l.a + d * t));
}

struct Verdict {
    double crossed = 0;  // share of the sampled contact length
    int lines = 0, walks = 0, ended = 0, lost = 0;
    double contactLength = 0;
};

Verdict judge(const Model& model, const Baked& baked) {
    const SurfaceData& surface = baked.surface;
    Oracle oracle(model);
    Verdict verdict;
    double area = 0, uv = 0;
    for (const Chart& c : surface.charts) area += c.area, uv += c.area / (double(c.metresPerUv) * c.metresPerUv);
    double texel = std::sqrt(area / uv) / surface.levels[0].size;

    std::vector<ContactLine> lines = oracle.intersections(), contacts;
    for (const Crossing& c : surface.crossings)
        if ((c.flags & 3u) == kCrossingContact) contacts.push_back(lineOf(surface, c));
    std::vector<double> until;
    for (const ContactLine& l : lines) until.push_back((until.empty() ? 0 : until.back()) + glm::length(l.b - l.a));
    verdict.lines = int(lines.size());
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    int seen = 0, crossed = 0;
    if (!lines.empty()) {
        verdict.contactLength = until.back();
        for (int i = 0; i < kSamples; ++i) {
            size_t at =
                size_t(std::lower_bound(until.begin(), until.end(), unit(random) * until.back()) - until.begin());
            const ContactLine& l = lines[std::min(at, lines.size() - 1)];
            if (!oracle.visible(l)) continue;
            ++seen;
            Vec3 p = l.a + (l.b - l.a) * unit(random);
            crossed += std::any_of(contacts.begin(), contacts.end(),
                                   [&](const ContactLine& c) { return toSegment(p, c) <= 1.5 * texel; });
        }
        verdict.crossed = seen > 0 ? double(crossed) / seen : 1;
    }

    SurfaceRef ref = surfaceRef(surface);
    SurfaceBuf surfaces{&ref};
    const SurfaceLevelData& level = surface.levels[0];
    for (int tries = 0; verdict.walks < kWalks && tries < 2000000; ++tries) {
        uint32_t x = uint32_t(unit(random) * level.size), y = uint32_t(unit(random) * level.size);
        const Texel& t = level.texels[texelIndex(level.size, x, y)];
        if (texelClass(t.bits) != kTexelInner) continue;
        WalkState w{};
        Vec3 direction(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
        glm::vec2 start((float(x) + 0.5f) / float(level.size), (float(y) + 0.5f) / float(level.size));
        if (!startWalk(surfaces, 0, texelChart(t.bits), start, glm::vec3(direction), w)) continue;
        ++verdict.walks;
        float step = 0.02f * float(oracle.radius());
        uint event = kWalkDone;
        for (int i = 0; i < 150 && event == kWalkDone; ++i) event = walkStep(surfaces, 0, w, step);
        if (event == kWalkDone) continue;
        verdict.lost += event == kWalkLost;
        if (oracle.toBorder(Vec3(w.position), 3 * texel) > 3 * texel) {
            ++verdict.ended;
            if (std::getenv("ESPALIER_VERBOSE"))
                std::printf("    ended: event %u at %.4f %.4f %.4f chart %u uv %.5f %.5f arc %.3f texel %.4f\n", event,
                            w.position.x, w.position.y, w.position.z, w.walk.place & 0xFFFFu, w.walk.uv.x, w.walk.uv.y,
                            w.walk.arc, texel);
        }
    }
    return verdict;
}

}  // namespace

TEST_CASE("where pieces of real models run into each other, walks cross") {
    std::vector<const char*> files = {
        "derived/fort_unwrap_scene.glb", "models/kaykit_medieval/building_castle_blue.gltf",
        "models/quaternius/House2.glb",  "models/quaternius/House_3.glb",
        "models/quaternius/Gazebo.glb",  "models/kaykit_dungeon/wall.glb"};
    if (const char* more = std::getenv("ESPALIER_CONTACT_MODEL")) files = {more};
    for (const char* file : files) {
        auto path = test::dataFile(file);
        if (!path) continue;
        CAPTURE(file);
        auto model = importModel(*path);
        REQUIRE(model);
        auto baked = bake(*model, {});
        if (!baked) FAIL(baked.failure().text());
        Verdict v = judge(*model, *baked);
        MESSAGE(file << ": " << v.lines << " lines, " << v.contactLength << " m, crossed " << v.crossed * 100 << " %; "
                     << v.walks << " walks, " << v.ended << " end where the model goes on, " << v.lost << " lost; "
                     << baked->report.reachableShare() * 100 << " % of the ground can be got to");
        CHECK(baked->report.reachableShare() >= 0.95);
        CHECK(v.crossed >= 0.95);
        CHECK(v.ended <= v.walks * 0.005);
        CHECK(v.lost <= v.walks * 0.005);
    }
}
