/* A town through the C interface: loading and placing, houses and their edits, layers, strokes and undo, bad arguments.
 * A failed check prints its line and ends the program with 1. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/plugin/check.h"

enum { kHouses = 8 };

/* Houses of 10 × 8 m, 20 m apart along x, their north walls at z = -8. */
static const char* town(void) {
    static char text[4096];
    size_t at = (size_t)sprintf(text, "{\"buildings\": [");
    for (int i = 0; i < kHouses; ++i)
        at += (size_t)sprintf(text + at, "%s{\"id\": \"h%d\", \"outer\": [[%d,0],[%d,0],[%d,8],[%d,8]]}", i ? "," : "",
                              i, 20 * i, 20 * i + 10, 20 * i + 10, 20 * i);
    sprintf(text + at, "]}");
    return text;
}

/* Walls rise by `rise` where the house is painted; tiles go by `decay`, which costs no growth. */
static const char* kGrammar =
    "context rise = 0\n"
    "context decay = 0\n"
    "House -> Extrude(wallHeight * (1 + rise(house))) {Wall, Top}\n"
    "Wall -> Shape(\"panel\")\n"
    "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
    "Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}\n"
    "Tile -> Drop(decay) Shape(\"slate\")\n";

static EspRoofStats stats(EspContext* context) {
    EspRoofStats s = {.structSize = sizeof s};
    OK(context, espReadRoofStats(context, &s));
    return s;
}

enum { kSide = 256 };

static EspCamera camera;
static EspLook look;

/* The first house seen from straight above, near enough for each tile to be one. */
static EspDrawDef fromAbove(void) {
    EspDrawDef draw = {.structSize = sizeof draw};
    camera.structSize = sizeof camera;
    look.structSize = sizeof look;
    espDefaultDrawDef(&draw);
    espDefaultCamera(&camera);
    espDefaultLook(&look);
    draw.width = draw.height = kSide;
    draw.camera = &camera;
    draw.look = &look;
    camera.eye[0] = camera.target[0] = 5;
    camera.eye[1] = 20;
    camera.target[1] = 0;
    camera.eye[2] = -4.f;
    camera.target[2] = -4.1f;
    look.shadows = 0;
    return draw;
}

static uint32_t drawnTiles(EspContext* context) {
    const EspDrawDef draw = fromAbove();
    OK(context, espDraw(context, &draw));
    return stats(context).drawnTiles;
}

/* In how many pixels that view differs from the picture `other`, which becomes its own. */
static int shownOtherwise(EspContext* context, const EspDrawDef* draw, uint8_t* other) {
    static uint8_t now[kSide * kSide * 4];
    int count = 0;
    OK(context, espUpdate(context));
    OK(context, espDraw(context, draw));
    OK(context, espReadPixels(context, now, sizeof now));
    for (int i = 0; i < kSide * kSide; ++i)
        count += abs(now[4 * i] - other[4 * i]) + abs(now[4 * i + 1] - other[4 * i + 1]) > 12;
    memcpy(other, now, sizeof now);
    return count;
}

static EspStroke dab(EspContext* context, const char* layer, float x, float z, float radius) {
    EspBrush brush = {.structSize = sizeof brush};
    espDefaultBrush(&brush);
    EspDab at = {{0, 0, 0}, {0, 1, 0}, 1};
    EspStroke stroke = {0};
    brush.layer = layer;
    brush.radius = radius;
    brush.strength = brush.hardness = 1;
    at.position[0] = x;
    at.position[1] = 40; /* height doesn't matter */
    at.position[2] = z;
    OK(context, espBeginStroke(context, &brush, &stroke));
    OK(context, espStrokeDabs(context, stroke, &at, 1));
    OK(context, espEndStroke(context, stroke));
    return stroke;
}

