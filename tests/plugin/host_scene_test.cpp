// Growth drawn into a picture and depth buffer that a host has begun.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/drawing_host.hpp"
#include "tests/plugin/grown_square.hpp"

using namespace espalier;

namespace {

using Picture = DrawingHost::Picture;
using Grown = GrownSquare;
constexpr uint32_t kWidth = DrawingHost::kWidth, kHeight = DrawingHost::kHeight;
constexpr size_t kPixels = size_t(kWidth) * kHeight;

// The host's device under the name of one that isn't software, on which more samples are drawn and no native code runs.
PFN_vkGetInstanceProcAddr realFunction;
PFN_vkGetPhysicalDeviceProperties2 realProperties;
VKAPI_ATTR void VKAPI_CALL asDiscrete(VkPhysicalDevice device, VkPhysicalDeviceProperties2* all) {
    realProperties(device, all);
    all->properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
}
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL functionOfDiscrete(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction real = realFunction(instance, name);
    if (std::string(name) != "vkGetPhysicalDeviceProperties2") return real;
    realProperties = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(&asDiscrete);
}
EspHostDevice discrete(const DrawingHost& host) {
    EspHostDevice device = host.device();
    realFunction = reinterpret_cast<PFN_vkGetInstanceProcAddr>(device.getInstanceProcAddr);
    device.getInstanceProcAddr = reinterpret_cast<void*>(&functionOfDiscrete);
    return device;
}

EspCamera cameraAt(float x, float y, float z) {
    EspCamera camera = esp::defaults<EspCamera>();
    const float eye[3] = {x, y, z}, target[3] = {.5f, .5f, 0};
    std::copy(eye, eye + 3, camera.eye);
    std::copy(target, target + 3, camera.target);
    camera.nearPlane = .02f;  // need not be the host's
    return camera;
}

// A wall under the square, a box in front of the growth and one that runs through it.
const std::vector<DrawingHost::Box> kBoxes = {{{0, 0, -.2f}, {1, 1, -.004f}, {.5f, .45f, .4f}},
                                              {{.55f, .1f, .2f}, {.8f, .5f, .4f}, {.7f, .2f, .1f}},
                                              {{.15f, .45f, -.1f}, {.4f, .7f, .06f}, {.2f, .3f, .7f}}};

// The gallery's picture, where ESPALIER_PICTURES names a folder for it.
void picture(DrawingHost& host, Grown& grown) {
    const char* folder = std::getenv("ESPALIER_PICTURES");
    if (!folder) return;
    constexpr uint32_t kTimes = 3;
    host.use(VK_FORMAT_R8G8B8A8_UNORM, {}, kTimes);
    const Picture drawn = host.draw(cameraAt(1.3f, .9f, 1.9f), kBoxes, grown.context);
    std::FILE* file = std::fopen((std::string(folder) + "/host.ppm").c_str(), "wb");
    REQUIRE(file);
    std::fprintf(file, "P6 %u %u 255\n", kTimes * kWidth, kTimes * kHeight);
    for (size_t i = 0; i < drawn.rgba.size(); i += 4) std::fwrite(&drawn.rgba[i], 1, 3, file);
    std::fclose(file);
}

// Whether a pixel or one within reach of it is among those marked.
bool near(const std::vector<bool>& marked, size_t pixel, int reach = 1) {
    const int x = int(pixel % kWidth), y = int(pixel / kWidth);
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, int(kHeight) - 1); ++v)
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, int(kWidth) - 1); ++u)
            if (marked[size_t(v) * kWidth + size_t(u)]) return true;
    return false;
}

