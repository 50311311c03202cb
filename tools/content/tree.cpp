// Trees and bushes. In: how a species stands. Out: trunk and boughs as tubes, twigs as cards that lie about the lobes
// of its crown; a level's cards stand for those of the finest one that lie near each other, so that a crown keeps its
// outline and its gaps.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "tools/content/card.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/props.hpp"

namespace espalier::content {
namespace {

struct Habit {
    const char* name;
    int row;  // of the atlas
    uint32_t salt;
    float crownFoot, crownTop;  // metres
    float radius;               // of the crown where it is widest
    float widest;               // 0 to 1, from its foot
    float hollow;               // share of a lobe's radius without twigs
    int lobes;
    int cards[kPlantLods];
    float side;   // of a card of the finest level, metres
    float trunk;  // radius at the foot; 0: boughs from the ground
    int boughs;
    bool birch;
};
constexpr int kAppleRow = 1;
const Habit kHabits[] = {
    {"lime_a", 0, 21, 1.9f, 9.6f, 3.5f, 0.42f, 0.45f, 13, {500, 150, 44}, 0.96f, 0.30f, 9, false},
    {"lime_b", 0, 22, 2.2f, 11.2f, 3.9f, 0.40f, 0.45f, 15, {560, 165, 46}, 1.03f, 0.36f, 10, false},
    {"apple_a", 1, 23, 1.3f, 4.3f, 2.1f, 0.45f, 0.35f, 8, {270, 86, 26}, 0.74f, 0.14f, 7, false},
    {"apple_b", 1, 24, 1.2f, 4.9f, 2.4f, 0.50f, 0.35f, 9, {290, 92, 28}, 0.78f, 0.15f, 7, false},
    {"birch_a", 2, 25, 1.9f, 9.2f, 2.65f, 0.40f, 0.30f, 14, {350, 104, 30}, 0.68f, 0.13f, 7, true},
    {"bush_a", 3, 26, 0.0f, 1.5f, 1.05f, 0.45f, 0.30f, 6, {150, 48, 16}, 0.54f, 0.0f, 0, false},
    {"bush_b", 3, 27, 0.0f, 1.0f, 0.85f, 0.50f, 0.30f, 5, {125, 42, 14}, 0.47f, 0.0f, 0, false},
};

float crownRadius(const Habit& h, float t) {
    const float u = t < h.widest ? t / h.widest : (1 - t) / (1 - h.widest);
    return h.radius * std::sqrt(std::max(u * (2 - u), 0.0f));
}

void addTube(Mesh& mesh, const std::vector<glm::vec3>& line, float r0, float r1, int sides, float u0, float open) {
    const uint32_t first = uint32_t(mesh.positions.size());
    float v = 0;
    for (size_t i = 0; i < line.size(); ++i) {
        const glm::vec3 along = glm::normalize(line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0]);
        const glm::vec3 x = glm::normalize(glm::cross(along, glm::vec3(0.31f, 0.2f, 0.93f))), y = glm::cross(along, x);
        const float t = float(i) / float(line.size() - 1), r = glm::mix(r0, r1, t);
        if (i > 0) v += glm::distance(line[i], line[i - 1]) * 0.6f;
        for (int s = 0; s <= sides; ++s) {
            const float a = 2 * kPi * float(s) / float(sides);
            const glm::vec3 n = x * std::cos(a) + y * std::sin(a);
            mesh.positions.push_back(line[i] + n * r);
            mesh.normals.push_back(n);
            mesh.uvs.push_back({std::round(open * 8) + u0 + 0.002f + 0.058f * float(s) / float(sides), v});
        }
    }
    const uint32_t row = uint32_t(sides) + 1;
    for (uint32_t i = 0; i + 1 < line.size(); ++i)
        for (uint32_t s = 0; s < uint32_t(sides); ++s) {
            const uint32_t a = first + i * row + s;
            for (uint32_t k : {a, a + 1, a + row + 1, a, a + row + 1, a + row}) mesh.indices.push_back(k);
        }
}

constexpr float kFlat = 0.8f;                            // height of a lobe by its width
constexpr float kSpread[kPlantLods] = {0, 1.4f, 1.75f};  // of a group's reach, that its card is larger by
struct Lobe {
    glm::vec3 at, away;  // away: from the trunk, unit
    float radius;
};

// Each bough carries one, spiralling up, the last one on top; the same on every level.
std::vector<Lobe> lobesOf(const Habit& h, glm::vec3 lean) {
    std::vector<Lobe> lobes;
    const float tall = h.crownTop - h.crownFoot;
    for (int k = 0; k < h.lobes; ++k) {
        const auto random = [&](uint32_t which) { return random01(h.salt * 5, uint32_t(k), which); };
        const bool top = k + 1 == h.lobes;
        const bool bush = h.trunk == 0;  // its lobes run into each other
        const float highest = h.birch ? 0.88f : bush ? 0.62f : 0.84f, rise = bush ? 0.40f : h.birch ? 0.74f : 0.72f;
        const float t = top ? highest : 0.10f + rise * (float(k) + 0.5f * random(0)) / float(h.lobes - 1);
        const float angle = 2.399963f * float(k) + 0.6f * random(1), wide = crownRadius(h, t);
        const float most = (bush ? 0.44f : h.row == kAppleRow ? 0.36f : 0.26f) * tall;
        const float broad = h.birch ? 0.78f * std::max(wide, 0.6f * h.radius) : (bush ? 0.66f : 0.60f) * h.radius;
        const float radius = std::min(broad * (bush ? 0.8f + 0.4f * random(2) : 0.70f + 0.50f * random(2)), most);
        const float reach = std::max(wide * (0.84f + 0.16f * random(3)) - 0.82f * radius, 0.25f * wide);
        // A birch's boughs are too thin to be seen: none of its lobes stands off by itself.
        const float r = top ? 0 : h.birch ? 0.9f * reach : bush ? std::min(reach, 0.7f * radius) : reach;
        const glm::vec3 out(std::cos(angle), 0, std::sin(angle));
        lobes.push_back({r * out + glm::vec3(0, h.crownFoot + tall * t, 0) + lean * (0.4f * tall * t),
                         glm::normalize(top ? glm::vec3(0, 1, 0) : out + glm::vec3(0, 0.5f * t, 0)), radius});
    }
    return lobes;
}

// Where a card lies in its lobe.
struct Twig {
    const Lobe* lobe;
    glm::vec3 at, dir;  // dir: from the lobe's middle, unit
    float side;
};

// Even over the lobes; what would lie inside the crown comes round to its outside. None hangs below the crown's foot.
std::vector<Twig> twigsOf(const Habit& h, const std::vector<Lobe>& lobes) {
    std::vector<Twig> twigs;
    const float side = h.side;
    const int cards = h.cards[0], count = (cards + h.lobes - 1) / h.lobes;
    for (int i = 0; i < cards; ++i) {
        const auto random = [&](uint32_t which) { return random01(h.salt * 7, uint32_t(i), which); };
        const Lobe& lobe = lobes[size_t(i) % lobes.size()];
        const int which = i / h.lobes;
        const float up = 1 - 2 * glm::clamp((float(which) + random(0)) / float(count), 0.0f, 1.0f);
        const float angle = 2.399963f * float(which) + 6.28f * random(1), flat = std::sqrt(1 - up * up);
        glm::vec3 dir(flat * std::cos(angle), up, flat * std::sin(angle));
        dir -= std::min(glm::dot(dir, lobe.away) + 0.25f, 0.0f) * 1.6f * lobe.away;
        dir = glm::normalize(dir);
        // Every fifth fills the room between lobe and trunk, so that no sky is seen through a crown's middle.
        const bool fills = i % 5 == 4;
        const float deep = fills ? h.hollow * random(2) : glm::mix(h.hollow, 1.0f, std::pow(random(2), 0.40f));
        glm::vec3 at = lobe.at + dir * glm::vec3(1, kFlat, 1) * (lobe.radius * deep);
        if (fills) at -= lobe.away * (0.7f * random(11) * glm::length(glm::vec2(lobe.at.x, lobe.at.z)));
        at.y = std::max(at.y, h.crownFoot + (h.trunk > 0 ? 0.5f : 0.3f) * side);
        if (h.trunk == 0 && i % 3 == 0) at.y = (0.1f + 0.2f * random(10)) * side;  // it stands on the ground
        twigs.push_back({&lobe, at, dir, side});
    }
    return twigs;
}

// One that would hang in the air by itself moves in to its lobe's middle until others are near, at last over to those.
void gather(std::vector<Twig>& twigs) {
    constexpr int kCompany = 4, kInward = 4, kSteps = 6;
    std::vector<glm::vec3> near(kCompany + 1), all(twigs.size());
    for (int step = 0; step < kSteps; ++step)
        for (Twig& twig : twigs) {
            const auto nearer = [&](glm::vec3 a, glm::vec3 b) {
                return glm::distance(a, twig.at) < glm::distance(b, twig.at);
            };
            std::transform(twigs.begin(), twigs.end(), all.begin(), [](const Twig& other) { return other.at; });
            std::partial_sort_copy(all.begin(), all.end(), near.begin(), near.end(), nearer);  // itself first
            if (glm::distance(near.back(), twig.at) < 0.8f * twig.side) continue;
            const glm::vec3 sum = std::accumulate(near.begin() + 1, near.end(), glm::vec3(0));
            twig.at = step < kInward ? glm::mix(twig.at, twig.lobe->at, 0.25f)
                                     : glm::mix(twig.at, sum / float(kCompany), 0.5f);
        }
}

// One for each of so many groups of those that lie near each other, as large as its group is wide. Groups begin far
// from each other, and what is nearer to another goes over to that.
std::vector<Twig> grouped(std::span<const Twig> twigs, int groups, float spread) {
    constexpr int kRounds = 8;
    const auto nearest = [](std::span<const glm::vec3> middles, glm::vec3 at) {
        const auto far = [&](glm::vec3 middle) { return glm::distance(middle, at); };
        return size_t(std::ranges::min_element(middles, {}, far) - middles.begin());
    };
    std::vector<glm::vec3> middles{twigs[0].at};
    while (int(middles.size()) < groups) {
        const auto off = [&](const Twig& t) { return glm::distance(middles[nearest(middles, t.at)], t.at); };
        middles.push_back(std::ranges::max_element(twigs, {}, off)->at);
    }
    std::vector<std::vector<const Twig*>> members;
    for (int round = 0; round < kRounds; ++round) {
        members.assign(middles.size(), {});
        for (const Twig& t : twigs) members[nearest(middles, t.at)].push_back(&t);
        for (size_t i = 0; i < middles.size(); ++i) {
            glm::vec3 sum(0);
            for (const Twig* t : members[i]) sum += t->at;
            if (!members[i].empty()) middles[i] = sum / float(members[i].size());
        }
    }
    std::vector<Twig> out;
    for (size_t i = 0; i < middles.size(); ++i) {
        if (members[i].empty()) continue;
        glm::vec3 dir(0);
        float reach = 0;
        for (const Twig* t : members[i]) {
            dir += t->dir;
            reach = std::max(reach, glm::distance(t->at, middles[i]));
        }
        const auto off = [&](const Twig* t) { return glm::distance(t->at, middles[i]); };
        const Lobe* lobe = (*std::ranges::min_element(members[i], {}, off))->lobe;
        const bool one = glm::length(dir) > 1e-3f;
        out.push_back({lobe, middles[i], one ? glm::normalize(dir) : lobe->away, twigs[0].side + spread * reach});
    }
    return out;
}

// Places within a crown: lobes are even clouds of leaves, which hide the more of the sky the longer the way through
// them.
class Crown {
  public:
    Crown(const Habit& h, std::span<const Lobe> lobes)
        : lobes_(lobes),
          middle_(0, glm::mix(h.crownFoot, h.crownTop, 0.42f), 0),
          squash_(h.radius, 0.5f * (h.crownTop - h.crownFoot), h.radius),
          dense_(kDense / h.radius),
          least_(h.birch ? 0.55f : 0.2f) {}

