/* Espalier: plants that a shape grammar grows over a game's own geometry, on the GPU.
 *
 * The life of a context: espCreate, espLoadSurface, espCompileGrammar, espPlant, then each frame espUpdate (grows
 * what changed; nothing if nothing did) and espDraw, at the end espDestroy.
 *
 * Threads: a context and its ids are used by one thread at a time; different contexts are independent, unless they share a
 * VkQueue, which nobody may use while a function of theirs runs: then one thread at a time uses them all.
 * Waiting: what loads, grows, reads back, paints, or undoes may wait for the GPU.
 * Errors: every function that can fail returns an EspResult and leaves the context as it was before the call: the
 * last good surface, grammar and growth go on. espLastError tells the cause. Counts of what isn't there are 0, names "".
 * Ownership: what the caller passes in is copied or used up before the call returns, unless said otherwise. Strings that are
 * returned belong to the context and live until its next call, unless said otherwise.
 * Units: metres, radians, right-handed world space with Y up; colours linear unless said otherwise.
 * Ids: plain values, zero-initialised is no object; an id whose object was destroyed is refused, never reused. An id of
 * another context is refused too, while no more than 64 contexts live in the process.
 * Structs that begin with structSize may get further fields in later versions. structSize is sizeof of the struct as the
 * host's header has it: C++ sets it, in C write `EspStats stats = {.structSize = sizeof stats};`. The library reads and
 * writes nothing beyond it. What an older header lacks has its default. Other structs never change.
 * Defs: begin with espDefault...(), so that each field gets a sensible value; those that have no such function, with zeros.
 * Pointers in a def to further structs may be NULL where the field says what that means.
 */
#ifndef ESPALIER_H
#define ESPALIER_H

#include <stddef.h>
#include <stdint.h>

/* ESPALIER_STATIC: the library is linked into the program (CMake's target says so by itself). ESPALIER_BUILDS: this is
 * the library. */
#if defined(_WIN32) && defined(ESPALIER_STATIC)
#define ESP_API
#elif defined(_WIN32) && defined(ESPALIER_BUILDS)
#define ESP_API __declspec(dllexport)
#elif defined(_WIN32)
#define ESP_API __declspec(dllimport)
#else
#define ESP_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define ESP_VERSION_MAJOR 0
#define ESP_VERSION_MINOR 1
#define ESP_VERSION_PATCH 0
/* What espCreate is given: the version of the header that a host was compiled with. */
#define ESP_VERSION ((uint32_t)ESP_VERSION_MAJOR << 22 | (uint32_t)ESP_VERSION_MINOR << 12 | (uint32_t)ESP_VERSION_PATCH)

/* The first field of a struct that may grow. */
#ifdef __cplusplus
#define ESP_STRUCT_SIZE(Struct) uint32_t structSize = sizeof(Struct)
#else
#define ESP_STRUCT_SIZE(Struct) uint32_t structSize
#endif

typedef enum EspResult {
    ESP_OK = 0,
    ESP_INVALID_ARGUMENT = 1,   /* a null pointer, a number out of range, an id of nothing */
    ESP_INVALID_CONTENT = 2,    /* a file or text that can't be used; espLastError names file, place and cause */
    ESP_IO_FAILED = 3,          /* can't read or write */
    ESP_NO_DEVICE = 4,          /* no Vulkan device that can run Espalier, or it can't be made; a driver that was found to
                                   run kernels wrongly */
    ESP_DEVICE_LOST = 5,        /* VK_ERROR_DEVICE_LOST: of each function that needs the device, from then on, until espRecreate
                                   has given the context another one */
    ESP_OUT_OF_MEMORY = 6,
    ESP_STOPPED = 7,            /* who watches growth gave it up (espWatchGrowth) */
    ESP_DRIVER_FAILED = 8,      /* a call of the GPU's driver failed, and neither for want of memory nor because the device is
                                   lost; espLastError names the result. It may work when it is tried again */
    ESP_WRONG_VERSION = 9,      /* the host was compiled with a header that this library can't serve (espCreate) */
    ESP_INTERNAL_ERROR = 10     /* a mistake of the library's own; espLastError says where. Destroy the context: what it holds
                                   may be half done */
} EspResult;

