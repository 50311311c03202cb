/* Loading surfaces beside the frames. espalier.h includes this file and says what holds for all functions: threads, units,
 * errors.
 *
 * A thread of the library's reads and unpacks the files, one after another. What is left for the context's thread is done by
 * espUpdate and is short: it takes memory for the surface, and a later call places the surface. */
#ifndef ESPALIER_LOADS_H
#define ESPALIER_LOADS_H

#include "espalier.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct EspLoad { uint32_t id; } EspLoad;   /* 0: none */

typedef enum EspLoadState {
    ESP_LOAD_READING = 1,        /* the file is being read, or waits for that */
    ESP_LOAD_UPLOADING = 2,      /* on its way to the device */
    ESP_LOAD_STANDS = 3,
    ESP_LOAD_FAILED = 4
} EspLoadState;

typedef struct EspLoadInfo {
    ESP_STRUCT_SIZE(EspLoadInfo);
    EspLoadState state;
    EspSurface surface;          /* once it stands; else 0 */
    EspResult result;            /* ESP_OK, or why it has failed */
    const char* message;         /* likewise, as espLastError would tell it; "" otherwise. Lives until espEndLoad */
    uint64_t bytes;              /* that go to the device; 0 while the file is being read */
} EspLoadInfo;

/* Begins to load a surface, and returns at once. `def` and what it leads to are copied. Where the context has EspFiles, the
 * file's bytes are asked for within this call. What is wrong with the file is told by espLoadInfo, and to the log. */
ESP_API EspResult espBeginLoad(EspContext* context, const EspSurfaceDef* def, EspLoad* out);
ESP_API EspResult espLoadInfo(const EspContext* context, EspLoad load, EspLoadInfo* out);
/* The load is forgotten. A surface that stands is the host's, to be destroyed by espDestroySurface; one that doesn't stand yet
 * never will. */
ESP_API EspResult espEndLoad(EspContext* context, EspLoad load);

typedef struct EspLoadingDef {
    ESP_STRUCT_SIZE(EspLoadingDef);
    uint32_t reserved;           /* 0 */
    uint64_t bytesPerUpdate;     /* so many bytes at most begin their way to the device in one espUpdate, or else one
                                    surface. Default 64 MiB */
    uint64_t bytesAhead;         /* so many bytes are unpacked at most before espUpdate has taken them, or else one surface.
                                    Default 256 MiB */
} EspLoadingDef;
ESP_API EspResult espDefaultLoadingDef(EspLoadingDef* out);
ESP_API EspResult espSetLoading(EspContext* context, const EspLoadingDef* def);

#ifdef __cplusplus
}
#endif
#endif
