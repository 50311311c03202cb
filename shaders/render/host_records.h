// What the passes read that draw into a picture which a host has begun.
#ifndef ESPALIER_RENDER_HOST_RECORDS_H
#define ESPALIER_RENDER_HOST_RECORDS_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

struct HostPush {
    float atInfinity;    // the host's depth is atInfinity + perNearness / distance along the view
    float perNearness;
    float nearPlane;     // ours is nearPlane / distance
    uint encoded;        // 1: the host's picture is sRGB that its format knows nothing of
    int reach;           // pixels around growth whose edges were smoothed with it
    uint spare[3];
};
STATIC_SIZE(HostPush, 32);

ESPALIER_END
#endif
