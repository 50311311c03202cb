// edit/…: what a dab of the brush costs beside growing everything anew, on a real model with more than a thousand seeds
// and half a million nodes. How much a dab invalidates is counted on the records by other means than growth's own: the
// nodes whose place lies in the dab, all after them on their branches, and all branches that leave these.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "shaders/shared/exact.h"
#include "shaders/shared/random.h"
#include "tools/bench/bench.hpp"
#include "tools/bench/bench_scene.hpp"

namespace espalier {
namespace {

constexpr uint32_t kSeeds = 1200, kTexels = 1024;

// Ivy that a mask leads; bark thins towards tips, so that it depends on where its branch ends.
std::string maskedGrammar(float step) {
    char text[1024];
    std::snprintf(text, sizeof text, R"(
context mask = 1
param stride = %g [0 .. 10] "m" "Step"
Stem(n) -> Marching(stride, rand(-0.2, 0.2), mask(texCoord) > 0.5 and n < 70) {Fork(n + 1), Cover}
Fork(n) -> Branch(2) {Twig(0, rand(4, 24)), Stem(n)} : 0.4
Fork(n) -> Stem(n) : 0.6
Twig(n, k) -> Marching(stride, rand(-0.5, 0.5), mask(texCoord) > 0.5 and n < k) {Twig(n + 1, k), Cover}
Cover -> Bark Leaves
Bark -> S(stride * (0.05 + 0.2 * clamp(toTip / stride / 70, 0, 1))) Shape("bark", C1)
Leaves -> Repeat(1) { T(rand(), 0) R(rand(-1, 1), 0.4) S(stride) Shape("leaf") }
)",
                  double(step));
    return text;
}

struct Dab {
    glm::vec2 at{0};   // texels
    float radius = 0;  // texels
    bool touches(glm::vec2 uv, float reach) const { return glm::length(uv * float(kTexels) - at) < radius + reach; }
};

// A growth's nodes in the order of their branches, to count what follows from a place.
struct Census {
    std::vector<std::vector<uint32_t>> branches;  // nodes in order
    std::vector<uint32_t> joints, order;          // of each branch; branches, parents first
    std::vector<glm::vec2> uvs;
    std::vector<uint32_t> branchOf, placeOf;  // of each node

    explicit Census(const GrowthRecords& g) {
        branches.resize(g.branches.size());
        joints.assign(g.branches.size(), kNoIndex);
        branchOf.assign(g.nodes.size(), kNoIndex);
        placeOf.assign(g.nodes.size(), 0);
        for (const Node& node : g.nodes) uvs.push_back(unpackUv(node.uv));
        for (uint32_t b = 0; b < g.branches.size(); ++b) {
            if (g.branches[b].firstChunk == kNoIndex) continue;
            order.push_back(b);
            joints[b] = g.chunks[g.branches[b].firstChunk].previousNode;
            for (uint32_t c = g.branches[b].firstChunk; c != kNoIndex; c = g.chunks[c].next)
                for (uint32_t i = 0; i < chunkNodes(g.chunks[c].marks); ++i) {
                    branchOf[g.chunks[c].firstNode + i] = b;
                    placeOf[g.chunks[c].firstNode + i] = uint32_t(branches[b].size());
                    branches[b].push_back(g.chunks[c].firstNode + i);
                }
        }
        const auto depth = [&](uint32_t b) { return g.chunks[g.branches[b].firstChunk].depth & 0xFFFF; };
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return depth(a) < depth(b); });
    }

    uint32_t invalidatedBy(const Dab& dab) const {
        std::vector<uint32_t> from(branches.size(), kNoIndex);  // the first node of it that is invalidated
        uint32_t count = 0;
        for (uint32_t b : order) {
            const uint32_t joint = joints[b];
            bool whole = joint != kNoIndex && from[branchOf[joint]] <= placeOf[joint];
            uint32_t first = 0;
            while (!whole && first < branches[b].size() && !dab.touches(uvs[branches[b][first]], 1)) ++first;
            if (first < branches[b].size()) {
                from[b] = first;
                count += uint32_t(branches[b].size()) - first;
            }
        }
        return count;
    }

    // Of many dabs the one that invalidates what is nearest to `wanted` nodes.
    Dab dabFor(double wanted) const {
        Dab best;
        double least = 1e30;
        uint64_t key = 5;
        for (uint32_t i = 0; i < 160; ++i) {
            key = mix64(key);
            const uint32_t b = order[size_t(double(uniformRandom(key, 1)) * double(order.size()))];
            if (branches[b].empty()) continue;
            const uint32_t node = branches[b][size_t(double(uniformRandom(key, 2)) * double(branches[b].size()))];
            const Dab dab{uvs[node] * float(kTexels),
                          2 + 60 * uniformRandom(key, 3) * uniformRandom(key, 4) * float(std::sqrt(wanted / 5000))};
            const double miss = std::abs(std::log((invalidatedBy(dab) + 1) / wanted));
            if (miss < least) {
                least = miss;
                best = dab;
            }
        }
        return best;
    }
    // On the stem of a plant, where it has hardly left its seed.
    Dab dabOnTrunk() const {
        uint32_t most = order.front();
        for (uint32_t b : order)
            if (joints[b] == kNoIndex && branches[b].size() > branches[most].size()) most = b;
        return {uvs[branches[most][std::min<size_t>(3, branches[most].size() - 1)]] * float(kTexels), 2};
    }
};

