// Trees and bushes. In: how a species stands. Out: trunk and boughs as tubes, twigs as cards that lie about the lobes
// of its crown, fewer and larger ones a level. A card's normals lead out of lobe and crown; the whole part of its u is
// how open it lies, in eighths.

#include <algorithm>
#include <cmath>

#include "shaders/render/prop_records.h"
#include "tools/content/noise.hpp"
#include "tools/content/props.hpp"

namespace espalier::content {
namespace {

constexpr float kPi = 3.14159265f;
constexpr int kLods = 3;

struct Habit {
    const char* name;
    int row;  // of the atlas
    uint32_t salt;
    float crownFoot, crownTop;  // metres
    float radius;               // of the crown where it is widest
    float widest;               // 0 to 1, from its foot
    float hollow;               // share of a lobe's radius without twigs
    int lobes;
    int cards[kLods];
    float side;   // of a card of the finest level, metres
    float trunk;  // radius at the foot; 0: boughs from the ground
    int boughs;
    bool birch;
};
const Habit kHabits[] = {
    {"lime_a", 0, 21, 1.9f, 9.6f, 3.5f, 0.42f, 0.45f, 13, {400, 104, 30}, 0.98f, 0.30f, 9, false},
    {"lime_b", 0, 22, 2.2f, 11.2f, 3.9f, 0.40f, 0.45f, 15, {450, 115, 32}, 1.06f, 0.36f, 10, false},
    {"apple_a", 1, 23, 1.3f, 4.3f, 2.1f, 0.45f, 0.35f, 8, {210, 60, 18}, 0.78f, 0.14f, 7, false},
    {"apple_b", 1, 24, 1.2f, 4.9f, 2.4f, 0.50f, 0.35f, 9, {230, 64, 19}, 0.82f, 0.15f, 7, false},
    {"birch_a", 2, 25, 1.8f, 9.4f, 1.75f, 0.33f, 0.15f, 13, {300, 80, 22}, 0.80f, 0.13f, 6, true},
    {"bush_a", 3, 26, 0.0f, 1.5f, 1.05f, 0.45f, 0.30f, 5, {90, 28, 9}, 0.60f, 0.0f, 0, false},
    {"bush_b", 3, 27, 0.0f, 1.0f, 0.85f, 0.50f, 0.30f, 4, {70, 24, 8}, 0.52f, 0.0f, 0, false},
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

// What a card's place tells of its normal: it leads out of the crown and of the lobe.
struct Round {
    glm::vec3 middle, squash, lobe;
    glm::vec3 normal(glm::vec3 p) const {
        return glm::normalize((p - middle) / squash) + 0.8f * glm::normalize(p - lobe);
    }
};

// A direction, either way: its square of the octahedron, which foliage.vert reads.
float facingCode(glm::vec3 n) {
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    glm::vec2 o(n.x, n.z);
    if (n.y < 0) o = (1.0f - glm::vec2(std::abs(n.z), std::abs(n.x))) * glm::vec2(n.x < 0 ? -1 : 1, n.z < 0 ? -1 : 1);
    constexpr int kSide = int(kFacingSide);
    const glm::ivec2 at = glm::clamp(glm::ivec2((o * 0.5f + 0.5f) * float(kSide)), 0, kSide - 1);
    return float(at.x + kSide * at.y);
}

// Of the atlas.
struct Cell {
    glm::vec2 low;
    float side = kCellSide;
};

// Two triangles about `at`, facing `out`; its twig points along `up`.
void addCard(Mesh& mesh, glm::vec3 at, glm::vec3 out, glm::vec3 up, float side, Cell cell, float open,
             const Round& round) {
    const glm::vec3 x = glm::normalize(glm::cross(up, out)), y = glm::cross(out, x);
    const uint32_t first = uint32_t(mesh.positions.size());
    const float facing = facingCode(glm::cross(x, y));
    for (int k = 0; k < 4; ++k) {
        const glm::vec2 c(k == 1 || k == 2 ? 1 : 0, k >= 2 ? 1 : 0);
        const glm::vec3 p = at + side * ((c.x - 0.5f) * x + (c.y - 0.5f) * y);
        mesh.positions.push_back(p);
        mesh.normals.push_back(glm::normalize(round.normal(p) + 0.35f * out));
        mesh.uvs.push_back(glm::vec2(std::round(open * 8), -1 - facing) + cell.low +
                           cell.side * (0.02f + 0.96f * glm::vec2(c.x, 1 - c.y)));
    }
    for (uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
}

// chance: 0 to 1, picks among the twigs of a species.
Cell cellOf(int lod, int row, float chance) {
    const int column = lod > 0 ? kFarColumn : std::min(int(float(kFarColumn) * chance), kFarColumn - 1);
    return {{kFirstCell + kCellSide * float(column), kCellSide * float(row)}};
}

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
        const float highest = h.birch ? 0.91f : bush ? 0.62f : 0.84f, rise = bush ? 0.40f : h.birch ? 0.78f : 0.72f;
        const float t = top ? highest : 0.10f + rise * (float(k) + 0.5f * random(0)) / float(h.lobes - 1);
        const float angle = 2.399963f * float(k) + 0.6f * random(1), wide = crownRadius(h, t);
        const float most = (bush ? 0.44f : 0.26f) * tall;
        const float broad = h.birch ? 0.78f * std::max(wide, 0.6f * h.radius) : (bush ? 0.66f : 0.56f) * h.radius;
        const float radius = std::min(broad * (bush ? 0.8f + 0.4f * random(2) : 0.70f + 0.50f * random(2)), most);
        const float r =
            top ? 0 : std::max(wide * ((bush ? 0.9f : 0.84f) + 0.22f * random(3)) - 0.75f * radius, 0.25f * wide);
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
    float deep;         // 1: on the lobe's outside
};

// Even over the lobes; what would lie inside the crown comes round to its outside. None hangs below the crown's foot.
std::vector<Twig> twigsOf(const Habit& h, const std::vector<Lobe>& lobes, int lod, float side) {
    std::vector<Twig> twigs;
    const int cards = h.cards[lod], count = (cards + h.lobes - 1) / h.lobes;
    for (int i = 0; i < cards; ++i) {
        const auto random = [&](uint32_t which) { return random01(h.salt * 7 + uint32_t(lod), uint32_t(i), which); };
        const Lobe& lobe = lobes[size_t(i) % lobes.size()];
        const int which = i / h.lobes;
        const float up = 1 - 2 * glm::clamp((float(which) + random(0)) / float(count), 0.0f, 1.0f);
        const float angle = 2.399963f * float(which) + 6.28f * random(1), flat = std::sqrt(1 - up * up);
        glm::vec3 dir(flat * std::cos(angle), up, flat * std::sin(angle));
        dir -= std::min(glm::dot(dir, lobe.away) + 0.25f, 0.0f) * 1.6f * lobe.away;
        dir = glm::normalize(dir);
        // Every sixth fills the lobe, so that no sky is seen through a crown's middle.
        const float deep = i % 6 == 5 ? h.hollow * random(2) : glm::mix(h.hollow, 1.0f, std::pow(random(2), 0.40f));
        glm::vec3 at = lobe.at + dir * glm::vec3(1, 0.8f, 1) * (lobe.radius * deep);
        at.y = std::max(at.y, h.crownFoot + (h.trunk > 0 ? 0.5f : 0.3f) * side);
        twigs.push_back({&lobe, at, dir, deep});
    }
    return twigs;
}

// One that would hang in the air by itself moves in to its lobe's middle until others are near.
void gather(std::vector<Twig>& twigs, float side) {
    constexpr int kCompany = 4;
    for (Twig& twig : twigs)
        for (int step = 0; step < 4; ++step) {
            const auto near = [&](const Twig& other) { return glm::distance(other.at, twig.at) < 0.8f * side; };
            if (std::count_if(twigs.begin(), twigs.end(), near) > kCompany) break;  // itself, too
            twig.at = glm::mix(twig.at, twig.lobe->at, 0.25f);
        }
}

Mesh makeTree(const Habit& h, int lod) {
    Mesh mesh;
    const float tall = h.crownTop - h.crownFoot, bark = h.birch ? 0.0625f : 0.0f;
    const glm::vec3 middle(0, h.crownFoot + tall * 0.42f, 0);
    const glm::vec3 lean(0.25f * (random01(h.salt, 1) - 0.5f), 0, 0.25f * (random01(h.salt, 2) - 0.5f));
    const int sides = lod == 0 ? 7 : lod == 1 ? 4 : 3;
    if (h.trunk > 0) {
        std::vector<glm::vec3> line;
        const float top = h.crownFoot + tall * (h.birch ? 0.9f : 0.5f);
        for (int i = 0; i <= (lod == 0 ? 5 : 2); ++i) {
            const float t = float(i) / (lod == 0 ? 5.0f : 2.0f);
            line.push_back(glm::vec3(0, top * t - 0.1f, 0) + lean * (t * t * top * 0.4f));
        }
        addTube(mesh, line, h.trunk, h.trunk * (h.birch ? 0.12f : 0.35f), sides, bark, 0.6f);
        // The root's flare.
        if (lod == 0)
            addTube(mesh, {{0, -0.1f, 0}, {0, 0.16f, 0}, {0, 0.5f, 0}}, h.trunk * 1.55f, h.trunk * 0.92f, sides, bark,
                    0.5f);
    }
    if (lod < 2)
        for (int b = 0; b < h.boughs; ++b) {
            const float angle = 2.399963f * float(b) + random01(h.salt, uint32_t(b), 5);
            const float from = h.crownFoot * 0.85f + tall * 0.36f * float(b) / float(h.boughs);
            const float t = glm::clamp((from - h.crownFoot) / tall + 0.24f, 0.1f, 0.9f);
            const float reach = 0.58f * crownRadius(h, t);
            const glm::vec3 root = glm::vec3(0, from, 0) + lean * (0.1f * from);
            const glm::vec3 end(reach * std::cos(angle), h.crownFoot + tall * (t + 0.08f), reach * std::sin(angle));
            const glm::vec3 bend = glm::mix(root, end, 0.5f) + glm::vec3(0, h.birch ? 0.5f : -0.18f, 0);
            addTube(mesh, {root, bend, end}, h.trunk * 0.45f, h.trunk * 0.10f, lod == 0 ? 4 : 3, bark, 0.5f);
        }
    const int cards = h.cards[lod];
    const float side = h.side * std::pow(float(h.cards[0]) / float(cards), 0.46f);
    const glm::vec3 squash(h.radius, tall * 0.5f, h.radius);
    const std::vector<Lobe> lobes = lobesOf(h, lean);
    std::vector<Twig> twigs = twigsOf(h, lobes, lod, side);
    gather(twigs, side);
    for (int i = 0; i < cards; ++i) {
        const auto random = [&](uint32_t which) { return random01(h.salt * 7 + uint32_t(lod), uint32_t(i), which); };
        const auto& [on, at, dir, deep] = twigs[size_t(i)];
        const Lobe& lobe = *on;
        const glm::vec3 away = glm::normalize((at - middle) / squash);
        const glm::vec3 tilt(random(3) - 0.5f, random(4) - 0.35f, random(5) - 0.5f);
        glm::vec3 out = glm::normalize(0.5f * away + dir + 0.9f * tilt);
        // Seen from the ground, a card that lies flat is a line.
        out = glm::normalize(glm::vec3(out.x, 0.55f * out.y, out.z));
        // Twigs lead out of their lobe, up to the light; a birch's hang.
        const glm::vec3 twig =
            glm::normalize(glm::vec3(random(6) - 0.5f, h.birch ? -0.9f : 0.35f, random(7) - 0.5f) + 0.6f * dir);
        const Cell cell = cellOf(lod, h.row, random(8));
        // Dark inside and below, of the crown and of each lobe; open above.
        const float t = (at.y - h.crownFoot) / tall;
        float open = glm::clamp(0.36f + 0.28f * (deep - h.hollow) / (1 - h.hollow) + 0.24f * dir.y +
                                    0.16f * glm::dot(dir, lobe.away) + 0.25f * (t - 0.4f),
                                0.2f, 1.0f);
        if (h.birch) open = glm::mix(open, 0.95f, 0.6f);  // light gets through
        addCard(mesh, at, out, twig, side * (0.8f + 0.4f * random(9)), cell, open, {middle, squash, lobe.at});
    }
    return mesh;
}

// A hedge, clipped: twigs lie on a box of 2 m by 1.25 m by 0.8 m.
Mesh makeHedge(int lod) {
    Mesh mesh;
    const int along = lod == 0 ? 7 : lod == 1 ? 4 : 2;
    const float side = 2.9f / float(along), high = 1.2f, half = 0.34f;
    const auto card = [&](glm::vec3 at, glm::vec3 out, uint32_t i) {
        const auto random = [&](uint32_t which) { return random01(911u + uint32_t(lod), i, which); };
        const glm::vec3 turned = glm::normalize(out + 0.7f * (glm::vec3(random(0), random(1), random(2)) - 0.5f));
        const Cell cell = cellOf(lod, 3, random(3));
        addCard(mesh, at + 0.08f * (glm::vec3(random(4), random(5), random(6)) - 0.5f), turned,
                std::abs(out.y) > 0.5f ? glm::vec3(0.3f, 0, 1) : glm::vec3(0.2f * (random(7) - 0.5f), 1, 0), side, cell,
                glm::clamp(0.35f + 0.5f * at.y / high, 0.0f, 1.0f), {at - out, glm::vec3(1), at - out});
    };
    uint32_t i = 0;
    const int rows = lod == 0 ? 4 : lod == 1 ? 2 : 1;
    for (int a = 0; a < along; ++a) {
        const float x = -1 + 2 * (float(a) + 0.5f) / float(along);
        for (int r = 0; r < rows; ++r) {
            const float y = high * (float(r) + 0.5f) / float(rows);
            card({x, y, half}, {0, 0, 1}, ++i);
            card({x, y, -half}, {0, 0, -1}, ++i);
        }
        card({x, high, 0.14f}, {0, 1, 0.2f}, ++i);
        card({x, high, -0.14f}, {0, 1, -0.2f}, ++i);
    }
    return mesh;
}

// A clump that stands upright on cards.
Mesh makeFlowers(int kind, int lod) {
    Mesh mesh;
    const int count = lod == 0 ? 6 : lod == 1 ? 3 : 1;
    const float side = lod == 0 ? 0.34f : lod == 1 ? 0.40f : 0.5f;
    const Cell cell{{1 - kFlowerSide, kFlowerSide * float(kind)}, kFlowerSide};
    for (int i = 0; i < count; ++i) {
        const float angle = 2.399963f * float(i), r = lod < 2 ? 0.16f * std::sqrt(float(i) / float(count)) : 0;
        const glm::vec3 at(r * std::cos(angle), 0.47f * side, r * std::sin(angle));
        const glm::vec3 out = glm::normalize(glm::vec3(std::cos(2 * angle), 0.25f, std::sin(2 * angle)));
        addCard(mesh, at, out, {0, 1, 0}, side, cell, 0.9f, {at - glm::vec3(0, 1, 0), glm::vec3(1), at - out});
    }
    return mesh;
}

// Grass as tall as one's knees, on cards that lean apart, so that it is seen from above, too; lit as the ground is.
Mesh makeMeadow(int kind, int lod) {
    constexpr float kLean = 0.40f;  // radians
    Mesh mesh;
    const int count = 5 - lod;
    const float side = lod == 0 ? 0.74f : lod == 1 ? 0.82f : 0.95f;
    const Cell cell{{1 - kFlowerSide, kFlowerSide * float(kFlowers + kind)}, kFlowerSide};
    for (int i = 0; i < count; ++i) {
        const float angle = 2.399963f * float(i), r = lod < 2 ? 0.34f * std::sqrt(float(i) / float(count)) : 0.08f;
        const float turn = lod < 2 ? 1.9f * angle : 2.09f * float(i) + 0.4f;
        const glm::vec3 foot(r * std::cos(angle), 0, r * std::sin(angle)), level(std::cos(turn), 0, std::sin(turn));
        const float lean = glm::dot(level, foot) < 0 ? -kLean : kLean;
        const glm::vec3 up = glm::vec3(0, std::cos(lean), 0) + std::sin(lean) * level;
        const glm::vec3 out = std::cos(lean) * level - glm::vec3(0, std::sin(lean), 0);
        const glm::vec3 at = foot + 0.48f * side * up, below = at - glm::vec3(0, 1, 0);
        addCard(mesh, at, out, up, side, cell, 0.8f, {below, glm::vec3(1), below});
    }
    return mesh;
}

// Blades of grass, their roots together. u is how far up the blade.
Mesh makeTuft(uint32_t salt, int blades, float tall, float spread, int lod) {
    Mesh mesh;
    const int steps = lod == 0 ? 2 : 1, count = lod == 0 ? blades : lod == 1 ? blades / 2 : blades / 4;
    for (int b = 0; b < count; ++b) {
        const auto random = [&](uint32_t which) { return random01(salt, uint32_t(b), which); };
        const float angle = 2.399963f * float(b) + random(0), high = tall * (0.55f + 0.45f * random(1));
        const glm::vec3 out(std::cos(angle), 0, std::sin(angle)), across(-out.z, 0, out.x);
        const glm::vec3 root = out * (spread * 0.35f * random(2));
        const float half = (lod == 0   ? 0.0042f
                            : lod == 1 ? 0.007f
                                       : 0.014f) *
                           (0.8f + 0.6f * random(3)),
                    lean = spread * (0.35f + 0.9f * random(4));
        const uint32_t first = uint32_t(mesh.positions.size());
        for (int s = 0; s <= steps; ++s) {
            const float t = float(s) / float(steps);
            const glm::vec3 at = root + out * (lean * t * t) + glm::vec3(0, high * (t - 0.25f * t * t) - 0.02f, 0);
            for (float side : {-1.0f, 1.0f}) {
                if (s == steps && side > 0) continue;  // a tip
                mesh.positions.push_back(at + across * (s == steps ? 0.0f : side * half * (1 - 0.4f * t)));
                mesh.normals.push_back(glm::normalize(glm::vec3(0, 1, 0) + 0.45f * out));
                mesh.uvs.push_back({t, 0.5f});
            }
        }
        for (int s = 0; s < steps; ++s) {
            const uint32_t a = first + 2 * uint32_t(s);
            for (uint32_t k : {a, a + 1, a + 2}) mesh.indices.push_back(k);
            if (s + 1 < steps)
                for (uint32_t k : {a + 1, a + 3, a + 2}) mesh.indices.push_back(k);
        }
    }
    return mesh;
}

}  // namespace

void addTrees(PropMeshes& out) {
    for (const Habit& h : kHabits)
        for (int lod = 0; lod < kLods; ++lod) out.add(h.name, lod, makeTree(h, lod), PropMeshes::kFoliage);
    for (int lod = 0; lod < kLods; ++lod) out.add("hedge", lod, makeHedge(lod), PropMeshes::kFoliage);
    for (int lod = 0; lod < kLods; ++lod) {
        for (int kind = 0; kind < kFlowers; ++kind)
            out.add("flowers_" + std::string(1, char('a' + kind)), lod, makeFlowers(kind, lod), PropMeshes::kFoliage);
        for (int kind = 0; kind < kMeadows; ++kind)
            out.add("meadow_" + std::string(1, char('a' + kind)), lod, makeMeadow(kind, lod), PropMeshes::kFoliage);
        out.add("tuft_a", lod, makeTuft(31, 18, 0.20f, 0.13f, lod), PropMeshes::kGrass);
        out.add("tuft_b", lod, makeTuft(32, 26, 0.32f, 0.20f, lod), PropMeshes::kGrass);
        out.add("tuft_c", lod, makeTuft(33, 14, 0.12f, 0.12f, lod), PropMeshes::kGrass);
    }
}

}  // namespace espalier::content
