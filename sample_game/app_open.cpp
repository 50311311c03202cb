// From a command line to a window with a document in it, and on to the next document.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "sample_game/app_state.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/settings.hpp"
#include "sample_game/theme.hpp"
#include "tools/document/project.hpp"

namespace sample {

namespace fs = std::filesystem;
using espalier::document::Document;
using espalier::document::Work;

void WindowCloser::operator()(GLFWwindow* window) const {
    glfwDestroyWindow(window);
}

bool App::fail(const std::string& message) {
    std::fprintf(stderr, "espalier-sample: %s\n", message.c_str());
    return false;
}

App::~App() {
    dropReloaded();
    atlas_.reset();
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

namespace {

constexpr std::chrono::milliseconds kOpeningEvery{100};  // between two pictures of how far it is
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
    layoutFile_ = options_.frames || configFolder().empty() ? "" : configFolder() + "/windows.ini";
    if (layoutFile_.empty()) return;
    std::error_code ignored;
    fs::create_directories(configFolder(), ignored);
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

bool App::openDocument(const espalier::scene::Request& request, std::string& error) {
    EspHostDevice device{};
    device.getInstanceProcAddr = reinterpret_cast<void*>(vkGetInstanceProcAddr);
    device.instance = host_->instance();
    device.physicalDevice = host_->physicalDevice();
    device.device = host_->device();
    device.queue = host_->queue();
    device.queueFamily = host_->queueFamily();
    device.debugUtils = host_->validation();
    device.anisotropy = host_->anisotropy();
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
    const EspGrowingFn watch = [](void* app, uint64_t nodes) { return static_cast<App*>(app)->growing(nodes) ? 1 : 0; };
    (void)espWatchGrowth(made, watch, this);
    auto document = std::make_unique<Document>(made);
    const fs::file_time_type read = fs::file_time_type::clock::now();
    auto shown = std::chrono::steady_clock::now();
    espalier::scene::Request told = request;
    told.told = [&](const std::string& part, float share) {
        const auto now = std::chrono::steady_clock::now();
        if (now - shown > kOpeningEvery && showOpening(request.file, part, share)) shown = now;
    };
    const bool opened = document->open(told, error);
    dropClicks();
    if (!opened) return false;
    host_->waitIdle();
    if (work_.document) session_.end(work_);
    dropReloaded();
    viewsSeen_.clear();
    work_.document = std::move(document);
    work_.context = std::move(context);
    work_.selected.clear();
    work_.branch.reset();
    work_.path.clear();
    work_.forgetBarren();
    work_.house.reset();
    work_.houseEdge.reset();
    atlas_->forget();
    work_.plantGrammar = work_.openGrammar = work_.shownGrammar = 0;
    work_.brush.layer = work_.scene().layers.empty() ? "" : work_.scene().layers.front();
    work_.stats = {};
    work_.roofs = {};
    work_.grownMs = 0;
    work_.redraw = true;
    work_.grownRevision = ~0ull;
    pace_ = {};
    work_.message.clear();
    for (const std::string& note : work_.scene().notes) work_.message += (work_.message.empty() ? "" : "\n") + note;
    const bool whole = request.layers.empty() && request.grammar.empty() && !request.seed && request.times == 1;
    session_.begin(work_, request.file, read, whole);
    if (options_.frames) session_.autosaves().forgetRecovery(false);
    work_.start = work_.scene().camera;
    work_.lookFromStart();
    work_.fitBrush();
    retitle();
    return true;
}

// By what is open, which another name may have been saved under.
void App::retitle() {
    entitle("Espalier \u2014 " + session_.name(work_));
}

void App::entitle(const std::string& title) {
    if (std::exchange(title_, title) != title) glfwSetWindowTitle(window_.get(), title.c_str());
}

bool App::open() {
    recall();
    if (!openWindow()) return false;
    openUi();
    ui_ = std::make_unique<UiRenderer>(*host_);
    image_ = std::make_unique<SceneImage>(*host_);
    atlas_ = std::make_unique<AtlasView>(*host_);
    if (!ui_->create()) return fail(ui_->error());
    std::string error;
    if (!showOpening(options_.request.file)) return false;
    const bool run = Replay::names(options_.request.file);
    if (run && !replay_.read(options_.request.file, error)) return fail(error);
    if (run) options_.request.file = replay_.scene();
    if (!openDocument(options_.request, error)) return fail(error);
    if (!layoutError_.empty()) work_.error = layoutError_;
    work_.editing = options_.editor;
    if (run) beginReplay();
    session_.autosaveEvery = options_.autosave;
    if (options_.record.empty()) return true;
    bool records = false;
    session_.startRecording(work_, options_.record, uint32_t(options_.width), uint32_t(options_.height),
                            [&](bool good) { records = good; });
    session_.background().finish();
    return records || fail(work_.error);
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

// What is clicked while something is opened isn't meant for what will be there.
void App::dropClicks() {
    const size_t before = input_->gui.count();
    glfwPollEvents();
    input_->gui.dropPresses(before);
    (void)input_->takeWheel();
}

bool App::showOpening(const std::string& file, const std::string& part, float share) {
    dropClicks();
    const std::optional<Frame> frame = host_->begin();
    if (!frame) return host_->error().empty() || fail(host_->error());
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    closeDialogues();
    const std::string text = "Opening " + fs::path(file).filename().string() + " ...";
    const ImVec2 size = ImGui::GetIO().DisplaySize, extent = ImGui::CalcTextSize(text.c_str());
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const ImU32 light = IM_COL32(220, 225, 215, 255);
    const float line = 1.5f * ImGui::GetFontSize();
    list.AddText({(size.x - extent.x) / 2, size.y / 2}, light, text.c_str());
    if (!part.empty()) {
        const float left = size.x / 2 - 8 * line, top = size.y / 2 + line, high = .2f * line;
        list.AddRectFilled({left, top}, {left + 16 * line, top + high}, IM_COL32(60, 64, 58, 255));
        list.AddRectFilled({left, top}, {left + 16 * line * share, top + high}, IM_COL32(110, 160, 90, 255));
        const float width = ImGui::CalcTextSize(part.c_str()).x;
        list.AddText({(size.x - width) / 2, top + .5f * line}, IM_COL32(150, 155, 145, 255), part.c_str());
    }
    ImGui::Render();
    clear(*frame, {{.1f, .1f, .1f, 1}});
    return (ui_->draw(*frame, *ImGui::GetDrawData()) || fail(ui_->error())) &&
           (host_->end(*frame) || fail(host_->error()));
}

// Opened anew, a dialogue would be gone, and what is typed into it meant for the tools: that comes first.
void App::followModels() {
    if (!session_.reload && reloading_.kept.empty()) return;
    const bool waits = usesPanels();
    if (waits && !reloadWaits_) work_.message = "A model has changed on disk: it is read when you are done here";
    reloadWaits_ = waits;
    if (waits || !session_.idle()) return;
    if (session_.reload && session_.autosaves().recovery().empty()) reload();
    if (!reloading_.kept.empty() && !work_.busy && session_.idle()) openReloaded();
}

void App::dropReloaded() {
    std::error_code ignored;
    if (!reloading_.kept.empty()) fs::remove_all(fs::path(reloading_.kept).parent_path(), ignored);
    reloading_ = {};
}

// By way of a project, so that everything that was done stands; only undo doesn't reach behind it. It is saved beside
// the frames; what is done meanwhile isn't in it, so it is then saved again.
void App::reload() {
    session_.reload = false;
    std::error_code failed;
    const fs::path temporary = fs::temp_directory_path(failed);
    if (failed) {
        work_.error = "Not reloaded: TMPDIR is no folder";
        return;
    }
    const fs::path folder = temporary / ("espalier-reload-" + std::to_string(getpid()));
    const std::string kept = (folder / work_.scene().name).string();
    const auto state = std::make_shared<uint64_t>();
    session_.background().ask({"Reloading " + fs::path(session_.file()).filename().string(),
                               [this, kept, state] {
                                   *state = work_.document->state();
                                   return saving(*work_.document, kept);
                               },
                               [this, kept, state](const Work& over) {
                                   const bool done = over.state() == Work::State::done;
                                   std::error_code ignored;
                                   if (done)
                                       reloading_ = {kept, *state};
                                   else
                                       fs::remove_all(fs::path(kept).parent_path(), ignored);
                                   if (!over.error().empty()) work_.error = "Not reloaded: " + over.error();
                               }});
}

void App::openReloaded() {
    const auto [kept, state] = std::exchange(reloading_, {});
    const Session::Origin origin = session_.origin(work_);
    const Workspace::Hands hands = work_.hands();
    const bool recorded = session_.recording();
    session_.reload = state != work_.document->state();
    session_.goesOn = !session_.reload;
    work_.error.clear();
    if (session_.goesOn && showOpening(origin.autosaves.file) && openDocument({kept, {}, {}, {}}, work_.error)) {
        work_.takeUp(hands);
        session_.setOrigin(work_, origin);
        const std::string notes = std::exchange(work_.message, {});
        work_.message = "Its model has changed on disk: " + fs::path(origin.autosaves.file).filename().string() +
                        " was reloaded" + (recorded ? "; the recording has ended" : "") + (notes.empty() ? "" : "\n") +
                        notes;
    }
    session_.goesOn = false;
    std::error_code ignored;
    fs::remove_all(fs::path(kept).parent_path(), ignored);
}

// Asked for by a dialogue or dropped onto the window: what can't be opened leaves the old document.
bool App::openNext() {
    const std::string file = std::exchange(session_.openNext, {});
    if (!showOpening(file)) return false;
    work_.error.clear();
    const bool run = Replay::names(file);
    if ((!run || replay_.read(file, work_.error)) &&
        openDocument({run ? replay_.scene() : file, {}, {}, {}}, work_.error)) {
        if (run) beginReplay();
        return true;
    }
    replay_.forget();
    session_.givesUp = false;
    if (file == session_.autosaves().recovery())
        session_.autosaves().refuseRecovery(std::exchange(work_.error, {}));
    else
        askToOpen(file, work_.error);
    return true;
}

void App::beginReplay() {
    session_.replays(replay_.path());
    controls_->setEditing(true);
    controls_->forgetButtons();  // of the click that chose it: the replay takes all that the mouse does
    replay_.begin(glfwGetTime());
}

}  // namespace sample
