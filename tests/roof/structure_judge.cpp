#include "tests/roof/structure_judge.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <tuple>

namespace espalier::test {

namespace {

using Point = std::tuple<float, float, float>;
Point key(glm::vec3 p) {
    return {p.x, p.y, p.z};
}

double shoelace(const std::vector<glm::dvec2>& p) {
    double sum = 0;
    for (size_t i = 0, j = p.size() - 1; i < p.size(); j = i++) sum += (p[j].x - p[i].x) * (p[j].y + p[i].y);
    return sum / 2;
}

// Winding number of the polygon round p.
int winding(const std::vector<glm::dvec2>& ring, glm::dvec2 p) {
    int turns = 0;
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        glm::dvec2 a = ring[j], b = ring[i];
        double side = (b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y);
        if (a.y <= p.y && b.y > p.y && side > 0) turns++;
        if (a.y > p.y && b.y <= p.y && side < 0) turns--;
    }
    return turns;
}

std::vector<glm::dvec2> flat(const std::vector<glm::dvec3>& outline) {
    std::vector<glm::dvec2> p;
    for (glm::dvec3 q : outline) p.push_back({q.x, q.y});
    return p;
}

double distanceTo(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b) {
    double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(p, a + t * (b - a));
}

}  // namespace

std::vector<glm::dvec3> outlineOf(const RoofStructure& roof, const RoofFace& face) {
    std::vector<glm::dvec3> points;
    auto add = [&](glm::vec3 p) { points.push_back({p.x, -double(p.z), p.y}); };
    if (!face.detached) add(face.eave[1]);
    for (uint32_t i = 0; i < face.segmentCount; i++) add(roof.segments[face.firstSegment + i].to);
    return points;
}

double heightAt(const RoofStructure& roof, uint32_t house, glm::dvec2 p) {
    const RoofHouse& h = roof.houses[house];
    for (uint32_t f = h.firstFace; f < h.firstFace + h.faceCount; f++) {
        const RoofFace& face = roof.faces[f];
        if (face.kind == FaceKind::gable) continue;
        std::vector<glm::dvec3> outline = outlineOf(roof, face);
        if (winding(flat(outline), p) == 0) continue;
        glm::dvec3 n(0), centre(0);
        for (size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
            n += glm::cross(outline[j] - outline[0], outline[i] - outline[0]);
            centre += outline[i] / double(outline.size());
        }
        return centre.z - (n.x * (p.x - centre.x) + n.y * (p.y - centre.y)) / n.z - h.eaveHeight;
    }
    return NAN;
}

