#pragma once

// Drawing: surfaces, bark and leaves with sun, shadow, sky and tone mapping, into an image of ours or a host's.
// renderer_setup.cpp makes what is needed, renderer.cpp draws, renderer_terminals.cpp what has grown,
// renderer_shadows.cpp shadows, renderer_pass.cpp within a host's pass.

#include <array>
#include <map>
#include <tuple>

#include "runtime/render/depth_tiles.hpp"
#include "runtime/render/frame.hpp"
#include "runtime/render/host_merge.hpp"
#include "runtime/render/models.hpp"
#include "runtime/render/shadow_state.hpp"
#include "runtime/render/targets.hpp"
#include "shaders/shared/random.h"

namespace espalier {

constexpr uint32_t kFrameSlots = 8;  // frame records, taken in turn

// Of models, in pixels.
float allowedModelError(const Look& look, bool grows);

class Renderer {
  public:
    static Result<std::unique_ptr<Renderer>> create(Device& device, TerminalData terminals);
    static Result<std::unique_ptr<Renderer>> create(Device& device, const std::filesystem::path& terminals);

    // The drawn mesh of surface instance `index`; uploads and waits. groundOnly: something else draws it; only views of
    // charts and of a layer show it.
    Status setSurface(uint32_t index, const SurfaceData& data, const glm::mat4& toWorld, bool groundOnly = false) {
        unprepare();
        return models_.set(device_, index, data, toWorld, groundOnly);
    }
    // Of a plan whose upload has been submitted.
    void setSurface(uint32_t index, Models::Plan plan, Upload& upload) {
        unprepare();
        models_.set(index, std::move(plan), upload);
    }
    // The surface `like`, which is there, once more at another place.
    void setSurfaceLike(uint32_t index, uint32_t like, const glm::mat4& toWorld) {
        unprepare();
        models_.setLike(index, like, toWorld);
    }
    void removeSurface(uint32_t index) {
        unprepare();
        models_.remove(index);
    }
    // Draws a surface that was set elsewhere.
    void placeSurface(uint32_t index, const glm::mat4& toWorld) { models_.place(index, toWorld); }

    void hideSurface(uint32_t index, bool hidden) {
        unprepare();
        models_.hide(index, hidden);
    }

    // Meshes that roofs are drawn with, kind 0 being none; returns their bounds. Once, before the first roofs.
    Result<std::vector<RoofMesh>> loadRoofMeshes(TerminalData meshes);

    // Models of props, their variants sorted by kind, and where they stand; in place of all that were. Waits.
    Status setProps(TerminalData models, std::vector<PropPlace> places);
    Status removeProps();
    // Meshes that patterns are drawn with, kind 0 being none. Once, before the first pieces.
    Status loadPieces(TerminalData meshes);
    // Pieces of patterns, in place of all that stood.
    Status placePieces(std::vector<PatternPiece> pieces);
    // Geometry of procedural graphs, in place of all that stood, with a box around each part.
    Status placeGraph(Geometry parts, std::span<const NodeBox> boxes);
    const GraphDraw* graph() const { return graph_.get(); }  // null: there never was any
    // What lies on the ground that is drawn; without texels: nothing.
    Status setSite(const SiteMap& map) { return ground_.setSite(device_, map); }

    // Records a frame. The shadow map is redrawn only if the growth's revision, a surface or the sun has changed; after
    // edits of growth only in tiles that they reach. If it may lag: from the third frame in a row on in which growth
    // has changed, at most eight of these tiles in every second one, and all when it has come to rest; where all growth
    // is new, in every eighth frame, until then with fewer and larger leaves.
    Status draw(Commands& commands, const DrawInputs& inputs, const DrawTarget& target);

    // A frame within a pass of the host's: prepare() records outside of it what comes before, record() the pass' own
    // commands. What prepare() has made ready lasts until the next draw() or prepare(); record() may come many times.
    Status prepare(Commands& commands, const DrawInputs& inputs, const PassView& pass);
    bool prepared() const { return now_.prepared; }
    void unprepare() { now_.prepared = false; }  // something that it relies on is about to change
    void record(Commands& inside);

    // What the last draw has recorded didn't run: the next relies on none of it.
    void forget();

    // Drops what only what comes would use; what was drawn last stays as it is. growth: that stands.
    void trim(const GrowthView& growth) { emit_.trim(growth); }

