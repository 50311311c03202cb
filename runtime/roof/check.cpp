// In: a structure from anywhere. Out: what one of its houses breaks of the contract, in words, or nothing.
// Faces that close, don't cross themselves, pair side by side and have the footprint's border partition the footprint.
#include "runtime/roof/check.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace espalier {

namespace {

struct Checker {
    const RoofStructure& s;
    const RoofHouse& house;
    uint32_t index;
    double size = 0;                    // of the footprint
    double length = 0;                  // tolerance along the plan
    double height = 0;                  // and off a plane
    std::vector<glm::dvec2> corners{};  // of all rings
    std::vector<glm::dvec2> nexts{};    // an edge's other end
    std::vector<double> covered{};      // length of each edge under an eave
    double area = 0;

    static glm::dvec2 plan(glm::vec3 p) { return {p.x, -double(p.z)}; }
    static double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

    bool rings() {
        double footprint = 0;
        glm::dvec2 low(INFINITY), high(-INFINITY);
        for (const auto& ring : house.rings) {
            if (ring.size() < 3) return false;
            for (size_t i = 0; i < ring.size(); i++) {
                glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
                if (!std::isfinite(a.x + a.y)) return false;
                corners.push_back(a);
                nexts.push_back(b);
                footprint += cross(a, b) / 2;
                low = glm::min(low, a);
                high = glm::max(high, a);
            }
        }
        if (corners.empty() || !(footprint > 0)) return false;
        covered.resize(corners.size());
        size = glm::length(high - low);
        length = 2e-5 + 1e-6 * size;
        height = 2e-4 + 1e-5 * size;
        area = -footprint;
        return true;
    }

    glm::vec3 startOf(const RoofFace& f, uint32_t i) const {
        if (i > f.firstSegment) return s.segments[i - 1].to;
        return f.detached ? s.segments[f.firstSegment + f.segmentCount - 1].to : f.eave[1];
    }

    // Does this piece lie on a-b?
    bool on(glm::vec3 p, glm::dvec2 a, glm::dvec2 b) const {
        glm::dvec2 d = b - a, q = plan(p) - a;
        double l = glm::length(d), along = glm::dot(q, d) / l;
        return along >= -length && along <= l + length && std::abs(cross(d, q)) <= length * l;
    }

    const char* twins(uint32_t number, const RoofFace& f) {
        for (uint32_t i = f.firstSegment; i < f.firstSegment + f.segmentCount; i++) {
            const ChainSegment& c = s.segments[i];
            glm::vec3 from = startOf(f, i);
            if (!std::isfinite(c.to.x + c.to.y + c.to.z)) return "has a point that is no number";
            if (c.face == kNoFace) {
                // The border of the roof: on an edge of the footprint.
                for (size_t e = 0; e < corners.size() && f.kind != FaceKind::gable; e++)
                    if (on(from, corners[e], nexts[e]) && on(c.to, corners[e], nexts[e])) {
                        covered[e] += glm::length(plan(c.to) - plan(from));
                        break;
                    }
                continue;
            }
            if (c.face < house.firstFace || c.face >= house.firstFace + house.faceCount) return "joins no face";
            const RoofFace& beyond = s.faces[c.face];
            if (c.segment == kNoFace) {
                if (beyond.detached || !on(from, plan(beyond.eave[0]), plan(beyond.eave[1])) ||
                    !on(c.to, plan(beyond.eave[0]), plan(beyond.eave[1])))
                    return "joins an eave that is elsewhere";
                continue;
            }
            if (c.segment < beyond.firstSegment || c.segment >= beyond.firstSegment + beyond.segmentCount)
                return "has a twin outside of the face beyond";
            const ChainSegment& twin = s.segments[c.segment];
            if (twin.face != number || twin.segment != i || twin.to != from || startOf(beyond, c.segment) != c.to)
                return "has a twin that is not the same piece";
        }
        return nullptr;
    }

    std::vector<glm::vec3> outline(const RoofFace& f) const {
        std::vector<glm::vec3> points;
        if (!f.detached) points.push_back(f.eave[0]), points.push_back(f.eave[1]);
        for (uint32_t i = 0; i < f.segmentCount; i++) points.push_back(s.segments[f.firstSegment + i].to);
        if (!f.detached) points.pop_back();
        return points;
    }

