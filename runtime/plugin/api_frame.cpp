// Drawing and reading back: what a host calls each frame after espUpdate.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "runtime/gpu/commands.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/dense_part.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/frame_inputs.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/town_growth.hpp"
#include "runtime/render/host_formats.hpp"
#include "shaders/render/heat.h"

namespace espalier {

void setDefaults(EspLook& out) {
    const Look look;
    const auto set = [](float to[3], glm::vec3 from) { std::memcpy(to, &from, sizeof from); };
    set(out.sunDirection, look.sunDirection);
    set(out.sunColour, look.sunColor);
    set(out.skyColour, look.skyColor);
    set(out.groundColour, look.groundColor);
    set(out.background, look.background);
    set(out.horizon, look.horizon);
    out.exposure = look.exposure;
    out.shadows = look.shadows;
    out.shadowsLag = look.shadowsLag;
    out.quick = look.quick;
    out.lodPixels = look.lodPixels;
    out.leafPixels = look.leafPixels;
    out.viewOpacity = look.layerOpacity;
    out.groundOvergrows = 1;
    out.gusts = look.gusts;
}

void setDefaults(EspCamera& out) {
    const Camera camera;
    put(out.eye, camera.eye);
    put(out.target, camera.target);
    put(out.up, camera.up);
    out.fovY = camera.fovY;
    out.nearPlane = camera.nearPlane;
}

void setDefaults(EspDrawDef& def) {
    def.width = 1280;
    def.height = 720;
}

namespace {

constexpr uint32_t kMostCharts = 65535;

struct Box {
    glm::vec3 low, high;
};

// Of the town's dense part.
std::vector<Box> houseBoxes(const EspContext& context) {
    std::vector<Box> boxes, dense;
    std::vector<PlanBox> plan;
    for (uint32_t i = 0; i < espHouseCount(&context); ++i)
        if (EspHouseInfo house; espHouseInfo(&context, i, &house) == ESP_OK) {
            boxes.push_back({vec(house.boundsMin), vec(house.boundsMax)});
            plan.push_back({{boxes.back().low.x, boxes.back().low.z}, {boxes.back().high.x, boxes.back().high.z}});
        }
    for (size_t i : densePart(plan)) dense.push_back(boxes[i]);
    return dense;
}

// A camera that shows all surfaces, houses and graphs; its contract is espFrameAll's.
EspCamera frameAll(const EspContext& context) {
    EspCamera camera{};
    setDefaults(camera);
    const GraphDraw* graph = context.renderer->graph();
    const bool graphed = graph && !graph->empty();
    if (context.surfaces.size() == 0 && !context.town && !graphed) return camera;
    const std::vector<Box> houses = houseBoxes(context);
    const auto eachBox = [&](auto&& take) {
        for (const Box& house : houses) take(house.low, house.high);
        context.surfaces.forEach([&](uint32_t, const PlacedSurface& surface) {
            take(vec(surface.info.boundsMin), vec(surface.info.boundsMax));
        });
        if (graphed) {
            glm::vec3 low(1e30f), high(-1e30f);
            graph->bounds(low, high);
            take(low, high);
        }
    };
    glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
    eachBox([&](glm::vec3 from, glm::vec3 to) { low = glm::min(low, from), high = glm::max(high, to); });
    const glm::vec3 size = high - low;
    const float radius = std::max(glm::length(size) * .5f, 1e-4f);
    camera.fovY = .6f;
    // What is flat, such as a town, is seen from further above, over what stands at its rim.
    const float flatness = size.y / std::max({size.x, size.z, 1e-4f});
    const glm::vec3 towards =
        glm::normalize(glm::vec3(.55f, glm::mix(.6f, .2f, glm::smoothstep(.1f, .5f, flatness)), 1));
    const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), towards));
    const glm::vec3 up = glm::cross(towards, right);
    // So far away that every corner is nearly within a frame of 4:3.
    const float tangent = std::tan(camera.fovY * .5f) * .96f;
    const glm::vec3 centre = (low + high) * .5f;
    float distance = radius;
    eachBox([&](glm::vec3 from, glm::vec3 to) {
        for (int i = 0; i < 8; ++i) {
            const glm::vec3 c = glm::mix(from, to, glm::vec3(i & 1, i >> 1 & 1, i >> 2 & 1)) - centre;
            const float across = std::max(std::abs(glm::dot(c, up)), std::abs(glm::dot(c, right)) * .75f);
            distance = std::max(distance, glm::dot(c, towards) + across / tangent);
        }
    });
    const glm::vec3 eye = centre + towards * distance;
    std::memcpy(camera.eye, &eye, sizeof camera.eye);
    std::memcpy(camera.target, &centre, sizeof camera.target);
    camera.nearPlane = std::min(radius * .005f, .1f);  // within a town one stands on its streets
    return camera;
}

