#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <vector>

#include "runtime/gpu/commands.hpp"
#include "runtime/render/ground.hpp"
#include "runtime/surface/length_unit.hpp"
#include "runtime/surface/surface.hpp"
#include "shaders/render/frame_records.h"

namespace espalier {

// What render/model.vert reads of a vertex, and what render/model_depth.vert does. pictured: also the place in its
// picture, as render/model_cut_depth.vert.
void takeModelVertices(GraphicsDesc& desc);
void takeModelPositions(GraphicsDesc& desc, bool pictured = false);

// The drawn meshes of the surfaces on the GPU, with their textures.
class Models {
  public:
    static Result<Models> create(Device& device);

    // groundOnly: something else draws it, see draw().
    Status set(Device& device, uint32_t index, const SurfaceData& data, const glm::mat4& toWorld, bool groundOnly);
    void remove(uint32_t index);
    void place(uint32_t index, const glm::mat4& toWorld);

    // Picks for each model the simplest mesh whose error is at most `pixels` where the model is nearest. Once before a
    // frame's draw: when the pick changes, the one mesh takes over from the other within the next kFadeFrames,
    // or at once. Models beyond the sides of the view aren't drawn. Of meshes that are solid (solid.hpp) above the
    // ground's level, below which nothing is seen, draws leave out what turns its back to the eye.
    void choose(const FrameRecord& frame, float pixels, bool atOnce = false);
    static constexpr uint32_t kFadeFrames = 8;

    // Draws all of them as chosen, but for those that are ground only if `drawnOnly`: triangles that the meadow at
    // groundLevel, in metres of `unit`, may reach by `foot`, all others by `program`. ground: of it the meadow is made,
    // and their grain.
    struct Drawn {
        const Program &program, &foot;
        const Buffer& frame;
        Binding shadow;
        const Ground& ground;
        Shading shading = Shading::full;
        bool walkData = false, drawnOnly = false;
        float groundLevel = 0, unit = 1;
    };
    void draw(DrawPass& pass, const Drawn& with) const;
    // The depths of what draw() draws without cut-outs: they go ahead, so that it shades only what is seen. fading: for
    // models of which two meshes are drawn.
    void drawAhead(DrawPass& pass, const Program& whole, const Program& fading, const Buffer& frame) const;
    // The simplest meshes with an error of at most `error` metres.
    void drawDepth(DrawPass& pass, const Program& whole, const Program& cut, const Buffer& frame, float error) const;

    uint64_t triangles() const;                      // that are drawn, as chosen
    uint32_t fading() const;                         // models of which two meshes are drawn
    uint64_t revision() const { return revision_; }  // grows with every change
    bool empty() const { return models_.empty(); }
    // World bounds of all models; a small box around the origin if there are none.
    void bounds(glm::vec3& low, glm::vec3& high) const;
    float lengthUnit() const;

  private:
    // Triangles of a range lie in order of the storey that their lowest corner is in: so many indices are in each and
    // those below it.
    static constexpr uint32_t kStoreys = 32;
    using Storeys = std::array<uint32_t, kStoreys>;
    // One of a model's meshes; all of them lie in the same buffers.
    struct Mesh {
        int32_t firstVertex = 0;
        std::vector<DrawRange> ranges;
        std::vector<Storeys> storeys;  // [range]
        float error = 0;               // metres in the world
        float solidAbove = 0;          // as of solid.hpp, along Model::up; of what has no cut-outs
    };
    struct Model {
        Buffer vertices, indices;
        std::vector<Mesh> meshes;  // of rising error, 0 the model itself
        uint32_t shown = 0, before = 0;
        uint32_t step = 0;  // of kFadeFrames from `before` to `shown`; 0: never drawn
        bool groundOnly = false;
        bool seen = true;  // some of it may lie in the view
        std::vector<Material> materials;
        std::vector<Image> colors, normals;  // one a picture of the file; empty where unused in that role
        glm::vec3 objectLow{0}, objectHigh{0};
        glm::mat4 toWorld{1};
        glm::vec3 low{0}, high{0};     // world
        glm::vec3 up{0};               // of the world, in object space, when triangles were put in order
        float lowest = 0, storey = 0;  // along `up`: where the first storey begins, how high each is
        void place(const glm::mat4& to);
        const Material& materialOf(const DrawRange& range) const {
            return materials[std::min<size_t>(range.material, materials.size() - 1)];
        }
    };
    static void raise(const SurfaceData& data, Model& model);
    static Storeys intoStoreys(const Model& model, std::span<const DrawVertex> vertices, std::span<uint32_t> indices);
    // Indices at a range's front whose triangles the meadow may reach.
    static uint32_t footOf(const Model& model, const Mesh& mesh, size_t range, float groundLevel, float unit);
    Status uploadMeshes(Device& device, const SurfaceData& data, Model& model);
    Status uploadPictures(Device& device, const SurfaceData& data, Model& model);
    ModelPush pushOf(const Model& model, uint32_t mesh, const Material& material, uint32_t surface) const;
    static bool standsAs(const Model& model);
    // Where `eye` is, the mesh's backs may be seen.
    bool showsBacks(const Model& model, const Mesh& mesh, const Material& material) const;
    static uint32_t simplest(const Model& model, float error);
    template <class Each>
    static void overShown(const Model& model, const Each& each);

    std::map<uint32_t, Model> models_;
    Image white_, flat_;
    Sampler sampler_, quickSampler_;
    uint64_t revision_ = 1;
    glm::vec3 eye_{0};  // as chosen for
    float groundLevel_ = 0;
};

}  // namespace espalier
