/* What editors of procedural graphs need: the table of node kinds, texts as nodes, and how nodes stand. A part of
 * espalier.h, which includes it; the rules at its top hold here too. docs/graph.md describes the text. */
#ifndef ESPALIER_NODES_H
#define ESPALIER_NODES_H

#include "espalier_graphs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- The table of kinds. Its texts live as long as the library. */

typedef enum EspNodeType {
    ESP_NODE_NUMBER = 0, ESP_NODE_WHOLE = 1, ESP_NODE_VECTOR = 2, ESP_NODE_COLOUR = 3, ESP_NODE_CHOICE = 4,
    ESP_NODE_TEXT = 5, ESP_NODE_FILE = 6, ESP_NODE_MATERIAL = 7,
    ESP_NODE_GRAMMAR = 8, ESP_NODE_SURFACE = 9, ESP_NODE_PLANTS = 10, ESP_NODE_TOWN = 11, ESP_NODE_LAYER = 12,
    ESP_NODE_POINTS = 13, ESP_NODE_CURVES = 14, ESP_NODE_MESH = 15, ESP_NODE_GEOMETRY = 16
} EspNodeType;

typedef struct EspNodeKind {
    ESP_STRUCT_SIZE(EspNodeKind);
    uint32_t inputs, outputs;
    uint32_t reserved;
    const char* name;
    const char* help;
    const char* group;    /* of similar kinds, for lists */
} EspNodeKind;

typedef struct EspNodePort {
    ESP_STRUCT_SIZE(EspNodePort);
    EspNodeType type;
    int wired;            /* 1: an input that has to be wired; there is no standard value then */
    int many;             /* 1: an input that takes any number of wires */
    int asFirst;          /* 1: an output of the type that the first input is wired to */
    uint32_t words;       /* of a choice; see espNodeWord */
    float standard[3];    /* one number, or three of a vector or colour */
    float low, high;      /* of each number; equal: there is no range */
    const char* name;
    const char* unit;
    const char* help;
    const char* text;     /* the standard text, file or choice; NULL of all others */
    const char* opener;   /* of an input: the kind of node that it has to be wired to, whatever that gives; NULL: any */
} EspNodePort;

/* By name, from A on. */
ESP_API uint32_t espNodeKindCount(void);
ESP_API EspResult espNodeKindInfo(uint32_t kind, EspNodeKind* out);
ESP_API EspResult espNodeInput(uint32_t kind, uint32_t input, EspNodePort* out);
ESP_API EspResult espNodeOutput(uint32_t kind, uint32_t output, EspNodePort* out);
ESP_API const char* espNodeWord(uint32_t kind, uint32_t input, uint32_t word);  /* NULL: there is no such word */
ESP_API const char* espNodeTypeName(EspNodeType type);                          /* "": there is none */
/* 1: an input of the type takes what an output of the other gives. */
ESP_API int espNodeTypeTakes(EspNodeType input, EspNodeType given);

/* ---- A text as nodes, as they are written: whether wires fit is for espCompileGraph to say. */

typedef struct EspGraphNodes EspGraphNodes;

typedef struct EspGraphNode {
    ESP_STRUCT_SIZE(EspGraphNode);
    uint32_t inputs;        /* that the text gives; see espGraphNodeInput */
    uint32_t line, column;
    float place[2];         /* on the canvas */
    uint32_t placed, shown, muted;  /* its number, from 1, in the text's lists of these; 0: it isn't there */
    uint32_t reserved;
    const char* name;
    const char* kind;
    const char* comments;   /* lines before it, without their '#'; NULL: none */
} EspGraphNode;

/* A constant, or a wire from another node. */
typedef struct EspGraphGiven {
    ESP_STRUCT_SIZE(EspGraphGiven);
    EspGraphValueKind kind;
    const char* input;      /* "" of a kind that isn't known: given by its place */
    const char* text;       /* of ESP_GRAPH_TEXT */
    const char* from;       /* of ESP_GRAPH_WIRE: the node, and its output, or "" for the first */
    const char* output;
    float numbers[3];
    uint32_t reserved;
} EspGraphGiven;

/* ESP_INVALID_CONTENT: espLastError names each mistake of the writing. To be given back by espFreeGraphNodes. */
ESP_API EspResult espReadGraphNodes(EspContext* context, const EspGraphDef* def, EspGraphNodes** out);
ESP_API void espFreeGraphNodes(EspGraphNodes* nodes);
/* Texts live as long as the nodes. */
ESP_API uint32_t espGraphNodeCount(const EspGraphNodes* nodes);
ESP_API EspResult espGraphNodeAt(const EspGraphNodes* nodes, uint32_t node, EspGraphNode* out);
ESP_API EspResult espGraphNodeInput(const EspGraphNodes* nodes, uint32_t node, uint32_t input, EspGraphGiven* out);
ESP_API const char* espGraphRemarks(const EspGraphNodes* nodes);  /* comments behind all nodes; NULL: none */

/* ---- How a node of a running graph stands, by the last espUpdate. */

typedef struct EspNodeState {
    ESP_STRUCT_SIZE(EspNodeState);
    EspNodeType type;         /* of what the output holds; of geometry of several kinds ESP_NODE_GEOMETRY */
    int made;                 /* 0: it was never made, and all below but `failure` is 0 */
    int waits;                /* 1: something that it reads has failed; it stands as it was made last */
    uint32_t evaluations;     /* that there were */
    uint32_t parts;           /* of geometry */
    float numbers[3];         /* of a number, vector or colour */
    uint32_t reserved;
    uint64_t points, curves, vertices, triangles;  /* without instances */
    uint64_t instances;
    double ms;                /* that it took the last time; -1: nobody asked (espMeasureGraph) */
    const char* failure;      /* why it couldn't be made; "": it could. Lives until the graph's next call */
    const char* note;         /* what it says of itself though it was made, such as "1,000,000 of 1,250,000 instances";
                                 "": nothing. Lives as `failure` does */
} EspNodeState;
/* output: NULL or "" for the first. ESP_INVALID_ARGUMENT: there is no such graph, node or output. */
ESP_API EspResult espNodeStateOf(EspContext* context, EspGraph graph, const char* node, const char* output,
                                 EspNodeState* out);
/* on: 1: each node is run by itself from now on, so that its time is known, which takes a little longer. */
ESP_API EspResult espMeasureGraph(EspContext* context, EspGraph graph, int on);
/* As espReadGraphPart, with the positions as the part's modifiers leave them. ESP_INVALID_CONTENT: it is scattered, and
 * has no positions of its own. */
ESP_API EspResult espReadGraphPlaces(EspContext* context, EspGraph graph, const char* node, const char* output,
                                     uint32_t part, EspGraphPart* out);

#ifdef __cplusplus
}
#endif

#endif
