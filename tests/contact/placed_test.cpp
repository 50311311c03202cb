// Surfaces placed against each other: walks go from one to the other as over a crease, and what is found agrees with an
// intersection of the triangles.
#include "tests/contact/placed.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/bake/kits.hpp"
#include "tests/bake/small_models.hpp"
#include "tests/contact/oracle.hpp"

using namespace espalier;
using namespace espalier::contacttest;
using glm::dvec3;

namespace {

Model plate(float half) {
    Model m;
    m.name = "plate";
    test::addPatch(
        m, 4, [&](float s, float t) { return glm::vec3((2 * s - 1) * half, 0, (1 - 2 * t) * half); },
        [](float s, float t) { return glm::vec2(0.05f + 0.9f * s, 0.05f + 0.9f * t); });
    return m;
}

// Hills of some decimetres.
Model terrain(int n) {
    Model m;
    m.name = "terrain";
    test::addPatch(
        m, n,
        [](float s, float t) {
            const float x = (2 * s - 1) * 3, z = (1 - 2 * t) * 3;
            return glm::vec3(x, 0.25f * std::sin(1.7f * x + 0.3f) * std::cos(1.3f * z), z);
        },
        [](float s, float t) { return glm::vec2(0.05f + 0.9f * s, 0.05f + 0.9f * t); });
    return m;
}

Model block(dvec3 half) {
    test::Kit kit;
    kit.box(dvec3(0), half);
    return kit.model();
}

glm::mat4 standing(glm::vec3 at, float turn, float scale = 1) {
    return glm::scale(glm::rotate(glm::translate(glm::mat4(1), at), turn, {0, 1, 0}), glm::vec3(scale));
}

// Walks on; the outside at the crossing from instance to instance, if there was one.
uint32_t go(World& world, WalkState& w, float length, glm::vec3* outside = nullptr) {
    uint32_t event = kWalkRetry;
    while (walkGoesOn(event)) {
        const uint32_t before = w.walk.place >> 16;
        glm::vec3 joint;
        event = walkAdvance(world.table(), 0, w, length, joint);
        if (outside && w.walk.place >> 16 != before) *outside = world.directionOf(w, joint);
    }
    return event;
}

// In the world: all, or one alone.
Model together(const World& world, const std::vector<Model>& models, uint32_t only = kNoIndex) {
    Model all;
    all.name = "all";
    for (uint32_t i = 0; i < models.size(); ++i) {
        if (only != kNoIndex && i != only) continue;
        const uint32_t base = uint32_t(all.positions.size());
        for (glm::vec3 p : models[i].positions) all.positions.push_back(glm::vec3(world.toWorld(i) * glm::vec4(p, 1)));
        for (uint32_t v : models[i].indices) all.indices.push_back(base + v);
    }
    return all;
}

double toLine(dvec3 p, const ContactLine& l) {
    const dvec3 d = l.b - l.a;
    return glm::length(p - (l.a + d * std::clamp(glm::dot(p - l.a, d) / std::max(glm::dot(d, d), 1e-300), 0.0, 1.0)));
}

// Where a crossing lies in the world, on its own side.
ContactLine inWorld(const World& world, uint32_t instance, const Crossing& c) {
    const SurfaceData& data = world.baked(instance);
    const SurfaceLevelData& level = data.levels[0];
    const auto at = [&](glm::vec2 uv) {
        const glm::uvec2 texel = glm::min(glm::uvec2(uv * float(level.size)), glm::uvec2(level.size - 1));
        uint32_t t = level.aux[texelIndex(level.size, texel.x, texel.y)].triangle;
        if (t == kNoIndex || data.triangles[t].chart != c.flags >> 16) t = data.charts[c.flags >> 16].firstTriangle;
        const TrianglePlane& plane = data.triangles[t];
        const glm::vec3 p = plane.position + plane.du * (uv.x - plane.uv0.x) + plane.dv * (uv.y - plane.uv0.y);
        return dvec3(glm::vec3(world.toWorld(instance) * glm::vec4(p, 1)));
    };
    return {at(c.a), at(c.b)};
}

}  // namespace

