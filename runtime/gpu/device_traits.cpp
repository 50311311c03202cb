// The one place that says what follows from the kind of device.
#include "runtime/gpu/device_traits.hpp"

#include <thread>

namespace espalier {

DeviceTraits traitsOf(bool cpu) {
    DeviceTraits traits;
    if (!cpu) return traits;
    traits.anisotropy = 1;
    traits.samples = 1;  // four make a frame three times as dear
    traits.quickPictures = true;
    // A core pays for each lane that has nothing to do,
    traits.cellLanes = 1;
    traits.sortLanes = 8;
    traits.wideGroups = false;
    traits.lazyMemory = true;
    // and for each group; but lavapipe ends loops after some 65,000 trips (see kMaxTrips).
    traits.leastGroups = std::clamp(8 * std::thread::hardware_concurrency(), 16u, 64u);
    traits.itemsOfGroup = 512;
    return traits;
}

}  // namespace espalier
