/* The public interface from plain C: a context's whole life on a device of Espalier's own and on a host's, then bad
 * arguments and bad content. Content: the folder with the sample's baked ruin, the only argument.
 * A failed check prints its line and ends the program with 1. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

#include "tests/plugin/c_abi.h"

enum { kWidth = 320, kHeight = 180 };

char surfacePath[1024];
const char* programPath;
int logged = 0;

static const char* kIvy =
    "param reach = 0.6 [0.1 .. 5] \"m\" \"Length of the stems\"\n"
    "param lush = 1 [0 .. 1] \"\" \"Share of leaves\"\n"
    "context mask = 1 \"Where ivy grows\"\n"
    "Ivy -> Branch(2) {Stem(reach), Stem(reach * 0.7)}\n"
    "Stem(l) : arc >= l -> NULL\n"
    "Stem(l) -> Marching(0.05, rand(-0.3, 0.3), mask(texCoord)) {Stem(l), Wood Foliage}\n"
    "Wood -> S(0.01) Shape(\"bark\", C1)\n"
    "Foliage -> Repeat(lush * 2) {S(0.06) T(rand(), 0.02) R(rand(-1, 1), 0.3) Shape(\"leaf\")}\n";

EspGrammarDef ivy(void) {
    EspGrammarDef def = {sizeof def, "ivy", NULL, 0};
    def.text = kIvy;
    def.length = strlen(kIvy);
    return def;
}

EspSeed plant(EspContext* context, EspGrammar grammar, float x, float y, float z, uint32_t number) {
    EspSeedDef def = {.structSize = sizeof def};
    espDefaultSeedDef(&def);
    EspSeed seed = {0};
    def.grammar = grammar;
    def.position[0] = x;
    def.position[1] = y;
    def.position[2] = z;
    def.direction[1] = 1;
    def.number = number;
    OK(context, espPlant(context, &def, &seed));
    CHECK(seed.id != 0);
    return seed;
}

static EspStats stats(EspContext* context) {
    EspStats s = {.structSize = sizeof s};
    OK(context, espReadStats(context, &s));
    return s;
}

size_t drawn(EspContext* context) {
    static uint8_t pixels[kWidth * kHeight * 4];
    size_t different = 0;
    EspDrawDef draw = {.structSize = sizeof draw};
    espDefaultDrawDef(&draw);
    draw.width = kWidth;
    draw.height = kHeight;
    EspCamera camera = {.structSize = sizeof camera};
    OK(context, espFrameAll(context, &camera));
    draw.camera = &camera;
    OK(context, espDraw(context, &draw));
    OK(context, espReadPixels(context, pixels, sizeof pixels));
    for (size_t i = 4; i < sizeof pixels; i += 4) different += memcmp(pixels, pixels + i, 3) != 0;
    return different;
}

/* What any host does, on whichever device the context has. Returns the growth's hash. */
static uint64_t wholeLife(EspContext* context) {
    EspSurface surface = {0};
    EspGrammar grammar = {0};
    EspGrammarDef def = ivy();
    EspSurfaceInfo info = {.structSize = sizeof info};
    OK(context, espLoadSurface(context, surfacePath, NULL, &surface));
    OK(context, espSurfaceInfo(context, surface, &info));
    CHECK(info.triangles > 1000 && info.charts > 1 && info.levels >= 1 && info.resolution >= 64);
    CHECK(info.walkableArea > 10 && info.boundsMax[1] > info.boundsMin[1] && info.hash != 0);
    CHECK(info.origin[0] == 0 && info.origin[1] == 0 && info.origin[2] == 0);

    OK(context, espCompileGrammar(context, &def, &grammar));
    CHECK(espParamCount(context, grammar) == 2);
    EspParamInfo param = {.structSize = sizeof param};
    OK(context, espParamInfo(context, grammar, 0, &param));
    CHECK(!strcmp(param.name, "reach") && !strcmp(param.label, "Length of the stems") && !strcmp(param.unit, "m"));
    CHECK(param.low == 0.1f && param.high == 5 && param.value[0] == 0.6f && param.initial[0] == 0.6f);
    CHECK(espLayerCount(context, grammar) == 1 && !strcmp(espLayerName(context, grammar, 0), "mask"));

    /* Nothing planted, nothing grown. */
    OK(context, espUpdate(context));
    CHECK(stats(context).nodes == 0);

    /* Two seeds on the wall; where a ray from the front meets it. */
    EspHit hit = {.structSize = sizeof hit};
    const float origin[3] = {-1.35f, 1, 5}, direction[3] = {0, 0, -2};
    OK(context, espPick(context, origin, direction, &hit));
    CHECK(hit.surface.id == surface.id && hit.chart < info.charts && hit.normal[2] > 0.5f);
    CHECK(fabsf(hit.distance - (5 - hit.position[2])) < 1e-3f);
    CHECK(hit.uv[0] >= 0 && hit.uv[0] <= 1 && hit.uv[1] >= 0 && hit.uv[1] <= 1);
    EspHit near = {.structSize = sizeof near};
    OK(context, espNearest(context, hit.position, &near));
    CHECK(near.distance < 1e-3f && near.chart == hit.chart);
    const float away[3] = {0, 1, 0};
    REFUSED(espPick(context, origin, away, &near));
    const EspSeed first = plant(context, grammar, hit.position[0], hit.position[1], hit.position[2], 1);
    plant(context, grammar, hit.position[0] + 0.3f, hit.position[1], hit.position[2], 2);
    OK(context, espUpdate(context));
    const EspStats grown = stats(context);
    CHECK(grown.seeds == 2 && grown.nodes > 20 && grown.branches == 4 && grown.leaves > 20 && grown.hash != 0);
    CHECK(grown.overflow == 0 && grown.nodeBytes <= 64 * grown.nodes);

    /* An unchanged scene expands nothing, however often it is updated and drawn. */
    CHECK(drawn(context) > 1000);
    OK(context, espUpdate(context));
    OK(context, espUpdate(context));
    CHECK(stats(context).expansions == grown.expansions);
    const float same = 0.6f;
    OK(context, espSetParam(context, grammar, "reach", &same, 1));
    EspGrowDef grow = {.structSize = sizeof grow};
    espDefaultGrowDef(&grow);
    OK(context, espSetGrow(context, &grow));
    OK(context, espUpdate(context));
    CHECK(stats(context).expansions == grown.expansions);

    /* A parameter changes it; beyond its range it is limited; and back is back. */
    const float longer = 100, shorter = 0.6f;
    OK(context, espSetParam(context, grammar, "reach", &longer, 1));
    OK(context, espParamInfo(context, grammar, 0, &param));
    CHECK(param.value[0] == 5);
    OK(context, espUpdate(context));
    CHECK(stats(context).nodes > 2 * grown.nodes && stats(context).expansions == grown.expansions + 1);
    OK(context, espSetParam(context, grammar, "reach", &shorter, 1));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == grown.hash);

    /* A limit stops growth and says so; without it all is as before. */
    grow.maxNodes = 30;
    OK(context, espSetGrow(context, &grow));
    OK(context, espUpdate(context));
    CHECK(stats(context).nodes > 0 && stats(context).nodes <= 30 && stats(context).overflow > 0);
    espDefaultGrowDef(&grow);
    OK(context, espSetGrow(context, &grow));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == grown.hash && stats(context).overflow == 0);

    /* A mask of zeros lets nothing grow; without it all is as before. */
    const float black[4] = {0, 0, 0, 0};
    EspLayerDef layer = {.structSize = sizeof layer};
    espDefaultLayerDef(&layer);
    layer.surface = surface;
    layer.name = "mask";
    layer.texels = black;
    layer.width = layer.height = 2;
    OK(context, espSetLayer(context, &layer));
    OK(context, espUpdate(context));
    CHECK(stats(context).nodes < 10 && stats(context).layerBytes > 0);
    layer.texels = NULL;
    OK(context, espSetLayer(context, &layer));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == grown.hash);

    /* A text that doesn't compile leaves the old one growing, and says where it is wrong. */
    EspGrammarDef broken = {sizeof broken, "broken.grammar", "Ivy -> Marching(\n", 17};
    CHECK(espRecompileGrammar(context, grammar, &broken) == ESP_INVALID_CONTENT);
    CHECK(strstr(espLastError(context), "broken.grammar:") != NULL);
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == grown.hash);
    CHECK(espParamCount(context, grammar) == 2);
    CHECK(espGrammarWarnings(context, grammar)[0] == 0);
    OK(context, espRecompileGrammar(context, grammar, &def));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == grown.hash);

    /* What may not be meant is told and grows. */
    char idle[4096];
    CHECK(snprintf(idle, sizeof idle, "%.*sparam idle = 1\n", (int)def.length, def.text) < (int)sizeof idle);
    EspGrammarDef warned = {sizeof warned, "idle.grammar", idle, strlen(idle)};
    OK(context, espRecompileGrammar(context, grammar, &warned));
    CHECK(strstr(espGrammarWarnings(context, grammar), "idle.grammar:") != NULL);
    CHECK(strstr(espGrammarWarnings(context, grammar), "warning: idle: ") != NULL);
    OK(context, espRecompileGrammar(context, grammar, &def));
    CHECK(espGrammarWarnings(context, grammar)[0] == 0);

    /* Triangles on request. */
    EspTriangles triangles = {.structSize = sizeof triangles};
    OK(context, espMaterialise(context, &triangles));
    CHECK(triangles.vertexCount > 1000 && triangles.indexCount > 1000 && triangles.indexCount % 3 == 0);
    for (uint64_t i = 0; i < triangles.indexCount; ++i) CHECK(triangles.indices[i] < triangles.vertexCount);

    /* Ids: what is gone is refused, and not taken for what came after it. */
    OK(context, espRemoveSeed(context, first));
    REFUSED(espRemoveSeed(context, first));
    const EspSeed third = plant(context, grammar, 1.6f, 1, 0.36f, 3);
    CHECK(third.id != first.id && espRemoveSeed(context, first) == ESP_INVALID_ARGUMENT);
    OK(context, espRemoveAllSeeds(context));
    plant(context, grammar, hit.position[0], hit.position[1], hit.position[2], 1);
    plant(context, grammar, hit.position[0] + 0.3f, hit.position[1], hit.position[2], 2);
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == grown.hash);

    /* A second, smaller ruin beside the first; away with it, and with the grammar. */
    EspTransform place = espIdentity();
    for (int i = 0; i < 3; ++i) place.rows[i][i] = 0.5f;
    place.rows[0][3] = 20;
    EspSurface second = {0};
    OK(context, espLoadSurface(context, surfacePath, &place, &second));
    EspSurfaceInfo secondInfo = {.structSize = sizeof secondInfo};
    OK(context, espSurfaceInfo(context, second, &secondInfo));
    CHECK(fabs(secondInfo.walkableArea * 4 / info.walkableArea - 1) < 1e-3);
    plant(context, grammar, 20 + hit.position[0] / 2, hit.position[1] / 2, hit.position[2] / 2, 4);
    OK(context, espUpdate(context));
    CHECK(stats(context).seeds == 3 && stats(context).nodes > grown.nodes);
    OK(context, espDestroySurface(context, second));
    REFUSED(espSurfaceInfo(context, second, &secondInfo));
    OK(context, espUpdate(context));
    CHECK(stats(context).seeds == 2 && stats(context).hash == grown.hash);
    OK(context, espDestroyGrammar(context, grammar));
    OK(context, espUpdate(context));
    CHECK(stats(context).seeds == 0 && stats(context).nodes == 0);
    CHECK(drawn(context) > 1000);
    CHECK(stats(context).validationMessages == 0);
    return grown.hash;
}