// Growth and a host's boxes hide each other as their depths say.
void hideEachOther(DrawingHost& host, Grown& grown) {
    const struct {
        const char* name;
        DrawingHost::Depth depth;
        double tolerance;  // of distances at some metres, in metres
    } cases[] = {{"reversed", {VK_FORMAT_D32_SFLOAT, true}, 1e-5},
                 {"forward", {VK_FORMAT_D32_SFLOAT, false}, 1e-4},
                 {"forward16", {VK_FORMAT_D16_UNORM, false}, 3e-3}};
    for (const auto& c : cases) {
        CAPTURE(c.name);
        host.use(VK_FORMAT_R8G8B8A8_UNORM, c.depth);
        const EspCamera camera = cameraAt(1.3f, .9f, 1.9f);
        const Picture boxes = host.draw(camera, kBoxes, nullptr);
        const Picture growth = host.draw(camera, {}, grown.context);
        const Picture both = host.draw(camera, kBoxes, grown.context);

        std::vector<bool> shown(kPixels);  // pixels in which growth is to be seen
        size_t front = 0, behind = 0;
        for (size_t i = 0; i < kPixels; ++i) {
            const double hostAt = host.distance(boxes.depth[i]), growthAt = host.distance(growth.depth[i]);
            const bool grows = growth.depth[i] != (c.depth.reversed ? 0.0f : 1.0f);
            const bool unclear = grows && std::abs(growthAt - hostAt) < c.tolerance;
            shown[i] = grows && (unclear || growthAt < hostAt);
            if (unclear) continue;
            front += grows && growthAt < hostAt;
            behind += grows && growthAt > hostAt;
            if (shown[i])
                CHECK(host.distance(both.depth[i]) == doctest::Approx(growthAt).epsilon(1e-6 + c.tolerance));
            else
                CHECK(both.depth[i] == boxes.depth[i]);
        }
        size_t changed = 0, touched = 0;
        for (size_t i = 0; i < kPixels; ++i) {
            if (!near(shown, i)) touched += !both.sameColour(boxes, i);
            if (shown[i]) changed += !both.sameColour(boxes, i);
        }
        CHECK(touched == 0);
        CHECK(front > 1500);
        CHECK(behind > 800);
        CHECK(changed > front * 9 / 10);
    }
}

// Depths that the host reads are where a ray meets the surface.
void depthsAreWhereRaysHit(DrawingHost& host, Grown& grown) {
    for (const bool reversed : {true, false}) {
        host.use(VK_FORMAT_R8G8B8A8_UNORM, {VK_FORMAT_D32_SFLOAT, reversed});
        const EspCamera camera = cameraAt(1.3f, .9f, 1.9f);
        const Picture growth = host.draw(camera, {}, grown.context), all = host.draw(camera, {}, grown.context, true);
        const glm::vec3 eye(1.3f, .9f, 1.9f), forward = glm::normalize(glm::vec3(.5f, .5f, 0) - eye);
        const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0))),
                        up = glm::cross(right, forward);
        const float tangent = std::tan(camera.fovY / 2);
        size_t judged = 0;
        for (uint32_t y = 3; y < kHeight; y += 5)
            for (uint32_t x = 3; x < kWidth; x += 5) {
                const size_t pixel = size_t(y) * kWidth + x;
                if (growth.depth[pixel] != (reversed ? 0.0f : 1.0f)) continue;  // something grows there
                const glm::vec2 at((float(x) + .5f) / kWidth * 2 - 1, (float(y) + .5f) / kHeight * 2 - 1);
                const glm::vec3 ray = forward + right * (at.x * tangent * kWidth / kHeight) - up * (at.y * tangent);
                EspHit hit{};
                if (espPick(grown.context, &eye.x, &ray.x, &hit) != ESP_OK) continue;
                const float along =
                    glm::dot(glm::vec3(hit.position[0], hit.position[1], hit.position[2]) - eye, forward);
                CHECK(host.distance(all.depth[pixel]) == doctest::Approx(along).epsilon(1e-4));
                ++judged;
            }
        CHECK(judged > 100);
    }
}

// Any picture and depth buffer with a stencil will do.
void otherFormats(DrawingHost& host, Grown& grown) {
    host.use(VK_FORMAT_R8G8B8A8_UNORM, {});
    const EspCamera camera = cameraAt(1.3f, .9f, 1.9f);
    const Picture bare = host.draw(camera, kBoxes, nullptr), plain = host.draw(camera, kBoxes, grown.context);
    std::vector<bool> other(kPixels);  // in which no growth is
    for (size_t i = 0; i < kPixels; ++i) other[i] = plain.depth[i] == bare.depth[i];
    const struct {
        VkFormat depth, colour;
    } cases[] = {{VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_R8G8B8A8_UNORM},
                 {VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_R8G8B8A8_SRGB},
                 {VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_R8G8B8A8_SRGB},
                 {VK_FORMAT_D32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT},
                 {VK_FORMAT_D32_SFLOAT, VK_FORMAT_A2B10G10R10_UNORM_PACK32}};
    for (const auto& c : cases) {
        if (!host.has(c.depth)) continue;
        CAPTURE(int(c.depth));
        host.use(c.colour, {c.depth, true});
        const Picture drawn = host.draw(camera, kBoxes, grown.context);
        size_t inside = 0, unlike = 0;
        for (size_t i = 0; i < kPixels; ++i) {
            // Edges hold some of the box behind them, which isn't the same in both formats.
            if (near(other, i, 2)) continue;
            ++inside;
            for (size_t channel = 0; channel < 3; ++channel)
                if (std::abs(int(drawn.rgba[4 * i + channel]) - int(plain.rgba[4 * i + channel])) > 2) {
                    ++unlike;
                    break;
                }
        }
        CHECK(inside > 4000);
        CHECK(unlike < inside / 500);  // smoothing follows some edges further, to boxes too
    }
}

