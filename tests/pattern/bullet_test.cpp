// What stands and what fell against Bullet's collision detection, over all pairs.
#ifdef ESPALIER_BULLET
#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/pattern/scene.hpp"

using namespace espalier;
using patterntest::Scene;

namespace {

// Deeper than this two pieces run through each other; less, or less apart, they merely touch. Metres.
constexpr float kTouch = 2e-5f;

btVector3 toBullet(vec3 v) {
    return {v.x, v.y, v.z};
}

// A piece where it stands, for Bullet: its surface, and of a box also the solid.
class Body {
  public:
    Body(const Scene& scene, const PatternPiece& piece) : isBox((piece.mesh & 0xFFFFu) == 0) {
        const PatternMesh& mesh = scene.meshes().meshes[piece.mesh & 0xFFFFu];
        const auto corner = [&](uint32_t i) {
            const vec3 v = scene.meshes().corners[mesh.firstVertex + i];
            return toBullet(piece.x * v.x + piece.y * v.y + piece.z * v.z);
        };
        for (uint32_t t = 0; t < mesh.triangleCount; ++t)
            triangles_.addTriangle(corner(3 * t), corner(3 * t + 1), corner(3 * t + 2));
        const btTransform place(btMatrix3x3::getIdentity(), toBullet(piece.position));
        surface_ = std::make_unique<btGImpactMeshShape>(&triangles_);
        surface_->setMargin(0);
        surface_->updateBound();
        surface.setCollisionShape(surface_.get());
        surface.setWorldTransform(place);
        surface_->getAabb(place, low, high);
        if (isBox) makeSolid(piece);
    }

    const bool isBox;
    btCollisionObject surface, solid;
    btVector3 low, high;

  private:
    void makeSolid(const PatternPiece& piece) {
        const vec3 sides(glm::length(piece.x), glm::length(piece.y), glm::length(piece.z));
        const vec3 x = piece.x / sides.x, y = piece.y / sides.y, z = piece.z / sides.z;
        const btMatrix3x3 turn(x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z);
        solid_ = std::make_unique<btBoxShape>(toBullet(sides / 2.f));
        solid_->setMargin(0);
        solid.setCollisionShape(solid_.get());
        solid.setWorldTransform(btTransform(turn, toBullet(piece.position + piece.y * .5f)));
    }

    btTriangleMesh triangles_;
    std::unique_ptr<btGImpactMeshShape> surface_;
    std::unique_ptr<btBoxShape> solid_;
};

class Bullet {
  public:
    Bullet() : dispatcher_(&configuration_), world_(&dispatcher_, &broadphase_, &configuration_) {
        // Bullet tests pairs by algorithms that are registered apart. Its standard one for convex shapes takes gaps of
        // 0.05 mm between edges of boxes for depths; those for boxes and for surfaces don't.
        dispatcher_.registerClosestPointsCreateFunc(
            BOX_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE,
            configuration_.getCollisionAlgorithmCreateFunc(BOX_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE));
        for (int i = 0; i < MAX_BROADPHASE_COLLISION_TYPES; ++i) {
            dispatcher_.registerClosestPointsCreateFunc(GIMPACT_SHAPE_PROXYTYPE, i, &surfaces_);
            dispatcher_.registerClosestPointsCreateFunc(i, GIMPACT_SHAPE_PROXYTYPE, &surfaces_);
        }
    }

    // How deep two bodies run into each other, metres; negative: they don't.
    float depth(Body& a, Body& b) {
        for (int i = 0; i < 3; ++i)
            if (a.low[i] > b.high[i] || b.low[i] > a.high[i]) return -1;
        Deepest deepest;
        const bool solid = a.isBox && b.isBox;
        world_.contactPairTest(solid ? &a.solid : &a.surface, solid ? &b.solid : &b.surface, deepest);
        return deepest.depth;
    }

  private:
    struct Deepest : btCollisionWorld::ContactResultCallback {
        float depth = -1;
        btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                                 const btCollisionObjectWrapper*, int, int) override {
            depth = std::max(depth, -float(point.getDistance()));
            return 0;
        }
    };

    btGImpactCollisionAlgorithm::CreateFunc surfaces_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broadphase_;
    btCollisionWorld world_;
};

// What a production tried: of each mesh one set.
struct Tried {
    std::vector<std::unique_ptr<Body>> bodies[2];
    bool stands[2] = {};
};

struct Judgement {
    size_t standing = 0, fallen = 0, culled = 0, pairs = 0, meeting = 0, unfounded = 0, touching = 0;
};