/* A layer over roofs is seen at any opacity, where it is painted and only there. */
static void views(EspContext* context) {
    static uint8_t picture[kSide * kSide * 4];
    EspDrawDef draw = fromAbove();
    (void)shownOtherwise(context, &draw, picture);
    look.view = ESP_VIEW_LAYER;
    look.viewLayer = "rise";
    look.viewOpacity = 0;
    CHECK(shownOtherwise(context, &draw, picture) == 0);
    look.viewOpacity = .5f;
    const int half = shownOtherwise(context, &draw, picture);
    look.viewOpacity = 1;
    const int whole = shownOtherwise(context, &draw, picture);
    CHECK(half > kSide * kSide / 4 && whole > kSide * kSide / 4);
    const EspStroke stroke = dab(context, "rise", 5, -4, 1.5f);
    const int painted = shownOtherwise(context, &draw, picture);
    CHECK(painted > 1000 && painted < kSide * kSide / 2);
    OK(context, espSwapStroke(context, stroke));
    CHECK(shownOtherwise(context, &draw, picture) == painted);
    look.viewLayer = "nobody's at all";
    REFUSED(espDraw(context, &draw));
}

static void houses(EspContext* context) {
    EspHouseInfo info = {.structSize = sizeof info};
    EspHouseDef change = {.structSize = sizeof change, .shape = ESP_ROOF_GABLE, .slope = 1};
    float corners[8];
    CHECK(espHouseCount(context) == kHouses);
    OK(context, espHouseInfo(context, 3, &info));
    CHECK(!strcmp(info.id, "h3") && info.cornerCount == 4 && info.shape == ESP_ROOF_HIP);
    OK(context, espHouseShape(context, 3, corners, NULL));
    CHECK(fabsf(corners[0] - 60) < 1e-3f && fabsf(corners[1]) < 1e-3f);

    const uint64_t before = stats(context).housesGrown;
    OK(context, espSetHouse(context, 3, &change));
    OK(context, espUpdate(context));
    CHECK(stats(context).housesGrown == before + 1);
    OK(context, espHouseInfo(context, 3, &info));
    CHECK(info.shape == ESP_ROOF_GABLE && fabsf(info.ridgeHeight - info.eaveHeight - 4) < 1e-3f);
    EspHouseEdge edge = {1, 0, 2};
    change.edges = &edge;
    change.edgeCount = 1;
    change.corners = corners;
    change.cornerCount = 4;
    corners[2] += 2;
    corners[4] += 2;
    OK(context, espSetHouse(context, 3, &change));
    OK(context, espHouseInfo(context, 3, &info));
    CHECK(info.edgeCount == 1 && fabsf(info.boundsMax[0] - 72) < 1e-3f);
    EspHouseLook dressed = {sizeof dressed, ESP_COVERING_SLATE, 1, {0.5f, 0, 1}, 0.5f, ESP_CHIMNEYS_NONE};
    EspHouseLook found = {.structSize = sizeof found};
    change.look = &dressed;
    OK(context, espSetHouse(context, 3, &change));
    OK(context, espHouseInfo(context, 3, &info));
    OK(context, espHouseLook(context, 3, &found));
    CHECK(found.covering == ESP_COVERING_SLATE && found.coloured && fabsf(found.colour[0] - 0.5f) < 0.01f);
    CHECK(found.colour[1] == 0 && found.overhang == 0.5f && found.chimneys == ESP_CHIMNEYS_NONE);
    dressed.overhang = 2;
    REFUSED(espSetHouse(context, 3, &change));
    dressed.overhang = 0;
    dressed.covering = (EspCovering)99;
    REFUSED(espSetHouse(context, 3, &change));
    change.look = NULL;
    change.slope = -1;
    REFUSED(espSetHouse(context, 3, &change));
    change.slope = 1;
    edge.edge = 4;
    REFUSED(espSetHouse(context, 3, &change));
    CHECK(strstr(espLastError(context), "edge"));
    edge.edge = 1;
    edge.gable = 5;
    REFUSED(espSetHouse(context, 3, &change));
    edge.gable = 0;
    change.cornerCount = 2;
    REFUSED(espSetHouse(context, 3, &change));
    REFUSED(espSetHouse(context, kHouses, &change));
    REFUSED(espHouseInfo(context, kHouses, &info));
    OK(context, espUpdate(context));
}

