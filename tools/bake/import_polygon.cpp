// In: a polygon's corners. Out: triangles that fill it. Ears are cut in the order in which a walk around the outline
// meets them. A corner whose ear another one lies in is looked at again only when that one has gone, or a neighbour.
#include "tools/bake/import_polygon.hpp"

#include <algorithm>
#include <bit>

namespace espalier::import {
namespace {

constexpr uint32_t kLeaf = 8;  // points of a box that is not divided

double cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The most that cross(a, b, p) comes to for points p of the box.
double mostCross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& low, const glm::dvec2& high) {
    const glm::dvec2 along = b - a;
    return cross(a, b, {along.y > 0 ? low.x : high.x, along.x > 0 ? high.y : low.y});
}

}  // namespace

void RankedSet::fill(size_t count) {
    sums_.assign(count, 0);
    has_.assign(count, 1);
    size_ = uint32_t(count);
    for (size_t i = 0; i < count; ++i) {
        sums_[i] += 1;
        const size_t above = i | (i + 1);
        if (above < count) sums_[above] += sums_[i];
    }
}

void RankedSet::add(uint32_t number, uint32_t by) {
    for (size_t i = number; i < sums_.size(); i |= i + 1) sums_[i] += by;
    size_ += by;
}

void RankedSet::insert(uint32_t number) {
    if (!has_[number]) add(number, 1);
    has_[number] = 1;
}

void RankedSet::erase(uint32_t number) {
    if (has_[number]) add(number, ~0u);
    has_[number] = 0;
}

uint32_t RankedSet::below(uint32_t number) const {
    uint32_t sum = 0;
    for (size_t i = number; i > 0; i &= i - 1) sum += sums_[i - 1];
    return sum;
}

uint32_t RankedSet::at(uint32_t rank) const {
    size_t at = 0;
    for (size_t step = std::bit_floor(sums_.size()); step > 0; step /= 2)
        if (at + step <= sums_.size() && sums_[at + step - 1] <= rank) rank -= sums_[(at += step) - 1];
    return uint32_t(at);
}

void PointTree::build(const std::vector<glm::dvec2>& points) {
    points_ = &points;
    order_.resize(points.size());
    leafOf_.resize(points.size());
    gone_.assign(points.size(), 0);
    for (uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    nodes_.clear();
    build(0, 0, uint32_t(points.size()));
}

void PointTree::build(size_t node, uint32_t first, uint32_t last) {
    if (node >= nodes_.size()) nodes_.resize(node + 1);
    glm::dvec2 low(1e300), high(-1e300);
    for (uint32_t i = first; i < last; ++i)
        low = glm::min(low, (*points_)[order_[i]]), high = glm::max(high, (*points_)[order_[i]]);
    nodes_[node] = {low, high, first, last, last - first};
    if (last - first <= kLeaf) {
        for (uint32_t i = first; i < last; ++i) leafOf_[order_[i]] = uint32_t(node);
        return;
    }
    const int axis = high.x - low.x > high.y - low.y ? 0 : 1;
    const uint32_t middle = (first + last) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](uint32_t a, uint32_t b) { return (*points_)[a][axis] < (*points_)[b][axis]; });
    build(2 * node + 1, first, middle);
    build(2 * node + 2, middle, last);
}

void PointTree::erase(uint32_t point) {
    gone_[point] = 1;
    for (size_t node = leafOf_[point];; node = (node - 1) / 2) {
        --nodes_[node].left;
        if (node == 0) return;
    }
}

uint32_t PointTree::findIn(const glm::dvec2 (&corners)[3]) const {
    return findIn(0, corners);
}

uint32_t PointTree::findIn(size_t index, const glm::dvec2 (&corners)[3]) const {
    const Node& node = nodes_[index];
    if (node.left == 0) return kNone;
    const auto isCorner = [&](const glm::dvec2& p) { return p == corners[0] || p == corners[1] || p == corners[2]; };
    if (node.low == node.high && isCorner(node.low)) return kNone;
    for (int k = 0; k < 3; ++k)
        if (mostCross(corners[k], corners[(k + 1) % 3], node.low, node.high) < 0) return kNone;
    if (node.last - node.first > kLeaf) {
        const uint32_t found = findIn(2 * index + 1, corners);
        return found != kNone ? found : findIn(2 * index + 2, corners);
    }
    for (uint32_t i = node.first; i < node.last; ++i) {
        const glm::dvec2& p = (*points_)[order_[i]];
        if (!gone_[order_[i]] && !isCorner(p) && cross(corners[0], corners[1], p) >= 0 &&
            cross(corners[1], corners[2], p) >= 0 && cross(corners[2], corners[0], p) >= 0)
            return order_[i];
    }
    return kNone;
}

