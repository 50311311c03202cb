// In: symbols that wait, by pointer. Out: sets and pieces that stand or fall, and the symbols of the next wave.
#include "runtime/host/kernels.hpp"
#include "shaders/shared/pattern_decide.h"

namespace espalier {
namespace {

constexpr size_t kAtOnce = 32;

template <class Work>
void each(const PatternEnv& env, uint32_t count, const HostRun& run, const Work& work) {
    run.crew.overRange(count, kAtOnce, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) work(env, uint32_t(i));
    });
}
const PatternStatus& statusOf(const PatternEnv& env) {
    return env.status.v[0];
}
// Pieces of the wave that goes on.
uint32_t piecesOf(const PatternEnv& env) {
    const PatternStatus& s = statusOf(env);
    return s.pieceGroups[0] > 0 ? s.pieces - s.firstPiece : 0;
}

void begin(PatternEnv env, const HostRun&) {
    beginWave(env);
}

void derive(PatternEnv env, const HostRun& run) {
    each(env, statusOf(env).deriveGroups[0] > 0 ? statusOf(env).wave : 0, run, deriveItem);
}

void place(PatternEnv env, const HostRun& run) {
    each(env, foundSetRoom(env) ? piecesOf(env) : 0, run, placePiece);
}

void look(PatternEnv env, const HostRun& run) {
    each(env, foundRoom(env) ? piecesOf(env) : 0, run, lookAround);
}

void meet(PatternEnv env, const HostRun& run) {
    const PatternStatus& s = statusOf(env);
    each(env, s.pairGroups[0] > 0 && foundRoom(env) ? s.pairs : 0, run, meetPair);
}

// All rounds that it takes.
void decide(PatternEnv env, const HostRun& run) {
    PatternStatus& s = env.status.v[0];
    for (; foundRoom(env) && !waveDecided(env); s.rounds += 1) each(env, s.sets - s.firstSet, run, decideSet);
}

void goOnAll(PatternEnv env, const HostRun& run) {
    each(env, foundRoom(env) ? statusOf(env).wave : 0, run, goOn);
}

void sumHash(PatternEnv env, const HostRun& run) {
    each(env, statusOf(env).pieces, run, [](const PatternEnv& e, uint32_t i) {
        const uvec2 h = hashOfPiece(e, i);
        atomicAdd(e.status.v[0].hash[0], h.x);
        atomicAdd(e.status.v[0].hash[1], h.y);
    });
}

constexpr HostRow kRows[] = {
    {"pattern/begin.comp", passOf<PatternEnv, begin>},   {"pattern/derive.comp", passOf<PatternEnv, derive>},
    {"pattern/place.comp", passOf<PatternEnv, place>},   {"pattern/look.comp", passOf<PatternEnv, look>},
    {"pattern/meet.comp", passOf<PatternEnv, meet>},     {"pattern/decide.comp", passOf<PatternEnv, decide>},
    {"pattern/go_on.comp", passOf<PatternEnv, goOnAll>}, {"pattern/hash.comp", passOf<PatternEnv, sumHash>}};

}  // namespace

const std::span<const HostRow> kPatternRows = kRows;

}  // namespace espalier
