/* A host that is compiled twice: with the header as it is, and with one in which the last fields of some structs are
 * missing. Both have to print the same, and around the older one's structs not a byte may change. */
#include <string.h>

#include "tests/plugin/check.h"

/* A struct in the middle of bytes that nobody may touch. */
#define GUARDED(Struct, name)         \
    struct {                          \
        Struct s;                     \
        uint8_t behind[64];           \
    } name;                           \
    memset(&name, 0xA5, sizeof name); \
    name.s.structSize = sizeof name.s
#define UNTOUCHED(name)                                                                    \
    do {                                                                                   \
        for (size_t i_ = 0; i_ < sizeof name.behind; ++i_) CHECK(name.behind[i_] == 0xA5); \
    } while (0)

static const char* kIvy =
    "Ivy -> Stem\n"
    "Stem : arc >= 0.6 -> NULL\n"
    "Stem -> Marching(0.05, rand(-0.3, 0.3), true) {Stem, Wood}\n"
    "Wood -> S(0.01) Shape(\"bark\", C1)\n";

static void wrongVersions(const EspContextDef* def) {
    EspContext* context = NULL;
    const uint32_t patch = 1, minor = 1u << 12, major = 1u << 22;
    const uint32_t wrong[] = {ESP_VERSION + patch, ESP_VERSION + minor, ESP_VERSION + major, 0};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i)
        CHECK(espCreate(wrong[i], def, &context) == ESP_WRONG_VERSION && !context);
    CHECK(strstr(espLastError(NULL), "0.0.0") && strstr(espLastError(NULL), espVersion()));
}

/* A size that isn't set, and one of a newer header. */
static void wrongSizes(EspContext* context) {
    EspStats stats = {.structSize = 0};
    REFUSED(espReadStats(context, &stats));
    CHECK(strstr(espLastError(context), "structSize") != NULL);
    stats.structSize = 100000;
    REFUSED(espReadStats(context, &stats));
    EspSeedDef seed = {.structSize = 0};
    REFUSED(espDefaultSeedDef(&seed));
}

int main(int argc, char** argv) {
    CHECK(argc == 2);
    EspContext* context = NULL;
    EspContextDef def = {.structSize = sizeof def};
    OK(NULL, espDefaultContextDef(&def));
    def.skipSelfCheck = 1;
    wrongVersions(&def);
    OK(NULL, espCreate(ESP_VERSION, &def, &context));
    wrongSizes(context);

    EspSurface surface = {0};
    OK(context, espLoadSurface(context, argv[1], NULL, &surface));
    GUARDED(EspSurfaceInfo, info);
    OK(context, espSurfaceInfo(context, surface, &info.s));
    UNTOUCHED(info);

    GUARDED(EspGrowDef, grow);
    OK(NULL, espDefaultGrowDef(&grow.s));
    UNTOUCHED(grow);
    grow.s.maxDepth = 100;
    OK(context, espSetGrow(context, &grow.s));

    EspGrammarDef text = {sizeof text, "ivy", kIvy, strlen(kIvy)};
    EspGrammar grammar = {0};
    OK(context, espCompileGrammar(context, &text, &grammar));
    GUARDED(EspSeedDef, seed);
    OK(NULL, espDefaultSeedDef(&seed.s));
    UNTOUCHED(seed);
    seed.s.grammar = grammar;
    seed.s.position[0] = seed.s.position[1] = 0.2f;
    seed.s.direction[1] = 1;
    EspSeed planted = {0};
    OK(context, espPlant(context, &seed.s, &planted));
    OK(context, espSeedDef(context, planted, &seed.s));
    UNTOUCHED(seed);
    OK(context, espUpdate(context));

    GUARDED(EspCamera, camera);
    OK(context, espFrameAll(context, &camera.s));
    UNTOUCHED(camera);
    EspDrawDef draw = {.structSize = sizeof draw};
    OK(NULL, espDefaultDrawDef(&draw));
    draw.width = 64;
    draw.height = 36;
    draw.camera = &camera.s;
    OK(context, espDraw(context, &draw));
    uint8_t pixels[64 * 36 * 4];
    OK(context, espReadPixels(context, pixels, sizeof pixels));
    uint64_t sum = 0;
    for (size_t i = 0; i < sizeof pixels; ++i) sum = sum * 31 + pixels[i];

    GUARDED(EspStats, stats);
    OK(context, espReadStats(context, &stats.s));
    UNTOUCHED(stats);
    CHECK(stats.s.nodes > 10);
#ifdef OLDER_HEADER
    CHECK(sizeof(EspStats) == 224 - 16);
#endif
    printf("%u triangles, %llu nodes, %016llx, picture %016llx\n", info.s.triangles, (unsigned long long)stats.s.nodes,
           (unsigned long long)stats.s.hash, (unsigned long long)sum);
    espDestroy(context);
    return 0;
}
