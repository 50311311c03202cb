/* Worlds that are larger than memory. espalier.h includes this file and says what holds for all functions: threads, units,
 * errors.
 *
 * A streamed surface is known by its file, its place and its bounds. It stands only while it is needed: then it is an ordinary
 * surface. While it is away, its id, its seeds and its painted layers stay, and no other function finds it: what is planted on it
 * grows when it stands again. */
#ifndef ESPALIER_STREAM_H
#define ESPALIER_STREAM_H

#include "espalier.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct EspStreamedDef {
    ESP_STRUCT_SIZE(EspStreamedDef);
    uint32_t reserved;           /* 0 */
    const EspSurfaceDef* surface;      /* with a name: it is read again each time that it comes. No `bytes` */
    float boundsMin[3], boundsMax[3];   /* of the file, before its place: EspSurfaceInfo's where it has been loaded by itself */
} EspStreamedDef;
/* The surface is away at first. `def` and what it leads to are copied. */
ESP_API EspResult espAddStreamed(EspContext* context, const EspStreamedDef* def, EspSurface* out);

typedef struct EspStreamingDef {
    ESP_STRUCT_SIZE(EspStreamingDef);
    uint32_t loadsAtOnce;        /* that many are on their way at most; default 3 */
    float eye[3];                /* what is near it and large is needed most; each frame's, metres */
    float leastSize;             /* surfaces stand from so large on, their radius divided by the distance of their middle.
                                    They go when their room is needed. Default 0.02 */
    uint64_t deviceBytes;        /* that streamed surfaces may take of the device; default 1 GiB. A surface that alone is larger
                                    never stands */
} EspStreamingDef;
ESP_API EspResult espDefaultStreamingDef(EspStreamingDef* out);
/* What espUpdate goes by from now on. Each frame, or when the eye has moved. */
ESP_API EspResult espSetStreaming(EspContext* context, const EspStreamingDef* def);

typedef enum EspStreamedState {
    ESP_STREAMED_AWAY = 1,
    ESP_STREAMED_COMING = 2,
    ESP_STREAMED_STANDS = 3,
    ESP_STREAMED_FAILED = 4      /* its file can't be read; tried again once it has been destroyed and added anew */
} EspStreamedState;
typedef struct EspStreamedInfo {
    ESP_STRUCT_SIZE(EspStreamedInfo);
    EspStreamedState state;
    EspResult result;            /* ESP_OK, or why it has failed */
    const char* message;         /* likewise; "" otherwise. Lives until the next espUpdate */
    uint64_t bytes;              /* of the device; 0 until its file has first been read */
} EspStreamedInfo;
ESP_API EspResult espStreamedInfo(const EspContext* context, EspSurface surface, EspStreamedInfo* out);

typedef struct EspStreamingInfo {
    ESP_STRUCT_SIZE(EspStreamingInfo);
    uint32_t streamed, standing, coming;   /* surfaces */
    uint64_t deviceBytes;        /* that streamed surfaces take, those on their way included: never beyond
                                    EspStreamingDef::deviceBytes, but where that has been lowered until the next espUpdate */
} EspStreamingInfo;
ESP_API EspResult espStreamingInfo(const EspContext* context, EspStreamingInfo* out);

#ifdef __cplusplus
}
#endif
#endif
