// In: rings and speeds. Out: nodes, faces and arcs of the weighted straight skeleton (Aichholzer 1995; weights as in
// Eppstein and Erickson 1999). Events live in one queue; a side's is dropped when its ends have changed, a reflex
// corner's is looked at in the order of its meetings with the edges' lines and counts if a side is there then.
#include "runtime/roof/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/roof/skeleton_wavefront.hpp"

namespace espalier {

namespace {

constexpr uint64_t kHighWork = 60;  // times as dear as in doubles

template <class T>
T absolute(T a) {
    return a < 0 ? -a : a;
}

// Newton from the double's root: exact to the last bits of either type.
template <class T>
T root(T a) {
    T r = std::sqrt(double(a));
    for (int i = 0; i < 2 && r > 0; i++) r = (r + a / r) / 2;
    return r;
}

}  // namespace

template <class T>
Wavefront<T>::Wavefront(const SkeletonInput& input, Tolerance tolerance, Skeleton& out, uint64_t& work)
    : input_(input), tolerance_(tolerance), out_(out), work_(work) {
    out_.nodes.clear();
    out_.faces.clear();
    out_.arcs.clear();
    uint32_t edge = 0;
    for (const auto& ring : input.rings) {
        uint32_t first = edge, count = uint32_t(ring.size());
        for (uint32_t i = 0; i < count; i++, edge++) {
            glm::dvec2 a = ring[i], b = ring[(i + 1) % count];
            out_.nodes.push_back({a.x, a.y, 0});
            out_.faces.push_back({edge, 0, edge, first + (i + 1) % count});
            addLine(lineThrough({a.x, a.y}, {b.x, b.y}, input.speeds[edge]));
        }
    }
    sides_.resize(lines_.size());
    corners_.reserve(4 * lines_.size());
    edge = 0;
    for (const auto& ring : input.rings) {
        int first = int(edge), count = int(ring.size());
        for (int i = 0; i < count; i++, edge++) {
            int c = addCorner(first + (i + count - 1) % count, int(edge), {ring[i].x, ring[i].y}, edge);
            if (i > 0) link(c - 1, c);
        }
        link(first + count - 1, first);
    }
}

template <class T>
typename Wavefront<T>::Line Wavefront<T>::lineThrough(Vec<T> a, Vec<T> b, T speed) const {
    Vec<T> d = b - a;
    T length = root(dot(d, d));
    Vec<T> along{d.x / length, d.y / length}, normal{-along.y, along.x};
    return {along, normal, dot(normal, a), speed};
}

template <class T>
void Wavefront<T>::addLine(const Line& line) {
    lines_.push_back(line);
    if constexpr (kHigh)
        nearLines_.push_back({{double(line.normal.x), double(line.normal.y)}, double(line.offset), double(line.speed)});
}

template <class T>
uint32_t Wavefront<T>::addNode(Vec<T> p, T time) {
    out_.nodes.push_back({double(p.x), double(p.y), double(time)});
    return uint32_t(out_.nodes.size() - 1);
}

template <class T>
void Wavefront<T>::addArc(uint32_t from, uint32_t to, int left, int right) {
    if (from != to) out_.arcs.push_back({from, to, uint32_t(left), uint32_t(right)});
}

template <class T>
int Wavefront<T>::addCorner(int left, int right, Vec<T> start, uint32_t node) {
    int c = int(corners_.size());
    corners_.push_back({-1, -1, left, right, start, {0, 0}, now_, node, true, false, T(-1), 0, 0, false});
    sides_[right].push_back(c);
    alive_++;
    return c;
}

template <class T>
void Wavefront<T>::link(int a, int b) {
    corners_[a].next = b;
    corners_[b].previous = a;
}

// The corner stops here and now: its arc is drawn. Returns the node at its end.
template <class T>
uint32_t Wavefront<T>::end(int corner, Vec<T>* where) {
    Corner& c = corners_[corner];
    Vec<T> p = at(c, now_);
    if (where) *where = p;
    uint32_t node = c.node;
    if (now_ > c.born) {
        node = addNode(p, now_);
        addArc(c.node, node, c.left, c.right);
    }
    c.alive = false;
    alive_--;
    return node;
}

// Velocity of a corner between two moving lines. False: they are parallel and don't move as one.
template <class T>
bool Wavefront<T>::setOff(int corner) {
    Corner& c = corners_[corner];
    const Line &a = lines_[c.left], &b = lines_[c.right];
    T sine = cross(a.along, b.along), cosine = dot(a.along, b.along);
    c.reflex = sine < 0;
    if (a.speed == b.speed && cosine > 0) {
        c.velocity = (a.speed / (1 + cosine)) * (a.normal + b.normal);
        return true;
    }
    if (absolute(sine) < tolerance_.parallel) return false;
    c.velocity = a.speed * a.normal + ((a.speed * cosine - b.speed) / sine) * a.along;
    return true;
}

template <class T>
void Wavefront<T>::start(int corner) {
    if (!corners_[corner].alive) return;
    int before = corners_[corner].previous, after = corners_[corner].next;
    if (before == after) return close(corner, before);
    if (!setOff(corner)) return slide(corner);
    scheduleShrink(before);
    scheduleShrink(corner);
}

// A loop of two sides: they lie on each other, and a ridge is left.
template <class T>
void Wavefront<T>::close(int a, int b) {
    int ahead = corners_[a].right, back = corners_[a].left;
    uint32_t na = end(a), nb = end(b);
    addArc(nb, na, ahead, back);
}

// Parallel sides meet at this corner. Facing each other they lie on each other: a ridge as far as the shorter reaches.
// In one line at different speeds the flatter roof goes on over the steeper one.
template <class T>
void Wavefront<T>::slide(int corner) {
    const Corner c = corners_[corner];
    Vec<T> here = at(c, now_);
    const Line &a = lines_[c.left], &b = lines_[c.right];
    Vec<T> toBefore = at(corners_[c.previous], now_) - here, toAfter = at(corners_[c.next], now_) - here;
    bool facing = dot(a.along, b.along) < 0;
    bool forward = facing ? dot(toAfter, toAfter) <= dot(toBefore, toBefore) : a.speed > b.speed;
    uint32_t node = end(corner);
    Vec<T> p;
    int merged;
    if (forward) {
        int right = corners_[c.next].right, beyond = corners_[c.next].next;
        uint32_t far = end(c.next, &p);
        addArc(far, node, c.right, c.left);
        merged = addCorner(c.left, right, p, far);
        link(c.previous, merged);
        link(merged, beyond);
    } else {
        int left = corners_[c.previous].left, beyond = corners_[c.previous].previous;
        uint32_t far = end(c.previous, &p);
        addArc(node, far, c.left, c.right);
        merged = addCorner(left, c.right, p, far);
        link(beyond, merged);
        link(merged, c.next);
    }
    start(merged);
}

// When the side that begins at the corner has no length left; infinity: it grows.
template <class T>
T Wavefront<T>::shrinkTime(int corner) const {
    const Corner &a = corners_[corner], &b = corners_[a.next];
    const Line& line = lines_[a.right];
    T length = dot(at(b, now_) - at(a, now_), line.along);
    T rate = dot(b.velocity - a.velocity, line.along);
    bool gone = length <= tolerance_.length && rate <= tolerance_.length;
    if (!gone && rate >= 0) return std::numeric_limits<double>::infinity();
    return now_ + (length > 0 && rate < 0 ? length / -rate : T(0));
}

template <class T>
void Wavefront<T>::scheduleShrink(int corner) {
    T time = shrinkTime(corner);
    if (time < std::numeric_limits<double>::infinity())
        events_.push({time, Kind::shrink, corner, corners_[corner].next});
    // The reflex corners at its ends may live longer than was thought when they looked for splits.
    for (int c : {corner, corners_[corner].next})
        if (corners_[c].reflex && !corners_[c].waiting) scheduleSplit(c);
}

// Queues the next line that the reflex corner meets while it lives: no longer than the sides beside it.
template <class T>
void Wavefront<T>::scheduleSplit(int corner) {
    Corner& c = corners_[corner];
    if (c.candidate == c.last) {
        T horizon = std::min(shrinkTime(c.previous), shrinkTime(corner));
        if (horizon > c.searched) findSplits(corner, horizon);
    }
    c.waiting = c.candidate < c.last;
    if (!c.waiting) return;
    const Meeting& next = pool_[c.candidate++];
    events_.push({std::max(next.time, now_), Kind::split, corner, next.face});
}

template <class T>
typename Wavefront<T>::Reach Wavefront<T>::reachOf(const Corner& c, T until) const {
    const double born = double(c.born);
    return {{double(c.start.x), double(c.start.y)},
            {double(c.velocity.x), double(c.velocity.y)},
            born,
            double(c.searched) - born,
            double(until) - born};
}

// In doubles: does the corner surely not meet this line in the time looked at? Most don't, and the number type may be
// dear. The slack is some thousand times what rounding does to metres of a town.
template <class T>
bool Wavefront<T>::beyond(const Reach& r, int face) const {
    if constexpr (!kHigh) return false;
    const Vec<double> normal = nearLines_[size_t(face)].normal;
    const double closing = nearLines_[size_t(face)].speed - dot(normal, r.velocity),
                 slack = 1e-6 * (1 + std::min(r.longest, 1e6));
    if (closing < -1e-6) return true;
    const double distance =
        dot(normal, r.start) - nearLines_[size_t(face)].offset - nearLines_[size_t(face)].speed * r.born;
    return distance < -slack || distance > r.longest * closing + slack || distance < r.least * closing - slack;
}

// Puts the next meetings with lines after `searched` into the pool, all up to the horizon or as many as are worth
// sorting.
template <class T>
void Wavefront<T>::findSplits(int corner, T horizon) {
    constexpr size_t kMost = 64;
    Corner& c = corners_[corner];
    found_.clear();
    T until = horizon + tolerance_.length;
    const Reach reach = reachOf(c, until);
    size_t looked = 0;
    for (int f = 0; f < int(lines_.size()); f++) {
        if (f == c.left || f == c.right || beyond(reach, f)) continue;
        const Line& line = lines_[f];
        looked++;
        T closing = line.speed - dot(line.normal, c.velocity);
        if (!(closing > 0)) continue;
        T distance = dot(line.normal, c.start) - line.offset - line.speed * c.born;
        if (distance < -tolerance_.length) continue;
        T time = c.born + (distance > 0 ? distance / closing : T(0));
        if (time > c.searched && time <= until) found_.push_back({time, f});
    }
    if (found_.size() > kMost) {
        std::nth_element(found_.begin(), found_.begin() + kMost, found_.end());
        T cut = found_[kMost].time;
        // Meetings of one moment stay together.
        auto later = [&](const Meeting& m) { return m.time > cut; };
        found_.erase(std::remove_if(found_.begin(), found_.end(), later), found_.end());
        until = cut;
    }
    std::sort(found_.begin(), found_.end());
    const uint64_t done = lines_.size() + (kHigh ? kHighWork * looked : 0);
    work_ -= std::min(work_, done);
    c.searched = until;
    c.candidate = int(pool_.size());
    pool_.insert(pool_.end(), found_.begin(), found_.end());
    c.last = int(pool_.size());
}

template <class T>
void Wavefront<T>::shrink(int a, int b) {
    const Corner &ca = corners_[a], &cb = corners_[b];
    if (!ca.alive || !cb.alive || ca.next != b) return;
    // The slower of the two knows better where they meet.
    bool first = dot(ca.velocity, ca.velocity) <= dot(cb.velocity, cb.velocity);
    Vec<T> p = at(first ? ca : cb, now_);
    int left = ca.left, right = cb.right, before = ca.previous, after = cb.next;
    uint32_t node = addNode(p, now_);
    addArc(ca.node, node, ca.left, ca.right);
    addArc(cb.node, node, cb.left, cb.right);
    corners_[a].alive = corners_[b].alive = false;
    alive_ -= 2;
    int merged = addCorner(left, right, p, node);
    link(before, merged);
    link(merged, after);
    start(merged);
}

template <class T>
bool Wavefront<T>::sameLoop(int a, int b) const {
    int c = a;
    do {
        if (c == b) return true;
        c = corners_[c].next;
    } while (c != a);
    return false;
}

// The face's side on which p lies; where two meet, the one that holds it better, in the corner's own loop first.
template <class T>
int Wavefront<T>::sideHit(int corner, int face, Vec<T> p) const {
    int best = -1;
    T bestDepth = 0;
    for (int s : sides_[face]) {
        const Corner& c = corners_[s];
        if (!c.alive || c.right != face) continue;
        const Line& line = lines_[face];
        T before = dot(p - at(c, now_), line.along), after = dot(at(corners_[c.next], now_) - p, line.along);
        T depth = std::min(before, after);
        if (depth < -tolerance_.length) continue;
        bool tie = best >= 0 && absolute(depth - bestDepth) <= 2 * tolerance_.length;
        bool better = best < 0 || (tie ? sameLoop(s, corner) && !sameLoop(best, corner) : depth > bestDepth);
        if (better) best = s, bestDepth = depth;
    }
    return best;
}

template <class T>
void Wavefront<T>::split(int corner, int face) {
    if (!corners_[corner].alive) return;
    Vec<T> p = at(corners_[corner], now_);
    int side = sideHit(corner, face, p);
    corners_[corner].waiting = false;
    if (side < 0) return scheduleSplit(corner);
    const Corner c = corners_[corner];
    int beyond = corners_[side].next;
    uint32_t node = end(corner);
    int ahead = addCorner(face, c.right, p, node);
    int behind = addCorner(c.left, face, p, node);
    // `side` may begin at c.next, or end at c.previous: then a loop of two is left there.
    link(side, ahead);
    link(ahead, c.next);
    link(c.previous, behind);
    link(behind, beyond);
    start(ahead);
    start(behind);
}

// At the break every loop begins anew: corners end at a level line and sides whose speed changes get a face above it.
template <class T>
void Wavefront<T>::breakAll() {
    events_ = {};
    size_t count = corners_.size();
    std::vector<int> renewed(count, -1);
    std::vector<int> living;
    for (size_t c = 0; c < count; c++)
        if (corners_[c].alive) living.push_back(int(c));
    std::vector<int> faceAbove(count, -1);
    for (int c : living) {
        int face = corners_[c].right;
        uint32_t edge = out_.faces[face].edge;
        faceAbove[c] = face;
        T speed = input_.speedsAbove[edge];
        if (!input_.breakAll && speed == lines_[face].speed) continue;
        Line line = lines_[face];
        line.offset = line.offset + (line.speed - speed) * now_;
        line.speed = speed;
        faceAbove[c] = int(lines_.size());
        addLine(line);
        sides_.emplace_back();
        out_.faces.push_back({edge, 1, 0, 0});
    }
    std::vector<std::pair<uint32_t, Vec<T>>> ends(count);
    for (int c : living) {
        Vec<T> p;
        uint32_t node = end(c, &p);
        ends[c] = {node, p};
    }
    for (int c : living)
        renewed[c] = addCorner(faceAbove[corners_[c].previous], faceAbove[c], ends[c].second, ends[c].first);
    for (int c : living) {
        int next = corners_[c].next, below = corners_[c].right, above = faceAbove[c];
        link(renewed[c], renewed[next]);
        if (above == below) continue;
        out_.faces[above].eaveFrom = ends[c].first;
        out_.faces[above].eaveTo = ends[next].first;
        addArc(ends[next].first, ends[c].first, below, above);
    }
    std::vector<int> parallel;
    for (int c : living)
        if (!setOff(renewed[c])) parallel.push_back(renewed[c]);
    for (int c : parallel)
        if (corners_[c].alive) slide(c);
    for (size_t c = count; c < corners_.size(); c++) {
        if (!corners_[c].alive) continue;
        scheduleShrink(int(c));
    }
}

template <class T>
bool Wavefront<T>::run() {
    int count = int(corners_.size());
    for (int c = 0; c < count; c++)
        if (!setOff(c)) return false;  // neighbours in one line at different speeds, or a spike
    for (int c = 0; c < count && work_ > 0; c++) scheduleShrink(c);
    if (input_.breakHeight < std::numeric_limits<double>::infinity())
        events_.push({T(input_.breakHeight), Kind::stop, std::numeric_limits<int>::max(), 0});
    // Each shrink or split uses up corners and sides; more than this many events is a loop.
    size_t limit = 64 * size_t(count) + 1024;
    while (alive_ > 0 && !events_.empty()) {
        Event event = events_.top();
        events_.pop();
        if (corners_.size() > limit || work_ == 0) return false;
        now_ = std::max(now_, event.time);
        if (event.kind == Kind::shrink) shrink(event.corner, event.other);
        if (event.kind == Kind::split) split(event.corner, event.other);
        if (event.kind == Kind::stop) breakAll();
    }
    return alive_ == 0;
}

bool straightSkeleton(const SkeletonInput& input, Precision precision, Skeleton& out, uint64_t& work) {
    if (precision == Precision::fast) return Wavefront<double>(input, {1e-9, 1e-8}, out, work).run();
    return Wavefront<__float128>(input, {1e-20, 1e-16}, out, work).run();
}

}  // namespace espalier
