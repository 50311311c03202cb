#pragma once

// What a picture is drawn from and into.

#include <filesystem>
#include <memory>
#include <span>

#include "runtime/emit/emit.hpp"
#include "runtime/render/graph_draw.hpp"
#include "runtime/render/ground.hpp"
#include "runtime/render/pass_format.hpp"
#include "runtime/render/piece_draw.hpp"
#include "runtime/render/props.hpp"
#include "runtime/render/roof_draw.hpp"
#include "runtime/surface/surface.hpp"
#include "shaders/paint/brush.h"

namespace espalier {

inline constexpr uint32_t kMaxFrameSide = 16384;  // pixels

struct Camera {
    glm::vec3 eye{0, 1, 5}, target{0, 1, 0}, up{0, 1, 0};
    float fovY = 0.7f;        // radians
    float nearPlane = 0.05f;  // metres; the far plane is at infinity
    glm::vec2 shift{0};       // moves the picture right and up, in halves of the frame, as a shift lens does
};

enum class ViewMode : uint32_t { shaded = 0, charts = 1, normals = 2, lod = 3, layer = 4, depth = 5, overdraw = 6 };

inline constexpr BrushLimits kNoLimits{-1e30f, 1e30f, 1, -1e30f, 1e30f, 1};

// Colours are linear.
struct Look {
    glm::vec3 sunDirection{0.45f, 0.62f, 0.64f};  // towards the sun
    glm::vec3 sunColor{2.9f, 2.5f, 1.95f};
    glm::vec3 skyColor{0.72f, 0.84f, 1.02f};
    glm::vec3 groundColor{0.44f, 0.39f, 0.28f};
    float exposure = 0;                         // stops
    glm::vec3 background{0.17f, 0.36f, 0.72f};  // at the zenith
    glm::vec3 horizon{0.66f, 0.77f, 0.88f};
    bool shadows = true;
    bool shadowsLag = false;  // while growth or houses change in every frame, shadows may follow late and coarsely; in
                              // quick pictures, too
    bool quick = false;       // on a software device fewer samples and twigs, for pictures that move
    ViewMode view = ViewMode::shaded;
    // For ViewMode::layer: index into DrawInputs::layers' 16 a surface, or colourLayers; kNoIndex: only roofs have it.
    uint32_t layer = 0;
    float layerOpacity = 1;
    BrushLimits limits = kNoLimits;  // that layer is hatched beyond them
    uint32_t level = 0;              // for ViewMode::charts
    bool pieces = true;              // false: those of patterns aren't drawn
    float lodPixels = 1;             // error allowed when choosing LOD, pixels
    glm::vec3 wind{0};               // metres a second
    float gusts = 0.7f;              // 0 to 1: how much of it comes in gusts
    double clock = 0;                // seconds
    float leafPixels = 8;  // leaves of at least so many are all drawn, of smaller ones fewer and larger; beyond 8 also
                           // fewer twigs
};

struct DrawInputs {
    GrowthView growth;      // nodeCount 0: nothing grows
    SurfaceBuf surfaces{};  // device address of the SurfaceRef table; 0: no growth and no chart view
    // As EmitInputs has it; growth stands on no model whose instance has none or 0. Empty: it may stand on all.
    std::span<const Version> placed;
    LayerBuf layers{};                // surfaces * kMaxLayers; 0: no layer view
    const RoofView* roofs = nullptr;  // none; needs loadRoofMeshes()
    GroundLook ground;
    Camera camera;
    Look look;
    glm::dvec3 origin{0};  // of the world, seen from where it was at first
};

// What a host has drawn already: growth is drawn into it, hidden by what lies nearer. The depth buffer holds
// atInfinity + perNearness / distance along the view; it and the picture can be sampled and have one sample a pixel.
// Both are in colorTarget and depthTarget, and stay there.
struct HostScene {
    VkImage depth = VK_NULL_HANDLE;  // null: there is none, the whole picture is ours
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;
    float atInfinity = 0, perNearness = 0;
    bool models = false;  // draw the surfaces too
};

// Where to draw. image null: into the renderer's own image. Otherwise the image may be in any layout, its contents
// are lost but with a host's scene, and it is left in VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL; format: one of
// EspDrawDef::colourFormat's.
struct DrawTarget {
    uint32_t width = 1280, height = 720;  // 1 to kMaxFrameSide
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    HostScene host{};  // only with an image; not with ViewMode::overdraw
};

// A pass that a host begins and ends. Its view is by matrices: world -> eye, rigid or mirroring, and eye -> clip.
struct PassView {
    PassFormat format;
    VkViewport viewport{};  // a negative height: y goes up in it
    glm::mat4 view{1}, projection{1};
    float focus = 20;     // metres ahead around which shadows of wide scenes are finest
    bool models = false;  // draw the surfaces too
};

struct RenderStats {
    EmitStats emit;
    RoofDrawStats roofs;
    uint64_t modelTriangles = 0;
    uint32_t modelsFading = 0;                     // models between two levels of detail
    uint32_t shadowsWhole = 0, shadowsPartly = 0;  // how often the near shadow map was redrawn, all or what had changed
    uint32_t shadowsTaken = 0;                     // and some of that, in strokes
    bool shadowsBehind = false;                    // in the last picture
    double emitMs = 0, drawMs = 0;                 // GPU time of the last finished frame
};

}  // namespace espalier
