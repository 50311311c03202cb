// edit/…: what a dab of the brush costs beside growing everything anew, on a real model with more than a thousand seeds
// and half a million nodes. What is timed is growth: painting, binding and drawing are frame/….
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "shaders/shared/exact.h"
#include "shaders/shared/random.h"
#include "tools/bench/bench.hpp"
#include "tools/bench/bench_scene.hpp"
#include "tools/bench/census.hpp"

namespace espalier {
namespace {

constexpr uint32_t kSeeds = 1200, kTexels = 1024;
constexpr size_t kDabs = 12;  // of a size

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

// The same with a shoot here and there, which turns by `bend` at every step.
std::string shootGrammar(float step, float bend) {
    char rules[160];
    std::snprintf(rules, sizeof rules, R"(Fork(n) -> Branch(2) {Shoot(0), Stem(n)} : 0.02
Shoot(n) -> Marching(stride, %g, n < 12) {Shoot(n + 1), Cover}
)",
                  double(bend));
    return maskedGrammar(step) + rules;
}

constexpr float kTexel = 1.0f / kTexels;

uint32_t invalidatedBy(const Dab& dab, const Census& census) {
    return census.invalidatedBy(dab, kTexel);
}

// Draws dabs that invalidate what is asked for.
class Dabs {
  public:
    explicit Dabs(const Census& census) : census_(census) {}

    // Of so many dabs, drawn by `number`, the one that invalidates what is nearest to `wanted` nodes.
    Dab one(double wanted, uint32_t dabs, uint64_t number) const {
        Dab best;
        double least = 1e30;
        uint64_t key = number;
        for (uint32_t i = 0; i < dabs; ++i) {
            key = mix64(key);
            const auto& order = census_.order;
            const auto& nodes = census_.branches[order[size_t(double(uniformRandom(key, 1)) * double(order.size()))]];
            if (nodes.empty()) continue;
            const uint32_t node = nodes[size_t(double(uniformRandom(key, 2)) * double(nodes.size()))];
            const float wide = uniformRandom(key, 3) * uniformRandom(key, 4) * float(std::sqrt(wanted / 5000));
            const Dab dab{census_.uvs[node], (2 + 60 * wide) * kTexel};
            const double miss = std::abs(std::log((invalidatedBy(dab, census_) + 1) / wanted));
            if (miss < least) {
                least = miss;
                best = dab;
            }
        }
        return best;
    }
    std::vector<Dab> about(double wanted) const {
        std::vector<Dab> dabs{one(wanted, 160, 5)};
        while (dabs.size() < kDabs) dabs.push_back(one(wanted, 40, 5 + dabs.size()));
        return dabs;
    }
    // On the longest stems, where they have hardly left their seeds.
    std::vector<Dab> onTrunks() const {
        const auto& branches = census_.branches;
        std::vector<uint32_t> stems;
        for (uint32_t b : census_.order)
            if (census_.joints[b] == kNoIndex && !branches[b].empty()) stems.push_back(b);
        std::stable_sort(stems.begin(), stems.end(),
                         [&](uint32_t a, uint32_t b) { return branches[a].size() > branches[b].size(); });
        stems.resize(std::min<size_t>(stems.size(), kDabs));
        std::vector<Dab> dabs;
        for (uint32_t b : stems)
            dabs.push_back({census_.uvs[branches[b][std::min<size_t>(3, branches[b].size() - 1)]], 2 * kTexel});
        return dabs;
    }

  private:
    const Census& census_;
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

    void measure(const std::string& name, const std::vector<Dab>& dabs, const Census& census) {
        const Timed timed = time(dabs);
        const uint32_t nodes = growth_.stats().nodes;
        const double all = median(timed.whole);
        std::vector<double> again, regrown, shares;
        double worst = 0, worstShare = 0;  // by what a dab of its share may cost
        for (size_t i = 0; i < dabs.size(); ++i) {
            const auto& [cut, grown] = timed.dabs[i];
            const double share = double(invalidatedBy(dabs[i], census)) / nodes;
            const double cost = std::max(median(cut), median(grown));
            if (cost / (share + 0.02) > worst / (worstShare + 0.02)) worst = cost, worstShare = share;
            shares.push_back(100 * share);
            again.insert(again.end(), cut.begin(), cut.end());
            again.insert(again.end(), grown.begin(), grown.end());
            regrown.insert(regrown.end(), grown.begin(), grown.end());
        }
        char figure[96];
        std::snprintf(figure, sizeof figure, "dabs that invalidate %.2f %% of %u nodes%s", median(shares), nodes,
                      timed.partly ? "" : " (GROWN ANEW)");
        bench_.add({name, figure, "CPU ms", 1e3 * median(again), "everything anew", 1e3 * all});
        bench_.add({name + "/regrown", "those that let it grow again", "CPU ms", 1e3 * median(regrown),
                    "everything anew", 1e3 * all});
        std::snprintf(figure, sizeof figure, "the worst of %zu, of %.2f %%", dabs.size(), 100 * worstShare);
        bench_.add({name + "/worst", figure, "CPU ms", 1e3 * worst, "its share of that and 2 % more",
                    1e3 * all * (worstShare + 0.02)});
        countDerived(name, dabs, census);
    }

