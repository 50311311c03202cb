// The sample game: a host that has a window, a device and a frame loop, and lets Espalier draw into its frames.
// It draws only when something has changed, so that a still scene leaves the machine alone.
#define GLFW_INCLUDE_NONE
#include "sample_game/app.hpp"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <random>

#include "sample_game/orbit_camera.hpp"
#include "sample_game/panel.hpp"
#include "sample_game/theme.hpp"
#include "sample_game/ui_renderer.hpp"
#include "sample_game/vulkan_host.hpp"
#include "tools/document/document.hpp"
#include "tools/scene/picture.hpp"

namespace sample {
namespace {

using espalier::document::Action;
using espalier::document::Document;
using espalier::document::SeedRecord;
using espalier::scene::Scene;
namespace fs = std::filesystem;

constexpr double kSlowDrawMs = 50;
constexpr int kFramesAfterChange = 3;       // ImGui settles within two
constexpr double kFilesLookedAtEvery = .3;  // seconds

// The newest change among the grammars of a folder: an included file counts too.
fs::file_time_type newestGrammar(const fs::path& file) {
    fs::file_time_type newest = fs::file_time_type::min();
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(file.parent_path().empty() ? "." : file.parent_path(), ignored))
        if (entry.path().extension() == ".grammar" || entry.path() == file)
            newest = std::max(newest, entry.last_write_time(ignored));
    return newest;
}

// What came in since the last frame. Frames may take long on a software device, and ImGui only knows what is down at
// the moment a frame begins: what was pressed and let go in between would be lost.
struct Events {
    struct Click {
        double x, y;
    };
    std::vector<int> keys;
    std::vector<Click> clicks;  // of the left button, without a drag
    double pressX = 0, pressY = 0;
    bool moved = false;

    static Events& of(GLFWwindow* window) { return *static_cast<Events*>(glfwGetWindowUserPointer(window)); }
    static void onKey(GLFWwindow* window, int key, int, int action, int) {
        if (action == GLFW_PRESS) of(window).keys.push_back(key);
    }
    static void onMove(GLFWwindow* window, double x, double y) {
        Events& events = of(window);
        if (std::abs(x - events.pressX) + std::abs(y - events.pressY) > 4) events.moved = true;
    }
    static void onButton(GLFWwindow* window, int button, int action, int) {
        Events& events = of(window);
        if (action == GLFW_PRESS) {
            glfwGetCursorPos(window, &events.pressX, &events.pressY);
            events.moved = false;
        } else if (button == GLFW_MOUSE_BUTTON_LEFT && !events.moved && !ImGui::GetIO().WantCaptureMouse) {
            events.clicks.push_back({events.pressX, events.pressY});
        }
    }
    bool pressed(int key) const { return std::find(keys.begin(), keys.end(), key) != keys.end(); }
};

// Where compiled grammars are kept between runs; empty where the system names no place for that.
std::string cacheFolder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return std::string(cache) + "/espalier";
    if (const char* home = std::getenv("HOME"); home && *home) return std::string(home) + "/.cache/espalier";
    return {};
}

struct WindowCloser {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};

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
    bool openContext();
    void openUi();
    void handleKeys();
    void handleMouse();
    void plantAt(double x, double y);
    void answerPanel();
    void perform(const Action& action, uint32_t gesture = 0);
    const Scene& scene() const { return document_->scene(); }
    void watchGrammars();
    void updateGrowth();
    bool drawFrame(bool last);
    void screenshot(const std::string& path, const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height);
    void wake() { awake_ = kFramesAfterChange; }
    std::string& generalError() { return panel_.errors.back(); }
    float reach() const;
    void look(const EspCamera& camera);
    // So that what is looked at stands in the middle of what the panel leaves free.
    float shift() const { return panelWidth(scale_, panel_) / std::max(1.f, ImGui::GetIO().DisplaySize.x); }

    AppOptions options_;
    bool glfw_ = false;
    std::unique_ptr<GLFWwindow, WindowCloser> window_;
    std::unique_ptr<VulkanHost> host_;
    std::unique_ptr<EspContext, void (*)(EspContext*)> context_{nullptr, espDestroy};
    std::unique_ptr<UiRenderer> ui_;
    bool imgui_ = false;
    float scale_ = 1;
    std::unique_ptr<Document> document_;
    std::vector<SeedRecord> sceneSeeds_;
    std::vector<fs::file_time_type> grammarTimes_;
    double nextLook_ = 0;
    OrbitCamera orbit_;
    PanelState panel_;
    int awake_ = kFramesAfterChange;
    uint64_t frames_ = 0;
    Events events_;
    bool dragging_ = false;
};