TEST_CASE("a walk goes from the ground up a wall that stands on it, wherever that is, and back") {
    World world;
    const uint32_t ground = world.add(throughFile(plate(2), 512), glm::mat4(1));
    const uint32_t wall = world.add(throughFile(block({0.5, 0.5, 0.2}), 256), glm::mat4(1));
    struct Case {
        glm::vec3 at;
        float turn, scale, groundTurn;
    };
    for (const Case& c : {Case{{0, 0.5f, 0}, 0, 1, 0},
                          {{0.3f, 0.45f, -0.2f}, 0.7f, 1, 0},
                          {{-0.4f, 0.7f, 0.1f}, 2.4f, 1.4f, 0.9f},
                          {{0.1f, 0.2f, 0.3f}, -1.1f, 0.5f, -0.4f}}) {
        CAPTURE(c.turn);
        world.place(ground, standing({0.2f, 0, -0.1f}, c.groundTurn));
        world.place(wall, standing(c.at, c.turn, c.scale));
        world.join();
        const glm::vec3 out(std::sin(c.turn), 0, std::cos(c.turn)), along(out.z, 0, -out.x), up(0, 1, 0);
        const glm::vec3 middle = glm::vec3(c.at.x, 0, c.at.z) + out * (0.2f * c.scale);
        for (float slant : {0.0f, 0.35f, -0.6f}) {
            CAPTURE(slant);
            // From 0.2 m before the wall, aslant; the angle to the line of contact is kept.
            const glm::vec3 heading = glm::normalize(-out + along * slant);
            WalkState w{};
            REQUIRE(world.start(w, ground, middle + out * 0.2f, heading));
            const glm::vec3 from = world.positionOf(w);
            const float ahead = glm::dot(from - middle, out) / glm::dot(-heading, out);
            const glm::vec3 foot = from + heading * ahead;
            const glm::vec3 climb = glm::normalize(up + along * slant);
            glm::vec3 outside(0);
            CHECK(go(world, w, ahead + 0.12f, &outside) == kWalkDone);
            CHECK((w.walk.place >> 16) == wall);
            CHECK(glm::length(world.positionOf(w) - (foot + climb * 0.12f)) < 1e-3f);
            CHECK(glm::length(world.directionOf(w, w.walk.direction) - climb) < 2e-3f);
            CHECK(glm::length(outside - glm::normalize(up + out)) < 0.02f);
            w.walk.direction = -w.walk.direction;
            CHECK(go(world, w, ahead + 0.12f, &outside) == kWalkDone);
            CHECK((w.walk.place >> 16) == ground);
            CHECK(glm::length(world.positionOf(w) - from) < 2e-3f);
            CHECK(glm::length(outside - glm::normalize(up + out)) < 0.02f);
        }
    }
    // Lifted off, or beside the ground, it is met by no walk, and all is as it was baked.
    world.place(wall, standing({0, 3, 0}, 0.3f));
    world.join();
    WalkState w{};
    REQUIRE(world.start(w, ground, {0.1f, 0, 0.6f}, {0, 0, -1}));
    CHECK(go(world, w, 1.2f) == kWalkDone);
    CHECK((w.walk.place >> 16) == ground);
    for (uint32_t i : {ground, wall}) CHECK(walkHash(world.joined(i)) == world.baked(i).hash);
}