class EditBench {
  public:
    EditBench(Bench& bench, BenchScene& scene, Growth& growth) : bench_(bench), scene_(scene), growth_(growth) {
        texels_.assign(size_t(kTexels) * kTexels, 1.0f);
    }

    bool growAll() {
        scene_.changes = nullptr;
        return bool(scene_.grow(growth_));
    }

    void measure(const std::string& name, const Dab& dab, const Census& census) {
        std::vector<double> again, whole;
        const uint32_t invalidated = census.invalidatedBy(dab);
        const uint32_t nodes = growth_.stats().nodes;
        uint32_t derived = 0;
        bool partly = true;
        for (int i = -1; i < bench_.options().repeats; ++i) {
            for (float value : {0.0f, 1.0f}) {
                GrowthChanges changes = paint(dab, value);
                scene_.changes = &changes;
                const uint32_t regrowths = growth_.stats().regrowths;
                const double time = cpuSeconds([&] { (void)scene_.grow(growth_); });
                // Taking what was there away is what the records foretold; putting it back derives as much.
                if (value == 1.0f) derived = growth_.stats().derived;
                partly = partly && growth_.stats().regrowths > regrowths;
                if (i >= 0) again.push_back(time);
            }
            const double time = cpuSeconds([&] { (void)growAll(); });
            if (i >= 0) whole.push_back(time);
        }
        char figure[96];
        std::snprintf(figure, sizeof figure, "a dab that invalidates %.2f %% of %u nodes%s",
                      100.0 * invalidated / nodes, nodes, partly ? "" : " (GROWN ANEW)");
        bench_.add({name, figure, "CPU ms", 1e3 * median(again), "everything anew", 1e3 * median(whole)});
        bench_.add({name + "/derived", "nodes derived", "nodes", double(derived), "invalidated", double(invalidated)});
    }

    void measureUnchanged() {
        GrowthChanges none;
        none.everything = false;
        scene_.changes = &none;
        const uint32_t expansions = growth_.stats().expansions;
        const double time = seconds([&] {
            for (int i = 0; i < 100; ++i) (void)scene_.grow(growth_);
        });
        bench_.add({"edit/unchanged", "a frame without edits", "us", 1e4 * time, "expansions, times 1 us",
                    double(growth_.stats().expansions - expansions)});
    }

  private:
    GrowthChanges paint(const Dab& dab, float value) {
        glm::ivec2 low = glm::max(glm::ivec2(dab.at - dab.radius), 0);
        glm::ivec2 high = glm::min(glm::ivec2(dab.at + dab.radius) + 1, int(kTexels));
        for (int y = low.y; y < high.y; ++y)
            for (int x = low.x; x < high.x; ++x)
                if (glm::length(glm::vec2(x, y) + 0.5f - dab.at) < dab.radius)
                    texels_[texelIndex(kTexels, uint32_t(x), uint32_t(y))] = value;
        (void)scene_.paint(0, kTexels, texels_);
        GrowthChanges changes;
        changes.everything = false;
        changes.markTexels(0, 0, kTexels, uint32_t(low.x), uint32_t(low.y), uint32_t(high.x), uint32_t(high.y));
        return changes;
    }

    Bench& bench_;
    BenchScene& scene_;
    Growth& growth_;
    std::vector<float> texels_;
};

}  // namespace

void editCases(Bench& bench) {
    const std::string name = "edit/";
    const std::pair<const char*, double> shares[] = {{"dab-0.1", 0.001}, {"dab-1", 0.01}, {"dab-10", 0.1}};
    bool wanted = bench.wants("edit/dab-trunk") || bench.wants("edit/unchanged");
    for (const auto& [row, share] : shares) wanted = wanted || bench.wants(name + row);
    if (!wanted) return;
    const std::string path = bench.options().dataFolder + "/derived/bunny_unwrap.glb";
    Result<std::unique_ptr<Device>> device = Device::create();
    if (!device) return bench.skip(name, device.failure().text());
    Result<std::unique_ptr<Growth>> growth = Growth::create(**device);
    auto scene = BenchScene::create(**device, path, kTexels);
    if (!growth || !scene) return bench.skip(name, "needs " + path);
    if (!scene->setGrammar(maskedGrammar(2.2f * scene->texelMetres()))) return;
    scene->plant(kSeeds);
    EditBench edits(bench, *scene, **growth);
    if (!scene->paint(0, kTexels, std::vector<float>(size_t(kTexels) * kTexels, 1.0f)) || !edits.growAll()) return;
    Result<GrowthRecords> records = (*growth)->read();
    if (!records) return bench.skip(name, records.failure().text());
    const Census census(*records);
    for (const auto& [row, share] : shares)
        if (bench.wants(name + row)) edits.measure(name + row, census.dabFor(share * (*growth)->stats().nodes), census);
    if (bench.wants("edit/dab-trunk")) edits.measure(name + "dab-trunk", census.dabOnTrunk(), census);
    if (bench.wants("edit/unchanged")) edits.measureUnchanged();
}

}  // namespace espalier
