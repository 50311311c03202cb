// In: a house's outline, its gables and the grids of its walls, on its plot. Out: triangles there. All walls of a house
// are divided at the same heights, so that they meet in equal corners; cells under an opening are left out, those at a
// roof are cut.
#include "tools/bake/main/town_walls.hpp"

#include <algorithm>
#include <cmath>

#include "shaders/shared/roof_cells.h"
#include "tools/bake/main/town_mesh.hpp"

namespace espalier {
namespace {

constexpr float kBefore = 0.01f;  // metres before the plaster
constexpr float kStandsOut = 0.02f, kNear = 0.3f;
constexpr float kMargin = 0.03f;    // left bare around an opening
constexpr float kBelowRoof = 0.3f;  // where leaves don't come through the tiles
constexpr float kLeast = 0.1f;      // height of a wall
constexpr float kWhole = 0.9f;      // of a wall, that a plinth is long at least

struct Rect {
    glm::vec2 low, high;  // along the wall and up, metres
};

struct Wall {
    glm::vec3 foot, along, out;  // unit
    float length = 0;
    std::vector<glm::vec2> top;  // from one end to the other, along the wall and up: a little below eave or verge
    std::vector<Rect> openings;
    float plinth = 0, plinthOut = 0;  // height and how far it stands out
};

// The cell's box in the wall's frame: along, up, out.
void boxOf(const RoofGrid& g, const RoofMesh& mesh, glm::vec2 corner, const Wall& wall, glm::vec3& low,
           glm::vec3& high) {
    const glm::vec3 x(g.axisX), y(g.axisY), up = glm::cross(x, y);
    low = glm::vec3(1e30f);
    high = -low;
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 unit(i & 1 ? mesh.high.x : mesh.low.x, i & 2 ? mesh.high.y : mesh.low.y,
                             i & 4 ? mesh.high.z : mesh.low.z);
        const glm::vec3 p = glm::vec3(g.origin) + x * (corner.x + unit.x * g.size.x) +
                            y * (corner.y + unit.y * g.size.y) + up * (unit.z * g.thickness) - wall.foot;
        const glm::vec3 at(glm::dot(p, wall.along), p.y, glm::dot(p, wall.out));
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
}

// Boards of a verge slope: walls end below them.
bool slopes(const RoofGrid& g) {
    const float up = std::abs(g.axisX.y) / glm::length(glm::vec3(g.axisX));
    return up > 0.05f && up < 0.99f;
}

void takeCell(const RoofGrid& g, const RoofMesh& mesh, glm::vec2 corner, std::vector<Wall>& walls) {
    const glm::vec3 faces = glm::cross(glm::vec3(g.axisX), glm::vec3(g.axisY));
    for (Wall& wall : walls) {
        if (glm::dot(faces, wall.out) < 0.99f * glm::length(faces) || slopes(g)) continue;
        glm::vec3 low, high;
        boxOf(g, mesh, corner, wall, low, high);
        if (low.z < -kNear || low.z > kNear || high.z < kStandsOut || high.x < 0 || low.x > wall.length) continue;
        if (low.y < kMargin && high.x - low.x > kWhole * wall.length) {
            wall.plinth = std::max(wall.plinth, high.y);
            wall.plinthOut = std::max(wall.plinthOut, high.z);
        } else {
            wall.openings.push_back({glm::vec2(low) - kMargin, glm::vec2(high) + kMargin});
        }
    }
}

void takeGrid(const RoofEnv& env, const RoofGrid& g, std::vector<Wall>& walls) {
    if (std::abs(glm::cross(glm::vec3(g.axisX), glm::vec3(g.axisY)).y) > 0.01f) return;
    const RoofMesh mesh = env.meshes.v[g.mesh & 255u];
    if (g.firstRow == kNoIndex) return takeCell(g, mesh, {0, 0}, walls);
    for (uint32_t row = 0; row < g.cells >> 16; ++row) {
        const uint32_t run = env.runs.v[g.firstRow + row].touched;
        for (uint32_t c = runFirst(run); c < runFirst(run) + runCount(run); ++c)
            takeCell(g, mesh, glm::vec2(c, row) * glm::vec2(g.step), walls);
    }
}

// Rising, no two nearer than a centimetre; what lies outside of 0 to `end` is pulled in.
std::vector<float> cuts(std::vector<float> at, float end) {
    at.insert(at.end(), {0, end});
    for (float& v : at) v = std::clamp(v, 0.0f, end);
    std::sort(at.begin(), at.end());
    std::vector<float> kept;
    for (float v : at)
        if (kept.empty() || v - kept.back() > 0.01f) kept.push_back(v);
    kept.back() = end;
    return kept;
}

float heightAt(const std::vector<glm::vec2>& line, float x) {
    size_t i = 1;
    while (i + 1 < line.size() && line[i].x < x) ++i;
    const glm::vec2 a = line[i - 1], b = line[i];
    return b.x > a.x ? a.y + (b.y - a.y) * std::clamp((x - a.x) / (b.x - a.x), 0.f, 1.f) : std::max(a.y, b.y);
}

// One line out of several that go over parts of a wall, lines above each other: the highest.
std::vector<glm::vec2> highestOf(const std::vector<std::vector<glm::vec2>>& lines) {
    std::vector<glm::vec2> points;
    for (const auto& line : lines)
        for (glm::vec2 p : line) {
            for (const auto& other : lines)
                if (&other != &line && p.x >= other.front().x && p.x <= other.back().x)
                    p.y = std::max(p.y, heightAt(other, p.x));
            points.push_back(p);
        }
    std::stable_sort(points.begin(), points.end(), [](glm::vec2 a, glm::vec2 b) { return a.x < b.x; });
    return points;
}

// The part of a cell below the line from (low.x, left) to (high.x, right): counterclockwise, convex, may be empty.
std::vector<glm::vec2> below(glm::vec2 low, glm::vec2 high, float left, float right) {
    const glm::vec2 corners[] = {low, {high.x, low.y}, high, {low.x, high.y}};
    const float tops[] = {left, right, right, left};
    const auto crossing = [&](float y) { return low.x + (high.x - low.x) * ((y - left) / (right - left)); };
    std::vector<glm::vec2> kept;
    const auto keep = [&](glm::vec2 p) {
        if (kept.empty() || (kept.back() != p && kept.front() != p)) kept.push_back(p);
    };
    for (int i = 0; i < 4; ++i) {
        const int next = (i + 1) % 4;
        const bool in = corners[i].y <= tops[i];
        if (in) keep(corners[i]);
        if (in == (corners[next].y <= tops[next])) continue;
        if (i % 2)  // upright
            keep({corners[i].x, tops[i]});
        else
            keep({crossing(corners[i].y), corners[i].y});
    }
    return kept;
}

class Builder {
  public:
    Builder(const RoofStructure& structure, const RoofHouse& house, RoofTriangles& out)
        : structure_(structure), house_(house), out_(out) {}

