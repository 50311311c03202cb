// The ruin's three walls. In: their elevations. Out: a chart for each face, for the crests and for the arch's
// soffit, meeting in equal vertices, and the footprints that they leave in the ground.

#include <algorithm>
#include <cmath>

#include "tools/content/masonry.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/ruin.hpp"
#include "tools/content/wall_layers.hpp"

namespace espalier::content {
namespace {

constexpr float kThickness = 0.7f, kHalf = 0.35f;
constexpr float kMainBegin = -3.5f, kMainEnd = 3.4f;
constexpr float kInnerX = kMainBegin + kThickness;
constexpr float kReturnEnd = 2.7f;
constexpr uint32_t kAcross = 14;  // pieces of a wall's thickness

Elevation mainWall() {
    return Elevation(kMainBegin, kMainEnd,
                     {{kMainBegin, 14},
                      {kInnerX, 14},
                      {-2.25f, 13},
                      {-1.72f, 14},
                      {-1.2f, 13},
                      {-0.55f, 12},
                      {0.1f, 13},
                      {0.72f, 12},
                      {1.3f, 11},
                      {1.72f, 9},
                      {2.12f, 8},
                      {2.42f, 6},
                      {2.75f, 4},
                      {3.08f, 2}},
                     Arch{0.55f, 0.78f, 1.66f, 0.36f, 13}, 4101);
}

Elevation returnWall() {
    return Elevation(
        -kHalf, kReturnEnd,
        {{-kHalf, 14}, {kHalf, 14}, {0.78f, 13}, {1.08f, 11}, {1.42f, 10}, {1.72f, 8}, {2.08f, 5}, {2.42f, 3}}, Arch{},
        4202);
}

// What is left of the court's other side: low, and open at both ends.
constexpr float kEastX = 4.25f;  // of its middle

Elevation eastWall() {
    return Elevation(1.0f, 4.2f, {{1.0f, 2}, {1.32f, 4}, {1.75f, 5}, {2.3f, 4}, {2.7f, 6}, {3.15f, 3}, {3.7f, 1}},
                     Arch{}, 4303);
}

float across(uint32_t i) {
    return glm::mix(-kHalf, kHalf, static_cast<float>(i) / static_cast<float>(kAcross));
}

// A face of a wall lies in a vertical plane: a point (along, y) of the elevation is at block(along, y).
struct Face {
    const char* name;
    float from;  // along, where the face begins
    float sign;  // s = sign * along
    glm::vec3 normal;
    uint32_t side;
    bool cornerAtBegin;  // the face begins at a convex corner
    std::function<glm::vec3(glm::vec2)> block;
};

// Outline of a face in its elevation, counter-clockwise.
std::vector<glm::vec2> faceLoop(const Elevation& wall, float from) {
    std::vector<glm::vec2> loop;
    auto addFoot = [&](float a, float b) {
        for (float x : wall.foot(a, b)) loop.push_back({x, 0});
    };
    const Arch& arch = wall.arch();
    if (arch.present()) {
        addFoot(from, arch.centre - arch.halfWidth);
        loop.pop_back();
        for (glm::vec2 p : wall.openingLine()) loop.push_back(p);
        loop.pop_back();
        addFoot(arch.centre + arch.halfWidth, wall.end());
    } else {
        addFoot(from, wall.end());
    }
    loop.pop_back();
    std::vector<glm::vec2> crest = wall.crestLine();
    for (size_t i = crest.size(); i-- > 0;)
        if (crest[i].x > from - 1e-4f) loop.push_back(crest[i]);
    std::vector<float> side = verticalSamples(wall.top(from));
    loop.pop_back();
    for (size_t i = side.size(); i-- > 1;) loop.push_back({from, side[i]});
    return loop;
}

void addFace(std::vector<Chart>& charts, const Elevation& wall, const Face& face) {
    Chart chart;
    chart.name = face.name;
    auto toSt = [&](glm::vec2 p) { return glm::vec2(face.sign * p.x, p.y); };
    std::vector<glm::vec2> loop;
    for (glm::vec2 p : faceLoop(wall, face.from)) loop.push_back(toSt(p));
    if (face.sign < 0) std::reverse(loop.begin(), loop.end());
    std::vector<Candidates> candidates;
    auto along = [&](float offset, float spacing, float clear) {
        Candidates c{wall.alongJoints(offset), spacing, clear};
        for (glm::vec2& p : c.points) p = toSt(p);
        candidates.push_back(std::move(c));
    };
    along(0, 0.064f, 0.02f);
    along(0.042f, 0.064f, 0.024f);
    along(0.018f, 0.07f, 0.017f);
    Candidates fill{{}, 0.098f, 0.055f};
    int row = 0;
    for (float y = 0.03f; y < wall.top(wall.begin()); y += 0.086f, ++row)
        for (float x = face.from + ((row & 1) != 0 ? 0.02f : 0.06f); x < wall.end(); x += 0.1f)
            fill.points.push_back(toSt({x, y}));
    candidates.push_back(std::move(fill));
    triangulate(chart, {loop}, candidates);
    for (glm::vec2 st : chart.st) {
        chart.block.push_back(face.block({face.sign * st.x, st.y}));
        chart.normal.push_back(face.normal);
    }
    chart.detail = [wall, face](glm::vec2 st) {
        glm::vec2 p{face.sign * st.x, st.y};
        StonePlace place = wall.placeAt(p, face.side);
        if (face.cornerAtBegin) place.edge = std::min(place.edge, std::max(p.x - face.from, 0.0f));
        StoneLook look;
        look.block = face.block(p);
        look.st = st;
        look.aboveGround = p.y;
        look.belowCrest = wall.belowCrest(p);
        Detail stone = stoneDetail(place, look);
        return face.side == 0 ? tondoDetail(p - kTondo, look, stone) : stone;
    };
    if (face.side == 0) chart.ivy = [wall](glm::vec2 st) { return frontIvy(st, wall); };
    if (face.side == 1) chart.ivy = [face](glm::vec2 st) { return backIvy({face.sign * st.x, st.y}); };
    if (face.side == 3) chart.ivy = [face](glm::vec2 st) { return outerIvy({face.sign * st.x, st.y}); };
    if (face.side == 0) chart.mask = [wall, face](glm::vec2 st) { return mainMask({face.sign * st.x, st.y}, wall); };
    charts.push_back(std::move(chart));
}

// A strip across a wall's thickness along a line of its elevation: a crest or a soffit.
struct Rim {
    std::vector<glm::vec2> line;    // (along, y)
    std::vector<float> length;      // to each point
    std::vector<glm::vec2> normal;  // of each piece, in elevation
    std::vector<float> breaks;      // lengths at which one stone ends and the next begins
    std::vector<uint32_t> ids;      // of the stones between them
    std::vector<float> corners;     // lengths of convex corners
};

Rim makeRim(const Elevation& wall, std::vector<glm::vec2> line, bool outsideIsRight) {
    Rim rim;
    rim.line = std::move(line);
    rim.length.push_back(0);
    uint32_t last = 0;
    for (size_t i = 0; i + 1 < rim.line.size(); ++i) {
        glm::vec2 d = rim.line[i + 1] - rim.line[i];
        rim.length.push_back(rim.length.back() + glm::length(d));
        d = glm::normalize(d);
        glm::vec2 n = outsideIsRight ? glm::vec2(d.y, -d.x) : glm::vec2(-d.y, d.x);
        if (i > 0 && glm::dot(n, rim.normal.back()) < 0.9f && glm::dot(d, rim.normal.back()) > 0)
            rim.corners.push_back(rim.length[i]);
        rim.normal.push_back(n);
        uint32_t id = wall.placeAt((rim.line[i] + rim.line[i + 1]) * 0.5f - n * 0.03f, 7).id;
        if (i == 0 || id != last) {
            rim.breaks.push_back(rim.length[i]);
            rim.ids.push_back(id);
        }
        last = id;
    }
    rim.breaks.push_back(rim.length.back());
    return rim;
}

size_t pieceAt(const Rim& rim, float s) {
    size_t i = static_cast<size_t>(std::upper_bound(rim.length.begin(), rim.length.end(), s) - rim.length.begin());
    return std::clamp<size_t>(i, 1, rim.length.size() - 1) - 1;
}

StonePlace rimPlace(const Rim& rim, glm::vec2 st, int widest) {
    StonePlace place;
    place.edge = kHalf - std::abs(st.y);
    for (float c : rim.corners) place.edge = std::min(place.edge, std::abs(st.x - c));
    float border = saturate((kHalf - std::abs(st.y)) / 0.12f);
    glm::vec2 q =
        st + glm::vec2(0.016f, 0.03f) * border * glm::vec2(fractal(st * 3.1f, 511, 2), fractal(st * 2.7f, 513, 2));
    q.x = glm::clamp(q.x, 0.0f, rim.length.back());
    size_t run = static_cast<size_t>(std::upper_bound(rim.breaks.begin(), rim.breaks.end(), q.x) - rim.breaks.begin());
    run = std::clamp<size_t>(run, 1, rim.breaks.size() - 1) - 1;
    uint32_t id = rim.ids[run];
    int pieces = 1 + static_cast<int>(id % static_cast<uint32_t>(widest));
    float shift = pieces > 1 ? (random01(id, 21) - 0.5f) * 0.22f : 0.0f;
    float low = -kHalf, high = kHalf;
    uint32_t piece = 0;
    float joint = 1;
    for (int k = 1; k < pieces; ++k) {
        float z = -kHalf + kThickness * static_cast<float>(k) / static_cast<float>(pieces) + shift;
        joint = std::min(joint, std::abs(q.y - z));
        if (q.y > z) {
            low = z;
            piece = static_cast<uint32_t>(k);
        } else {
            high = std::min(high, z);
        }
    }
    if (run > 0) joint = std::min(joint, q.x - rim.breaks[run]);
    if (run + 2 < rim.breaks.size()) joint = std::min(joint, rim.breaks[run + 1] - q.x);
    place.joint = std::max(joint, 0.0f);
    place.id = hash32(id, piece, 77);
    place.local = {q.x - (rim.breaks[run] + rim.breaks[run + 1]) * 0.5f, q.y - (low + high) * 0.5f};
    return place;
}

// block(along, y, t): t across the thickness, to the left of the line's direction seen from outside.
void addRim(std::vector<Chart>& charts, const char* name, Rim rim, int widest, float roughness,
            const std::function<glm::vec3(glm::vec2, float)>& block) {
    Chart chart;
    chart.name = name;
    auto normalAt = [&](size_t i) {
        glm::vec2 n = rim.normal[std::min(i, rim.normal.size() - 1)];
        if (i > 0 && i < rim.normal.size()) n = glm::normalize(n + rim.normal[i - 1]);
        return glm::normalize(block(n, 0) - block({0, 0}, 0));
    };
    gridChart(chart, static_cast<uint32_t>(rim.line.size()), kAcross + 1, [&](uint32_t c, uint32_t r) {
        return GridPoint{{rim.length[c], across(r)}, block(rim.line[c], across(r)), normalAt(c)};
    });
    chart.detail = [rim = std::move(rim), block, widest, roughness](glm::vec2 st) {
        size_t i = pieceAt(rim, st.x);
        float f = saturate((st.x - rim.length[i]) / (rim.length[i + 1] - rim.length[i]));
        glm::vec2 p = glm::mix(rim.line[i], rim.line[i + 1], f);
        StoneLook look;
        look.block = block(p, st.y);
        look.st = st;
        look.aboveGround = p.y;
        look.upward = std::max(rim.normal[i].y, 0.0f);
        look.roughness = roughness;
        look.belowCrest = roughness > 1 ? 0.3f : 3.0f;
        return stoneDetail(rimPlace(rim, st, widest), look);
    };
    charts.push_back(std::move(chart));
}

void addMainRims(std::vector<Chart>& charts, const Elevation& wall) {
    std::vector<glm::vec2> crest = wall.crestLine();
    // Two strips, so that neither is longer than the atlas.
    size_t cut = 0;
    while (crest[cut].x < 0.1f - 1e-4f) ++cut;
    auto block = [](glm::vec2 p, float t) { return glm::vec3(p.x, p.y, -t); };
    auto middle = crest.begin() + static_cast<long>(cut);
    addRim(charts, "main crest left", makeRim(wall, {crest.begin(), middle + 1}, false), 3, 2.3f, block);
    addRim(charts, "main crest right", makeRim(wall, {middle, crest.end()}, false), 3, 2.3f, block);
    addRim(charts, "soffit", makeRim(wall, wall.openingLine(), true), 2, 1,
           [](glm::vec2 p, float t) { return glm::vec3(p.x, p.y, t); });
}

Loop mirroredPair(const std::vector<float>& xs, bool withEnds) {
    Loop loop;  // back left to right, right end, front right to left, left end
    for (float x : xs) loop.push_back({x, -kHalf});
    for (uint32_t i = 1; i < kAcross; ++i) loop.push_back({xs.back(), across(i)});
    for (size_t i = xs.size(); i-- > 0;) loop.push_back({xs[i], kHalf});
    for (uint32_t i = kAcross - 1; withEnds && i > 0; --i) loop.push_back({xs.front(), across(i)});
    return loop;
}

void addEastWall(std::vector<Chart>& charts, std::vector<Loop>& footprints) {
    Elevation wall = eastWall();
    auto block = [](glm::vec2 p, float t) { return glm::vec3(kEastX + t, p.y, p.x); };
    addFace(charts, wall,
            {"east inner", wall.begin(), 1, {-1, 0, 0}, 4, true, [=](glm::vec2 p) { return block(p, -kHalf); }});
    addFace(charts, wall,
            {"east outer", wall.begin(), -1, {1, 0, 0}, 5, true, [=](glm::vec2 p) { return block(p, kHalf); }});
    addRim(charts, "east crest", makeRim(wall, wall.crestLine(), false), 3, 2.3f, block);
    std::vector<glm::vec2> end;
    for (float y : verticalSamples(wall.top(wall.begin()))) end.push_back({wall.begin(), y});
    addRim(charts, "east end", makeRim(wall, end, false), 2, 1.5f, block);
    Loop loop;
    for (glm::vec2 p : mirroredPair(wall.foot(wall.begin(), wall.end()), true)) loop.push_back({kEastX - p.y, p.x});
    footprints.push_back(std::move(loop));
}

}  // namespace

void addWalls(std::vector<Chart>& charts, std::vector<Loop>& footprints) {
    Elevation main = mainWall(), ret = returnWall();
    const Arch& arch = main.arch();
    addFace(charts, main,
            {"main front", kInnerX, 1, {0, 0, 1}, 0, false, [](glm::vec2 p) { return glm::vec3(p, kHalf); }});
    addFace(charts, main,
            {"main back", kMainBegin, -1, {0, 0, -1}, 1, true, [](glm::vec2 p) { return glm::vec3(p, -kHalf); }});
    addFace(charts, ret,
            {"return inner", kHalf, -1, {1, 0, 0}, 2, false, [](glm::vec2 p) { return glm::vec3(kInnerX, p.y, p.x); }});
    addFace(charts, ret, {"return outer", -kHalf, 1, {-1, 0, 0}, 3, true, [](glm::vec2 p) {
                              return glm::vec3(kMainBegin, p.y, p.x);
                          }});
    addMainRims(charts, main);
    std::vector<glm::vec2> crest = ret.crestLine();
    std::erase_if(crest, [](glm::vec2 p) { return p.x < kHalf - 1e-4f; });
    addRim(charts, "return crest", makeRim(ret, crest, false), 3, 2.3f,
           [](glm::vec2 p, float t) { return glm::vec3(kMainBegin + kHalf + t, p.y, p.x); });

    addEastWall(charts, footprints);
    footprints.push_back(mirroredPair(main.foot(arch.centre + arch.halfWidth, kMainEnd), true));
    Loop left;  // from the outer corner along the back to the arch, to the inner corner, round the return wall
    for (float x : main.foot(kMainBegin, arch.centre - arch.halfWidth)) left.push_back({x, -kHalf});
    for (uint32_t i = 1; i < kAcross; ++i) left.push_back({arch.centre - arch.halfWidth, across(i)});
    std::vector<float> front = main.foot(kInnerX, arch.centre - arch.halfWidth);
    for (size_t i = front.size(); i-- > 1;) left.push_back({front[i], kHalf});
    for (float z : ret.foot(kHalf, kReturnEnd)) left.push_back({kInnerX, z});
    for (uint32_t i = kAcross - 1; i > 0; --i) left.push_back({kMainBegin + kHalf + across(i), kReturnEnd});
    std::vector<float> outer = ret.foot(-kHalf, kReturnEnd);
    for (size_t i = outer.size(); i-- > 1;) left.push_back({kMainBegin, outer[i]});
    footprints.push_back(std::move(left));
}

}  // namespace espalier::content
