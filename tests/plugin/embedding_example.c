#include <espalier/espalier.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static EspContext* context;

static void must(EspResult result) {
    if (result == ESP_OK) return;
    fprintf(stderr, "espalier: %s\n", espLastError(context));
    exit(1);
}

/* usage: embedding_example SURFACE.glb */
int main(int argc, char** argv) {
    EspContextDef def = {.structSize = sizeof def};
    espDefaultContextDef(&def); /* def.host: your VkDevice; NULL: one of Espalier's own */
    must(espCreate(ESP_VERSION, &def, &context));

    EspSurface wall;
    must(espLoadSurface(context, argc > 1 ? argv[1] : "wall.surface.glb", NULL, &wall));

    const char* text =
        "param reach = 2 [0.1 .. 10] \"m\" \"Length of the stems\"\n"
        "Ivy -> Branch(2) {Stem(reach), Stem(reach * 0.6)}\n"
        "Stem(l) : arc >= l -> NULL\n"
        "Stem(l) -> Marching(0.05, rand(-0.3, 0.3), true) {Stem(l), Wood Leaves}\n"
        "Wood   -> S(0.01) Shape(\"bark\", C1)\n"
        "Leaves -> Repeat(2) {S(0.07) T(rand(), 0.02) R(rand(-1, 1), 0.3) Shape(\"leaf\")}\n";
    EspGrammarDef grammarDef = {sizeof grammarDef, "ivy.grammar", text, strlen(text)};
    EspGrammar ivy;
    must(espCompileGrammar(context, &grammarDef, &ivy));

    EspSeedDef seed = {.structSize = sizeof seed};
    espDefaultSeedDef(&seed);
    seed.grammar = ivy;
    seed.position[1] = 0.1f; /* the nearest point of the wall is taken */
    seed.direction[1] = 1;
    EspSeed planted;
    must(espPlant(context, &seed, &planted));

    for (int frame = 0; frame < 3; ++frame) {
        must(espUpdate(context)); /* grows in the first frame; nothing has changed in the others */
        EspDrawDef draw = {.structSize = sizeof draw};
        espDefaultDrawDef(&draw);
        must(espDraw(context, &draw));
    }

    EspStats stats = {.structSize = sizeof stats};
    must(espReadStats(context, &stats));
    printf("%u seeds, %u branches, %llu leaves, grown %u times\n", stats.seeds, stats.branches,
           (unsigned long long)stats.leaves, stats.expansions);
    espDestroy(context);
    return 0;
}
