/* Bad arguments and bad content: refused, and nothing has changed. */
#include <math.h>
#include <string.h>

#include "tests/plugin/c_abi.h"

void badArguments(EspContext* context) {
    EspSurface surface = {0}, none = {77};
    EspGrammar grammar = {0}, noGrammar = {12345};
    EspGrammarDef def = ivy();
    EspHit hit = {.structSize = sizeof hit};
    EspStats s = {.structSize = sizeof s};
    const float point[3] = {0, 0, 0}, bad[3] = {NAN, 0, 0};

    REFUSED(espCreate(ESP_VERSION, NULL, NULL));
    REFUSED(espFrameAll(NULL, NULL));
    CHECK(espTrim(NULL) == ESP_INVALID_ARGUMENT && espWatchGrowth(NULL, NULL, NULL) == ESP_INVALID_ARGUMENT);
    CHECK(espUpdate(NULL) == ESP_INVALID_ARGUMENT && espDraw(NULL, NULL) == ESP_INVALID_ARGUMENT);
    CHECK(espParamCount(NULL, grammar) == 0 && espLayerName(context, noGrammar, 0)[0] == 0);
    CHECK(espGrammarWarnings(context, noGrammar)[0] == 0 && espGrammarWarnings(NULL, grammar)[0] == 0);
    CHECK(espReadStats(context, NULL) == ESP_INVALID_ARGUMENT && espLastError(context)[0] != 0);
    REFUSED(espLoadSurface(context, NULL, NULL, &surface));
    REFUSED(espLoadGround(context, NULL, NULL, &surface));
    CHECK(espLoadSurface(context, "no/such/file.glb", NULL, &surface) == ESP_IO_FAILED);
    CHECK(strstr(espLastError(context), "no/such/file.glb") != NULL && surface.id == 0);
    CHECK(espLoadSurface(context, ".", NULL, &surface) == ESP_IO_FAILED);
    CHECK(espLoadSurface(context, programPath, NULL, &surface) == ESP_INVALID_CONTENT);
    EspTransform skewed = espIdentity();
    skewed.rows[0][0] = 2;
    REFUSED(espLoadSurface(context, surfacePath, &skewed, &surface));
    skewed.rows[0][0] = 1;
    skewed.rows[0][1] = -1;
    REFUSED(espLoadSurface(context, surfacePath, &skewed, &surface));
    skewed.rows[0][1] = 0;
    skewed.rows[0][0] = NAN;
    REFUSED(espLoadSurface(context, surfacePath, &skewed, &surface));
    REFUSED(espDestroySurface(context, none));
    REFUSED(espNearest(context, point, &hit));
    CHECK(espNearest(context, bad, &hit) == ESP_INVALID_ARGUMENT && espPick(context, point, point, &hit) != ESP_OK);

    EspGrammarDef empty = {sizeof empty, "empty.grammar", "", 0}, null = {sizeof null, NULL, NULL, 5};
    CHECK(espCompileGrammar(context, &empty, &grammar) == ESP_INVALID_CONTENT);
    CHECK(strstr(espLastError(context), "empty.grammar") != NULL);
    REFUSED(espCompileGrammar(context, &null, &grammar));
    OK(context, espCompileGrammar(context, &def, &grammar));
    const float nan = NAN, one = 1, three[3] = {1, 1, 1};
    REFUSED(espSetParam(context, grammar, "reach", &nan, 1));
    REFUSED(espSetParam(context, grammar, "nothing", &one, 1));
    CHECK(strstr(espLastError(context), "nothing") != NULL);
    REFUSED(espSetParam(context, grammar, "reach", &one, 0));
    REFUSED(espSetParam(context, grammar, "reach", three, 3));

    EspSeedDef seed = {.structSize = sizeof seed};
    espDefaultSeedDef(&seed);
    EspSeed planted;
    seed.grammar = grammar;
    REFUSED(espPlant(context, &seed, &planted)); /* no surface yet */
    OK(context, espLoadSurface(context, surfacePath, NULL, &surface));
    seed.symbol = "Wood"; /* draws, but doesn't grow */
    REFUSED(espPlant(context, &seed, &planted));
    seed.symbol = NULL;
    seed.position[1] = INFINITY;
    REFUSED(espPlant(context, &seed, &planted));
    seed.position[1] = 0;
    seed.grammar = noGrammar;
    REFUSED(espPlant(context, &seed, &planted));

    EspLayerDef layer = {.structSize = sizeof layer};
    espDefaultLayerDef(&layer);
    layer.surface = surface;
    layer.name = "mask";
    layer.texels = &one;
    REFUSED(espSetLayer(context, &layer)); /* 0 x 0 */
    layer.width = 9000;
    layer.height = 1;
    CHECK(espSetLayer(context, &layer) == ESP_INVALID_ARGUMENT && strstr(espLastError(context), "9000") != NULL);
    layer.width = 1;
    layer.surface = none;
    REFUSED(espSetLayer(context, &layer));

    EspDrawDef draw = {.structSize = sizeof draw};
    EspCamera camera = {.structSize = sizeof camera};
    EspLook look = {.structSize = sizeof look};
    espDefaultDrawDef(&draw);
    espDefaultCamera(&camera);
    espDefaultLook(&look);
    draw.width = 0;
    REFUSED(espDraw(context, &draw));
    draw.width = 20000;
    REFUSED(espDraw(context, &draw));
    espDefaultDrawDef(&draw);
    draw.camera = &camera;
    draw.look = &look;
    camera.eye[0] = NAN;
    REFUSED(espDraw(context, &draw));
    espDefaultCamera(&camera);
    float* const numbers[] = {&look.sunColour[1], &look.horizon[2], &look.exposure,
                              &look.lodPixels,    &look.leafPixels, &look.groundLevel};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
        const float before = *numbers[i];
        *numbers[i] = i % 2 ? NAN : INFINITY;
        REFUSED(espDraw(context, &draw));
        *numbers[i] = before;
    }
    look.view = ESP_VIEW_LAYER;
    look.viewLayer = "no such layer";
    REFUSED(espDraw(context, &draw));
    look.view = (EspView)99;
    REFUSED(espDraw(context, &draw));
    espDefaultLook(&look);
    EspBrush nameless = {.structSize = sizeof nameless};
    espDefaultBrush(&nameless);
    look.viewBrush = &nameless;
    OK(context, espDraw(context, &draw)); /* it is for the view of a layer */
    look.view = ESP_VIEW_LAYER;
    REFUSED(espDraw(context, &draw));
    uint8_t pixel[4];
    REFUSED(espReadPixels(context, pixel, sizeof pixel));
    EspGrowDef grow = {.structSize = sizeof grow};
    espDefaultGrowDef(&grow);
    grow.maxNodes = 0;
    REFUSED(espSetGrow(context, &grow));

    /* After all that it still works. */
    plant(context, grammar, 0, 1, 0, 1);
    OK(context, espUpdate(context));
    OK(context, espReadStats(context, &s));
    CHECK(s.nodes > 0 && drawn(context) > 1000);
}
