// Enters: camera, look, sun. Leaves: matrices and the record that all drawing shaders read.
#include "runtime/render/frame.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/render/targets.hpp"

namespace espalier {
namespace {

// The shaders' names for what hosts ask for.
static_assert(uint32_t(ViewMode::shaded) == kViewShaded && uint32_t(ViewMode::charts) == kViewCharts &&
              uint32_t(ViewMode::normals) == kViewNormals && uint32_t(ViewMode::lod) == kViewLod &&
              uint32_t(ViewMode::layer) == kViewLayer && uint32_t(ViewMode::depth) == kViewDepth &&
              uint32_t(ViewMode::overdraw) == kViewOverdraw);

glm::vec3 unitOr(glm::vec3 v, glm::vec3 other) {
    const float length = glm::length(v);
    return std::isfinite(length) && length > 1e-12f ? v / length : other;
}

// Right, up and backward as rows; `up` may be along the view.
glm::mat4 viewMatrix(glm::vec3 eye, glm::vec3 forward, glm::vec3 up, glm::vec3& right, glm::vec3& trueUp) {
    if (glm::length(glm::cross(forward, up)) < 1e-4f)
        up = std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
    right = glm::normalize(glm::cross(forward, up));
    trueUp = glm::cross(right, forward);
    glm::mat4 m(1);
    for (int c = 0; c < 3; ++c) {
        m[c][0] = right[c];
        m[c][1] = trueUp[c];
        m[c][2] = -forward[c];
    }
    m[3] = glm::vec4(-glm::dot(right, eye), -glm::dot(trueUp, eye), glm::dot(forward, eye), 1);
    return m;
}

// Both the sky and what else lights are that dim.
float nightOf(const Look& look) {
    constexpr glm::vec3 kWeights(0.3f, 0.6f, 0.1f);
    const float sky = glm::dot(look.skyColor, kWeights), sun = glm::dot(look.sunColor, kWeights);
    return std::clamp((0.48f - sky) * 4, 0.0f, 1.0f) * std::clamp((1.0f - sun) * 3, 0.0f, 1.0f);
}

// Pictures that lie fractions of a pixel apart look for shadows in other places, so that their mean has soft ones.
// from: FrameRecord::ditherFrom.
glm::vec2 shadowTap(glm::vec2 from) {
    constexpr glm::vec2 kFirst(1, 0.4f);
    if (from == glm::vec2(0)) return kFirst;
    const float at = glm::fract(glm::dot(from, glm::vec2(0.618034f, 0.754878f)));
    const float angle = at * 2 * std::numbers::pi_v<float>, wide = 0.5f + 1.1f * glm::fract(at * 7.31f);
    const float c = std::cos(angle) * wide, s = std::sin(angle) * wide;
    return {kFirst.x * c - kFirst.y * s, kFirst.x * s + kFirst.y * c};
}

// All turns at rates of their own, so that a wind that rises or falls makes nothing jump.
void blow(const Look& look, FrameRecord& frame) {
    constexpr double kRates[3] = {0.31, 1.3, 4.1};             // of gusts, leaning and fluttering, turns a second
    constexpr float kBendPerSpeed = 0.06f, kMostBend = 0.75f;  // of a leaf's length; by metres a second
    frame.wind = unitOr(look.wind, {1, 0, 0});
    frame.windBend = std::min(kBendPerSpeed * glm::length(look.wind), kMostBend);
    frame.windGusts = std::clamp(look.gusts, 0.0f, 1.0f);
    for (int i = 0; i < 3; ++i)
        frame.windTurns[i] = float(std::fmod(look.clock * kRates[i], 1.0) * 2 * std::numbers::pi);
}

}  // namespace

ViewMode shownView(const DrawInputs& inputs) {
    const ViewMode view = inputs.look.view;
    const bool layer = view == ViewMode::layer, surface = layer || view == ViewMode::charts;
    return (surface && !inputs.surfaces.v) || (layer && !inputs.layers.v) ? ViewMode::normals : view;
}

FrameRecord makeFrame(const DrawInputs& inputs, uint32_t width, uint32_t height) {
    const Camera& camera = inputs.camera;
    const Look& look = inputs.look;
    const glm::vec3 forward = unitOr(camera.target - camera.eye, {0, 0, -1});
    const float tangent = std::tan(camera.fovY * 0.5f);
    const float aspect = float(width) / float(height);
    glm::vec3 right, up;
    const glm::mat4 view = viewMatrix(camera.eye, forward, unitOr(camera.up, {0, 1, 0}), right, up);
    // Vulkan's clip space: y down; depth near / distance.
    glm::mat4 projection(0);
    projection[0][0] = 1 / (tangent * aspect);
    projection[1][1] = -1 / tangent;
    projection[2][3] = -1;
    projection[2][0] = -camera.shift.x;
    projection[2][1] = camera.shift.y;
    projection[3][2] = std::max(camera.nearPlane, kLeastNearPlane);

    FrameRecord frame{};
    frame.viewProjection = projection * view;
    frame.eye = camera.eye;
    frame.nearPlane = projection[3][2];
    frame.sunDirection = unitOr(look.sunDirection, {0, 1, 0});
    frame.sunColor = look.sunColor;
    frame.exposure = std::exp2(std::clamp(look.exposure, -20.0f, 20.0f));
    frame.skyColor = look.skyColor;
    frame.view = uint32_t(shownView(inputs));
    frame.groundColor = look.groundColor;
    frame.layer = look.view == ViewMode::charts ? look.level : look.layer;
    frame.layerOpacity = std::clamp(look.layerOpacity, 0.0f, 1.0f);
    frame.limits = look.limits;
    frame.background = look.background;
    frame.shadows = look.shadows ? 1 : 0;
    frame.horizon = look.horizon;
    frame.groundLevel = inputs.ground.kind != GroundKind::none ? inputs.ground.height : kNoGround;
    frame.grassColor = inputs.ground.colour;
    frame.rayRight = right * (tangent * aspect);
    frame.rayUp = up * tangent;
    frame.rayForward = forward - camera.shift.x * frame.rayRight - camera.shift.y * frame.rayUp;
    frame.pixelScale = float(height) / (2 * tangent);
    frame.night = nightOf(look);
    frame.ditherFrom = glm::mod(glm::round(camera.shift * 32.0f * glm::vec2(width, height)), 64.0f);
    frame.shadowTap = shadowTap(frame.ditherFrom);
    blow(look, frame);
    frame.unit = 1;
    frame.surfaces = inputs.surfaces;
    frame.layers = inputs.layers;
    return frame;
}

// Sines of leaf_vertex.glsl repeat after ten turns: of 0.6, 0.8, 1.1 and 1.3 of a turn these make whole ones.
void anchorLook(FrameRecord& frame, const glm::dvec3& origin) {
    constexpr double kTurn = 6.283185307179586;
    const glm::dvec3 place = origin / double(frame.unit);
    const auto rest = [](double turns, double period) { return float(std::fmod(turns, period)); };
    for (int k = 0; k < 3; ++k) frame.tonesFrom[k] = rest(place[k] * double(kTonesPerUnit), 10 * kTurn);
    frame.windTurns.x -= rest(glm::dot(place, glm::dvec3(frame.wind)) * double(kGustTurns), kTurn);
    frame.gustsFrom = rest(glm::dot(place, glm::dvec3(ESPALIER_GUST_PHASE)), kTurn);
}

ViewShape::ViewShape(const PassView& pass) {
    const glm::mat4& p = pass.projection;
    const glm::mat4 back = glm::inverse(pass.view);
    parallel = p[2][3] == 0;
    // Eye space may go either way along its z.
    const bool along = parallel ? (p[2][2] > 0) != pass.format.reversed : p[2][3] > 0;
    const float unit = std::abs(parallel ? p[3][3] : p[2][3]);
    pixelScale = std::abs(pass.viewport.height) * 0.5f * glm::length(glm::vec2(p[0][1], p[1][1])) / unit;
    const float turn = glm::determinant(glm::mat3(pass.view)) * (p[0][0] * p[1][1] - p[0][1] * p[1][0]);
    mirrored = (turn > 0) == ((pass.viewport.height > 0) != along);
    camera.eye = glm::vec3(back[3]);
    camera.target = camera.eye + glm::vec3(back[2]) * (along ? pass.focus : -pass.focus);
    camera.up = glm::vec3(back[1]);
    camera.nearPlane = kLeastNearPlane;
    culling = p * pass.view;
    for (int c = 0; c < 4; ++c) culling[c][2] = 0;
    culling[3][2] = parallel ? 0 : kLeastNearPlane * unit;
}

FrameRecord makeFrame(const DrawInputs& inputs, const PassView& pass, const ViewShape& shape) {
    constexpr float kFarAway = 1e6f;  // metres
    FrameRecord frame =
        makeFrame(inputs, uint32_t(pass.viewport.width), uint32_t(std::max(std::abs(pass.viewport.height), 1.0f)));
    frame.viewProjection = pass.projection * pass.view;
    frame.pixelScale = shape.pixelScale;
    if (!shape.parallel) return frame;
    frame.eye += glm::normalize(shape.camera.eye - shape.camera.target) * kFarAway;
    frame.pixelScale *= kFarAway;
    return frame;
}

SunView makeSunView(glm::vec3 sunDirection, glm::vec3 center, float radius, float towards) {
    glm::vec3 right, up;
    const glm::vec3 forward = -unitOr(sunDirection, {0, 1, 0});
    towards = std::max(towards, radius);
    glm::mat4 view = viewMatrix(center - forward * towards, forward, {0, 1, 0}, right, up);
    const float texel = 2 * radius / kShadowSize;
    for (int i : {0, 1}) view[3][i] = std::round(view[3][i] / texel) * texel;
    glm::mat4 projection(1);
    projection[0][0] = 1 / radius;
    projection[1][1] = -1 / radius;
    projection[2][2] = -1 / (towards + radius);
    SunView sun;
    sun.toClip = projection * view;
    glm::mat4 toTexture(1);
    toTexture[0][0] = toTexture[1][1] = 0.5f;
    toTexture[3] = glm::vec4(0.5f, 0.5f, 0, 1);
    sun.toTexture = toTexture * sun.toClip;
    sun.width = 2 * radius;
    sun.depth = towards + radius;
    return sun;
}

}  // namespace espalier
