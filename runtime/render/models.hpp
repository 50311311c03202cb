#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/gpu/commands.hpp"
#include "runtime/gpu/upload.hpp"
#include "runtime/graph/node.hpp"
#include "runtime/render/ground.hpp"
#include "runtime/surface/length_unit.hpp"
#include "runtime/surface/surface.hpp"
#include "shaders/render/frame_records.h"

namespace espalier {

// What render/model.vert reads of a vertex, and what render/model_depth.vert does. mapped: also the second UV set, as
// render/model_mapped.vert. pictured: also the place in its picture, as render/model_cut_depth.vert.
void takeModelVertices(GraphicsDesc& desc, bool mapped = false);
void takeModelPositions(GraphicsDesc& desc, bool pictured = false);

// What is drawn where a material has no picture, or its own is damaged.
inline const Image& pictureOr(const std::vector<Image>& images, int index, const Image& other) {
    return index >= 0 && size_t(index) < images.size() && images[size_t(index)] ? images[size_t(index)] : other;
}

// The drawn meshes of the surfaces on the GPU, with their textures.
class Models {
  public:
    static Result<Models> create(Device& device);

    // groundOnly: something else draws it, see draw().
    Status set(Device& device, uint32_t index, const SurfaceData& data, const glm::mat4& toWorld, bool groundOnly);
    // The same in steps: what is to be uploaded, on any thread, and the model once the upload has been submitted.
    // roots: holdsRoots().
    class Plan;
    static Plan plan(const SurfaceData& data, const glm::mat4& toWorld, bool groundOnly, bool roots, Upload& upload);
    void set(uint32_t index, Plan plan, Upload& upload);
    // The model `like`, which is there, once more at another place: shares what was uploaded.
    void setLike(uint32_t index, uint32_t like, const glm::mat4& toWorld);
    void remove(uint32_t index);
    void place(uint32_t index, const glm::mat4& toWorld);
    // Neither drawn nor casting a shadow, in any view, until it is set anew or shown.
    void hide(uint32_t index, bool hidden);

    // Picks for each model the simplest mesh whose error is at most `pixels` where the model is nearest. Once before a
    // frame's draw: when the pick changes, the one mesh takes over from the other within the next kFadeFrames,
    // or at once. Models beyond the sides of the view aren't drawn. Of meshes that are solid (solid.hpp) above the
    // ground's level, below which nothing is seen, draws leave out what turns its back to the eye.
    void choose(const FrameRecord& frame, float pixels, bool atOnce = false);
    static constexpr uint32_t kFadeFrames = 8;

    // Whether some of them have materials that aren't plain: programs for these are made when there are any.
    bool anyMapped() const;  // textures by UVs of their own, light, what mirrors
    bool anyGlass() const;   // blended with what lies behind

    // Draws all of them as chosen, but for those that are ground only if `drawnOnly`: triangles over which the meadow
    // at meadowLevel, in metres of `unit`, may grow by `foot`, all others by `program`; of materials that aren't plain
    // by `mapped`. ground: of it the meadow is made, and their grain. glassApart: drawGlass() draws what is blended,
    // else it is drawn as if it weren't.
    struct Programs {
        const Program *program, *foot;
    };
    struct Drawn {
        Programs plain, mapped;
        const Buffer& frame;
        Binding shadow;
        const Ground& ground;
        Shading shading = Shading::full;
        bool walkData = false, drawnOnly = false, glassApart = false;
        float meadowLevel = 0, unit = 1;
    };
    void draw(DrawPass& pass, const Drawn& with) const;
    // What is blended, over all that has been drawn, the farthest along the view first: ranges by their middles,
    // triangles of a range by theirs. tint: takes from what lies behind what coloured glass doesn't let through.
    struct GlassPrograms {
        const Program &tint, &glass;
    };
    void drawGlass(DrawPass& pass, const Drawn& with, const GlassPrograms& programs, glm::vec3 forward) const;
    // The depths of what draw() draws without cut-outs: they go ahead, so that it shades only what is seen. fading: for
    // models of which two meshes are drawn.
    void drawAhead(DrawPass& pass, const Program& whole, const Program& fading, const Buffer& frame,
                   bool glassApart) const;
    // The simplest meshes with an error of at most `error` metres.
    void drawDepth(DrawPass& pass, const Program& whole, const Program& cut, const Buffer& frame, float error) const;

    uint64_t triangles() const;                      // that are drawn, as chosen
    uint32_t fading() const;                         // models of which two meshes are drawn
    uint64_t revision() const { return revision_; }  // grows with every change
    bool empty() const { return models_.empty(); }
    // World bounds of all models; a small box around the origin if there are none.
    void bounds(glm::vec3& low, glm::vec3& high) const;
    // Of those that DrawInputs::placed says growth may stand on; nothing if there are none.
    std::optional<std::array<glm::vec3, 2>> carrierBounds(std::span<const Version> placed) const;
    float lengthUnit() const;

