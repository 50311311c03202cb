// Frames and leaves side by side in the processor's vectors against the same one by one.
#include <cstring>
#include <random>

#include <doctest/doctest.h>

#include "runtime/host/wide_nodes.hpp"
#include "shaders/shared/expand_terminals.h"

using namespace espalier;

namespace {

constexpr int kRounds = 400;

// Most of them within a metre; now and then what is at the edge of floats.
struct Numbers {
    std::mt19937_64 random{7};
    float operator()() {
        constexpr float kEdges[] = {0, -0.0f, 1, -1, 1e-30f, -1e-38f, 1e9f, -1e9f, 61, 9.765625e-4f};
        if (random() % 8 == 0) return kEdges[random() % std::size(kEdges)];
        return std::uniform_real_distribution<float>(-1, 1)(random);
    }
    vec3 vector() { return {(*this)(), (*this)(), (*this)()}; }
};

void put(WideStems::Vectors& to, uint32_t i, vec3 v) {
    to.x[i] = v.x;
    to.y[i] = v.y;
    to.z[i] = v.z;
}
vec3 vectorOf(const WideStems::Vectors& v, uint32_t i) {
    return {v.x[i], v.y[i], v.z[i]};
}
bool same(vec3 a, vec3 b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

TEST_CASE("frames side by side come to the bit where one by one they come") {
    Numbers number;
    WideStems wide = {};
    for (int round = 0; round < kRounds; ++round) {
        vec3 before[kNodeLanes], at[kNodeLanes], after[kNodeLanes], branches[kNodeLanes];
        for (uint32_t i = 0; i < kNodeLanes; ++i) {
            at[i] = number.vector();
            before[i] = number.random() % 8 == 0 ? at[i] : number.vector();  // feet and tips stand for their neighbours
            after[i] = number.random() % 8 == 0 ? before[i] : number.vector();
            branches[i] = number.random() % 2 == 0 ? vec3(0) : number.vector();
            put(wide.before, i, before[i]);
            put(wide.at, i, at[i]);
            put(wide.after, i, after[i]);
            put(wide.branches, i, branches[i]);
            wide.packedNormal[i] = uint32_t(number.random());
            wide.packedHeading[i] = uint32_t(number.random());
        }
        frameStems(wide);
        for (uint32_t i = 0; i < kNodeLanes; ++i) {
            const StemFrame f =
                stemFrame(before[i], at[i], after[i], branches[i], wide.packedNormal[i], wide.packedHeading[i]);
            CHECK(same(vectorOf(wide.normal, i), f.normal));
            CHECK(same(vectorOf(wide.heading, i), f.heading));
            CHECK(wide.tangent[i] == f.tangent);
        }
    }
}

TEST_CASE("leaves side by side are packed as one by one") {
    Numbers number;
    WideLeaves wide = {};
    for (int round = 0; round < kRounds; ++round) {
        LeafDraft drafts[kLeafLanes];
        for (uint32_t i = 0; i < kLeafLanes; ++i) {
            LeafDraft& d = drafts[i];
            d = {number(), number(), number() + 0.5f, number(), 4 * number(), 2 * number(), number(), 0, 0, 0};
            d.mesh = uint32_t(number.random());
            d.colour = uint32_t(number.random()) & 0x00FFFF00u;
            d.word = uint32_t(number.random());
            wide.along[i] = d.along;
            wide.span[i] = d.span;
            wide.size[i] = d.size;
            wide.lift[i] = d.lift;
            wide.turn[i] = d.turn;
            wide.pitch[i] = d.pitch;
            wide.tint[i] = d.tint;
            wide.mesh[i] = d.mesh;
            wide.colour[i] = d.colour;
            wide.word[i] = d.word;
        }
        packLeaves(wide);
        for (uint32_t i = 0; i < kLeafLanes; ++i) {
            const Leaf leaf = leafOf(drafts[i]);
            CHECK(wide.packedPlace[i] == leaf.place);
            CHECK(wide.packedPose[i] == leaf.pose);
            CHECK(wide.packedTint[i] == leaf.tint);
        }
    }
}
