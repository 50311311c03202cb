// In: a level's ids, the planes of triangles, crossings, creases. Out: the level's records in their tiles:
// position, class, clearance, crease, curvature, normal, triangle, and the lists of crossings.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "runtime/core/jobs.hpp"
#include "shaders/shared/exact.h"
#include "tools/bake/bake_mesh.hpp"
#include "tools/bake/bands.hpp"
#include "tools/bake/beside.hpp"

namespace espalier::bakery {
namespace {

constexpr double kCreaseGrow = 1.5;       // a texel's half side and one texel around
constexpr double kCreaseAltitude = 1;     // texels: creases between narrower triangles are roundings
constexpr float kMaxStretch = 4;          // gutters never run faster than this times the chart's mean scale
constexpr float kSlitTexels = 0.5f;       // positions that far off their chart's near side lie beyond a slit
constexpr float kCreaseCosine = 0.9659f;  // 15°

struct LevelWork {
    const LevelSource& source;
    const IdImage& image;
    SurfaceLevelData& level;
    std::vector<uint8_t> distance;  // to the nearest texel with a crossing, chessboard, row by row
    std::vector<uint8_t> crease;    // row by row

    uint32_t chartAt(size_t x, size_t y) const {
        uint32_t id = image.id[y * image.size + x];
        if (id == kNone) return kNone;
        return source.mesh.chartOf(id & kGutterBit ? id & ~kGutterBit : id * 3);
    }
};

// The crossings that come near each band.
Bands bandsOf(std::span<const Crossing> crossings, uint32_t size, double reach) {
    return Bands(crossings.size(), size, [&](size_t i) {
        const double a = double(crossings[i].a.y) * size, b = double(crossings[i].b.y) * size;
        return std::pair(std::min(a, b) - reach, std::max(a, b) + reach);
    });
}

// Lists the crossings of each texel's own chart that pass its square.
void listCrossings(LevelWork& work, std::vector<uint8_t>& walkable) {
    const auto& crossings = work.source.crossings;
    uint32_t size = work.image.size;
    size_t bands = (size + kBandRows - 1) / kBandRows;
    struct Hit {
        uint32_t texel, crossing;
    };
    std::vector<std::vector<Hit>> hits(bands);
    const Bands near = bandsOf(crossings, size, 1);
    parallelFor(size, kBandRows, [&](size_t begin, size_t end) {
        auto& mine = hits[begin / kBandRows];
        for (uint32_t i : near.at(begin)) {
            glm::dvec2 a = glm::dvec2(crossings[i].a) * double(size), b = glm::dvec2(crossings[i].b) * double(size);
            uint32_t chart = crossings[i].flags >> 16;
            gridSegment(a, b, kCrossingGrow, size, int64_t(begin), int64_t(end),
                        [&](int64_t y, int64_t x0, int64_t x1) {
                            for (int64_t x = x0; x <= x1; ++x)
                                if (work.chartAt(size_t(x), size_t(y)) == chart)
                                    mine.push_back({texelIndex(size, uint32_t(x), uint32_t(y)), i});
                        });
        }
    });
    std::vector<size_t> first(bands + 1, 0);
    for (size_t b = 0; b < bands; ++b) first[b + 1] = first[b] + hits[b].size();
    auto& level = work.level;
    level.crossingHead.assign(size_t(size) * size, 0);
    level.crossingRefs.resize(first[bands]);
    std::vector<std::vector<uint32_t>> crowded(bands);
    parallelFor(bands, 1, [&](size_t band, size_t) {
        size_t base = band * kBandRows * size, count = std::min(size_t(size) * kBandRows, size_t(size) * size - base);
        std::vector<uint32_t> start(count + 1, 0);
        for (const Hit& h : hits[band]) ++start[h.texel - base + 1];
        for (size_t i = 0; i < count; ++i) {
            uint32_t n = start[i + 1];
            start[i + 1] += start[i];
            if (n == 0) continue;
            level.crossingHead[base + i] = uint32_t(first[band] + start[i]) << 8 | std::min(n, 255u);
            if (n > 255) crowded[band].push_back(uint32_t(base + i));
        }
        for (const Hit& h : hits[band]) level.crossingRefs[first[band] + start[h.texel - base]++] = h.crossing;
    });
    for (const auto& band : crowded)
        for (uint32_t texel : band) {
            uint32_t crossing = level.crossingRefs[level.crossingHead[texel] >> 8];
            walkable[crossings[crossing].flags >> 16] = 0;
        }
}

// Chessboard distance in texels, up to 64, to the nearest texel that lists a crossing. Along rows first: then distances
// of texels side by side differ by one at most, and each row only has to look at those before and after it.
void measureClearance(LevelWork& work) {
    const uint32_t size = work.image.size;
    work.distance.resize(size_t(size) * size);
    const auto rowAt = [&](size_t y) { return work.distance.data() + y * size; };
    const auto further = [](uint8_t d) { return uint8_t(d + 1); };
    parallelFor(size, kBandRows, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y) {
            uint8_t* d = rowAt(y);
            uint8_t last = 64;
            for (uint32_t x = 0; x < size; ++x) {
                const bool listed = (work.level.crossingHead[texelIndex(size, x, uint32_t(y))] & 255u) != 0;
                d[x] = last = listed ? 0 : std::min<uint8_t>(64, further(last));
            }
            for (uint32_t x = size - 1; x-- > 0;) d[x] = last = std::min(d[x], further(last));
        }
    });
    const auto relax = [&](size_t y, size_t from) {
        uint8_t* d = rowAt(y);
        const uint8_t* f = rowAt(from);
        d[0] = std::min(d[0], further(std::min(f[0], f[1])));
        for (size_t x = 1; x + 1 < size; ++x)
            d[x] = std::min(d[x], further(std::min(f[x - 1], std::min(f[x], f[x + 1]))));
        d[size - 1] = std::min(d[size - 1], further(std::min(f[size - 2], f[size - 1])));
    };
    for (size_t y = 1; y < size; ++y) relax(y, y - 1);
    for (size_t y = size - 1; y-- > 0;) relax(y, y + 1);
}