// Six frames may be recorded before the first is submitted.
void sixFramesAtOnce(DrawingHost& host, Grown& grown) {
    host.use(VK_FORMAT_R8G8B8A8_UNORM, {});
    std::vector<EspCamera> cameras;
    for (int i = 0; i < 6; ++i) cameras.push_back(cameraAt(.2f + .3f * float(i), .6f, 1.6f));
    std::vector<Picture> single;
    for (const EspCamera& camera : cameras) single.push_back(host.drawAtOnce({camera}, grown.context).front());
    const std::vector<Picture> together = host.drawAtOnce(cameras, grown.context);
    for (size_t i = 0; i < cameras.size(); ++i) CHECK(together[i].rgba == single[i].rgba);
    CHECK(single[0].rgba != single[1].rgba);
}

// The first frame of a plant is recorded and dropped: what it would have bound, culled and shaded, the next one does.
void droppedFrame(DrawingHost& host, Grown& grown) {
    host.use(VK_FORMAT_R8G8B8A8_UNORM, {});
    const std::vector<EspCamera> cameras = {cameraAt(.9f, .8f, 1.7f)};
    const Picture wanted = host.drawAtOnce(cameras, grown.context)[0];
    Grown other(host.device());
    host.recordInVain(cameras[0], other.context);
    REQUIRE(espDropFrame(other.context) == ESP_OK);
    const Picture after = host.drawAtOnce(cameras, other.context)[0];
    CHECK(after.rgba == wanted.rgba);
    CHECK(espDropFrame(nullptr) == ESP_INVALID_ARGUMENT);
}

// A host's scene that can't be used is refused.
void refusedFrames(DrawingHost& host, Grown& grown) {
    const auto refused = [&](auto&& spoil) {
        EspHostScene scene = host.scene();
        esp::DrawDef def;
        int recording = 0, image = 0;  // refused before anything is done with them
        def.commandBuffer = &recording;
        def.colourImage = def.colourView = &image;
        def.colourFormat = VK_FORMAT_R8G8B8A8_UNORM;
        def.colourUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
        def.frame = 1;
        def.scene = &scene;
        spoil(def, scene);
        return espDraw(grown.context, &def) == ESP_INVALID_ARGUMENT &&
               std::string(espLastError(grown.context)).find("scene") != std::string::npos;
    };
    CHECK(refused([](esp::DrawDef& def, EspHostScene&) { def.commandBuffer = nullptr; }));
    CHECK(refused([](esp::DrawDef&, EspHostScene& scene) { scene.depthImage = nullptr; }));
    CHECK(refused([](esp::DrawDef&, EspHostScene& scene) { scene.depthFormat = VK_FORMAT_R32_SFLOAT; }));
    CHECK(refused([](esp::DrawDef&, EspHostScene& scene) { scene.depthPerNearness = 0; }));
    // As five of five engines make it.
    CHECK(refused([](esp::DrawDef&, EspHostScene& s) { s.depthUsage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT; }));
    CHECK(std::string(espLastError(grown.context)).find("depthUsage lacks VK_IMAGE_USAGE_SAMPLED_BIT") !=
          std::string::npos);
    CHECK(refused([](esp::DrawDef& def, EspHostScene&) { def.colourUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT; }));
    CHECK(refused([](esp::DrawDef&, EspHostScene& scene) { scene.depthAtInfinity = NAN; }));
    CHECK(refused([](esp::DrawDef& def, EspHostScene&) { def.look.view = ESP_VIEW_OVERDRAW; }));
    // A picture that isn't one, with a scene or without.
    for (const VkFormat format : {VK_FORMAT_R8_UNORM, VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_UNDEFINED}) {
        esp::DrawDef def;
        int handle = 0;
        def.commandBuffer = def.colourImage = def.colourView = &handle;
        def.colourFormat = format;
        def.frame = 1;
        CHECK(espDraw(grown.context, &def) == ESP_INVALID_ARGUMENT);
        CHECK(std::string(espLastError(grown.context)).find("colourFormat") != std::string::npos);
    }
    // A frame that is done: what it reads might be gone.
    esp::DrawDef late;
    int handle = 0;
    late.commandBuffer = late.colourImage = late.colourView = &handle;
    late.colourFormat = VK_FORMAT_R8G8B8A8_UNORM;
    late.frame = 1;
    CHECK(espDraw(grown.context, &late) == ESP_INVALID_ARGUMENT);
    CHECK(std::string(espLastError(grown.context)).find("frame 1 is done already") != std::string::npos);
}

}  // namespace

