#pragma once

// The renderer behind renderer.hpp: renderer_setup.cpp makes it, renderer.cpp draws.

#include <array>
#include <map>

#include "runtime/render/frame.hpp"
#include "runtime/render/models.hpp"
#include "runtime/render/renderer.hpp"
#include "runtime/render/targets.hpp"

namespace espalier {

constexpr uint32_t kFrameSlots = 8;  // frame records that recordings in flight may still read

class RendererImpl final : public Renderer {
  public:
    explicit RendererImpl(Device& device) : device_(device) {}

    Status setUp(TerminalData data);
    Status setSurface(uint32_t index, const SurfaceData& data, const glm::mat4& toWorld) override {
        return models_.set(device_, index, data, toWorld);
    }
    void removeSurface(uint32_t index) override { models_.remove(index); }
    void placeSurface(uint32_t index, const glm::mat4& toWorld) override { models_.place(index, toWorld); }
    Result<std::vector<RoofMesh>> loadRoofMeshes(TerminalData meshes) override;
    Status draw(Commands& commands, const DrawInputs& inputs, const DrawTarget& target) override;
    Result<std::vector<uint8_t>> readPixels() override;
    RenderStats stats() const override;
    Result<EmittedTriangles> materialise(const EmitInputs& inputs) override { return emit_.materialise(inputs); }

  private:
    struct ShadowKey {
        uint64_t growth = 0, models = 0;
        glm::vec3 sun{0};
        uint32_t nodes = 0, leaves = 0;
        uint64_t roofs = 0;
        glm::vec4 sphere{0};
        bool operator==(const ShadowKey&) const = default;
    };

    Status makePrograms();
    Result<Program> sceneProgram(const char* name, const char* vertex, const char* fragment, Blend blend) const;
    Status makeCounting();
    Result<const Program*> resolveProgram(VkFormat format);
    // Uploads the record and returns its address.
    Result<uint64_t> upload(Commands& commands, const FrameRecord& frame);
    Status drawShadows(Commands& commands, const DrawInputs& inputs, const SunView& sun, float lodPixels);
    void drawModels(Commands& commands, const DrawInputs& inputs, const PostPush& post);
    Status cullGrowth(Commands& commands, const DrawInputs& inputs, const FrameRecord& frame);
    void drawGrowth(Commands& commands, const PostPush& post);
    enum class Terminal { depthOnly, plain, smallLit, counting };
    // plain: every leaf is lit at each pixel, as the views that explain want it. counting: fragments are added up.
    void drawTerminals(DrawPass& pass, uint64_t frame, Terminal how);
    void drawOcclusion(Commands& commands, const PostPush& push);
    Status resolve(Commands& commands, const DrawTarget& target, PostPush push);

    Device& device_;
    Terminals terminals_;
    Emit emit_;
    std::unique_ptr<RoofDraw> roofs_;
    Models models_;
    Ground ground_;
    Targets targets_;
    Image shadowMap_;
    Sampler shadowSampler_, textureSampler_, plainSampler_, pointSampler_;
    Program model_, bark_, leaf_, leafSmall_, modelDepth_, barkDepth_, leafDepth_, leafCutDepth_, distance_, occlusion_,
        sky_, depthTiles_;
    struct {
        Program model, bark, leaf;
    } counting_;  // made when first asked for
    std::map<VkFormat, Program> resolves_;
    std::array<bool, kMaxBuckets> small_{};  // buckets of leaves that are lit at their vertices
    Buffer frames_, tiles_;
    uint32_t frameSlot_ = 0;
    ShadowKey shadowKey_;
    bool grows_ = false, roofed_ = false, explained_ = false, counts_ = false, shadowDrawn_ = false;
};

}  // namespace espalier
