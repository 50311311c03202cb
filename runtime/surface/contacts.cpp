// In: one mesh, or two. Out: the contacts between their shells.
#include "runtime/surface/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "runtime/surface/contact_flaps.hpp"
#include "shaders/shared/exact.h"

namespace espalier {
namespace {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;

constexpr double kTurn = 6.283185307179586;
constexpr double kReachShare = 0.1;    // of the least altitude of a point's triangles
constexpr double kLeastShifts = 0.05;  // a shorter contact, in shifts of borders, is rounding

double cross(dvec2 a, dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

class Assembler {
  public:
    Assembler(const ContactView& a, const ContactView& b, double tolerance) : flaps_(a, b, tolerance) {}

    // Adds the contacts of one stretch, those from side s to out[s].
    void add(const ContactStretch& stretch, std::array<std::vector<Contact>*, 2> out) {
        flaps_.standAround(stretch);
        if (flaps_.areBorders()) return;
        for (const Flap& f : flaps_.all()) {
            const Flap* g = flaps_.leadsTo(f);
            if (!g) continue;
            const std::optional<Half> from = half(f), to = half(*g);
            if (from && to) addWithin(make(f, *g, *from, *to), *g, *to, *out[size_t(f.side)]);
        }
    }

  private:
    const ContactSegment::Side& sideOf(const Flap& f) const { return flaps_.stretch().segment.side[f.side]; }

    dvec2 uvAt(const ContactView& view, uint32_t t, dvec3 p) const {
        dvec3 o = view.at(t, 0), e1 = view.at(t, 1) - o, e2 = view.at(t, 2) - o, d = p - o;
        double a = glm::dot(e1, e1), b = glm::dot(e1, e2), c = glm::dot(e2, e2), x = glm::dot(e1, d),
               y = glm::dot(e2, d);
        double k = 1 / (a * c - b * b);
        const auto& uv = view.mesh.triangles[t].uv;
        return uv[0] + (uv[1] - uv[0]) * ((c * x - b * y) * k) + (uv[2] - uv[0]) * ((a * y - b * x) * k);
    }

    // One side's half of a record.
    struct Half {
        dvec2 a, b;
        uint32_t edge;
        bool insideLeft;
    };
    std::optional<Half> half(const Flap& f) const {
        const ContactView& view = flaps_.viewOf(f);
        const auto& side = sideOf(f);
        double length = glm::length(side.b - side.a);
        dvec2 a = uvAt(view, f.triangle, side.a), b = uvAt(view, f.triangle, side.b);
        dvec2 inward = uvAt(view, f.triangle, side.a + f.away * length) - a, d = b - a;
        double turn = cross(d, inward), size = glm::length(d);
        if (!(size > kLeastShifts * view.borderShift) || !std::isfinite(turn) || turn == 0) return std::nullopt;
        bool left = turn > 0;
        if (f.atBorder) {
            dvec2 shift = dvec2(-d.y, d.x) * ((left ? 1 : -1) * view.borderShift / size);
            a += shift, b += shift;
        }
        a = glm::clamp(a, dvec2(0), dvec2(1)), b = glm::clamp(b, dvec2(0), dvec2(1));
        dvec3 edge = side.b - side.a;
        if (!view.identity) edge = glm::inverse(glm::dmat3(view.map)) * edge;
        return Half{a, b, packOct(glm::vec3(glm::normalize(edge))), left};
    }

    // As crossingJoint tells it.
    static float jointOf(dvec3 toOutside, dvec3 fromOutside, dvec3 edge) {
        dvec3 mean = toOutside + fromOutside, across = glm::cross(glm::normalize(edge), toOutside);
        double c = glm::dot(mean, toOutside), s = glm::dot(mean, across), sum = c + std::abs(s);
        return sum > 1e-6 ? float(s / sum) : 0.0f;
    }

    Contact make(const Flap& f, const Flap& g, const Half& from, const Half& to) const {
        const ContactMesh &mesh = flaps_.viewOf(f).mesh, &other = flaps_.viewOf(g).mesh;
        uint32_t chart = mesh.triangles[f.triangle].chart, target = other.triangles[g.triangle].chart;
        // As the walk works it out; what differs from that is turned over, or mirrored.
        const bool expected = from.insideLeft == (mesh.orientation[chart] * other.orientation[target] < 0);
        const bool mirrored = flaps_.viewOf(f).outward * flaps_.viewOf(g).outward < 0;
        const bool turned = (expected != to.insideLeft) != mirrored;
        Contact contact{};
        Crossing& c = contact.crossing;
        c.a = glm::vec2(from.a), c.b = glm::vec2(from.b);
        c.ta = glm::vec2(to.a), c.tb = glm::vec2(to.b);
        c.edge = from.edge;
        c.targetEdge = to.edge;
        c.target = 0xFFFF0000u | target;
        c.flags = kCrossingContact | (from.insideLeft ? kCrossingInsideLeft : 0u) | (turned ? kCrossingTurned : 0u) |
                  (mirrored ? kCrossingMirrored : 0u) | chart << 16;
        if (!flaps_.ofOneMesh()) {
            const auto& side = sideOf(g);
            const dvec3 outside = g.normal * (turned ? -1.0 : 1.0);
            // Of the far one's space, where left is right if that is mirrored here.
            const float joint = jointOf(outside, f.normal, side.b - side.a) * float(flaps_.viewOf(g).outward);
            c.flags |= packCrossingJoint(joint);
        }
        contact.from = f.triangle;
        contact.to = g.triangle;
        contact.a = sideOf(g).a;
        contact.b = sideOf(g).b;
        contact.onward = g.away;
        contact.fromA = sideOf(f).a;
        contact.fromB = sideOf(f).b;
        contact.back = f.away;
        contact.turn = flaps_.angle(f, g);
        if (contact.turn == 0) contact.turn = kTurn;  // back to back
        return contact;
    }

    // Adds a contact in up to three parts, so that none leads over a border of the chart that it leads to: what touches
    // within a tolerance may reach that far beyond its triangle. Beyond, all lead to where the border is met.
    void addWithin(const Contact& contact, const Flap& g, const Half& to, std::vector<Contact>& out) const {
        const ContactView& view = flaps_.viewOf(g);
        const auto& uv = view.mesh.triangles[g.triangle].uv;
        const dvec2 a = to.a, b = to.b;
        double turn = cross(uv[1] - uv[0], uv[2] - uv[0]) > 0 ? 1 : -1, t0 = 0, t1 = 1;
        const double hair = view.borderShift / 4;  // rounding
        for (uint32_t k = 0; k < 3; ++k) {
            dvec2 e = glm::normalize(uv[(k + 1) % 3] - uv[k]), inward = dvec2(-e.y, e.x) * turn;
            auto within = [&](dvec2 p) {
                const double d = glm::dot(p - uv[k], inward);
                return d < 0 && d > -hair ? 0.0 : d;
            };
            const double da = within(a), db = within(b);
            if (da < 0 && db < 0) return;  // off a corner
            if (da < 0) t0 = std::max(t0, da / (da - db));
            if (db < 0) t1 = std::min(t1, da / (da - db));
        }
        if (t0 > t1) t0 = t1 = (t0 + t1) / 2;
        auto add = [&](double low, double high, double targetFrom, double targetTo) {
            if (!(high > low)) return;
            Contact part = contact;
            Crossing& c = part.crossing;
            glm::vec2 near = c.a, along = c.b - c.a;
            c.a = low > 0 ? near + along * float(low) : c.a;
            c.b = high < 1 ? near + along * float(high) : c.b;
            c.ta = glm::vec2(a + (b - a) * targetFrom);
            c.tb = glm::vec2(a + (b - a) * targetTo);
            part.a = contact.a + (contact.b - contact.a) * targetFrom;
            part.b = contact.a + (contact.b - contact.a) * targetTo;
            part.fromA = contact.fromA + (contact.fromB - contact.fromA) * low;
            part.fromB = contact.fromA + (contact.fromB - contact.fromA) * high;
            out.push_back(part);
        };
        // A walk tells by the target's direction on which side of it the chart lies, so that it has to have one.
        const double least = view.borderShift / std::max(glm::length(b - a), 1e-300);
        const bool room = t1 > t0;
        add(0, t0, room ? t0 : t0 - least / 2, room ? std::min(t0 + least, t1) : t0 + least / 2);
        add(t0, t1, t0, t1);
        add(t1, 1, room ? std::max(t1 - least, t0) : t1 - least / 2, room ? t1 : t1 + least / 2);
    }

    Flaps flaps_;
};

}  // namespace

Crossing closed(Crossing contact) {
    Crossing& c = contact;
    c.ta = c.a, c.tb = c.b;
    c.targetEdge = c.edge;
    c.target = (c.target & 0xFFFF0000u) | c.flags >> 16;
    c.flags = (c.flags & (0xFFFF0000u | kCrossingInsideLeft)) | kCrossingOpen;
    return c;
}

BoxTree ContactMesh::tree() const {
    std::vector<Box> boxes(triangles.size());
    std::vector<uint32_t> group(triangles.size());
    for (uint32_t t = 0; t < boxes.size(); ++t) {
        for (uint32_t k = 0; k < 3; ++k) boxes[t].add(at(t, k));
        group[t] = triangles[t].shell;
    }
    return {std::move(boxes), group};
}

double ContactMesh::reachOf(uint32_t triangle) const {
    const auto& p = triangles[triangle].point;
    return std::max({reach[p[0]], reach[p[1]], reach[p[2]]});
}

void setReach(ContactMesh& mesh, double tolerance) {
    mesh.reach.assign(mesh.points.size(), tolerance);
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        dvec3 p[3] = {mesh.at(t, 0), mesh.at(t, 1), mesh.at(t, 2)};
        double longest = std::max({glm::length(p[1] - p[0]), glm::length(p[2] - p[1]), glm::length(p[0] - p[2])});
        double altitude = glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / std::max(longest, 1e-300);
        for (uint32_t v : mesh.triangles[t].point) mesh.reach[v] = std::min(mesh.reach[v], altitude * kReachShare);
    }
}

std::vector<Contact> contactsWithin(const ContactMesh& mesh, const BoxTree& tree, const ContactOptions& options) {
    const ContactView view{mesh, dmat4(1), true, options.borderShift};
    std::vector<Contact> out;
    Assembler assembler(view, view, options.tolerance);
    for (const ContactStretch& s : stretchesWithin(view, tree, options.tolerance)) assembler.add(s, {&out, &out});
    return out;
}

ContactsBetween contactsBetween(const ContactMesh& a, const BoxTree& treeA, const ContactMesh& b, const BoxTree& treeB,
                                const ContactOptions& options) {
    const ContactView viewA{a, dmat4(1), true, options.borderShift},
        viewB{b, options.toA, false, options.otherBorderShift,
              glm::determinant(glm::dmat3(options.toA)) < 0 ? -1.0 : 1.0};
    ContactsBetween out;
    Assembler assembler(viewA, viewB, options.tolerance);
    for (const ContactStretch& s : stretchesBetween(viewA, treeA, viewB, treeB, options.tolerance))
        assembler.add(s, {&out.fromA, &out.fromB});
    return out;
}

}  // namespace espalier
