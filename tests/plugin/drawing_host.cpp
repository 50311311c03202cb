#include "tests/plugin/drawing_host.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/made_as_required.hpp"

namespace espalier {
namespace {

struct BoxPush {
    glm::mat4 viewProjection;
    glm::vec3 low, high, tint;
};

template <class T>
T must(Result<T> made) {
    REQUIRE_MESSAGE(made, (made ? "" : made.failure().text()));
    return std::move(*made);
}

glm::vec3 vec(const float v[3]) {
    return {v[0], v[1], v[2]};
}

glm::mat4 viewProjection(const EspCamera& camera, bool reversed) {
    const float aspect = float(DrawingHost::kWidth) / DrawingHost::kHeight;
    glm::mat4 projection = glm::perspectiveRH_ZO(camera.fovY, aspect, DrawingHost::kNear, DrawingHost::kFar);
    if (reversed) {
        projection[2][2] = 0;
        projection[3][2] = DrawingHost::kNear;
    }
    projection[1][1] *= -1;  // Vulkan's y goes down
    return projection * glm::lookAtRH(vec(camera.eye), vec(camera.target), vec(camera.up));
}

}  // namespace

bool DrawingHost::Picture::sameColour(const Picture& other, size_t pixel) const {
    return std::memcmp(&rgba[4 * pixel], &other.rgba[4 * pixel], 4) == 0;
}

DrawingHost::DrawingHost() {
    DeviceOptions options;
    options.validation = true;
    device_ = must(Device::create(options));
    use(colour_, depth_);
}

DrawingHost::~DrawingHost() {
    for (const std::string& text : device_->validationTexts()) MESSAGE(text);
    CHECK(device_->validationMessages() == 0);
}

EspHostDevice DrawingHost::device() const {
    return hostDeviceOf(*device_);
}

bool DrawingHost::has(VkFormat format) const {
    VkFormatProperties properties{};
    const auto ask = reinterpret_cast<PFN_vkGetPhysicalDeviceFormatProperties>(
        device_->getInstanceProcAddr()(device_->instance(), "vkGetPhysicalDeviceFormatProperties"));
    ask(device_->physicalDevice(), format, &properties);
    const VkFormatFeatureFlags wanted =
        VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
    return (properties.optimalTilingFeatures & wanted) == wanted;
}

void DrawingHost::use(VkFormat colour, const Depth& depth, uint32_t times) {
    colour_ = colour;
    depth_ = depth;
    width_ = times * kWidth;
    height_ = times * kHeight;
    makeImages();
    GraphicsDesc desc;
    desc.name = "host's box";
    desc.vertex = "tests/box.vert";
    desc.fragment = "tests/triangle.frag";
    desc.colors = {colour};
    desc.depth = depth.format;
    desc.depthCompare = depth.reversed ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS;
    box_ = must(Program::graphics(*device_, desc));
}

void DrawingHost::makeImages() {
    ImageDesc desc{.name = "host's picture", .format = colour_, .width = width_, .height = height_};
    desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    picture_ = must(Image::create(*device_, desc));
    desc.name = "host's depth buffer";
    desc.format = depth_.format;
    desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    nearest_ = must(Image::create(*device_, desc));
}

EspHostScene DrawingHost::scene() const {
    EspHostScene scene{};
    scene.depthImage = nearest_.handle();
    scene.depthFormat = depth_.format;
    scene.depthUsage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    scene.depthAtInfinity = depth_.reversed ? 0 : kFar / (kFar - kNear);
    scene.depthPerNearness = depth_.reversed ? kNear : -kNear * kFar / (kFar - kNear);
    return scene;
}

double DrawingHost::distance(float depth) const {
    return depth_.reversed ? double(kNear) / depth : double(kNear) * kFar / (kFar - double(depth) * (kFar - kNear));
}

esp::DrawDef DrawingHost::def(const EspCamera& camera, const Commands& commands) const {
    esp::DrawDef def;
    def.width = width_;
    def.height = height_;
    def.camera = camera;
    def.commandBuffer = commands.handle();
    def.colourImage = picture_.handle();
    def.colourView = picture_.view();
    def.colourFormat = colour_;
    def.colourUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    def.frame = frame_;
    def.framesDone = frame_ - 1;
    return def;
}

DrawingHost::Picture DrawingHost::draw(const EspCamera& camera, const std::vector<Box>& boxes, EspContext* context,
                                       bool surfaces) {
    Commands commands = must(Commands::begin(*device_, "host's frame"));
    commands.transition(picture_, ImageState::colorTarget, true);
    commands.transition(nearest_, ImageState::depthTarget, true);
    {
        DrawTargets targets;
        targets.extent = {width_, height_};
        targets.colors.push_back({.view = picture_.view(), .clear = std::array<float, 4>{.2f, .3f, .5f, 1}});
        targets.depth = DepthTarget{.view = nearest_.view(), .clear = depth_.reversed ? 0.0f : 1.0f};
        DrawPass pass(commands, "host", targets);
        for (const Box& box : boxes)
            pass.draw(box_, 36, 1, BoxPush{viewProjection(camera, depth_.reversed), box.low, box.high, box.tint});
    }
    if (context) {
        ++frame_;
        EspHostScene own = scene();
        own.surfaces = surfaces;
        esp::DrawDef drawn = def(camera, commands);
        drawn.scene = &own;
        const EspResult result = espDraw(context, &drawn);
        REQUIRE_MESSAGE(result == ESP_OK, espLastError(context));
    }
    REQUIRE(commands.finish());
    return read();
}

void DrawingHost::recordInVain(const EspCamera& camera, EspContext* context) {
    makeImages();
    Commands commands = must(Commands::begin(*device_, "host's frame"));
    ++frame_;
    const esp::DrawDef drawn = def(camera, commands);
    const EspResult result = espDraw(context, &drawn);
    REQUIRE_MESSAGE(result == ESP_OK, espLastError(context));
}

std::vector<Image> DrawingHost::submit(const std::vector<EspCamera>& cameras, EspContext* context) {
    std::vector<Image> images;
    std::vector<Commands> recorded;
    const uint64_t before = frame_;
    for (const EspCamera& camera : cameras) {
        makeImages();
        recorded.push_back(must(Commands::begin(*device_, "host's frame")));
        ++frame_;
        esp::DrawDef drawn = def(camera, recorded.back());
        drawn.framesDone = before;
        const EspResult result = espDraw(context, &drawn);
        REQUIRE_MESSAGE(result == ESP_OK, espLastError(context));
        images.push_back(std::move(picture_));
    }
    for (Commands& commands : recorded) REQUIRE(commands.submit());
    return images;
}

std::vector<DrawingHost::Picture> DrawingHost::drawAtOnce(const std::vector<EspCamera>& cameras, EspContext* context) {
    std::vector<Picture> pictures;
    for (Image& image : submit(cameras, context)) {
        picture_ = std::move(image);
        pictures.push_back(read());
    }
    return pictures;
}

namespace {

// sRGB, whatever the picture's format.
std::vector<uint8_t> inEightBits(const std::vector<std::byte>& bytes, VkFormat format, size_t pixels) {
    std::vector<uint8_t> rgba(pixels * 4);
    if (format == VK_FORMAT_R16G16B16A16_SFLOAT) {
        for (size_t i = 0; i < rgba.size(); ++i) {
            uint16_t half;
            std::memcpy(&half, &bytes[2 * i], 2);
            const float v = std::clamp(glm::unpackHalf1x16(half), 0.f, 1.f);
            const float encoded = v <= .0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - .055f;
            rgba[i] = uint8_t(255 * (i % 4 == 3 ? v : encoded) + .5f);
        }
    } else if (format == VK_FORMAT_A2B10G10R10_UNORM_PACK32) {
        for (size_t i = 0; i < rgba.size() / 4; ++i) {
            uint32_t word;
            std::memcpy(&word, &bytes[4 * i], 4);
            for (size_t k = 0; k < 3; ++k) rgba[4 * i + k] = uint8_t(float(word >> 10 * k & 1023u) * 255 / 1023 + .5f);
            rgba[4 * i + 3] = uint8_t((word >> 30) * 85);
        }
    } else {
        REQUIRE(bytes.size() == rgba.size());
        std::memcpy(rgba.data(), bytes.data(), bytes.size());
    }
    return rgba;
}

}  // namespace

DrawingHost::Picture DrawingHost::read() {
    picture_.state = ImageState::colorTarget;
    Picture picture;
    const std::vector<std::byte> bytes = must(readImage(*device_, picture_));
    picture.rgba = inEightBits(bytes, colour_, size_t(width_) * height_);
    const bool legible = depth_.format == VK_FORMAT_D32_SFLOAT || depth_.format == VK_FORMAT_D16_UNORM;
    if (!legible || nearest_.state != ImageState::depthTarget) return picture;
    const std::vector<std::byte> depths = must(readImage(*device_, nearest_));
    picture.depth.resize(size_t(width_) * height_);
    for (size_t i = 0; i < picture.depth.size(); ++i)
        if (depth_.format == VK_FORMAT_D16_UNORM) {
            uint16_t depth;
            std::memcpy(&depth, &depths[2 * i], 2);
            picture.depth[i] = float(depth) / 65535;
        } else {
            std::memcpy(&picture.depth[i], &depths[4 * i], 4);
        }
    return picture;
}

}  // namespace espalier