    // The last frame drawn into the renderer's own image: RGBA, sRGB, rows top to bottom. Waits for it.
    Result<std::vector<uint8_t>> readPixels();

    // Counts of the last frame that has finished.
    RenderStats stats() const;

    // Other meshes for stems and leaves. Growth is bound anew. Waits. On failure the old ones stay.
    Status setTerminals(TerminalData data);
    // What stems and leaves are drawn with.
    const Terminals& terminals() const { return terminals_; }
    // What patterns are drawn with, and where; null: there are none.
    const PieceDraw* pieces() const { return pieces_.get(); }

    // Bound by itself, whatever bounds pictures bind growth in: triangles come in an order of their own.
    Result<EmittedTriangles> materialise(const EmitInputs& inputs) { return emit_.materialise(inputs); }

  private:
    explicit Renderer(Device& device) : device_(device) {}
    Status setUp(TerminalData data);
    void noteSmall();
    Status makePrograms();
    // What a recording is about, so far as it doesn't depend on where it goes.
    void begin(const DrawInputs& inputs, PassFormat pass);
    Status drawFrame(Commands& commands, const DrawInputs& inputs, const DrawTarget& target);
    // The programs that draw what is lit: one set for each kind of shading, one for the view that counts fragments.
    struct ScenePrograms {
        Program model, modelFoot, modelMapped, modelMappedFoot, tint, glass, bark, barkSmall, barkFaint, leaf,
            leafSmall;
        struct Lit {
            Program light, draw;
        };
        bool litMade = false;
        Lit litBark, litLeaves[2];  // of quick ones (lit.glsl): leaves of three vertices, and of four, if there are any
        RoofPrograms roof;
        Program piece, graph, studio;
    };
    // Those that draw depths only.
    struct DepthPrograms {
        Program model, modelCut, bark, leaf, leafCut, piece, graph;
        RoofPrograms roof;
    };
    Status makeScene(ScenePrograms& programs, Shading shading) const;
    // Those of materials that aren't plain, of which most scenes have none.
    Status makeRareScene(ScenePrograms& programs, Shading shading) const;
    Status makeSceneProgram(Program& program, const char* name, const char* vertex, const char* fragment,
                            std::vector<SpecConstant> constants, Blend blend) const;
    Status pickScene(ViewMode shown, bool quick);
    Status pickDepths(const PassFormat& pass);
    Result<const Program*> resolveProgram(VkFormat format);
    // Uploads the record to now_.frame.
    Status upload(Commands& commands, const FrameRecord& frame);
    // Tells the frame where a studio's floor lies.
    void aimStudio(const DrawInputs& inputs, FrameRecord& frame) const;
    // renderer_shadows.cpp: redraws shadows that aren't up to date, and tells the frame where they are.
    Status keepShadows(Commands& commands, const DrawInputs& inputs, FrameRecord& frame);
    ShadowScene shadowScene(const DrawInputs& inputs, glm::vec3 sun, glm::vec4 sphere) const;
    Status updateNearShadows(Commands& commands, const DrawInputs& inputs, const SunView& sun, const ShadowScene& now);
    Status drawShadows(Commands& commands, const DrawInputs& inputs, const SunView& sun);
    // The tiles that edits have changed since, or so many of them.
    Status redrawShadows(Commands& commands, const DrawInputs& inputs, const SunView& sun, uint32_t mostTiles);
    void drawStanding(DrawPass& pass, const SunView& sun, float error);
    Status makeStanding();
    // All that stands but growth, into the map's right half; the whole map is cleared.
    Status drawWideShadows(Commands& commands, const DrawInputs& inputs, const SunView& sun);
    Status aimWideShadows(Commands& commands, const DrawInputs& inputs, const SunView& near, glm::vec3 center,
                          float radius, FrameRecord& frame);
    Models::Drawn modelsDrawn() const;
    void drawSurroundings(DrawPass& pass, const PostPush& post);
    Status drawModels(Commands& commands, const DrawInputs& inputs, const DrawTarget& target, const PostPush& post);
    // A number for the models and props of this recording.
    uint64_t standing() const {
        return models_.revision() + (now_.furnished ? propsRevision_ << 32 : 0) +
               (now_.patterned ? pieces_->revision() << 48 : 0) +
               (now_.graphed ? combineKeys(graph_->revision(), 1) : 0);
    }
    EmitInputs emitInputs(const DrawInputs& inputs) const;
    uint64_t sceneOf(const DrawInputs& inputs);
    Status cullGrowth(Commands& commands, const DrawInputs& inputs, const FrameRecord& frame);
    Status cullGrowth(Commands& commands, const DrawInputs& inputs, EmitView view);
    void drawGrowth(Commands& commands, const FrameRecord& frame, const PostPush& post);
    void drawSky(DrawPass& pass, const FrameRecord& frame, const PostPush& post);
    Status lightTerminals(Commands& commands);
    // Whether what the bucket draws has few enough vertices, and pixels, to be lit ahead; whether it has been.
    bool canBeLit(uint32_t bucket) const;
    bool isLit(uint32_t bucket) const { return now_.lit && canBeLit(bucket); }
    ScenePrograms::Lit& litPrograms(ScenePrograms& programs, uint32_t bucket) const;
    Status makeLit(ScenePrograms& programs) const;
    void drawTerminals(DrawPass& pass, bool depthOnly);
    // Ribbons that are thinner than a pixel cover a share of it: with one sample a pixel they are laid over all else.
    bool faintLast(uint32_t bucket) const {
        return now_.faint && small_[bucket] && bucket < terminals_.table().barkBuckets;
    }
    void drawFaint(DrawPass& pass) const;
    void drawOcclusion(Commands& commands, const PostPush& push);
    Status resolve(Commands& commands, const DrawTarget& target, PostPush push);

