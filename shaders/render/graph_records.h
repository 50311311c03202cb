// What is drawn of the procedural graph: geometry in planes, with the program that it carries.
#ifndef ESPALIER_RENDER_GRAPH_RECORDS_H
#define ESPALIER_RENDER_GRAPH_RECORDS_H
#include "shaders/render/piece_records.h"
#include "shaders/shared/node_deform.h"

ESPALIER_BEGIN

// Of one draw, followed by the program's steps.
struct GraphDrawRecord {
    vec3 colour;      // linear
    float extent;     // about how large the geometry is
    uint stride;      // words from one plane of positions to the next
    uint opCount;
};
STATIC_SIZE(GraphDrawRecord, 24);

ESPALIER_END
#endif
