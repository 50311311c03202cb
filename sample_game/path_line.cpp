// A line over surfaces -> strokes that paint its direction, one for each straight part, and a seed.
#include "sample_game/path_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace sample {
namespace {

using namespace espalier::document;

constexpr float kRadius = .14f;                  // metres on either side of the line, times the grammar's scale
constexpr float kSpacing = .3f;                  // of the radius, between two dabs
constexpr float kStraight = .35f;                // of the radius, that a part of the line may leave a straight one
constexpr float kMiddle = .503f, kHalf = .497f;  // a direction as a colour: its parts are kHalf to either side
constexpr float kWandering = 1.15f;              // stems are that much longer than the line

constexpr float kErases = 1.2f;  // of the radius, around a line that goes
constexpr float kPlaces = .5f;   // of the radius, between two places of a line
constexpr size_t kMostLinePlaces = 4000;

float paramOf(const Workspace& work, uint32_t grammar, const char* name, float otherwise) {
    const EspGrammar id = work.scene().grammars[grammar].id;
    for (uint32_t i = 0; i < espParamCount(work.context.get(), id); ++i)
        if (EspParamInfo info;
            espParamInfo(work.context.get(), id, i, &info) == ESP_OK && !std::strcmp(info.name, name))
            return info.value[0];
    return otherwise;
}

float distanceToSegment(glm::vec3 p, glm::vec3 a, glm::vec3 b) {
    const glm::vec3 ab = b - a;
    const float t = glm::clamp(glm::dot(p - a, ab) / std::max(glm::dot(ab, ab), 1e-12f), 0.f, 1.f);
    return glm::distance(p, a + t * ab);
}

// The places of `line` where straight parts begin or end: Douglas and Peucker's.
void addCorners(const std::vector<EspHit>& line, size_t from, size_t to, float tolerance, std::vector<size_t>& out) {
    size_t farthest = from;
    float most = tolerance;
    for (size_t i = from + 1; i < to; ++i)
        if (const float d = distanceToSegment(vec(line[i].position), vec(line[from].position), vec(line[to].position));
            d > most)
            most = d, farthest = i;
    if (farthest != from) {
        addCorners(line, from, farthest, tolerance, out);
        addCorners(line, farthest, to, tolerance, out);
        return;
    }
    out.push_back(to);
}

// A dab for each place, and between places that lie far apart.
StrokeDabs dabsOf(const std::vector<EspHit>& line, size_t from, size_t to, float step) {
    StrokeDabs dabs;
    for (size_t i = from; i < to; ++i) {
        const glm::vec3 a = vec(line[i].position), b = vec(line[i + 1].position);
        const glm::vec3 n = vec(line[i].normal), m = vec(line[i + 1].normal);
        const int parts = std::max(1, int(std::ceil(glm::distance(a, b) / step)));
        for (int k = i == from ? 0 : 1; k <= parts; ++k) {
            const float t = float(k) / float(parts);
            const glm::vec3 at = glm::mix(a, b, t), up = t < .5f ? n : m;
            dabs.dabs.push_back({at.x, at.y, at.z, up.x, up.y, up.z, 1});
        }
    }
    return dabs;
}

// direction: zero erases.
bool paint(Workspace& work, const StrokeDabs& dabs, glm::vec3 direction, float radius, uint32_t gesture) {
    StrokeBegin stroke;
    stroke.layer = kLeadingLayer;
    stroke.mode = direction == glm::vec3(0) ? "erase" : "paint";
    stroke.radius = radius;
    stroke.strength = 1;
    stroke.hardness = .5f;
    for (int i = 0; i < 3; ++i) stroke.colour.push_back(kMiddle + kHalf * direction[i]);
    if (!work.perform(stroke, gesture)) return false;
    const bool laid = work.perform(dabs, gesture);
    return work.perform(StrokeEnd{}, gesture) && laid;
}

// In a scene that has none: one of the size of the plants that are there.
std::optional<uint32_t> addLeadingGrammar(Workspace& work, uint32_t gesture) {
    std::optional<float> scale;
    for (uint32_t i = 0; i < work.scene().grammars.size() && !scale; ++i)
        if (const float found = paramOf(work, i, "scale", 0); found > 0) scale = found;
    if (!work.perform(AddGrammar{espalier::scene::contentFolder() + "/grammars/ivy_path.grammar"}, gesture))
        return std::nullopt;
    const uint32_t grammar = uint32_t(work.scene().grammars.size() - 1);
    if (scale) work.perform(SetParam{grammar, {"scale", {*scale}}}, gesture);
    return grammar;
}

float radiusOf(const Workspace& work, uint32_t grammar) {
    return kRadius * paramOf(work, grammar, "scale", 1);
}

float lengthOf(const std::vector<EspHit>& line) {
    float length = 0;
    for (size_t i = 1; i < line.size(); ++i) length += glm::distance(vec(line[i - 1].position), vec(line[i].position));
    return length;
}

// Paints the directions of a line's straight parts; tells where these begin and end.
bool lay(Workspace& work, const std::vector<EspHit>& line, float radius, uint32_t gesture,
         std::vector<size_t>& corners) {
    corners = {0};
    addCorners(line, 0, line.size() - 1, kStraight * radius, corners);
    for (size_t i = 0; i + 1 < corners.size(); ++i) {
        const glm::vec3 way = vec(line[corners[i + 1]].position) - vec(line[corners[i]].position);
        if (glm::length(way) == 0) continue;
        if (!paint(work, dabsOf(line, corners[i], corners[i + 1], kSpacing * radius), glm::normalize(way), radius,
                   gesture))
            return false;
    }
    return true;
}

// The way from its first corner to the next.
glm::vec3 beginningOf(const std::vector<EspHit>& line, const std::vector<size_t>& corners) {
    for (size_t i = 0; i + 1 < corners.size(); ++i)
        if (const glm::vec3 way = vec(line[corners[i + 1]].position) - vec(line[corners[i]].position);
            glm::length(way) > 0)
            return glm::normalize(way);
    return glm::vec3(0);
}

// All of it or nothing.
void giveUp(Workspace& work, uint32_t gesture) {
    const std::string why = work.error;
    work.takeBack(gesture);
    work.error = why;
}

struct LineBox {
    glm::vec3 low{1e30f}, high{-1e30f};
    void add(const std::vector<LinePoint>& points, float reach) {
        for (const LinePoint& p : points) {
            low = glm::min(low, glm::vec3(p[0], p[1], p[2]) - reach);
            high = glm::max(high, glm::vec3(p[0], p[1], p[2]) + reach);
        }
    }
    bool meets(const LineBox& other) const {
        return glm::all(glm::lessThanEqual(low, other.high)) && glm::all(glm::lessThanEqual(other.low, high));
    }
};

// The line goes from the layer; of others that are near, what went with it is painted again, in the order in which they
// were drawn, and so is the line by its new points.
bool repaint(Workspace& work, const SeedRecord& seed, const std::vector<LinePoint>& points, uint32_t gesture) {
    const float radius = radiusOf(work, seed.grammar);
    const std::vector<EspHit> before = placesOf(work, seed.line);
    if (before.size() > 1 &&
        !paint(work, dabsOf(before, 0, before.size() - 1, kSpacing * radius), glm::vec3(0), kErases * radius, gesture))
        return false;
    LineBox changed;
    changed.add(seed.line, 2 * radius);
    changed.add(points, 2 * radius);
    const std::vector<espalier::scene::Seed> all = work.scene().seeds;
    for (const espalier::scene::Seed& other : all) {
        const std::vector<LinePoint>& line = other.key == seed.key ? points : other.line;
        LineBox box;
        box.add(line, 2 * radiusOf(work, other.grammar));
        if (line.size() < 2 || !box.meets(changed)) continue;
        const std::vector<EspHit> places = placesOf(work, line);
        std::vector<size_t> corners;
        if (places.size() > 1 && !lay(work, places, radiusOf(work, other.grammar), gesture, corners)) return false;
    }
    return true;
}

}  // namespace

