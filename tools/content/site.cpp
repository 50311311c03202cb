// The village around the ruin. In: outlines of houses. Out: a map of streets and trodden earth, and where trees,
// hedges, walls and tufts stand: some by hand, where a picture wants them, the rest strewn by rules.

#include "tools/content/site.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

using glm::vec2;
using Json = nlohmann::ordered_json;
constexpr float kPi = 3.14159265f;
constexpr float kLevel = -0.06f;  // of the meadow, as in sample.json
constexpr float kHalfMap = 104;   // metres
constexpr float kReach = 1;       // as kSiteReach of the shaders
const vec2 kCourt{0.35f, 1.7f}, kCourtHalf{5.2f, 4.0f};

struct Street {
    std::vector<vec2> points;
    float half;  // of its paved width
    bool closed = false;
};
// Around the village past the houses' fronts, ways out, and the path to the court's arch.
const Street kStreets[] = {
    {{{-31, 52},   {-27, 40}, {-34, 28}, {-37, 14},   {-40.5f, 0}, {-37, -13}, {-29, -21.5f}, {-16, -24},
      {-6, -27},   {3, -34},  {13, -35}, {24, -33},   {34, -29},   {44, -21},  {49, -9},      {43.5f, 3},
      {41.5f, 13}, {34, 22},  {27, 32},  {15, 38.5f}, {3, 45},     {-12, 47},  {-23, 52}},
     2.3f,
     true},
    {{{24, -33}, {25.5f, -48}, {20, -66}, {24, -90}, {20, -130}}, 2.0f},
    {{{-29, 51}, {-40, 66}, {-44, 90}, {-60, 130}}, 2.0f},
    {{{3, -34}, {-0.5f, -42}, {-0.8f, -49}}, 1.8f},
    {{{-6, -27}, {-7.5f, -20}, {-4.5f, -13}, {-0.2f, -8}, {0.6f, -3.2f}, {0.6f, -0.6f}}, 1.05f},
};
constexpr vec2 kSquare{-0.8f, -46.0f};  // before the school, with the well
constexpr float kSquareRadius = 4.8f;
constexpr float kPiece = 1.9f, kHalfGate = 0.75f;      // of a yard's fence
constexpr float kHalfPath = 0.62f, kLongestPath = 17;  // from a door to its street

float segmentDistance(vec2 p, vec2 a, vec2 b) {
    const vec2 d = b - a;
    return glm::distance(p, a + d * saturate(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-9f)));
}

// Metres from an outline's sides.
float outlineDistance(const Outline& o, vec2 p) {
    float d = 1e9f;
    for (size_t i = 0, j = o.size() - 1; i < o.size(); j = i++) d = std::min(d, segmentDistance(p, o[i], o[j]));
    return d;
}

// A Catmull-Rom curve through the points, in pieces of half a metre or so.
std::vector<vec2> curve(const Street& s) {
    std::vector<vec2> line;
    const int n = int(s.points.size()), spans = s.closed ? n : n - 1;
    const auto at = [&](int i) { return s.points[size_t(s.closed ? (i + n) % n : std::clamp(i, 0, n - 1))]; };
    for (int i = 0; i < spans; ++i) {
        const vec2 a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
        for (int k = 0; k < 12; ++k) {
            const float t = float(k) / 12;
            line.push_back(0.5f * (2.0f * b + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * t * t +
                                   (3.0f * b - a - 3.0f * c + d) * t * t * t));
        }
    }
    line.push_back(at(spans));
    return line;
}

struct Plan {
    std::vector<Outline> houses;
    std::vector<std::pair<std::vector<vec2>, float>> streets;  // line and half width
    std::vector<Door> fronts;                                  // doors that a path leads to