    Device& device_;
    Terminals terminals_;
    Emit emit_;
    std::unique_ptr<RoofDraw> roofs_;
    std::unique_ptr<Props> props_;
    std::unique_ptr<PieceDraw> pieces_;
    std::unique_ptr<GraphDraw> graph_;
    std::unique_ptr<HostMerge> merge_;  // made when a host first has a scene
    Models models_;
    Ground ground_;
    Targets targets_;
    DepthTiles depthTiles_;
    Image shadowMap_, standing_;  // the near half without growth; made when something grows
    Sampler shadowSampler_, textureSampler_, quickSampler_, plainSampler_, pointSampler_;
    std::map<std::pair<PassFormat, Shading>, ScenePrograms> scenes_;  // each made when first asked for
    std::map<PassFormat, DepthPrograms> depths_;
    Program modelAhead_, modelAheadFading_, distance_, occlusion_, shadowRestore_;
    Program sky_[2];                                       // without and with hills
    using ResolveKind = std::tuple<VkFormat, bool, bool>;  // format, whether the view counts, whether it is quick
    std::map<ResolveKind, Program> resolves_;
    std::array<bool, kMaxBuckets> small_{};  // buckets that are lit at their vertices
    Buffer litTerminals_;                    // lit.glsl
    TexelView litTexels_;                    // of it; after it
    std::array<Buffer, kFrameSlots> frames_;
    uint32_t frameSlot_ = 0;
    NearShadows near_;
    WideShadows wide_;
    uint64_t sceneNumber_ = 0, propsRevision_ = 0;
    bool quickBefore_ = false;  // the picture before was
    // What the recording that goes on, or the last one, is about: none of it outlives the next one's beginning.
    struct {
        bool grows = false, roofed = false, furnished = false, patterned = false;  // growth, roofs, props, patterns
        bool graphed = false;                                                      // geometry of procedural graphs
        bool hosted = false;                                                       // into a host's scene
        GroundKind ground = GroundKind::none;
        PassFormat pass;  // that it draws in
        Shading shading = Shading::full;
        ScenePrograms* scene = nullptr;
        const DepthPrograms* depths = nullptr;
        bool plain = false;                        // growth and props are drawn as in the shaded view
        bool lit = false;                          // what has few vertices has been lit ahead
        bool faint = false;                        // ribbons are drawn last
        bool ahead = false;                        // models' depths went ahead, they are shaded after growth
        bool glass = false;                        // what is blended is drawn last
        float meadowLevel = 0, unit = 1;           // where grass grows over models
        bool onGround = false, walkData = false;   // the view shows surfaces themselves; there are any
        bool prepared = false, modelsToo = false;  // for a host's pass; with the surfaces
        bool mirrored = false;
        float modelError = 0;  // metres, of what draws depths only
        VkViewport viewport{};
        const Buffer* frame = nullptr;
        bool shadowsBehind = false;  // what this picture shows
    } now_;
};

}  // namespace espalier
