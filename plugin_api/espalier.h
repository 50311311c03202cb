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
    ESP_DEVICE_LOST = 5,        /* destroy the context and create it anew */
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
    const void* deviceInfo;      /* VkDeviceCreateInfo that `device` was made with, its chain too; read by espCreate only.
                                    What it leaves out of what is required is named in espCreate's error. With the feature
                                    samplerAnisotropy what is seen at a grazing angle stays sharp */
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

/* ---- Surfaces ----------------------------------------------------------------------------------------------- */

/* Rows of a 3×4 object-to-world matrix. Its scale must be even in all directions, 1e-6 to 1e6, and mirror nothing;
 * it moves by up to 1e9 m along each axis. */
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
 * stand. place: NULL is the identity. At most 4,095 surfaces a context. */
ESP_API EspResult espLoadSurface(EspContext* context, const char* path, const EspTransform* place, EspSurface* out);
/* Likewise, of ground that something else draws, such as the walls of a town's houses: of it only ESP_VIEW_CHARTS and
 * ESP_VIEW_LAYER show anything, and it casts no shadow. */
ESP_API EspResult espLoadGround(EspContext* context, const char* path, const EspTransform* place, EspSurface* out);
typedef struct EspSurfaceDef {
    ESP_STRUCT_SIZE(EspSurfaceDef);
    int groundOnly;              /* 1: as by espLoadGround */
    const char* name;            /* the file's path; with `bytes` only for messages, and may be NULL */
    const void* bytes;           /* what espalier-bake wrote; NULL: it is read from the file */
    size_t size;                 /* of `bytes` */
    const EspTransform* place;   /* NULL: the identity */
} EspSurfaceDef;
/* espLoadSurface and espLoadGround, from memory too. */
ESP_API EspResult espAddSurface(EspContext* context, const EspSurfaceDef* def, EspSurface* out);
/* Puts a surface elsewhere, with its seeds and layers. In the next espUpdate contacts with other surfaces are found anew,
 * and plants grow again that can get to it from where they stand; others are left alone. Of a surface that touches no
 * other, neither before nor after, plants go along as they are, if it keeps its scale to the last bit (moves do, and
 * nearly all turns of a surface of scale 1). Only those grow again whose grammar asks for what has changed: `position`
 * and `height`, and if the surface has turned also `normal`, `heading`, `slope` and `angleTo`. */
ESP_API EspResult espMoveSurface(EspContext* context, EspSurface surface, const EspTransform* place);
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

/* ---- Frames ------------------------------------------------------------------------------------------------- */

typedef enum EspWalkMode { ESP_WALK_INTRINSIC = 0, ESP_WALK_PAPER = 1 } EspWalkMode;
typedef enum EspTangentMode { ESP_TANGENT_STEM = 0, ESP_TANGENT_PAPER = 1 } EspTangentMode;

typedef struct EspGrowDef {
    ESP_STRUCT_SIZE(EspGrowDef);
    EspWalkMode walk;
    EspTangentMode tangents;
    uint32_t maxNodes;           /* growth stops there and says so; default 4,000,000 */
    uint32_t maxDepth;           /* chunks one after another along one path, 1 to 65,534, default 4096 */
    float leafDensityCap;        /* leaves per square metre and seed at most, 0: no cap */
    int shadersOnly;             /* 1: by shaders on a software device too, where growth is native code of their text
                                    otherwise, with the same result; default 0 */
} EspGrowDef;
ESP_API EspResult espDefaultGrowDef(EspGrowDef* out);
ESP_API EspResult espSetGrow(EspContext* context, const EspGrowDef* def);   /* where it differs, all grows anew */

/* Grows what changed since the last call. Does nothing, and costs nothing, if nothing did. A town and plants grow each for
 * itself: where one fails the other grows, what stood of it stands, and the town's failure is given first. What has failed
 * is told by each call until its inputs change; for want of memory (ESP_OUT_OF_MEMORY), or where the driver failed
 * (ESP_DRIVER_FAILED), it is tried again after 1, 2, 4 ... calls, at most 1,024. */
ESP_API EspResult espUpdate(EspContext* context);

/* Plants that take long to grow may be watched: `growing` is called within espUpdate, on its thread, some ten times a second
 * from a tenth of a second on, on a GPU between its submissions, with the nodes grown so far (fewer again where room has run
 * out and growth begins anew). Where it returns 0 growth is given up: espUpdate returns ESP_STOPPED until its inputs change,
 * what was grown before stands, and the next growth is of all that has changed since the last one that came to its end.
 * `growing` must neither use the context nor throw; it and `user` are used until they are replaced, or the context is
 * destroyed. NULL: nobody watches. */