    // Taking what was there away is what the records foretold; putting it back derives as much.
    void countDerived(const std::string& name, const std::vector<Dab>& dabs, const Census& census) {
        double derived = 0, invalidated = 0, worst = 0;
        for (const Dab& dab : dabs) {
            for (float value : {0.0f, 1.0f}) {
                GrowthChanges changes = paint(dab, value);
                scene_.changes = &changes;
                (void)scene_.grow(growth_);
            }
            const double these = invalidatedBy(dab, census);
            derived += growth_.stats().derived;
            invalidated += these;
            worst = std::max(worst, growth_.stats().derived / std::max(these, 1.0));
        }
        char figure[96];
        std::snprintf(figure, sizeof figure, "nodes derived; %zu dabs; the worst %.2f", dabs.size(), worst);
        bench_.add({name + "/derived", figure, "nodes", derived, "invalidated", invalidated});
    }

    // Texts of which each changes the rule of shoots, and no other.
    void measureRule(const std::string& name, float step) {
        std::vector<double> again, whole, shares;
        for (int i = -1; i < bench_.options().repeats; ++i) {  // the first isn't counted
            GrowthChanges changes;
            if (!scene_.changeGrammar(shootGrammar(step, i % 2 == 0 ? 0.1f : 0.2f), changes)) return;
            scene_.changes = &changes;
            const double time = cpuSeconds([&] { (void)scene_.grow(growth_); });
            const double share = 100.0 * growth_.stats().derived / growth_.stats().nodes;
            const double all = cpuSeconds([&] { (void)growAll(); });
            if (i < 0) continue;
            again.push_back(time);
            shares.push_back(share);
            whole.push_back(all);
        }
        char figure[96];
        std::snprintf(figure, sizeof figure, "a text that changes a rule of %.2f %% of %u nodes", median(shares),
                      growth_.stats().nodes);
        bench_.add({name, figure, "CPU ms", 1e3 * median(again), "everything anew", 1e3 * median(whole)});
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
    struct DabTimes {
        std::vector<double> cut, grown;  // seconds
    };
    struct Timed {
        std::vector<DabTimes> dabs;
        std::vector<double> whole;
        bool partly = true;  // none grew everything anew
    };
    // One of the dabs a round, each in its turn, so often that noise doesn't pick the worst of them, and everything
    // anew.
    Timed time(const std::vector<Dab>& dabs) {
        Timed timed;
        timed.dabs.resize(dabs.size());
        constexpr int kTimesEach = 9;
        const int rounds = std::max(bench_.options().repeats, kTimesEach * int(dabs.size()));
        for (int i = -1; i < rounds; ++i) {  // the first isn't counted
            const size_t dab = size_t(i + 1) % dabs.size();
            for (float value : {0.0f, 1.0f}) {
                GrowthChanges changes = paint(dabs[dab], value);
                scene_.changes = &changes;
                const uint32_t regrowths = growth_.stats().regrowths;
                const double took = cpuSeconds([&] { (void)scene_.grow(growth_); });
                timed.partly = timed.partly && growth_.stats().regrowths > regrowths;
                if (i >= 0) (value == 1 ? timed.dabs[dab].grown : timed.dabs[dab].cut).push_back(took);
            }
            const double took = cpuSeconds([&] { (void)growAll(); });
            if (i >= 0) timed.whole.push_back(took);
        }
        return timed;
    }

    GrowthChanges paint(const Dab& dab, float value) {
        const glm::vec2 at = dab.at * float(kTexels);
        const float radius = dab.radius * float(kTexels);
        glm::ivec2 low = glm::max(glm::ivec2(at - radius), 0);
        glm::ivec2 high = glm::min(glm::ivec2(at + radius) + 1, int(kTexels));
        GrowthChanges changes;
        changes.everything = false;
        for (int y = low.y; y < high.y; ++y)
            for (int x = low.x; x < high.x; ++x) {
                if (glm::length(glm::vec2(x, y) + 0.5f - at) >= radius) continue;
                texels_[texelIndex(kTexels, uint32_t(x), uint32_t(y))] = value;
                changes.markTexels(0, 0, kTexels, uint32_t(x), uint32_t(y), uint32_t(x) + 1, uint32_t(y) + 1);
            }
        (void)scene_.paint(0, kTexels, texels_);
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
    bool wanted = bench.wants("edit/dab-trunk") || bench.wants("edit/rule") || bench.wants("edit/unchanged");
    for (const auto& [row, share] : shares) wanted = wanted || bench.wants(name + row);
    if (!wanted) return;
    const std::string path = bench.options().dataFolder + "/derived/bunny_unwrap.glb";
    Result<std::unique_ptr<Device>> device = Device::create();
    if (!device) return bench.skip(name, device.failure().text());
    Result<std::unique_ptr<Growth>> growth = Growth::create(**device);
    auto scene = BenchScene::create(**device, path, kTexels);
    if (!growth || !scene) return bench.skip(name, "needs " + path);
    const float step = 2.2f * scene->texelMetres();
    if (!scene->setGrammar(maskedGrammar(step))) return;
    scene->plant(kSeeds);
    EditBench edits(bench, *scene, **growth);
    if (!scene->paint(0, kTexels, std::vector<float>(size_t(kTexels) * kTexels, 1.0f)) || !edits.growAll()) return;
    Result<GrowthRecords> records = (*growth)->read();
    if (!records) return bench.skip(name, records.failure().text());
    const Census census(*records);
    for (const auto& [row, share] : shares)
        if (bench.wants(name + row))
            edits.measure(name + row, Dabs(census).about(share * (*growth)->stats().nodes), census);
    if (bench.wants("edit/dab-trunk")) edits.measure(name + "dab-trunk", Dabs(census).onTrunks(), census);
    if (bench.wants("edit/unchanged")) edits.measureUnchanged();
    if (bench.wants("edit/rule") && scene->setGrammar(shootGrammar(step, 0)) && edits.growAll())
        edits.measureRule(name + "rule", step);
}

}  // namespace espalier