typedef struct EspContext EspContext;
typedef struct EspSurface { uint32_t id; } EspSurface;
typedef struct EspGrammar { uint32_t id; } EspGrammar;
typedef struct EspSeed { uint32_t id; } EspSeed;
typedef struct EspStroke { uint32_t id; } EspStroke;
typedef struct EspBrush EspBrush;   /* espalier_paint.h */

typedef enum EspLogLevel { ESP_LOG_INFO = 0, ESP_LOG_WARNING = 1, ESP_LOG_ERROR = 2 } EspLogLevel;
/* Called by the context's functions, on their thread; it must not use the context, nor throw. */
typedef void (*EspLogFn)(void* user, EspLogLevel level, const char* message);

/* ---- Context ------------------------------------------------------------------------------------------------ */

/* A host's Vulkan objects; handles as they are in vulkan.h. The device must have been created with the features that
 * espRequiredFeatures chains into a VkDeviceCreateInfo; its subgroups must vote, ballot and do arithmetic in compute, and its
 * uniform blocks hold 65,536 bytes. The instance must have been made for Vulkan 1.3 or later. What is missing is named in espCreate's error. Espalier submits to `queue` only inside its functions; what it
 * submits waits for the frames before it that espDraw has recorded into, and later ones see what it wrote. The host keeps
 * all objects alive until espDestroy has returned. */
typedef struct EspHostDevice {
    ESP_STRUCT_SIZE(EspHostDevice);
    uint32_t queueFamily;
    void* getInstanceProcAddr;   /* PFN_vkGetInstanceProcAddr */
    void* instance;              /* VkInstance */
    void* physicalDevice;        /* VkPhysicalDevice */
    void* device;                /* VkDevice */
    void* queue;                 /* VkQueue: graphics and compute */
    int debugUtils;              /* 1: VK_EXT_debug_utils is on: objects get names and passes labels */
    const void* deviceInfo;      /* VkDeviceCreateInfo that `device` was made with, its chain too; read by espCreate and
                                    espRecreate only, whose errors name what it leaves out of what is required. With the
                                    feature samplerAnisotropy what is seen at a grazing angle stays sharp */
    void* pipelineCache;         /* VkPipelineCache, in which pipelines are looked for and to which they are added, by the
                                    context's functions on their thread; NULL: none */
} EspHostDevice;

/* How a context reads files where they don't lie on the disk: in an archive, in memory. `read` and `release` are called
 * within the context's functions, on their thread; they must neither use the context nor throw. */
typedef EspResult (*EspReadFileFn)(void* user, const char* path, const void** bytes, size_t* size);
typedef void (*EspReleaseFileFn)(void* user, const void* bytes, size_t size);
typedef struct EspFiles {
    ESP_STRUCT_SIZE(EspFiles);
    uint32_t reserved;           /* 0 */
    void* user;
    EspReadFileFn read;          /* Sets *bytes and *size to the whole file, which stays until it is released, and returns
                                    ESP_OK; what else it returns is told as ESP_IO_FAILED. path: as the host gave it, or beside
                                    that: roofs.glb and pieces.glb beside EspContextDef::terminals, included grammars
                                    beside those that include them */
    EspReleaseFileFn release;    /* after each ESP_OK of `read`, with what it gave, within the same function of the context */
} EspFiles;

typedef struct EspContextDef {
    ESP_STRUCT_SIZE(EspContextDef);
    int validation;              /* own device only: 1 turns the validation layer on where it is installed */
    const EspHostDevice* host;   /* NULL: Espalier makes its own device */
    EspLogFn log;                /* of what a context does, from espCreate on until espDestroy has returned; NULL: warnings and
                                    errors go to stderr */
    void* logUser;
    const char* terminals;       /* path of the terminal meshes (terminals.glb), beside which towns look for roofs.glb; NULL:
                                    ../content/terminals.glb beside the library's folder, or where it has been installed,
                                    and with `files` "terminals.glb" */
    const char* cacheFolder;     /* compiled rule maps are cached here, the 256 used last, and devices that have passed the
                                    self-check are remembered; NULL: no cache on disk */
    int skipSelfCheck;           /* 0: the first context on a device and driver grows and draws a small scene by shaders and
                                    compares it with what has to come out. espCreate then fails with ESP_NO_DEVICE, and
                                    names device and driver, where the driver runs our kernels wrongly. 1: it doesn't */
    uint32_t reserved;           /* 0 */
    const EspFiles* files;       /* all files but those of cacheFolder are read by these; NULL: from the disk */
} EspContextDef;