TEST_CASE("contacts between placed surfaces are where their triangles intersect") {
    const std::vector<Model> models = {terrain(24), block({0.9, 0.6, 0.15}), block({0.3, 0.8, 0.3})};
    World world;
    for (const Model& model : models) world.add(throughFile(model, 512), glm::mat4(1));
    world.place(1, standing({0.4f, 0.3f, 0.2f}, 0.5f));
    world.place(2, standing({1.1f, 0.2f, -0.3f}, 0.2f));  // runs into the wall and stands in the ground
    world.join();
    std::vector<ContactLine> contacts;
    for (uint32_t i = 0; i < models.size(); ++i)
        for (size_t k = world.baked(i).crossings.size(); k < world.joined(i).crossings.size(); ++k)
            contacts.push_back(inWorld(world, i, world.joined(i).crossings[k]));
    REQUIRE(contacts.size() > 50);
    const Oracle oracle(together(world, models));
    std::vector<ContactLine> lines = oracle.intersections();
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    int seen = 0, crossed = 0, hidden = 0, wrong = 0;
    for (const ContactLine& l : lines) {
        if (glm::length(l.b - l.a) < 0.01) continue;
        const dvec3 p = l.a + (l.b - l.a) * unit(random);
        const bool met =
            std::any_of(contacts.begin(), contacts.end(), [&](const ContactLine& c) { return toLine(p, c) < 0.015; });
        const bool visible = oracle.visible({p, p + (l.b - l.a) * 1e-3});
        (visible ? seen : hidden) += 1;
        crossed += visible && met;
    }
    // And nothing else: each contact lies on an intersection.
    for (const ContactLine& c : contacts) {
        const dvec3 p = (c.a + c.b) * 0.5;
        wrong += std::none_of(lines.begin(), lines.end(), [&](const ContactLine& l) { return toLine(p, l) < 0.015; });
    }
    MESSAGE(lines.size() << " lines, " << contacts.size() << " contacts; " << crossed << " of " << seen
                         << " seen places crossed, " << hidden << " hidden, " << wrong << " contacts elsewhere");
    CHECK(seen > 50);
    CHECK(crossed >= 0.98 * seen);
    CHECK(wrong == 0);
}

TEST_CASE("ground within a closed body that stands on it is buried until that has moved away, and no more than that") {
    // Terrain whose hills a wall stands in, askew, and a pillar that runs into the wall.
    const std::vector<Model> models = {terrain(24), block({0.9, 0.6, 0.15}), block({0.3, 0.8, 0.3})};
    World world;
    for (const Model& model : models) world.add(throughFile(model, 512), glm::mat4(1));
    for (const glm::vec3 at : {glm::vec3(0.4f, 0.3f, 0.2f), glm::vec3(-1.2f, 0.1f, 0.9f)}) {
        world.place(1, standing(at, 0.5f));
        world.place(2, standing(at + glm::vec3(0.7f, -0.1f, -0.5f), 0.2f));
        world.join();
        for (uint32_t instance : {0u, 1u, 2u})
            for (uint32_t l : {0u, 1u}) {
                CAPTURE(instance);
                CAPTURE(l);
                std::vector<Oracle> judges;
                for (uint32_t k : {1u, 2u})
                    if (k != instance) judges.emplace_back(together(world, models, k));
                const SurfaceLevelData &level = world.joined(instance).levels[l],
                                       &baked = world.baked(instance).levels[l];
                const double texel = world.texel(instance) * double(1u << l);
                int within = 0, missed = 0, wrong = 0, altered = 0;
                for (uint32_t i = 0; i < level.texels.size(); ++i) {
                    if (texelClass(baked.texels[i].bits) != kTexelInner) continue;
                    const bool buried = texelClass(level.texels[i].bits) == kTexelLink;
                    altered += !buried && texelClass(level.texels[i].bits) != kTexelInner;
                    const dvec3 p(glm::vec3(world.toWorld(instance) * glm::vec4(baked.texels[i].position, 1)));
                    // A texel or two beside a contact are left as they are.
                    double depth = -1e300;
                    for (const Oracle& judge : judges)
                        depth = std::max(depth, judge.toSurface(p) * (judge.winding(p) > 0.5 ? 1 : -1));
                    within += depth > 2 * texel;
                    missed += depth > 2 * texel && !buried;
                    wrong += depth < -1e-3 * texel && buried;
                }
                MESSAGE("instance " << instance << ", level " << l << ": " << within << " texels are within");
                CHECK(within > 50);
                CHECK(missed == 0);
                CHECK(wrong == 0);
                CHECK(altered == 0);
            }
        // What walks all the same: none gets farther under a wall than to the contact.
        std::mt19937_64 random(3);
        std::uniform_real_distribution<float> unit(-1, 1);
        const Oracle wall(together(world, models, 1)), pillar(together(world, models, 2));
        int inside = 0, lost = 0;
        for (int i = 0; i < 300; ++i) {
            const glm::vec3 from(2.8f * unit(random), 0, 2.8f * unit(random));
            if (wall.winding(dvec3(from)) > 0.5 || pillar.winding(dvec3(from)) > 0.5) continue;
            WalkState w{};
            if (!world.start(w, 0, from, {unit(random), 0, unit(random)})) continue;
            uint32_t event = kWalkDone;
            for (int step = 0; step < 60 && event == kWalkDone; ++step) {
                event = go(world, w, 0.05f);
                const dvec3 p(world.positionOf(w));
                for (const Oracle* judge : {&wall, &pillar})
                    inside += judge->winding(p) > 0.5 && judge->toSurface(p) > 2 * world.texel(0);
            }
            lost += event == kWalkLost;
        }
        CHECK(inside == 0);
        CHECK(lost == 0);
    }
    world.place(1, standing({0, 9, 0}, 0.5f));
    world.place(2, standing({0, -9, 0}, 0.5f));
    world.join();
    for (uint32_t i : {0u, 1u, 2u}) CHECK(walkHash(world.joined(i)) == world.baked(i).hash);
}

