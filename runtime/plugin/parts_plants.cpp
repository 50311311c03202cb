// In: the records of all plants. Out: stems, a part a plant, and leaves where they stand.
#include <algorithm>
#include <map>
#include <numeric>

#include "runtime/core/jobs.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/parts_stems.hpp"
#include "runtime/plugin/seeds.hpp"
#include "shaders/emit/leaf_place.h"

namespace espalier {
namespace {

constexpr float kFirstError = .2f;  // of the level after one without any

// Where a node stands in its plant.
struct NodePlace {
    float way = 0;   // metres from the seed, along branches
    float wind = 0;  // as EspPartVertex
    uint32_t seed = 0;
};

class PlantGatherer {
  public:
    PlantGatherer(EspContext& context, const Plants& plants, PartsWriter& out)
        : context_(context),
          plants_(plants),
          records_(plants.records()),
          out_(out),
          terminals_(context.renderer->terminals()) {
        for (const glm::mat4& m : context.stands()) {
            SurfaceRef& ref = surfaces_.emplace_back();
            for (int row = 0; row < 3; ++row) ref.toWorld[row] = vec4(m[0][row], m[1][row], m[2][row], m[3][row]);
        }
    }

    void run() {
        measure();
        if (out_.wants(ESP_PART_STEMS)) addStems();
        if (out_.wants(ESP_PART_LEAF)) addLeaves();
    }