std::optional<uint32_t> leadingGrammar(const Workspace& work) {
    const auto leads = [&](uint32_t grammar) {
        const EspGrammar id = work.scene().grammars[grammar].id;
        for (uint32_t i = 0; i < espLayerCount(work.context.get(), id); ++i)
            if (std::string(espLayerName(work.context.get(), id, i)).starts_with(std::string(kLeadingLayer) + "."))
                return true;
        return false;
    };
    const uint32_t count = uint32_t(work.scene().grammars.size());
    if (work.plantGrammar < count && leads(work.plantGrammar)) return work.plantGrammar;
    for (uint32_t i = 0; i < count; ++i)
        if (leads(i)) return i;
    return std::nullopt;
}

std::vector<EspHit> placesOf(const Workspace& work, const std::vector<LinePoint>& points) {
    std::vector<EspHit> places;
    if (points.size() < 2) return places;
    const auto at = [&](size_t i) { return glm::vec3(points[i][0], points[i][1], points[i][2]); };
    float length = 0;
    for (size_t i = 1; i < points.size(); ++i) length += glm::distance(at(i - 1), at(i));
    const auto grammar = leadingGrammar(work);
    const float step = std::max(kPlaces * radiusOf(work, grammar.value_or(0)), length / float(kMostLinePlaces));
    for (size_t i = 0; i + 1 < points.size(); ++i) {
        const int parts = std::max(1, int(std::ceil(glm::distance(at(i), at(i + 1)) / std::max(step, 1e-6f))));
        for (int k = i == 0 ? 0 : 1; k <= parts; ++k) {
            const glm::vec3 point = glm::mix(at(i), at(i + 1), float(k) / float(parts));
            if (EspHit hit; espNearest(work.context.get(), &point.x, &hit) == ESP_OK) places.push_back(hit);
        }
    }
    return places;
}