typedef int (*EspGrowingFn)(void* user, uint64_t nodes);
ESP_API EspResult espWatchGrowth(EspContext* context, EspGrowingFn growing, void* user);

/* Zeros but for structSize aren't a camera: begin with espDefaultCamera or espFrameAll. */
typedef struct EspCamera {
    ESP_STRUCT_SIZE(EspCamera);
    float eye[3], target[3], up[3];   /* eye and target: two places */
    float fovY;                  /* radians, 0.001 to 3.1 */
    float nearPlane;             /* metres; the far plane is at infinity */
    float shift[2];              /* moves the picture right and up, in halves of the frame, as a shift lens does: 0.2
                                    makes room for a panel at the left */
} EspCamera;
ESP_API EspResult espDefaultCamera(EspCamera* out);

typedef enum EspView {
    ESP_VIEW_SHADED = 0, ESP_VIEW_CHARTS = 1, ESP_VIEW_NORMALS = 2, ESP_VIEW_LOD = 3, ESP_VIEW_LAYER = 4,
    ESP_VIEW_DEPTH = 5,          /* growth by the branches that lead to it from its seed */
    ESP_VIEW_OVERDRAW = 6,       /* fragments that were shaded for each pixel */
    ESP_VIEW_FIELD = 7           /* a field of directions (espalier_patterns.h) by streaks along it, with a mark at each
                                    singularity: warm of a positive index, blue of a negative one; no pieces */
} EspView;

typedef struct EspLook {         /* all numbers finite */
    ESP_STRUCT_SIZE(EspLook);
    float sunDirection[3];       /* towards the sun */
    float sunColour[3], skyColour[3], groundColour[3];
    float exposure;              /* stops */
    float background[3], horizon[3];
    int shadows;
    int shadowsLag;              /* 1: while growth or houses change in every frame, shadows follow a few frames later, and
                                    in quick pictures coarsely; once nothing changes they are whole and sharp. Default 0:
                                    each picture has its own */
    int quick;                   /* 1: for pictures of what moves: a software device takes fewer samples of shadows and textures,
                                    leaves out growth that models hid in the picture before, draws twigs that follow each
                                    other as one where lodPixels allows it, and lights small leaves and twigs once
                                    instead of at each vertex; models' levels of detail take over at once;
                                    default 0 */
    EspView view;
    const char* viewLayer;       /* for ESP_VIEW_LAYER a layer, or one of colours; for ESP_VIEW_FIELD a field that a
                                    grammar declares; else not read */
    float viewOpacity;           /* 0 to 1: of that layer over models and roofs; default 1 */
    const EspBrush* viewBrush;   /* for ESP_VIEW_LAYER, else not read: where its slopes and heights let no paint pass the
                                    surfaces are hatched, and the more faintly the more passes; NULL: nowhere */
    uint32_t viewLevel;          /* for ESP_VIEW_CHARTS: the level whose charts and links are shown */
    float lodPixels;       /* error allowed when choosing LOD, pixels; default 1 */
    float leafPixels;            /* leaves of at least so many pixels are all drawn, of smaller ones fewer and larger;
                                    beyond 8 fewer twigs, too; default 8 */
    int ground;                  /* 1: a meadow to the horizon under it all, only to be looked at; default 0 */
    float groundLevel;           /* its height in the world, metres */
    int groundOvergrows;         /* 1: its grass grows over what of models lies almost as low, some 9 cm; default 1 */
    float wind[3];               /* metres a second that the air moves, along the world's axes: leaves lean and flutter, stems
                                    and shadows keep still. Default 0. It may change from frame to frame: gusts of the host's own */
    float gusts;                 /* 0 to 1: how much of the wind comes in gusts that go over the plants; default 0.7 */
    double clock;                /* seconds, of the wind: one clock, one picture. Nothing is derived when it goes on. Default 0 */
} EspLook;
ESP_API EspResult espDefaultLook(EspLook* out);
/* For legends: the linear colour by which ESP_VIEW_DEPTH, ESP_VIEW_OVERDRAW, ESP_VIEW_LAYER, ESP_VIEW_LOD (levels, 0 the
 * finest) or ESP_VIEW_CHARTS (a chart's number) shows `amount`, and the amount from which on nothing changes. */