ESP_API EspResult espDefaultContextDef(EspContextDef* out);
/* headerVersion: ESP_VERSION. The library serves hosts whose header is as old as it is or older, of the same major version,
 * and before version 1.0 of the same minor one; else ESP_WRONG_VERSION. */
ESP_API EspResult espCreate(uint32_t headerVersion, const EspContextDef* def, EspContext** out);
/* Waits for the GPU, also for frames that the host has submitted to EspHostDevice::queue. What espDraw has recorded and isn't
 * submitted by then must never be. NULL is allowed. */
ESP_API void espDestroy(EspContext* context);

/* Gives a context another device: after ESP_DEVICE_LOST, or to move it to another GPU. Ids stay. Surfaces are read again
 * from their files, which must be as they were. Those that came from memory are read from the context's copy. Layers are as
 * painted, seeds, parameters, looks, towns, fields, graphs, props and what is frozen or pruned as they were; strokes can be
 * undone, and open ones go on. The next espUpdate grows all anew, the same to the bit. Loads begin again. A call that
 * returned ESP_DEVICE_LOST has done nothing of what it was for, and may be made again.
 * device: NULL for one of Espalier's own. What the earlier device's host keeps alive may go when this has returned ESP_OK.
 * Waits for the GPU. What was recorded into the host's command buffers and isn't submitted by then must never be, as with
 * espDestroy. On failure call it again, with this device or another; the message names a file that can't be read any more.
 * Until then functions answer ESP_DEVICE_LOST; only where the new device can't be made and the context's own wasn't lost all
 * goes on as before. Takes about as long as loading all surfaces. */
ESP_API EspResult espRecreate(EspContext* context, const EspHostDevice* device);

/* Gives back to the device what GPU memory is only kept for what comes: by itself a context keeps up to 256 MiB of it, 1 GiB
 * on a software device, as asking for it again costs time. For when nothing is to come soon: a pause, a menu, a level that has been loaded, a window at
 * rest. Waits for the GPU; what was recorded into the host's command buffers has to be submitted, as before espUpdate.
 * What stands and is drawn stays. Where an earlier growth needed far more, it is copied into buffers of its own size: both
 * exist for a moment, and the next frame takes a little longer. EspStats::reservedBytes tells what is left. */
ESP_API EspResult espTrim(EspContext* context);

/* The VkPhysicalDeviceFeatures2 chain that a host's device must be created with; static memory, don't free. */
ESP_API const void* espRequiredFeatures(void);
/* Names of the device extensions that it must have been created with besides. Static memory. */
ESP_API const char* const* espRequiredExtensions(uint32_t* count);

/* Why the context's last call failed (NULL: this thread's last call without one, such as espCreate), several lines if several
 * mistakes were found. Ask right after it: the next call that returns an EspResult, even ESP_OK, begins with "". Never NULL. */
ESP_API const char* espLastError(const EspContext* context);
ESP_API const char* espVersion(void);                             /* "0.1.0": the library's; static */
ESP_API const char* espDeviceName(const EspContext* context);     /* lives as long as the context */
ESP_API const char* espDriverName(const EspContext* context);     /* with its version, as the driver writes it; likewise */

/* ---- Surfaces ----------------------------------------------------------------------------------------------- */

/* Rows of a 3×4 object-to-world matrix. Its scale must be even in all directions, 1e-6 to 1e6; it may mirror, and
 * moves by up to 1e9 m along each axis. */
