// What inside views read of a surface: texels as the file has them, links that lead where the mesh goes on.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <set>

#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// Where a texel of this chart that is nearest to uv lies.
glm::vec3 placeNear(const Painting& painting, const float u, const float v, uint32_t chart) {
    const int side = int(painting.size()), cx = int(u * float(side)), cy = int(v * float(side));
    float best = 1e9f;
    glm::vec3 found(1e9f);
    for (int y = std::max(cy - 3, 0); y <= std::min(cy + 3, side - 1); ++y)
        for (int x = std::max(cx - 3, 0); x <= std::min(cx + 3, side - 1); ++x) {
            const Texel& texel = painting.texel(uint32_t(x), uint32_t(y));
            const float dx = float(x) + .5f - u * float(side), dy = float(y) + .5f - v * float(side);
            if (texelClass(texel.bits) != kTexelInner || texelChart(texel.bits) != chart || dx * dx + dy * dy > best)
                continue;
            best = dx * dx + dy * dy;
            found = texel.position;
        }
    return found;
}

}  // namespace

TEST_CASE("the atlas of every level is read back as it was baked") {
    const Painting painting;
    EspSurfaceInfo info{};
    painting.ok(espSurfaceInfo(painting.context, painting.surface, &info));
    REQUIRE(info.levels == painting.data.levels.size());
    for (uint32_t level = 0; level < info.levels; ++level) {
        const SurfaceLevelData& baked = painting.data.levels[level];
        uint32_t side = 0;
        painting.ok(espReadAtlas(painting.context, painting.surface, level, nullptr, &side));
        REQUIRE(side == baked.size);
        std::vector<uint32_t> texels(size_t(side) * side);
        painting.ok(espReadAtlas(painting.context, painting.surface, level, texels.data(), &side));
        size_t unlike = 0;
        for (uint32_t y = 0; y < side; ++y)
            for (uint32_t x = 0; x < side; ++x) {
                const uint32_t bits = baked.texels[texelIndex(side, x, y)].bits, read = texels[size_t(y) * side + x];
                const bool lost =
                    texelClass(bits) != kTexelEmpty && painting.data.charts[texelChart(bits)].coarsestLevel < level;
                unlike += texelChart(read) != texelChart(bits) || texelClass(read) != texelClass(bits);
                if (texelClass(bits) != kTexelEmpty) unlike += (read >> 18 & 1u) != uint32_t(lost);
            }
        CHECK(unlike == 0);
    }
    uint32_t small = painting.size() - 1, texel = 0;
    CHECK(espReadAtlas(painting.context, painting.surface, info.levels, nullptr, &small) == ESP_INVALID_ARGUMENT);
    CHECK(espReadAtlas(painting.context, painting.surface, 0, &texel, &small) == ESP_INVALID_ARGUMENT);
    CHECK(espReadAtlas(painting.context, {77}, 0, nullptr, &small) == ESP_INVALID_ARGUMENT);
}

TEST_CASE("what another surface buries is no ground in the atlas until that has moved away") {
    const Painting painting;
    EspTransform over = espIdentity(), away = espIdentity();
    over.rows[0][3] = 1.5f, over.rows[1][3] = over.rows[2][3] = .3f;  // from (.5, -.7, -.7) on
    away.rows[0][3] = 5;
    EspSurface second{};
    painting.ok(espLoadSurface(painting.context, painting.path.c_str(), &over, &second));
    for (bool covered : {true, false, true}) {
        painting.ok(espMoveSurface(painting.context, second, covered ? &over : &away));
        painting.ok(espUpdate(painting.context));
        for (uint32_t level : {0u, 1u}) {
            const SurfaceLevelData& baked = painting.data.levels[level];
            uint32_t side = baked.size, within = 0, unlike = 0;
            std::vector<uint32_t> texels(size_t(side) * side);
            painting.ok(espReadAtlas(painting.context, painting.surface, level, texels.data(), &side));
            const float texel = 12.f / float(side);  // metres: two and more
            for (uint32_t y = 0; y < side; ++y)
                for (uint32_t x = 0; x < side; ++x) {
                    const Texel& t = baked.texels[texelIndex(side, x, y)];
                    if (texelClass(t.bits) != kTexelInner) continue;
                    const glm::vec3 in = t.position - glm::vec3(.5f, -.7f, -.7f);
                    const float depth = std::min({in.x, in.y, in.z});
                    const bool shown = (texels[size_t(y) * side + x] >> 16 & 3u) != ESP_TEXEL_INNER;
                    within += depth > texel;
                    if (std::abs(depth) > texel || !covered) unlike += shown != (covered && depth > 0);
                }
            CHECK(within > 100);
            CHECK(unlike == 0);
        }
    }
}

