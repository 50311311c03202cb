/* Layers and the strokes that paint them. A part of espalier.h, which includes it; the rules at its top hold here too. */
#ifndef ESPALIER_PAINT_H
#define ESPALIER_PAINT_H

#include "espalier.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Layers -------------------------------------------------------------------------------------------------
 * Pictures in [0,1] by which designers tell grammars where to do what. A layer of colours, `context NAME = #rrggbb`, is
 * three layers, NAME.r, NAME.g and NAME.b, linear; only EspLook::viewLayer takes it by NAME. */

typedef enum EspLayerSpace {
    ESP_LAYER_WALK_UV = 0,       /* drawn in the surface's walk UV set */
    ESP_LAYER_MATERIAL_UV = 1,   /* drawn in the model's own UV set; resampled on loading. Without one the log warns */
    ESP_LAYER_TEXELS = 2         /* as espReadLayer gave it: the same size, taken as it is, gutters too */
} EspLayerSpace;

/* texels: height rows of width floats in [0,1], the first row at v = 0; 1 to 8192 each. What lies beyond is taken as the
 * nearer of 0 and 1, what isn't a number as 0. NULL removes the layer. */
typedef struct EspLayerDef {
    ESP_STRUCT_SIZE(EspLayerDef);
    EspSurface surface;
    const char* name;            /* as a grammar's `context` declares it */
    EspLayerSpace space;
    const float* texels;
    uint32_t width, height;
} EspLayerDef;
ESP_API EspResult espDefaultLayerDef(EspLayerDef* out);
ESP_API EspResult espSetLayer(EspContext* context, const EspLayerDef* def);

/* A surface that was baked anew, as another resolution or after its model has changed: its charts lie elsewhere, places in
 * space don't. Each texel of the later bake takes the value of the nearest place of the earlier one that faces the same way
 * within 60 degrees, up to a hundredth of the surface's radius or two texels away, whichever is more. These need no context and may be called by any thread;
 * espLastError(NULL) tells what went wrong. */
typedef struct EspCarry EspCarry;
typedef struct EspCarried {
    ESP_STRUCT_SIZE(EspCarried);
    double fresh;                /* m² of the later bake's ground without a place of the earlier one near */
    double lost;                 /* m² that were painted above 0 and have no ground any more */
} EspCarried;
/* Paths of what espalier-bake wrote. May take seconds. out: the caller's, to be destroyed; serves all layers, several threads
 * at a time. ESP_IO_FAILED: a file can't be read; ESP_INVALID_CONTENT: it is no surface. */
ESP_API EspResult espCreateCarry(const char* earlier, const char* later, EspCarry** out);
ESP_API uint32_t espCarrySide(const EspCarry* carry);   /* texels a side of what is carried; NULL: 0 */
/* texels: as espReadLayer gave them, over the earlier bake's walk UV set; limited to [0,1], NaN counts as 0. fresh: the value
 * of ground that the earlier hadn't, finite.
 * out: espCarrySide's square of floats, over the later's; espSetLayer takes them as ESP_LAYER_WALK_UV. carried: may be
 * NULL. */
ESP_API EspResult espCarryLayer(const EspCarry* carry, const float* texels, uint32_t width, uint32_t height, float fresh,
                                float* out, EspCarried* carried);
ESP_API void espDestroyCarry(EspCarry* carry);          /* NULL is allowed */

/* ---- Painting ------------------------------------------------------------------------------------------------ */

/* Painting happens in world space, on all surfaces at once: a dab reaches every texel whose point lies in its sphere,
 * so that seams don't show. A layer comes into being on a surface where it is first painted on. Before that each grammar
 * reads its own fill there; the first stroke fills it with that of the first grammar that declares the layer, 0 if none does,
 * and all read that. Painting works for layers that no grammar reads too. A layer that a town's grammar reads or that was
 * set over the town, and that no grammar of plants reads, is painted over the town, and on surfaces that have it already only.
 *
 * A stroke keeps what it painted over, in blocks of 8×8 texels. Once ended it is a record for undoing, until it is
 * destroyed. Layers that came into being by it go while it is undone, if nothing else has been painted on them since.
 * Strokes of one layer are to be swapped in the order in which a history goes: last done, first undone. */
