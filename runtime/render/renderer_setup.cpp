// Enters: the terminals. Leaves: programs, samplers and buffers of the renderer.
#include "runtime/gpu/color_texture.hpp"
#include "runtime/render/renderer.hpp"

namespace espalier {
namespace {

constexpr uint32_t kSmallIndices = 12;  // leaves of no more are for few pixels, as those of the last LOD are

}  // namespace

Status Renderer::makePrograms() {
    const bool one = targets_.samples == 1;
    GraphicsDesc ahead;
    ahead.name = "model ahead";
    ahead.vertex = "render/model_depth.vert";
    ahead.depth = kDepthFormat;
    ahead.samples = targets_.samples;
    ahead.depthCompare = VK_COMPARE_OP_GREATER_OR_EQUAL;
    takeModelPositions(ahead);
    for (Program* program : {&modelAhead_, &modelAheadFading_}) {
        if (program == &modelAheadFading_) ahead.fragment = "render/model_fade.frag";
        if (Status made = assign(*program, Program::graphics(device_, ahead)); !made) return made.failure();
    }
    GraphicsDesc skyDesc = fullscreen("render/sky.frag");
    skyDesc.colors = {kSceneFormat};
    skyDesc.samples = targets_.samples;
    skyDesc.depth = kDepthFormat;  // it lies at depth 0, infinitely far
    skyDesc.depthCompare = VK_COMPARE_OP_GREATER_OR_EQUAL;
    skyDesc.depthWrite = false;
    for (uint32_t hills : {0u, 1u}) {
        skyDesc.options.constants = {{kConstantRest, hills}};
        if (Status made = assign(sky_[hills], Program::graphics(device_, skyDesc)); !made) return made.failure();
    }
    GraphicsDesc restore;
    restore.name = "shadow restore";
    restore.vertex = "render/shadow_restore.vert";
    restore.fragment = "render/shadow_restore.frag";
    restore.depth = kDepthFormat;
    restore.depthCompare = VK_COMPARE_OP_ALWAYS;
    restore.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    if (Status made = assign(shadowRestore_, Program::graphics(device_, restore)); !made) return made.failure();
    if (Status made = assign(depthTiles_, DepthTiles::create(device_, targets_.samples)); !made) return made.failure();
    auto post = [&](Program& program, const char* fragment, VkFormat format) -> Status {
        GraphicsDesc desc = fullscreen(fragment);
        desc.colors = {format};
        return assign(program, Program::graphics(device_, desc));
    };
    return allDone({pickDepths(shadowPass()),
                    post(distance_, one ? "render/depth_single.frag" : "render/depth.frag", kDistanceFormat),
                    post(occlusion_, "render/occlusion.frag", kOpenFormat)});
}

Status Renderer::pickDepths(const PassFormat& pass) {
    DepthPrograms& programs = depths_[pass];
    now_.depths = &programs;
    const struct {
        Program& program;
        const char* name;
        const char* vertex;
        const char* fragment;
    } rows[] = {{programs.model, "model shadow", "render/model_depth.vert", ""},
                {programs.modelCut, "cut model shadow", "render/model_cut_depth.vert", "render/model_shadow.frag"},
                {programs.bark, "bark shadow", "render/bark.vert", ""},
                {programs.leaf, "leaf shadow", "render/leaf.vert", ""},
                {programs.leafCut, "cut leaf shadow", "render/leaf.vert", "render/leaf_shadow.frag"}};
    for (const auto& row : rows) {
        if (row.program) continue;
        GraphicsDesc desc = inPass(pass, row.name, row.vertex, row.fragment, {});
        if (&row.program == &programs.model) takeModelPositions(desc);
        if (&row.program == &programs.modelCut) takeModelPositions(desc, true);
        if (Status made = assign(row.program, Program::graphics(device_, desc)); !made) return made;
    }
    if (now_.roofed)
        if (Status made = programs.roof.make(device_, pass, Shading::full); !made) return made;
    if (now_.patterned && !programs.piece)
        if (Status made = assign(programs.piece, PieceDraw::program(device_, pass, Shading::full)); !made) return made;
    if (!now_.graphed || programs.graph) return Done{};
    return assign(programs.graph, GraphDraw::program(device_, pass, Shading::full));
}

Status Renderer::makeSceneProgram(Program& program, const char* name, const char* vertex, const char* fragment,
                                  std::vector<SpecConstant> constants, Blend blend) const {
    GraphicsDesc desc = inPass(now_.pass, name, vertex, fragment, std::move(constants));
    desc.blend = blend;
    if (std::string_view(vertex) == "render/model.vert") takeModelVertices(desc);
    if (std::string_view(vertex) == "render/model_mapped.vert") takeModelVertices(desc, true);
    desc.depthWrite = blend != Blend::over && blend != Blend::multiply;
    return assign(program, Program::graphics(device_, desc));
}

Status Renderer::makeScene(ScenePrograms& programs, Shading shading) const {
    if (isQuick(shading) && !programs.litMade) {
        if (Status lit = makeLit(programs); !lit) return lit;
        programs.litMade = true;
    }
    if (programs.model) return Done{};
    const bool one = now_.pass.samples == 1;
    const struct {
        Program& program;
        const char* name;
        const char* vertex;
        const char* fragment;
        bool rest = false;  // draws the rest, too
    } rows[] = {{programs.bark, "bark", "render/bark.vert", one ? "render/bark_single.frag" : "render/bark.frag"},
                {programs.barkSmall, "small bark", "render/bark_small.vert",
                 one ? "render/bark_small_single.frag" : "render/bark_small.frag"},
                {programs.leaf, "leaf", "render/leaf.vert", one ? "render/leaf_single.frag" : "render/leaf.frag"},
                {programs.leafSmall, "small leaf", "render/leaf_small.vert",
                 one ? "render/leaf_small_single.frag" : "render/leaf_small.frag"},
                {programs.modelFoot, "model's foot", "render/model.vert", "render/model.frag", true},
                {programs.model, "model", "render/model.vert", "render/model.frag"}};  // last: then all are made
    for (const auto& row : rows) {
        const Status made = makeSceneProgram(row.program, row.name, row.vertex, row.fragment,
                                             constantsOf(shading, holdsRoots(device_), row.rest), blendOf(shading));
        if (!made) return made;
    }
    return Done{};
}

Status Renderer::makeRareScene(ScenePrograms& programs, Shading shading) const {
    const auto make = [&](Program& program, const char* name, const char* fragment, bool rest, Blend blend) -> Status {
        if (program) return Done{};
        return makeSceneProgram(program, name, "render/model_mapped.vert", fragment,
                                constantsOf(shading, holdsRoots(device_), rest), blend);
    };
    if (models_.anyMapped()) {
        const Blend blend = blendOf(shading);
        if (Status s = make(programs.modelMappedFoot, "mapped model's foot", "render/model_mapped.frag", true, blend);
            !s)
            return s;
        if (Status s = make(programs.modelMapped, "mapped model", "render/model_mapped.frag", false, blend); !s)
            return s;
    }
    if (now_.faint && !programs.barkFaint) {
        Status made =
            makeSceneProgram(programs.barkFaint, "faint bark", "render/bark_small.vert", "render/bark_small_faint.frag",
                             constantsOf(shading, holdsRoots(device_)), Blend::over);
        if (!made) return made;
    }
    if (now_.roofed)
        if (Status s = programs.roof.make(device_, now_.pass, shading); !s) return s;
    if (now_.patterned && !programs.piece)
        if (Status s = assign(programs.piece, PieceDraw::program(device_, now_.pass, shading)); !s) return s;
    if (now_.graphed && !programs.graph)
        if (Status s = assign(programs.graph, GraphDraw::program(device_, now_.pass, shading)); !s) return s;
    if (now_.ground == GroundKind::studio && !programs.studio) {
        Status made = makeSceneProgram(programs.studio, "studio floor", "render/ground.vert", "render/studio.frag",
                                       constantsOf(shading), blendOf(shading));
        if (!made) return made;
    }
    if (!now_.glass) return Done{};
    if (Status s = make(programs.tint, "glass tint", "render/model_tint.frag", false, Blend::multiply); !s) return s;
    return make(programs.glass, "glass", "render/model_glass.frag", false, Blend::over);
}

Status Renderer::pickScene(ViewMode shown, bool quick) {
    const bool explained = shown != ViewMode::shaded, cheap = quick && device_.info().traits.quickPictures;
    now_.plain = !explained || shown == ViewMode::layer;
    if (shown == ViewMode::overdraw)
        now_.shading = Shading::counting;
    else if (explained)
        now_.shading = cheap ? Shading::quickExplaining : Shading::explaining;
    else
        now_.shading = cheap ? Shading::quick : Shading::full;
    now_.scene = &scenes_[{now_.pass, now_.shading}];
    if (Status made = makeScene(*now_.scene, now_.shading); !made) return made;
    now_.glass = !explained && !now_.hosted && models_.anyGlass();
    now_.faint = now_.grows && now_.pass.samples == 1 && !now_.hosted && now_.shading == Shading::full;
    return makeRareScene(*now_.scene, now_.shading);
}

Result<const Program*> Renderer::resolveProgram(VkFormat format) {
    const bool counts = now_.shading == Shading::counting;
    const ResolveKind kind{format, counts, isQuick(now_.shading)};
    if (auto it = resolves_.find(kind); it != resolves_.end()) return &it->second;
    const char* fragment = targets_.samples == 1 ? "render/resolve_single.frag" : "render/resolve.frag";
    GraphicsDesc desc = fullscreen(fragment);
    desc.colors = {format};
    desc.options.constants = {{kConstantExplains, counts ? 1u : 0u}, {kConstantQuick, isQuick(now_.shading) ? 1u : 0u}};
    Result<Program> made = Program::graphics(device_, desc);
    if (!made) return made.failure();
    return &(resolves_[kind] = std::move(*made));
}

// Which meshes are for few pixels.
void Renderer::noteSmall() {
    const TerminalTable& table = terminals_.table();
    small_.fill(false);
    for (uint32_t v = 0; v < table.variants.size(); ++v) {
        const VariantRecord& variant = table.variants[v];
        const uint32_t last = variant.firstBucket + variant.lodCount - 1;
        const bool ribbon = table.buckets[last].vertexCount == kRibbonVertices;
        if (last < table.barkBuckets)
            small_[last] = ribbon;
        else if (variant.lodCount > 1)
            for (uint32_t b = variant.firstBucket; b <= last; ++b)
                small_[b] = b == last || table.buckets[b].indexCount <= kSmallIndices;
    }
}

// Emission refers to terminals_, whose place in memory stays.
Status Renderer::setTerminals(TerminalData data) {
    Result<Terminals> terminals = Terminals::create(device_, std::move(data));
    if (!terminals) return terminals.failure();
    Result<Emit> emit = Emit::create(device_, terminals_);
    if (!emit) return emit.failure();
    unprepare();
    terminals_ = std::move(*terminals);
    emit_ = std::move(*emit);
    noteSmall();
    for (auto& [kind, programs] : scenes_) programs.litMade = false;
    near_.clear();
    return Done{};
}

Status Renderer::setUp(TerminalData data) {
    targets_.samples = device_.info().traits.samples;
    if (Status made = assign(terminals_, Terminals::create(device_, std::move(data))); !made) return made.failure();
    noteSmall();
    if (Status made = assign(emit_, Emit::create(device_, terminals_)); !made) return made.failure();
    if (Status made = assign(models_, Models::create(device_)); !made) return made.failure();
    if (Status made = assign(ground_, Ground::create(device_, kSceneFormat, kDepthFormat, targets_.samples)); !made)
        return made.failure();
    ImageDesc shadow{.name = "shadow map", .format = kDepthFormat, .width = 2 * kShadowSize, .height = kShadowSize};
    shadow.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    Result<Image> map = Image::create(device_, shadow);
    if (!map) return map.failure();
    shadowMap_ = std::move(*map);
    const DeviceTraits& traits = device_.info().traits;
    const struct {
        Sampler& sampler;
        SamplerDesc desc;
    } samplers[] = {
        {shadowSampler_,
         {.name = "shadow map",
          .address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
          .mips = false,
          .shadowCompare = true}},
        {textureSampler_, {.name = "terminal textures", .anisotropy = traits.anisotropy}},
        {quickSampler_, {.name = "terminal textures, quick", .blendMips = false}},
        {pointSampler_,
         {.name = "point",
          .filter = VK_FILTER_NEAREST,
          .address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
          .mips = false}},
        {plainSampler_, {.name = "plain", .address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, .mips = false}}};
    for (const auto& s : samplers) {
        if (Status made = assign(s.sampler, Sampler::create(device_, s.desc)); !made) return made.failure();
    }
    for (Buffer& frame : frames_) {
        if (Status made = assign(frame, Buffer::create(device_, "frame", sizeof(FrameRecord))); !made)
            return made.failure();
    }
    return makePrograms();
}

Result<std::unique_ptr<Renderer>> Renderer::create(Device& device, TerminalData terminals) {
    std::unique_ptr<Renderer> renderer(new Renderer(device));
    if (Status s = renderer->setUp(std::move(terminals)); !s) return s.failure();
    return renderer;
}

Result<std::unique_ptr<Renderer>> Renderer::create(Device& device, const std::filesystem::path& terminals) {
    Result<TerminalData> data = readTerminals(terminals);
    if (!data) return data.failure();
    return create(device, std::move(*data));
}

}  // namespace espalier
