#pragma once

#include <map>
#include <vector>

#include "runtime/gpu/commands.hpp"
#include "runtime/surface/surface.hpp"
#include "shaders/render/frame_records.h"

namespace espalier {

// The drawn meshes of the surfaces on the GPU, with their textures.
class Models {
  public:
    static Result<Models> create(Device& device);

    Status set(Device& device, uint32_t index, const SurfaceData& data, const glm::mat4& toWorld);
    void remove(uint32_t index);

    // Draws all of them; `shadowMap` may be without an image for a depth-only program.
    void draw(DrawPass& pass, const Program& program, uint64_t frame, const Image& shadowMap,
              const Sampler& shadowSampler, bool walkData) const;
    void drawDepth(DrawPass& pass, const Program& program, uint64_t frame) const;

    uint64_t triangles() const;
    uint64_t revision() const { return revision_; }  // grows with every change
    bool empty() const { return models_.empty(); }
    // World bounds of all models; a small box around the origin if there are none.
    void bounds(glm::vec3& low, glm::vec3& high) const;

  private:
    struct Model {
        Buffer vertices, indices;
        std::vector<DrawRange> ranges;
        std::vector<Material> materials;
        std::vector<Image> colors, normals;  // one a picture of the file; empty where unused in that role
        glm::mat4 toWorld{1};
        glm::vec3 low{0}, high{0};
    };
    Status upload(Device& device, const SurfaceData& data, Model& model);
    ModelPush pushOf(const Model& model, const Material& material, uint64_t frame, uint32_t surface) const;

    std::map<uint32_t, Model> models_;
    Image white_, flat_;
    Sampler sampler_;
    uint64_t revision_ = 1;
};

}  // namespace espalier
