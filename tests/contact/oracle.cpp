#include "tests/contact/oracle.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Triangle_3.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <variant>

namespace espalier::contacttest {
namespace {

// What a variant of CGAL's holds, if it is a T: these are boost's before CGAL 6, and then the standard library's.
template <class T, class Variant>
const T* heldAs(const Variant& variant) {
    if constexpr (requires { std::get_if<T>(&variant); })
        return std::get_if<T>(&variant);
    else
        return boost::get<T>(&variant);
}

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;

Vec3 from(const Point& p) {
    return {CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())};
}

// The solid angle of a triangle seen from p, over 4 pi (van Oosterom and Strackee).
double solidAngle(Vec3 a, Vec3 b, Vec3 c, Vec3 p) {
    a -= p, b -= p, c -= p;
    double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    double up = glm::dot(a, glm::cross(b, c));
    double down = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    return std::atan2(up, down) / 6.283185307179586;
}

constexpr double kAgainst = -0.9986;  // cosine: of faces that lie against each other, 3 degrees off at most

Vec3 normalOf(const Vec3 (&p)[3]) {
    return glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
}

double toSegment(Vec3 p, Vec3 a, Vec3 b) {
    double t = std::clamp(glm::dot(p - a, b - a) / std::max(glm::dot(b - a, b - a), 1e-300), 0.0, 1.0);
    return glm::length(p - (a + (b - a) * t));
}

double toTriangle(Vec3 p, const Vec3 (&q)[3]) {
    Vec3 n = glm::cross(q[1] - q[0], q[2] - q[0]);
    bool within = true;
    for (int k = 0; k < 3; ++k) within = within && glm::dot(glm::cross(n, q[(k + 1) % 3] - q[k]), p - q[k]) >= 0;
    if (within) return std::abs(glm::dot(n, p - q[0])) / glm::length(n);
    return std::min({toSegment(p, q[0], q[1]), toSegment(p, q[1], q[2]), toSegment(p, q[2], q[0])});
}

}  // namespace

struct Oracle::Sight {
    using Plain = CGAL::Simple_cartesian<double>;
    using Shapes = std::vector<Plain::Triangle_3>;
    using Tree =
        CGAL::AABB_tree<CGAL::AABB_traits<Plain, CGAL::AABB_triangle_primitive<Plain, Shapes::const_iterator>>>;
    Shapes shapes;
    Tree tree;
    CGAL::Bbox_3 bounds;

    void add(const Vec3 (&p)[3]) {
        auto point = [](Vec3 q) { return Plain::Point_3(q.x, q.y, q.z); };
        shapes.emplace_back(point(p[0]), point(p[1]), point(p[2]));
        bounds += shapes.back().bbox();
    }
    void build() {
        tree.rebuild(shapes.cbegin(), shapes.cend());
        tree.build();
    }
};

Oracle::Oracle(const Model& model) {
    for (uint32_t i : model.indices) {
        low_ = glm::min(low_, Vec3(model.positions[i]));
        high_ = glm::max(high_, Vec3(model.positions[i]));
    }
    radius_ = glm::length(high_ - low_) / 2;
    std::map<std::tuple<int64_t, int64_t, int64_t>, uint32_t> cells;
    auto pointOf = [&](Vec3 p) {
        Vec3 g = glm::round(p / (radius_ * 1e-6));
        return cells.try_emplace({int64_t(g.x), int64_t(g.y), int64_t(g.z)}, uint32_t(cells.size())).first->second;
    };
    for (size_t i = 0; i + 2 < model.indices.size(); i += 3) {
        Triangle t{};
        for (size_t k = 0; k < 3; ++k) {
            t.p[k] = Vec3(model.positions[model.indices[i + k]]);
            t.point[k] = pointOf(t.p[k]);
        }
        if (glm::length(glm::cross(t.p[1] - t.p[0], t.p[2] - t.p[0])) > 1e-12 * radius_ * radius_)
            triangles_.push_back(t);
    }
    std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> edges;
    for (uint32_t i = 0; i < triangles_.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            uint32_t a = triangles_[i].point[k], b = triangles_[i].point[(k + 1) % 3];
            edges[std::minmax(a, b)].push_back(i * 3 + uint32_t(k));
        }
    std::vector<uint32_t> parent(triangles_.size());
    std::iota(parent.begin(), parent.end(), 0u);
    auto find = [&](uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (const auto& [edge, halves] : edges)
        for (uint32_t h : halves) parent[find(h / 3)] = find(halves[0] / 3);
    closed_.assign(triangles_.size(), 1);
    for (uint32_t i = 0; i < triangles_.size(); ++i) triangles_[i].piece = find(i);
    for (const auto& [edge, halves] : edges) {
        if (halves.size() != 1) continue;
        const Triangle& t = triangles_[halves[0] / 3];
        closed_[t.piece] = 0;
        borders_.push_back({t.p[halves[0] % 3], t.p[(halves[0] + 1) % 3]});
        borderTriangle_.push_back(halves[0] / 3);
    }
    auto sight = std::make_shared<Sight>();
    std::map<uint32_t, std::shared_ptr<Sight>> bodies;
    for (const Triangle& t : triangles_) {
        sight->add(t.p);
        if (!closed_[t.piece]) continue;
        auto& body = bodies[t.piece];
        if (!body) body = std::make_shared<Sight>();
        body->add(t.p);
    }
    sight->build();
    sight_ = sight;
    for (auto& [piece, body] : bodies) {
        body->build();
        bodies_.push_back(piece);
        bodySight_.push_back(body);
    }
}

std::vector<ContactLine> Oracle::intersections() const {
    using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, uint32_t>;
    std::vector<Box> boxes;
    std::vector<Kernel::Triangle_3> shapes;
    for (uint32_t i = 0; i < triangles_.size(); ++i) {
        const Vec3* p = triangles_[i].p;
        shapes.emplace_back(Point(p[0].x, p[0].y, p[0].z), Point(p[1].x, p[1].y, p[1].z),
                            Point(p[2].x, p[2].y, p[2].z));
        CGAL::Bbox_3 box;
        for (int k = 0; k < 3; ++k) box += CGAL::Bbox_3(p[k].x, p[k].y, p[k].z, p[k].x, p[k].y, p[k].z);
        boxes.emplace_back(box, i);
    }
    std::vector<ContactLine> lines;
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& x, const Box& y) {
        if (triangles_[x.info()].piece == triangles_[y.info()].piece) return;
        if (glm::dot(normalOf(triangles_[x.info()].p), normalOf(triangles_[y.info()].p)) < kAgainst) return;
        auto shared = CGAL::intersection(shapes[x.info()], shapes[y.info()]);
        if (!shared) return;
        if (const auto* s = heldAs<Kernel::Segment_3>(*shared)) lines.push_back({from(s->source()), from(s->target())});
    });
    return lines;
}