    // Metres into a street, negative beside it.
    float paved(vec2 p) const {
        float inside = kSquareRadius - glm::distance(p, kSquare);
        for (const auto& [line, half] : streets)
            for (size_t i = 0; i + 1 < line.size(); ++i)
                inside = std::max(inside, half - segmentDistance(p, line[i], line[i + 1]));
        return inside;
    }
    // Metres from the nearest house, negative within.
    float toHouse(vec2 p) const {
        float nearest = 1e9f;
        for (const Outline& o : houses) {
            bool inside = false;
            const float d = outlineDistance(o, p);
            for (size_t i = 0, j = o.size() - 1; i < o.size(); j = i++)
                if ((o[i].y > p.y) != (o[j].y > p.y) &&
                    p.x < (o[j].x - o[i].x) * (p.y - o[i].y) / (o[j].y - o[i].y) + o[i].x)
                    inside = !inside;
            nearest = std::min(nearest, inside ? -d : d);
        }
        return nearest;
    }
    vec2 nearestStreet(vec2 p) const {
        vec2 best(1e9f);
        for (const auto& [line, half] : streets)
            for (vec2 q : line)
                if (glm::distance(p, q) < glm::distance(p, best)) best = q;
        return best;
    }
    // From each door that faces a street near by, straight out and then over to it.
    void layPaths(const std::vector<Door>& doors) {
        std::vector<std::pair<std::vector<vec2>, float>> paths;
        for (const Door& door : doors) {
            const vec2 from = door.at + 0.8f * door.out, bend = door.at + 2.2f * door.out, to = nearestStreet(bend);
            if (glm::distance(bend, to) > kLongestPath || glm::dot(to - bend, door.out) < 0) continue;
            const std::vector<vec2> line = curve({{from, bend, glm::mix(bend, to, 0.6f) + 0.6f * door.out, to}, 0});
            if (std::any_of(line.begin(), line.end(), [&](vec2 p) { return toHouse(p) < 0.7f; })) continue;
            paths.emplace_back(line, kHalfPath);
            fronts.push_back(door);
        }
        streets.insert(streets.end(), paths.begin(), paths.end());
    }
    static float toCourt(vec2 p) {
        const vec2 d = glm::abs(p - kCourt) - kCourtHalf;
        return glm::length(glm::max(d, vec2(0))) + std::min(std::max(d.x, d.y), 0.0f);
    }
};

class Layout {
  public:
    Layout(const Plan& plan, Site& site) : plan_(plan), site_(site) {}

    void lay() {
        feature();
        yards();
        gardens();
        trees();
        beds();
        daisies();
        shrubs();
        tufts();
    }

  private:
    void put(const std::string& model, vec2 at, float degrees, float scale, float sink = 0) {
        site_.props[model].push_back({{at.x, kLevel - sink, at.y}, degrees, scale});
    }
    bool clear(vec2 p, float radius, float fromHouse) const {
        if (plan_.paved(p) > -radius || plan_.toHouse(p) < fromHouse || Plan::toCourt(p) < radius + 0.5f) return false;
        return std::all_of(taken_.begin(), taken_.end(),
                           [&](glm::vec3 t) { return glm::distance(p, vec2(t)) > radius + t.z; });
    }
    void tree(const std::string& model, vec2 at, float scale, float radius, uint32_t turn) {
        put(model, at, 360 * random01(turn, 19), scale, 0.05f);
        taken_.push_back({at, radius});
        shades_.push_back({at, radius});
    }

    // What the sample's pictures are composed with.
    void feature() {
        tree("lime_b", {-13.5f, -9.5f}, 0.92f, 3.0f, 1);
        tree("lime_a", {12.5f, -14.0f}, 0.95f, 2.6f, 2);
        tree("birch_a", {9.4f, -5.2f}, 0.86f, 1.2f, 3);
        tree("birch_a", {11.2f, -3.8f}, 0.70f, 1.0f, 4);
        tree("apple_a", {-12.0f, 6.5f}, 1.0f, 1.6f, 5);
        tree("apple_b", {-16.5f, 12.5f}, 1.0f, 1.7f, 6);
        tree("apple_a", {-19.5f, 5.0f}, 0.9f, 1.6f, 7);
        tree("lime_a", {15.5f, 12.5f}, 0.85f, 2.6f, 8);
        for (vec2 p : {vec2(-6.6f, -1.9f), vec2(7.1f, -1.3f), vec2(-8.4f, -3.9f), vec2(6.9f, 6.6f)})
            put(p.x < 0 ? "bush_a" : "bush_b", p, 40 * p.x, 0.85f + 0.03f * std::abs(p.y), 0.05f);
        put("bush_b", {-5.9f, -2.9f}, 70, 0.8f, 0.05f);
        put("bush_b", {-7.6f, -0.7f}, 10, 0.7f, 0.05f);
        put("rubble", {6.9f, 0.4f}, 20, 1, 0.03f);
        put("rubble", {-5.4f, 5.9f}, 130, 0.8f, 0.04f);
        put("bench", {-3.1f, -8.3f}, 62, 1);
        put("bench", {-5.3f, -31.0f}, 29, 1);
        put("well", kSquare + vec2(0.2f, 0.4f), 25, 1);
        taken_.push_back({kSquare, 2});
    }