    void build(const RoofEnv& env, const std::vector<uint32_t>& grids) {
        std::vector<size_t> sizes;
        for (const auto& ring : house_.rings) {
            sizes.push_back(ring.size());
            for (size_t i = 0; i < ring.size(); ++i) walls_.push_back(wallFrom(ring[i], ring[(i + 1) % ring.size()]));
        }
        raiseGables();
        for (uint32_t g : grids) takeGrid(env, env.grids.v[g], walls_);
        std::vector<float> heights;
        float highest = 0;
        for (const Wall& wall : walls_) {
            plinth_ = std::max(plinth_, wall.plinth);
            plinthOut_ = std::max(plinthOut_, wall.plinthOut);
            for (const Rect& r : wall.openings) heights.insert(heights.end(), {r.low.y, r.high.y});
            for (glm::vec2 p : wall.top) highest = std::max(highest, p.y);
        }
        heights.insert(heights.end(), {plinth_, eave()});
        heights_ = cuts(std::move(heights), highest);
        size_t first = 0;
        for (size_t size : sizes) {
            for (size_t i = 0; i < size; ++i)
                if (!hidden(first + i))
                    write(walls_[first + (i + size - 1) % size], walls_[first + i], walls_[first + (i + 1) % size]);
            first += size;
        }
    }