// A production of these grammars has a colour of its own, and also places by I, which meets nothing, what it tries. So
// the free pieces tell what was tried. A ring stands behind the boxes of its production.
Judgement judge(const std::string& grammar) {
    Scene scene(patterntest::torus(2, .7f), 256);
    scene.addGrammar(grammar);
    scene.plant({1.3f, 0, .2f}, {1, 0, .3f});
    std::map<uint32_t, Tried> productions;
    std::vector<std::unique_ptr<Body>> standing;
    for (const PatternPiece& p : scene.grow(2).pieces) {
        Tried& tried = productions[p.colour];
        const uint32_t mesh = p.mesh & 0xFFFFu;
        const bool free = (p.mesh & kPieceFree) != 0;
        (free ? tried.bodies[mesh] : standing).push_back(std::make_unique<Body>(scene, p));
        if (!free) tried.stands[mesh] = true;
    }
    Bullet bullet;
    Judgement all;
    all.standing = standing.size();
    const auto note = [&](float depth, const std::string& what) {
        all.touching += std::abs(depth) <= kTouch;
        if (std::abs(depth) <= kTouch) MESSAGE(what << " touch, depth " << depth << " m");
    };
    for (size_t i = 0; i < standing.size(); ++i)
        for (size_t j = i + 1; j < standing.size(); ++j) {
            const float depth = bullet.depth(*standing[i], *standing[j]);
            note(depth, "pieces " + std::to_string(i) + " and " + std::to_string(j) + " that stand");
            ++all.pairs;
            all.meeting += depth > kTouch;
            if (depth > kTouch) MESSAGE("pieces " << i << " and " << j << " meet, depth " << depth << " m");
        }
    for (const auto& [colour, tried] : productions)
        for (const uint32_t mesh : {0u, 1u}) {
            if (tried.bodies[mesh].empty() || tried.stands[mesh]) continue;
            const bool culled = mesh == 1 && !tried.bodies[0].empty() && !tried.stands[0];
            float deepest = -1;
            for (const auto& body : tried.bodies[mesh])
                for (const auto& other : standing) deepest = std::max(deepest, bullet.depth(*body, *other));
            if (!culled) note(deepest, "set " + std::to_string(colour) + " that fell and one that stands");
            ++all.fallen;
            all.culled += culled;
            all.unfounded += !culled && deepest < -kTouch;
        }
    return all;
}

}  // namespace

TEST_CASE("Bullet finds no two placed pieces that meet, and for every set that fell a placed piece that it meets") {
    const std::string begin = "angles degrees\nA -> C(rand(), rand(), rand())\n";
    const struct {
        std::string name, rules;
    } rows[] = {{"rings",
                 "C(r, g, b) -> [S(0.31, 0.31, 0.19) Colour(r, g, b) I(\"ring\")] D(r, g, b)\n"
                 "    [T(0.2, 0, 0) Rz(61) T(0.2, 0, 0) A] [T(0.2, 0, 0) Rz(-61) T(0.2, 0, 0) A]\n"
                 "D(r, g, b) -> S(0.31, 0.31, 0.19) Colour(r, g, b) IC(\"ring\")"},
                {"boxes of many sizes",
                 "C(r, g, b) -> [Rz(80 * r) S(0.08 + 0.2 * g, 0.06 + 0.14 * b, 0.1) Colour(r, g, b) I(\"box\")]\n"
                 "    D(r, g, b) [T(0.23, 0, 0) A] [Rz(131) T(0.27, 0, 0) A] [Rz(-119) T(0.25, 0, 0) A]\n"
                 "D(r, g, b) -> Rz(80 * r) S(0.08 + 0.2 * g, 0.06 + 0.14 * b, 0.1) Colour(r, g, b) IC(\"box\")"},
                {"locked boxes and rings behind them",
                 "C(r, g, b) -> [S(0.13) Colour(r, g, b) I(\"box\") T(0.2, 0, 0) Rz(30) I(\"box\")]\n"
                 "    [T(-0.2, 0, 0) S(0.15) Colour(r, g, b) I(\"ring\")] D(r, g, b)\n"
                 "D(r, g, b) -> Colour(r, g, b) S(0.13) Lock { IC(\"box\") | [T(0.2, 0, 0) Rz(30) IC(\"box\")] }\n"
                 "    [T(0.42, 0, 0) Rz(20) A] [Rz(100) T(0.3, 0, 0) A] [Rz(-117) T(0.35, 0, 0) Rz(9) A]\n"
                 "    T(-0.2, 0, 0) S(0.15) IC(\"ring\") [Rz(160) T(0.2, 0, 0) A]"}};
    for (const auto& row : rows) {
        const Judgement j = judge(begin + row.rules);
        MESSAGE(row.name << ": " << j.standing << " stand, " << j.fallen << " sets fell, " << j.culled
                         << " of them culled, " << j.pairs << " pairs, " << j.meeting << " meet, " << j.unfounded
                         << " fell without reason, " << j.touching << " touch");
        CHECK(j.standing > 100);
        CHECK(j.fallen > 50);
        CHECK(j.meeting == 0);
        CHECK(j.unfounded == 0);
        CHECK(double(j.touching) < 1e-4 * double(j.pairs));
    }
}
#endif
