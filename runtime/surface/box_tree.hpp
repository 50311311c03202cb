#pragma once

// A binary tree of boxes over numbered things, for what asks for more than one hit: pairs that may touch, all that a
// ray meets, all near a point. Read-only after it is built. Boxes hold doubles: contacts are decided by them.

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

namespace espalier {

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    void add(glm::dvec3 p) { low = glm::min(low, p), high = glm::max(high, p); }
    void add(const Box& b) { low = glm::min(low, b.low), high = glm::max(high, b.high); }
    Box grown(double by) const { return {low - by, high + by}; }
    bool touches(const Box& b) const {
        return low.x <= b.high.x && low.y <= b.high.y && low.z <= b.high.z && high.x >= b.low.x && high.y >= b.low.y &&
               high.z >= b.low.z;
    }
    // Around the box after an affine map.
    Box mapped(const glm::dmat4& m) const {
        if (low.x > high.x) return *this;
        glm::dvec3 middle = glm::dvec3(m * glm::dvec4((low + high) * 0.5, 1)), half = (high - low) * 0.5, reach(0);
        for (int k = 0; k < 3; ++k) reach += glm::abs(glm::dvec3(m[k])) * half[k];
        return {middle - reach, middle + reach};
    }
};

class BoxTree {
  public:
    BoxTree() = default;
    // group[i]: pairs within one group are never asked for; subtrees of one group are skipped whole.
    BoxTree(std::vector<Box> boxes, const std::vector<uint32_t>& group) : boxes_(std::move(boxes)) {
        items_.resize(boxes_.size());
        for (uint32_t i = 0; i < items_.size(); ++i) items_[i] = i;
        if (!items_.empty()) build(0, uint32_t(items_.size()), group);
    }

    bool empty() const { return nodes_.empty(); }
    const Box& bounds() const { return nodes_[0].box; }

    // fn(i, j), i of this tree and j of the other, once for each two whose boxes, grown by `grow`, touch when the
    // other's are mapped by toThis.
    template <class Fn>
    void pairs(const BoxTree& other, const glm::dmat4& toThis, double grow, Fn&& fn) const {
        findPairs(other, toThis, grow, false, fn);
    }
    // The same within this tree: each pair once, pairs of one group left out.
    template <class Fn>
    void pairs(double grow, Fn&& fn) const {
        findPairs(*this, glm::dmat4(1), grow, true, fn);
    }

    // fn(i) for each whose box touches `box`.
    template <class Fn>
    void near(const Box& box, Fn&& fn) const {
        visit([&](const Box& b) { return b.touches(box); }, fn);
    }

    // Does one of the boxes touch `box`?
    bool meets(const Box& box) const {
        bool met = false;
        visit([&](const Box& b) { return !met && b.touches(box); }, [&](uint32_t) { met = true; });
        return met;
    }

    // The least of square(i), the squares of distances from `point`, and of `least`; asked only of those whose boxes
    // are nearer than what was found before, near ones first.
    template <class Fn>
    double nearestSquare(glm::dvec3 point, Fn&& square, double least = std::numeric_limits<double>::infinity()) const {
        if (empty()) return least;
        const auto away = [&](const Box& b) {
            const glm::dvec3 d = glm::max(glm::max(b.low - point, point - b.high), glm::dvec3(0));
            return glm::dot(d, d);
        };
        struct Ahead {
            uint32_t node;
            double away;
        };
        Ahead stack[96];
        uint32_t top = 0;
        stack[top++] = {0, away(bounds())};
        while (top > 0) {
            const auto [node, nearest] = stack[--top];
            if (nearest >= least) continue;
            const Node& n = nodes_[node];
            for (uint32_t i = n.first; i < n.first + n.count; ++i)
                if (away(boxes_[items_[i]]) < least) least = std::min(least, double(square(items_[i])));
            if (n.count > 0) continue;
            Ahead near{n.first, away(nodes_[n.first].box)}, far{n.first + 1, away(nodes_[n.first + 1].box)};
            if (far.away < near.away) std::swap(near, far);
            stack[top++] = far;
            stack[top++] = near;
        }
        return least;
    }

    // fn(i) for each whose box the ray meets.
    template <class Fn>
    void along(glm::dvec3 origin, glm::dvec3 direction, Fn&& fn) const {
        glm::dvec3 k = 1.0 / direction;
        visit(
            [&](const Box& b) {
                glm::dvec3 t0 = (b.low - origin) * k, t1 = (b.high - origin) * k;
                glm::dvec3 in = glm::min(t0, t1), out = glm::max(t0, t1);
                return std::max({in.x, in.y, in.z, 0.0}) <= std::min({out.x, out.y, out.z});
            },
            fn);
    }

