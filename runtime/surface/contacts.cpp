// In: one mesh, or two. Out: the contacts between their shells.
//
// Around a stretch of contact the surfaces stand as half-planes, here called flaps. A walk that comes along a flap
// goes on along the one that it meets first when it turns from there towards its own outside: so it leaves the floor
// for the wall, and what lies within a solid leads nowhere.
#include "runtime/surface/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>

#include "runtime/surface/contact_segments.hpp"
#include "shaders/shared/exact.h"

namespace espalier {
namespace {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;

constexpr double kTurn = 6.283185307179586;
constexpr double kSameAngle = 0.06;       // radians: flaps nearer to each other coincide
constexpr double kCrossingAngle = 0.004;  // radians: and those that do so in truth
constexpr double kReachShare = 0.1;       // of the least altitude of a point's triangles
constexpr double kOutlineCosine = 0.999;
constexpr double kLeastShifts = 0.05;  // a shorter contact, in shifts of borders, is rounding

double cross(dvec2 a, dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

// One mesh of a search: where its points are in the space of the search, side 0's object space.
struct View {
    const ContactMesh& mesh;
    dmat4 map{1};
    bool identity = true;
    double borderShift = 0;  // UV

    dvec3 at(uint32_t triangle, uint32_t corner) const {
        dvec3 p = mesh.at(triangle, corner);
        return identity ? p : dvec3(map * glm::dvec4(p, 1));
    }
    dvec3 normal(uint32_t t) const {
        dvec3 a = at(t, 0), n = glm::cross(at(t, 1) - a, at(t, 2) - a);
        double length = glm::length(n);
        return length > 0 ? n / length : dvec3(0);
    }
    ContactShape shape(uint32_t t, double scale) const {
        ContactShape s;
        s.normal = normal(t);
        for (uint32_t k = 0; k < 3; ++k) {
            s.p[k] = at(t, k);
            s.reach[k] = mesh.reach[mesh.triangles[t].point[k]] * scale;
            uint32_t twin = mesh.twin[t * 3 + k];
            s.outline[k] = twin == kNoIndex || glm::dot(s.normal, normal(twin / 3)) < kOutlineCosine;
        }
        return s;
    }
    // What a stretch belongs to, so that the triangles on both sides of an edge find it once.
    uint64_t keyOf(uint32_t t, int edge) const {
        if (edge < 0) return uint64_t(t) << 1;
        uint32_t h = t * 3 + uint32_t(edge), twin = mesh.twin[h];
        return uint64_t(std::min(h, twin)) << 1 | 1;
    }
};

// A stretch of contact with its triangles.
struct Found {
    std::array<uint64_t, 2> key;
    std::array<uint32_t, 2> triangle;
    ContactSegment segment;
};

// A half-plane at a stretch of contact.
struct Flap {
    int side;
    uint32_t triangle;
    dvec3 away, normal;  // unit; away from the stretch, within the surface
    uint32_t half;       // half-edge that it ends at there; kNoIndex: it goes on as another flap
    bool atBorder;       // along a border of its chart
};

// The parts of a stretch that come before and after another one.
void addBeside(const Found& f, const Found& other, std::vector<Found>& out) {
    const dvec3 a = f.segment.side[0].a, d = f.segment.side[0].b - a;
    const auto at = [&](dvec3 p) { return glm::dot(d, p - a) / glm::dot(d, d); };
    const double from = at(other.segment.side[0].a), to = at(other.segment.side[0].b);
    const auto addPart = [&](double low, double high) {
        if (!(low < high)) return;
        Found part = f;
        for (auto& side : part.segment.side) {
            const dvec3 start = side.a, along = side.b - side.a;
            if (low > 0) side.a = start + along * low;
            if (high < 1) side.b = start + along * high;
        }
        out.push_back(part);
    };
    addPart(0, std::min(from, 1.0));
    addPart(std::max(to, 0.0), 1);
}

// Adds what the stretches of one key make together; those that are gone come last.
void mergeKey(std::span<Found> found, std::vector<Found>& out) {
    const auto& first = found.front().segment.side[0];
    const dvec3 d = glm::normalize(first.b - first.a);
    for (Found& f : found)
        for (auto& side : f.segment.side)
            if (glm::dot(d, side.b - side.a) < 0) std::swap(side.a, side.b);
    const auto from = [&](const Found& f) { return glm::dot(d, f.segment.side[0].a); };
    const auto to = [&](const Found& f) { return glm::dot(d, f.segment.side[0].b); };
    std::stable_sort(found.begin(), found.end(), [&](const Found& x, const Found& y) {
        return std::make_pair(x.segment.gone, from(x)) < std::make_pair(y.segment.gone, from(y));
    });
    std::vector<Found> joined, left;
    for (const Found& f : found) {
        if (f.segment.gone) {
            left.clear();
            for (const Found& stretch : joined) addBeside(stretch, f, left);
            joined.swap(left);
        } else if (joined.empty() || from(f) > to(joined.back())) {
            joined.push_back(f);
        } else if (to(f) > to(joined.back())) {
            for (int s = 0; s < 2; ++s) joined.back().segment.side[s].b = f.segment.side[s].b;
        }
    }
    out.insert(out.end(), joined.begin(), joined.end());
}

// Stretches that were found by several pairs of triangles become one each.
void merge(std::vector<Found>& found) {
    std::sort(found.begin(), found.end(),
              [](const Found& x, const Found& y) { return std::tie(x.key, x.triangle) < std::tie(y.key, y.triangle); });
    std::vector<Found> out;
    for (size_t i = 0, j = 0; i < found.size(); i = j) {
        while (j < found.size() && found[j].key == found[i].key) ++j;
        if (j - i == 1)
            out.push_back(found[i]);
        else
            mergeKey({found.data() + i, j - i}, out);
    }
    found.swap(out);
}

class Assembler {
  public:
    Assembler(const View& a, const View& b, const ContactOptions& options) : view_{&a, &b}, options_(options) {}

    // Adds the contacts of one stretch, those from side s to out[s].
    void add(const Found& found, std::array<std::vector<Contact>*, 2> out) {
        found_ = &found;
        direction_ = found.segment.side[0].b - found.segment.side[0].a;
        double length = glm::length(direction_);
        if (!(length > 0)) return;
        direction_ /= length;
        flaps_.clear();
        for (int s = 0; s < 2; ++s) addFlaps(s);
        // Borders that run along each other are joined as borders.
        if (flaps_.size() == 2 && sideOf(flaps_[0]) != sideOf(flaps_[1]) && view_[0] == view_[1]) return;
        for (const Flap& f : flaps_) {
            const Flap* g = goesOn(f);
            if (!g || g->side == f.side || seamLeads(f, *g)) continue;
            if (!faces(*g, f) && solid(*g)) continue;
            if (auto contact = make(f, *g)) addWithin(*contact, *g, *out[size_t(f.side)]);
        }
    }

  private:
    void addFlaps(int s) {
        const View& view = *view_[s];
        const auto& side = found_->segment.side[s];
        uint32_t t = found_->triangle[size_t(s)];
        auto push = [&](uint32_t triangle, dvec3 towards, uint32_t half) {
            dvec3 n = view.normal(triangle);
            dvec3 w = glm::cross(n, direction_);
            double length = glm::length(w);
            if (!(length > 0.1)) return;
            w /= length;
            const bool atBorder = half != kNoIndex && view.mesh.chartBorder[half] != 0;
            flaps_.push_back({s, triangle, glm::dot(w, towards) < 0 ? -w : w, n, half, atBorder});
        };
        if (side.edge < 0) {
            dvec3 w = glm::cross(view.normal(t), direction_);
            push(t, w, kNoIndex);
            push(t, -w, kNoIndex);
            return;
        }
        uint32_t h = t * 3 + uint32_t(side.edge);
        for (uint32_t half : {h, view.mesh.twin[h]}) {
            if (half == kNoIndex) continue;
            dvec3 tip = view.at(half / 3, (half + 2) % 3) - view.at(half / 3, half % 3);
            push(half / 3, tip, half);
        }
    }

    // Does a seam along the stretch lead from f to g?
    bool seamLeads(const Flap& f, const Flap& g) const {
        if (f.half == kNoIndex || g.half == kNoIndex || view_[0] != view_[1]) return false;
        const auto& seam = meshOf(f).seam;
        return !seam.empty() && seam[f.half] == g.half;
    }

    const ContactMesh& meshOf(const Flap& f) const { return view_[f.side]->mesh; }
    uint32_t body(const Flap& f) const { return meshOf(f).triangles[f.triangle].body; }
    bool solid(const Flap& f) const { return meshOf(f).solid[body(f)] != 0; }
    // The way around the stretch in which a flap's outside lies: +1 or -1.
    double sideOf(const Flap& f) const { return glm::dot(f.normal, glm::cross(direction_, f.away)) > 0 ? 1 : -1; }
    // Does g turn its outside to a walk that comes from f's outside?
    bool faces(const Flap& g, const Flap& f) const { return sideOf(g) != sideOf(f); }

    // Of two faces of one outside that coincide: does g hide f?
    bool hides(const Flap& g, const Flap& f) const {
        const auto &a = found_->segment.side[f.side], &b = found_->segment.side[g.side];
        double above = glm::dot(f.normal, (b.a + b.b - a.a - a.b) * 0.5);
        if (std::abs(above) > 0.02 * options_.tolerance) return above > 0;
        // Where they cross at a small angle, the one that rises from the stretch.
        const double rise = glm::dot(glm::cross(f.away, g.away), direction_) * sideOf(f);
        if (std::abs(rise) > kCrossingAngle) return rise > 0;
        return std::make_pair(g.side == 1 && view_[0] != view_[1], body(g)) <
               std::make_pair(f.side == 1 && view_[0] != view_[1], body(f));
    }

    // The angle by which a walk along f turns to its outside until it stands on g.
    double angle(const Flap& f, const Flap& g) const {
        double cosine = glm::dot(f.away, g.away), sine = glm::dot(glm::cross(f.away, g.away), direction_) * sideOf(f);
        double a = std::atan2(sine, cosine);
        if (std::abs(a) < kSameAngle) a = 0;
        return a < 0 ? a + kTurn : a;
    }

    // What comes first from f. Null: f is covered, or alone.
    const Flap* goesOn(const Flap& f) const {
        const Flap* best = nullptr;
        double least = 0;
        for (const Flap& g : flaps_) {
            if (&g == &f) continue;
            double a = angle(f, g);
            if (a == 0 && g.side != f.side) {
                if (!faces(g, f)) {
                    if (hides(g, f)) return nullptr;
                    continue;
                }
                // Face to face where one is a solid's, else back to back.
                if (solid(f) || solid(g)) return nullptr;
                a = kTurn;
            }
            if (!best || a < least - kSameAngle || (a < least + kSameAngle && before(g, *best, f)))
                best = &g, least = a;
        }
        return best;
    }

    // Which of two flaps at one angle a walk from f meets.
    bool before(const Flap& g, const Flap& h, const Flap& f) const {
        if (g.side == h.side) return false;
        if (faces(g, f) == faces(h, f)) return hides(g, h);
        bool faceToFace = solid(g) || solid(h);
        return faces(g, f) != faceToFace;
    }

    dvec2 uvAt(const View& view, uint32_t t, dvec3 p) const {
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
        const View& view = *view_[f.side];
        const auto& side = found_->segment.side[f.side];
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

    std::optional<Contact> make(const Flap& f, const Flap& g) const {
        auto from = half(f), to = half(g);
        if (!from || !to) return std::nullopt;
        const ContactMesh &mesh = meshOf(f), &other = meshOf(g);
        uint32_t chart = mesh.triangles[f.triangle].chart, target = other.triangles[g.triangle].chart;
        // As the walk works it out; what differs from that is turned over.
        bool expected = from->insideLeft == (mesh.orientation[chart] * other.orientation[target] < 0);
        Contact contact{};
        Crossing& c = contact.crossing;
        c.a = glm::vec2(from->a), c.b = glm::vec2(from->b);
        c.ta = glm::vec2(to->a), c.tb = glm::vec2(to->b);
        c.edge = from->edge;
        c.targetEdge = to->edge;
        c.target = 0xFFFF0000u | target;
        c.flags = kCrossingContact | (from->insideLeft ? kCrossingInsideLeft : 0u) |
                  (expected != to->insideLeft ? kCrossingTurned : 0u) | chart << 16;
        if (view_[0] != view_[1]) {
            const auto& side = found_->segment.side[g.side];
            double over = expected != to->insideLeft ? -1 : 1;
            c.flags |= packCrossingJoint(jointOf(g.normal * over, f.normal, side.b - side.a));
        }
        contact.from = f.triangle;
        contact.to = g.triangle;
        contact.a = found_->segment.side[g.side].a;
        contact.b = found_->segment.side[g.side].b;
        contact.onward = g.away;
        contact.fromA = found_->segment.side[f.side].a;
        contact.fromB = found_->segment.side[f.side].b;
        contact.back = f.away;
        contact.turn = angle(f, g);
        if (contact.turn == 0) contact.turn = kTurn;  // back to back
        return contact;
    }

    // Adds a contact in up to three parts, so that none leads over a border of the chart that it leads to: what touches
    // within a tolerance may reach that far beyond its triangle. Beyond, all lead to where the border is met.
    void addWithin(const Contact& contact, const Flap& g, std::vector<Contact>& out) const {
        const View& view = *view_[g.side];
        const auto& uv = view.mesh.triangles[g.triangle].uv;
        dvec2 a(contact.crossing.ta), b(contact.crossing.tb);
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
        auto add = [&](double from, double to, double targetFrom, double targetTo) {
            if (!(to > from)) return;
            Contact part = contact;
            Crossing& c = part.crossing;
            glm::vec2 near = c.a, along = c.b - c.a;
            c.a = from > 0 ? near + along * float(from) : c.a;
            c.b = to < 1 ? near + along * float(to) : c.b;
            c.ta = glm::vec2(a + (b - a) * targetFrom);
            c.tb = glm::vec2(a + (b - a) * targetTo);
            part.a = contact.a + (contact.b - contact.a) * targetFrom;
            part.b = contact.a + (contact.b - contact.a) * targetTo;
            part.fromA = contact.fromA + (contact.fromB - contact.fromA) * from;
            part.fromB = contact.fromA + (contact.fromB - contact.fromA) * to;
            out.push_back(part);
        };
        // A walk tells by the target's direction on which side of it the chart lies, so that it has to have one.
        const double least = view.borderShift / std::max(glm::length(b - a), 1e-300);
        const bool room = t1 > t0;
        add(0, t0, room ? t0 : t0 - least / 2, room ? std::min(t0 + least, t1) : t0 + least / 2);
        add(t0, t1, t0, t1);
        add(t1, 1, room ? std::max(t1 - least, t0) : t1 - least / 2, room ? t1 : t1 + least / 2);
    }

    std::array<const View*, 2> view_;
    const ContactOptions& options_;
    const Found* found_ = nullptr;
    dvec3 direction_{0};
    std::vector<Flap> flaps_;
};

void find(const View& a, uint32_t i, const View& b, uint32_t j, double scale, std::vector<Found>& found) {
    std::array<ContactSegment, 6> segments;
    int count = touch(a.shape(i, 1), b.shape(j, scale), segments);
    for (int k = 0; k < count; ++k) {
        const ContactSegment& s = segments[size_t(k)];
        found.push_back({{a.keyOf(i, s.side[0].edge), b.keyOf(j, s.side[1].edge)}, {i, j}, s});
    }
}

// A shell meets itself where one of its borders lies against the middle of its own: a wall of a welded house that ends
// at another one.
void findWithinShells(const View& view, const BoxTree& tree, double tolerance, std::vector<Found>& found) {
    const ContactMesh& mesh = view.mesh;
    auto shareAPoint = [&](uint32_t i, uint32_t j) {
        for (uint32_t p : mesh.triangles[i].point)
            if (std::count(mesh.triangles[j].point.begin(), mesh.triangles[j].point.end(), p) > 0) return true;
        return false;
    };
    for (uint32_t h = 0; h < mesh.twin.size(); ++h) {
        if (mesh.twin[h] != kNoIndex) continue;
        const uint32_t i = h / 3;
        Box edge;
        edge.add(mesh.at(i, h % 3)), edge.add(mesh.at(i, (h + 1) % 3));
        tree.near(edge.grown(tolerance), [&](uint32_t j) {
            if (mesh.triangles[i].shell != mesh.triangles[j].shell || shareAPoint(i, j)) return;
            std::vector<Found> all;
            find(view, i, view, j, 1, all);
            for (const Found& f : all)
                if (f.segment.side[0].edge == int(h % 3)) found.push_back(f);
        });
    }
}

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
    View view{mesh, dmat4(1), true, options.borderShift};
    std::vector<Found> found;
    tree.pairs(options.tolerance, [&](uint32_t i, uint32_t j) {
        if (mesh.triangles[i].shell == mesh.triangles[j].shell) return;
        if (mesh.triangles[i].shell > mesh.triangles[j].shell)
            std::swap(i, j);  // one order for all pairs of two shells
        find(view, i, view, j, 1, found);
    });
    findWithinShells(view, tree, options.tolerance, found);
    merge(found);
    std::vector<Contact> out;
    Assembler assembler(view, view, options);
    for (const Found& f : found) assembler.add(f, {&out, &out});
    return out;
}

ContactsBetween contactsBetween(const ContactMesh& a, const BoxTree& treeA, const ContactMesh& b, const BoxTree& treeB,
                                const ContactOptions& options) {
    View viewA{a, dmat4(1), true, options.borderShift}, viewB{b, options.toA, false, options.otherBorderShift};
    double scale = std::cbrt(glm::determinant(glm::dmat3(options.toA)));
    std::vector<Found> found;
    treeA.pairs(treeB, options.toA, options.tolerance,
                [&](uint32_t i, uint32_t j) { find(viewA, i, viewB, j, scale, found); });
    merge(found);
    ContactsBetween out;
    Assembler assembler(viewA, viewB, options);
    for (const Found& f : found) assembler.add(f, {&out.fromA, &out.fromB});
    return out;
}

}  // namespace espalier