// What espDraw is asked for, with all that the def leads to. Not copyable: the def leads to the rest.
struct Wanted {
    EspDrawDef def;
    EspCamera camera{};
    TakenLook shown;
    EspHostScene scene{};

    Wanted(const EspContext& context, const EspDrawDef* given)
        : def(taken("espDraw", given)), shown("espDraw", def.look) {
        camera = def.camera ? taken("espDraw: camera", def.camera) : frameAll(context);
        if (def.scene) {
            scene = taken("espDraw: scene", def.scene);
            def.scene = &scene;
        }
    }
    Wanted(const Wanted&) = delete;
    Wanted& operator=(const Wanted&) = delete;
};

// What the images of a host's scene were made without; null: nothing that is needed.
const char* usageMissing(VkImageUsageFlags colour, VkImageUsageFlags depth) {
    if (!(depth & VK_IMAGE_USAGE_SAMPLED_BIT)) return "depthUsage lacks VK_IMAGE_USAGE_SAMPLED_BIT";
    if (!(depth & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT))
        return "depthUsage lacks VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT";
    if (!(colour & VK_IMAGE_USAGE_SAMPLED_BIT)) return "colourUsage lacks VK_IMAGE_USAGE_SAMPLED_BIT";
    if (!(colour & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT)) return "colourUsage lacks VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT";
    return nullptr;
}

// What doesn't depend on where a frame is drawn.
EspResult checkView(const EspContext* context, const Wanted& wanted) {
    const auto& [def, camera, shown, scene] = wanted;
    const EspLook& look = shown.look;
    if (EspResult bad = checkLook(context, "espDraw", look)) return bad;
    if (def.width < 1 || def.height < 1 || def.width > kMaxFrameSide || def.height > kMaxFrameSide)
        return fail(context, ESP_INVALID_ARGUMENT, "espDraw: a frame is 1 to 16384 pixels wide and high");
    for (const float* v : {camera.eye, camera.target, camera.up})
        if (!finite(v)) return fail(context, ESP_INVALID_ARGUMENT, "espDraw: the camera is not finite");
    if (!std::isfinite(camera.fovY) || !std::isfinite(camera.nearPlane) || !std::isfinite(camera.shift[0]) ||
        !std::isfinite(camera.shift[1]))
        return fail(context, ESP_INVALID_ARGUMENT, "espDraw: the camera is not finite");
    if (!(std::abs(camera.shift[0]) < 100) || !(std::abs(camera.shift[1]) < 100) ||
        !(camera.fovY >= 0.001f && camera.fovY <= 3.1f) || !(camera.nearPlane > 0) ||
        vec(camera.eye) == vec(camera.target))
        return fail(context, ESP_INVALID_ARGUMENT, "espDraw: the camera looks at nothing");
    return ESP_OK;
}

EspResult checkDraw(const EspContext* context, const Wanted& wanted) {
    if (EspResult bad = checkView(context, wanted)) return bad;
    const auto& [def, camera, shown, scene] = wanted;
    const EspLook& look = shown.look;
    if (def.commandBuffer && (!def.colourImage || !def.colourView || !def.frame))
        return fail(context, ESP_INVALID_ARGUMENT,
                    "espDraw: with a command buffer, colourImage, colourView and frame are needed");
    if (def.commandBuffer && !isHostPicture(VkFormat(def.colourFormat)))
        return fail(context, ESP_INVALID_ARGUMENT,
                    "espDraw: colourFormat " + std::to_string(def.colourFormat) +
                        " is none that a frame is drawn into; espalier.h lists them");
    if (def.scene && (!def.commandBuffer || !scene.depthImage || !isDepthFormat(VkFormat(scene.depthFormat)) ||
                      !std::isfinite(scene.depthAtInfinity) || !std::isfinite(scene.depthPerNearness) ||
                      scene.depthPerNearness == 0 || look.view == ESP_VIEW_OVERDRAW))
        return fail(
            context, ESP_INVALID_ARGUMENT,
            "espDraw: a scene needs a command buffer, a depth image of a format with depth, a way from distance "
            "to depth, and no view of overdraw");
    if (const char* missing = def.scene ? usageMissing(def.colourUsage, scene.depthUsage) : nullptr)
        return fail(context, ESP_INVALID_ARGUMENT,
                    std::string("espDraw: the scene's images can't be read and drawn into: ") + missing);
    return def.commandBuffer ? checkFrame(context, "espDraw", def.frame, def.framesDone) : ESP_OK;
}

