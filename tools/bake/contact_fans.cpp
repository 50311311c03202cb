// In: the contacts that lead on. Out: of those that leave one line, as where sheets meet in a fan, what a walk meets
// first when it turns to its outside. Contacts are found pair by pair, and the farther ones would else be as good.
// Lines may lie up to a reach apart on a sheet that both of the others touch: they are no fan, since there is ground
// between them, to which the farther contact leads back. Where borders run along each other their link is met first
// likewise, as by a gable that stands where two floors of one height meet.
#include <algorithm>
#include <map>

#include "tools/bake/contact.hpp"

namespace espalier::bakery {
namespace {

using glm::dvec2;

constexpr double kOneLine = 1e-3;   // texels: so far apart are lines that are one; shorter parts are none
constexpr double kAtBorder = 0.03;  // texels: so near to a border runs a contact along it
constexpr double kSameTurn = 0.06;  // radians: turns that are alike

struct Part {
    double from, to;  // shares of a contact
};

// The share of the line a-b that the line p-q covers.
Part covered(dvec2 a, dvec2 b, dvec2 p, dvec2 q, double within) {
    const dvec2 d = b - a;
    const double length = glm::length(d);
    if (std::abs(cross(d, p - a)) > within * length || std::abs(cross(d, q - a)) > within * length) return {0, 0};
    const double s = glm::dot(d, p - a) / (length * length), t = glm::dot(d, q - a) / (length * length);
    return {std::max(0.0, std::min(s, t)), std::min(1.0, std::max(s, t))};
}

// Do walks come to lines of one place from the same side?
bool fromOneSide(const Crossing& c, const Crossing& o) {
    const bool alike = ((c.flags ^ o.flags) & kCrossingInsideLeft) == 0;
    return (glm::dot(dvec2(c.b - c.a), dvec2(o.b - o.a)) > 0) == alike;
}

// least: the share of a contact below which nothing is left.
void takeFrom(std::vector<Part>& parts, Part taken, double least) {
    if (!(taken.to > taken.from)) return;
    std::vector<Part> left;
    for (const Part& p : parts)
        for (const Part& side : {Part{p.from, std::min(p.to, taken.from)}, Part{std::max(p.from, taken.to), p.to}})
            if (side.to - side.from > least) left.push_back(side);
    parts.swap(left);
}

}  // namespace

void Contacts::dropBehindLinks(const BakeMesh& mesh, const std::vector<Link>& links) {
    std::map<uint32_t, std::vector<const Link*>> leaving;  // by triangle
    for (const Link& link : links)
        if (link.kind == kCrossingNearest && link.to0 > link.to1) leaving[link.from / 3].push_back(&link);
    std::vector<Contact> kept;
    for (const Contact& c : list_) {
        std::vector<Part> parts{{0, 1}};
        // Either way a walk turns through the same wedge.
        const auto takeBehind = [&](uint32_t triangle, dvec2 a, dvec2 b) {
            const auto found = leaving.find(triangle);
            if (found == leaving.end()) return;
            for (const Link* link : found->second) {
                if (outsideAngle(mesh, link->from, link->to) >= c.turn - kSameTurn) continue;
                const auto& uv = mesh.triangles[triangle].uv;
                const dvec2 start = uv[link->from % 3], edge = uv[(link->from + 1) % 3] - start;
                takeFrom(parts,
                         covered(a, b, start + edge * link->from0, start + edge * link->from1, kAtBorder * texel_),
                         kOneLine * texel_ / glm::length(b - a));
            }
        };
        takeBehind(c.from, dvec2(c.crossing.a), dvec2(c.crossing.b));
        takeBehind(c.to, dvec2(c.crossing.ta), dvec2(c.crossing.tb));
        for (const Part& p : parts) kept.push_back(part(c, p.from, p.to));
    }
    list_.swap(kept);
}

void Contacts::keepFirstMet() {
    // Of solid bodies the nearer one hides what is behind it.
    const auto ofSheets = [&](const Contact& c) {
        return !mesh_.solid[mesh_.triangles[c.from].body] && !mesh_.solid[mesh_.triangles[c.to].body];
    };
    std::map<uint32_t, std::vector<const Contact*>> leaving;  // by triangle
    for (const Contact& c : list_)
        if (ofSheets(c)) leaving[c.from].push_back(&c);
    const double hair = kOneLine * texel_;
    // Where along c its far side touches what o leads to, in the same line.
    const auto touches = [&](const Contact& c, const Contact& o) {
        std::vector<Part> parts;
        const auto found = leaving.find(c.to);
        if (found == leaving.end()) return parts;
        for (const Contact* p : found->second)
            if (mesh_.triangles[p->to].shell == mesh_.triangles[o.to].shell)
                parts.push_back(covered(dvec2(c.crossing.ta), dvec2(c.crossing.tb), dvec2(p->crossing.a),
                                        dvec2(p->crossing.b), hair));
        return parts;
    };
    std::vector<Contact> kept;
    for (const Contact& c : list_) {
        if (!ofSheets(c)) {
            kept.push_back(c);
            continue;
        }
        std::vector<Part> parts{{0, 1}};
        const double least = hair / glm::length(c.crossing.b - c.crossing.a);
        for (const Contact* o : leaving[c.from]) {
            if (o->turn >= c.turn - kSameTurn || !fromOneSide(c.crossing, o->crossing)) continue;
            const Part on =
                covered(dvec2(c.crossing.a), dvec2(c.crossing.b), dvec2(o->crossing.a), dvec2(o->crossing.b), hair);
            if (!(on.to > on.from)) continue;
            for (const Part& p : touches(c, *o))
                takeFrom(parts, {std::max(on.from, p.from), std::min(on.to, p.to)}, least);
        }
        for (const Part& p : parts) kept.push_back(part(c, p.from, p.to));
    }
    list_.swap(kept);
}

}  // namespace espalier::bakery
