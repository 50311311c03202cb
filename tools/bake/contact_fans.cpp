// In: the contacts that lead on. Out: of those that leave one line, as where sheets meet in a fan, what a walk meets
// first when it turns to its outside. Contacts are found pair by pair, and the farther ones would else be as good.
#include <algorithm>
#include <map>

#include "tools/bake/contact.hpp"

namespace espalier::bakery {
namespace {

constexpr double kOneLine = 1e-3;   // texels: so far apart are lines that are one; shorter parts are none
constexpr double kSameTurn = 0.06;  // radians: turns that are alike

struct Part {
    double from, to;  // shares of a contact
};

// The share of c's line that o's covers, coming from the same side.
Part covered(const Crossing& c, const Crossing& o, double within) {
    const glm::dvec2 a(c.a), d = glm::dvec2(c.b) - a, p = glm::dvec2(o.a) - a, q = glm::dvec2(o.b) - a;
    const double length = glm::length(d), along = glm::dot(d, q - p);
    const bool oneSide = ((c.flags ^ o.flags) & kCrossingInsideLeft) == 0 ? along > 0 : along < 0;
    if (!oneSide || std::abs(cross(d, p)) > within * length || std::abs(cross(d, q)) > within * length) return {0, 0};
    const double s = glm::dot(d, p) / (length * length), t = glm::dot(d, q) / (length * length);
    return {std::max(0.0, std::min(s, t)), std::min(1.0, std::max(s, t))};
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

void Contacts::keepFirstMet() {
    // Of solid bodies the nearer one hides what is behind it.
    const auto ofSheets = [&](const Contact& c) {
        return !mesh_.solid[mesh_.triangles[c.from].body] && !mesh_.solid[mesh_.triangles[c.to].body];
    };
    std::map<uint32_t, std::vector<const Contact*>> leaving;  // by triangle
    for (const Contact& c : list_)
        if (ofSheets(c)) leaving[c.from].push_back(&c);
    std::vector<Contact> kept;
    for (const Contact& c : list_) {
        if (!ofSheets(c)) {
            kept.push_back(c);
            continue;
        }
        std::vector<Part> parts{{0, 1}};
        const double hair = kOneLine * texel_, least = hair / glm::length(c.crossing.b - c.crossing.a);
        for (const Contact* other : leaving[c.from])
            if (other->turn < c.turn - kSameTurn) takeFrom(parts, covered(c.crossing, other->crossing, hair), least);
        for (const Part& p : parts) kept.push_back(part(c, p.from, p.to));
    }
    list_.swap(kept);
}

}  // namespace espalier::bakery