TEST_CASE("a walk that gets past a contact finds no ground beyond") {
    World world;
    world.add(throughFile(plate(2), 512), glm::mat4(1));
    world.add(throughFile(block({0.5, 0.5, 0.4}), 256), standing({0, 0.3f, 0}, 0.4f));
    world.join(false);
    WalkState w{};
    REQUIRE(world.start(w, 0, {0.1f, 0, 1.2f}, {0, 0, -1}));
    CHECK(go(world, w, 1.5f) == kWalkLost);
    const double z = 0.4 / std::cos(0.4) - 0.1 * std::tan(0.4);  // of the wall, at x = 0.1
    CHECK(world.positionOf(w).z > z - 4 * world.texel(0));
    // Nor does one that begins there go anywhere.
    if (world.start(w, 0, {0, 0, 0}, {0, 0, -1}, 0, kTexelLink)) CHECK(go(world, w, 0.2f) == kWalkLost);
}

TEST_CASE("walks end where another surface's bare ground stands; it hides what it did, a bare face or none") {
    size_t hidden[3] = {};
    for (int bare : {0, 1, 2}) {  // faces: none, one, all but one
        CAPTURE(bare);
        Model standing = block({0.5, 0.5, 0.5});
        if (bare) test::makeBare(standing, {-9, -9, bare == 1 ? 0.45f : -0.45f}, {9, 9, 9});
        World world;
        world.add(throughFile(plate(2), 512), glm::mat4(1));
        world.add(throughFile(standing, 256), glm::translate(glm::mat4(1), {0, 0.3f, 0}));
        world.join();
        WalkState w{};
        REQUIRE(world.start(w, 0, {0.1f, 0, 1.2f}, {0, 0, -1}));
        CHECK(go(world, w, 1) == (bare ? kWalkOpen : kWalkDone));
        CHECK(world.positionOf(w).y == doctest::Approx(bare ? 0 : 0.3f).epsilon(0.02));
        if (bare) CHECK(world.positionOf(w).z == doctest::Approx(0.5f).epsilon(0.01));
        // The face that never is bare.
        REQUIRE(world.start(w, 0, {0.1f, 0, -1.2f}, {0, 0, 1}));
        CHECK(go(world, w, 1) == kWalkDone);
        CHECK(world.positionOf(w).y == doctest::Approx(0.3f).epsilon(0.02));
        for (const Texel& t : world.joined(0).levels[0].texels)
            hidden[bare] +=
                texelClass(t.bits) == kTexelLink && std::max(std::abs(t.position.x), std::abs(t.position.z)) < 0.5f;
    }
    CHECK(hidden[0] > 1000);
    CHECK(hidden[1] == hidden[0]);
    CHECK(hidden[2] == hidden[0]);
}

