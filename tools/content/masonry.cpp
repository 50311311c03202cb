// Courses, joints and voussoirs of a wall in elevation. In: the wall's outline and an arch. Out: for any point the
// stone it is in and its distances to joints and edges; polylines of the outline; points along the joints.

#include "tools/content/masonry.hpp"

#include <algorithm>
#include <cmath>

#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

constexpr float kTallShare = 0.3f;                       // of the stones that could be as high as two courses
constexpr float kTallWidest = 0.5f, kTallClear = 0.21f;  // metres; and room beside them

// Joints wander by a centimetre or two; less towards outlines, where charts must agree.
glm::vec2 wander(glm::vec2 p, uint32_t salt) {
    return {0.016f * fractal(p * 3.1f, salt + 71, 2), 0.014f * fractal(p * 2.7f, salt + 72, 2)};
}

size_t courseOf(float y) {
    auto& h = Elevation::courseHeights();
    size_t c = 0;
    while (c + 2 < h.size() && y >= h[c + 1]) ++c;
    return c;
}

}  // namespace

const std::vector<float>& Elevation::courseHeights() {
    static const std::vector<float> kHeights{0,     0.34f, 0.62f, 0.87f, 1.15f, 1.38f, 1.66f, 1.90f, 2.15f,
                                             2.44f, 2.66f, 2.91f, 3.15f, 3.42f, 3.66f, 3.92f, 4.2f};
    return kHeights;
}

Elevation::Elevation(float begin, float end, std::vector<CrestStep> crest, Arch arch, uint32_t salt)
    : begin_(begin), end_(end), crest_(std::move(crest)), arch_(arch), salt_(salt) {
    tall_.resize(courseHeights().size() - 1);
    for (size_t c = 0; c + 1 < courseHeights().size(); ++c) layCourse(c);
    corners_.push_back({begin_, top(begin_)});
    for (size_t i = 1; i < crest_.size(); ++i) {
        corners_.push_back({crest_[i].from, courseHeights()[static_cast<size_t>(crest_[i - 1].courses)]});
        if (crest_[i].courses != crest_[i - 1].courses)
            corners_.push_back({crest_[i].from, courseHeights()[static_cast<size_t>(crest_[i].courses)]});
    }
    corners_.push_back({end_, top(end_)});
    corners_.push_back({end_, 0});
}

// Stones end where the crest steps down on them, and at the opening.
std::vector<float> Elevation::fixedJoints(size_t course) const {
    std::vector<float> fixed{begin_, end_};
    float middle = (courseHeights()[course] + courseHeights()[course + 1]) * 0.5f;
    for (size_t i = 1; i < crest_.size(); ++i) {
        auto [low, high] = std::minmax(crest_[i - 1].courses, crest_[i].courses);
        if (static_cast<int>(course) >= low && static_cast<int>(course) < high) fixed.push_back(crest_[i].from);
    }
    if (arch_.present() && middle < arch_.spring) {
        fixed.push_back(arch_.centre - arch_.halfWidth);
        fixed.push_back(arch_.centre + arch_.halfWidth);
    }
    return fixed;
}

// Some short stones of the course below are as high as two courses, away from the crest, the ends and the arch. Adds
// their ends to `fixed`.
void Elevation::growTall(size_t course, std::vector<float>& fixed) {
    const std::vector<float>& below = joints_[course - 1];
    for (size_t i = 1; i + 2 < below.size(); ++i) {
        const float a = below[i], b = below[i + 1];
        if (random01(hash32(salt_, static_cast<uint32_t>(course)), static_cast<uint32_t>(i), 31) > kTallShare) continue;
        if (b - a > kTallWidest || (course > 1 && isTall(course - 2, a))) continue;
        if (std::min(top(a - kTallClear), top(b + kTallClear)) < courseHeights()[course + 1] + 0.01f) continue;
        const float ring = arch_.halfWidth + arch_.ring + kTallClear;
        if (arch_.present() && a < arch_.centre + ring && b > arch_.centre - ring) continue;
        const auto close = [&](float x) { return x > a - kTallClear && x < b + kTallClear; };
        if (std::any_of(fixed.begin(), fixed.end(), close)) continue;
        fixed.insert(fixed.end(), {a, b});
        tall_[course - 1].push_back(a);
    }
}