// The height of a triangle over one of its edges, in UV.
double altitude(const BakeMesh& mesh, uint32_t h) {
    double length = glm::length(mesh.uvAt(BakeMesh::next(h)) - mesh.uvAt(h));
    return length > 0 ? 2 * std::abs(uvArea(mesh.triangles[h / 3])) / length : 0;
}

void markCreases(LevelWork& work) {
    const auto& mesh = work.source.mesh;
    uint32_t size = work.image.size;
    work.crease.assign(size_t(size) * size, 0);
    const auto& creases = work.source.creases;
    const Bands bands(creases.size(), size, [&](size_t i) {
        const double a = mesh.uvAt(creases[i]).y * size, b = mesh.uvAt(BakeMesh::next(creases[i])).y * size;
        return std::pair(std::min(a, b) - 2, std::max(a, b) + 2);
    });
    parallelFor(size, kBandRows, [&](size_t begin, size_t end) {
        for (uint32_t i : bands.at(begin)) {
            const uint32_t h = creases[i];
            glm::dvec2 a = mesh.uvAt(h) * double(size), b = mesh.uvAt(BakeMesh::next(h)) * double(size);
            if (std::min(altitude(mesh, h), altitude(mesh, mesh.twin[h])) * size < kCreaseAltitude) continue;
            uint32_t chart = mesh.chartOf(h);
            gridSegment(a, b, kCreaseGrow, size, int64_t(begin), int64_t(end), [&](int64_t y, int64_t x0, int64_t x1) {
                for (int64_t x = x0; x <= x1; ++x)
                    if (work.chartAt(size_t(x), size_t(y)) == chart) work.crease[size_t(y) * size + size_t(x)] = 1;
            });
        }
    });
}

uint32_t encodeCurvature(float curvature, float radius) {
    float q = std::round(8 * std::log2(1 + std::abs(curvature) * radius));
    return uint32_t(std::clamp(q, 0.0f, 127.0f)) | (curvature < 0 ? 128u : 0u);
}

struct Sample {
    glm::vec3 position, normal;
    float curvature;
    uint32_t triangle, kind;
};

Sample sampleInner(const LevelSource& source, uint32_t t, glm::dvec2 uv) {
    const Plane& plane = source.planes[t];
    const auto& point = source.mesh.triangles[t].point;
    const glm::vec3* n = &source.mesh.normals[size_t(t) * 3];
    glm::vec2 d(uv - plane.uv0);
    float w1 = glm::dot(plane.g1, d), w2 = glm::dot(plane.g2, d), w0 = 1 - w1 - w2;
    const auto& k = source.mesh.curvature;
    return {placeOn(source.records[t], glm::vec2(uv)), n[0] * w0 + n[1] * w1 + n[2] * w2,
            k[point[0]] * w0 + k[point[1]] * w1 + k[point[2]] * w2, t, kTexelInner};
}

