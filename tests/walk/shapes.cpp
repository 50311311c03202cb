// Analytic surfaces for judging walks: embeddings of charts on one side, closed-form or integrated geodesics
// (great circles, RK4 on the torus, unfolding of cylinder, cone and cube) on the other.
#include "tests/walk/shapes.hpp"

#include <cmath>
#include <numbers>

namespace espalier::walktest {
namespace {

constexpr double kTau = 2 * std::numbers::pi;

// A grid of cells, each with a rectangle of the proportions of `extent`, turned differently, every third mirrored if
// `mirrors`.
std::vector<AtlasCell> gridCells(int columns, int rows, Vec2 extent, bool mirrors) {
    std::vector<AtlasCell> cells;
    for (int i = 0; i < columns * rows; ++i) {
        AtlasCell c;
        c.centre = Vec2((i % columns + 0.5) / columns, (i / columns + 0.5) / rows);
        c.angle = 0.25 + 1.1 * i;
        // The largest size at which the turned rectangle fits its cell with room for a gutter.
        double w = std::abs(extent.x * std::cos(c.angle)) + std::abs(extent.y * std::sin(c.angle));
        double h = std::abs(extent.x * std::sin(c.angle)) + std::abs(extent.y * std::cos(c.angle));
        c.extent = extent * std::min(0.86 / columns / w, 0.86 / rows / h);
        c.mirror = mirrors && i % 3 == 2;
        cells.push_back(c);
    }
    return cells;
}

std::optional<Vec3> torusGeodesic(double big, double small, Vec3 from, Vec3 direction, double length) {
    double u = std::atan2(from.y, from.x);
    double rho = std::hypot(from.x, from.y);
    double v = std::atan2(from.z, rho - big);
    Vec3 eu(-std::sin(u), std::cos(u), 0);
    Vec3 ev(-std::sin(v) * std::cos(u), -std::sin(v) * std::sin(u), std::cos(v));
    struct State {
        double u, v, du, dv;
    } s{u, v, glm::dot(direction, eu) / rho, glm::dot(direction, ev) / small};
    auto slope = [&](const State& q) {
        double w = big + small * std::cos(q.v);
        return State{q.du, q.dv, 2 * small * std::sin(q.v) / w * q.du * q.dv, -w * std::sin(q.v) / small * q.du * q.du};
    };
    auto moved = [](const State& q, const State& k, double h) {
        return State{q.u + h * k.u, q.v + h * k.v, q.du + h * k.du, q.dv + h * k.dv};
    };
    int steps = std::max(1, int(length / 0.002));
    double h = length / steps;
    for (int i = 0; i < steps; ++i) {
        State k1 = slope(s), k2 = slope(moved(s, k1, h / 2)), k3 = slope(moved(s, k2, h / 2)),
              k4 = slope(moved(s, k3, h));
        s = moved(moved(moved(moved(s, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
    }
    double w = big + small * std::cos(s.v);
    return Vec3(w * std::cos(s.u), w * std::sin(s.u), small * std::sin(s.v));
}

// Straight over the faces of [-1,1]³.
std::optional<Vec3> cubeGeodesic(Vec3 p, Vec3 d, double length) {
    int face = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(p[k]) > std::abs(p[face])) face = k;
    double sign = p[face] < 0 ? -1 : 1;
    p[face] = sign;
    d[face] = 0;
    d = glm::normalize(d);
    while (length > 0) {
        double reach = 1e9;
        int edge = -1;
        for (int k = 0; k < 3; ++k) {
            if (k == face || d[k] == 0) continue;
            double t = ((d[k] < 0 ? -1 : 1) - p[k]) / d[k];
            if (t < reach) reach = t, edge = k;
        }
        if (reach >= length) return p + d * length;
        p += d * reach;
        length -= reach;
        double outward = d[edge] < 0 ? -1 : 1;
        p[edge] = outward;
        d[face] = -sign * std::abs(d[edge]);
        d[edge] = 0;
        face = edge;
        sign = outward;
    }
    return p;
}

Vec3 cubeNormal(Vec3 p) {
    Vec3 a = glm::abs(p);
    if (a.x >= a.y && a.x >= a.z) return {p.x < 0 ? -1 : 1, 0, 0};
    if (a.y >= a.z) return {0, p.y < 0 ? -1 : 1, 0};
    return {0, 0, p.z < 0 ? -1 : 1};
}

// Face k of the cube: centre axis, and the axes along a and b with a × b outward.
struct Face {
    Vec3 axis, a, b;
    Vec3 at(Vec2 q) const { return axis + a * (2 * q.x - 1) + b * (2 * q.y - 1); }
};
const Face kFaces[6] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},   {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                        {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                        {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},  {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}};

}  // namespace

Vec2 AtlasCell::toUv(Vec2 ab) const {
    Vec2 q = (ab - 0.5) * extent;
    if (mirror) q.x = -q.x;
    return centre + Vec2(q.x * std::cos(angle) - q.y * std::sin(angle), q.x * std::sin(angle) + q.y * std::cos(angle));
}

Vec2 AtlasCell::toParameter(Vec2 uv) const {
    Vec2 q = uv - centre;
    Vec2 r(q.x * std::cos(angle) + q.y * std::sin(angle), -q.x * std::sin(angle) + q.y * std::cos(angle));
    if (mirror) r.x = -r.x;
    return r / extent + 0.5;
}

Shape sphere(int detail, bool mirrors) {
    Shape s;
    s.name = "sphere, 6 charts";
    auto cells = gridCells(3, 2, {1, 1}, mirrors);
    for (int i = 0; i < 6; ++i)
        s.charts.push_back({[i](Vec2 q) { return glm::normalize(kFaces[i].at(q)); }, detail, detail, cells[size_t(i)]});
    s.normal = [](Vec3 p) { return glm::normalize(p); };
    s.geodesic = [](Vec3 p, Vec3 d, double length) -> std::optional<Vec3> {
        return p * std::cos(length) + d * std::sin(length);
    };
    s.radius = std::sqrt(3.0);
    return s;
}

Shape torus(int detail, bool mirrors) {
    constexpr double big = 1, small = 0.4;
    Shape s;
    s.name = "torus, 6 charts";
    auto cells = gridCells(3, 2, {1, 0.6}, mirrors);
    for (int i = 0; i < 6; ++i) {
        int iu = i % 3, iv = i / 3;
        s.charts.push_back({[iu, iv](Vec2 q) {
                                double u = kTau * (iu + q.x) / 3, v = kTau * (iv + q.y) / 2;
                                double w = big + small * std::cos(v);
                                return Vec3(w * std::cos(u), w * std::sin(u), small * std::sin(v));
                            },
                            2 * detail, detail, cells[size_t(i)]});
    }
    s.normal = [](Vec3 p) {
        double rho = std::hypot(p.x, p.y);
        return glm::normalize(p - Vec3(p.x, p.y, 0) * (big / rho));
    };
    s.geodesic = [](Vec3 p, Vec3 d, double length) { return torusGeodesic(big, small, p, d, length); };
    s.radius = std::sqrt(2 * (big + small) * (big + small) + small * small);
    return s;
}

Shape cylinder(int detail, bool mirrors) {
    constexpr double r = 0.7, half = 1.4;
    Shape s;
    s.name = "cylinder, 6 charts";
    auto cells = gridCells(3, 2, {0.45, 1}, mirrors);
    for (int i = 0; i < 6; ++i)
        s.charts.push_back({[i](Vec2 q) {
                                double u = kTau * (i + q.x) / 6;
                                return Vec3(r * std::cos(u), r * std::sin(u), half * (2 * q.y - 1));
                            },
                            detail, detail, cells[size_t(i)]});
    s.normal = [](Vec3 p) { return glm::normalize(Vec3(p.x, p.y, 0)); };
    s.geodesic = [](Vec3 p, Vec3 d, double length) -> std::optional<Vec3> {
        double u = std::atan2(p.y, p.x);
        double turn = glm::dot(d, Vec3(-std::sin(u), std::cos(u), 0));
        u += turn * length / r;
        Vec3 end(r * std::cos(u), r * std::sin(u), p.z + d.z * length);
        if (std::abs(end.z) > half - 0.02) return std::nullopt;
        return end;
    };
    s.radius = std::sqrt(2 * r * r + half * half);
    return s;
}

Shape cone(int detail, bool mirrors) {
    // The frustum of the cone with its apex at z = 4 and radius 1 at z = 0, from z = 0 to z = 3.4.
    constexpr double h = 4, top = 3.4;
    const double slant = std::sqrt(1 + h * h), sine = 1 / slant;
    Shape s;
    s.name = "cone, 6 charts";
    auto cells = gridCells(6, 1, {0.35, 1}, mirrors);
    for (int i = 0; i < 6; ++i)
        s.charts.push_back({[i](Vec2 q) {
                                double u = kTau * (i + q.x) / 6, z = top * q.y, w = 1 - z / h;
                                return Vec3(w * std::cos(u), w * std::sin(u), z);
                            },
                            detail, detail, cells[size_t(i)]});
    s.normal = [](Vec3 p) {
        double rho = std::hypot(p.x, p.y);
        return glm::normalize(Vec3(p.x / rho * h, p.y / rho * h, 1));
    };
    s.geodesic = [=](Vec3 p, Vec3 d, double length) -> std::optional<Vec3> {
        // In the unrolled sector: polar radius l from the apex, polar angle u · sine.
        double u = std::atan2(p.y, p.x), l = (h - p.z) / h * slant;
        Vec3 around(-std::sin(u), std::cos(u), 0), outward = glm::normalize(p - Vec3(0, 0, h));
        Vec2 q(l, 0), e(glm::dot(d, outward), glm::dot(d, around));
        double nearest = std::clamp(-glm::dot(q, e), 0.0, length);
        Vec2 end = q + e * length;
        double l1 = glm::length(end);
        if (glm::length(q + e * nearest) < slant * (1 - top / h) + 0.05 || l1 > slant - 0.05) return std::nullopt;
        double angle = u + std::atan2(end.y, end.x) / sine;
        double w = l1 / slant;
        return Vec3(w * std::cos(angle), w * std::sin(angle), h * (1 - w));
    };
    s.radius = std::sqrt(2 + top * top / 4);
    return s;
}

Shape cubeOfSixCharts(bool mirrors) {
    Shape s;
    s.name = "cube, a chart a face";
    auto cells = gridCells(3, 2, {1, 1}, mirrors);
    for (int i = 0; i < 6; ++i) s.charts.push_back({[i](Vec2 q) { return kFaces[i].at(q); }, 1, 1, cells[size_t(i)]});
    s.normal = cubeNormal;
    s.geodesic = cubeGeodesic;
    s.radius = std::sqrt(3.0);
    return s;
}

Shape cubeWithStrip(bool mirrors) {
    Shape s;
    s.name = "cube, four faces in one chart";
    auto strip = [](Vec2 q) {
        double a = q.x * 4;
        int face = std::clamp(int(std::floor(a)), 0, 3);
        return kFaces[face].at({a - face, q.y});
    };
    s.charts.push_back({strip, 4, 1, {{0.5, 0.26}, {0.9, 0.225}, 0.13, false}});
    s.charts.push_back({[](Vec2 q) { return kFaces[4].at(q); }, 1, 1, {{0.25, 0.75}, {0.27, 0.27}, 0.7, false}});
    s.charts.push_back({[](Vec2 q) { return kFaces[5].at(q); }, 1, 1, {{0.72, 0.75}, {0.3, 0.3}, -0.4, mirrors}});
    s.normal = cubeNormal;
    s.geodesic = cubeGeodesic;
    s.radius = std::sqrt(3.0);
    return s;
}

Start randomStart(const Shape& shape, std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    Start s;
    s.chart = int(unit(random) * double(shape.charts.size())) % int(shape.charts.size());
    const ChartPatch& c = shape.charts[size_t(s.chart)];
    double across = unit(random), up = unit(random);  // one after the other: compilers differ in arguments' order
    Vec2 q(0.02 + 0.96 * across, 0.02 + 0.96 * up);
    s.uv = c.cell.toUv(q);
    s.position = c.at(q);
    Vec3 n = shape.normal(s.position);
    Vec3 a = glm::normalize(glm::cross(n, std::abs(n.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    double angle = kTau * unit(random);
    s.direction = a * std::cos(angle) + glm::cross(n, a) * std::sin(angle);
    return s;
}

}  // namespace espalier::walktest