/* Wide shapes grow on a coarser level of the surface, and a parameter may say how wide they are. */
static void widthIsFollowed(EspContext* context) {
    static const char* text =
        "param thick = 0 [0 .. 1] \"m\" \"Width\"\n"
        "width thick\n"
        "Vine -> Marching(0.05, rand(-0.3, 0.3), arc < 2) {Vine, S(0.01) Shape(\"bark\", C1)}\n";
    EspGrammarDef def = {sizeof def, "thick", text, strlen(text)};
    EspSurface surface = {0};
    EspGrammar grammar = {0};
    EspSurfaceInfo info = {.structSize = sizeof info};
    OK(context, espLoadSurface(context, surfacePath, NULL, &surface));
    OK(context, espSurfaceInfo(context, surface, &info));
    CHECK(info.levels > 2);
    OK(context, espCompileGrammar(context, &def, &grammar));
    plant(context, grammar, -1.35f, 1, 0.36f, 1);
    OK(context, espUpdate(context));
    const EspStats finest = stats(context);
    CHECK(finest.nodes > 10);
    const float wide = 0.2f, thin = 1e-6f, none = 0;
    OK(context, espSetParam(context, grammar, "thick", &wide, 1));
    OK(context, espUpdate(context));
    CHECK(stats(context).expansions == finest.expansions + 1);
    CHECK(stats(context).nodes > 10 && stats(context).hash != finest.hash);
    OK(context, espSetParam(context, grammar, "thick", &thin, 1));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == finest.hash);
    OK(context, espSetParam(context, grammar, "thick", &wide, 1));
    OK(context, espSetParam(context, grammar, "thick", &none, 1));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == finest.hash);
}