Camera cameraOf(const EspCamera& camera) {
    return {vec(camera.eye), vec(camera.target), vec(camera.up),
            camera.fovY,     camera.nearPlane,   {camera.shift[0], camera.shift[1]}};
}

EspResult draw(EspContext& context, const Wanted& wanted) {
    if (EspResult bad = checkDraw(&context, wanted)) return bad;
    FrameInputs inputs;
    if (EspResult bad = findInputs(context, "espDraw", wanted.shown.look, wanted.def.scene != nullptr, inputs))
        return bad;
    inputs.camera = cameraOf(wanted.camera);
    const EspDrawDef& def = wanted.def;
    const EspHostScene& scene = wanted.scene;
    DrawTarget target;
    target.width = def.width;
    target.height = def.height;
    if (!def.commandBuffer) {
        Result<Commands> commands = Commands::begin(*context.device, "frame");
        if (!commands) return failGpu(&context, commands.failure());
        context.hasPicture = false;
        Status drawn = context.renderer->draw(*commands, inputs, target);
        if (!drawn) return failGpu(&context, drawn.failure());
        Status finished = commands->finish();
        if (!finished) {
            context.renderer->forget();
            return failGpu(&context, finished.failure());
        }
        context.hasPicture = true;
        context.pictureWidth = def.width;
        context.pictureHeight = def.height;
        return ESP_OK;
    }
    if (def.framesDone) context.device->hostFrameDone(def.framesDone);
    context.device->collect();
    target.image = reinterpret_cast<VkImage>(def.colourImage);
    target.view = reinterpret_cast<VkImageView>(def.colourView);
    target.format = VkFormat(def.colourFormat);
    if (def.scene)
        target.host = {reinterpret_cast<VkImage>(scene.depthImage), VkFormat(scene.depthFormat), scene.depthAtInfinity,
                       scene.depthPerNearness, scene.surfaces != 0};
    // Espalier's image is of the size drawn last, and what a scene is composed in.
    if (def.scene || def.width != context.pictureWidth || def.height != context.pictureHeight)
        context.hasPicture = false;
    Commands commands =
        Commands::into(*context.device, reinterpret_cast<VkCommandBuffer>(def.commandBuffer), def.frame);
    Status drawn = context.renderer->draw(commands, inputs, target);
    return drawn ? ESP_OK : failGpu(&context, drawn.failure());
}

// Draws a small picture as it is wanted, into images that nobody looks at.
EspResult warmUp(EspContext& context, const Wanted& wanted) {
    constexpr uint32_t kSide = 32;
    if (EspResult bad = checkView(&context, wanted)) return bad;
    const EspHostScene& scene = wanted.scene;
    const VkFormat format = VkFormat(wanted.def.colourFormat);
    const bool hosted = wanted.def.scene != nullptr;
    if ((format != VK_FORMAT_UNDEFINED && !isHostPicture(format)) ||
        (hosted && (format == VK_FORMAT_UNDEFINED || !isDepthFormat(VkFormat(scene.depthFormat)))))
        return fail(&context, ESP_INVALID_ARGUMENT, "espWarmUp: frames are drawn into no such formats");
    FrameInputs inputs;
    if (EspResult bad = findInputs(context, "espDraw", wanted.shown.look, wanted.def.scene != nullptr, inputs))
        return bad;
    inputs.camera = cameraOf(wanted.camera);
    DrawTarget target;
    target.width = target.height = kSide;
    ImageDesc desc{.name = "warm-up", .format = format, .width = kSide, .height = kSide};
    desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    Image colour, depth;
    Result<Commands> commands = Commands::begin(*context.device, "warm-up");
    if (!commands) return failGpu(&context, commands.failure());
    if (format != VK_FORMAT_UNDEFINED) {
        if (Status made = assign(colour, Image::create(*context.device, desc)); !made)
            return failGpu(&context, made.failure());
        commands->transition(colour, ImageState::colorTarget, true);
        target.image = colour.handle();
        target.view = colour.view();
        target.format = format;
    }
    if (hosted) {
        desc.format = VkFormat(scene.depthFormat);
        desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
        if (Status made = assign(depth, Image::create(*context.device, desc)); !made)
            return failGpu(&context, made.failure());
        commands->transition(depth, ImageState::depthTarget, true);
        target.host = {depth.handle(), desc.format, 0, inputs.camera.nearPlane, scene.surfaces != 0};
    }
    context.hasPicture = false;
    Status drawn = context.renderer->draw(*commands, inputs, target);
    if (!drawn) return failGpu(&context, drawn.failure());
    if (Status finished = commands->finish(); !finished) {
        context.renderer->forget();
        return failGpu(&context, finished.failure());
    }
    return ESP_OK;
}