void growAlong(Workspace& work, const std::vector<EspHit>& line) {
    const float length = lengthOf(line);
    const uint32_t gesture = work.newGesture();
    auto grammar = leadingGrammar(work);
    if (length == 0) return work.say("Drag: ivy follows the line that you draw");
    if (!grammar && !(grammar = addLeadingGrammar(work, gesture))) return;
    const float scale = paramOf(work, *grammar, "scale", 1);
    std::vector<size_t> corners;
    const bool good = lay(work, line, kRadius * scale, gesture, corners);
    SeedRecord seed{work.document->freshKey(),
                    *grammar,
                    array(vec(line.front().position)),
                    array(beginningOf(line, corners)),
                    std::random_device()(),
                    {{"reach", {kWandering * length / scale}}}};
    for (size_t corner : corners) {
        const EspHit& hit = line[corner];
        seed.line.push_back(
            {hit.position[0], hit.position[1], hit.position[2], hit.normal[0], hit.normal[1], hit.normal[2]});
    }
    if (!good || !work.perform(AddSeeds{{seed}, {uint32_t(work.scene().seeds.size())}}, gesture))
        return giveUp(work, gesture);
    work.selected = {seed.key};
    work.document->callStep(gesture, "Ivy along a line");
    work.plantGrammar = *grammar;
}

void relay(Workspace& work, uint32_t key, const std::vector<LinePoint>& points) {
    const espalier::scene::Seed* known = work.document->seed(key);
    if (!known || points.size() == 1) return;
    SeedRecord seed = work.document->recordOf(*known);
    const uint32_t gesture = work.newGesture();
    bool good = repaint(work, seed, points, gesture);
    if (points.empty()) {
        good = good && work.perform(RemoveSeeds{{key}}, gesture);
    } else if (const std::vector<EspHit> places = placesOf(work, points); good && places.size() > 1) {
        const float scale = paramOf(work, seed.grammar, "scale", 1);
        std::vector<size_t> corners{0};
        addCorners(places, 0, places.size() - 1, kStraight * kRadius * scale, corners);
        seed.line = points;
        // Not the place that was found for it, which may be rounded otherwise: the plant stays where its foot does.
        seed.position = {points.front()[0], points.front()[1], points.front()[2]};
        seed.direction = array(beginningOf(places, corners));
        for (Param& param : seed.params)
            if (param.name == "reach") param.value = {kWandering * lengthOf(places) / scale};
        good = work.perform(ChangeSeeds{{seed}}, gesture);
    }
    if (!good) return giveUp(work, gesture);
    work.document->callStep(gesture, points.empty() ? "Remove a line" : "Edit a line");
}

}  // namespace sample