bool Elevation::isTall(size_t course, float from) const {
    return std::find(tall_[course].begin(), tall_[course].end(), from) != tall_[course].end();
}

// Between fixed joints, stones are cut to lengths that avoid the joints of the course below.
void Elevation::layCourse(size_t course) {
    std::vector<float> fixed = fixedJoints(course);
    if (course > 0) growTall(course, fixed);
    std::sort(fixed.begin(), fixed.end());
    std::vector<float> joints;
    for (size_t k = 0; k + 1 < fixed.size(); ++k) {
        float a = fixed[k], b = fixed[k + 1];
        joints.push_back(a);
        if (course > 0 && isTall(course - 1, a)) continue;
        int count = std::max(
            1, static_cast<int>(std::lround((b - a) / (0.40f + 0.16f * random01(salt_, static_cast<uint32_t>(course),
                                                                                static_cast<uint32_t>(k))))));
        for (int i = 1; i < count; ++i) {
            float slack = (random01(hash32(salt_, static_cast<uint32_t>(course)), static_cast<uint32_t>(k),
                                    static_cast<uint32_t>(i)) -
                           0.5f) *
                          0.55f;
            float x = a + (b - a) * (static_cast<float>(i) + slack) / static_cast<float>(count);
            if (course > 0)
                for (float below : joints_[course - 1])
                    if (std::abs(x - below) < 0.09f) x = below + (x < below ? -0.09f : 0.09f);
            if (x > joints.back() + 0.16f && x < b - 0.16f) joints.push_back(x);
        }
    }
    joints.push_back(fixed.back());
    joints_.push_back(std::move(joints));
}

float Elevation::top(float along) const {
    int courses = crest_[0].courses;
    for (auto& s : crest_)
        if (along >= s.from) courses = s.courses;
    return courseHeights()[static_cast<size_t>(courses)];
}

float Elevation::belowCrest(glm::vec2 p) const {
    float sum = 0;
    for (int k = -4; k <= 4; ++k) sum += top(glm::clamp(p.x + 0.1f * static_cast<float>(k), begin_, end_));
    return std::max(sum / 9 - p.y, 0.0f);
}

bool Elevation::inRing(glm::vec2 p) const {
    if (!arch_.present() || p.y < arch_.spring) return false;
    return glm::distance(p, glm::vec2(arch_.centre, arch_.spring)) < arch_.halfWidth + arch_.ring;
}

float Elevation::crestDistance(glm::vec2 p) const {
    float d = 1;
    for (size_t i = 0; i + 1 < corners_.size(); ++i) d = std::min(d, segmentDistance(p, corners_[i], corners_[i + 1]));
    if (arch_.present()) {
        glm::vec2 c(arch_.centre, arch_.spring);
        float x = std::abs(p.x - arch_.centre);
        d = std::min(
            d, p.y < arch_.spring ? std::abs(x - arch_.halfWidth) : std::abs(glm::distance(p, c) - arch_.halfWidth));
    }
    return d;
}