    glm::vec3 away(glm::vec3 p) const { return glm::normalize((p - middle_) / squash_); }
    Lit litAt(glm::vec3 p, const Lobe& lobe, glm::vec3 out) const {
        const glm::vec3 n = 0.6f * away(p) + glm::normalize(p - lobe.at) + 0.3f * out;
        return {glm::normalize(n), glm::mix(least_, 1.0f, std::min(1.35f * openAt(p), 1.0f))};
    }

  private:
    static constexpr float kDense = 2.6f;  // of a way as long as the crown's radius
    static constexpr int kWays = 48;

    // Share of the sky, its zenith counting most.
    float openAt(glm::vec3 p) const {
        float seen = 0, all = 0;
        for (int i = 0; i < kWays; ++i) {
            const float up = 1 - 1.5f * (float(i) + 0.5f) / kWays, angle = 2.399963f * float(i);
            const float flat = std::sqrt(1 - up * up), weight = 0.6f + up;
            const glm::vec3 way(flat * std::cos(angle), up, flat * std::sin(angle));
            float through = 0;
            for (const Lobe& lobe : lobes_) through += within(lobe, p, way);
            seen += weight * std::exp(-dense_ * through);
            all += weight;
        }
        return seen / all;
    }
    // Length of the ray from p that lies in a lobe.
    static float within(const Lobe& lobe, glm::vec3 p, glm::vec3 way) {
        const glm::vec3 rcp(1, 1 / kFlat, 1), from = (p - lobe.at) * rcp / lobe.radius, d = way * rcp / lobe.radius;
        const float a = glm::dot(d, d), b = glm::dot(from, d), c = glm::dot(from, from) - 1, root = b * b - a * c;
        return root > 0 ? std::max((std::sqrt(root) - b) / a, 0.0f) - std::max((-std::sqrt(root) - b) / a, 0.0f) : 0;
    }

