// The sample game and its editor: a host that has a window, a device and a frame loop, and lets Espalier draw into its
// frames. It draws only when something has changed, so that a still scene leaves the machine alone.
#define GLFW_INCLUDE_NONE
#include "sample_game/app.hpp"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "sample_game/brush_tool.hpp"
#include "sample_game/input.hpp"
#include "sample_game/navigation.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/scene_image.hpp"
#include "sample_game/seed_tool.hpp"
#include "sample_game/session.hpp"
#include "sample_game/settings.hpp"
#include "sample_game/theme.hpp"
#include "sample_game/ui_renderer.hpp"
#include "sample_game/vulkan_host.hpp"
#include "tools/scene/picture.hpp"

namespace sample {
namespace {

using namespace espalier::document;
namespace fs = std::filesystem;

constexpr double kSlowDrawMs = 40, kSlowGrowthMs = 500;
constexpr int kFramesAfterChange = 3;  // ImGui settles within two
constexpr double kLookEvery = .3;      // seconds
constexpr size_t kHistory = 240;       // frames in the graph

struct WindowCloser {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};

// As of the last frame: whether a press there is the panels' own. ImGui knows only what lies under the mouse at the
// beginning of a frame, which with slow frames isn't where it was pressed.
bool overPanel(float x, float y) {
    const ImGuiContext& gui = *ImGui::GetCurrentContext();
    if (!gui.OpenPopupStack.empty()) return true;
    for (const ImGuiWindow* window : gui.Windows)
        if (window->WasActive && !window->Hidden && !(window->Flags & ImGuiWindowFlags_NoMouseInputs) &&
            window->OuterRectClipped.Contains({x, y}))
            return true;
    return false;
}

class App {
  public:
    explicit App(const AppOptions& options) : options_(options) {}
    ~App();
    bool open();
    bool loop();

  private:
    bool fail(const std::string& message) {
        std::fprintf(stderr, "espalier-sample: %s\n", message.c_str());
        return false;
    }
    bool openWindow();
    void openUi();
    bool openDocument(const espalier::scene::Request& request, std::string& error);
    void lookFrom(const EspCamera& camera);
    float reach() const;

    bool rescale();
    void handleKeys(const std::vector<KeyEvent>& keys);
    void handleKey(const KeyEvent& key);
    void handlePointer(const std::vector<PointerEvent>& events);
    void setEditing(bool editing);
    void catchMouse(bool caught);
    void chooseTool(Tool tool);
    void hover();
    void showUi();
    bool update();
    bool showOpening(const std::string& file);
    bool drawFrame(bool moving, bool last);
    void screenshot(const std::string& path, const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height);
    void wake() { awake_ = kFramesAfterChange; }

    AppOptions options_;
    bool glfw_ = false, imgui_ = false;
    std::unique_ptr<GLFWwindow, WindowCloser> window_;
    std::unique_ptr<VulkanHost> host_;
    std::unique_ptr<SceneImage> image_;
    std::unique_ptr<UiRenderer> ui_;
    std::unique_ptr<Input> input_;
    std::string layoutFile_;  // of ImGui's windows

    Workspace work_;
    Session session_;
    Navigation navigation_;
    BrushTool brush_;
    SeedTool seeds_;