TEST_CASE("links lead to the same place of the model, and every face of a cube to four others") {
    const Painting painting;
    uint32_t count = 0;
    painting.ok(espReadLinks(painting.context, painting.surface, nullptr, &count));
    REQUIRE(count > 0);
    std::vector<EspLink> links(count);
    painting.ok(espReadLinks(painting.context, painting.surface, links.data(), &count));
    const float texel = 4.f / float(painting.size());  // no face has fewer than a quarter of the side
    std::set<std::pair<uint32_t, uint32_t>> pairs;
    for (const EspLink& link : links) {
        REQUIRE(link.kind == ESP_LINK_SEAM);  // a cube is closed
        CHECK(link.toSurface.id == painting.surface.id);
        pairs.insert({link.chart, link.toChart});
        const glm::vec3 here =
            placeNear(painting, (link.a[0] + link.b[0]) / 2, (link.a[1] + link.b[1]) / 2, link.chart);
        const glm::vec3 there =
            placeNear(painting, (link.toA[0] + link.toB[0]) / 2, (link.toA[1] + link.toB[1]) / 2, link.toChart);
        CHECK(glm::distance(here, there) < 8 * texel);
    }
    CHECK(pairs.size() == painting.data.charts.size() * 4);
}

TEST_CASE("links of surfaces that touch are read with those between them, and without once they stand apart") {
    const Painting painting;
    const auto linksOf = [&](EspSurface surface) {
        uint32_t count = 0;
        painting.ok(espReadLinks(painting.context, surface, nullptr, &count));
        std::vector<EspLink> links(count);
        painting.ok(espReadLinks(painting.context, surface, links.data(), &count));
        return links;
    };
    const std::vector<EspLink> alone = linksOf(painting.surface);
    const glm::vec3 offset(1.5f, .3f, .3f);
    EspTransform over = espIdentity(), away = espIdentity();
    for (int i = 0; i < 3; ++i) over.rows[i][3] = offset[i];
    away.rows[0][3] = 5;
    EspSurface second{};
    painting.ok(espLoadSurface(painting.context, painting.path.c_str(), &over, &second));
    painting.ok(espUpdate(painting.context));
    const float texel = 4.f / float(painting.size());
    for (EspSurface surface : {painting.surface, second}) {
        const std::vector<EspLink> links = linksOf(surface);
        REQUIRE(links.size() > alone.size());
        const auto placed = [&](const float a[2], const float b[2], uint32_t chart, uint32_t on) {
            const glm::vec3 place = placeNear(painting, (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, chart);
            return on == second.id ? place + offset : place;
        };
        size_t across = 0;
        for (const EspLink& link : links) {
            across += link.toSurface.id != surface.id;
            const glm::vec3 here = placed(link.a, link.b, link.chart, surface.id);
            const glm::vec3 there = placed(link.toA, link.toB, link.toChart, link.toSurface.id);
            CHECK(glm::distance(here, there) < 8 * texel);
        }
        CHECK(across == links.size() - alone.size());
    }
    painting.ok(espMoveSurface(painting.context, second, &away));
    painting.ok(espUpdate(painting.context));
    CHECK(linksOf(painting.surface).size() == alone.size());
}