    std::span<const Lobe> lobes_;
    glm::vec3 middle_, squash_;
    float dense_, least_;
};

// The trunk, with its root's flare, and boughs that end in the lobes that they carry.
class Wood {
  public:
    Wood(const Habit& h, glm::vec3 lean)
        : h_(h), lean_(lean), top_(h.crownFoot + (h.crownTop - h.crownFoot) * (h.birch ? 0.9f : 0.5f)) {}

    void addTrunk(Mesh& mesh, int lod) const {
        const int sides = lod == 0 ? 7 : lod == 1 ? 4 : 3, pieces = lod == 0 ? 5 : 2;
        const float bark = h_.birch ? 0.0625f : 0.0f;
        std::vector<glm::vec3> line;
        for (int i = 0; i <= pieces; ++i) line.push_back(axis(top_ * float(i) / float(pieces)) - glm::vec3(0, 0.1f, 0));
        addTube(mesh, line, h_.trunk, h_.trunk * (h_.birch ? 0.12f : 0.22f), sides, bark, 0.6f);
        if (lod > 0) return;
        addTube(mesh, {{0, -0.1f, 0}, {0, 0.16f, 0}, {0, 0.5f, 0}}, h_.trunk * 1.55f, h_.trunk * 0.92f, sides, bark,
                0.5f);
    }
    void addBough(Mesh& mesh, int lod, const Lobe& lobe) const {
        const float tall = h_.crownTop - h_.crownFoot;
        const glm::vec3 root = axis(glm::clamp(lobe.at.y - 0.3f * tall, 0.85f * h_.crownFoot, 0.9f * top_));
        const glm::vec3 end = glm::mix(axis(std::min(lobe.at.y, top_)), lobe.at, 0.85f);
        // Up from the trunk, then over.
        const glm::vec3 bend = glm::mix(root, end, 0.5f) + glm::vec3(0, h_.birch ? 0.5f : 0.2f, 0);
        const int pieces = lod == 0 ? 3 : 2;
        std::vector<glm::vec3> line;
        for (int i = 0; i <= pieces; ++i) {
            const float t = float(i) / float(pieces);
            line.push_back(glm::mix(glm::mix(root, bend, t), glm::mix(bend, end, t), t));
        }
        addTube(mesh, line, h_.trunk * (h_.birch ? 0.28f : 0.45f), h_.trunk * 0.04f, lod == 0 ? 4 : 3, 0, 0.5f);
    }