Sample sampleGutter(const LevelSource& source, const std::vector<uint8_t>& open, uint32_t h, glm::dvec2 uv) {
    const auto& mesh = source.mesh;
    uint32_t t = h / 3, n = BakeMesh::next(h);
    const Plane& plane = source.planes[t];
    glm::dvec2 a = mesh.uvAt(h), b = mesh.uvAt(n), d = b - a;
    float s = float(std::clamp(glm::dot(uv - a, d) / std::max(glm::dot(d, d), 1e-300), 0.0, 1.0));
    glm::vec2 away(uv - (a + d * double(s)));
    glm::vec3 onEdge = glm::vec3(mesh.pointAt(h)) * (1 - s) + glm::vec3(mesh.pointAt(n)) * s;
    glm::vec3 step = plane.e1 * glm::dot(plane.g1, away) + plane.e2 * glm::dot(plane.g2, away);
    // A sliver's map may be wild: what it carries outward is capped.
    float length = glm::length(step),
          most = kMaxStretch * source.charts[mesh.chartOf(h)].metresPerUv * glm::length(away);
    const glm::vec3 place = length > most ? onEdge + step * (most / length) : placeOn(source.records[t], glm::vec2(uv));
    const auto& k = mesh.curvature;
    const auto& point = mesh.triangles[t].point;
    return {place, mesh.normals[h] * (1 - s) + mesh.normals[n] * s, k[point[h % 3]] * (1 - s) + k[point[n % 3]] * s, t,
            open[h] ? kTexelOpen : kTexelLink};
}

void fillTexels(LevelWork& work) {
    const LevelSource& source = work.source;
    const auto& mesh = source.mesh;
    uint32_t size = work.image.size;
    // A border counts as open when more of it is open than not.
    std::vector<uint8_t> open(mesh.joined.size(), 0);
    std::vector<float> balance(mesh.joined.size(), 0);
    for (const Link& link : source.links) {
        const bool ends = link.to == kNone || mesh.parted(link.from / 3, link.to / 3);
        balance[link.from] += float(link.from1 - link.from0) * (ends ? 1.0f : -1.0f);
    }
    for (size_t h = 0; h < open.size(); ++h) open[h] = balance[h] > 0;
    auto& level = work.level;
    float radius = float(mesh.radius);
    parallelFor(size, 8, [&](size_t begin, size_t end) {
        for (size_t y = begin; y < end; ++y)
            for (size_t x = 0; x < size; ++x) {
                uint32_t id = work.image.id[y * size + x];
                size_t at = texelIndex(size, uint32_t(x), uint32_t(y));
                if (id == kNone) {
                    level.texels[at] = {glm::vec3(0), 0};
                    level.aux[at] = {0, kNoIndex};
                    continue;
                }
                glm::dvec2 uv((double(x) + 0.5) / size, (double(y) + 0.5) / size);
                Sample s =
                    id & kGutterBit ? sampleGutter(source, open, id & ~kGutterBit, uv) : sampleInner(source, id, uv);
                uint32_t far = work.distance[y * size + x];
                uint32_t clearance = far > 1 ? std::min(far - 1, 31u) : 0;
                level.texels[at] = {s.position,
                                    packTexelBits(mesh.triangles[s.triangle].chart, s.kind, work.crease[y * size + x],
                                                  clearance, encodeCurvature(s.curvature, radius))};
                float length2 = glm::dot(s.normal, s.normal);
                level.aux[at] = {packOct(length2 > 1e-12f ? s.normal : source.planes[s.triangle].normal), s.triangle};
            }
    });
}