typedef struct EspTransform { float rows[3][4]; } EspTransform;
ESP_API EspTransform espIdentity(void);

typedef struct EspSurfaceInfo {
    ESP_STRUCT_SIZE(EspSurfaceInfo);
    float boundsMin[3], boundsMax[3];   /* world */
    uint32_t triangles, charts, levels;
    uint32_t resolution;                /* texels a side of the finest level */
    double walkableArea;                /* m² */
    uint64_t hash;
    /* What the bake took off the positions of the model's file, since single precision can't hold them; metres, 0 mostly.
     * A position in the file's coordinates is a position in the surface's space, before its transform, plus this. */
    double origin[3];
} EspSurfaceInfo;

/* Loads what espalier-bake wrote and places it. Where it touches other surfaces or runs into them, plants go over from
 * one to the other. What lies within another surface's solid body is no ground until one of them is elsewhere: nothing
 * grows there, and seeds there wait. In the next espUpdate only plants grow again that can get to it from where they
 * stand. place: NULL is the identity. At most 65,535 surfaces a context. */
ESP_API EspResult espLoadSurface(EspContext* context, const char* path, const EspTransform* place, EspSurface* out);
/* Likewise, of ground that something else draws, such as the walls of a town's houses: of it only ESP_VIEW_CHARTS and
 * ESP_VIEW_LAYER show anything, and it casts no shadow. */
ESP_API EspResult espLoadGround(EspContext* context, const char* path, const EspTransform* place, EspSurface* out);
typedef struct EspSurfaceDef {
    ESP_STRUCT_SIZE(EspSurfaceDef);
    int groundOnly;              /* 1: as by espLoadGround */
    const char* name;            /* the file's path; with `bytes` only for messages, and may be NULL */
    const void* bytes;           /* what espalier-bake wrote, of which the context keeps a copy; NULL: it is read from the file */
    size_t size;                 /* of `bytes` */
    const EspTransform* place;   /* NULL: the identity */
} EspSurfaceDef;
/* espLoadSurface and espLoadGround, from memory too. */
ESP_API EspResult espAddSurface(EspContext* context, const EspSurfaceDef* def, EspSurface* out);
/* Places a standing surface once more, elsewhere. The new one has seeds and layers of its own, and shares what was read and
 * uploaded of `like` as long as one of the two is there. A place that other surfaces touch takes an eighth to a
 * fifth of the surface's memory for itself, and what is painted. `groundOnly` is that of `like`; fields aren't taken along. */
ESP_API EspResult espPlaceAgain(EspContext* context, EspSurface like, const EspTransform* place, EspSurface* out);
/* Puts a surface elsewhere, with its seeds and layers. In the next espUpdate contacts with other surfaces are found anew,
 * and plants grow again that can get to it from where they stand; others are left alone. Of a surface that touches no
 * other, neither before nor after, plants go along as they are, if it keeps its scale to the last bit (moves do, and
 * nearly all turns of a surface of scale 1). Only those grow again whose grammar asks for what has changed: `position`
 * and `height`, and if the surface has turned also `normal`, `heading`, `slope` and `angleTo`. */
ESP_API EspResult espMoveSurface(EspContext* context, EspSurface surface, const EspTransform* place);
/* Moves the world's origin by so many metres, for worlds that are wider than floats are precise: what stands stays where it
 * is, and all positions that are given and taken from now on are seen from the new origin. So the eye of the next frame is
 * the one before less `by`. Nothing is derived, and contacts aren't found anew; growth is bound anew in the next frame, and
 * shadows are drawn anew, whose edges may shift by parts of a texel. Where surfaces stand is kept in double precision: an
 * origin that comes back finds all as it was. Surfaces on their way and streamed ones that are away come where they belong. Grammars that ask for `position` or
 * `height` see the new ones when they grow next. The origin goes at most 1e9 m along each axis.
 * ESP_INVALID_ARGUMENT, and nothing moves: there is a town, a procedural graph, props or a site's map. */
