// Surfaces that are placed mirrored: plants, contacts and light are as on those that aren't.
#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <glm/glm.hpp>
#include <utility>

#include "tests/plugin/places_world.hpp"

namespace espalier::places {
namespace {

struct Corner {
    glm::vec3 position, normal;
};
glm::vec3 octahedral(float x, float y) {
    glm::vec3 n(x, y, 1 - std::abs(x) - std::abs(y));
    if (n.z < 0) {
        n.x = (1 - std::abs(y)) * (x < 0 ? -1.f : 1.f);
        n.y = (1 - std::abs(x)) * (y < 0 ? -1.f : 1.f);
    }
    return glm::normalize(n);
}

// Two squares that meet at an edge, bent by an angle, with a plant that climbs over it from the first one.
struct Bent {
    EspContext* context = nullptr;
    EspSeed seed{};

    // other: the second square is a mirrored one, which fills the same place.
    Bent(float angle, bool other, const char* rules) {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = quiet;
        REQUIRE_MESSAGE(espCreate(ESP_VERSION, &def, &context) == ESP_OK, espLastError(nullptr));
        EspTransform first = espIdentity(), second = espIdentity();
        second.rows[0][0] = second.rows[2][2] = std::cos(angle);
        second.rows[0][2] = std::sin(angle);
        second.rows[2][0] = -second.rows[0][2];
        second.rows[0][3] = 1;
        if (other) {
            // From its far edge back.
            for (auto& row : second.rows) row[3] += row[0], row[0] = -row[0];
        }
        EspSurface surface{};
        REQUIRE(espLoadSurface(context, ESPALIER_SQUARE, &first, &surface) == ESP_OK);
        REQUIRE_MESSAGE(espPlaceAgain(context, surface, &second, &surface) == ESP_OK, espLastError(context));
        const EspGrammarDef text = esp::grammarDef("ivy", rules);
        EspSeedDef plant = esp::defaults<EspSeedDef>();
        REQUIRE_MESSAGE(espCompileGrammar(context, &text, &plant.grammar) == ESP_OK, espLastError(context));
        plant.position[0] = .5f, plant.position[1] = .3f;
        plant.direction[0] = 1, plant.direction[1] = .2f;
        plant.number = 3;
        REQUIRE_MESSAGE(espPlant(context, &plant, &seed) == ESP_OK, espLastError(context));
        REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    }
    ~Bent() { espDestroy(context); }
    Bent(const Bent&) = delete;