ESP_API EspResult espViewColour(EspView view, float amount, float rgb[3], float* most);

/* As EspDrawDef::framesDone, for frames without espDraw: completes the times of the last picture, and frees what was only kept
 * for it. */
ESP_API EspResult espFramesDone(EspContext* context, uint64_t framesDone);

/* A picture that the host has begun: its opaque objects are in colourImage and in a depth buffer. Growth and roofs are
 * drawn into it, hidden by what lies nearer, and their depth is added, so that what the host draws next is hidden by
 * them. Pixels that they don't reach (or, where edges are smoothed, don't touch) stay as they are to the bit.
 * The host draws with the camera of EspDrawDef; fovY is vertical, pixels are square. Sky, ground (the look's and the
 * town's) and ESP_VIEW_OVERDRAW are the host's business. Both images: one sample a pixel, usage SAMPLED besides that of an attachment. */
typedef struct EspHostScene {
    ESP_STRUCT_SIZE(EspHostScene);
    uint32_t depthFormat;        /* VkFormat: any of depth; a stencil is left alone */
    void* depthImage;            /* VkImage, in VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, left so */
    uint32_t depthUsage;         /* VkImageUsageFlags that depthImage was made with: SAMPLED and DEPTH_STENCIL_ATTACHMENT */
    float depthAtInfinity;       /* the buffer holds depthAtInfinity + depthPerNearness / distance, the distance in metres */
    float depthPerNearness;      /*   along the view. Reversed, infinitely far: 0, near; from 0 at near to 1 at far: */
                                 /*   far / (far - near), -near * far / (far - near) */
    int surfaces;                /* 1: draw the surfaces too; 0: the host has, they only cast shadows on growth */
} EspHostScene;

/* Where to draw. With commandBuffer NULL Espalier draws into its own image of width × height, submits, waits, and
 * espReadPixels returns it. Otherwise it records into the host's VkCommandBuffer (outside of a render pass), and ends
 * with colourView's image in VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL. What it held before is lost, unless there is a
 * `scene`: then it must come in that layout. Its colours are sRGB: encoded in 8-bit RGBA or BGRA and A2B10G10R10 or
 * A2R10G10B10, all UNORM; linear in 8-bit SRGB, R16G16B16A16_SFLOAT and B10G11R11_UFLOAT, where what we draw is within [0, 1].
 * Another format is refused. One sample a pixel: a multisampled picture has to be resolved first.
 * The buffer is a primary one; pipelines, descriptor sets, push constants and dynamic state aren't what they were afterwards.
 * On failure it may hold a part of the picture: record it anew, or call espDropFrame.
 * What was recorded has to be submitted to EspHostDevice::queue before the next call that changes the context
 * (espUpdate, espLoadSurface, espStrokeDabs ...) or submits by itself (espDraw without a command buffer, espMaterialise),
 * which would overwrite what the recording is to read: `frame` and `framesDone` tell Espalier how long it must keep what
 * that frame reads. A host that stops drawing (a menu, a minimised window) need not tell: the next espUpdate or stroke submits
 * behind its last frame, and once that is done, so is the frame. */
typedef struct EspDrawDef {
    ESP_STRUCT_SIZE(EspDrawDef);
    uint32_t width, height;      /* 1 to 16384 */
    const EspCamera* camera;     /* NULL: as espFrameAll's */
    const EspLook* look;         /* NULL: as espDefaultLook's */
    void* commandBuffer;         /* VkCommandBuffer or NULL */
    void* colourImage;           /* VkImage */
    void* colourView;            /* VkImageView */
    uint32_t colourFormat;       /* VkFormat */
    uint32_t colourUsage;        /* with a scene: VkImageUsageFlags that colourImage was made with, SAMPLED and
                                    COLOR_ATTACHMENT */
    uint64_t frame;              /* with commandBuffer: the host's number of this frame, from 1, rising, the same for several
                                    views of one; one that is done is refused */
    uint64_t framesDone;         /* the GPU has finished all of the host's frames up to this one */
    const EspHostScene* scene;   /* with commandBuffer: what growth is drawn into; NULL: the whole picture is ours */
} EspDrawDef;
ESP_API EspResult espDefaultDrawDef(EspDrawDef* out);
ESP_API EspResult espDraw(EspContext* context, const EspDrawDef* def);
/* Makes what frames like `def` need, so that the first of them waits for no compiler of the driver's: for when a level has
 * been loaded, and grown by espUpdate. Of `def` count camera, look, colourFormat (0: Espalier's own image), and of its scene
 * depthFormat and `surfaces`; handles may be NULL. Draws a small picture of its own, submits and waits. EspHostDevice's
 * pipelineCache keeps what a driver compiles for the next run. */
