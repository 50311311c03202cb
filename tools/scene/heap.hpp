#pragma once

// How a program that draws in a window, or measures that, has glibc keep memory. Software devices take theirs by
// malloc.

#include <malloc.h>

namespace espalier::scene {

// Of the whole process. Call it once, before other threads begin.
inline void keepHeap() {
    // Large blocks go back when they are freed: left alone, glibc takes them from its heap as soon as one was, and each
    // document that is opened finds that in more pieces.
    (void)mallopt(M_MMAP_THRESHOLD, 1 << 20);
    // What a frame's vertices take stays for the next frame's: given back and asked for again it is an eighth of a
    // frame.
    (void)mallopt(M_TRIM_THRESHOLD, 64 << 20);
    (void)mallopt(M_TOP_PAD, 4 << 20);
    // One heap for all threads: what one of them frees others find, and malloc_trim gives back its end, too, which it
    // doesn't of threads' own heaps. Frames ask for little, and take no longer for it.
    (void)mallopt(M_ARENA_MAX, 1);
}

}  // namespace espalier::scene