  private:
    // Parents first: a branch begins where its parent has been measured.
    void measure() {
        places_.resize(records_.nodes.size());
        std::vector<uint32_t> order(records_.branches.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::stable_sort(order, {}, [&](uint32_t b) { return plants_.depthOf(b); });
        for (uint32_t b : order) measureBranch(b);
        branches_ = std::move(order);
    }
    void measureBranch(uint32_t branch) {
        const std::vector<uint32_t> nodes = plants_.nodesOf(branch);
        const uint32_t seed = plants_.seedOf(branch);
        if (seed >= longest_.size()) longest_.resize(seed + 1, 1e-6f);
        const bool joined = plants_.parentOf(branch).has_value();
        const NodePlace root = joined ? places_[nodes.front()] : NodePlace{};
        const float length = std::max(records_.nodes[nodes.back()].arc, 1e-6f);
        for (size_t i = joined ? 1 : 0; i < nodes.size(); ++i) {
            const float arc = records_.nodes[nodes[i]].arc;
            const float share = std::clamp(arc / length, 0.0f, 1.0f);
            places_[nodes[i]] = {root.way + arc, glm::mix(root.wind, 1.0f, share), seed};
            longest_[seed] = std::max(longest_[seed], root.way + arc);
        }
    }
    float ageOf(const NodePlace& place) const { return std::clamp(1 - place.way / longest_[place.seed], 0.0f, 1.0f); }

    LoadedSpan spanOf(uint32_t node) {
        return loadSpan({const_cast<Node*>(records_.nodes.data())}, {const_cast<Chunk*>(records_.chunks.data())},
                        {surfaces_.data()}, node);
    }

    // The kind of bark of the span that ends at a node; kNoBark if it has none.
    uint32_t barkOf(const Node& node) const {
        const uint32_t kind = (node.flags >> 18u) & 255u;
        const auto& kinds = terminals_.table().kinds;
        const bool bark = (node.flags & kNodeBark) != 0u && node.radius > 0.0f && kind < kinds.size() &&
                          kinds[kind].variantCount > 0u && kinds[kind].bark != 0u;
        return bark ? kind : kNoBark;
    }

    // By seed and kind of bark.
    void addStems() {
        std::map<std::pair<uint32_t, uint32_t>, std::vector<StemRun>> plants;
        for (uint32_t branch : branches_) addRuns(branch, plants);
        const EspPartsDef& def = out_.def();
        for (const auto& [of, runs] : plants) {
            const TerminalVariant& variant =
                terminals_.data().variants[terminals_.table().kinds[of.second].firstVariant];
            Part& part = out_.single(ESP_PART_STEMS, "stems_" + std::to_string(of.first + 1),
                                     out_.material(terminals_.data(), variant.lods.front().material, false));
            part.seed = {of.first < context_.grownSeeds.size() ? context_.grownSeeds[of.first] : 0};
            part.levels.resize(def.stemLevels);
            float radius = 0;
            for (const StemRun& run : runs) radius = std::max(radius, thickest(run));
            parallelFor(def.stemLevels, 1, [&, &runs = runs](size_t begin, size_t end) {
                for (size_t level = begin; level < end; ++level)
                    part.levels[level] = stemLevel(runs, errorOf(def.stemError, radius, level), level > 0);
            });
        }
    }
    // metres: of a level, where the plant's thickest stem has this radius.
    static float errorOf(float finest, float radius, size_t level) {
        if (level == 0) return finest * radius;
        return (finest > 0 ? 4 * finest : kFirstError) * radius * std::exp2(2 * float(level - 1));
    }
    void addRuns(uint32_t branch, std::map<std::pair<uint32_t, uint32_t>, std::vector<StemRun>>& plants) {
        const std::vector<uint32_t> nodes = plants_.nodesOf(branch);
        const uint32_t seed = plants_.seedOf(branch);
        uint32_t last = kNoBark;
        for (size_t i = 1; i < nodes.size(); ++i) {
            const uint32_t kind = barkOf(records_.nodes[nodes[i]]);
            if (kind != kNoBark) {
                std::vector<StemRun>& runs = plants[{seed, kind}];
                if (kind != last) runs.emplace_back();
                addSpan(nodes[i - 1], nodes[i], runs.back());
            }
            last = kind;
        }
    }
    void addSpan(uint32_t from, uint32_t to, StemRun& run) {
        const LoadedSpan s = spanOf(to);
        SpanInstance o{};
        o.p0 = s.span.p0, o.b1 = s.span.b1, o.b2 = s.span.b2, o.p3 = s.span.p3;
        o.radius0 = s.radius0, o.radius1 = s.radius1;
        o.metres = spanLength(s.span);
        o.bits = s.tip ? 64u : 0u;
        const NodePlace &a = places_[from], &b = places_[to];
        const float start = run.empty() ? s.arc0 : run.back().metres;
        for (uint32_t i = run.empty() ? 0 : 1; i < kBarkRings; ++i) {
            const float u = float(i) / float(kBarkRings - 1);
            StemRing ring;
            ring.ring = barkRing(o, s.normal0, s.normal1, i);
            if (s.tip) ring.ring.radius = tipRadius(o, i);
            ring.metres = start + o.metres * u;
            ring.wind = glm::mix(a.wind, b.wind, u);
            ring.age = glm::mix(ageOf(a), ageOf(b), u);
            run.push_back(ring);
        }
    }

    // The colour by which a leaf's picture is multiplied, nearly as it is drawn (leaf_light.glsl).
    glm::vec3 leafColour(const LeafPose& pose, uint32_t hash, glm::vec3 mean) const {
        const glm::vec3 weights(.3f, .6f, .1f), young(1.16f, 1.08f, .60f), old(.46f, .57f, .52f);
        const float a = float(hash & 255u) / 255, b = float(hash >> 8 & 255u) / 255;
        const glm::vec3& c = pose.colour;
        const float strong = std::max({c.x, c.y, c.z}) - std::min({c.x, c.y, c.z});
        const float turn = .5f * std::min(1.0f, 3 * strong);
        const float share = std::clamp(.08f + .46f * pose.tint + .8f * (a - .5f), 0.0f, 1.0f);
        glm::vec3 grown = glm::mix(old, young, share) * (.68f + .64f * b);
        if (pose.mesh >= kOwnMeshes) grown = glm::vec3(std::clamp(1.7f * glm::dot(grown, weights), .55f, 1.25f));
        const glm::vec3 turned =
            c / std::max(glm::dot(c, weights), 1e-3f) * glm::dot(mean, weights) / glm::max(mean, glm::vec3(1e-3f));
        return grown * glm::mix(glm::vec3(1), turned, turn);
    }

    void addLeaves() {
        const TerminalTable& table = terminals_.table();
        std::map<uint32_t, uint32_t> partOf;  // variant to part
        for (const Leaf& leaf : records_.leaves) {
            const LeafPose pose = unpackLeaf(leaf.place, leaf.pose, leaf.tint);
            if (leaf.node >= records_.nodes.size() || pose.mesh >= table.kinds.size()) continue;
            const KindRecord& kind = table.kinds[pose.mesh];
            if (kind.variantCount == 0 || kind.bark != 0 || isGap(records_.nodes[leaf.node])) continue;
            const LoadedSpan span = spanOf(leaf.node);
            if (!span.valid) continue;
            const uint32_t hash = leafHash(leaf), variant = kind.firstVariant + (hash >> 3u) % kind.variantCount;
            const auto [known, added] = partOf.try_emplace(variant, 0);
            if (added) known->second = variantPart(variant);
            addLeaf(leaf, pose, placeLeaf(span, pose, hash, table.variants[variant].extent), known->second, hash);
        }
    }
    uint32_t variantPart(uint32_t variant) {
        const TerminalVariant& of = terminals_.data().variants[variant];
        const uint32_t part = out_.variant(ESP_PART_LEAF, of.name, terminals_.data(), of, hangs(of.kind));
        means_.resize(std::max<size_t>(means_.size(), part + 1), glm::vec3(1));
        means_[part] = meanColour(terminals_.data(), of);
        return part;
    }
    // Of what a leaf's picture shows, linear.
    static glm::vec3 meanColour(const TerminalData& data, const TerminalVariant& variant) {
        const TerminalMaterial& material = data.materials[variant.lods.front().material];
        if (material.baseColorPicture < 0) return glm::vec3(1);
        const TerminalPicture& picture = data.pictures[size_t(material.baseColorPicture)];
        glm::dvec3 sum(0);
        double count = 0;
        for (size_t i = 0; i + 3 < picture.rgba.size(); i += 64) {
            if (picture.rgba[i + 3] < 128) continue;
            for (int k = 0; k < 3; ++k) sum[k] += std::pow(picture.rgba[i + size_t(k)] / 255.0, 2.2);
            ++count;
        }
        return count > 0 ? glm::vec3(sum / count) : glm::vec3(1);
    }
    void addLeaf(const Leaf& leaf, const LeafPose& pose, const PlacedLeaf& placed, uint32_t part, uint32_t hash) {
        const NodePlace& at = places_[leaf.node];
        EspPartInstance instance{};
        const glm::vec3 columns[] = {placed.axisX * placed.size, placed.axisY * placed.size, placed.axisZ * placed.size,
                                     placed.origin};
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column) instance.place.rows[row][column] = columns[column][row];
        put(instance.colour, leafColour(pose, hash, means_[part]));
        instance.wind = at.wind;
        instance.age = ageOf(at);
        instance.seed = {at.seed < context_.grownSeeds.size() ? context_.grownSeeds[at.seed] : 0};
        out_.part(part).instances.push_back(instance);
    }

    EspContext& context_;
    const Plants& plants_;
    const GrowthRecords& records_;
    PartsWriter& out_;
    const Terminals& terminals_;
    std::vector<SurfaceRef> surfaces_;
    std::vector<NodePlace> places_;   // [node]
    std::vector<uint32_t> branches_;  // parents first
    std::vector<float> longest_;      // [seed] metres
    std::vector<glm::vec3> means_;    // [part]
};

}  // namespace

EspResult gatherPlants(EspContext& context, PartsWriter& out) {
    if (context.growth->view().nodeCount == 0) return ESP_OK;
    const Plants* plants = nullptr;
    if (const EspResult failed = readPlants(context, plants)) return failed;
    PlantGatherer(context, *plants, out).run();
    return ESP_OK;
}

}  // namespace espalier
