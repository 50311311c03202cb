// The window: as large as it was last, with letters that suit its display.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "sample_game/app_state.hpp"
#include "sample_game/settings.hpp"
#include "sample_game/theme.hpp"
#include "tools/scene/user_folders.hpp"

namespace sample {

namespace fs = std::filesystem;

void WindowCloser::operator()(GLFWwindow* window) const {
    glfwDestroyWindow(window);
}

namespace {

constexpr uint32_t kLeastWidth = 480, kLeastHeight = 320;

// What was asked for, times the display's scale, may be more than the display has room for.
void fitDisplay(GLFWwindow* window) {
    int x, y, most[2] = {0, 0}, size[2];
    if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) glfwGetMonitorWorkarea(monitor, &x, &y, &most[0], &most[1]);
    glfwGetWindowSize(window, &size[0], &size[1]);
    if (most[0] > 0 && (size[0] > most[0] || size[1] > most[1]))
        glfwSetWindowSize(window, std::min(size[0], most[0]), std::min(size[1], most[1]));
}

}  // namespace

// What the last session has left. Tests and scripts neither find nor leave anything.
void App::recall() {
    layoutFile_ = options_.frames || espalier::scene::configFolder().empty()
                      ? ""
                      : espalier::scene::configFolder() + "/windows.ini";
    if (layoutFile_.empty()) return;
    std::error_code ignored;
    fs::create_directories(espalier::scene::configFolder(), ignored);
    readLayout(work_.layout, work_.brush, layoutError_);
    const Layout& layout = work_.layout;
    if (options_.sized || layout.windowWidth < kLeastWidth || layout.windowHeight < kLeastHeight) return;
    options_.width = int(layout.windowWidth);
    options_.height = int(layout.windowHeight);
}

void App::keepLayout() {
    if (layoutFile_.empty()) return;
    Layout& layout = work_.layout;
    layout.maximised = glfwGetWindowAttrib(window_.get(), GLFW_MAXIMIZED);
    if (!layout.maximised) {
        float scale = 1, y = 1;
        glfwGetWindowContentScale(window_.get(), &scale, &y);  // which a new window is made larger by
        int width = 0, height = 0;
        glfwGetWindowSize(window_.get(), &width, &height);
        layout.windowWidth = uint32_t(std::lround(float(width) / scale));
        layout.windowHeight = uint32_t(std::lround(float(height) / scale));
    }
    writeLayout(layout, work_.brush);
}

bool App::openWindow() {
    glfwSetErrorCallback([](int, const char* text) { std::fprintf(stderr, "espalier-sample: window: %s\n", text); });
    if (!glfwInit()) return fail("there is no display to open a window on; tools/run writes frames to out/ then");
    glfw_ = true;
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    glfwWindowHint(GLFW_MAXIMIZED, !options_.sized && work_.layout.maximised);
    window_.reset(glfwCreateWindow(options_.width, options_.height, "Espalier", nullptr, nullptr));
    if (!window_) return fail("the window can't be opened");
    fitDisplay(window_.get());
    glfwSetWindowSizeLimits(window_.get(), int(kLeastWidth), int(kLeastHeight), GLFW_DONT_CARE, GLFW_DONT_CARE);
    host_ = std::make_unique<VulkanHost>();
    uint32_t count = 0;
    const char* const* extensions = espRequiredExtensions(&count);
    if (!host_->create(window_.get(), options_.validation, espRequiredFeatures(), extensions, count))
        return fail(host_->error());
    return true;
}

void App::openUi() {
    ImGui::CreateContext();
    imgui_ = true;
    ImGui::GetIO().IniFilename = layoutFile_.empty() ? nullptr : layoutFile_.c_str();
    input_ = std::make_unique<Input>(window_.get());
    controls_ = std::make_unique<Controls>(work_, session_, input_.get());
    ImGui_ImplGlfw_InitForVulkan(window_.get(), false);
    rescale();
}

// The display's scale, or the size of letters, has changed.
bool App::rescale() {
    float scale = 1, y = 1;
    glfwGetWindowContentScale(window_.get(), &scale, &y);
    if (options_.uiScale > 0) scale = options_.uiScale;
    scale = std::max(scale, .5f) * work_.layout.sizeOfAll;
    if (scale == themeScale_ || (themeScale_ > 0 && ImGui::IsMouseDown(0))) return true;
    themeScale_ = work_.scale = scale;
    applyTheme(scale);
    wake();
    return !ui_ || ui_->updateFonts() || fail(ui_->error());
}

}  // namespace sample
