/* Preloaded into a program: notes in the file NOTE_UPDATE what each espUpdate returned that was another than the last.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>

int espUpdate(void* context) {
    static int last = -1;
    int (*real)(void*) = (int (*)(void*))dlsym(RTLD_NEXT, "espUpdate");
    const int result = real ? real(context) : 0;
    const char* name = getenv("NOTE_UPDATE");
    FILE* file = name && result != last ? fopen(name, "a") : NULL;
    if (file) {
        fprintf(file, "%d\n", result);
        fclose(file);
        last = result;
    }
    return result;
}
