// Versions of nodes: what a change is pushed to, what is due, and what is told apart.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "runtime/graph/node.hpp"

using namespace espalier;

namespace {

// A small scene: two things that plants are made from, one that only roofs are, and a picture of both.
struct Scene {
    graph::Node seeds, rules, town;
    graph::Node plants{&seeds, &rules}, roofs{&town, &rules};
    graph::Node picture{&plants, &roofs};
    std::array<graph::Node*, 3> derived{&plants, &roofs, &picture};
    Scene() {
        for (graph::Node* node : derived) node->made();
    }
};

}  // namespace

TEST_CASE("what was never made is due, and what was made isn't until an input changes") {
    graph::Node input;
    graph::Node output{&input};
    CHECK(output.due());
    output.made();
    CHECK_FALSE(output.due());
    const Version before = output.version();
    const Version change = input.change();
    CHECK(change > before);
    CHECK(output.version() == change);
    CHECK(input.version() == change);
    CHECK(output.due());
    output.made();
    CHECK_FALSE(output.due());
}

TEST_CASE("a change reaches all that is made from a node, and nothing else") {
    Scene scene;
    const Version town = scene.town.version(), roofs = scene.roofs.version();
    const Version change = scene.seeds.change();
    CHECK(scene.plants.version() == change);
    CHECK(scene.picture.version() == change);
    CHECK(scene.roofs.version() == roofs);
    CHECK(scene.town.version() == town);
    CHECK(scene.plants.due());
    CHECK(scene.picture.due());
    CHECK_FALSE(scene.roofs.due());
    // By two ways.
    scene.plants.made();
    const Version rules = scene.rules.change();
    for (const graph::Node* node : scene.derived) CHECK(node->version() == rules);
}

TEST_CASE("what a node can't be made from stays due, and what is made in vain doesn't change others") {
    Scene scene;
    scene.town.change();
    scene.plants.made();  // of nothing new
    CHECK(scene.roofs.due());
    CHECK(scene.picture.due());
    scene.picture.made();  // by the roofs that stand
    CHECK(scene.roofs.due());
    CHECK_FALSE(scene.picture.due());
}

TEST_CASE("a node that is made from others may change by itself") {
    Scene scene;
    scene.plants.change();
    CHECK(scene.plants.due());
    CHECK(scene.picture.version() == scene.plants.version());
    CHECK(scene.seeds.version() < scene.plants.version());
}

TEST_CASE("no two changes have the same version, whatever they are of") {
    std::vector<Version> all;
    {
        graph::Node a, b;
        for (int i = 0; i < 3; ++i) all.insert(all.end(), {a.change(), b.change(), nextVersion()});
    }
    graph::Node later;  // perhaps where one of them was
    all.push_back(later.version());
    CHECK(std::ranges::is_sorted(all));
    CHECK(std::ranges::adjacent_find(all) == all.end());
    CHECK(all.front() > 0);
}

TEST_CASE("nodes that go are told no more") {
    graph::Node input;
    graph::Node stays{&input};
    std::optional<graph::Node> goes(std::in_place, std::initializer_list<graph::Node*>{&input});
    goes.reset();
    stays.made();
    const Version change = input.change();
    CHECK(stays.version() == change);
}

TEST_CASE("long chains and wide ones are told without end or stack") {
    constexpr size_t kNodes = 100'000;
    std::vector<std::unique_ptr<graph::Node>> chain;
    chain.push_back(std::make_unique<graph::Node>());
    while (chain.size() < kNodes)
        chain.push_back(std::make_unique<graph::Node>(
            std::initializer_list<graph::Node*>{chain.back().get(), chain[chain.size() / 2].get()}));
    const Version change = chain.front()->change();
    CHECK(std::ranges::all_of(chain, [&](const auto& node) { return node->version() == change; }));
    while (!chain.empty()) chain.pop_back();
}

TEST_CASE("versions of threads are unlike each other") {
    std::vector<Version> versions[2];
    const auto count = [](std::vector<Version>& out) {
        graph::Node node;
        for (int i = 0; i < 10'000; ++i) out.push_back(node.change());
    };
    std::thread other(count, std::ref(versions[1]));
    count(versions[0]);
    other.join();
    std::vector<Version> both;
    std::ranges::merge(versions[0], versions[1], std::back_inserter(both));
    CHECK(std::ranges::adjacent_find(both) == both.end());
}
