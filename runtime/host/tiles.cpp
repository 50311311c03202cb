// Enters: tiles in which changes were noted, by pointer. Leaves: what take_tiles.comp would.
#include "runtime/host/tiles.hpp"

#include "shaders/emit/glsl_names.h"

namespace espalier {
namespace {

// What is around the kernel's text.
struct TakeTiles {
    const TakePush& push;
#include "shaders/emit/take_tiles.h"

    void all() {
        takeRun(floatBitsToUint(push.taken.v[push.tiles]), 0, takePlaces(), 0);
    }
};

}  // namespace

void takeTilesNative(const TakePush& push) {
    TakeTiles{push}.all();
}

}  // namespace espalier
