// The window's frames as its GPU sees them: how far recording runs ahead of drawing.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <doctest/doctest.h>

#include <memory>

#include "plugin_api/espalier.h"
#include "sample_game/vulkan_host.hpp"
#include "tests/tools/on_display.hpp"

using namespace sample;

TEST_CASE(
    "on software devices a frame is done before the next is recorded unless they overlap, on others the one before "
    "it") {
    if (!std::getenv("DISPLAY")) {
        if (!passesOnDisplay("on software devices a frame is done*")) MESSAGE("xvfb-run isn't installed; skipped");
        return;
    }
    const Glfw glfw;
    REQUIRE(glfw.up);
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    const std::unique_ptr<GLFWwindow, void (*)(GLFWwindow*)> window(glfwCreateWindow(160, 90, "test", nullptr, nullptr),
                                                                    glfwDestroyWindow);
    REQUIRE(window);
    VulkanHost host;
    uint32_t count = 0;
    const char* const* extensions = espRequiredExtensions(&count);
    REQUIRE_MESSAGE(host.create(window.get(), true, espRequiredFeatures(), extensions, count), host.error());
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(host.physicalDevice(), &properties);
    const bool software = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    uint64_t shown = 0;
    for (int tries = 0; shown < 12 && tries < 50; ++tries) {
        glfwPollEvents();
        const bool overlaps = shown >= 4 && shown < 8;
        const std::optional<Frame> frame = host.begin(overlaps);
        REQUIRE_MESSAGE(host.error().empty(), host.error());
        if (!frame) continue;  // the window took another size
        CAPTURE(frame->number);
        const uint64_t ahead = software && !overlaps ? 1 : kFramesInFlight;
        CHECK(frame->number == shown + 1);
        CHECK(frame->finished == (frame->number > ahead ? frame->number - ahead : 0));
        imageBarrier(frame->commands, frame->image, VK_IMAGE_LAYOUT_UNDEFINED,
                     VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
        REQUIRE_MESSAGE(host.end(*frame), host.error());
        shown = frame->number;
    }
    CHECK(shown == 12);
    CHECK(host.validationMessages() == 0);
}

TEST_CASE("a run that is shown for some frames only leaves nothing behind to be recovered") {
    if (run("command -v xvfb-run").code != 0) {
        MESSAGE("xvfb-run isn't installed; skipped");
        return;
    }
    const Folder folder;
    const std::string shown = folder.write("run.jsonl", R"({"espalier_run":1,"scene":")" + content("guided.json") +
                                                            R"(","width":64,"height":36,"step":0.01}
{"frame":0,"fill":{"layer":"mask","value":0}}
{"frame":1,"light":{"hour":12,"exposure":0,"shadows":false}}
)");
    const std::string home = "HOME=" + folder.path.string() + " XDG_CONFIG_HOME=" + folder.file("config") + " ";
    const Ran ran = runOnDisplay("640x480", home + program("espalier-sample") + " " + shown +
                                                " --editor --size 320x240 --autosave 1 --frames 12");
    CHECK_MESSAGE(ran.code == 0, ran.output);
    std::error_code none;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path / "config", none))
        CHECK_MESSAGE(entry.path().filename() != "autosave.json", entry.path().string());
}