// One device for all: making its programs is what takes time.
TEST_CASE("growth in a host's scene") {
    DrawingHost host;
    Grown grown(host.device());
    hideEachOther(host, grown);
    depthsAreWhereRaysHit(host, grown);
    otherFormats(host, grown);
    sixFramesAtOnce(host, grown);
    droppedFrame(host, grown);
    refusedFrames(host, grown);
    picture(host, grown);
}

TEST_CASE("growth in a host's scene, as drawn on devices that aren't software") {
    DrawingHost host;
    Grown grown(discrete(host)), plain(host.device());
    const EspCamera camera = cameraAt(1.3f, .9f, 1.9f);
    const Picture bare = host.draw(camera, kBoxes, nullptr), drawn = host.draw(camera, kBoxes, grown.context),
                  other = host.draw(camera, kBoxes, plain.context);
    size_t ours = 0, both = 0, either = 0;
    for (size_t i = 0; i < kPixels; ++i) {
        const bool here = drawn.depth[i] != bare.depth[i], there = other.depth[i] != bare.depth[i];
        ours += here, both += here && there, either += here || there;
    }
    CHECK(ours > 2000);
    CHECK(both > either * 3 / 4);  // they differ at edges
    // A stroke, an edit and a move of the eye; and all that is drawn to explain.
    for (EspView view : {ESP_VIEW_SHADED, ESP_VIEW_CHARTS, ESP_VIEW_LOD, ESP_VIEW_OVERDRAW}) {
        esp::DrawDef def;
        def.width = kWidth;
        def.height = kHeight;
        def.camera = cameraAt(.3f + .2f * float(view), .7f, 1.7f);
        def.look.view = view;
        CHECK(espDraw(grown.context, &def) == ESP_OK);
        EspSeed seed{};
        REQUIRE(espSeedAt(grown.context, 0, &seed) == ESP_OK);
        const float position[3] = {.3f + .1f * float(view), .1f, 0}, direction[3] = {0, 1, 0};
        REQUIRE(espMoveSeed(grown.context, seed, position, direction) == ESP_OK);
        REQUIRE(espUpdate(grown.context) == ESP_OK);
    }
    EspTriangles triangles{};
    CHECK(espMaterialise(grown.context, &triangles) == ESP_OK);
    CHECK(triangles.indexCount > 10000);
}

TEST_CASE("a picture whose place a host's frame took isn't read back") {
    DrawingHost host;
    Grown grown(host.device());
    const EspCamera camera = cameraAt(1.3f, .9f, 1.9f);
    std::vector<uint8_t> pixels;
    const auto drawn = [&](uint32_t times) {
        esp::DrawDef def;
        def.width = times * kWidth;
        def.height = times * kHeight;
        def.camera = camera;
        REQUIRE(espDraw(grown.context, &def) == ESP_OK);
        pixels.assign(size_t(def.width) * def.height * 4, 0);
    };
    const auto read = [&] { return espReadPixels(grown.context, pixels.data(), pixels.size()); };
    for (uint32_t times : {1u, 2u}) {
        drawn(times);
        REQUIRE(read() == ESP_OK);
        const std::vector<uint8_t> before = pixels;
        host.drawAtOnce({camera}, grown.context);  // not into a scene
        CHECK(read() == (times == 1 ? ESP_OK : ESP_INVALID_ARGUMENT));
        if (times == 1) {
            CHECK(pixels == before);
            // Nor does one take it that is dropped, and after which all images but this are made anew.
            host.recordInVain(camera, grown.context);
            REQUIRE(espDropFrame(grown.context) == ESP_OK);
            host.drawAtOnce({camera}, grown.context);
            CHECK(read() == ESP_OK);
            CHECK(pixels == before);
        }
        drawn(times);
        host.draw(camera, kBoxes, grown.context);
        CHECK(read() == ESP_INVALID_ARGUMENT);
        CHECK(std::string(espLastError(grown.context)).find("took its place") != std::string::npos);
    }
}

TEST_CASE("a context may go while frames that its host has submitted are still drawn") {
    DrawingHost host;
    std::vector<Image> drawn;
    {
        const Grown grown(host.device());
        drawn =
            host.submit({cameraAt(1.3f, .9f, 1.9f), cameraAt(.5f, .5f, 1.2f), cameraAt(.2f, .5f, 1.5f)}, grown.context);
    }
    // The validation layer tells of what goes too early; so that it is awaited here:
    host.draw(cameraAt(1.3f, .9f, 1.9f), kBoxes, nullptr);
}

