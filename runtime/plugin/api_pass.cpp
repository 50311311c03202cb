// Drawing within a host's pass.
#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "runtime/gpu/commands.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/frame_inputs.hpp"
#include "runtime/plugin/given.hpp"

namespace espalier {

void setDefaults(EspPassFormat& format) {
    format.samples = 1;
    format.output = ESP_OUTPUT_ENCODED;
}

void setDefaults(EspPassDef& def) {
    def.viewport[2] = 1280;
    def.viewport[3] = 720;
    for (int i = 0; i < 4; ++i) def.view[5 * i] = def.projection[5 * i] = 1;
    def.focus = 20;
}

namespace {

constexpr uint32_t kMostColours = 8;
constexpr float kRigid = 1e-3f;  // by how much a view may scale or shear

EspResult takeFormat(const EspContext* context, const EspPassFormat* given, PassFormat& out) {
    const EspPassFormat format = taken("espPrepare: format", given);
    const auto refuse = [&](const std::string& why) {
        return fail(context, ESP_INVALID_ARGUMENT, "espPrepare: format: " + why);
    };
    if (format.colourCount > kMostColours || (format.colourCount > 0 && !format.colourFormats))
        return refuse("colourCount is 0 to 8, with as many colourFormats");
    if (!isDepthFormat(VkFormat(format.depthFormat)))
        return refuse("depthFormat " + std::to_string(format.depthFormat) + " holds no depths");
    if (format.samples != 1 && format.samples != 2 && format.samples != 4 && format.samples != 8)
        return refuse("samples are 1, 2, 4 or 8, not " + std::to_string(format.samples));
    if (!isAmong(format.output, ESP_OUTPUT_ENCODED, ESP_OUTPUT_LIGHT)) return refuse("no such output");
    if (!std::isfinite(format.depthBias) || !std::isfinite(format.depthBiasSlope))
        return refuse("the depth bias is not finite");
    for (uint32_t i = 0; i < format.colourCount; ++i) out.colors.push_back(VkFormat(format.colourFormats[i]));
    if (!out.colors.empty() && (out.colors[0] == VK_FORMAT_UNDEFINED || isDepthFormat(out.colors[0])))
        return refuse("the first colour format, " + std::to_string(out.colors[0]) + ", holds no colours");
    out.depth = VkFormat(format.depthFormat);
    out.stencil = VkFormat(format.stencilFormat);
    out.samples = format.samples;
    out.reversed = format.depthReversed != 0;
    static_assert(ESP_OUTPUT_ENCODED == int(kOutputEncoded) && ESP_OUTPUT_LINEAR == int(kOutputLinear) &&
                  ESP_OUTPUT_LIGHT == int(kOutputLight));
    out.output = uint32_t(format.output);
    out.biasConstant = format.depthBias;
    out.biasSlope = format.depthBiasSlope;
    out.renderPass = reinterpret_cast<VkRenderPass>(format.renderPass);
    out.subpass = format.subpass;
    return ESP_OK;
}

// Why a view can't be drawn; null: it can.
const char* mistakeIn(const EspPassDef& def) {
    const auto all = [](const float* numbers, int count) {
        return std::all_of(numbers, numbers + count, [](float v) { return std::isfinite(v); });
    };
    if (!all(def.viewport, 4) || !all(def.view, 16) || !all(def.projection, 16) || !std::isfinite(def.focus))
        return "a number is not finite";
    const float height = std::abs(def.viewport[3]);
    if (!(def.viewport[2] >= 1 && def.viewport[2] <= kMaxFrameSide && height >= 1 && height <= kMaxFrameSide) ||
        def.viewport[0] < 0 || std::min(def.viewport[1], def.viewport[1] + def.viewport[3]) < 0)
        return "a viewport is 1 to 16384 pixels wide and high, and begins within the picture";
    if (!(def.focus > 0)) return "focus is more than 0";
    const glm::mat4 view = glm::make_mat4(def.view), projection = glm::make_mat4(def.projection);
    const glm::mat3 turn(view), squares = glm::transpose(turn) * turn - glm::mat3(1);
    for (int i = 0; i < 9; ++i)
        if (std::abs(squares[i / 3][i % 3]) > kRigid) return "the view scales or shears";
    if (view[0][3] != 0 || view[1][3] != 0 || view[2][3] != 0 || view[3][3] != 1)
        return "the view's last row isn't 0 0 0 1";
    if (projection[0][3] != 0 || projection[1][3] != 0 || (projection[2][3] != 0) == (projection[3][3] != 0) ||
        projection[0][0] * projection[1][1] == projection[0][1] * projection[1][0])
        return "the projection is neither of a perspective nor parallel";
    return nullptr;
}

EspResult takeView(const EspContext* context, const EspPassDef& def, PassView& out) {
    if (const char* mistake = mistakeIn(def))
        return fail(context, ESP_INVALID_ARGUMENT, std::string("espPrepare: ") + mistake);
    if (EspResult bad = takeFormat(context, def.format, out.format)) return bad;
    out.viewport = {def.viewport[0], def.viewport[1], def.viewport[2], def.viewport[3], 0, 1};
    out.view = glm::make_mat4(def.view);
    out.projection = glm::make_mat4(def.projection);
    out.focus = def.focus;
    out.models = def.surfaces != 0;
    return ESP_OK;
}

EspResult prepare(EspContext& context, const EspPassDef& def) {
    PassView pass;
    if (EspResult bad = takeView(&context, def, pass)) return bad;
    const TakenLook shown("espPrepare", def.look);
    const EspLook& look = shown.look;
    if (EspResult bad = checkLook(&context, "espPrepare", look)) return bad;
    if (look.view == ESP_VIEW_OVERDRAW)
        return fail(&context, ESP_INVALID_ARGUMENT, "espPrepare: there is no view of overdraw within a host's pass");
    if (!def.commandBuffer || !def.frame)
        return fail(&context, ESP_INVALID_ARGUMENT, "espPrepare: commandBuffer and frame are needed");
    if (EspResult bad = checkFrame(&context, "espPrepare", def.frame, def.framesDone)) return bad;
    FrameInputs inputs;
    if (EspResult bad = findInputs(context, "espPrepare", look, true, inputs)) return bad;
    if (def.framesDone) context.device->hostFrameDone(def.framesDone);
    context.device->collect();
    Commands commands =
        Commands::into(*context.device, reinterpret_cast<VkCommandBuffer>(def.commandBuffer), def.frame);
    context.preparedFrame = def.frame;
    if (Status prepared = context.renderer->prepare(commands, inputs, pass); !prepared) {
        context.renderer->forget();
        return failGpu(&context, prepared.failure());
    }
    return ESP_OK;
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espDefaultPassFormat(EspPassFormat* out) {
    return giveDefaults("espDefaultPassFormat", out);
}

EspResult espDefaultPassDef(EspPassDef* out) {
    return giveDefaults("espDefaultPassDef", out);
}

EspResult espPrepare(EspContext* context, const EspPassDef* def) {
    return guarded(context, [&] { return prepare(*context, taken("espPrepare", def)); });
}

EspResult espRecord(EspContext* context, void* commandBuffer) {
    return guarded(context, [&] {
        if (!commandBuffer) return fail(context, ESP_INVALID_ARGUMENT, "espRecord: null pointer");
        if (!context->renderer->prepared())
            return fail(context, ESP_INVALID_ARGUMENT, "espRecord: nothing has been prepared");
        Commands inside = Commands::into(*context->device, reinterpret_cast<VkCommandBuffer>(commandBuffer),
                                         context->preparedFrame, true);
        context->renderer->record(inside);
        return ESP_OK;
    });
}

}  // extern "C"
