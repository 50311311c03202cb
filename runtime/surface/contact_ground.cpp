// In: a surface as it is loaded. Out: the mesh and bodies by which contacts with others are found; the contacts of two
// placed surfaces, without those that lead to what a third piece hides.
#include "runtime/surface/contact_ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "runtime/core/disjoint_sets.hpp"
#include "runtime/core/jobs.hpp"

namespace espalier {
namespace {

using glm::dmat4;
using glm::dvec3;

constexpr double kBorderShift = 0.02;  // texels, as in what was baked
constexpr size_t kMostParts = 8;       // that a contact is judged in
constexpr double kPart = 4;            // tolerances

struct PointHash {
    size_t operator()(const std::array<uint32_t, 3>& p) const {
        return (p[0] * 0x9E3779B97F4A7C15ull ^ p[1] * 0xC2B2AE3D27D4EB4Full ^ p[2] * 0x165667B19E3779F9ull) >> 7;
    }
};

// Vertices of one place are one point: the file's quantisation has made them equal to the bit.
std::vector<uint32_t> weld(const SurfaceData& data, std::vector<dvec3>& points) {
    std::unordered_map<std::array<uint32_t, 3>, uint32_t, PointHash> known;
    known.reserve(data.vertices.size());
    std::vector<uint32_t> out(data.vertices.size());
    for (size_t i = 0; i < out.size(); ++i) {
        const glm::vec3 p = data.vertices[i].position + glm::vec3(0);  // no -0
        std::array<uint32_t, 3> bits;
        std::memcpy(bits.data(), &p, sizeof p);
        const auto [at, fresh] = known.try_emplace(bits, uint32_t(points.size()));
        if (fresh) points.push_back(dvec3(p));
        out[i] = at->second;
    }
    return out;
}

// The chart of the texel around uv that is nearest in space to `position`; kNoIndex: none there.
uint32_t chartAt(const SurfaceLevelData& level, glm::vec2 uv, glm::vec3 position) {
    const int size = int(level.size), cx = int(uv.x * float(size)), cy = int(uv.y * float(size));
    uint32_t best = kNoIndex;
    float least = 1e30f;
    for (int y = std::max(0, cy - 1); y <= std::min(size - 1, cy + 1); ++y)
        for (int x = std::max(0, cx - 1); x <= std::min(size - 1, cx + 1); ++x) {
            const Texel& texel = level.texels[texelIndex(level.size, uint32_t(x), uint32_t(y))];
            const glm::vec3 gap = texel.position - position;
            if (texelClass(texel.bits) != kTexelEmpty && glm::dot(gap, gap) < least)
                least = glm::dot(gap, gap), best = texelChart(texel.bits);
        }
    return best;
}

// Pairs half-edges that run against each other, each with the first one.
std::vector<uint32_t> findTwins(const std::vector<ContactMesh::Triangle>& triangles) {
    std::vector<uint32_t> twin(triangles.size() * 3, kNoIndex);
    std::unordered_map<uint64_t, uint32_t> waiting;
    waiting.reserve(twin.size() / 2);
    for (uint32_t h = 0; h < twin.size(); ++h) {
        const auto& p = triangles[h / 3].point;
        const uint64_t a = p[h % 3], b = p[(h + 1) % 3];
        if (const auto other = waiting.find(b << 32 | a); other != waiting.end()) {
            twin[h] = other->second;
            twin[other->second] = h;
            waiting.erase(other);
        } else {
            waiting.try_emplace(a << 32 | b, h);
        }
    }
    return twin;
}

}  // namespace

ContactGround::ContactGround(const SurfaceData& data) {
    const SurfaceLevelData& level = data.levels.front();
    texelUv_ = 1.0 / level.size;
    double area = 0, uvArea = 0;
    for (const Chart& c : data.charts) area += c.area, uvArea += c.area / (double(c.metresPerUv) * c.metresPerUv);
    texel_ = uvArea > 0 ? std::sqrt(area / uvArea) / level.size : 0;
    for (const Chart& c : data.charts) mesh_.orientation.push_back(c.orientation);

    const std::vector<uint32_t> pointOf = weld(data, mesh_.points);
    for (size_t i = 0; i + 2 < data.indices.size(); i += 3) {
        ContactMesh::Triangle t{};
        glm::vec2 middle(0);
        for (size_t k = 0; k < 3; ++k) {
            t.point[k] = pointOf[data.indices[i + k]];
            t.uv[k] = glm::dvec2(data.vertices[data.indices[i + k]].walkUv);
            middle += data.vertices[data.indices[i + k]].walkUv / 3.0f;
        }
        const dvec3 a = mesh_.points[t.point[0]], b = mesh_.points[t.point[1]], c = mesh_.points[t.point[2]];
        const glm::dvec2 u = t.uv[1] - t.uv[0], v = t.uv[2] - t.uv[0];
        const double turn = u.x * v.y - u.y * v.x;
        if (turn == 0 || glm::cross(b - a, c - a) == dvec3(0)) continue;
        t.chart = chartAt(level, middle, glm::vec3((a + b + c) / 3.0));
        if (t.chart == kNoIndex) continue;
        t.bare = !data.bareTriangles.empty() && data.bareTriangles[i / 3] != 0;
        if (turn * mesh_.orientation[t.chart] < 0) std::swap(t.point[1], t.point[2]), std::swap(t.uv[1], t.uv[2]);
        mesh_.triangles.push_back(t);
    }
    mesh_.twin = findTwins(mesh_.triangles);
    mesh_.chartBorder.resize(mesh_.twin.size());
    for (uint32_t h = 0; h < mesh_.twin.size(); ++h) {
        const uint32_t g = mesh_.twin[h];
        mesh_.chartBorder[h] = g == kNoIndex || mesh_.triangles[g / 3].chart != mesh_.triangles[h / 3].chart ||
                               mesh_.triangles[g / 3].uv[(g + 1) % 3] != mesh_.triangles[h / 3].uv[h % 3];
    }
    // Charts that seams join are a shell, shells that near borders join are a body. Seams that bare ground has closed
    // still name their targets; other open borders name their own chart.
    DisjointSets together(data.charts.size());
    for (const Crossing& c : data.crossings)
        if ((c.flags & 3u) == kCrossingSeam || (c.flags & 3u) == kCrossingOpen)
            together.join(c.flags >> 16, c.target & 0xFFFFu);
    std::vector<uint32_t> shell;
    together.number(shell);
    for (const Crossing& c : data.crossings)
        if ((c.flags & 3u) == kCrossingNearest) together.join(c.flags >> 16, c.target & 0xFFFFu);
    const uint32_t count = together.number(bodyOfChart_);
    for (ContactMesh::Triangle& t : mesh_.triangles) t.shell = shell[t.chart], t.body = bodyOfChart_[t.chart];
    for (const SurfaceLevelData& each : data.levels) tiles_.emplace_back(each);
    setReach(mesh_, texel_);
    std::vector<float> open(mesh_.twin.size());
    for (size_t h = 0; h < open.size(); ++h) open[h] = mesh_.twin[h] == kNoIndex ? 1.0f : 0.0f;
    bodies_ = Bodies(mesh_, open);
    mesh_.solid.resize(count);  // the last bodies may have no triangles: they are sheets
}

namespace {

// A search between two grounds, in a's object space.
struct ContactSearch {
    const PlacedGround& a;
    const PlacedGround& b;
    std::span<const PlacedGround> others;
    double tolerance;  // metres of a's object space
    dmat4 aToWorld;