ESP_API EspResult espShiftOrigin(EspContext* context, const double by[3]);
/* Hides a surface (hidden 1), as an editor does: it isn't drawn, casts no shadow, and rays of espPick and espPickPlant go
 * through it; it stays ground, and what grows on it is seen. One that was streamed away and came back is shown. */
ESP_API EspResult espHideSurface(EspContext* context, EspSurface surface, int hidden);
/* Its seeds and layers go with it. In the next espUpdate only plants grow again that could get to it. */
ESP_API EspResult espDestroySurface(EspContext* context, EspSurface surface);
ESP_API EspResult espSurfaceInfo(const EspContext* context, EspSurface surface, EspSurfaceInfo* out);

typedef struct EspHit {
    ESP_STRUCT_SIZE(EspHit);
    EspSurface surface;
    float position[3], normal[3];   /* world */
    float uv[2];                    /* the walk's UV set */
    uint32_t chart;
    float distance;                 /* along the ray, or from the point asked for; metres */
} EspHit;

/* The first point of a surface that the ray meets; ESP_INVALID_ARGUMENT without a message if there is none. Of plants
 * espPickPlant tells; towns are the host's to pick, by espHouseShape. direction need not be a unit vector. */
ESP_API EspResult espPick(const EspContext* context, const float origin[3], const float direction[3], EspHit* out);
/* The nearest point of all surfaces. */
ESP_API EspResult espNearest(const EspContext* context, const float point[3], EspHit* out);

/* ---- The atlas ---------------------------------------------------------------------------------------------- */

/* What a surface's walk goes over (docs/surface_format.md), for inside views and checks. Both wait for the GPU. */
typedef enum EspTexelKind {
    ESP_TEXEL_EMPTY = 0,
    ESP_TEXEL_INNER = 1,         /* its centre lies in a chart */
    ESP_TEXEL_LINK = 2,          /* beside a border that goes on somewhere; or no ground: buried, or bare */
    ESP_TEXEL_OPEN = 3           /* beside a border of the model itself */
} EspTexelKind;
/* A level of the surface, 0 the finest: size rows of size words, the first row at v = 0. Bits 15..0: the chart, 17..16:
 * EspTexelKind, 18: the chart is too small to be walked on this level. *size: as for espReadLayer. */
ESP_API EspResult espReadAtlas(EspContext* context, EspSurface surface, uint32_t level, uint32_t* texels,
                               uint32_t* size);

typedef enum EspLinkKind {
    ESP_LINK_SEAM = 0,           /* the chart goes on where the mesh does */
    ESP_LINK_NEAREST = 1,        /* found by nearest points */
    ESP_LINK_CONTACT = 2,        /* where two pieces touch or run into each other */
    ESP_LINK_OPEN = 3            /* a border of the model: leads nowhere */
} EspLinkKind;
/* A piece of a chart's border, a to b, and where walks over it arrive. In walk UVs. */
typedef struct EspLink {
    float a[2], b[2], toA[2], toB[2];
    uint32_t chart, toChart;
    EspSurface toSurface;
    EspLinkKind kind;
} EspLink;
/* *count: room in links, set to how many there are; what there is no room for is left out. links NULL: only asks. */
ESP_API EspResult espReadLinks(EspContext* context, EspSurface surface, EspLink* links, uint32_t* count);

/* ---- Grammars ----------------------------------------------------------------------------------------------- */

/* At most 1,024 a context. All that grow plants together read at most 16 layers, each one of colours counted as three. */
typedef struct EspGrammarDef {
    ESP_STRUCT_SIZE(EspGrammarDef);
    const char* name;     /* for messages, usually the file's path; included files are looked for beside it */
    const char* text;
    size_t length;        /* bytes, up to 1 MiB */
} EspGrammarDef;

typedef enum EspParamKind { ESP_PARAM_FLOAT = 0, ESP_PARAM_BOOL = 1, ESP_PARAM_COLOUR = 2 } EspParamKind;

typedef struct EspParamInfo {
    ESP_STRUCT_SIZE(EspParamInfo);
    EspParamKind kind;
    const char* name;     /* these three strings live as long as the grammar and until it is compiled anew */
    const char* label;
    const char* unit;
    float value[3], initial[3];   /* colours use all three */
    float low, high;
} EspParamInfo;