TEST_CASE("a contact that overhangs its target leads into the chart, from every part of it") {
    // A board on a box, which it overhangs by less than a texel, so that its outline leads beyond the box's top.
    test::Kit kit;
    kit.box(dvec3(0), {0.5, 0.3, 0.5});
    kit.box({0.2, 0.33, 0.1}, {0.3007, 0.03, 0.4007});
    const SurfaceData data = throughFile(kit.model(), 512);
    const auto inside = [&](glm::dvec2 p) {
        for (size_t i = 0; i + 2 < data.indices.size(); i += 3) {
            int left = 0, right = 0;
            for (size_t k = 0; k < 3; ++k) {
                const glm::dvec2 a(data.vertices[data.indices[i + k]].walkUv),
                    b(data.vertices[data.indices[i + (k + 1) % 3]].walkUv), e = b - a, r = p - a;
                (e.x * r.y - e.y * r.x > -1e-9 ? left : right) += 1;
            }
            if (left == 3 || right == 3) return true;
        }
        return false;
    };
    int contacts = 0, stubs = 0, beside = 0;
    for (const Crossing& c : data.crossings) {
        if ((c.flags & 3u) != kCrossingContact) continue;
        ++contacts;
        const double orientation = data.charts[c.flags >> 16].orientation * data.charts[c.target & 0xFFFFu].orientation;
        const bool left =
            ((c.flags & kCrossingInsideLeft) != 0) == (orientation * ((c.flags & kCrossingTurned) != 0 ? -1 : 1) < 0);
        const glm::dvec2 e(c.tb - c.ta), inward = glm::dvec2(-e.y, e.x) * ((left ? 0.01 : -0.01) / glm::length(e));
        stubs += glm::length(e) * 512 < 0.03;
        for (double t : {0.1, 0.5, 0.9}) beside += !inside(glm::dvec2(c.ta) + e * t + inward / 512.0);
    }
    MESSAGE(contacts << " contacts, " << stubs << " lead to one place");
    CHECK(stubs > 0);
    CHECK(beside == 0);
}

TEST_CASE("ground that a door leads to is not buried, ground behind a closed one is") {
    // A house without a floor; its front is open from x = -door to door.
    const auto house = [](double door) {
        test::Kit kit;
        const dvec3 up(0, 1, 0), z(0, 0, 1);
        const auto wall = [&](dvec3 from, dvec3 to) { kit.panel(from, to - from, up * 0.8); };
        wall({-0.6, 0, -0.5}, {-0.6, 0, 0.5});
        wall({0.6, 0, 0.5}, {0.6, 0, -0.5});
        wall({0.6, 0, -0.5}, {-0.6, 0, -0.5});
        if (door > 0) wall({-0.6, 0, 0.5}, {-door, 0, 0.5}), wall({door, 0, 0.5}, {0.6, 0, 0.5});
        if (door > 0) kit.panel({-door, 0.5, 0.5}, {2 * door, 0, 0}, up * 0.3);
        if (door == 0) wall({-0.6, 0, 0.5}, {0.6, 0, 0.5});
        kit.panel({-0.6, 0.8, 0.5}, {1.2, 0, 0}, -z);
        return kit.model();
    };
    for (double door : {0.0, 0.2}) {
        CAPTURE(door);
        World world;
        world.add(throughFile(plate(2), 512), glm::mat4(1));
        world.add(throughFile(house(door), 256), standing({0, -0.1f, 0}, 0.3f));
        world.join();
        const SurfaceLevelData &level = world.joined(0).levels[0], &baked = world.baked(0).levels[0];
        int buried = 0;
        for (uint32_t i = 0; i < level.texels.size(); ++i)
            buried += texelClass(level.texels[i].bits) == kTexelLink && texelClass(baked.texels[i].bits) == kTexelInner;
        const double within = 1.2 * 1.0 / (world.texel(0) * world.texel(0));
        MESSAGE(buried << " of " << within << " texels are buried");
        CHECK((door > 0 ? buried == 0 : buried > 0.93 * within && buried < within));
    }
}

