// Items that are unlike in length, on lanes that run together: when half of a subgroup's lanes have ended theirs, these
// take further items, as long as there are any. What an item is the kernel says, by functions of its own (in C++ they are
// members of what stands for the lane):
//   bool takeItem(bool)   takes the next item; its argument becomes false if there is none for this lane any more
//   bool goesOn()         whether there is anything to do for the item
//   bool tripOfItem()     does some of it; likewise
//   void endItem()        it is done
#ifndef ESPALIER_SHARED_REFILL_H
#define ESPALIER_SHARED_REFILL_H
#include "shaders/shared/subgroup.h"

ESPALIER_BEGIN

// more: there may be items. Both loops go on for a subgroup or end for it, as what they hang on is voted on.
LANES_FN void refillLanes(LANES_PARAM bool more) {
    bool live = false;    // the lane has an item,
    bool works = false;   // which isn't done
    while (OF_LANES(anyLane(live || more))) {
        if (!live && more) {
            live = OF_LANES(takeItem(more));
            works = live && OF_LANES(goesOn());
        }
        bool refills = OF_LANES(anyLane(more));
        uint few = refills ? OF_LANES(lanesTogether()) / 2u : 0u;
        uint busy = few + 1u;
        while (busy > few) {
            if (works) works = OF_LANES(tripOfItem());
            busy = OF_LANES(countLanes(works));
        }
        if (live && !works) {
            OF_LANES(endItem());
            live = false;
        }
    }
}

ESPALIER_END
#endif
