// Real models of many pieces: how much of the length along which they run into each other can be crossed, how many
// walks end where the model doesn't, and how many get into a closed piece.
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
constexpr double kInsideTexels = 3;  // deeper in a closed piece no bark may lie
constexpr double kRoomTexels = 1.5;  // slits as narrow are walked over: tests/bake's groove between boards

Vec3 placeOf(const SurfaceData& surface, uint32_t chart, glm::vec2 uv) {
    const uint32_t size = surface.levels[0].size;
    const glm::uvec2 texel = glm::min(glm::uvec2(uv * float(size)), glm::uvec2(size - 1));
    uint32_t triangle = surface.levels[0].aux[texelIndex(size, texel.x, texel.y)].triangle;
    if (triangle == kNoIndex || surface.triangles[triangle].chart != chart)
        triangle = surface.charts[chart].firstTriangle;
    const TrianglePlane& t = surface.triangles[triangle];
    return Vec3(t.position) + Vec3(t.du) * double(uv.x - t.uv0.x) + Vec3(t.dv) * double(uv.y - t.uv0.y);
}

// The 3D line of a crossing on its own side.
ContactLine lineOf(const SurfaceData& surface, const Crossing& c) {
    return {placeOf(surface, c.flags >> 16, c.a), placeOf(surface, c.flags >> 16, c.b)};
}

// Does a chart go on from piece to piece near p?
bool chartGoesOn(const SurfaceData& surface, const Oracle& oracle, Vec3 p, double within) {
    struct Place {
        uint32_t x, y, chart, piece;
    };
    std::vector<Place> places;
    const SurfaceLevelData& level = surface.levels[0];
    for (uint32_t y = 0; y < level.size; ++y)
        for (uint32_t x = 0; x < level.size; ++x) {
            const Texel& t = level.texels[texelIndex(level.size, x, y)];
            if (texelClass(t.bits) != kTexelInner || glm::length(Vec3(t.position) - p) > within) continue;
            const Place q{x, y, texelChart(t.bits), oracle.pieceAt(Vec3(t.position))};
            for (const Place& r : places)
                if (r.chart == q.chart && r.piece != q.piece && (x - r.x) + (y - r.y) <= 1) return true;
            places.push_back(q);
        }
    return false;
}

// Does a border lead from piece to piece? Pieces that stand corner to corner share edges, and what is shared is a seam.
bool leadsOn(const SurfaceData& surface, const Oracle& oracle, const Crossing& c) {
    auto piece = [&](uint32_t chart, glm::vec2 a, glm::vec2 b, bool left) {
        const glm::vec2 e = b - a, inward = glm::vec2(-e.y, e.x) * (left ? 1.0f : -1.0f) / glm::length(e);
        return oracle.pieceAt(placeOf(surface, chart, (a + b) * 0.5f + inward / float(surface.levels[0].size)));
    };
    const uint32_t chart = c.flags >> 16, target = c.target & 0xFFFFu;
    const bool left = (c.flags & kCrossingInsideLeft) != 0;
    const bool alike = surface.charts[chart].orientation * surface.charts[target].orientation > 0;
    return piece(chart, c.a, c.b, left) != piece(target, c.ta, c.tb, left != alike);
}

double toSegment(Vec3 p, const ContactLine& l) {
    Vec3 d = l.b - l.a;
    double t = std::clamp(glm::dot(p - l.a, d) / std::max(glm::dot(d, d), 1e-300), 0.0, 1.0);
    return glm::length(p - (l.a + d * t));
}

struct Verdict {
    double crossed = 0;  // share of the sampled contact length
    int lines = 0, walks = 0, ended = 0, lost = 0, inside = 0;
    double contactLength = 0;
};

void tellInside(const Oracle& oracle, const WalkState& before, const WalkState& w, uint32_t piece, double texel) {
    auto tell = [&](const WalkState& s) {
        std::printf(" %.4f %.4f %.4f (piece %u, chart %u, uv %.5f %.5f)", s.position.x, s.position.y, s.position.z,
                    oracle.pieceAt(Vec3(s.position)), s.walk.place & 0xFFFFu, s.walk.uv.x, s.walk.uv.y);
    };
    std::printf("    inside piece %u, from", piece);
    tell(before);
    std::printf(" to");
    tell(w);
    std::printf(" texel %.4f\n", texel);
}