/* Two ruins, one on top of the other's ground: plants go over, and nothing is left of that when one is moved away. */
static void surfacesTouch(EspContext* context) {
    EspSurface ground = {0}, wall = {0};
    EspGrammar grammar = {0};
    EspGrammarDef def = ivy();
    EspTransform place = espIdentity();
    EspSurfaceInfo info = {.structSize = sizeof info};
    OK(context, espCompileGrammar(context, &def, &grammar));
    OK(context, espLoadSurface(context, surfacePath, NULL, &ground));
    plant(context, grammar, -1.35f, 0.1f, 0.4f, 3);
    OK(context, espUpdate(context));
    const uint64_t alone = stats(context).hash;
    CHECK(stats(context).contacts == 0);

    place.rows[0][3] = 1.5f;
    place.rows[2][3] = 1.2f;
    OK(context, espLoadSurface(context, surfacePath, &place, &wall));
    OK(context, espUpdate(context));
    const uint64_t joined = stats(context).hash;
    const uint32_t contacts = stats(context).contacts;
    CHECK(contacts > 100 && stats(context).contactMs > 0);
    CHECK(drawn(context) > 500);

    place.rows[0][3] = 40;
    OK(context, espMoveSurface(context, wall, &place));
    OK(context, espSurfaceInfo(context, wall, &info));
    CHECK(info.boundsMin[0] > 20 && info.triangles > 1000);
    OK(context, espUpdate(context));
    CHECK(stats(context).contacts == 0);
    CHECK(stats(context).hash == alone);

    place.rows[0][3] = 1.5f;
    OK(context, espMoveSurface(context, wall, &place));
    OK(context, espUpdate(context));
    CHECK(stats(context).contacts == contacts);
    CHECK(stats(context).hash == joined);

    /* Its seeds go with a surface. */
    EspSeed seed = plant(context, grammar, 1.5f - 1.35f, 2.5f, 1.2f + 0.4f, 5);
    EspSeedInfo before = {.structSize = sizeof before}, after = {.structSize = sizeof after};
    OK(context, espSeedInfo(context, seed, &before));
    CHECK(before.surface.id == wall.id);
    place.rows[1][3] = 7;
    OK(context, espMoveSurface(context, wall, &place));
    OK(context, espSeedInfo(context, seed, &after));
    CHECK(fabsf(after.position[1] - before.position[1] - 7) < 1e-4f && after.surface.id == wall.id);

    place.rows[0][0] = 2; /* stretched */
    REFUSED(espMoveSurface(context, wall, &place));
    REFUSED(espMoveSurface(context, (EspSurface){0}, &place));
    REFUSED(espMoveSurface(context, wall, NULL));
    OK(context, espDestroySurface(context, wall));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == alone);
    CHECK(stats(context).validationMessages == 0);
}

