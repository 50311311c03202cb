/* Preloaded into a program: notes each malloc_trim in the file NOTE_TRIM, as pages that were resident before and after
 * it, and how often espTrim was called by then. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>

static long residentPages(void) {
    long all = 0, resident = 0;
    FILE* file = fopen("/proc/self/statm", "r");
    if (!file) return 0;
    if (fscanf(file, "%ld %ld", &all, &resident) != 2) resident = 0;
    fclose(file);
    return resident;
}

static int contextsTrimmed;

int espTrim(void* context) {
    int (*real)(void*) = (int (*)(void*))dlsym(RTLD_NEXT, "espTrim");
    ++contextsTrimmed;
    return real ? real(context) : 0;
}

int malloc_trim(size_t pad) {
    int (*real)(size_t) = (int (*)(size_t))dlsym(RTLD_NEXT, "malloc_trim");
    const long before = residentPages();
    const int released = real ? real(pad) : 0;
    const char* name = getenv("NOTE_TRIM");
    FILE* file = name ? fopen(name, "a") : NULL;
    if (file) {
        fprintf(file, "%ld %ld %d\n", before, residentPages(), contextsTrimmed);
        fclose(file);
    }
    return released;
}