typedef enum EspBrushMode {
    ESP_BRUSH_PAINT = 0,         /* towards `value` */
    ESP_BRUSH_ERASE = 1,         /* to what the whole layer was filled with last (espLayerFilled), else its fill */
    ESP_BRUSH_SMOOTH = 2         /* towards the mean of the surface around, over seams too */
} EspBrushMode;

struct EspBrush {
    ESP_STRUCT_SIZE(EspBrush);
    EspBrushMode mode;
    const char* layer;
    float radius;                /* metres, 1e-6 to 1e6 */
    float value;                 /* 0 to 1 */
    float strength;              /* 0 to 1: of a dab, where it is strongest; dabs add up */
    float hardness;              /* 0 to 1: share of the radius that has full strength; beyond it falls off smoothly */
    float slopeRange[2];         /* radians between the surface's normal and the upward; default 0 to pi */
    float heightRange[2];        /* metres, world; default the whole range of floats */
    float limitSoftness;         /* 0 to 1: beyond these ranges paint fades out over up to 45 degrees and one radius */
    int frontOnly;               /* 1: only where the normal is within 90 degrees of the dab's */
};

typedef struct EspDab {
    float position[3];           /* world */
    float normal[3];             /* unit, world; read with frontOnly */
    float pressure;              /* 0 to 1, scales the strength */
} EspDab;

ESP_API EspResult espDefaultBrush(EspBrush* out);   /* paints 1, half a metre in radius, half strength, without a hard core or limits */
/* Several strokes may be open at a time, on unlike layers. */
ESP_API EspResult espBeginStroke(EspContext* context, const EspBrush* brush, EspStroke* out);
/* On the GPU, applied in order; the next espUpdate and espDraw see it. At most 65,536 dabs. They go 32 together: where
 * memory runs out, surfaces have those before, and the stroke's record knows of them; a town's layer has none. */
ESP_API EspResult espStrokeDabs(EspContext* context, EspStroke stroke, const EspDab* dabs, uint32_t count);
/* Waits for the GPU and keeps only the blocks that changed, or all that it has come to where memory is short. */
ESP_API EspResult espEndStroke(EspContext* context, EspStroke stroke);
/* Exchanges the layer's blocks with those kept, bit for bit: undoes an ended stroke, the next time redoes it. On
 * failure nothing is exchanged. Surfaces and layers that are gone are passed over, also where espSetLayer has put another
 * in a layer's place. */
ESP_API EspResult espSwapStroke(EspContext* context, EspStroke stroke);
/* Forgets the record; what is painted stays. An open stroke is ended by it. */
ESP_API EspResult espDestroyStroke(EspContext* context, EspStroke stroke);
ESP_API uint64_t espStrokeBytes(const EspContext* context, EspStroke stroke);   /* on the device and, as much again, on the host */
/* 1: the record holds texels of this surface, or, of one of id 0, of the town: what a stroke that has ended changed there. */
ESP_API int espStrokePainted(const EspContext* context, EspStroke stroke, EspSurface surface);
/* Sets the whole layer, on all surfaces; out is an ended stroke. On failure the layer is as it was. A surface that isn't
 * painted, and where all grammars take the layer as that value already, stays unpainted: another grammar may change it. */
ESP_API EspResult espFillLayer(EspContext* context, const char* layer, float value, EspStroke* out);
/* 1: *value is what espFillLayer set the whole layer to last, undone fills aside; 0: it was never filled. */
ESP_API int espLayerFilled(const EspContext* context, const char* layer, float* value);

/* espSetLayer that can be undone: out is an ended stroke. texels must not be NULL. */
ESP_API EspResult espImportLayer(EspContext* context, const EspLayerDef* def, EspStroke* out);

/* The layers that are painted on any surface; a name is valid until the next call that changes layers. */
ESP_API uint32_t espPaintedLayerCount(const EspContext* context);
ESP_API const char* espPaintedLayerName(const EspContext* context, uint32_t index);
/* 1: this surface has such a layer of its own; 0: grammars read their fill there. */
ESP_API int espLayerPainted(const EspContext* context, EspSurface surface, const char* layer);
/* The layer over the surface's walk UV: size rows of size floats, the first at v = 0. *size: the side of the array
 * that texels has room for; set to the layer's. 0, or texels NULL: only asks. Waits for the GPU. */
ESP_API EspResult espReadLayer(EspContext* context, EspSurface surface, const char* layer, float* texels, uint32_t* size);

#ifdef __cplusplus
}
#endif
#endif