TEST_CASE("a host that draws no more, but paints and updates, or only paints, takes no more memory for it") {
    bool updates = true;
    SUBCASE("and updates") {}
    SUBCASE("only paints") {
        updates = false;
    }
    DrawingHost host;
    Grown grown(host.device());
    host.draw(cameraAt(1.3f, .9f, 1.9f), kBoxes, grown.context);
    EspBrush brush = esp::defaults<EspBrush>();
    brush.layer = "mask";
    brush.radius = .3f;
    const auto bytesAfter = [&](int strokes) {
        for (int i = 0; i < strokes; ++i) {
            const EspDab dab = {{.5f, .5f, 0}, {0, 0, 1}, 1};
            EspStroke stroke{};
            REQUIRE(espBeginStroke(grown.context, &brush, &stroke) == ESP_OK);
            REQUIRE(espStrokeDabs(grown.context, stroke, &dab, 1) == ESP_OK);
            REQUIRE(espEndStroke(grown.context, stroke) == ESP_OK);
            REQUIRE(espDestroyStroke(grown.context, stroke) == ESP_OK);
            if (updates) REQUIRE(espUpdate(grown.context) == ESP_OK);
        }
        EspStats stats{};
        REQUIRE(espReadStats(grown.context, &stats) == ESP_OK);
        return stats.totalBytes;
    };
    const uint64_t settled = bytesAfter(8);
    CHECK(bytesAfter(64) <= settled + (64 << 10));
}

TEST_CASE("what a frame took is known once its host says that it is done, though it draws no other") {
    DrawingHost host;
    Grown grown(host.device());
    REQUIRE(espUpdate(grown.context) == ESP_OK);
    const auto drawMs = [&] {
        EspStats s{};
        REQUIRE(espReadStats(grown.context, &s) == ESP_OK);
        return s.drawMs;
    };
    host.draw(cameraAt(1.3f, .9f, 1.9f), kBoxes, grown.context);
    CHECK(drawMs() == 0);
    REQUIRE(espFramesDone(grown.context, 1) == ESP_OK);
    CHECK(drawMs() > 0);
    CHECK(espFramesDone(nullptr, 1) == ESP_INVALID_ARGUMENT);
}

TEST_CASE("what is only kept for what comes is given back when the host asks, and nothing else") {
    DrawingHost host;
    Grown grown(host.device());
    const EspCamera camera = cameraAt(1.3f, .9f, 1.9f);
    const auto stats = [&] {
        EspStats s{};
        REQUIRE(espReadStats(grown.context, &s) == ESP_OK);
        return s;
    };
    const auto growTo = [&](uint32_t depth) {
        EspGrowDef grow = esp::defaults<EspGrowDef>();
        grow.maxDepth = depth;
        REQUIRE(espSetGrow(grown.context, &grow) == ESP_OK);
        REQUIRE(espUpdate(grown.context) == ESP_OK);
    };
    growTo(4000);  // both sets of buffers are there now
    host.use(VK_FORMAT_R8G8B8A8_UNORM, {}, 8);
    host.draw(camera, kBoxes, grown.context);  // so large pictures have memory of their own
    host.use(VK_FORMAT_R8G8B8A8_UNORM, {});
    const Picture before = host.draw(camera, kBoxes, grown.context);  // nobody says that this frame is done
    const EspStats kept = stats();
    CHECK(kept.reservedBytes >= kept.totalBytes);

    REQUIRE_MESSAGE(espTrim(grown.context) == ESP_OK, espLastError(grown.context));
    const EspStats left = stats();
    MESSAGE("bytes reserved: " << kept.reservedBytes << ", then " << left.reservedBytes);
    CHECK(left.totalBytes < kept.totalBytes);
    CHECK(left.reservedBytes < kept.reservedBytes);
    CHECK(left.hash == kept.hash);
    CHECK(left.expansions == kept.expansions);
    const Picture after = host.draw(camera, kBoxes, grown.context);
    CHECK(after.rgba == before.rgba);
    CHECK(after.depth == before.depth);

    growTo(4096);
    CHECK(stats().hash == kept.hash);
    REQUIRE(espTrim(grown.context) == ESP_OK);
    REQUIRE(espTrim(grown.context) == ESP_OK);
    CHECK(stats().reservedBytes <= left.reservedBytes);
    CHECK(host.draw(camera, kBoxes, grown.context).rgba == before.rgba);
}
