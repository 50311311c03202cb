#pragma once

#include <algorithm>
#include <cstdint>

namespace espalier {

// What pays on a device. All of it follows from whether the device runs shaders on the CPU: who wants to know one of
// these asks for it, and not for the kind of device.
struct DeviceTraits {
    float anisotropy = 8;        // of textures' samplers; 1: none
    uint32_t samples = 4;        // of a pixel of the picture; 1: edges are smoothed when all is drawn
    bool quickPictures = false;  // moving pictures have shading of their own, else they have fewer pixels at most
    uint32_t cellLanes = 64;  // lanes of a kernel that share a cell's items: more, where one alone would be waited for
    uint32_t sortLanes = 64;  // lanes that put a cell's bins in order
    bool wideGroups = true;   // groups of as many lanes as there may be pay
    bool lazyMemory = false;  // memory costs nothing until it is touched
    // Of a pass whose kernels go through items by themselves; itemsOfGroup 0: any number of items.
    uint32_t leastGroups = 1024, itemsOfGroup = 0;

    uint32_t groupsThrough(uint32_t items) const {
        return std::max(leastGroups, itemsOfGroup ? items / itemsOfGroup : 0);
    }
};

// cpu: shaders run on the CPU.
DeviceTraits traitsOf(bool cpu);

}  // namespace espalier