    // A row of pieces of two metres along a line; a piece is left out for each gate.
    void row(const std::string& piece, vec2 a, vec2 b, int gate = -1) {
        const float length = glm::distance(a, b);
        const int count = std::max(1, int(std::round(length / 2)));
        const float degrees = -std::atan2(b.y - a.y, b.x - a.x) * 180 / kPi, scale = length / (2 * float(count));
        for (int i = 0; i < count; ++i) {
            const vec2 at = glm::mix(a, b, (float(i) + 0.5f) / float(count));
            if (i == gate || plan_.paved(at) > -0.3f || plan_.toHouse(at) < 0.25f) continue;
            put(piece, at, degrees, scale, 0);
            taken_.push_back({at, 1.0f});
        }
        if (piece == "wall")
            for (vec2 end : {a, b})
                if (plan_.paved(end) < -0.3f && plan_.toHouse(end) > 0.3f) put("pier", end, degrees, 1);
    }
    // A yard before each door that a path leads to: fenced towards the street on both sides of the gate and back to the
    // wall, in pieces of one length.
    void yards() {
        const char* kinds[] = {"hedge", "fence", "wall"};
        for (uint32_t i = 0; i < plan_.fronts.size(); ++i) {
            const Door& door = plan_.fronts[i];
            const Outline& o =
                *std::min_element(plan_.houses.begin(), plan_.houses.end(), [&](const Outline& a, const Outline& b) {
                    return outlineDistance(a, door.at) < outlineDistance(b, door.at);
                });
            const char* kind = kinds[uint32_t(&o - plan_.houses.data()) % 3];
            int deep = 2;
            while (deep > 0 && plan_.paved(door.at + (kPiece * float(deep) + 0.4f) * door.out +
                                           1.6f * glm::vec2(-door.out.y, door.out.x)) > 0)
                --deep;
            if (deep == 0) continue;
            // To the wall's corners, or as far as there's room before the street.
            const float out = kPiece * float(deep);
            const auto end = [&](vec2 along, int pieces) {
                return door.at + out * door.out + (kHalfGate + kPiece * float(pieces)) * along;
            };
            const vec2 ways[2] = {{-door.out.y, door.out.x}, {door.out.y, -door.out.x}};
            int pieces[2];
            for (int k = 0; k < 2; ++k) {
                float reach = 0;
                for (vec2 corner : o)
                    if (std::abs(glm::dot(corner - door.at, door.out)) < 0.2f)
                        reach = std::max(reach, glm::dot(corner - door.at, ways[k]));
                pieces[k] = int((reach - kHalfGate - 0.2f) / kPiece);
                while (pieces[k] > 0 && plan_.paved(end(ways[k], pieces[k])) > -0.4f) --pieces[k];
            }
            if (std::min(pieces[0], pieces[1]) < 1) continue;
            for (int k = 0; k < 2; ++k) {
                const vec2 corner = end(ways[k], pieces[k]);
                row(kind, end(ways[k], 0), corner);
                row(kind, corner, corner - out * door.out);
            }
        }
    }
    // Each house has a garden at the side away from the street, fenced in one of three ways.
    void gardens() {
        const char* kinds[] = {"fence", "wall", "hedge"};
        for (size_t h = 0; h < plan_.houses.size(); ++h) {
            const Outline& o = plan_.houses[h];
            // The widest side whose middle lies farthest from streets.
            float best = 1e9f;
            size_t side = 0;
            for (size_t i = 0; i < o.size(); ++i) {
                const vec2 a = o[i], b = o[(i + 1) % o.size()];
                if (glm::distance(a, b) < 5) continue;
                const float score = plan_.paved(0.5f * (a + b)) - 0.2f * glm::distance(a, b);
                if (score < best) best = score, side = i;
            }
            const vec2 a = o[side], b = o[(side + 1) % o.size()], along = glm::normalize(b - a);
            vec2 out(along.y, -along.x);
            if (plan_.toHouse(0.5f * (a + b) + 0.5f * out) < 0) out = -out;
            const float deep = 7 + 3 * random01(uint32_t(h), 31);
            const vec2 a1 = a - along * 1.5f, b1 = b + along * 1.5f, c = b1 + out * deep, d = a1 + out * deep;
            const char* kind = kinds[h % 3];
            row(kind, b1, c, 1);
            row(kind, c, d);
            row(kind, d, a1);
            for (uint32_t i = 0; i < 3; ++i) {
                const vec2 p =
                    glm::mix(glm::mix(a1, b1, random01(uint32_t(h), i, 32)),
                             glm::mix(d, c, random01(uint32_t(h), i, 32)), 0.35f + 0.4f * random01(uint32_t(h), i, 33));
                if (clear(p, 1.8f, 2.6f))
                    tree(i % 2 ? "apple_a" : "apple_b", p, 0.8f + 0.35f * random01(uint32_t(h), i, 34), 1.9f,
                         uint32_t(h) * 8 + i);
            }
        }
    }
    void trees() {
        // Along streets, in groups between the houses and, ever denser, behind them, so that the village lies among
        // trees.
        for (uint32_t i = 0; i < 3200; ++i) {
            const float angle = 2 * kPi * random01(i, 41), r = 16 + 84 * std::pow(random01(i, 42), 0.7f);
            const vec2 p(r * std::cos(angle), r * std::sin(angle));
            const float grove = noise(p / 17.0f, 43), chance = r < 34 ? 0.02f : r < 62 ? 0.06f : 0.30f;
            if (random01(i, 44) > chance + 0.34f * std::max(grove, 0.0f) * ramp(26, 60, r)) continue;
            const bool tall = random01(i, 45) < 0.55f;
            if (!clear(p, tall ? 3.2f : 2.0f, tall ? 4.5f : 3.0f)) continue;
            const float pick = random01(i, 46);
            const char* model = !tall          ? (pick < 0.5f ? "apple_a" : "birch_a")
                                : pick < 0.4f  ? "lime_a"
                                : pick < 0.75f ? "lime_b"
                                               : "birch_a";
            tree(model, p, 0.8f + 0.5f * random01(i, 47), tall ? 3.2f : 1.6f, i + 500);
        }
    }
    // Beds along a house's walls, between its corners and what may be a door: flowers of one kind, a bush at the
    // corner.
    void beds() {
        const char* kinds[] = {"flowers_b", "flowers_a", "flowers_c"};
        for (uint32_t h = 0; h < plan_.houses.size(); ++h) {
            const Outline& o = plan_.houses[h];
            for (uint32_t side = 0; side < o.size(); ++side) {
                const auto random = [&](uint32_t i, uint32_t which) { return random01(h * 16 + side, i, which); };
                const vec2 a = o[side], b = o[(side + 1) % o.size()], along = glm::normalize(b - a);
                const float bed = 0.5f * glm::distance(a, b) - 1.6f;
                vec2 out(along.y, -along.x);
                if (plan_.toHouse(0.5f * (a + b) + 0.5f * out) < 0) out = -out;
                for (uint32_t end : {0u, 1u}) {
                    if (bed < 0.8f || random(end, 81) < 0.35f) continue;
                    const vec2 from = end ? b : a, way = end ? -along : along;
                    const vec2 corner = from + 0.7f * way + 0.75f * out;
                    if (random(end, 82) < 0.6f && clear(corner, 0.6f, 0.5f))
                        put("bush_b", corner, 360 * random(end, 83), 0.55f + 0.3f * random(end, 84), 0.04f);
                    for (float x = 1.4f; x < bed; x += 0.38f) {
                        const uint32_t i = uint32_t(x * 100) * 2 + end;
                        const vec2 p = from + (x + 0.2f * random(i, 85)) * way + (0.36f + 0.25f * random(i, 86)) * out;
                        if (random(i, 87) < 0.8f && clear(p, 0.15f, 0.25f))
                            put(kinds[h % 3], p, 360 * random(i, 88), 0.8f + 0.5f * random(i, 89), 0.02f);
                    }
                }
            }
        }
    }
    // In the meadow about the court.
    void daisies() {
        for (uint32_t i = 0; i < 1500; ++i) {
            const float angle = 2 * kPi * random01(i, 91), r = 18 * std::sqrt(random01(i, 92));
            const vec2 p = kCourt + r * vec2(std::cos(angle), std::sin(angle));
            if (noise(p / 2.1f, 93) + 0.4f * noise(p / 0.6f, 94) > 0.38f && clear(p, 0.2f, 0.5f))
                put("flowers_a", p, 360 * random01(i, 95), 0.4f + 0.3f * random01(i, 96), 0.02f);
        }
    }
    void shrubs() {
        for (uint32_t i = 0; i < 2600; ++i) {
            const vec2 p = kHalfMap * 0.9f * (2.0f * vec2(random01(i, 51), random01(i, 52)) - 1.0f);
            const float house = plan_.toHouse(p), grove = noise(p / 9.0f, 53);
            // At the feet of walls, and in groves.
            const float chance = house > 0.5f && house < 1.6f           ? 0.55f
                                 : glm::length(p) > 22 && grove > 0.45f ? 0.10f
                                                                        : 0.0f;
            if (random01(i, 54) > chance || !clear(p, 0.9f, 0.5f)) continue;
            put(random01(i, 55) < 0.5f ? "bush_a" : "bush_b", p, 360 * random01(i, 56), 0.6f + 0.6f * random01(i, 57),
                0.05f);
            taken_.push_back({p, 0.7f});
        }
    }
    // Grass stands higher where nobody mows or treads: at feet of walls and stones, along kerbs, around the court.
    void tufts() {
        uint32_t index = 0;
        const auto tuft = [&](vec2 p, float most) {
            const uint32_t i = ++index;
            if (plan_.paved(p) > -0.12f || plan_.toHouse(p) < 0.1f || Plan::toCourt(p) < 0.15f) return;
            const float pick = random01(i, 61);
            put(pick < 0.4f    ? "tuft_a"
                : pick < 0.62f ? "tuft_b"
                               : "tuft_c",
                p, 360 * random01(i, 62), most * (0.7f + 0.6f * random01(i, 63)));
        };
        for (uint32_t i = 0; i < 24000; ++i) {
            const float angle = 2 * kPi * random01(i, 64), r = 22 * std::sqrt(random01(i, 65));
            const vec2 p = kCourt + r * vec2(std::cos(angle), std::sin(angle));
            const float rank =
                noise(p / 1.7f, 66) + 0.5f * noise(p / 5.0f, 67) + 0.9f * ramp(1.8f, 0.3f, Plan::toCourt(p));
            if (rank > 0.06f) tuft(p, 0.75f + 0.4f * saturate(rank - 0.3f));
        }
        const std::map<std::string, std::vector<SitePlace>> built = site_.props;
        for (const char* foot : {"wall", "pier", "fence", "rubble", "bench"}) {
            const auto found = built.find(foot);
            if (found == built.end()) continue;
            for (const SitePlace& place : found->second)
                for (uint32_t i = 0; i < 5; ++i) {
                    const float turn = place.degrees * kPi / 180, x = 2 * random01(index, i, 68) - 1,
                                side = (random01(index, i, 69) < 0.5f ? -1.0f : 1.0f) * 0.34f;
                    tuft(vec2(place.position.x, place.position.z) + x * vec2(std::cos(turn), -std::sin(turn)) +
                             side * vec2(std::sin(turn), std::cos(turn)),
                         1.0f);
                }
        }
    }

