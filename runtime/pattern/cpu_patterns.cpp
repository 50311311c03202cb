// The CPU reference of patterns: the same stages, over memory of its own.
#include <chrono>

#include "runtime/pattern/pattern_room.hpp"
#include "runtime/pattern/pattern_stages.hpp"
#include "runtime/run/host_runner.hpp"

namespace espalier {
namespace {

class CpuPatterns {
  public:
    CpuPatterns(const PatternInputs& inputs, unsigned threads) : inputs_(inputs), runner_(threads) {}

    Result<GrownPattern> run() {
        const auto begin = std::chrono::steady_clock::now();
        room_.items = std::max(room_.items, uint32_t(inputs_.seeds.size()));
        while (true) {
            derive();
            if (Status within = withinLimits(status_, inputs_.limits); !within) return within.failure();
            if (room_.holds(status_)) break;
            room_.grow(status_);
        }
        StageList hash = patternHashStages({}, env_);
        runner_.run(hash);
        GrownPattern grown =
            standingOf(std::span(pieces_).first(status_.pieces), std::span(sets_).first(status_.sets), status_);
        grown.stats.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
        return grown;
    }

  private:
    void makeRoom() {
        items_.resize(size_t(room_.items) * kPatternPriorities);
        shapes_.resize(room_.items);
        sets_.resize(room_.sets);
        pieces_.resize(room_.pieces);
        edges_.resize(room_.edges);
        pairs_.resize(room_.pairs);
        cells_.assign(room_.cells(), kNoIndex);
        std::ranges::copy(itemsOfPatternSeeds(inputs_), items_.begin());
        status_ = freshPatternStatus(inputs_, room_);
        const PieceMeshes& meshes = *inputs_.meshes;
        env_.surfaces = inputs_.surfaces;
        env_.layers = inputs_.layers;
        env_.grammars.v = const_cast<RuleMapRef*>(inputs_.grammars.data());
        env_.fields = inputs_.fields;
        env_.items.v = items_.data();
        env_.shapes.v = shapes_.data();
        env_.sets.v = sets_.data();
        env_.pieces.v = pieces_.data();
        env_.edges.v = edges_.data();
        env_.pairs.v = pairs_.data();
        env_.cells.v = cells_.data();
        env_.meshes.v = const_cast<PatternMesh*>(meshes.meshes.data());
        env_.clusters.v = const_cast<vec4*>(meshes.clusters.data());
        env_.corners.v = const_cast<vec3*>(meshes.corners.data());
        env_.status.v = &status_;
        env_.instances = inputs_.surfaceCount;
        env_.cellMask = room_.cells() - 1;
    }

    void derive() {
        makeRoom();
        do {
            StageList waves = patternStages({}, env_);
            runner_.run(waves);
        } while (status_.wave > 0 && room_.holds(status_) && withinLimits(status_, inputs_.limits));
    }

    const PatternInputs& inputs_;
    HostRunner runner_;
    PatternRoom room_;
    PatternEnv env_{};
    PatternStatus status_{};
    std::vector<PatternItem> items_;
    std::vector<PatternShape> shapes_;
    std::vector<PatternSet> sets_;
    std::vector<PatternPiece> pieces_;
    std::vector<PatternEdge> edges_;
    std::vector<PatternPair> pairs_;
    std::vector<uint32_t> cells_;
};

}  // namespace

Result<GrownPattern> growPatternsOnCpu(const PatternInputs& inputs, unsigned threads) {
    return CpuPatterns(inputs, threads).run();
}

}  // namespace espalier
