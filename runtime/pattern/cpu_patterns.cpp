// The kernels' text on the CPU: native code of software devices, and the reference of tests.
#include <chrono>

#include "runtime/core/jobs.hpp"
#include "runtime/pattern/pattern_room.hpp"
#include "shaders/shared/pattern_decide.h"

namespace espalier {
namespace {

constexpr size_t kGrain = 32;

class CpuPatterns {
  public:
    CpuPatterns(const PatternInputs& inputs, unsigned threads) : inputs_(inputs), crew_(threads) {}

    Result<GrownPattern> run() {
        const auto begin = std::chrono::steady_clock::now();
        room_.items = std::max(room_.items, uint32_t(inputs_.seeds.size()));
        while (true) {
            derive();
            if (Status within = withinLimits(status_, inputs_.limits); !within) return within.failure();
            if (room_.holds(status_)) break;
            room_.grow(status_);
        }
        sumHash();
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

    template <class Work>
    void each(uint32_t count, const Work& work) {
        crew_.overRange(count, kGrain, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) work(env_, uint32_t(i));
        });
    }

    void derive() {
        makeRoom();
        for (beginWave(env_); status_.wave > 0; beginWave(env_)) {
            each(status_.wave, deriveItem);
            if (!foundRoom(env_) || status_.pieces > inputs_.limits.maxPieces) return;
            each(status_.pieces - status_.firstPiece, placePiece);
            each(status_.pieces - status_.firstPiece, lookAround);
            if (!foundRoom(env_)) return;
            each(status_.pairs, meetPair);
            if (!foundRoom(env_)) return;
            while (!waveDecided(env_)) {
                each(status_.sets - status_.firstSet, decideSet);
                status_.rounds += 1;
            }
            each(status_.wave, goOn);
            if (!foundRoom(env_)) return;
        }
    }

    void sumHash() {
        each(status_.pieces, [](const PatternEnv& env, uint32_t i) {
            const uvec2 h = hashOfPiece(env, i);
            atomicAdd(env.status.v[0].hash[0], h.x);
            atomicAdd(env.status.v[0].hash[1], h.y);
        });
    }

    const PatternInputs& inputs_;
    Crew crew_;
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