  public:
    std::vector<glm::vec3> shades_;  // of crowns: x, z, radius

  private:
    const Plan& plan_;
    Site& site_;
    std::vector<glm::vec3> taken_;  // circles: x, z, radius
};

void paintMap(const Plan& plan, const std::vector<glm::vec3>& shades, Site& site) {
    for (int y = 0; y < site.map.height; ++y)
        for (int x = 0; x < site.map.width; ++x) {
            const vec2 p = glm::mix(site.low, site.high, (vec2(x, y) + 0.5f) / vec2(site.map.width, site.map.height));
            const float paved = plan.paved(p), house = plan.toHouse(p), court = Plan::toCourt(p);
            // The court's own paving goes on where the path comes to it.
            const float uneven = noise(p / 1.3f, 71) + 0.6f * noise(p / 0.5f, 72);
            float earth = 0.62f * ramp(-0.55f - 0.4f * uneven, -0.05f, paved);        // beside kerbs
            earth = std::max(earth, 0.7f * ramp(1.1f + 0.6f * uneven, 0.2f, house));  // around houses
            earth = std::max(earth, 0.16f * ramp(0.9f + uneven, 0.0f, court));
            float open = 1 - 0.55f * std::exp(-std::max(house, 0.0f) / 0.9f);
            for (glm::vec3 s : shades) {
                const float d = glm::distance(p, vec2(s)) / s.z;
                if (d < 1.5f) open *= 1 - 0.42f * ramp(1.4f, 0.1f, d);
                earth = std::max(earth, 0.7f * ramp(0.34f, 0.10f, d));
            }
            uint8_t* texel = site.map.at(x, y);
            const float rgb[3] = {0.5f + paved / (2 * kReach), earth, open};
            for (int k = 0; k < 3; ++k) texel[k] = uint8_t(saturate(rgb[k]) * 255 + 0.5f);
            texel[3] = 255;
        }
}

}  // namespace