Verdict judge(const Model& model, const Baked& baked) {
    const SurfaceData& surface = baked.surface;
    Oracle oracle(model);
    Verdict verdict;
    double area = 0, uv = 0;
    for (const Chart& c : surface.charts) area += c.area, uv += c.area / (double(c.metresPerUv) * c.metresPerUv);
    double texel = std::sqrt(area / uv) / surface.levels[0].size;

    std::vector<ContactLine> lines = oracle.intersections(), contacts, seams;
    std::vector<const Crossing*> seamOf;
    for (const Crossing& c : surface.crossings) {
        const uint32_t kind = c.flags & 3u;
        if (kind == kCrossingContact) contacts.push_back(lineOf(surface, c));
        // Near borders lead from piece to piece as seams do.
        if (kind == kCrossingSeam || kind == kCrossingNearest)
            seams.push_back(lineOf(surface, c)), seamOf.push_back(&c);
    }
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
            if (!oracle.visible(l, kRoomTexels * texel)) continue;
            ++seen;
            Vec3 p = l.a + (l.b - l.a) * unit(random);
            bool crosses = std::any_of(contacts.begin(), contacts.end(),
                                       [&](const ContactLine& c) { return toSegment(p, c) <= 1.5 * texel; });
            for (size_t k = 0; k < seams.size() && !crosses; ++k)
                crosses = toSegment(p, seams[k]) <= 0.1 * texel && leadsOn(surface, oracle, *seamOf[k]);
            crosses = crosses || chartGoesOn(surface, oracle, p, 1.5 * texel);
            if (!crosses && std::getenv("ESPALIER_VERBOSE"))
                std::printf("    not crossed: %.4f %.4f %.4f\n", p.x, p.y, p.z);
            crossed += crosses;
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
        // Nobody seeds where nobody looks, as inside of a hull that stands without its floor.
        if (!oracle.seen(Vec3(w.position) + Vec3(w.normal) * (0.05 * texel), w.normal)) continue;
        ++verdict.walks;
        float step = 0.02f * float(oracle.radius());
        uint event = kWalkDone;
        bool inside = false;
        WalkState before = w;
        for (int i = 0; i < 150 && event == kWalkDone; ++i) {
            float remaining = step;
            event = kWalkRetry;
            while (walkGoesOn(event)) {
                glm::vec3 jointNormal;
                event = walkAdvance(surfaces, 0, w, remaining, jointNormal);
                if (inside || !walkHasSample(event)) continue;
                const uint32_t piece = oracle.insideOf(Vec3(w.position), kInsideTexels * texel);
                inside = piece != Oracle::kNoPiece;
                if (inside && std::getenv("ESPALIER_VERBOSE")) tellInside(oracle, before, w, piece, texel);
                before = w;
            }
        }
        verdict.inside += inside;
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
    std::vector<const char*> files = {"derived/fort_unwrap_scene.glb",
                                      "models/kaykit_medieval/building_castle_blue.gltf",
                                      "models/quaternius/House2.glb",
                                      "models/quaternius/House_3.glb",
                                      "models/quaternius/Gazebo.glb",
                                      "models/kaykit_dungeon/wall.glb",
                                      "models/kaykit_city/building_H_withoutBase.gltf",
                                      "models/kaykit_medieval/wall_corner_A_gate.gltf",
                                      "models/khronos/Lantern/glTF/Lantern.gltf"};
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
                     << v.walks << " walks, " << v.ended << " end where the model goes on, " << v.lost << " lost, "
                     << v.inside << " get inside; " << baked->report.reachableShare() * 100
                     << " % of the ground can be got to");
        CHECK(baked->report.reachableShare() >= 0.95);
        CHECK(v.crossed >= 0.95);
        CHECK(v.ended <= v.walks * 0.005);
        CHECK(v.lost <= v.walks * 0.005);
        CHECK(v.inside <= v.walks * 0.005);
    }
}