TEST_CASE("lists and clearances tell of added crossings") {
    World world;
    world.add(throughFile(terrain(12), 256), glm::mat4(1));
    world.add(throughFile(block({0.9, 0.6, 0.15}), 256), standing({0.4f, 0.3f, 0.2f}, 0.5f));
    world.join();
    for (uint32_t instance : {0u, 1u})
        for (uint32_t l : {0u, 1u}) {
            const SurfaceData& data = world.joined(instance);
            const SurfaceLevelData &level = data.levels[l], &baked = world.baked(instance).levels[l];
            const int size = int(level.size);
            std::vector<glm::ivec2> listing;
            int missing = 0, far = 0, lost = 0;
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x)
                    if ((level.crossingHead[texelIndex(level.size, uint32_t(x), uint32_t(y))] & 255u) != 0)
                        listing.push_back({x, y});
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    const uint32_t at = texelIndex(level.size, uint32_t(x), uint32_t(y));
                    const uint32_t bits = level.texels[at].bits, was = baked.texels[at].bits;
                    const bool buried = texelClass(bits) == kTexelLink && texelClass(was) == kTexelInner;
                    lost += (bits ^ was) & ~(31u << 19 | (buried ? 3u << 16 : 0u)) ? 1 : 0;
                    int nearest = 64;
                    for (glm::ivec2 p : listing)
                        nearest = std::min(nearest, std::max(std::abs(p.x - x), std::abs(p.y - y)));
                    const int expected = std::min({int(texelClearance(was)), std::max(nearest - 1, 0), 31});
                    if (texelClass(bits) != kTexelEmpty) far += int(texelClearance(bits)) != expected;
                    for (uint32_t k = 0; k < (baked.crossingHead[at] & 255u); ++k)
                        lost += level.crossingRefs[(level.crossingHead[at] >> 8) + k] !=
                                baked.crossingRefs[(baked.crossingHead[at] >> 8) + k];
                }
            // Points of the crossings, each in a texel that lists it.
            for (size_t i = world.baked(instance).crossings.size(); i < data.crossings.size(); ++i)
                for (float t : {0.0f, 0.31f, 0.5f, 1.0f}) {
                    const Crossing& c = data.crossings[i];
                    const uint32_t at = texelAt(level.size, c.a + (c.b - c.a) * t);
                    if (texelChart(level.texels[at].bits) != c.flags >> 16) continue;
                    const uint32_t head = level.crossingHead[at];
                    bool listed = false;
                    for (uint32_t k = 0; k < (head & 255u); ++k)
                        listed = listed || level.crossingRefs[(head >> 8) + k] == i;
                    missing += !listed;
                }
            CHECK(data.crossings.size() > world.baked(instance).crossings.size() + 8);
            CHECK(missing == 0);
            CHECK(far == 0);
            CHECK(lost == 0);
        }
}

TEST_CASE("a body of which nothing is drawn has ground that others bury, and buries none") {
    test::Kit kit;
    kit.box(dvec3(0), dvec3(0.2));
    kit.box(dvec3(2, 0, 0), dvec3(0.2));
    SurfaceData data = throughFile(kit.model(), 128);
    // Left of the mesh is the box whose charts come first.
    const bool firstIsLeft = data.triangles[data.charts[0].firstTriangle].position.x < 1;
    const auto isFirst = [&](glm::vec3 p) { return (p.x < 1) == firstIsLeft; };
    std::vector<uint32_t> drawn;
    for (size_t i = 0; i < data.indices.size(); i += 3)
        if (isFirst(data.vertices[data.indices[i]].position))
            drawn.insert(drawn.end(), &data.indices[i], &data.indices[i] + 3);
    data.indices = drawn;
    const ContactGround ground(data);
    CHECK(ground.bodyCount() == 2);
    for (uint32_t c = 0; c < data.charts.size(); ++c)
        CHECK(ground.solidChart(c) == isFirst(data.triangles[data.charts[c].firstTriangle].position));
    World world;
    world.add(data, glm::mat4(1));
    world.add(throughFile(block(dvec3(0.5)), 128), standing({firstIsLeft ? 2 : 0, 0, 0}, 0));
    world.join();
    const std::vector<Texel>&now = world.joined(0).levels[0].texels, &before = world.baked(0).levels[0].texels;
    int wrong = 0, buried = 0;
    for (size_t i = 0; i < now.size(); ++i) {
        if (texelClass(before[i].bits) != kTexelInner) continue;
        buried += texelClass(now[i].bits) == kTexelLink;
        wrong += (texelClass(now[i].bits) == kTexelLink) == isFirst(before[i].position);
    }
    CHECK(buried > 1000);
    CHECK(wrong == 0);
}