    // Is a place on `own` hidden by a body, other than its own and `except` of the other one of the two?
    bool hidden(bool ofA, dvec3 p, uint32_t triangle, uint32_t except, bool crevices) const {
        const PlacedGround &own = ofA ? a : b, &other = ofA ? b : a;
        const ContactMesh& mesh = own.ground->mesh();
        const uint32_t body = mesh.triangles[triangle].body;
        const dvec3 corner = mesh.at(triangle, 0);
        const dvec3 normal = glm::normalize(glm::dmat3(own.toWorld) *
                                            glm::cross(mesh.at(triangle, 1) - corner, mesh.at(triangle, 2) - corner));
        const dvec3 world(aToWorld * glm::dvec4(p, 1));
        const double reach = mesh.reachOf(triangle) * glm::length(dvec3(own.toWorld[0]));
        auto hides = [&](const PlacedGround& by, uint32_t ownBody, uint32_t exceptBody, bool yields) {
            return hiddenBy(by, {world, normal, ownBody, exceptBody, mesh.solid[body] != 0, yields}, reach, crevices);
        };
        if (own.ground->bodyCount() > 1 && hides(own, body, kNoIndex, false)) return true;
        if (other.ground->bodyCount() > 1 && hides(other, kNoIndex, except, ofA)) return true;
        return std::any_of(others.begin(), others.end(),
                           [&](const PlacedGround& by) { return hides(by, kNoIndex, kNoIndex, true); });
    }