/* A courtyard that comes, is moved, and goes. */
static void courtyards(EspContext* context) {
    EspHouseInfo info = {.structSize = sizeof info};
    float corners[16], now[16];
    uint32_t rings[2] = {4, 4}, found[2] = {0, 0};
    EspHouseDef change = {.structSize = sizeof change,
                          .shape = ESP_ROOF_HIP,
                          .slope = 1,
                          .corners = corners,
                          .cornerCount = 8,
                          .rings = rings,
                          .ringCount = 2};
    OK(context, espHouseShape(context, 2, corners, NULL));
    const float x = 40, z = -4; /* the house's middle less five metres along x */
    for (int i = 0; i < 4; ++i) {
        corners[8 + 2 * i] = x + (i == 0 || i == 3 ? 3.5f : 6.5f);
        corners[9 + 2 * i] = z + (i < 2 ? -1.f : 1.f);
    }
    OK(context, espSetHouse(context, 2, &change));
    OK(context, espHouseInfo(context, 2, &info));
    CHECK(info.ringCount == 2 && info.cornerCount == 8);
    OK(context, espHouseRings(context, 2, found));
    CHECK(found[0] == 4 && found[1] == 4);
    OK(context, espUpdate(context));
    const uint64_t hash = stats(context).hash;

    /* Without rings the corners are the outer one's, and the courtyard stays. */
    change.cornerCount = 4;
    change.rings = NULL;
    change.ringCount = 0;
    OK(context, espSetHouse(context, 2, &change));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == hash);
    OK(context, espHouseInfo(context, 2, &info));
    CHECK(info.ringCount == 2);
    EspHouseEdge edge = {5, 0, 0.7f}; /* of the courtyard */
    change.edges = &edge;
    change.edgeCount = 1;
    OK(context, espSetHouse(context, 2, &change));
    edge.edge = 8;
    REFUSED(espSetHouse(context, 2, &change));
    change.edges = NULL;
    change.edgeCount = 0;
    OK(context, espSetHouse(context, 2, &change));
    OK(context, espHouseShape(context, 2, now, NULL));
    float low = 1e9f;
    for (int i = 4; i < 8; ++i) low = fminf(low, now[2 * i]);
    CHECK(fabsf(low - (x + 3.5f)) < 1e-3f);

    const uint32_t few[2] = {6, 2}, many[2] = {4, 5};
    change.cornerCount = 8;
    change.ringCount = 2;
    REFUSED(espSetHouse(context, 2, &change));
    change.rings = few;
    REFUSED(espSetHouse(context, 2, &change));
    change.rings = many;
    REFUSED(espSetHouse(context, 2, &change));
    REFUSED(espHouseRings(context, 2, NULL));
    REFUSED(espHouseRings(context, kHouses, found));

    change.rings = rings;
    change.cornerCount = 4;
    change.ringCount = 1;
    OK(context, espSetHouse(context, 2, &change));
    OK(context, espHouseInfo(context, 2, &info));
    CHECK(info.ringCount == 1 && info.cornerCount == 4);
    OK(context, espResetHouse(context, 2));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash != hash);
}

/* Houses that are hidden, one and all, with what changes them meanwhile. */
static void hiding(EspContext* context) {
    EspHouseInfo info = {.structSize = sizeof info};
    OK(context, espUpdate(context));
    const EspRoofStats all = stats(context);
    OK(context, espHideHouse(context, 1, 1));
    OK(context, espHouseInfo(context, 1, &info));
    CHECK(info.hidden == 1);
    OK(context, espUpdate(context));
    const EspRoofStats one = stats(context);
    CHECK(one.tiles < all.tiles && one.tiles > 0 && one.housesGrown == all.housesGrown + 1);
    OK(context, espHideHouse(context, 1, 1)); /* it is */
    OK(context, espUpdate(context));
    CHECK(stats(context).housesGrown == one.housesGrown);

    EspHouseDef change = {.structSize = sizeof change, .shape = ESP_ROOF_GABLE, .slope = 0.9f};
    OK(context, espSetHouse(context, 1, &change));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == one.hash);
    OK(context, espHideHouse(context, 1, 0));
    OK(context, espUpdate(context));
    const uint64_t changed = stats(context).hash;
    CHECK(changed != all.hash && changed != one.hash);
    OK(context, espResetHouse(context, 1));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == all.hash && stats(context).tiles == all.tiles);

    for (uint32_t i = 0; i < kHouses; ++i) OK(context, espHideHouse(context, i, 1));
    OK(context, espUpdate(context));
    CHECK(stats(context).tiles == 0);
    for (uint32_t i = 0; i < kHouses; ++i) OK(context, espHideHouse(context, i, 0));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash == all.hash);
    REFUSED(espHideHouse(context, kHouses, 1));
    REFUSED(espHideHouse(NULL, 0, 1));
}

