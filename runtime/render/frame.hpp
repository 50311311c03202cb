#pragma once

#include "runtime/render/draw_data.hpp"
#include "shaders/render/frame_records.h"

namespace espalier {

// What can be shown: views of surfaces or layers that aren't there fall back to normals.
ViewMode shownView(const DrawInputs& inputs);

constexpr float kLeastNearPlane = 1e-4f;  // metres

// A camera and a look as the shaders want them. Sizes in pixels.
FrameRecord makeFrame(const DrawInputs& inputs, uint32_t width, uint32_t height);

// Looks that depend on places stay where they are while the world's origin moves. After the record's unit is known.
// origin: seen from the first one.
void anchorLook(FrameRecord& frame, const glm::dvec3& origin);

// What a view by matrices is.
struct ViewShape {
    explicit ViewShape(const PassView& pass);

    bool parallel = false;  // of one scale everywhere
    bool mirrored = false;
    float pixelScale = 1;  // pixels of a metre, at a metre's distance where it isn't parallel
    Camera camera;         // that looks the same way
    glm::mat4 culling{1};  // world -> clip, but for depths: nothing is too far or, but what is behind, too near
};
// The record by which a pass draws. Where the view is parallel, the eye stands so far behind that it looks the same
// way everywhere.
FrameRecord makeFrame(const DrawInputs& inputs, const PassView& pass, const ViewShape& shape);

// The sun's parallel projection over a sphere, world -> clip, depth 0 near the sun to 1.
struct SunView {
    glm::mat4 toClip{1};
    glm::mat4 toTexture{1};  // world -> texture coordinates and depth
    float width = 1;         // metres that the map covers
    float depth = 1;         // and along the sun
};
// Of a sphere, moved to whole texels, and of what casts from so far towards the sun, at least the sphere's radius.
SunView makeSunView(glm::vec3 sunDirection, glm::vec3 center, float radius, float towards = 0);

}  // namespace espalier
