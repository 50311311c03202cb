/* Procedural graphs through the C interface: texts, inputs, time, what nodes make, pictures, bad arguments. A failed
 * check prints its line and ends the program with 1. */
#include <math.h>
#include <string.h>

#include "tests/plugin/check.h"

enum { kSide = 96 };

static const char* kText =
    "graph 1\n"
    "time = Time\n"
    "points = Particles(count: 20, time: time.frame)\n"
    "ball = Sphere(radius: 0.2, sides: 12)\n"
    "balls = Scatter(points, ball)\n"
    "show balls\n";

static EspGraphDef defOf(const char* text) {
    EspGraphDef def = {.structSize = sizeof def};
    def.name = "test.graph";
    def.text = text;
    def.length = strlen(text);
    return def;
}

static EspGraphStats statsOf(EspContext* context, EspGraph graph) {
    EspGraphStats stats = {.structSize = sizeof stats};
    OK(context, espGraphStats(context, graph, &stats));
    return stats;
}

static EspResult setNumber(EspContext* context, EspGraph graph, const char* node, const char* input, float number) {
    EspGraphInput set = {.structSize = sizeof set};
    set.kind = ESP_GRAPH_NUMBER;
    set.node = node;
    set.input = input;
    set.numbers[0] = number;
    return espSetGraphInput(context, graph, &set);
}

/* Pixels that differ from those of the first picture, which shows nothing. */
static int drawn(EspContext* context) {
    static unsigned char pixels[kSide * kSide * 4], empty[kSide * kSide * 4];
    static int known = 0;
    EspDrawDef draw = {.structSize = sizeof draw};
    EspCamera camera = {.structSize = sizeof camera};
    espDefaultDrawDef(&draw);
    espDefaultCamera(&camera);
    camera.target[1] = 0;
    draw.camera = &camera;
    draw.width = draw.height = kSide;
    OK(context, espDraw(context, &draw));
    OK(context, espReadPixels(context, pixels, sizeof pixels));
    if (!known) memcpy(empty, pixels, sizeof pixels);
    known = 1;
    int different = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        int apart = 0;
        for (int k = 0; k < 3; ++k) apart += abs(pixels[4 * i + k] - empty[4 * i + k]);
        different += apart > 30;
    }
    return different;
}

static void badArguments(EspContext* context, EspGraph graph) {
    EspGraph none = {77}, out = {0};
    EspGraphDef def = defOf(kText), null = {.structSize = sizeof null, .length = 5};
    EspGraphStats stats = {.structSize = sizeof stats};
    EspGraphPart part = {.structSize = sizeof part};
    EspGraphInput input = {.structSize = sizeof input};
    REFUSED(espCompileGraph(NULL, &def, &out));
    REFUSED(espCompileGraph(context, NULL, &out));
    REFUSED(espCompileGraph(context, &def, NULL));
    REFUSED(espCompileGraph(context, &null, &out));
    REFUSED(espRecompileGraph(context, none, &def));
    REFUSED(espDestroyGraph(context, none));
    REFUSED(espSetGraphTime(context, none, 0, 1));
    REFUSED(espSetGraphTime(context, graph, -1, 1));
    REFUSED(espSetGraphTime(context, graph, 0.5, 1));
    REFUSED(espSetGraphTime(context, graph, NAN, 1));
    REFUSED(espSetGraphTime(context, graph, 1, 0));
    REFUSED(espSetGraphTime(context, graph, 1, INFINITY));
    REFUSED(espSetGraphInput(context, graph, NULL));
    REFUSED(espSetGraphInput(context, graph, &input));
    input.node = input.input = "points";
    input.kind = ESP_GRAPH_TEXT;
    REFUSED(espSetGraphInput(context, graph, &input));
    REFUSED(espGraphStats(context, none, &stats));
    REFUSED(espGraphStats(context, graph, NULL));
    REFUSED(espReadGraphPart(context, none, "ball", NULL, 0, &part));
    REFUSED(espReadGraphPart(context, graph, NULL, NULL, 0, &part));
    REFUSED(espReadGraphPart(context, graph, "time", NULL, 0, &part));
    REFUSED(espReadGraphPart(context, graph, "ball", "inside", 0, &part));
    REFUSED(espReadGraphPart(context, graph, "ball", NULL, 1, &part));
    CHECK(*espGraphText(context, none) == 0 && *espGraphText(NULL, graph) == 0);
    CHECK(*espGraphFailures(context, none) == 0 && *espGraphFailures(NULL, graph) == 0);
    CHECK(setNumber(context, graph, "points", "count", 0) == ESP_INVALID_CONTENT);
    CHECK(strstr(espLastError(context), "'count' is 0, which isn't 1 to") != NULL);
    CHECK(setNumber(context, graph, "points", "time", 1) == ESP_INVALID_CONTENT); /* wired */
    def = defOf("graph 1\na = Cube(cells: b)\n");
    CHECK(espCompileGraph(context, &def, &out) == ESP_INVALID_CONTENT && out.id == 0);
    CHECK(strstr(espLastError(context), "test.graph:2:17: a: there is no node 'b'") != NULL);
    CHECK(espRecompileGraph(context, graph, &def) == ESP_INVALID_CONTENT);
    CHECK(strcmp(espGraphText(context, graph), kText) == 0);
}

