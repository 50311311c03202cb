// A window that is resized while frames are shown. Needs a display; without one it says so.
#include "runtime/gpu/swapchain.hpp"

#include "tests/gpu/gpu_test.hpp"
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

extern "C" VkResult glfwCreateWindowSurface(VkInstance, GLFWwindow*, const VkAllocationCallbacks*, VkSurfaceKHR*);

using namespace espalier;

namespace {

struct Glfw {
    bool ready = glfwInit() == GLFW_TRUE && glfwVulkanSupported();
    ~Glfw() { glfwTerminate(); }
};

}  // namespace

TEST_CASE("frames are shown while the window changes its size") {
    Glfw glfw;
    if (!glfw.ready) {
        MESSAGE("skipped: no display to open a window on");
        return;
    }
    DeviceOptions options = validated();
    uint32_t count = 0;
    const char** extensions = glfwGetRequiredInstanceExtensions(&count);
    options.surfaceExtensions.assign(extensions, extensions + count);
    std::unique_ptr<Device> device = must(Device::create(options));
    CHECK(device->info().canPresent);
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    GLFWwindow* window = glfwCreateWindow(320, 200, "espalier", nullptr, nullptr);
    REQUIRE(window);
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    REQUIRE(glfwCreateWindowSurface(device->instance(), window, nullptr, &surface) == VK_SUCCESS);
    int shown = 0;
    {
        Swapchain swapchain = must(Swapchain::create(*device, surface, {320, 200}, false));
        CHECK(must(swapchain.acquire({0, 0})) == nullptr);  // minimised
        for (int frame = 0; frame < 30; ++frame) {
            if (frame == 10) glfwSetWindowSize(window, 400, 300);
            if (frame == 20) glfwSetWindowSize(window, 100, 90);
            glfwPollEvents();
            int width = 0, height = 0;
            glfwGetFramebufferSize(window, &width, &height);
            Image* image = must(swapchain.acquire({uint32_t(width), uint32_t(height)}));
            if (!image) continue;
            Commands commands = must(Commands::begin(*device, "frame"));
            commands.transition(*image, ImageState::colorTarget);
            DrawTargets targets{image->extent(), {{.view = image->view(), .clear = {{0.1f, 0.4f, 0.1f, 1}}}}, {}};
            { DrawPass pass(commands, "clear", targets); }
            REQUIRE(swapchain.present(commands));
            ++shown;
        }
    }
    CHECK(shown > 15);
    REQUIRE(device->waitIdle());
    CHECK(device->validationMessages() == 0);
    device->vkInstance().vkDestroySurfaceKHR(device->instance(), surface, nullptr);
    glfwDestroyWindow(window);
}
