/* A surface, a grammar that includes another, and the terminal meshes: from the disk, by a host's file callbacks, and
 * the surface from memory. All grow the same, and by callbacks and from memory the library opens none of these files.
 * The program counts by functions of its own that stand before the C library's. */
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <string.h>

#include "tests/plugin/check.h"

static int opened = 0, asked = 0, held = 0;
static const char* content; /* folder of the terminal meshes */

static void note(const char* path) {
    const char* end = strrchr(path, '.');
    if (end && (!strcmp(end, ".glb") || !strcmp(end, ".grammar"))) ++opened;
}
#define OPENS(name)                                                         \
    int name(const char* path, int flags, ...) {                            \
        int (*real)(const char*, int, ...) = 0;                             \
        va_list rest;                                                       \
        va_start(rest, flags);                                              \
        const unsigned mode = flags & O_CREAT ? va_arg(rest, unsigned) : 0; \
        va_end(rest);                                                       \
        *(void**)&real = dlsym(RTLD_NEXT, #name);                           \
        note(path);                                                         \
        return real(path, flags, mode);                                     \
    }
#define FOPENS(name)                                 \
    FILE* name(const char* path, const char* mode) { \
        FILE* (*real)(const char*, const char*) = 0; \
        *(void**)&real = dlsym(RTLD_NEXT, #name);    \
        note(path);                                  \
        return real(path, mode);                     \
    }
OPENS(open)
OPENS(open64)
FOPENS(fopen)
FOPENS(fopen64)

/* A file as an archive would have it: only these three are there. */
static void* readAll(const char* path, size_t* size) {
    FILE* (*real)(const char*, const char*) = 0;
    *(void**)&real = dlsym(RTLD_NEXT, "fopen");
    FILE* file = real(path, "rb");
    CHECK(file != NULL);
    CHECK(fseek(file, 0, SEEK_END) == 0);
    *size = (size_t)ftell(file);
    rewind(file);
    void* bytes = malloc(*size);
    CHECK(fread(bytes, 1, *size, file) == *size);
    fclose(file);
    return bytes;
}
static const char* surfaceFile;
static const char kBark[] = "Wood -> S(0.01) Shape(\"bark\", C1)\n";
static EspResult readFile(void* user, const char* path, const void** bytes, size_t* size) {
    CHECK(user == &asked);
    ++asked;
    CHECK(!strstr(path, "far")); /* whose name leads out of the archive */
    char real[1024];
    if (!strcmp(path, "archive/wall.glb"))
        snprintf(real, sizeof real, "%s", surfaceFile);
    else if (!strcmp(path, "archive/terminals.glb"))
        snprintf(real, sizeof real, "%s/terminals.glb", content);
    else if (!strcmp(path, "archive/parts/bark.grammar")) {
        *size = sizeof kBark - 1;
        *bytes = memcpy(malloc(*size), kBark, *size);
        ++held;
        return ESP_OK;
    } else {
        return ESP_IO_FAILED;
    }
    *bytes = readAll(real, size);
    ++held;
    return ESP_OK;
}
static void releaseFile(void* user, const void* bytes, size_t size) {
    CHECK(user == &asked && bytes && size > 0);
    --held;
    free((void*)bytes);
}

static const char* kIvy =
    "include \"parts/bark.grammar\"\n"
    "Ivy -> Stem\n"
    "Stem : arc >= 0.6 -> NULL\n"
    "Stem -> Marching(0.05, rand(-0.3, 0.3), true) {Stem, Wood}\n";

static EspContext* create(const EspFiles* files, const char* terminals) {
    EspContext* context = NULL;
    EspContextDef def = {.structSize = sizeof def};
    OK(NULL, espDefaultContextDef(&def));
    def.skipSelfCheck = 1;
    def.files = files;
    def.terminals = terminals;
    OK(NULL, espCreate(ESP_VERSION, &def, &context));
    return context;
}

/* Of what grows on the context's only surface. */
static uint64_t grown(EspContext* context, const char* grammarName) {
    EspGrammarDef text = {sizeof text, grammarName, kIvy, strlen(kIvy)};
    EspGrammar grammar = {0};
    OK(context, espCompileGrammar(context, &text, &grammar));
    EspSeedDef seed = {.structSize = sizeof seed};
    OK(NULL, espDefaultSeedDef(&seed));
    seed.grammar = grammar;
    seed.position[0] = seed.position[1] = 0.2f;
    seed.direction[1] = 1;
    EspSeed planted = {0};
    OK(context, espPlant(context, &seed, &planted));
    OK(context, espUpdate(context));
    EspStats stats = {.structSize = sizeof stats};
    OK(context, espReadStats(context, &stats));
    CHECK(stats.nodes > 10 && stats.hash != 0);
    return stats.hash;
}

int main(int argc, char** argv) {
    CHECK(argc == 4);
    surfaceFile = argv[1];
    content = argv[2];
    const char* folder = argv[3]; /* that lies on the disk as the archive does */
    char path[1024];
    const EspFiles files = {sizeof files, 0, &asked, readFile, releaseFile};
    EspSurface surface = {0};

    EspContext* byHost = create(&files, "archive/terminals.glb");
    OK(byHost, espLoadSurface(byHost, "archive/wall.glb", NULL, &surface));
    const uint64_t hash = grown(byHost, "archive/ivy.grammar");
    CHECK(opened == 0 && asked >= 3 && held == 0);
    /* What the host hasn't got is no file, and is named. */
    CHECK(espLoadSurface(byHost, surfaceFile, NULL, &surface) == ESP_IO_FAILED);
    CHECK(strstr(espLastError(byHost), surfaceFile) != NULL && opened == 0);
    EspGrammarDef far = {sizeof far, "archive/out.grammar", "include \"../../../far.grammar\"\n", 30};
    EspGrammar none = {0};
    CHECK(espCompileGrammar(byHost, &far, &none) == ESP_INVALID_CONTENT);
    espDestroy(byHost);

    size_t size = 0;
    void* bytes = readAll(surfaceFile, &size);
    EspContext* fromMemory = create(&files, "archive/terminals.glb");
    EspSurfaceDef wall = {.structSize = sizeof wall, .bytes = bytes, .size = size};
    OK(fromMemory, espAddSurface(fromMemory, &wall, &surface));
    CHECK(grown(fromMemory, "archive/ivy.grammar") == hash);
    wall.size = size / 2;
    wall.name = "half of it";
    CHECK(espAddSurface(fromMemory, &wall, &surface) == ESP_INVALID_CONTENT);
    CHECK(strstr(espLastError(fromMemory), "half of it") != NULL);
    wall.bytes = NULL;
    wall.name = NULL;
    REFUSED(espAddSurface(fromMemory, &wall, &surface));
    espDestroy(fromMemory);
    free(bytes);
    CHECK(opened == 0 && held == 0);

    snprintf(path, sizeof path, "%s/terminals.glb", content);
    EspContext* fromDisk = create(NULL, path);
    OK(fromDisk, espLoadSurface(fromDisk, surfaceFile, NULL, &surface));
    snprintf(path, sizeof path, "%s/ivy.grammar", folder);
    CHECK(grown(fromDisk, path) == hash);
    espDestroy(fromDisk);
    CHECK(opened >= 3); /* the counter counts */
    printf("files by callbacks, from memory and from the disk: all checks passed\n");
    return 0;
}