ESP_API EspResult espCompileGrammar(EspContext* context, const EspGrammarDef* def, EspGrammar* out);
/* Replaces the text; parameters keep their values by name. On failure the last good grammar keeps growing. Where comments,
 * layout, labels or defaults alone are new, nothing grows anew; where only what is drawn on spans is, bark and leaves, no node
 * is derived again; where rules are, the plants' chunks that used one. ESP_INVALID_CONTENT also where seeds grow by the grammar
 * and it would make roofs, or the town's roofs and it would make none, or where a seed begins with a symbol from which nothing
 * grows any more. */
ESP_API EspResult espRecompileGrammar(EspContext* context, EspGrammar grammar, const EspGrammarDef* def);
/* What isn't wrong in the text that grows, but may not be meant: lines "file:line:column: warning: rule: message", "" if there
 * are none. Lives as long as the grammar and until it is compiled anew. */
ESP_API const char* espGrammarWarnings(const EspContext* context, EspGrammar grammar);
ESP_API EspResult espDestroyGrammar(EspContext* context, EspGrammar grammar);   /* its seeds go with it, or the town's roofs */
ESP_API uint32_t espParamCount(const EspContext* context, EspGrammar grammar);
ESP_API EspResult espParamInfo(const EspContext* context, EspGrammar grammar, uint32_t index, EspParamInfo* out);
/* Values outside the range are clamped to it. count: 3 for a colour, else 1. */
ESP_API EspResult espSetParam(EspContext* context, EspGrammar grammar, const char* name, const float* value, uint32_t count);
ESP_API uint32_t espLayerCount(const EspContext* context, EspGrammar grammar);
ESP_API const char* espLayerName(const EspContext* context, EspGrammar grammar, uint32_t index);
/* What the grammar says that it is for; may be empty. */
ESP_API const char* espLayerLabel(const EspContext* context, EspGrammar grammar, uint32_t index);
ESP_API float espLayerFill(const EspContext* context, EspGrammar grammar, uint32_t index);   /* where nothing is painted */

/* ---- Furnishing ---------------------------------------------------------------------------------------------- */

/* Props: trees, walls, grass, whatever a scene is furnished with that nothing grows on. A host that draws its own scene
 * (EspHostScene) draws its own. */
typedef struct EspPropPlace {
    const char* model;           /* as the file names it, without _lodN */
    float position[3];           /* of its origin, world */
    float turn;                  /* radians about the vertical, counterclockwise from above */
    float scale;                 /* over 0 */
} EspPropPlace;
/* Places props in place of all that stood. models: a glTF binary of meshes NAME_lodN, of one material each (docs/scene_format.md);
 * NULL, or count 0: none. */
ESP_API EspResult espSetProps(EspContext* context, const char* models, const EspPropPlace* places, uint32_t count);

/* What lies on the ground that EspLook::ground or a town draws, seen from above, the first row at low[1]. Red: 0.5 at a paved
 * street's edge, 1 a metre inside of it, 0 a metre outside; green: trodden earth; blue: share of the sky that is
 * seen. Its outermost texels go on to the horizon. */
typedef struct EspSiteDef {
    ESP_STRUCT_SIZE(EspSiteDef);
    const uint8_t* rgba;         /* height rows of width texels, 1 to 8192 each; NULL: nothing lies there */
    uint32_t width, height;
    float low[2], high[2];       /* world x and z of its corners, metres */
} EspSiteDef;
ESP_API EspResult espSetSite(EspContext* context, const EspSiteDef* def);   /* NULL: nothing lies there */

#ifdef __cplusplus
}
#endif

#include "espalier_frames.h"
#include "espalier_graphs.h"
#include "espalier_loads.h"
#include "espalier_nodes.h"
#include "espalier_paint.h"
#include "espalier_parts.h"
#include "espalier_pass.h"
#include "espalier_patterns.h"
#include "espalier_plants.h"
#include "espalier_roofs.h"
#include "espalier_stream.h"
#endif
