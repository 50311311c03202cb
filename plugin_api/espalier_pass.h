/* Drawing within a pass of the host's: with its samples and formats, and with its depth buffer, of which nothing else is
 * asked. espalier.h includes this file and says what holds for all functions: threads, units, errors.
 *
 * Each frame: espUpdate; espPrepare, outside of the pass; then the host begins its pass and draws what it likes, and
 * espRecord adds the growth. What is nearer hides the rest by the depth test, whatever the order. */
#ifndef ESPALIER_PASS_H
#define ESPALIER_PASS_H

#include "espalier.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is written into the first colour attachment; alpha is 1. */
typedef enum EspOutput {
    ESP_OUTPUT_ENCODED = 1,      /* tone-mapped and encoded to sRGB: for UNORM formats */
    ESP_OUTPUT_LINEAR = 2,       /* tone-mapped, linear, within [0, 1]: for SRGB formats, which encode by themselves */
    ESP_OUTPUT_LIGHT = 3         /* linear light times the look's exposure, for hosts that map tones later: float formats */
} EspOutput;

/* How the host's pass is begun. Pipelines are made for each that is new, which takes a while the first time; a render
 * pass' handle is compared, so a host keeps one rather than making one anew for each frame. */
typedef struct EspPassFormat {
    ESP_STRUCT_SIZE(EspPassFormat);
    const uint32_t* colourFormats;   /* VkFormat of each colour attachment, VK_FORMAT_UNDEFINED for an unused one. The
                                        first is drawn into, the others stay as they are */
    uint32_t colourCount;        /* 0 to 8; 0: depths only, as for a map of shadows or a depth pass */
    uint32_t depthFormat;        /* VkFormat: any of depth, with or without a stencil, which is left alone */
    uint32_t samples;            /* a pixel: 1, 2, 4 or 8; default 1 */
    int depthReversed;           /* 1: nearer is more; default 0 */
    EspOutput output;            /* default ESP_OUTPUT_ENCODED */
    float depthBias, depthBiasSlope;   /* as vkCmdSetDepthBias' constant and slope factor; default 0 */
    void* renderPass;            /* VkRenderPass; NULL: dynamic rendering, which is the default */
    uint32_t subpass;            /* of renderPass */
    uint32_t stencilFormat;      /* VkFormat of a stencil attachment of dynamic rendering; default 0: there is none */
} EspPassFormat;
ESP_API EspResult espDefaultPassFormat(EspPassFormat* out);

/* A view by matrices, column after column: world -> eye, and eye -> Vulkan's clip space, depth from 0 to 1. The eye may
 * look along its -z or +z axis, the projection be of a perspective or parallel, off centre, jittered, reversed, finite
 * or not, its near plane oblique. `view` turns, moves and mirrors, but doesn't scale. */
typedef struct EspPassDef {
    ESP_STRUCT_SIZE(EspPassDef);
    const EspPassFormat* format;
    float viewport[4];           /* x, y, width, height in pixels; a negative height, with y at the bottom, as Vulkan has it, where
                                    the projection's y goes up. Default 0, 0, 1280, 720 */
    float view[16], projection[16];   /* default: identity */
    float focus;                 /* metres ahead, more than 0: in wide scenes shadows are finest around there; default 20 */
    const EspLook* look;         /* NULL: as espDefaultLook's. `quick`, the ground and the sky don't count; ESP_VIEW_OVERDRAW
                                    is refused */
    int surfaces;                /* 1: draw the surfaces too; 0, the default: the host does, they only cast shadows */
    void* commandBuffer;         /* VkCommandBuffer, primary, outside of a pass */
    uint64_t frame, framesDone;  /* as EspDrawDef's */
} EspPassDef;
ESP_API EspResult espDefaultPassDef(EspPassDef* out);

/* Records what comes before the pass: shadows, culling, light. To be submitted before what espRecord records, or in front
 * of it in the same buffer. The pipelines, descriptor sets and push constants that were bound aren't afterwards. */
ESP_API EspResult espPrepare(EspContext* context, const EspPassDef* def);
/* Records the draws of the last espPrepare into a pass of its format that the host has begun, also in a secondary command
 * buffer that continues one. As often as wanted, until the next espPrepare, espDraw, espUpdate or change of the context;
 * where several views are drawn in one frame, each is prepared and recorded before the next is prepared.
 * A host that records its buffers once, and submits them in each frame, prepares and records into each of them: they hold until
 * the context changes, and as long as framesDone stays below their frames.
 * Viewport, scissor, cull mode, front face, pipeline, vertex and index buffers, push descriptors of set 0 and push constants aren't
 * what they were afterwards. ESP_INVALID_ARGUMENT: nothing has been prepared. */
ESP_API EspResult espRecord(EspContext* context, void* commandBuffer);

#ifdef __cplusplus
}
#endif
#endif