static void layers(EspContext* context) {
    EspTownInfo info = {.structSize = sizeof info};
    OK(context, espTownInfo(context, &info));
    CHECK(info.houses == kHouses && info.layerSide >= 158 && info.layerTexels >= 512);
    CHECK(info.layerLow[0] < 0 && info.layerLow[0] + info.layerSide > 150);

    /* A layer that houses read: those under the dab grow anew, no others. */
    const uint64_t hash = stats(context).hash;
    uint64_t before = stats(context).housesGrown;
    EspStroke up = dab(context, "rise", 45, -4, 12); /* the third house; 6 m short of its neighbours */
    OK(context, espUpdate(context));
    CHECK(stats(context).housesGrown == before + 1);
    CHECK(espTownLayerCount(context) == 1 && !strcmp(espTownLayerName(context, 0), "rise"));
    OK(context, espUpdate(context));
    CHECK(stats(context).housesGrown == before + 1); /* nothing changed since */
    OK(context, espSwapStroke(context, up));
    OK(context, espUpdate(context));
    CHECK(stats(context).housesGrown == before + 2);
    dab(context, "rise", 15, 60, 3); /* over no house */
    OK(context, espUpdate(context));
    CHECK(stats(context).housesGrown == before + 2);

    /* Tiles that are dropped cost no growth, and come back. */
    const uint32_t whole = drawnTiles(context);
    before = stats(context).housesGrown;
    EspStroke gone = dab(context, "decay", 5, -4, 2);
    CHECK(espStrokeBytes(context, gone) > 0);
    OK(context, espUpdate(context));
    const uint32_t fewer = drawnTiles(context);
    CHECK(whole > 500 && fewer < whole - 50 && fewer > whole / 2);
    CHECK(stats(context).housesGrown == before);
    OK(context, espSwapStroke(context, gone));
    OK(context, espUpdate(context));
    CHECK(drawnTiles(context) == whole);
    OK(context, espSwapStroke(context, gone));

    /* Pictures in, texels out. */
    static float picture[4] = {0, 1, 0, 1}, texels[2048 * 2048];
    EspStroke set = {0};
    uint32_t side = 0;
    OK(context, espReadTownLayer(context, "decay", NULL, &side));
    CHECK(side == info.layerTexels);
    OK(context, espSetTownLayer(context, "decay", picture, 2, 2, &set));
    side = 2048;
    OK(context, espReadTownLayer(context, "decay", texels, &side));
    CHECK(texels[0] == 0 && texels[side - 1] == 1 && texels[side * side - 1] == 1);
    OK(context, espSwapStroke(context, set));
    OK(context, espUpdate(context));
    CHECK(drawnTiles(context) == fewer);
    /* One that no grammar reads is kept, for one that will. */
    OK(context, espSetTownLayer(context, "nobody's", picture, 2, 2, NULL));
    side = 2048;
    OK(context, espReadTownLayer(context, "nobody's", texels, &side));
    EspDrawDef unseen = fromAbove();
    look.view = ESP_VIEW_LAYER;
    look.viewLayer = "nobody's";
    OK(context, espDraw(context, &unseen));
    CHECK(texels[0] == 0 && texels[side - 1] == 1);
    OK(context, espUpdate(context));
    CHECK(drawnTiles(context) == fewer);
    REFUSED(espSetTownLayer(context, "", picture, 2, 2, NULL));
    REFUSED(espSetTownLayer(context, "decay", NULL, 2, 2, NULL));
    side = 4;
    REFUSED(espReadTownLayer(context, "decay", texels, &side));

    EspStroke all = {0};
    OK(context, espFillLayer(context, "rise", 1, &all));
    OK(context, espUpdate(context));
    CHECK(stats(context).hash != hash);
    OK(context, espSwapStroke(context, all));
    OK(context, espUpdate(context));
}

