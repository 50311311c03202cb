#pragma once

// Drawing: surfaces, bark and leaves with sun, shadow, sky and tone mapping, into an image of ours or a host's.

#include <filesystem>
#include <memory>

#include "runtime/emit/emit.hpp"
#include "runtime/render/ground.hpp"
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
    float lodPixels = 1;             // error allowed when choosing LOD, pixels
    float leafPixels = 8;  // leaves of at least so many are all drawn, of smaller ones fewer and larger; beyond 8 also
                           // fewer twigs
};

struct DrawInputs {
    GrowthView growth;                // nodeCount 0: nothing grows
    SurfaceBuf surfaces{};            // device address of the SurfaceRef table; 0: no growth and no chart view
    uint64_t surfacesRevision = 0;    // another one when that table says something else
    LayerBuf layers{};                // surfaces * kMaxLayers; 0: no layer view
    const RoofView* roofs = nullptr;  // none; needs loadRoofMeshes()
    GroundLook ground;
    Camera camera;
    Look look;
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

class Renderer {
  public:
    static Result<std::unique_ptr<Renderer>> create(Device& device, TerminalData terminals);
    static Result<std::unique_ptr<Renderer>> create(Device& device, const std::filesystem::path& terminals);
    virtual ~Renderer() = default;

    // The drawn mesh of surface instance `index`; uploads and waits. groundOnly: something else draws it; only views of
    // charts and of a layer show it.
    virtual Status setSurface(uint32_t index, const SurfaceData& data, const glm::mat4& toWorld,
                              bool groundOnly = false) = 0;
    virtual void removeSurface(uint32_t index) = 0;
    // Draws a surface that was set elsewhere.
    virtual void placeSurface(uint32_t index, const glm::mat4& toWorld) = 0;

    // Meshes that roofs are drawn with, kind 0 being none; returns their bounds. Once, before the first roofs.
    virtual Result<std::vector<RoofMesh>> loadRoofMeshes(TerminalData meshes) = 0;

    // Models of props, their variants sorted by kind, and where they stand; in place of all that were. Waits.
    virtual Status setProps(TerminalData models, std::vector<PropPlace> places) = 0;
    virtual Status removeProps() = 0;
    // What lies on the ground that is drawn; without texels: nothing.
    virtual Status setSite(const SiteMap& map) = 0;

    // Records a frame. The shadow map is redrawn only if the growth's revision, a surface or the sun has changed; after
    // edits of growth only in tiles that they reach. If it may lag: from the third frame in a row on in which growth
    // has changed, at most eight of these tiles in every second one, and all when it has come to rest; where all growth
    // is new, in every eighth frame, until then with fewer and larger leaves.
    virtual Status draw(Commands& commands, const DrawInputs& inputs, const DrawTarget& target) = 0;

    // What the last draw has recorded didn't run: the next relies on none of it.
    virtual void forget() = 0;

    // Drops what only what comes would use; what was drawn last stays as it is. growth: that stands.
    virtual void trim(const GrowthView& growth) = 0;

    // The last frame drawn into the renderer's own image: RGBA, sRGB, rows top to bottom. Waits for it.
    virtual Result<std::vector<uint8_t>> readPixels() = 0;

    // Counts of the last frame that has finished.
    virtual RenderStats stats() const = 0;

    virtual Result<EmittedTriangles> materialise(const EmitInputs& inputs) = 0;
};

}  // namespace espalier