    int awake_ = kFramesAfterChange;
    int panelButtons_ = 0;  // that were pressed over a panel and are down
    uint64_t frames_ = 0, grownRevision_ = 0;
    bool coarse_ = false, growing_ = false, screenshot_ = false;
    float themeScale_ = 0;
};

App::~App() {
    ui_.reset();
    image_.reset();
    work_.document.reset();
    work_.context.reset();
    host_.reset();
    if (imgui_) {
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    window_.reset();
    if (glfw_) glfwTerminate();
}

// ---- Opening

bool App::openWindow() {
    glfwSetErrorCallback([](int, const char* text) { std::fprintf(stderr, "espalier-sample: window: %s\n", text); });
    if (!glfwInit()) return fail("there is no display to open a window on; tools/run writes frames to out/ then");
    glfw_ = true;
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_.reset(glfwCreateWindow(options_.width, options_.height, "Espalier", nullptr, nullptr));
    if (!window_) return fail("the window can't be opened");
    glfwSetWindowSizeLimits(window_.get(), 480, 320, GLFW_DONT_CARE, GLFW_DONT_CARE);
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
    // Tests and scripts leave nothing behind.
    layoutFile_ = options_.frames || configFolder().empty() ? "" : configFolder() + "/windows.ini";
    if (!layoutFile_.empty()) {
        std::error_code ignored;
        fs::create_directories(configFolder(), ignored);
        readLayout(work_.layout, work_.brush);
    }
    ImGui::GetIO().IniFilename = layoutFile_.empty() ? nullptr : layoutFile_.c_str();
    input_ = std::make_unique<Input>(window_.get());
    ImGui_ImplGlfw_InitForVulkan(window_.get(), true);
    rescale();
}

bool App::openDocument(const espalier::scene::Request& request, std::string& error) {
    EspHostDevice device{};
    device.getInstanceProcAddr = reinterpret_cast<void*>(vkGetInstanceProcAddr);
    device.instance = host_->instance();
    device.physicalDevice = host_->physicalDevice();
    device.device = host_->device();
    device.queue = host_->queue();
    device.queueFamily = host_->queueFamily();
    device.debugUtils = host_->validation();
    EspContextDef def = espDefaultContextDef();
    def.host = &device;
    const std::string cache = cacheFolder();
    if (!cache.empty()) def.cacheFolder = cache.c_str();
    def.log = [](void*, EspLogLevel level, const char* message) {
        if (level == ESP_LOG_WARNING) std::fprintf(stderr, "espalier-sample: warning: %s\n", message);
    };
    // The old document stays until the new one is there.
    EspContext* made = nullptr;
    if (espCreate(&def, &made) != ESP_OK) {
        error = espLastError(nullptr);
        return false;
    }
    std::unique_ptr<EspContext, void (*)(EspContext*)> context(made, espDestroy);
    auto document = std::make_unique<Document>(made);
    if (!document->open(request, error)) return false;
    host_->waitIdle();
    if (work_.document) session_.end(work_);
    work_.document = std::move(document);
    work_.context = std::move(context);
    work_.selected.clear();
    work_.branch.reset();
    work_.path.clear();
    work_.plantGrammar = work_.openGrammar = 0;
    work_.brush.layer = work_.scene().layers.empty() ? "" : work_.scene().layers.front();
    work_.stats = {};
    work_.redraw = true;
    grownRevision_ = ~0ull;
    espSetGrow(made, &work_.grow);
    session_.begin(work_, request.file);
    if (options_.frames) session_.forgetRecovery(false);
    lookFrom(work_.scene().camera);
    glfwSetWindowTitle(window_.get(), ("Espalier \u2014 " + work_.scene().name).c_str());
    return true;
}

bool App::open() {
    if (!openWindow()) return false;
    openUi();
    ui_ = std::make_unique<UiRenderer>(*host_);
    image_ = std::make_unique<SceneImage>(*host_);
    if (!ui_->create()) return fail(ui_->error());
    std::string error;
    if (!showOpening(options_.request.file)) return false;
    if (!openDocument(options_.request, error)) return fail(error);
    work_.editing = options_.editor;
    if (!options_.record.empty() &&
        !session_.startRecording(work_, options_.record, uint32_t(options_.width), uint32_t(options_.height)))
        return fail(work_.error);
    return true;
}

float App::reach() const {
    float low[3] = {1e30f, 1e30f, 1e30f}, high[3] = {-1e30f, -1e30f, -1e30f};
    for (const auto& surface : work_.scene().surfaces) {
        EspSurfaceInfo info;
        if (espSurfaceInfo(work_.context.get(), surface.id, &info) != ESP_OK) continue;
        for (int i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], info.boundsMin[i]);
            high[i] = std::max(high[i], info.boundsMax[i]);
        }
    }
    return low[0] > high[0] ? 1 : glm::distance(vec(low), vec(high));
}

void App::lookFrom(const EspCamera& camera) {
    work_.camera.set(camera, reach());
    work_.redraw = true;
}

// ---- What the user does

// The display's scale, or the size of letters, has changed.
bool App::rescale() {
    float scale = 1, y = 1;
    glfwGetWindowContentScale(window_.get(), &scale, &y);
    scale = std::max(scale, .5f) * work_.layout.sizeOfAll;
    if (scale == themeScale_ || (themeScale_ > 0 && ImGui::IsMouseDown(0))) return true;
    themeScale_ = work_.scale = scale;
    applyTheme(scale);
    wake();
    return !ui_ || ui_->updateFonts() || fail(ui_->error());
}

void App::catchMouse(bool caught) {
    navigation_.caught = caught;
    glfwSetInputMode(window_.get(), GLFW_CURSOR, caught ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    ImGuiIO& io = ImGui::GetIO();
    io.ConfigFlags = caught ? io.ConfigFlags | ImGuiConfigFlags_NoMouse | ImGuiConfigFlags_NoMouseCursorChange
                            : io.ConfigFlags & ~(ImGuiConfigFlags_NoMouse | ImGuiConfigFlags_NoMouseCursorChange);
}

void App::setEditing(bool editing) {
    brush_.cancel(work_);
    catchMouse(false);
    work_.editing = editing;
    work_.redraw = true;
}

void App::chooseTool(Tool tool) {
    brush_.cancel(work_);
    work_.choose(tool);
}

void App::handleKeys(const std::vector<KeyEvent>& keys) {
    for (const KeyEvent& key : keys) {
        const bool functionKey = key.key >= GLFW_KEY_F1 && key.key <= GLFW_KEY_F12;
        const bool control = key.mods & GLFW_MOD_CONTROL;
        const bool file = control && (key.key == GLFW_KEY_S || key.key == GLFW_KEY_O || key.key == GLFW_KEY_Q);
        if (!ImGui::GetCurrentContext()->OpenPopupStack.empty() && !functionKey) continue;
        if (ImGui::GetIO().WantTextInput && !functionKey && !file) continue;
        handleKey(key);
    }
}

void App::handleKey(const KeyEvent& event) {
    const int key = event.key;
    const bool control = event.mods & GLFW_MOD_CONTROL, shift = event.mods & GLFW_MOD_SHIFT;
    if (key == GLFW_KEY_F1) work_.layout.help = !work_.layout.help;
    if (key == GLFW_KEY_F2) work_.layout.panel = !work_.layout.panel, work_.redraw = true;
    if (key == GLFW_KEY_F3) work_.layout.figures = !work_.layout.figures;
    if (key == GLFW_KEY_F4) work_.layout.grammar = !work_.layout.grammar;
    if (key == GLFW_KEY_F12) screenshot_ = true;
    if (control) {
        if (key == GLFW_KEY_Q) session_.quit = true;
        if (key == GLFW_KEY_S) askToSave(work_, session_);
        if (key == GLFW_KEY_O) askToOpen();
        if (brush_.painting()) return;
        if (key == GLFW_KEY_Z && !shift && work_.document->undoName()) work_.perform(Undo{});
        if (((key == GLFW_KEY_Z && shift) || key == GLFW_KEY_Y) && work_.document->redoName()) work_.perform(Redo{});
        return;
    }
    if (key == GLFW_KEY_TAB) return setEditing(!work_.editing);
    if (key == GLFW_KEY_ESCAPE) {
        // Never quits: frees the mouse, closes the help, puts the tool away.
        if (navigation_.caught)
            catchMouse(false);
        else if (work_.layout.help)
            work_.layout.help = false;
        else if (brush_.sizing())
            brush_.cancel(work_);
        else
            chooseTool(Tool::look);
    }
    if (key == GLFW_KEY_HOME) lookFrom(espFrameAll(work_.context.get()));
    if (!work_.editing) {
        if (key == GLFW_KEY_G) navigation_.toggleFlying();
        if (key == GLFW_KEY_SPACE) navigation_.jump();
        return;
    }
    if (navigation_.dragging()) return;  // letters fly
    if (key == GLFW_KEY_Q) chooseTool(Tool::look);
    if (key == GLFW_KEY_B) chooseTool(Tool::paint);
    if (key == GLFW_KEY_S) chooseTool(Tool::seeds);
    if (key == GLFW_KEY_P) chooseTool(Tool::branch);
    if (work_.tool == Tool::paint) {
        float& radius = work_.brush.radius;
        if (key == GLFW_KEY_LEFT_BRACKET) radius = std::max(radius / 1.15f, .005f);
        if (key == GLFW_KEY_RIGHT_BRACKET) radius = std::min(radius * 1.15f, 20.f);
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        if (key == GLFW_KEY_F) brush_.startSizing(work_, {mouse.x, mouse.y}, shift);
    } else if (key == GLFW_KEY_F) {
        lookFrom(espFrameAll(work_.context.get()));
    }
    if (work_.tool == Tool::seeds) {
        if (key == GLFW_KEY_DELETE || key == GLFW_KEY_X) seeds_.remove(work_);
        if (key == GLFW_KEY_A) seeds_.selectAll(work_);
    }
    if (key == GLFW_KEY_R) {
        ChangeSeeds change;
        for (const auto& seed : work_.scene().seeds) {
            change.seeds.push_back(work_.document->recordOf(seed));
            change.seeds.back().number = seed.number * 747796405u + 2891336453u;
        }
        work_.perform(change);
    }
    if (key == GLFW_KEY_V && !work_.brush.layer.empty()) {
        const bool seen = work_.scene().look.view == ESP_VIEW_LAYER;
        work_.perform(SetView{seen ? "shaded" : "layer", seen ? "" : work_.brush.layer});
    }
    for (int i = 0; i < 4; ++i)
        if (key == GLFW_KEY_1 + i) work_.perform(SetView{espalier::scene::nameOf(EspView(i)), ""});
}

void App::handlePointer(const std::vector<PointerEvent>& events) {
    using Kind = PointerEvent::Kind;
    for (const PointerEvent& event : events) {
        const bool busy = navigation_.dragging() || brush_.painting() || brush_.sizing() || seeds_.dragging();
        if (!navigation_.caught && !busy) {
            if (event.kind == Kind::press && (panelButtons_ > 0 || overPanel(event.x, event.y))) {
                ++panelButtons_;
                continue;
            }
            if (event.kind == Kind::release && panelButtons_ > 0) {
                --panelButtons_;
                continue;
            }
        }
        if (!work_.editing && event.kind == Kind::press && event.button == GLFW_MOUSE_BUTTON_LEFT &&
            !navigation_.caught) {
            catchMouse(true);
            continue;
        }
        const bool toolFirst = brush_.painting() || brush_.sizing() || seeds_.dragging();
        if (!toolFirst && navigation_.take(work_, event)) continue;
        if (!work_.editing || panelButtons_ > 0) continue;
        if (work_.tool == Tool::paint) brush_.take(work_, event);
        if (work_.tool == Tool::seeds) seeds_.take(work_, event);
        if (work_.tool == Tool::branch && event.kind == Kind::press && event.button == GLFW_MOUSE_BUTTON_LEFT)
            work_.pickBranch({event.x, event.y});
        if (toolFirst) navigation_.follow({event.x, event.y});
    }
    brush_.flush(work_);
}

void App::hover() {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    work_.hit.reset();
    if (!work_.editing || work_.tool != Tool::paint || !ImGui::IsMousePosValid(&mouse)) return;
    if (!brush_.painting() && overPanel(mouse.x, mouse.y)) return;
    work_.hit = work_.pick({mouse.x, mouse.y});
}

// ---- A frame

void App::showUi() {
    const auto& layers = work_.scene().layers;
    if (std::find(layers.begin(), layers.end(), work_.brush.layer) == layers.end())
        work_.brush.layer = layers.empty() ? "" : layers.front();
    if (work_.editing) {
        hover();
        if (work_.tool == Tool::paint) brush_.draw(work_, input_->mods());
        if (work_.tool == Tool::seeds) seeds_.draw(work_);
        if (work_.tool == Tool::branch) showWalk(work_);
        showMenu(work_, session_);
        showPanel(work_);
        showGrammarWindow(work_);
        showFigures(work_, host_->validationMessages(), host_->validation());
    }
    showStatus(work_, navigation_.caught, navigation_.flying());
    showHelp(work_);
}

// Growth that takes longer than a blink is announced one frame before.
bool App::update() {
    const bool changed = work_.document->revision() != grownRevision_ || brush_.painting();
    if (changed && !growing_ && !brush_.painting() && frames_ > 0 && work_.stats.expandMs > kSlowGrowthMs) {
        growing_ = true;
        showGrowing(work_);
        wake();
        return false;
    }
    growing_ = false;
    const uint32_t before = work_.stats.expansions;
    if (espUpdate(work_.context.get()) != ESP_OK) work_.error = espLastError(work_.context.get());
    grownRevision_ = work_.document->revision();
    if (espReadStats(work_.context.get(), &work_.stats) != ESP_OK) work_.error = espLastError(work_.context.get());
    const bool grew = work_.stats.expansions != before;
    if (grew && work_.branch) work_.readPath();
    work_.redraw = work_.redraw || grew;
    return grew;
}

void App::screenshot(const std::string& path, const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
    if (espalier::scene::writePng(path, rgba.data(), width, height, work_.error)) work_.message = "Written: " + path;
    wake();
}

bool App::showOpening(const std::string& file) {
    glfwPollEvents();
    const std::optional<Frame> frame = host_->begin();
    if (!frame) return host_->error().empty() || fail(host_->error());
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    const std::string text = "Opening " + fs::path(file).filename().string() + " ...";
    const ImVec2 size = ImGui::GetIO().DisplaySize, extent = ImGui::CalcTextSize(text.c_str());
    ImGui::GetForegroundDrawList()->AddText({(size.x - extent.x) / 2, size.y / 2}, IM_COL32(220, 225, 215, 255),
                                            text.c_str());
    ImGui::Render();
    imageBarrier(frame->commands, frame->image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkClearColorValue dark{{.1f, .1f, .1f, 1}};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(frame->commands, frame->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &dark, 1, &all);
    imageBarrier(frame->commands, frame->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    return (ui_->draw(*frame, *ImGui::GetDrawData()) || fail(ui_->error())) &&
           (host_->end(*frame) || fail(host_->error()));
}

bool App::drawFrame(bool moving, bool last) {
    const std::optional<Frame> frame = host_->begin();
    if (!frame) {
        if (!host_->error().empty()) return fail(host_->error());
        ImGui::EndFrame();
        glfwWaitEventsTimeout(.05);  // minimised, or about to be resized
        work_.redraw = true;
        return true;
    }
    EspDrawDef draw = espDefaultDrawDef();
    draw.camera = work_.camera.camera(work_.shift());
    draw.look = work_.scene().look;
    draw.look.viewLayer = work_.scene().viewLayer.c_str();
    // While the camera moves on a slow device, less detail: what counts then is that it follows the hand.
    const bool slow = moving && !last && work_.stats.drawMs > kSlowDrawMs;
    if (slow) draw.look.windowLodPixels *= 4;
    const float scale = slow && work_.layout.halfWhileMoving ? .5f : 1;
    if (!image_->show(work_.context.get(), *frame, draw, scale, work_.redraw)) return fail(image_->error());
    if (image_->drew()) {
        coarse_ = slow;
        EspStats stats;
        work_.redraw = espReadStats(work_.context.get(), &stats) == ESP_OK && stats.modelsFading > 0;
    }
    ImGui::Render();
    if (!ui_->draw(*frame, *ImGui::GetDrawData())) return fail(ui_->error());

    VulkanHost::TakePicture take;
    std::string path = last ? options_.screenshot : "";
    if (screenshot_ && path.empty())
        for (int i = 1; path.empty() || fs::exists(path); ++i) path = "espalier-" + std::to_string(i) + ".png";
    if (!path.empty())
        take = [&](const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
            screenshot(path, rgba, width, height);
        };
    screenshot_ = false;
    return host_->end(*frame, take) || fail(host_->error());
}

bool App::loop() {
    using Clock = std::chrono::steady_clock;
    double before = glfwGetTime();
    std::vector<PointerEvent> pointer;
    std::vector<KeyEvent> keys;
    while (!glfwWindowShouldClose(window_.get()) && !session_.quit) {
        // Asleep until the user does something, or it is time to look at the grammars' files.
        if (awake_ > 0 || options_.frames) {
            glfwPollEvents();
        } else {
            const double asleep = glfwGetTime();
            glfwWaitEventsTimeout(kLookEvery);
            if (glfwGetTime() - asleep < .9 * kLookEvery) wake();
        }
        const double now = glfwGetTime();
        const float seconds = float(std::min(now - before, .5));
        before = now;
        if (session_.step(work_, now)) wake();
        if (awake_ == 0 && !options_.frames) continue;
        const auto begin = Clock::now();
        if (!session_.openNext.empty()) {
            const std::string file = std::exchange(session_.openNext, {});
            if (!showOpening(file)) return false;
            work_.error.clear();
            openDocument({file, {}, {}, {}}, work_.error);
        }
        if (!rescale()) return false;

        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
        work_.window = {ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y};
        float wheel = 0;
        input_->take(pointer, keys, wheel);
        handleKeys(keys);
        handlePointer(pointer);
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        if (!overPanel(mouse.x, mouse.y)) navigation_.wheel(work_, wheel);
        const bool moved = navigation_.step(work_, *input_, seconds, ImGui::GetIO().WantTextInput);
        if (moved || frames_ == 0) {
            const EspCamera camera = work_.camera.camera(0);
            work_.perform(SetCamera{array(vec(camera.eye)), array(vec(camera.target)), camera.fovY});
        }
        showUi();
        const bool grew = update();
        if (coarse_ && !moved) work_.redraw = true;
        ++frames_;
        const bool last = options_.frames && frames_ >= options_.frames;
        if (!drawFrame(moved, last)) return false;
        session_.nextFrame();
        work_.frameMs = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
        const bool drew = image_->drew();
        work_.history.push_back({grew ? float(work_.stats.expandMs) : 0, drew ? float(work_.stats.emitMs) : 0,
                                 drew ? float(work_.stats.drawMs) : 0, float(work_.frameMs)});
        if (work_.history.size() > kHistory) work_.history.erase(work_.history.begin());
        const bool held = ImGui::IsAnyMouseDown() || ImGui::IsAnyItemActive() || navigation_.dragging();
        if (moved || held || wheel != 0 || !pointer.empty() || !keys.empty() || grew)
            wake();
        else if (awake_ > 0)
            --awake_;
        if (last) break;
    }
    session_.end(work_);
    if (!layoutFile_.empty()) writeLayout(work_.layout, work_.brush);
    if (host_->validationMessages())
        return fail(std::to_string(host_->validationMessages()) + " messages of the validation layer");
    // A user has seen the message; a script sees the exit code.
    if (options_.frames && !work_.error.empty()) return fail(work_.error);
    return true;
}

}  // namespace

int runApp(const AppOptions& options) {
    App app(options);
    return app.open() && app.loop() ? 0 : 1;
}

}  // namespace sample