StonePlace Elevation::placeAt(glm::vec2 p, uint32_t side) const {
    StonePlace place;
    place.edge = crestDistance(p);
    float border = std::min({place.edge, p.x - begin_, end_ - p.x, p.y});
    glm::vec2 q = p + wander(p, salt_) * saturate(border / 0.12f);
    uint32_t salt = hash32(salt_, side);
    glm::vec2 centre(arch_.centre, arch_.spring);
    float radius = glm::distance(q, centre), outer = arch_.halfWidth + arch_.ring;
    if (inRing(q)) {
        float angle = std::atan2(q.x - centre.x, q.y - centre.y), step = kPi / static_cast<float>(arch_.voussoirs);
        float k = std::floor((angle + kPi / 2) / step);
        float within = (angle + kPi / 2) - k * step;
        place.id = hash32(salt, 900u + static_cast<uint32_t>(std::max(k, 0.0f)));
        place.joint = std::min({within * radius, (step - within) * radius, outer - radius, q.y - arch_.spring});
        place.local = {(within - step / 2) * radius, radius - (arch_.halfWidth + arch_.ring / 2)};
        return place;
    }
    size_t course = courseOf(q.y);
    const auto stoneAt = [&](size_t in) {
        size_t i = 0;
        while (i + 2 < joints_[in].size() && q.x >= joints_[in][i + 1]) ++i;
        return i;
    };
    size_t above = course + 1;
    if (isTall(course, joints_[course][stoneAt(course)])) ++above;
    if (course > 0 && isTall(course - 1, joints_[course][stoneAt(course)])) --course;
    const size_t i = stoneAt(course);
    auto& joints = joints_[course];
    float y0 = courseHeights()[course], y1 = courseHeights()[above];
    // A joint needs a stone on its other side.
    float row = (y0 + y1) * 0.5f;
    auto solid = [&](float x) {
        return row < top(x) &&
               !(arch_.present() && y1 < arch_.spring + 0.01f && std::abs(x - arch_.centre) < arch_.halfWidth);
    };
    float d = 1;
    if (course > 0) d = std::min(d, q.y - y0);
    if (y1 < top(q.x) - 0.01f) d = std::min(d, y1 - q.y);
    if (i > 0 && solid(joints[i] - 0.01f)) d = std::min(d, q.x - joints[i]);
    if (i + 2 < joints.size() && solid(joints[i + 1] + 0.01f)) d = std::min(d, joints[i + 1] - q.x);
    if (arch_.present() && q.y >= arch_.spring) d = std::min(d, radius - outer);
    if (arch_.present() && q.y < arch_.spring && std::abs(q.x - arch_.centre) < outer)
        d = std::min(d, arch_.spring - q.y);
    place.joint = std::max(d, 0.0f);
    place.id = hash32(salt, static_cast<uint32_t>(course) * 131u + static_cast<uint32_t>(i));
    place.local = {q.x - (joints[i] + joints[i + 1]) / 2, q.y - (y0 + y1) / 2};
    return place;
}

std::vector<glm::vec2> Elevation::alongJoints(float offset) const {
    std::vector<glm::vec2> raw;
    auto both = [&](glm::vec2 p, glm::vec2 n) {
        raw.push_back(p + n * offset);
        if (offset > 0) raw.push_back(p - n * offset);
    };
    constexpr float kStep = 0.012f;
    for (size_t c = 0; c + 1 < courseHeights().size(); ++c) {
        float y0 = courseHeights()[c], y1 = courseHeights()[c + 1];
        for (float x : joints_[c])
            for (float y = y0; y < y1; y += kStep) both({x, y}, {1, 0});
        for (float x = begin_; c > 0 && x < end_; x += kStep) both({x, y0}, {0, 1});
    }
    if (arch_.present()) {
        glm::vec2 centre(arch_.centre, arch_.spring);
        float outer = arch_.halfWidth + arch_.ring;
        for (float a = 0; a < kPi; a += kStep / outer)
            both(centre + outer * glm::vec2(std::cos(a), std::sin(a)), {std::cos(a), std::sin(a)});
        for (int k = 0; k <= arch_.voussoirs; ++k) {
            float a = kPi * static_cast<float>(k) / static_cast<float>(arch_.voussoirs);
            glm::vec2 d(std::cos(a), std::sin(a));
            for (float r = arch_.halfWidth; r < outer; r += kStep) both(centre + d * r, {-d.y, d.x});
        }
    }
    std::vector<glm::vec2> out;
    for (glm::vec2 p : raw) {
        glm::vec2 q =
            p - wander(p, salt_) * saturate(std::min({crestDistance(p), p.x - begin_, end_ - p.x, p.y}) / 0.12f);
        float d = placeAt(q, 0).joint;
        if (std::abs(d - offset) < 0.006f) out.push_back(q);
    }
    return out;
}