App::~App() {
    ui_.reset();
    document_.reset();
    context_.reset();
    host_.reset();
    if (imgui_) {
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    window_.reset();
    if (glfw_) glfwTerminate();
}

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

bool App::openContext() {
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
    EspContext* made = nullptr;
    if (espCreate(&def, &made) != ESP_OK) return fail(espLastError(nullptr));
    context_.reset(made);
    std::string error;
    document_ = std::make_unique<Document>(made);
    if (!document_->open(options_.request, error)) return fail(error);
    for (const auto& seed : scene().seeds) sceneSeeds_.push_back(document_->recordOf(seed));
    for (const auto& grammar : scene().grammars) grammarTimes_.push_back(newestGrammar(grammar.file));
    panel_.deviceName = espDeviceName(made);
    panel_.errors.resize(scene().grammars.size() + 1);
    panel_.look = scene().look;
    panel_.grow = espDefaultGrowDef();
    panel_.validation = host_->validation();
    glfwSetWindowTitle(window_.get(), ("Espalier \u2014 " + scene().name).c_str());
    return true;
}

void App::openUi() {
    ImGui::CreateContext();
    imgui_ = true;
    ImGui::GetIO().IniFilename = nullptr;  // nothing is left behind in the folder it was started from
    // Ours first: ImGui's backend calls on to what was there before it.
    glfwSetWindowUserPointer(window_.get(), &events_);
    glfwSetKeyCallback(window_.get(), Events::onKey);
    glfwSetMouseButtonCallback(window_.get(), Events::onButton);
    glfwSetCursorPosCallback(window_.get(), Events::onMove);
    ImGui_ImplGlfw_InitForVulkan(window_.get(), true);
    float y = 1;
    glfwGetWindowContentScale(window_.get(), &scale_, &y);
    applyTheme(scale_);
}

bool App::open() {
    if (!openWindow() || !openContext()) return false;
    openUi();
    ui_ = std::make_unique<UiRenderer>(*host_);
    return ui_->create() || fail(ui_->error());
}

float App::reach() const {
    EspSurfaceInfo info;
    if (espSurfaceInfo(context_.get(), scene().surfaces.front().id, &info) != ESP_OK) return 1;
    float sum = 0;
    for (int i = 0; i < 3; ++i) sum += std::pow(info.boundsMax[i] - info.boundsMin[i], 2.f);
    return std::sqrt(sum);
}

// From a little further away than the camera says, since the panel takes a part of the picture's width.
void App::look(const EspCamera& camera) {
    EspCamera further = camera;
    const float free = std::clamp(1 - shift(), .4f, 1.f);
    for (int i = 0; i < 3; ++i) further.eye[i] = camera.target[i] + (camera.eye[i] - camera.target[i]) / free;
    orbit_.set(further, reach());
}

void App::handleKeys() {
    const ImGuiIO& io = ImGui::GetIO();
    const auto pressed = [&](int key) { return events_.pressed(key); };
    if (pressed(GLFW_KEY_F1)) panel_.showHelp = !panel_.showHelp;
    if (pressed(GLFW_KEY_F2)) panel_.showPanel = !panel_.showPanel;
    if (pressed(GLFW_KEY_F12)) panel_.screenshot = true;
    if (io.WantTextInput) return;
    const bool control = io.KeyCtrl || pressed(GLFW_KEY_LEFT_CONTROL) || pressed(GLFW_KEY_RIGHT_CONTROL);
    if (control && pressed(GLFW_KEY_Q)) glfwSetWindowShouldClose(window_.get(), GLFW_TRUE);
    if (control || io.KeyAlt || io.KeySuper) return;
    if (pressed(GLFW_KEY_ESCAPE)) {
        // Never quits: first closes the help, then puts the tool away.
        if (panel_.showHelp)
            panel_.showHelp = false;
        else
            panel_.tool = Tool::look;
    }
    if (pressed(GLFW_KEY_Q)) panel_.tool = Tool::look;
    if (pressed(GLFW_KEY_S)) panel_.tool = Tool::plant;
    if (pressed(GLFW_KEY_R)) panel_.newNumbers = true;
    if (pressed(GLFW_KEY_F)) panel_.frameAll = true;
    for (int i = 0; i < 4; ++i)
        if (pressed(GLFW_KEY_1 + i)) panel_.look.view = EspView(i);
}

void App::handleMouse() {
    const ImGuiIO& io = ImGui::GetIO();
    const bool buttons[3] = {io.MouseDown[0], io.MouseDown[1], io.MouseDown[2]};
    const bool down = buttons[0] || buttons[1] || buttons[2];
    if (!down)
        dragging_ = false;
    else if (!io.WantCaptureMouse)
        dragging_ = true;
    if (dragging_ && events_.moved) {
        const float x = io.MouseDelta.x / io.DisplaySize.y, y = io.MouseDelta.y / io.DisplaySize.y;
        if (buttons[1] || io.KeyShift)
            orbit_.pan(x, y);
        else
            orbit_.turn(x, y);
    }
    if (panel_.tool == Tool::plant)
        for (const Events::Click& click : events_.clicks) plantAt(click.x, click.y);
    if (io.MouseWheel != 0 && !io.WantCaptureMouse) orbit_.zoom(io.MouseWheel);
}

void App::plantAt(double x, double y) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const Ray ray = orbit_.ray(float(x) / size.x, float(y) / size.y, size.x / size.y, shift());
    EspHit hit;
    if (espPick(context_.get(), ray.origin, ray.direction, &hit) != ESP_OK) return;
    const SeedRecord seed{document_->freshKey(),
                          uint32_t(panel_.plantGrammar),
                          {hit.position[0], hit.position[1], hit.position[2]},
                          {0, 1, 0},
                          std::random_device()()};
    perform(espalier::document::AddSeeds{{seed}, {uint32_t(scene().seeds.size())}});
}