/* However often a house is changed, the town is as large as it is. */
static void manyEdits(EspContext* context) {
    const EspRoofStats before = stats(context);
    uint64_t settled = 0;
    for (int i = 0; i < 1500; ++i) {
        EspHouseDef change = {.structSize = sizeof change, .shape = ESP_ROOF_HIP, .slope = i % 2 ? 1.f : 1.1f};
        EspStats all = {.structSize = sizeof all};
        OK(context, espSetHouse(context, 5, &change));
        OK(context, espUpdate(context));
        OK(context, espReadStats(context, &all));
        if (i < 700 && all.totalBytes > settled) settled = all.totalBytes;
        CHECK(i < 700 || all.totalBytes <= settled);
    }
    CHECK(stats(context).eaves == before.eaves && stats(context).houses == kHouses);
    OK(context, espResetHouse(context, 5));
    OK(context, espUpdate(context));
    CHECK(stats(context).eaves == before.eaves);
}

/* What is upright below the eaves are walls. */
static void triangles(EspContext* context) {
    EspTriangles t = {.structSize = sizeof t};
    OK(context, espMaterialise(context, &t));
    CHECK(t.vertexCount > 1000 && t.indexCount % 3 == 0 && t.indexCount > 1000);
    double walls = 0;
    for (uint64_t i = 0; i < t.indexCount; i += 3) {
        float p[3][3];
        for (int k = 0; k < 3; ++k) {
            CHECK(t.indices[i + k] < t.vertexCount);
            memcpy(p[k], (const char*)t.vertices + 16 * (size_t)t.indices[i + k], 12);
        }
        const double ax = p[1][0] - p[0][0], ay = p[1][1] - p[0][1], az = p[1][2] - p[0][2];
        const double bx = p[2][0] - p[0][0], by = p[2][1] - p[0][1], bz = p[2][2] - p[0][2];
        const double nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
        const double area = sqrt(nx * nx + ny * ny + nz * nz) / 2;
        if (p[0][1] < 6.01f && p[1][1] < 6.01f && p[2][1] < 6.01f && fabs(ny) < 1e-6) walls += area;
    }
    /* 6 m high around 10 × 8 m; one house is 12 m long. */
    CHECK(fabs(walls - 6 * (kHouses * 36.0 + 4)) < 25);
}

/* A town whose grammar was destroyed has no triangles, before the update that takes its roofs away and after it. */
static void grammarGone(EspContext* context, EspGrammar grammar) {
    EspTriangles t = {.structSize = sizeof t};
    OK(context, espMaterialise(context, &t));
    CHECK(t.indexCount > 1000);
    OK(context, espDestroyGrammar(context, grammar));
    for (int i = 0; i < 2; ++i) {
        OK(context, espMaterialise(context, &t));
        CHECK(t.vertexCount == 0 && t.indexCount == 0);
        OK(context, espUpdate(context));
    }
}

/* Where a town's plan has its origin, in degrees or in metres of the plan. */
static void origins(EspContext* context) {
    static const char* const degrees =
        "{\"type\": \"Polygon\", \"coordinates\": [[[11.5,48.1],[11.5002,48.1],[11.5002,48.1001],[11.5,48.1]]]}";
    static const char* const far =
        "{\"buildings\": [{\"outer\": [[691603,5334760],[691613.25,5334760],[691603,5334769.35]]}]}";
    EspTownInfo info = {.structSize = sizeof info};
    EspHouseInfo house = {.structSize = sizeof house};
    EspTownDef load = {.structSize = sizeof load};
    espDefaultTownDef(&load);
    OK(context, espTownInfo(context, &info));
    CHECK(!info.geographic && info.origin[0] == 0 && info.origin[1] == 0);
    load.text = degrees;
    load.length = strlen(degrees);
    OK(context, espLoadTown(context, &load));
    OK(context, espTownInfo(context, &info));
    CHECK(info.geographic && fabs(info.origin[0] - 11.5) < 1e-3 && fabs(info.origin[1] - 48.1) < 1e-3);
    load.text = far;
    load.length = strlen(far);
    OK(context, espLoadTown(context, &load));
    OK(context, espTownInfo(context, &info));
    CHECK(!info.geographic && info.origin[0] == 691603 && info.origin[1] == 5334760);
    OK(context, espHouseInfo(context, 0, &house));
    CHECK(fabsf(house.boundsMax[0] - house.boundsMin[0] - 10.25f) < 1e-3f);
    CHECK(fabsf(house.boundsMax[2] - house.boundsMin[2] - 9.35f) < 1e-3f);
}