  private:
    // The trunk's middle at a height.
    glm::vec3 axis(float y) const {
        const float t = y / top_;
        return glm::vec3(0, y, 0) + lean_ * (t * t * top_ * 0.4f);
    }
    const Habit& h_;
    glm::vec3 lean_;
    float top_;
};

Mesh makeTree(const Habit& h, int lod) {
    Mesh mesh;
    const glm::vec3 lean(0.25f * (random01(h.salt, 1) - 0.5f), 0, 0.25f * (random01(h.salt, 2) - 0.5f));
    const std::vector<Lobe> lobes = lobesOf(h, lean);
    const Wood wood(h, lean);
    if (h.trunk > 0) wood.addTrunk(mesh, lod);
    for (int b = 0; b < h.boughs && lod < 2; ++b) wood.addBough(mesh, lod, lobes[size_t(b * (h.lobes - 1) / h.boughs)]);
    const Crown crown(h, lobes);
    std::vector<Twig> twigs = twigsOf(h, lobes);
    gather(twigs);
    if (lod > 0) {
        twigs = grouped(twigs, h.cards[lod], kSpread[lod]);
        gather(twigs);
    }
    for (size_t i = 0; i < twigs.size(); ++i) {
        const auto random = [&](uint32_t which) { return random01(h.salt * 7 + uint32_t(lod), uint32_t(i), which); };
        const auto& [lobe, at, dir, side] = twigs[i];
        const glm::vec3 tilt(random(3) - 0.5f, random(4) - 0.35f, random(5) - 0.5f);
        glm::vec3 out = glm::normalize(0.3f * crown.away(at) + 0.7f * dir + 1.4f * tilt);
        // Seen from the ground, a card that lies flat is a line.
        out = glm::normalize(glm::vec3(out.x, 0.55f * out.y, out.z));
        // Twigs lead out of their lobe, up to the light; a birch's hang. Far off, cards are light above.
        const float rise = lod > 0 ? 1.0f : h.birch ? -0.9f : 0.35f;
        const glm::vec3 twig =
            glm::normalize(glm::vec3(random(6) - 0.5f, rise, random(7) - 0.5f) + (lod > 0 ? 0.2f : 0.6f) * dir);
        const Cell cell = cellOf(lod, h.row, random(8));
        addCard(mesh, at, out, twig, side * (0.8f + 0.4f * random(9)), cell,
                [&, on = lobe](glm::vec3 p) { return crown.litAt(p, *on, out); });
    }
    return mesh;
}

}  // namespace

void addTrees(PropMeshes& out) {
    for (const Habit& h : kHabits)
        for (int lod = 0; lod < kPlantLods; ++lod) out.add(h.name, lod, makeTree(h, lod), PropMeshes::kFoliage);
}

}  // namespace espalier::content