    // The parts of a contact on whose both sides there is ground, or none on either: a third piece may hide one.
    std::vector<Crossing> visibleParts(const Contact& c, bool fromA) const {
        const ContactMesh &from = (fromA ? a : b).ground->mesh(), &to = (fromA ? b : a).ground->mesh();
        const uint32_t fromBody = from.triangles[c.from].body, toBody = to.triangles[c.to].body;
        const size_t parts = std::clamp(size_t(glm::length(c.b - c.a) / (kPart * tolerance)), size_t(1), kMostParts);
        const auto asked = [&](bool far, dvec3 p, bool crevices) {
            return far ? hidden(!fromA, p, c.to, fromBody, crevices) : hidden(fromA, p, c.from, toBody, crevices);
        };
        const auto leads = [&](size_t k) { return leadsOn(c, (double(k) + 0.5) / double(parts), tolerance, asked); };
        std::vector<Crossing> out;
        for (size_t k = 0; k < parts; ++k) {
            if (!leads(k)) continue;
            const size_t first = k;
            while (k + 1 < parts && leads(k + 1)) ++k;
            const float t0 = float(first) / float(parts), t1 = float(k + 1) / float(parts);
            Crossing part = c.crossing;
            const glm::vec2 d = part.b - part.a, td = part.tb - part.ta;
            if (t1 < 1) part.b = part.a + d * t1, part.tb = part.ta + td * t1;
            if (t0 > 0) part.a += d * t0, part.ta += td * t0;
            out.push_back(part);
        }
        return out;
    }

    std::vector<Crossing> visible(std::vector<Contact> contacts, bool fromA) const {
        for (Contact& c : contacts)
            if ((fromA ? b : a).ground->mesh().triangles[c.to].bare) c.crossing = closed(c.crossing);
        std::vector<Crossing> out;
        if (a.ground->bodyCount() <= 1 && b.ground->bodyCount() <= 1 && others.empty()) {
            for (const Contact& c : contacts) out.push_back(c.crossing);
            return out;
        }
        std::vector<std::vector<Crossing>> parts(contacts.size());
        parallelFor(contacts.size(), 16, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) parts[i] = visibleParts(contacts[i], fromA);
        });
        for (const auto& some : parts) out.insert(out.end(), some.begin(), some.end());
        return out;
    }
};

}  // namespace

bool hiddenBy(const PlacedGround& by, HiddenQuery query, double tolerance, bool crevices) {
    const dmat4 back = glm::inverse(by.toWorld);
    query.position = dvec3(back * glm::dvec4(query.position, 1));
    query.normal = glm::normalize(glm::dmat3(back) * query.normal);
    return by.ground->bodies().hide(query, tolerance * glm::length(dvec3(back[0])), crevices);
}

PlacedContacts contactsOf(const PlacedGround& a, const PlacedGround& b, std::span<const PlacedGround> others) {
    const double scaleA = glm::length(dvec3(a.toWorld[0])), scaleB = glm::length(dvec3(b.toWorld[0]));
    const double tolerance = std::max(a.ground->texel(), b.ground->texel() * scaleB / scaleA);
    const ContactOptions options{tolerance, kBorderShift * a.ground->texelUv(), glm::inverse(a.toWorld) * b.toWorld,
                                 kBorderShift * b.ground->texelUv()};
    const ContactsBetween found = contactsBetween(a.ground->mesh(), a.ground->bodies().tree(), b.ground->mesh(),
                                                  b.ground->bodies().tree(), options);
    const ContactSearch search{a, b, others, tolerance, a.toWorld};
    return {search.visible(found.fromA, true), search.visible(found.fromB, false)};
}

}  // namespace espalier