// Corners laid into their mean plane, counter-clockwise.
void Triangulator::flatten(const std::vector<glm::vec3>& positions, std::span<const uint32_t> polygon) {
    glm::dvec3 normal(0), origin(positions[polygon[0]]);
    for (size_t i = 0; i < polygon.size(); ++i) {
        glm::dvec3 a = glm::dvec3(positions[polygon[i]]) - origin;
        glm::dvec3 b = glm::dvec3(positions[polygon[(i + 1) % polygon.size()]]) - origin;
        normal += glm::cross(a, b);
    }
    glm::dvec3 size = glm::abs(normal);
    int k = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;  // the axis to drop
    int u = (k + 1) % 3, v = (k + 2) % 3;
    if (normal[k] < 0) std::swap(u, v);
    flat_.clear();
    for (uint32_t i : polygon) flat_.push_back({positions[i][u], positions[i][v]});
}

void Triangulator::begin() {
    const uint32_t n = uint32_t(flat_.size());
    before_.resize(n);
    after_.resize(n);
    for (uint32_t i = 0; i < n; ++i) before_[i] = (i + n - 1) % n, after_[i] = (i + 1) % n;
    left_.fill(n);
    doubtful_.fill(n);
    points_.build(flat_);
    isEar_.assign(n, 0);
    firstWaiting_.assign(n, PointTree::kNone);
    waiting_.clear();
}

bool Triangulator::isEar(uint32_t corner) {
    if (isEar_[corner]) return true;
    const glm::dvec2 ear[3] = {flat_[before_[corner]], flat_[corner], flat_[after_[corner]]};
    if (!(cross(ear[0], ear[1], ear[2]) > 0)) return false;
    const uint32_t inside = points_.findIn(ear);
    if (inside == PointTree::kNone) {
        isEar_[corner] = 1;
        return true;
    }
    waiting_.push_back({corner, firstWaiting_[inside]});
    firstWaiting_[inside] = uint32_t(waiting_.size() - 1);
    return false;
}

// The first ear from the place `at` on around what is left of the outline, to which `at` moves on. Where nothing is an
// ear, since the outline crosses itself, the corner at that place is cut all the same.
uint32_t Triangulator::nextEar(size_t& at) {
    const uint32_t place = uint32_t(at % left_.size());
    for (uint32_t from = left_.at(place); doubtful_.size() > 0;) {
        const uint32_t before = doubtful_.below(from);
        const uint32_t corner = doubtful_.at(before < doubtful_.size() ? before : 0);
        if (isEar(corner)) {
            at += (left_.below(corner) + left_.size() - place) % left_.size();
            return corner;
        }
        doubtful_.erase(corner);
    }
    at += left_.size();
    return left_.at(place);
}

void Triangulator::cut(uint32_t corner) {
    const uint32_t before = before_[corner], after = after_[corner];
    after_[before] = after;
    before_[after] = before;
    left_.erase(corner);
    doubtful_.erase(corner);
    points_.erase(corner);
    for (uint32_t neighbour : {before, after}) {
        isEar_[neighbour] = 0;
        doubtful_.insert(neighbour);
    }
    for (uint32_t i = firstWaiting_[corner]; i != PointTree::kNone; i = waiting_[i].next)
        if (left_.has(waiting_[i].corner)) doubtful_.insert(waiting_[i].corner);
}

void Triangulator::fill(const std::vector<glm::vec3>& positions, std::span<const uint32_t> polygon,
                        std::vector<uint32_t>& triangles) {
    const auto emit = [&](uint32_t a, uint32_t b, uint32_t c) {
        triangles.insert(triangles.end(), {polygon[a], polygon[b], polygon[c]});
    };
    if (polygon.size() == 3) return emit(0, 1, 2);
    flatten(positions, polygon);
    begin();
    for (size_t at = 0; left_.size() > 3;) {
        const uint32_t ear = nextEar(at);
        emit(before_[ear], ear, after_[ear]);
        cut(ear);
    }
    emit(left_.at(0), left_.at(1), left_.at(2));
}

}  // namespace espalier::import