Verdict judge(const RoofStructure& roof, uint32_t number, const std::function<double(const RoofFace&)>& slope) {
    const RoofHouse& house = roof.houses[number];
    Verdict verdict;
    auto fail = [&](uint32_t face, const std::string& what) {
        verdict.problem = "face " + std::to_string(face - house.firstFace) + ": " + what;
        return verdict;
    };
    std::vector<std::vector<glm::dvec2>> rings;
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (const auto& ring : house.rings) {
        rings.emplace_back(ring.begin(), ring.end());
        verdict.area += shoelace(rings.back());
        for (glm::dvec2 p : rings.back()) low = glm::min(low, p), high = glm::max(high, p);
    }
    double size = glm::distance(low, high), near = 1e-4 + 1e-6 * size, sum = 0;

    // Every directed piece of a border, and where it is.
    std::map<std::pair<Point, Point>, int> pieces;
    std::vector<std::vector<glm::dvec2>> plans;
    for (uint32_t f = house.firstFace; f < house.firstFace + house.faceCount; f++) {
        const RoofFace& face = roof.faces[f];
        std::vector<glm::dvec3> outline = outlineOf(roof, face);
        if (outline.size() < 3) return fail(f, "fewer than three corners");
        // Newell's normal, then everyone's distance from the plane through the mean.
        glm::dvec3 n(0), mean(0);
        for (size_t i = 0, j = outline.size() - 1; i < outline.size(); j = i++) {
            glm::dvec3 a = outline[j] - outline[0], b = outline[i] - outline[0];
            n += glm::dvec3((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
            mean += outline[i] / double(outline.size());
        }
        double area = glm::length(n) / 2;
        std::vector<glm::dvec2> plan = flat(outline);
        double covered = shoelace(plan);
        bool sliver = area < 20 * near * size;
        if (!sliver) {
            n = glm::normalize(n);
            for (glm::dvec3 p : outline)
                if (std::abs(glm::dot(p - mean, n)) > 5 * near) return fail(f, "not planar");
            double tangent = glm::length(glm::dvec2(n)) / std::abs(n.z);
            if (face.kind == FaceKind::gable ? std::abs(n.z) > 1e-3 : n.z <= 0) return fail(f, "turned the wrong way");
            if (face.kind != FaceKind::gable) {
                double asked = slope ? slope(face) : -1;
                double wrong = 1e-3 * (1 + face.slope) + 10 * near * size / area;
                if (std::abs(tangent - face.slope) > wrong) return fail(f, "not of the slope that it states");
                if (asked >= 0 && std::abs(tangent - asked) > wrong) return fail(f, "not of the slope asked");
            }
        }
        if (face.kind != FaceKind::gable) {
            sum += covered;
            plans.push_back(plan);
        }
        std::vector<glm::vec3> border;
        if (!face.detached) border = {face.eave[0], face.eave[1]};
        for (uint32_t i = 0; i < face.segmentCount; i++) border.push_back(roof.segments[face.firstSegment + i].to);
        for (size_t i = face.detached ? 0 : 1; i < border.size(); i++) {
            glm::vec3 from = i > 0 ? border[i - 1] : border.back();
            if (++pieces[{key(from), key(border[i])}] > 1) return fail(f, "a piece of border that another has too");
        }
    }
    if (std::abs(sum - verdict.area) > 1e-6 * verdict.area) {
        verdict.problem = "faces cover " + std::to_string(sum) + " of " + std::to_string(verdict.area);
        return verdict;
    }
    // Pieces without a counterpart make up the footprint's border at the wall's top, each edge once; or they lie,
    // several to one, along an eave above a break, and cancel out as vectors.
    double border = 0, perimeter = 0;
    glm::dvec3 loose(0);
    for (const auto& ring : rings)
        for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) perimeter += glm::distance(ring[i], ring[j]);
    for (const auto& [piece, count] : pieces) {
        if (pieces.count({piece.second, piece.first})) continue;
        auto [ax, ah, az] = piece.first;
        auto [bx, bh, bz] = piece.second;
        glm::dvec2 a(ax, -double(az)), b(bx, -double(bz));
        bool onRing = false;
        for (const auto& ring : rings)
            for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
                onRing = onRing || (distanceTo(a, ring[j], ring[i]) < near && distanceTo(b, ring[j], ring[i]) < near);
        if (onRing && ah == house.eaveHeight && bh == house.eaveHeight) {
            border += glm::distance(a, b);
            continue;
        }
        if (std::abs(ah - bh) > near) return fail(house.firstFace, "a border that no other face has");
        loose += glm::dvec3(bx - ax, bh - ah, bz - az);
    }
    if (std::abs(border - perimeter) > 1e-4 * perimeter) verdict.problem = "gaps between roof and walls";
    if (glm::length(loose) > 10 * near) verdict.problem = "gaps at a break";
    // Every sample of the footprint lies under one face; near borders that isn't decidable.
    std::mt19937 random(7);
    std::uniform_real_distribution<double> x(low.x, high.x), y(low.y, high.y);
    for (int i = 0; i < 60 && verdict.problem.empty(); i++) {
        glm::dvec2 p(x(random), y(random));
        int in = 0, over = 0;
        double least = INFINITY;
        for (const auto& ring : rings) in += winding(ring, p);
        for (const auto& plan : plans) {
            over += std::abs(winding(plan, p));
            for (size_t k = 0, j = plan.size() - 1; k < plan.size(); j = k++)
                least = std::min(least, distanceTo(p, plan[j], plan[k]));
        }
        if (least > near && over != in) verdict.problem = "a point under " + std::to_string(over) + " faces";
    }
    return verdict;
}

}  // namespace espalier::test