  private:
    // A neighbour stands against all of it, or there is none.
    bool hidden(size_t wall) const {
        return house_.open || (wall < house_.shared.size() && house_.shared[wall] == kEndsRoof);
    }
    float eave() const { return std::max(house_.eaveHeight - house_.baseHeight - kBelowRoof, kLeast); }
    // Walls go up to the verges of their gables. Where a roof breaks, one gable is a face below and others above.
    void raiseGables() {
        std::vector<std::vector<std::vector<glm::vec2>>> lines(walls_.size());
        for (uint32_t f = house_.firstFace; f < house_.firstFace + house_.faceCount; ++f) {
            const RoofFace& face = structure_.faces[f];
            if (face.kind == FaceKind::gable) lines[face.edge].push_back(vergesOf(face));
        }
        for (size_t i = 0; i < walls_.size(); ++i)
            if (!lines[i].empty()) walls_[i].top = highestOf(lines[i]);
    }
    std::vector<glm::vec2> vergesOf(const RoofFace& face) const {
        const Wall& wall = walls_[face.edge];
        std::vector<glm::vec2> line;
        const auto add = [&](glm::vec3 p) {
            const glm::vec3 at = p - wall.foot;
            line.push_back({glm::dot(at, wall.along), std::max(at.y - kBelowRoof, kLeast)});
        };
        for (uint32_t i = face.segmentCount; i-- > 0;) add(structure_.segments[face.firstSegment + i].to);
        add(face.eave[1]);
        return line;
    }
    Wall wallFrom(glm::vec2 a, glm::vec2 b) const {
        Wall wall;
        const glm::vec2 to = (b - a) / glm::distance(a, b);
        wall.foot = {a.x, house_.baseHeight, -a.y};
        wall.along = {to.x, 0, -to.y};
        wall.out = {to.y, 0, to.x};
        wall.length = glm::distance(a, b);
        wall.top = {{0, eave()}, {wall.length, eave()}};
        return wall;
    }
    // Where the wall's column stands, `before` metres before the plaster; its ends are those of its neighbours.
    static glm::vec3 corner(const Wall& wall, const Wall& next, float before) {
        const glm::vec3 both = wall.out + next.out;
        return next.foot + both * (before / std::max(0.5f * glm::dot(both, both), 0.1f));
    }
    void write(const Wall& last, const Wall& wall, const Wall& next) {
        std::vector<float> along;
        for (const Rect& r : wall.openings) along.insert(along.end(), {r.low.x, r.high.x});
        for (glm::vec2 p : wall.top) along.push_back(p.x);
        along = cuts(std::move(along), wall.length);
        const size_t columns = along.size() - 1, rows = heights_.size() - 1;
        const auto at = [&](glm::vec2 of, float before) {
            glm::vec3 p = of.x == 0             ? corner(last, wall, before)
                          : of.x == wall.length ? corner(wall, next, before)
                                                : wall.foot + wall.along * of.x + wall.out * before;
            p.y += of.y;
            return p;
        };
        const auto open = [&](size_t column, size_t row) {
            const glm::vec2 middle((along[column] + along[column + 1]) / 2, (heights_[row] + heights_[row + 1]) / 2);
            return std::any_of(wall.openings.begin(), wall.openings.end(), [&](const Rect& r) {
                return glm::all(glm::greaterThan(middle, r.low)) && glm::all(glm::lessThan(middle, r.high));
            });
        };
        const auto before = [&](size_t row) { return heights_[row] < plinth_ - 0.02f ? plinthOut_ : kBefore; };
        for (size_t row = 0; row < rows; ++row)
            for (size_t c = 0; c < columns; ++c) {
                if (open(c, row)) continue;
                const glm::vec2 low(along[c], heights_[row]), high(along[c + 1], heights_[row + 1]);
                std::vector<glm::vec3> cell;
                for (glm::vec2 p : below(low, high, heightAt(wall.top, low.x), heightAt(wall.top, high.x)))
                    cell.push_back(at(p, before(row)));
                fan(cell);
                // The ledge from a plinth to the wall above it.
                if (row + 1 < rows && before(row + 1) != before(row) && !open(c, row + 1))
                    fan({at({low.x, high.y}, before(row)), at(high, before(row)), at(high, kBefore),
                         at({low.x, high.y}, kBefore)});
            }
    }
    // A convex polygon, counterclockwise seen from outside.
    void fan(const std::vector<glm::vec3>& points) {
        if (points.size() < 3) return;
        const uint32_t first = uint32_t(out_.positions.size());
        const glm::vec3 normal = glm::normalize(glm::cross(points[2] - points[0], points.back() - points[1]));
        for (glm::vec3 p : points) {
            out_.positions.push_back(p);
            out_.normals.push_back(normal);
            out_.colours.push_back(kWallColour);
        }
        for (uint32_t i = 2; i < points.size(); ++i)
            for (uint32_t corner : {0u, i - 1, i}) out_.indices.push_back(first + corner);
    }

    const RoofStructure& structure_;
    const RoofHouse& house_;
    RoofTriangles& out_;
    std::vector<Wall> walls_;
    std::vector<float> heights_;
    float plinth_ = 0, plinthOut_ = 0;
};

}  // namespace

void appendWalls(const RoofEnv& env, const std::vector<uint32_t>& grids, const RoofStructure& structure, uint32_t house,
                 RoofTriangles& out) {
    Builder(structure, structure.houses[house], out).build(env, grids);
}

}  // namespace espalier
