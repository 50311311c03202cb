// From a command line to a window with a document in it, and on to the next document.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "plugin_api/espalier.hpp"
#include "sample_game/additions.hpp"
#include "sample_game/app_state.hpp"
#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/settings.hpp"
#include "tools/scene/scene_file.hpp"
#include "tools/scene/user_folders.hpp"

namespace sample {

namespace fs = std::filesystem;
using espalier::document::Document;

bool App::fail(const std::string& message) {
    std::fprintf(stderr, "espalier-sample: %s\n", message.c_str());
    return false;
}

App::~App() {
    dropReloaded();
    atlas_.reset();
    pictures_.reset();
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

}  // namespace

bool App::openDocument(const espalier::scene::Request& request, std::string& error) {
    EspHostDevice device{};
    device.getInstanceProcAddr = reinterpret_cast<void*>(vkGetInstanceProcAddr);
    device.instance = host_->instance();
    device.physicalDevice = host_->physicalDevice();
    device.device = host_->device();
    device.queue = host_->queue();
    device.queueFamily = host_->queueFamily();
    device.debugUtils = host_->validation();
    device.deviceInfo = &host_->deviceInfo();
    EspContextDef def = esp::defaults<EspContextDef>();
    def.host = &device;
    const std::string cache = espalier::scene::cacheFolder();
    if (!cache.empty()) def.cacheFolder = cache.c_str();
    def.log = [](void*, EspLogLevel level, const char* message) {
        if (level == ESP_LOG_WARNING) std::fprintf(stderr, "espalier-sample: warning: %s\n", message);
    };
    // The old document stays until the new one is there.
    EspContext* made = nullptr;
    if (espCreate(ESP_VERSION, &def, &made) != ESP_OK) {
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
    controls_->forgetScene();
    atlas_->forget();
    work_.graphs.open = 0;
    work_.graphs.playing = false;
    work_.graphs.nodes = work_.scene().surfaces.empty() && !work_.scene().graphs.empty();
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
    retitle();
    return true;
}

// By what is open, which another name may have been saved under, and whether all of it is.
void App::retitle() {
    entitle("Espalier \u2014 " + session_.name(work_) + (session_.modified(work_) ? " *" : ""));
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
    pictures_ = std::make_unique<ShownPictures>(*host_);
    work_.pictureOf = [this](const std::string& file, float& aspect) { return pictures_->of(file, aspect); };
    if (!ui_->create()) return fail(ui_->error());
    std::string error;
    if (!work_.layout.recent.empty()) beginOpeningIn(work_.layout.recent.front());
    if (!showOpening(options_.request.file)) return false;
    const bool run = Replay::names(options_.request.file);
    if (run && !replay_.read(options_.request.file, error)) return fail(error);
    if (run) options_.request.file = replay_.scene();
    if (!openDocument(options_.request, error)) return fail(error);
    work_.fitBrush();
    noteRecent(options_.request.file);
    if (!layoutError_.empty()) work_.error = layoutError_;
    work_.editing = options_.editor;
    if (run) beginReplay();
    addModels(work_, session_, options_.models);
    if (options_.frames) session_.background().finish();
    session_.autosaveEvery = options_.autosave;
    if (options_.record.empty()) return true;
    bool records = false;
    session_.startRecording(work_, options_.record, uint32_t(options_.width), uint32_t(options_.height),
                            [&](bool good) { records = good; });
    session_.background().finish();
    return records || fail(work_.error);
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

// Neither what is there anyway nor what was recovered.
void App::noteRecent(const std::string& file) {
    const fs::path whole = wholePath(file);
    const bool own = whole == emptyScene() || whole.filename() == espalier::scene::kAutosaveFile;
    if (!layoutFile_.empty() && !own) work_.layout.noteRecent(whole.string());
}

// Asked for by a dialogue or dropped onto the window: what can't be opened leaves the old document.
bool App::openNext() {
    const std::string file = std::exchange(session_.openNext, {});
    if (!showOpening(file)) return false;
    work_.error.clear();
    const bool run = Replay::names(file);
    if ((!run || replay_.read(file, work_.error)) &&
        openDocument({run ? replay_.scene() : file, {}, {}, {}}, work_.error)) {
        work_.fitBrush();
        noteRecent(file);
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