ESP_API EspResult espWarmUp(EspContext* context, const EspDrawDef* def);
/* What espDraw has recorded last into a command buffer of the host's won't be submitted after all (a swapchain that was
 * lost, an error). The next frame relies on nothing of it and draws its shadows anew. Without this call Espalier takes it
 * that the commands have run, and pictures may be wrong until growth or the view changes. Its `frame` is done when framesDone
 * says so. */
ESP_API EspResult espDropFrame(EspContext* context);
/* rgba: width * height * 4 bytes, rows top to bottom, sRGB, of the last espDraw into Espalier's own image, unless one into
 * a host's scene, of another size, or one that failed has taken its place since. */
ESP_API EspResult espReadPixels(EspContext* context, uint8_t* rgba, size_t sizeBytes);

/* A camera that shows all surfaces and houses from the front right, and what is flat, as a town is, from further above. */
ESP_API EspResult espFrameAll(const EspContext* context, EspCamera* out);

typedef struct EspStats {
    ESP_STRUCT_SIZE(EspStats);
    uint32_t seeds, chunks, branches;
    uint64_t nodes, leaves;
    uint64_t polygons;           /* triangles of the growth at full detail, once it has been drawn */
    uint64_t drawnPolygons;      /* triangles of the growth in the last frame */
    uint32_t expansions;         /* espUpdate calls that expanded anything of the plants, since creation */
    uint32_t overflow;           /* times that maxNodes cut the growth, and leaves that were left out. Plants stand whole where
                                    this and `stopped` are 0 */
    uint32_t stopped;            /* branches that a limit ended: of depth, of recursion, or maxNodes */
    uint32_t deadEnds;           /* branches that found no direction that their condition allows */
    uint32_t validationMessages;
    uint32_t cut;                /* times that maxNodes cut the growth that stands; 0: it didn't */
    double expandMs;             /* of the latest growth: GPU time, or wall time where it ran on the CPU */
    double emitMs, drawMs;       /* GPU time of the last picture's stages */
    double compileMs;            /* on the CPU: the grammar compiled last */
    uint64_t nodeBytes, leafBytes, chunkBytes, surfaceBytes, layerBytes, totalBytes;
    uint64_t hash;               /* canonical: of positions, radii and all terminals, in no order */
    uint64_t modelTriangles;     /* triangles drawn of the surfaces' meshes in the last frame */
    uint32_t modelsFading;       /* surfaces that change their level of detail: the next frames will look different */
    uint32_t shadowsBehind;      /* 1: in the last picture shadows lagged (EspLook::shadowsLag): draw another once nothing changes */
    uint32_t contacts;           /* crossings from surface to surface */
    double contactMs;            /* on the CPU: finding them when surfaces last came, went or moved */
    uint64_t derivedNodes;       /* that the latest growth derived; the others stood as they were */
    uint64_t drawnLeaves;        /* of the growth in the last frame */
    uint32_t enlarged;           /* times that the latest growth ran out of room and was given more, until it had enough */
    uint64_t reservedBytes;      /* taken from the device: totalBytes, and what is kept for what comes (espTrim) */
} EspStats;
ESP_API EspResult espReadStats(EspContext* context, EspStats* out);

/* The growth as triangles, written by the GPU on request: for export, physics, ray tracing. A town's roofs and walls follow
 * it, every tile cut exactly, on the CPU; ESP_OUT_OF_MEMORY if they are more than 2^31 bytes.
 * vertices: 16 bytes each, 3 floats position (world), octahedral 2×16 snorm normal; indices: 32 bit. The arrays belong
 * to the context and live until the next call that grows or materialises. */
typedef struct EspTriangles {
    ESP_STRUCT_SIZE(EspTriangles);
    const void* vertices;
    uint64_t vertexCount;
    const uint32_t* indices;
    uint64_t indexCount;
    double ms;
} EspTriangles;
ESP_API EspResult espMaterialise(EspContext* context, EspTriangles* out);

#ifdef __cplusplus
}
#endif

#include "espalier_paint.h"
#include "espalier_parts.h"
#include "espalier_pass.h"
#include "espalier_patterns.h"
#include "espalier_plants.h"
#include "espalier_roofs.h"
#endif
