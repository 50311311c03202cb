// The scene's images: of four samples a pixel, or of one where ESPALIER_ONE_SAMPLE is defined.
#ifndef ESPALIER_RENDER_SCENE_SAMPLER_GLSL
#define ESPALIER_RENDER_SCENE_SAMPLER_GLSL
#ifdef ESPALIER_ONE_SAMPLE
#define SceneSampler sampler2D
#define sceneSize(map) textureSize(map, 0)
const int kSceneSamples = 1;
#else
#define SceneSampler sampler2DMS
#define sceneSize(map) textureSize(map)
const int kSceneSamples = 4;
#endif
#endif
