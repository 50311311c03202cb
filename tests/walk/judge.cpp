// The walk's end against the oracle's, in per cent of the length walked.
#include "tests/walk/judge.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace espalier::walktest {

Drift judge(const SurfaceData& surface, const std::vector<Trial>& trials, uint level, float step, Scheme scheme) {
    SurfaceRef ref = surfaceRef(surface);
    SurfaceBuf surfaces{&ref};
    Drift result;
    std::vector<double> drifts;
    long long steps = 0;
    auto begin = std::chrono::steady_clock::now();
    for (const Trial& trial : trials) {
        WalkState w{};
        bool paper = scheme == Scheme::paper;
        bool alive = paper ? startPaperWalk(surfaces, level, trial.place, trial.uv, trial.direction, w)
                           : startWalk(surfaces, level, trial.place, trial.uv, trial.direction, w);
        int count = int(std::ceil(trial.length / step));
        float each = trial.length / float(count);
        for (int i = 0; i < count && alive; ++i, ++steps) {
            uint event = paper ? paperStep(surfaces, level, w, each) : walkStep(surfaces, level, w, each);
            alive = event == kWalkDone;
        }
        double off = glm::length(Vec3(w.position) - trial.end) / trial.length * 100;
        ++result.walks;
        result.lost += alive ? 0 : 1;
        drifts.push_back(alive && std::isfinite(off) ? off : std::numeric_limits<double>::infinity());
    }
    auto end = std::chrono::steady_clock::now();
    result.nanoseconds = std::chrono::duration<double, std::nano>(end - begin).count() / double(std::max(1LL, steps));
    std::sort(drifts.begin(), drifts.end());
    if (!drifts.empty()) {
        result.median = drifts[drifts.size() / 2];
        result.p95 = drifts[drifts.size() * 95 / 100];
    }
    return result;
}

uint chartAt(const SurfaceData& surface, vec2 uv, Vec3 position) {
    const SurfaceLevelData& level = surface.levels[0];
    int size = int(level.size), x0 = int(uv.x * float(size)), y0 = int(uv.y * float(size));
    uint chart = kNoIndex;
    double best = std::numeric_limits<double>::infinity();
    for (int y = std::max(0, y0 - 1); y <= std::min(size - 1, y0 + 1); ++y)
        for (int x = std::max(0, x0 - 1); x <= std::min(size - 1, x0 + 1); ++x) {
            const Texel& t = level.texels[texelIndex(level.size, uint(x), uint(y))];
            double d = glm::length(Vec3(t.position) - position);
            if (texelClass(t.bits) == kTexelEmpty || d >= best) continue;
            best = d;
            chart = texelChart(t.bits);
        }
    return chart;
}

std::vector<Trial> shapeTrials(const Shape& shape, const SurfaceData& surface, int count, double length,
                               uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<Trial> trials;
    for (int tries = 0; int(trials.size()) < count && tries < count * 500; ++tries) {
        Start s = randomStart(shape, random);
        auto end = shape.geodesic(s.position, s.direction, length);
        if (!end) continue;
        Trial t;
        t.uv = vec2(s.uv);
        t.place = chartAt(surface, t.uv, s.position);
        t.direction = vec3(s.direction);
        t.length = float(length);
        t.end = *end;
        trials.push_back(t);
    }
    return trials;
}

}  // namespace espalier::walktest