// A slit of a chart narrower than a bilinear read puts texels of its far side into cells of the near one. They are
// found by where the near side's triangle would have them, and their surroundings marked as creases.
void markSlits(LevelWork& work) {
    const LevelSource& source = work.source;
    uint32_t size = work.image.size;
    std::vector<uint8_t> far(size_t(size) * size, 0);
    std::atomic<bool> any = false;
    const Bands bands = bandsOf({source.crossings.data(), source.links.size()}, size, 2);
    parallelFor(size, kBandRows, [&](size_t begin, size_t end) {
        bool found = false;
        for (uint32_t i : bands.at(begin)) {
            glm::dvec2 a = glm::dvec2(source.crossings[i].a) * double(size);
            glm::dvec2 b = glm::dvec2(source.crossings[i].b) * double(size);
            uint32_t t = source.links[i].from / 3, chart = source.mesh.triangles[t].chart;
            const Plane& plane = source.planes[t];
            float limit = kSlitTexels * source.charts[chart].metresPerUv / float(size);
            gridSegment(a, b, 1, size, int64_t(begin), int64_t(end), [&](int64_t y, int64_t x0, int64_t x1) {
                for (int64_t x = x0; x <= x1; ++x) {
                    if (work.chartAt(size_t(x), size_t(y)) != chart) continue;
                    size_t at = texelIndex(size, uint32_t(x), uint32_t(y));
                    if (work.level.aux[at].triangle == t) continue;
                    glm::vec2 d(glm::dvec2((double(x) + 0.5) / size, (double(y) + 0.5) / size) - plane.uv0);
                    glm::vec3 p = plane.p0 + plane.e1 * glm::dot(plane.g1, d) + plane.e2 * glm::dot(plane.g2, d);
                    if (glm::length(p - work.level.texels[at].position) < limit) continue;
                    far[size_t(y) * size + size_t(x)] = 1;
                    found = true;
                }
            });
        }
        if (found) any = true;
    });
    if (!any) return;
    parallelFor(size - 2, kBandRows, [&](size_t begin, size_t end) {
        for (size_t y = begin + 1; y < end + 1; ++y)
            for (size_t x = 1; x + 1 < size; ++x) {
                const uint8_t* f = &far[y * size + x];
                bool near = false;
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx) near = near || f[dy * int64_t(size) + dx];
                if (near && work.image.id[y * size + x] != kNone)
                    work.level.texels[texelIndex(size, uint32_t(x), uint32_t(y))].bits |= 1u << 18;
            }
    });
}

}  // namespace

std::vector<Plane> makePlanes(const BakeMesh& mesh) {
    std::vector<Plane> planes(mesh.triangles.size());
    parallelFor(planes.size(), 8192, [&](size_t begin, size_t end) {
        for (size_t t = begin; t < end; ++t) {
            const Triangle& tri = mesh.triangles[t];
            glm::dvec2 u1 = tri.uv[1] - tri.uv[0], u2 = tri.uv[2] - tri.uv[0];
            double det = cross(u1, u2);
            glm::dvec3 p0 = mesh.points[tri.point[0]], e1 = mesh.points[tri.point[1]] - p0,
                       e2 = mesh.points[tri.point[2]] - p0;
            planes[t] = {tri.uv[0],
                         glm::vec2(u2.y / det, -u2.x / det),
                         glm::vec2(-u1.y / det, u1.x / det),
                         glm::vec3(p0),
                         glm::vec3(e1),
                         glm::vec3(e2),
                         glm::vec3(glm::normalize(glm::cross(e1, e2)))};
        }
    });
    return planes;
}

std::vector<uint32_t> creaseEdges(const BakeMesh& mesh) {
    std::vector<uint32_t> out;
    std::vector<glm::vec3> normal(mesh.triangles.size());
    for (size_t t = 0; t < normal.size(); ++t) {
        const auto& p = mesh.triangles[t].point;
        normal[t] = glm::vec3(
            glm::normalize(glm::cross(mesh.points[p[1]] - mesh.points[p[0]], mesh.points[p[2]] - mesh.points[p[0]])));
    }
    for (uint32_t h = 0; h < mesh.joined.size(); ++h)
        if (mesh.joined[h] && h < mesh.twin[h] && glm::dot(normal[h / 3], normal[mesh.twin[h] / 3]) < kCreaseCosine)
            out.push_back(h);
    return out;
}

SurfaceLevelData composeLevel(const LevelSource& source, const IdImage& image, std::vector<uint8_t>& walkable) {
    SurfaceLevelData level;
    level.size = image.size;
    LevelWork work{source, image, level, {}, {}};
    listCrossings(work, walkable);
    // Fresh memory is slow to touch.
    beside(
        [&] {
            level.texels.resize(size_t(level.size) * level.size);
            level.aux.resize(size_t(level.size) * level.size);
        },
        [&] {
            measureClearance(work);
            markCreases(work);
        });
    fillTexels(work);
    markSlits(work);
    return level;
}

}  // namespace espalier::bakery