void App::perform(const Action& action, uint32_t gesture) {
    generalError().clear();
    document_->perform(action, generalError(), gesture);
    wake();
}

void App::answerPanel() {
    using namespace espalier::document;
    std::vector<SeedRecord> seeds;
    RemoveSeeds all;
    for (const auto& seed : scene().seeds) {
        seeds.push_back(document_->recordOf(seed));
        all.keys.push_back(seed.key);
    }
    if (panel_.newNumbers) {
        std::random_device random;
        for (SeedRecord& seed : seeds) seed.number = random();
        perform(ChangeSeeds{seeds});
    }
    if (panel_.clearSeeds) perform(all);
    if (panel_.sceneSeeds) {
        AddSeeds add{sceneSeeds_, {}};
        for (SeedRecord& seed : add.seeds) {
            seed.key = document_->freshKey();
            add.places.push_back(uint32_t(add.places.size()));
        }
        const uint32_t gesture = uint32_t(document_->revision()) + 1;
        perform(all, gesture);
        perform(add, gesture);
    }
    if (panel_.frameAll) look(espFrameAll(context_.get()));
    if (panel_.newNumbers || panel_.clearSeeds || panel_.sceneSeeds || panel_.frameAll || panel_.paramsChanged) wake();
    panel_.newNumbers = panel_.clearSeeds = panel_.sceneSeeds = panel_.frameAll = panel_.paramsChanged = false;
    if (espSetGrow(context_.get(), &panel_.grow) != ESP_OK) generalError() = espLastError(context_.get());
}

void App::watchGrammars() {
    if (glfwGetTime() < nextLook_) return;
    nextLook_ = glfwGetTime() + kFilesLookedAtEvery;
    for (size_t i = 0; i < scene().grammars.size(); ++i) {
        const fs::file_time_type time = newestGrammar(scene().grammars[i].file);
        if (time == grammarTimes_[i]) continue;
        grammarTimes_[i] = time;
        std::string text, error;
        if (espalier::scene::readText(scene().grammars[i].file, text, error))
            perform(document_->withText(uint32_t(i), text));
        panel_.errors[i] = error.empty() ? scene().grammars[i].error : error;
        wake();
    }
}

void App::updateGrowth() {
    if (espUpdate(context_.get()) != ESP_OK) generalError() = espLastError(context_.get());
    EspStats stats;
    if (espReadStats(context_.get(), &stats) == ESP_OK) panel_.stats = stats;
    panel_.validationMessages = host_->validationMessages();
}