/* A layer that is carried to the bake that it lies over stays as it was, and next to nothing is lost or fresh. */
static void carries(void) {
    EspCarry* carry = NULL;
    CHECK(espCreateCarry(surfacePath, surfacePath, &carry) == ESP_OK);
    const uint32_t side = espCarrySide(carry);
    CHECK(side >= 64);
    const size_t count = (size_t)side * side;
    float* texels = malloc(count * sizeof *texels);
    float* out = malloc(count * sizeof *out);
    for (size_t i = 0; i < count; ++i) texels[i] = (float)(i % side) / (float)side;
    EspCarried carried = {sizeof carried, 1, 1};
    CHECK(espCarryLayer(carry, texels, side, side, .5f, out, &carried) == ESP_OK);
    CHECK(carried.fresh < .2 && carried.lost < .2); /* m²: slivers that face elsewhere than their neighbours */
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) kept += fabsf(out[i] - texels[i]) < 1.5f / (float)side;
    CHECK(kept > count / 20 * 9); /* the rest is no ground */
    CHECK(espCarryLayer(carry, texels, 0, side, .5f, out, NULL) == ESP_INVALID_ARGUMENT);
    CHECK(espCarryLayer(carry, texels, side, side, NAN, out, NULL) == ESP_INVALID_ARGUMENT);
    /* Values are what layers hold, whatever comes in. */
    for (size_t i = 0; i < count; ++i) texels[i] = i % 3 == 0 ? NAN : i % 3 == 1 ? 7 : -INFINITY;
    CHECK(espCarryLayer(carry, texels, side, side, 3, out, NULL) == ESP_OK);
    size_t within = 0;
    for (size_t i = 0; i < count; ++i) within += out[i] >= 0 && out[i] <= 1;
    CHECK(within == count);
    espDestroyCarry(carry);
    free(out);
    free(texels);
}