int main(void) {
    EspContext* context = NULL;
    EspContextDef contextDef = {.structSize = sizeof contextDef};
    espDefaultContextDef(&contextDef);
    OK(NULL, espCreate(ESP_VERSION, &contextDef, &context));
    EspGraph graph = {0};
    EspGraphDef def = defOf(kText);
    OK(context, espUpdate(context));
    CHECK(drawn(context) == 0);
    OK(context, espCompileGraph(context, &def, &graph));
    OK(context, espUpdate(context));
    EspGraphStats stats = statsOf(context, graph);
    CHECK(stats.nodes == 4 && stats.evaluated == 4 && stats.evaluations == 1 && stats.parts == 1 &&
          stats.instances == 20);
    CHECK(stats.triangles == 12 * 6 * 2 && stats.boundsMin[0] >= -1.4f && stats.boundsMax[0] <= 1.4f);
    CHECK(drawn(context) > 300);

    OK(context, espUpdate(context));
    CHECK(statsOf(context, graph).evaluations == 1);
    OK(context, espSetGraphTime(context, graph, 40, 1.0 / 30));
    OK(context, espUpdate(context));
    stats = statsOf(context, graph);
    CHECK(stats.evaluations == 2 && stats.evaluated == 3);
    OK(context, setNumber(context, graph, "ball", "radius", 0.1f));
    OK(context, espUpdate(context));
    CHECK(statsOf(context, graph).evaluated == 2);
    CHECK(strstr(espGraphText(context, graph), "ball = Sphere(radius: 0.1, sides: 12)\n") != NULL);
    OK(context, espRecompileGraph(context, graph, &def));

    EspGraphPart part = {.structSize = sizeof part};
    OK(context, espReadGraphPart(context, graph, "ball", NULL, 0, &part));
    CHECK(part.kind == ESP_GRAPH_MESH && part.partCount == 1 && part.positionCount == 13 * 7 &&
          part.instanceCount == 1);
    CHECK(part.indexCount == 3 * 12 * 6 * 2 && part.indices[part.indexCount - 1] < part.positionCount);
    for (uint32_t i = 0; i < part.positionCount; ++i) {
        const float* p = part.positions + 3 * i;
        CHECK(fabsf(sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) - 0.2f) < 1e-6f);
    }
    OK(context, espReadGraphPart(context, graph, "points", "points", 0, &part));
    CHECK(part.kind == ESP_GRAPH_POINTS && part.positionCount == 20 && part.indexCount == 0);
    badArguments(context, graph);

    /* A node fails: what it made last is still there. */
    def = defOf(
        "graph 1\npoints = Particles(count: 3)\ncurves = SubsetCurves(points)\nring = Circle\n"
        "tubes = Loft(curves, ring)\nshow tubes\n");
    EspGraph other = {0};
    OK(context, espCompileGraph(context, &def, &other));
    OK(context, espUpdate(context));
    CHECK(strcmp(espGraphFailures(context, other),
                 "test.graph:3:1: curves: a curve through 8 points needs as many, but there are 3") == 0);
    OK(context, setNumber(context, other, "curves", "keys", 3));
    OK(context, espUpdate(context));
    CHECK(*espGraphFailures(context, other) == 0 && statsOf(context, other).triangles > 0);
    OK(context, espDestroyGraph(context, other));
    OK(context, espDestroyGraph(context, graph));
    OK(context, espUpdate(context));
    CHECK(drawn(context) == 0);
    espDestroy(context);
    return 0;
}