Result<std::vector<Outline>> readOutlines(const std::string& path) {
    Result<std::vector<std::byte>> bytes = readFile(path);
    if (!bytes) return bytes.failure();
    const auto* text = reinterpret_cast<const char*>(bytes->data());
    const Json json = Json::parse(text, text + bytes->size(), nullptr, false);
    std::vector<Outline> outlines;
    try {
        for (const Json& building : json.at("buildings")) {
            Outline& outline = outlines.emplace_back();
            for (const Json& corner : building.at("outer"))
                outline.push_back({corner.at(0).get<float>(), -corner.at(1).get<float>()});
        }
    } catch (const Json::exception& mistake) {
        return Failure(path, std::string("isn't a town: ") + mistake.what());
    }
    return outlines;
}

Site makeSite(const std::vector<Outline>& houses, const std::vector<Door>& doors, int mapSize) {
    Site site;
    site.low = vec2(-kHalfMap);
    site.high = vec2(kHalfMap);
    site.map = Picture(mapSize, mapSize);
    Plan plan{houses, {}, {}};
    for (const Street& s : kStreets) plan.streets.emplace_back(curve(s), s.half);
    plan.layPaths(doors);
    Layout layout(plan, site);
    layout.lay();
    paintMap(plan, layout.shades_, site);
    return site;
}

std::string siteJson(const Site& site) {
    const auto rounded = [](float x) { return std::round(double(x) * 1000) / 1000; };
    Json json = {
        {"models", "props.glb"},
        {"ground", {{"map", "site.png"}, {"low", {site.low.x, site.low.y}}, {"high", {site.high.x, site.high.y}}}}};
    for (const auto& [model, places] : site.props)
        for (const SitePlace& p : places)
            json["props"][model].push_back({rounded(p.position.x), rounded(p.position.y), rounded(p.position.z),
                                            rounded(p.degrees), rounded(p.scale)});
    return json.dump() + "\n";
}

}  // namespace espalier::content