  private:
    // Triangles of a range lie in order of the storey that their lowest corner is in: so many indices are in each and
    // those below it.
    static constexpr uint32_t kStoreys = 32;
    using Storeys = std::array<uint32_t, kStoreys>;
    // A range that is blended: its indices from firstIndex on, once for each of the directions by which they are
    // sorted.
    struct Panes {
        uint32_t firstIndex = 0;
        glm::vec3 middle{0};
    };
    // One of a model's meshes; all of them lie in the same buffers.
    struct Mesh {
        int32_t firstVertex = 0;
        std::vector<DrawRange> ranges{};
        std::vector<Storeys> storeys{};  // [range]
        std::vector<Panes> panes{};      // [range]
        float error = 0;                 // metres, before it is placed
        float solidAbove = 0;            // as of solid.hpp, along Shape::up; of what has no cut-outs
    };
    // What all places of a surface share.
    struct Shape {
        Buffer vertices, indices;
        std::vector<Mesh> meshes;  // of rising error, 0 the model itself
        std::vector<Material> materials;
        std::vector<Image> colors, normals;  // one a picture of the file; empty where unused in that role
        std::vector<Buffer> records;         // one a material: MaterialRecord, of those that aren't plain
        glm::vec3 low{0}, high{0};           // object space
        glm::vec3 up{0};                     // of the world, in object space, when triangles were put in order
        float lowest = 0, storey = 0;        // along `up`: where the first storey begins, how high each is
        const Material& materialOf(const DrawRange& range) const {
            return materials[std::min<size_t>(range.material, materials.size() - 1)];
        }
    };
    struct Model {
        std::shared_ptr<const Shape> shape;
        uint32_t shown = 0, before = 0;
        uint32_t step = 0;  // of kFadeFrames from `before` to `shown`; 0: never drawn
        bool groundOnly = false;
        bool hidden = false;
        bool seen = true;  // some of it may lie in the view
        glm::mat4 toWorld{1};
        float scale = 1;
        bool mirrored = false;
        glm::vec3 low{0}, high{0};  // world
        void place(const glm::mat4& to);
    };
    static void raise(const SurfaceData& data, const glm::mat4& toWorld, Shape& shape);
    static Storeys intoStoreys(const Shape& shape, std::span<const DrawVertex> vertices, std::span<uint32_t> indices);
    // Indices at a range's front whose triangles the meadow may reach.
    static uint32_t footOf(const Model& model, const Mesh& mesh, size_t range, float groundLevel, float unit);
    static void planMeshes(const SurfaceData& data, const glm::mat4& toWorld, Plan& plan, Upload& upload);
    static void planPictures(const SurfaceData& data, bool roots, Plan& plan, Upload& upload);
    static void planRecords(Plan& plan, Upload& upload);
    // Appends a range's triangles in the order of each direction.
    static Panes intoPanes(std::span<const DrawVertex> vertices, const DrawRange& range,
                           std::vector<uint32_t>& indices);
    static bool isMapped(const Material& material);
    void drawMapped(DrawPass& pass, const Program& program, const Drawn& with, const Model& model,
                    const DrawRange& range, const DrawPass::IndexRange& indices, const ModelPush& push) const;
    Status makeSamplers(Device& device);
    const Sampler& samplerOf(const Material& material, bool quick) const;
    ModelPush pushOf(const Model& model, uint32_t mesh, const Material& material, uint32_t surface) const;
    static bool standsAs(const Model& model);
    static void useBuffersOf(DrawPass& pass, const Model& model);
    static void endModels(DrawPass& pass);
    // Where `eye` is, the mesh's backs may be seen.
    bool showsBacks(const Model& model, const Mesh& mesh, const Material& material) const;
    static uint32_t simplest(const Model& model, float error);
    template <class Each>
    static void overShown(const Model& model, const Each& each);

    std::map<uint32_t, Model> models_;
    Image white_, flat_;
    std::array<Sampler, kWraps * kWraps> samplers_, quickSamplers_;  // by what lies beyond borders
    uint64_t revision_ = 1;
    glm::vec3 eye_{0};  // as chosen for
    float groundLevel_ = 0;
};

// A model, and by which numbers the upload knows its buffers and images.
class Models::Plan {
    friend class Models;
    static constexpr size_t kNone = ~size_t(0);
    Model model;
    Shape shape;
    size_t vertices = kNone, indices = kNone;
    std::vector<size_t> colors, normals, records;  // as Shape's; kNone: there is none
};

// each(mesh, fade): the mesh that is drawn, or the two that share the picture.
template <class Each>
void Models::overShown(const Model& model, const Each& each) {
    if (model.step == kFadeFrames) return each(model.shown, 1.0f);
    // Pixels go to the coarser one in one order and come back in the same.
    const float share = float(model.step) / kFadeFrames, coarser = model.shown > model.before ? share : 1 - share;
    each(std::max(model.shown, model.before), coarser);
    each(std::min(model.shown, model.before), -coarser);
}

}  // namespace espalier
