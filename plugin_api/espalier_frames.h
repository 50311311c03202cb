/* What a host does in each frame: growing, drawing, reading back. A part of espalier.h, which includes it; the rules at its top
 * hold here too. espalier_pass.h draws within a pass of the host's. */
#ifndef ESPALIER_FRAMES_H
#define ESPALIER_FRAMES_H

#include "espalier.h"

#ifdef __cplusplus
extern "C" {
#endif

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

typedef enum EspGround {
    ESP_GROUND_NONE = 0,
    ESP_GROUND_MEADOW = 1,       /* grass to the horizon, and hills there */
    ESP_GROUND_STUDIO = 2        /* a neutral floor around all surfaces and houses, which goes over into the horizon's colour */
} EspGround;

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
    int ground;                  /* EspGround: what lies under it all, only to be looked at; default none. Towns have a
                                    meadow of their own */
    float groundLevel;           /* its height in the world, metres */
    int groundOvergrows;         /* 1: a meadow's grass grows over what of models lies almost as low, some 9 cm; default 1 */
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

/* A camera that shows all surfaces and houses from the front right, and what is flat, as a town is, from further above. Of
 * houses that stand far apart it shows those that stand most densely, within at most two kilometres. */
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
#endif