    const char* face(uint32_t number) {
        const RoofFace& f = s.faces[number];
        if (f.house != index || f.edge >= corners.size()) return "belongs to no edge of the house";
        if (f.segmentCount < 2 || size_t(f.firstSegment) + f.segmentCount > s.segments.size()) return "has no chain";
        if (!f.detached && s.segments[f.firstSegment + f.segmentCount - 1].to != f.eave[0]) return "doesn't close";
        if (const char* problem = twins(number, f)) return problem;
        glm::dvec2 a = corners[f.edge], along = glm::normalize(nexts[f.edge] - a), up(-along.y, along.x);
        if (!f.detached && f.tier == 0) {
            if (!on(f.eave[0], a, nexts[f.edge]) || !on(f.eave[1], a, nexts[f.edge])) return "has its eave elsewhere";
            covered[f.edge] += glm::dot(plan(f.eave[1]) - plan(f.eave[0]), along);
        }
        std::vector<glm::dvec2> local;
        double twice = 0, base = f.eave[0].y;
        if (!(f.slope >= 0) || (f.kind == FaceKind::slope) != (f.slope > 0)) return "has a slope that isn't its kind's";
        for (glm::vec3 p : outline(f)) {
            glm::dvec2 q = plan(p) - plan(f.eave[0]);
            double rise = p.y - base, out = glm::dot(q, up);
            if (f.kind == FaceKind::gable ? std::abs(out) > length
                                          : std::abs(rise - f.slope * out) > height * (1 + f.slope))
                return "isn't planar";
            local.push_back({glm::dot(q, along), f.kind == FaceKind::gable ? rise : out});
        }
        for (size_t i = 0; i < local.size(); i++) twice += cross(local[i], local[(i + 1) % local.size()]);
        if (twice < -2 * length * size) return "is turned over";
        std::vector<glm::vec3> points = outline(f);
        for (size_t i = 0; i < points.size(); i++)
            area += cross(plan(points[i]), plan(points[(i + 1) % points.size()])) / 2;
        return f.kind == FaceKind::gable ? nullptr : monotone(local);
    }

    // Counterclockwise: first the lower side, forward; then the upper one, back. The upper is nowhere below the lower.
    const char* monotone(const std::vector<glm::dvec2>& p) const {
        size_t n = p.size();
        auto less = [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x; };
        size_t left = size_t(std::min_element(p.begin(), p.end(), less) - p.begin());
        size_t right = size_t(std::max_element(p.begin(), p.end(), less) - p.begin());
        std::vector<glm::dvec2> lower, upper;
        for (size_t i = left;; i = (i + 1) % n) {
            lower.push_back(p[i]);
            if (i == right) break;
        }
        for (size_t i = left;; i = (i + n - 1) % n) {
            upper.push_back(p[i]);
            if (i == right) break;
        }
        for (const auto* side : {&lower, &upper}) {
            double furthest = side->front().x;
            for (glm::dvec2 q : *side) {
                if (q.x < furthest - length) return "turns back along its eave";
                furthest = std::max(furthest, q.x);
            }
        }
        size_t k = 0;
        for (glm::dvec2 q : lower) {
            while (k + 2 < upper.size() && upper[k + 1].x < q.x) k++;
            if (!above(upper[k], upper[k + 1], q, +1)) return "crosses itself";
        }
        k = 0;
        for (glm::dvec2 q : upper) {
            while (k + 2 < lower.size() && lower[k + 1].x < q.x) k++;
            if (!above(lower[k], lower[k + 1], q, -1)) return "crosses itself";
        }
        return nullptr;
    }
    // Is the line a-b above (sign +1) or below (-1) q, where it passes it, but for the tolerance?
    bool above(glm::dvec2 a, glm::dvec2 b, glm::dvec2 q, int sign) const {
        if (q.x <= a.x + length || q.x >= b.x - length) return true;
        return sign * cross(b - a, q - a) <= length * glm::length(b - a);
    }
};

}  // namespace

std::string checkRoof(const RoofStructure& structure, uint32_t index) {
    if (index >= structure.houses.size()) return "there is no such house";
    const RoofHouse& house = structure.houses[index];
    Checker checker{structure, house, index};
    if (!checker.rings()) return "the footprint has no area";
    if (house.faceCount == 0 || size_t(house.firstFace) + house.faceCount > structure.faces.size())
        return "the house has no faces";
    for (uint32_t f = house.firstFace; f < house.firstFace + house.faceCount; f++)
        if (const char* problem = checker.face(f)) {
            std::ostringstream text;
            text << "face " << f - house.firstFace << " over edge " << structure.faces[f].edge << " " << problem;
            return text.str();
        }
    double footprint = 0;
    for (size_t e = 0; e < checker.corners.size(); e++) {
        footprint += Checker::cross(checker.corners[e], checker.nexts[e]) / 2;
        double whole = glm::length(checker.nexts[e] - checker.corners[e]);
        if (std::abs(checker.covered[e] - whole) > 4 * checker.length)
            return "edge " + std::to_string(e) + " isn't covered by eaves";
    }
    if (std::abs(checker.area) > 1e-6 * footprint) return "the faces don't make up the footprint";
    return {};
}

}  // namespace espalier