void App::screenshot(const std::string& path, const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
    std::string error;
    if (espalier::scene::writePng(path, rgba.data(), width, height, error))
        panel_.message = "Written: " + path;
    else
        generalError() = error;
    wake();
}

bool App::drawFrame(bool last) {
    const std::optional<Frame> frame = host_->begin();
    if (!frame) {
        if (!host_->error().empty()) return fail(host_->error());
        if (ImGui::GetFrameCount()) ImGui::EndFrame();
        glfwWaitEventsTimeout(.05);  // minimised, or about to be resized
        return true;
    }
    EspDrawDef draw = espDefaultDrawDef();
    draw.width = frame->extent.width;
    draw.height = frame->extent.height;
    draw.camera = orbit_.camera(shift());
    draw.look = panel_.look;
    draw.look.viewLayer = panel_.viewLayer.c_str();
    // While the camera moves on a slow device, less detail: what counts then is that it follows the hand.
    if (dragging_ && panel_.stats.drawMs > kSlowDrawMs) draw.look.windowLodPixels *= 4;
    draw.commandBuffer = frame->commands;
    draw.colourImage = reinterpret_cast<void*>(frame->image);
    draw.colourView = reinterpret_cast<void*>(frame->view);
    draw.colourFormat = host_->format();
    draw.frame = frame->number;
    draw.framesDone = frame->finished;
    if (espDraw(context_.get(), &draw) != ESP_OK) return fail(espLastError(context_.get()));
    ImGui::Render();
    if (!ui_->draw(*frame, *ImGui::GetDrawData())) return fail(ui_->error());

    VulkanHost::TakePicture take;
    std::string path = last ? options_.screenshot : "";
    if (panel_.screenshot && path.empty())
        for (int i = 1; path.empty() || fs::exists(path); ++i) path = "espalier-" + std::to_string(i) + ".png";
    if (!path.empty())
        take = [&](const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
            screenshot(path, rgba, width, height);
        };
    panel_.screenshot = false;
    return host_->end(*frame, take) || fail(host_->error());
}

bool App::loop() {
    using Clock = std::chrono::steady_clock;
    while (!glfwWindowShouldClose(window_.get())) {
        // Asleep until the user does something, or it is time to look at the grammars' files.
        if (awake_ > 0 || options_.frames) {
            glfwPollEvents();
        } else {
            const double asleep = glfwGetTime();
            glfwWaitEventsTimeout(kFilesLookedAtEvery);
            if (glfwGetTime() - asleep < .9 * kFilesLookedAtEvery) wake();
        }
        const auto begin = Clock::now();
        watchGrammars();
        if (awake_ == 0 && !options_.frames) continue;

        float scale = 1, y = 1;
        glfwGetWindowContentScale(window_.get(), &scale, &y);
        if (scale != scale_ && scale > 0) {
            scale_ = scale;
            applyTheme(scale_);
            if (!ui_->updateFonts()) return fail(ui_->error());
            wake();
        }
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
        if (frames_ == 0) look(scene().camera);
        handleKeys();
        handleMouse();
        const bool happened = !events_.keys.empty() || !events_.clicks.empty();
        events_.keys.clear();
        events_.clicks.clear();
        showPanel(context_.get(), scene(), scale_, panel_);
        answerPanel();
        updateGrowth();
        ++frames_;
        const bool last = options_.frames && frames_ >= options_.frames;
        if (!drawFrame(last)) return false;
        panel_.frameMs = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
        const ImGuiIO& io = ImGui::GetIO();
        const bool input = happened || io.MouseDelta.x != 0 || io.MouseDelta.y != 0 || io.MouseWheel != 0 ||
                           io.MouseDown[0] || io.MouseDown[1] || io.MouseDown[2] || ImGui::IsAnyItemActive();
        if (input)
            wake();
        else if (awake_ > 0)
            --awake_;
        if (last) break;
    }
    if (host_->validationMessages())
        return fail(std::to_string(host_->validationMessages()) + " messages of the validation layer");
    // A user has seen the message in the panel; a script sees the exit code.
    if (options_.frames && !generalError().empty()) return fail(generalError());
    return true;
}

}  // namespace

int runApp(const AppOptions& options) {
    App app(options);
    return app.open() && app.loop() ? 0 : 1;
}

}  // namespace sample
