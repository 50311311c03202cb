#pragma once

#include <map>
#include <vector>

#include "runtime/gpu/commands.hpp"
#include "runtime/render/ground.hpp"
#include "runtime/surface/surface.hpp"
#include "shaders/render/frame_records.h"

namespace espalier {

// What render/model.vert reads of a vertex.
void takeModelVertices(GraphicsDesc& desc);

// The drawn meshes of the surfaces on the GPU, with their textures.
class Models {
  public:
    static Result<Models> create(Device& device);

    // groundOnly: something else draws it, see draw().
    Status set(Device& device, uint32_t index, const SurfaceData& data, const glm::mat4& toWorld, bool groundOnly);
    void remove(uint32_t index);
    void place(uint32_t index, const glm::mat4& toWorld);

    // Picks for each model the simplest mesh whose error is at most `pixels` where the model is nearest. Once before a
    // frame's draw: when the pick changes, the one mesh takes over from the other within the next kFadeFrames.
    void choose(glm::vec3 eye, float pixelScale, float pixels);
    static constexpr uint32_t kFadeFrames = 8;

    // Draws all of them as chosen, but for those that are ground only if `drawnOnly`. ground: of it the meadow at their
    // feet is made, and their grain.
    void draw(DrawPass& pass, const Program& program, const Buffer& frame, const Binding& shadow, const Ground& ground,
              bool walkData, bool drawnOnly) const;
    // The depths of those that draw() draws whole: they go ahead, so that it shades only what is seen.
    void drawAhead(DrawPass& pass, const Program& program, const Buffer& frame) const;
    // The simplest meshes with an error of at most `error` metres.
    void drawDepth(DrawPass& pass, const Program& program, const Buffer& frame, float error) const;

    uint64_t triangles() const;                      // as chosen
    uint32_t fading() const;                         // models of which two meshes are drawn
    uint64_t revision() const { return revision_; }  // grows with every change
    bool empty() const { return models_.empty(); }
    // World bounds of all models; a small box around the origin if there are none.
    void bounds(glm::vec3& low, glm::vec3& high) const;

  private:
    // One of a model's meshes; all of them lie in the same buffers.
    struct Mesh {
        int32_t firstVertex = 0;
        std::vector<DrawRange> ranges;
        float error = 0;  // metres in the world
    };
    struct Model {
        Buffer vertices, indices;
        std::vector<Mesh> meshes;  // of rising error, 0 the model itself
        uint32_t shown = 0, before = 0;
        uint32_t step = 0;  // of kFadeFrames from `before` to `shown`; 0: never drawn
        bool groundOnly = false;
        std::vector<Material> materials;
        std::vector<Image> colors, normals;  // one a picture of the file; empty where unused in that role
        glm::vec3 objectLow{0}, objectHigh{0};
        glm::mat4 toWorld{1};
        glm::vec3 low{0}, high{0};  // world
        void place(const glm::mat4& to);
    };
    Status uploadMeshes(Device& device, const SurfaceData& data, Model& model);
    Status uploadPictures(Device& device, const SurfaceData& data, Model& model);
    ModelPush pushOf(const Model& model, uint32_t mesh, const Material& material, uint32_t surface) const;
    static uint32_t simplest(const Model& model, float error);

    std::map<uint32_t, Model> models_;
    Image white_, flat_;
    Sampler sampler_;
    uint64_t revision_ = 1;
};

}  // namespace espalier