int main(int argc, char** argv) {
    CHECK(argc == 3);
    programPath = argv[0];
    snprintf(surfacePath, sizeof surfacePath, "%s/ruin.surface.glb", argv[1]);
    const char* cache = argv[2];
    CHECK(strcmp(espVersion(), "0.1.0") == 0);
    espDestroy(NULL);
    EspCarry* carry = NULL;
    CHECK(espCreateCarry("/no/such.glb", "/no/such.glb", &carry) == ESP_IO_FAILED && !carry);
    CHECK(strstr(espLastError(NULL), "/no/such.glb") != NULL);
    CHECK(espCarrySide(NULL) == 0);
    CHECK(espCarryLayer(NULL, NULL, 1, 1, 0, NULL, NULL) == ESP_INVALID_ARGUMENT);
    espDestroyCarry(NULL);
    float rgb[3], most;
    CHECK(espViewColour(ESP_VIEW_DEPTH, NAN, rgb, &most) == ESP_INVALID_ARGUMENT);
    CHECK(espViewColour(ESP_VIEW_DEPTH, 3, rgb, &most) == ESP_OK && rgb[0] >= 0 && rgb[0] <= 1);
    carries();

    EspContext* own = create(NULL, NULL);
    const uint64_t hash = wholeLife(own);
    espDestroy(own);

    const EspHostDevice host = makeHost(VK_API_VERSION_1_3);
    EspContext* hosted = create(&host, cache);
    CHECK(wholeLife(hosted) == hash);
    espDestroy(hosted);
    /* With grammars from the cache: the same again. */
    hosted = create(&host, cache);
    CHECK(wholeLife(hosted) == hash);
    espDestroy(hosted);

    EspContext* wide = create(NULL, NULL);
    widthIsFollowed(wide);
    espDestroy(wide);

    EspContext* several = create(NULL, NULL);
    surfacesTouch(several);
    espDestroy(several);

    EspContext* refused = create(NULL, NULL);
    logged = 0;
    badArguments(refused);
    CHECK(logged > 10); /* errors reach the host's log */
    espDestroy(refused);

    EspContextDef def = {.structSize = sizeof def};
    espDefaultContextDef(&def);
    EspContext* context = NULL;
    def.terminals = "no/such/terminals.glb";
    CHECK(espCreate(ESP_VERSION, &def, &context) == ESP_IO_FAILED && context == NULL);
    CHECK(strstr(espLastError(NULL), "terminals.glb") != NULL);
    EspHostDevice half = host;
    half.queue = NULL;
    espDefaultContextDef(&def);
    def.host = &half;
    CHECK(espCreate(ESP_VERSION, &def, &context) == ESP_INVALID_ARGUMENT && context == NULL);
    half = host;
    half.deviceInfo = NULL;
    CHECK(espCreate(ESP_VERSION, &def, &context) == ESP_INVALID_ARGUMENT && context == NULL);
    CHECK(strstr(espLastError(NULL), "deviceInfo") != NULL);

    /* An instance that is too old is called so. */
    const EspHostDevice old = makeHost(VK_API_VERSION_1_1);
    def.host = &old;
    CHECK(espCreate(ESP_VERSION, &def, &context) == ESP_NO_DEVICE && context == NULL);
    CHECK(strstr(espLastError(NULL), "apiVersion") != NULL);
    vkDestroyDevice((VkDevice)old.device, NULL);
    vkDestroyInstance((VkInstance)old.instance, NULL);
    vkDestroyDevice((VkDevice)host.device, NULL);
    vkDestroyInstance((VkInstance)host.instance, NULL);
    printf("the C interface: all checks passed\n");
    return 0;
}