  private:
    static constexpr uint32_t kMixed = 0xFFFFFFFFu;
    static constexpr uint32_t kLeaf = 4;
    // count 0: inner, with children first and first + 1; else items_[first, first + count).
    struct Node {
        Box box;
        uint32_t first = 0, count = 0, group = kMixed;
    };

    static double size(const Node& n) {
        glm::dvec3 d = n.box.high - n.box.low;
        return d.x + d.y + d.z;
    }

    template <class Fn>
    void findPairs(const BoxTree& other, const glm::dmat4& toThis, double grow, bool self, Fn& fn) const {
        if (empty() || other.empty()) return;
        std::vector<std::pair<uint32_t, uint32_t>> stack{{0, 0}};
        while (!stack.empty()) {
            auto [a, b] = stack.back();
            stack.pop_back();
            const Node &n = nodes_[a], &m = other.nodes_[b];
            if (self && n.group == m.group && n.group != kMixed) continue;
            if (!n.box.grown(grow).touches(self ? m.box : m.box.mapped(toThis))) continue;
            if (n.count > 0 && m.count > 0) {
                for (uint32_t i = n.first; i < n.first + n.count; ++i)
                    for (uint32_t j = a == b && self ? i + 1 : m.first; j < m.first + m.count; ++j) {
                        const Box& there = other.boxes_[other.items_[j]];
                        if (boxes_[items_[i]].grown(grow).touches(self ? there : there.mapped(toThis)))
                            fn(items_[i], other.items_[j]);
                    }
            } else if (self && a == b) {
                stack.insert(stack.end(), {{n.first, n.first}, {n.first, n.first + 1}, {n.first + 1, n.first + 1}});
            } else if (m.count > 0 || (n.count == 0 && size(n) >= size(m))) {
                stack.insert(stack.end(), {{n.first, b}, {n.first + 1, b}});
            } else {
                stack.insert(stack.end(), {{a, m.first}, {a, m.first + 1}});
            }
        }
    }

    void build(uint32_t begin, uint32_t end, const std::vector<uint32_t>& group) {
        struct Work {
            uint32_t node, begin, end;
        };
        nodes_.reserve(items_.size());
        nodes_.emplace_back();
        std::vector<Work> stack{{0, begin, end}};
        while (!stack.empty()) {
            Work w = stack.back();
            stack.pop_back();
            Box box, middles;
            uint32_t only = group.empty() ? kMixed : group[items_[w.begin]];
            for (uint32_t i = w.begin; i < w.end; ++i) {
                const Box& b = boxes_[items_[i]];
                box.add(b);
                middles.add((b.low + b.high) * 0.5);
                if (!group.empty() && group[items_[i]] != only) only = kMixed;
            }
            nodes_[w.node].box = box;
            nodes_[w.node].group = only;
            if (w.end - w.begin <= kLeaf) {
                nodes_[w.node].first = w.begin;
                nodes_[w.node].count = w.end - w.begin;
                continue;
            }
            glm::dvec3 d = middles.high - middles.low;
            int axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
            uint32_t half = (w.begin + w.end) / 2;
            auto middle = [&](uint32_t i) { return boxes_[i].low[axis] + boxes_[i].high[axis]; };
            std::nth_element(items_.begin() + w.begin, items_.begin() + half, items_.begin() + w.end,
                             [&](uint32_t x, uint32_t y) { return middle(x) < middle(y); });
            uint32_t child = uint32_t(nodes_.size());
            nodes_[w.node].first = child;
            nodes_.resize(child + 2);
            stack.push_back({child, w.begin, half});
            stack.push_back({child + 1, half, w.end});
        }
    }

    template <class Inside, class Fn>
    void visit(Inside&& inside, Fn&& fn) const {
        if (empty()) return;
        uint32_t stack[96], top = 0;
        stack[top++] = 0;
        while (top > 0) {
            const Node& n = nodes_[stack[--top]];
            if (!inside(n.box)) continue;
            if (n.count > 0) {
                for (uint32_t i = n.first; i < n.first + n.count; ++i)
                    if (inside(boxes_[items_[i]])) fn(items_[i]);
            } else {
                stack[top++] = n.first;
                stack[top++] = n.first + 1;
            }
        }
    }

    std::vector<Box> boxes_;
    std::vector<uint32_t> items_;
    std::vector<Node> nodes_;
};

}  // namespace espalier