    // Vertices of all that has grown, by their places in the list.
    std::vector<Corner> corners() {
        EspTriangles triangles{};
        triangles.structSize = sizeof triangles;
        REQUIRE_MESSAGE(espMaterialise(context, &triangles) == ESP_OK, espLastError(context));
        std::vector<Corner> out(triangles.vertexCount);
        for (size_t i = 0; i < out.size(); ++i) {
            const std::byte* from = static_cast<const std::byte*>(triangles.vertices) + 16 * i;
            int16_t packed[2];
            std::memcpy(&out[i].position, from, 12);
            std::memcpy(packed, from + 12, 4);
            out[i].normal = octahedral(float(packed[0]) / 32767, float(packed[1]) / 32767);
        }
        return out;
    }
};

// Stems that go straight on, without leaves: turns and leaves to the left are those that the surface itself sees.
constexpr const char* kStems =
    "Ivy -> Stem(.9)\n"
    "Stem(l) : arc >= l -> NULL\n"
    "Stem(l) -> Marching(0.04, 0, true) {Stem(l), Wood}\n"
    "Wood -> S(0.02) Shape(\"bark\", C1)\n";

}  // namespace

TEST_CASE("a plant climbs over to a mirrored surface as over to any other") {
    for (const float angle : {0.f, .7f, 1.4f, -.9f, -2.f}) {
        CAPTURE(angle);
        Bent straight(angle, false, kStems), mirror(angle, true, kStems);
        const std::vector<Corner> a = straight.corners(), b = mirror.corners();
        REQUIRE(a.size() == b.size());
        REQUIRE(a.size() > 500);
        bool beyond = false;
        float apart = 0, turned = 0;
        // They come in any order.
        for (const Corner& from : a) {
            const auto unlike = [&](const Corner& to) {
                return glm::distance(from.position, to.position) + .01f * glm::distance(from.normal, to.normal);
            };
            const Corner& to = *std::ranges::min_element(b, {}, unlike);
            apart = std::max(apart, glm::distance(from.position, to.position));
            turned = std::max(turned, glm::distance(from.normal, to.normal));
            beyond = beyond || from.position.x > 1.1f || std::abs(from.position.z) > .1f;
        }
        CHECK(beyond);
        CHECK(apart < 1e-3f);  // a contact lies a fiftieth of a texel within each border
        CHECK(turned < .05f);
    }
}

TEST_CASE("a mirrored surface touches what is near it as any other does") {
    // Squares beside another one: turned into it from a hair before it on, or straight up from there.
    for (const float angle : {.02f, .37f, 1.1f, -1.5707964f}) {
        CAPTURE(angle);
        uint32_t contacts[2];
        for (const bool other : {false, true}) {
            EspContextDef def = esp::defaults<EspContextDef>();
            def.log = quiet;
            EspContext* context = nullptr;
            REQUIRE(espCreate(ESP_VERSION, &def, &context) == ESP_OK);
            EspTransform floor = espIdentity(), wall = placeAt(.23f, .17f, .0005f, angle);
            // About its diagonal, so that its two triangles fill the same places.
            if (other)
                for (auto& row : wall.rows) std::swap(row[0], row[1]);
            EspSurface surface{};
            REQUIRE(espLoadSurface(context, ESPALIER_SQUARE, &floor, &surface) == ESP_OK);
            REQUIRE(espPlaceAgain(context, surface, &wall, &surface) == ESP_OK);
            REQUIRE(espUpdate(context) == ESP_OK);
            EspStats stats{};
            stats.structSize = sizeof stats;
            REQUIRE(espReadStats(context, &stats) == ESP_OK);
            contacts[other] = stats.contacts;
            espDestroy(context);
        }
        CHECK(contacts[0] > 0);
        CHECK(contacts[0] == contacts[1]);
    }
}

TEST_CASE("bark goes straight on where a stem climbs over to another surface") {
    // The plant's line, less half of the bark, which is buried.
    const glm::vec3 origin(.5f, .3f, .0045f), along = glm::normalize(glm::vec3(1, .2f, 0));
    for (const bool mirror : {false, true}) {
        Bent flat(0, mirror, kStems);
        float farthest = 0;
        for (const Corner& corner : flat.corners()) {
            const glm::vec3 off = corner.position - origin;
            farthest = std::max(farthest, glm::length(off - along * glm::dot(off, along)));
        }
        CHECK(farthest > .0099f);
        CHECK(farthest < .0103f);  // its radius, and what a contact's place differs by
    }
}

TEST_CASE("what is mirrored as a whole grows as it did, mirrored") {
    World straight(false);
    const EspStats before = straight.stats();
    std::vector<uint8_t> picture = straight.picture();
    // Each square, each seed.
    for (size_t i = 0; i < kPlaces.size(); ++i) {
        EspTransform place = kPlaces[i];
        for (float& x : place.rows[0]) x = -x;
        REQUIRE_MESSAGE(espMoveSurface(straight.context, straight.squares[i], &place) == ESP_OK,
                        espLastError(straight.context));
    }
    straight.update();
    CHECK(straight.stats().hash == before.hash);
    CHECK(straight.stats().contacts == before.contacts);
    // Back again.
    for (size_t i = 0; i < kPlaces.size(); ++i)
        REQUIRE(espMoveSurface(straight.context, straight.squares[i], &kPlaces[i]) == ESP_OK);
    straight.update();
    CHECK(straight.stats().hash == before.hash);
    CHECK(straight.picture() == picture);
}

TEST_CASE("a mirrored surface is lit as what fills the same place") {
    EspContextDef def = esp::defaults<EspContextDef>();
    def.log = quiet;
    std::vector<uint8_t> pictures[2];
    for (int other = 0; other < 2; ++other) {
        EspContext* context = nullptr;
        REQUIRE(espCreate(ESP_VERSION, &def, &context) == ESP_OK);
        EspTransform place = placeAt(0, 0, 0, .4f);
        if (other)
            for (auto& row : place.rows) row[3] += row[0], row[0] = -row[0];
        EspSurface surface{};
        REQUIRE(espLoadSurface(context, ESPALIER_SQUARE, &place, &surface) == ESP_OK);
        REQUIRE(espUpdate(context) == ESP_OK);
        for (const float side : {1.f, -1.f}) {  // its back, too
            esp::DrawDef draw;
            draw.width = kWidth, draw.height = kHeight;
            draw.camera.eye[0] = .5f, draw.camera.eye[1] = .9f, draw.camera.eye[2] = 2 * side;
            draw.camera.target[0] = .5f, draw.camera.target[1] = .5f;
            REQUIRE_MESSAGE(espDraw(context, &draw) == ESP_OK, espLastError(context));
            std::vector<uint8_t> pixels(size_t(kWidth) * kHeight * 4);
            REQUIRE(espReadPixels(context, pixels.data(), pixels.size()) == ESP_OK);
            pictures[other].insert(pictures[other].end(), pixels.begin(), pixels.end());
        }
        espDestroy(context);
    }
    size_t apart = 0;
    for (size_t i = 0; i < pictures[0].size(); ++i) apart += std::abs(int(pictures[0][i]) - int(pictures[1][i])) > 3;
    CHECK(apart * 1000 < pictures[0].size());
}

}  // namespace espalier::places
