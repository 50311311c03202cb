// Included once for four samples a pixel and once for one (ESPALIER_ONE_SAMPLE).
// The farthest depth of each tile of the picture, for culling what the models hide.
#include "shaders/render/frame_records.h"
#include "shaders/render/scene_sampler.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { TilesPush push; };
layout(set = 0, binding = 0) uniform SceneSampler depthMap;

void main() {
    ivec2 size = sceneSize(depthMap);
    ivec2 tiles = (size + int(kDepthTile) - 1) / int(kDepthTile);
    int i = int(itemIndex());
    if (i >= tiles.x * tiles.y) return;
    ivec2 low = ivec2(i % tiles.x, i / tiles.x) * int(kDepthTile);
    ivec2 high = min(low + int(kDepthTile), size);
    float least = 1.0;
    for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x)
            for (int s = 0; s < kSceneSamples; ++s) least = min(least, texelFetch(depthMap, ivec2(x, y), s).x);
    push.tiles.v[i] = least;
}
