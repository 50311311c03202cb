/* Procedural graphs: nodes that make and change geometry, as a text wires them (docs/graph.md). A part of espalier.h, which
 * includes it; the rules at its top hold here too. What a graph shows stands in the scene, lit and shadowed. */
#ifndef ESPALIER_GRAPHS_H
#define ESPALIER_GRAPHS_H

#include "espalier.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct EspGraph { uint32_t id; } EspGraph;

/* At most 256 a context. */
typedef struct EspGraphDef {
    ESP_STRUCT_SIZE(EspGraphDef);
    int unfinished;       /* 1: nodes that wait for wires are no mistakes; each fails by itself, as espGraphFailures tells */
    const char* name;     /* for messages, usually the file's path */
    const char* text;
    size_t length;        /* bytes, up to 16 MiB */
} EspGraphDef;

/* What the graph shows is made by the next espUpdate. ESP_INVALID_CONTENT: espLastError names each mistake with
 * file:line:column. A node of a kind that isn't known is no mistake: espGraphFailures tells of it, and the others run. */
ESP_API EspResult espCompileGraph(EspContext* context, const EspGraphDef* def, EspGraph* out);
/* Another text for the same graph. Nodes that are made from the same as before keep what they made. On failure the graph
 * stays as it was. */
ESP_API EspResult espRecompileGraph(EspContext* context, EspGraph graph, const EspGraphDef* def);
ESP_API EspResult espDestroyGraph(EspContext* context, EspGraph graph);

/* What Time nodes give: the frame, a whole number of 0 to 16,777,216, and the seconds from one frame to the next, above 0
 * and up to 3,600. At first frame 0, a thirtieth of a second. Never the wall clock: the same frame shows the same. */
ESP_API EspResult espSetGraphTime(EspContext* context, EspGraph graph, double frame, double step);

typedef enum EspGraphValueKind { ESP_GRAPH_NUMBER = 0, ESP_GRAPH_VECTOR = 1, ESP_GRAPH_TEXT = 2, ESP_GRAPH_WIRE = 3 } EspGraphValueKind;
/* Another constant at an input of a node, as if the text said so; only what depends on it is made again. numbers: one, or
 * three of a vector; text: of ESP_GRAPH_TEXT. ESP_INVALID_CONTENT: the input is wired or doesn't take such a value. */
typedef struct EspGraphInput {
    ESP_STRUCT_SIZE(EspGraphInput);
    EspGraphValueKind kind;
    const char* node;
    const char* input;
    const char* text;     /* NULL unless kind is ESP_GRAPH_TEXT */
    float numbers[3];
    uint32_t reserved;    /* 0 */
} EspGraphInput;
ESP_API EspResult espSetGraphInput(EspContext* context, EspGraph graph, const EspGraphInput* input);

/* A mesh that a Bake node wants to have as ground. Baking takes seconds, so it is the host's to do, beside its frames: it writes
 * the mesh into a model's file, runs espalier-bake over it, and keeps what comes of it by the key. Arrays live until the
 * context's next call. */
typedef struct EspGraphBake {
    ESP_STRUCT_SIZE(EspGraphBake);
    uint32_t resolution;       /* texels a side: espalier-bake --resolution */
    uint64_t key;              /* of the mesh and all below; alike meshes have one key. 0: no node wants any */
    const float* positions;    /* x, y, z of each, world */
    const uint32_t* indices;   /* three a triangle */
    uint64_t indexCount;
    uint32_t positionCount;
    float colour[3], roughness;  /* of its material; linear */
    uint32_t reserved;
} EspGraphBake;
/* The next one that waits, after each espUpdate. The same comes again until it is answered or no node wants it any more. */
ESP_API EspResult espNextGraphBake(EspContext* context, EspGraph graph, EspGraphBake* out);
/* The answer: what espalier-bake wrote, or NULL and why it can't be, for espGraphFailures. The next espUpdate lets the ground
 * stand and plants on it. A key that no node wants any more is ignored. What espLoadSurface fails with, the node tells too. */
ESP_API EspResult espGiveGraphBake(EspContext* context, EspGraph graph, uint64_t key, const char* path, const char* why);

/* The graph as text, in the one canonical way, with all inputs that were set. Lives until the graph's next call. "": there is
 * no such graph. */
ESP_API const char* espGraphText(EspContext* context, EspGraph graph);
/* What the last espUpdate couldn't make, a line each: "file:line:column: node: why". Such a node and what depends on it keep
 * their last good geometry, all others go on. "": nothing failed. Lives until the graph's next call. */
ESP_API const char* espGraphFailures(EspContext* context, EspGraph graph);

typedef struct EspGraphStats {
    ESP_STRUCT_SIZE(EspGraphStats);
    uint32_t nodes;
    uint32_t evaluated;   /* nodes that the last evaluation made; a graph in which nothing changed evaluates nothing */
    uint32_t evaluations; /* that there were */
    uint32_t parts;       /* of what is shown; each is points, curves or a mesh */
    uint32_t dispatches;  /* of kernels in the last evaluation; 0: it ran as native code */
    uint64_t vertices, triangles;  /* of shown meshes, without their instances */
    uint64_t instances;   /* of shown meshes, all together */
    double ms;            /* of the last evaluation */
    float boundsMin[3], boundsMax[3];  /* world, of shown meshes; zeros if there are none */
} EspGraphStats;
ESP_API EspResult espGraphStats(EspContext* context, EspGraph graph, EspGraphStats* out);

typedef enum EspGraphPartKind { ESP_GRAPH_POINTS = 0, ESP_GRAPH_CURVES = 1, ESP_GRAPH_MESH = 2 } EspGraphPartKind;
/* A part of a node's geometry, without its padding. Arrays live until the context's next call. */
typedef struct EspGraphPart {
    ESP_STRUCT_SIZE(EspGraphPart);
    EspGraphPartKind kind;
    uint32_t partCount;        /* that there are */
    uint32_t positionCount;
    uint32_t curves, samples;  /* of curves: sample j of curve c is position j * curves + c */
    uint64_t indexCount;       /* of a mesh, three a triangle */
    uint64_t instanceCount;
    const float* positions;    /* x, y, z of each, before modifiers */
    const uint32_t* indices;
} EspGraphPart;
/* What a node makes, made if need be: part number `part` of its output. output: NULL or "" for the first.
 * ESP_INVALID_ARGUMENT: no such graph, node, output or part, or the output is no geometry. */
ESP_API EspResult espReadGraphPart(EspContext* context, EspGraph graph, const char* node, const char* output, uint32_t part,
                                   EspGraphPart* out);

#ifdef __cplusplus
}
#endif

#endif
