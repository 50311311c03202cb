// Drawing roofs: grids are looked at one by one, of near ones the rows, of rows the cells. Whole cells are instances of a
// mesh, cells that an outline crosses are instances with planes, far grids are rectangles whose pattern stands for cells.
#ifndef ESPALIER_ROOF_DRAW_RECORDS_H
#define ESPALIER_ROOF_DRAW_RECORDS_H
#include "shaders/render/frame_records.h"
#include "shaders/shared/roof_records.h"

ESPALIER_BEGIN

// A row of a near grid.
struct RoofRow {
    uint grid, row;
    uint bucket;
    uint wholePlace, cutPlace;   // in the bucket
    float share;                 // of its cells that are drawn; the pattern below stands for the others
};
STATIC_SIZE(RoofRow, 24);

// cell: bits 15..0 column, 31..16 row.
struct RoofTile {
    uint grid, cell;
};
STATIC_SIZE(RoofTile, 8);

// planes: bits 7..0 of the part's planes that cut it, then of the grid's rectangle: left, right, upper.
CONST_UINT(kCutLeft, 1u << 8u);
CONST_UINT(kCutRight, 1u << 9u);
CONST_UINT(kCutUpper, 1u << 10u);
struct RoofCutTile {
    uint grid, cell;
    uint part;           // kNoIndex: none
    uint planes;
};
STATIC_SIZE(RoofCutTile, 16);

// RoofTile::cell of a row of caps, which is drawn as two halves of a small roof.
CONST_UINT(kCapLow, 0xFFFFFFFDu);
CONST_UINT(kCapHigh, 0xFFFFFFFEu);
CONST_UINT(kRectangleBelow, 1u << 31u);   // RoofTile::grid of a pattern that lies under cells

struct RoofDrawState {
    uint rows;
    uint rowGroups[3];
    uint whole[64], cut[64];             // instances a bucket
    uint wholeStarts[64], cutStarts[64];
    DrawCommand draws[256];              // of bucket b: 2b, 2b + 1 whole ones, 128 + 2b, 128 + 2b + 1 cut ones
    uint rectangles;
    uint rectangleDraw[4];               // VkDrawIndirectCommand
    uint overflow;
    uint triangles;
    uint spare;
};
STATIC_SIZE(RoofDrawState, 6192);

BUFFER(RoofRowBuf, RoofRow)
BUFFER(RoofTileBuf, RoofTile)
BUFFER(RoofCutTileBuf, RoofCutTile)
BUFFER(RoofDrawStateBuf, RoofDrawState)

// What lies open of a covering at a place across its cells.
CONST_UINT(kProfileSteps, 16u);
struct RoofProfile {
    float slope;       // of the mesh's height to its right, in the mesh's space; in the world thickness / size.x times that
    float shade;
    float steepness, meanShade;   // means of the slope's size and the shade over the cell, the same at all steps
};
STATIC_SIZE(RoofProfile, 16);
BUFFER(RoofProfileBuf, RoofProfile)

CONST_FLOAT(kDarkOfEdges, 0.35f);       // of cells' lower edges, where these are too small to be lit as they stand
CONST_FLOAT(kRoughnessOfGlass, 0.2f);   // what is less rough mirrors

CONST_UINT(kRoofShadow, 1u);   // far rectangles only, as coarse as shadows are
struct RoofDrawEnv {
    RoofEnv roofs;                // grids, runs, regions, parts, planes, meshes, plots
    EmitViewBuf view;
    EmitTableBuf table;
    RoofDrawStateBuf state;
    RoofRowBuf rows;
    RoofTileBuf tiles;
    RoofCutTileBuf cuts;
    RoofTileBuf rectangles;       // grid, part
    RoofProfileBuf profiles;      // [kind * kProfileSteps + step]
    uint gridCount;
    uint rowRoom, tileRoom, cutRoom, rectangleRoom;
    float leastCell;              // pixels below which cells are a pattern
    uint flags;
    uint shownLayer;              // for the view of a layer: the grammar's number, or colourLayers; kNoIndex: none
};
STATIC_SIZE(RoofDrawEnv, 296);
BUFFER(RoofDrawEnvBuf, RoofDrawEnv)

struct RoofCullPush {
    RoofDrawEnvBuf env;
};
STATIC_SIZE(RoofCullPush, 8);

struct RoofDrawPush {
    RoofDrawEnvBuf env;
    TerminalVertexBuf vertices;
    uint bucket, firstVertex, vertexCount, batch;
    float roughness;
};
STATIC_SIZE(RoofDrawPush, 40);

ESPALIER_END
#endif