int main(void) {
    EspContext* context = NULL;
    EspContextDef def = {.structSize = sizeof def};
    espDefaultContextDef(&def);
    EspGrammar grammar = {0}, ivy = {0};
    EspGrammarDef text = {sizeof text, "town", kGrammar, strlen(kGrammar)};
    def.validation = 1;
    OK(context, espCreate(ESP_VERSION, &def, &context));

    EspTownDef load = {.structSize = sizeof load};
    espDefaultTownDef(&load);
    CHECK(load.ground == 1);
    REFUSED(espLoadTown(context, &load));
    load.text = "{}";
    load.length = 2;
    CHECK(espLoadTown(context, &load) == ESP_INVALID_CONTENT);
    load.text = town();
    load.length = strlen(load.text);
    load.grammar.id = 77;
    REFUSED(espLoadTown(context, &load));
    load.grammar.id = 0;
    EspHouseInfo house = {.structSize = sizeof house};
    EspTownInfo info = {.structSize = sizeof info};
    REFUSED(espTownInfo(context, &info));
    REFUSED(espHouseInfo(context, 0, &house));
    REFUSED(espSetTownGrammar(context, grammar));

    OK(context, espCompileGrammar(context, &text, &grammar));
    const char* walks = "A -> Marching(0.1, 0, arc < 1) {A}\n";
    text.text = walks;
    text.length = strlen(walks);
    OK(context, espCompileGrammar(context, &text, &ivy));
    OK(context, espLoadTown(context, &load));
    REFUSED(espSetTownGrammar(context, ivy));
    OK(context, espSetTownGrammar(context, grammar));
    OK(context, espUpdate(context));
    CHECK(stats(context).houses == kHouses && stats(context).tiles > 1000 && stats(context).housesGrown == kHouses);

    houses(context);
    courtyards(context);
    hiding(context);
    layers(context);
    views(context);
    triangles(context);
    manyEdits(context);

    /* Furnishing: what can't stand is refused by name, and the last that stood goes on. */
    EspPropPlace place = {"bench", {1, 0, 1}, 0, 1};
    const uint8_t street[8] = {255, 0, 255, 255, 0, 0, 255, 255};
    EspSiteDef site = {sizeof site, street, 2, 1, {0, 0}, {10, 10}};
    CHECK(espSetProps(context, "/no/such/file.glb", &place, 1) == ESP_IO_FAILED);
    CHECK(strstr(espLastError(context), "/no/such/file.glb") != NULL);
    REFUSED(espSetProps(context, "/no/such/file.glb", NULL, 1));
    OK(context, espSetProps(context, NULL, NULL, 0));
    OK(context, espSetSite(context, &site));
    site.high[0] = 0;
    REFUSED(espSetSite(context, &site));
    site.width = 0;
    REFUSED(espSetSite(context, &site));
    OK(context, espSetSite(context, NULL));

    /* Turned by a right angle and moved: what lay to the east lies to the north. */
    load.turn = 1.57079633f;
    load.position[0] = 100;
    load.position[1] = 5;
    load.grammar = grammar;
    OK(context, espLoadTown(context, &load));
    OK(context, espHouseInfo(context, 7, &house));
    CHECK(fabsf(house.boundsMin[0] - 92) < 1e-2f && fabsf(house.boundsMin[2] + 150) < 1e-2f && house.baseHeight == 5);
    OK(context, espUpdate(context));
    grammarGone(context, grammar);
    load.turn = 0;
    load.grammar.id = 0;
    OK(context, espLoadTown(context, &load));
    origins(context);
    OK(context, espRemoveTown(context));
    CHECK(espHouseCount(context) == 0);
    OK(context, espUpdate(context));

    EspStats all = {.structSize = sizeof all};
    OK(context, espReadStats(context, &all));
    CHECK(all.validationMessages == 0);
    espDestroy(context);
    printf("towns through the C interface: all checks passed\n");
    return 0;
}