EspStats gather(const EspContext& context) {
    const GrowthStats growth = context.growth->stats();
    const RenderStats render = context.renderer->stats();
    EspStats stats{};
    stats.seeds = growth.seeds;
    stats.chunks = growth.chunks;
    stats.branches = growth.branches;
    stats.nodes = growth.nodes;
    stats.leaves = growth.leaves;
    stats.polygons = render.emit.fullTriangles;
    stats.drawnPolygons = render.emit.drawnTriangles;
    stats.drawnLeaves = render.emit.leaves;
    stats.expansions = growth.expansions;
    stats.overflow = growth.overflow + render.emit.overflow;
    stats.enlarged = growth.enlarged;
    stats.cut = growth.overflow;
    stats.stopped = growth.stopped;
    stats.deadEnds = growth.deadEnds;
    stats.validationMessages = context.device->validationMessages();
    stats.expandMs = growth.expandMs;
    stats.emitMs = render.emitMs;
    stats.drawMs = render.drawMs;
    stats.compileMs = context.compileMs;
    stats.nodeBytes = growth.nodeBytes;
    stats.leafBytes = growth.leafBytes;
    stats.chunkBytes = growth.chunkBytes;
    std::set<const SurfaceContent*> contents;
    context.surfaces.forEach([&](uint32_t, const PlacedSurface& s) {
        stats.surfaceBytes += s.gpu.ownBytes();
        if (contents.insert(s.content.get()).second) stats.surfaceBytes += s.gpu.bakedBytes();
    });
    for (const PaintedLayer& layer : context.layers) stats.layerBytes += layer.texels.size();
    stats.totalBytes = context.device->memory().bytesUsed();
    stats.reservedBytes = context.device->memory().bytesReserved();
    stats.hash = growth.hash;
    stats.modelTriangles = render.modelTriangles;
    stats.modelsFading = render.modelsFading;
    stats.shadowsBehind = render.shadowsBehind;
    stats.contacts = context.contactCount;
    stats.contactMs = context.contactMs;
    stats.derivedNodes = growth.derived;
    return stats;
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espDefaultLook(EspLook* out) {
    return giveDefaults("espDefaultLook", out);
}

EspResult espDefaultCamera(EspCamera* out) {
    return giveDefaults("espDefaultCamera", out);
}

EspResult espViewColour(EspView view, float amount, float rgb[3], float* most) {
    return guardedAlone([&] {
        if (!rgb || !most) return failAlone(ESP_INVALID_ARGUMENT, "espViewColour: null pointer");
        if (!std::isfinite(amount)) return failAlone(ESP_INVALID_ARGUMENT, "espViewColour: the amount isn't finite");
        glm::vec3 colour;
        switch (view) {
            case ESP_VIEW_LOD:
                *most = float(kCoarsestLod);
                colour = lodColor(uint32_t(std::clamp(amount, 0.0f, *most)));
                break;
            case ESP_VIEW_CHARTS:
                *most = float(kMostCharts);
                colour = chartColor(uint32_t(std::clamp(amount, 0.0f, *most)));
                break;
            case ESP_VIEW_LAYER:
                *most = 1;
                colour = layerColor(amount);
                break;
            case ESP_VIEW_DEPTH:
            case ESP_VIEW_OVERDRAW:
                *most = view == ESP_VIEW_DEPTH ? kHottestDepth : kHottestOverdraw;
                colour = heatColor(amount / *most);
                break;
            default:
                return failAlone(ESP_INVALID_ARGUMENT, "espViewColour: no legend for this view");
        }
        std::memcpy(rgb, &colour, sizeof colour);
        return ESP_OK;
    });
}

EspResult espDefaultDrawDef(EspDrawDef* out) {
    return giveDefaults("espDefaultDrawDef", out);
}

EspResult espDraw(EspContext* context, const EspDrawDef* def) {
    return guarded(context, [&] { return draw(*context, Wanted(*context, def)); });
}

EspResult espWarmUp(EspContext* context, const EspDrawDef* def) {
    return guarded(context, [&] { return warmUp(*context, Wanted(*context, def)); });
}

EspResult espFramesDone(EspContext* context, uint64_t framesDone) {
    return guarded(context, [&] {
        context->device->hostFrameDone(framesDone);
        return ESP_OK;
    });
}

EspResult espDropFrame(EspContext* context) {
    return guarded(context, [&] {
        context->renderer->forget();
        return ESP_OK;
    });
}

EspResult espReadPixels(EspContext* context, uint8_t* rgba, size_t sizeBytes) {
    return guarded(context, [&] {
        if (!rgba) return fail(context, ESP_INVALID_ARGUMENT, "espReadPixels: null pointer");
        if (!context->hasPicture)
            return fail(context, ESP_INVALID_ARGUMENT,
                        "espReadPixels: nothing was drawn into Espalier's image yet, or another frame took its place");
        const size_t needed = size_t(context->pictureWidth) * context->pictureHeight * 4;
        if (sizeBytes != needed)
            return fail(context, ESP_INVALID_ARGUMENT,
                        "espReadPixels: the picture has " + std::to_string(needed) + " bytes, not " +
                            std::to_string(sizeBytes));
        Result<std::vector<uint8_t>> pixels = context->renderer->readPixels();
        if (!pixels) return failGpu(context, pixels.failure());
        std::memcpy(rgba, pixels->data(), needed);
        return ESP_OK;
    });
}

EspResult espFrameAll(const EspContext* context, EspCamera* out) {
    return guarded(context, [&] {
        give("espFrameAll", out, frameAll(*context));
        return ESP_OK;
    });
}

EspResult espReadStats(EspContext* context, EspStats* out) {
    return guarded(context, [&] {
        context->device->collect();
        give("espReadStats", out, gather(*context));
        return ESP_OK;
    });
}

EspResult espMaterialise(EspContext* context, EspTriangles* out) {
    return guarded(context, [&] {
        EspTriangles made{};
        give("espMaterialise", out, made);
        Status tables = context->refreshTables();
        if (!tables) return failGpu(context, tables.failure());
        EmitInputs inputs;
        inputs.growth = context->growth->view();
        inputs.surfaces = addressOf<SurfaceBuf>(context->surfaceTable);
        const std::vector<Version> placed = context->carriersPlaced();
        inputs.placed = placed;
        context->dropTriangles();
        if (inputs.growth.nodeCount > 0) {
            Result<EmittedTriangles> triangles = context->renderer->materialise(inputs);
            if (!triangles) return failGpu(context, triangles.failure());
            auto vertices =
                readBuffer(*context->device, triangles->vertices, 0, triangles->vertexCount * sizeof(TriangleVertex));
            if (!vertices) return failGpu(context, vertices.failure());
            auto indices =
                readBuffer(*context->device, triangles->indices, 0, triangles->indexCount * sizeof(uint32_t));
            if (!indices) return failGpu(context, indices.failure());
            context->vertices = std::move(*vertices);
            context->indices = std::move(*indices);
            made.ms = triangles->milliseconds;
        }
        if (EspResult bad = materialiseTown(*context, context->vertices, context->indices)) return bad;
        if (!context->indices.empty()) {
            made.vertices = context->vertices.data();
            made.vertexCount = context->vertices.size() / sizeof(TriangleVertex);
            made.indices = reinterpret_cast<const uint32_t*>(context->indices.data());
            made.indexCount = context->indices.size() / sizeof(uint32_t);
        }
        give("espMaterialise", out, made);
        return ESP_OK;
    });
}

}  // extern "C"