double Oracle::winding(Vec3 p) const {
    double sum = 0;
    for (const Triangle& t : triangles_)
        if (closed_[t.piece]) sum += solidAngle(t.p[0], t.p[1], t.p[2], p);
    return sum;
}

uint32_t Oracle::insideOf(Vec3 p, double depth) const {
    for (size_t i = 0; i < bodies_.size(); ++i) {
        const Sight& body = *bodySight_[i];
        const CGAL::Bbox_3& b = body.bounds;
        const Vec3 within = glm::min(p - Vec3(b.xmin(), b.ymin(), b.zmin()), Vec3(b.xmax(), b.ymax(), b.zmax()) - p);
        if (std::min({within.x, within.y, within.z}) <= depth) continue;
        if (body.tree.squared_distance({p.x, p.y, p.z}) <= depth * depth) continue;
        double sum = 0;
        for (const auto& t : body.shapes)
            sum += solidAngle({t[0].x(), t[0].y(), t[0].z()}, {t[1].x(), t[1].y(), t[1].z()},
                              {t[2].x(), t[2].y(), t[2].z()}, p);
        if (std::abs(sum) > 0.5) return bodies_[i];
    }
    return kNoPiece;
}

bool Oracle::seen(Vec3 p, Vec3 normal) const {
    constexpr int kRays = 200;
    for (int i = 0; i < kRays; ++i) {
        double z = 1 - (2 * i + 1.0) / kRays, r = std::sqrt(1 - z * z), turn = 2.399963229728653 * i;
        Vec3 ray(r * std::cos(turn), z, r * std::sin(turn));
        if (normal != Vec3(0) && glm::dot(ray, normal) < 0.02) continue;
        Vec3 end = p + ray * (ray.y < 0 ? (low_.y - p.y) / ray.y : 0.0);
        if (ray.y < 0 && end.x > low_.x && end.x < high_.x && end.z > low_.z && end.z < high_.z) continue;
        using Plain = Sight::Plain;
        if (!sight_->tree.do_intersect(
                Plain::Ray_3(Plain::Point_3(p.x, p.y, p.z), Plain::Vector_3(ray.x, ray.y, ray.z))))
            return true;
    }
    return false;
}

bool Oracle::visible(const ContactLine& line, double room) const {
    Vec3 d = glm::normalize(line.b - line.a), m = (line.a + line.b) * 0.5;
    Vec3 u = glm::normalize(glm::cross(d, std::abs(d.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0))), v = glm::cross(d, u);
    for (int k = 0; k < 16; ++k) {
        double angle = (k + 0.5) * 6.283185307179586 / 16;
        for (double away : {0.75, 1.0, 2.0}) {
            Vec3 p = m + (u * std::cos(angle) + v * std::sin(angle)) * (room > 0 ? away * room : 2e-4 * radius_);
            double near2 = room > 0 ? sight_->tree.squared_distance({p.x, p.y, p.z}) : 1e300;
            if (near2 >= 0.24 * room * room && winding(p) < 0.5 && seen(p, Vec3(0))) return true;
        }
    }
    return false;
}

uint32_t Oracle::pieceAt(Vec3 p) const {
    auto nearest = sight_->tree.closest_point_and_primitive({p.x, p.y, p.z}).second;
    return triangles_[size_t(nearest - sight_->shapes.cbegin())].piece;
}

double Oracle::toSurface(Vec3 p) const {
    return std::sqrt(sight_->tree.squared_distance({p.x, p.y, p.z}));
}

double Oracle::toBorder(Vec3 p, double within) const {
    double best = 1e300;
    for (size_t i = 0; i < borders_.size(); ++i) {
        const ContactLine& l = borders_[i];
        if (toSegment(p, l.a, l.b) > within) continue;
        Vec3 ab = l.b - l.a;
        double length = glm::length(ab), foot = glm::dot(p - l.a, ab) / length;
        uint32_t own = borderTriangle_[i];
        // Where another piece touches, the model does go on; beside that it may not.
        for (double beside : {0.0, -0.15, 0.15, -0.4, 0.4, -0.8, 0.8}) {
            Vec3 at = l.a + ab * (std::clamp(foot + beside * within, 0.0, length) / length);
            double d = glm::length(p - at);
            if (d >= best || d > within) continue;
            bool goesOn = false;
            for (uint32_t k = 0; k < triangles_.size() && !goesOn; ++k) {
                if (k == own || triangles_[k].piece == triangles_[own].piece) continue;
                goesOn = toTriangle(at, triangles_[k].p) <= 1e-4 * radius_;
            }
            if (!goesOn) best = d;
        }
    }
    return best;
}

}  // namespace espalier::contacttest