std::vector<glm::vec2> Elevation::crestLine() const {
    std::vector<glm::vec2> line{corners_[0]};
    for (size_t i = 1; i < corners_.size(); ++i) {
        glm::vec2 a = corners_[i - 1], b = corners_[i];
        std::vector<glm::vec2> stops;  // joints that end on this piece of crest
        if (i == 1 && crest_[0].courses == crest_[1].courses) {
            // The first piece is where another wall joins: evenly split, as that wall's thickness is.
        } else if (a.y == b.y) {
            size_t course = courseOf(a.y - 0.01f);
            for (float x : joints_[course])
                if (x > a.x + 0.03f && x < b.x - 0.03f) stops.push_back({x, a.y});
        } else {
            for (float y : courseHeights())
                if (y > std::min(a.y, b.y) + 0.03f && y < std::max(a.y, b.y) - 0.03f) stops.push_back({a.x, y});
            if (b.y < a.y) std::reverse(stops.begin(), stops.end());
        }
        for (glm::vec2 s : stops) splitInto(line, s, kBorderEdge);
        splitInto(line, b, kBorderEdge);
    }
    return line;
}

std::vector<glm::vec2> Elevation::openingLine() const {
    std::vector<glm::vec2> line;
    if (!arch_.present()) return line;
    float left = arch_.centre - arch_.halfWidth, right = arch_.centre + arch_.halfWidth;
    std::vector<float> heights{0};
    for (float y : courseHeights())
        if (y > 0 && y < arch_.spring - 0.05f) heights.push_back(y);
    heights.push_back(arch_.spring);
    line.push_back({left, 0});
    for (size_t i = 1; i < heights.size(); ++i) splitInto(line, {left, heights[i]}, kBorderEdge);
    int pieces = arch_.voussoirs * 4;
    for (int k = 1; k < pieces; ++k) {
        float a = kPi * static_cast<float>(k) / static_cast<float>(pieces);
        line.push_back({arch_.centre - arch_.halfWidth * std::cos(a), arch_.spring + arch_.halfWidth * std::sin(a)});
    }
    line.push_back({right, arch_.spring});
    for (size_t i = heights.size() - 1; i-- > 0;) splitInto(line, {right, heights[i]}, kBorderEdge);
    return line;
}

std::vector<float> Elevation::foot(float a, float b) const {
    std::vector<glm::vec2> line{{a, 0}};
    for (float x : joints_[0])
        if (x > a + 0.03f && x < b - 0.03f) splitInto(line, {x, 0}, kBorderEdge);
    splitInto(line, {b, 0}, kBorderEdge);
    std::vector<float> out;
    for (glm::vec2 p : line) out.push_back(p.x);
    return out;
}

void splitInto(std::vector<glm::vec2>& line, glm::vec2 b, float longest) {
    glm::vec2 a = line.back();
    int pieces = std::max(1, static_cast<int>(std::ceil(glm::distance(a, b) / longest - 1e-4f)));
    for (int i = 1; i < pieces; ++i) line.push_back(glm::mix(a, b, static_cast<float>(i) / static_cast<float>(pieces)));
    line.push_back(b);
}

std::vector<float> verticalSamples(float top) {
    std::vector<glm::vec2> line{{0, 0}};
    for (float y : Elevation::courseHeights())
        if (y > 0 && y < top + 1e-4f) splitInto(line, {0, y}, kBorderEdge);
    std::vector<float> out;
    for (glm::vec2 p : line) out.push_back(p.y);
    return out;
}

}  // namespace espalier::content
