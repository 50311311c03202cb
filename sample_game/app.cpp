// The sample game and its editor: a host that has a window, a device and a frame loop, and lets Espalier draw into its
// frames. It draws only when something has changed, so that a still scene leaves the machine alone.
#define GLFW_INCLUDE_NONE
#include "sample_game/app.hpp"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "plugin_api/espalier.hpp"
#include "sample_game/additions.hpp"
#include "sample_game/app_state.hpp"
#include "sample_game/folder_list.hpp"
#include "sample_game/graph_editor.hpp"
#include "sample_game/panels.hpp"
#include "tools/scene/picture.hpp"

namespace sample {
namespace {

using namespace espalier::document;
namespace fs = std::filesystem;

constexpr double kLookEvery = .3, kLookAtWorkEvery = .05, kWaking = 1 / 60.;  // seconds
constexpr double kNewsSeconds = 12;                                           // that a message is shown
constexpr double kWindMs = 50;      // where a picture takes longer, the wind goes on only with what is drawn anyway
constexpr size_t kHistory = 240;    // frames in the graph
constexpr float kTurnDegrees = 2;   // a frame
constexpr uint64_t kSettling = 60;  // frames in which detail and size follow the time

}  // namespace

void App::showUi() {
    work_.followLayers();
    const bool asks = dialogueAsked() || !session_.autosaves().recovery().empty();
    if (!work_.editing && asks) controls_->setEditing(true);  // where it can be answered
    if (!work_.editing) closeDialogues();
    if (work_.editing) {
        controls_->showTool(input_->mods());
        showMenu(work_, session_);
        showPanel(work_);
        showGrammarWindow(work_);
        showGraphs(work_);
        atlas_->show(work_);
        showLegend(work_);
        showManualAndAbout(work_);
        showFigures(work_, host_->validationMessages(), host_->validation());
    }
    showStatus(work_, controls_->caught(), controls_->flying());
    showBackground(work_, session_.background());
    showHelp(work_);
    if (work_.editing) showDialogues(work_, session_);
    work_.followLayers();  // what is seen may have lost its layer by what was done just now
    if (work_.windowsAnew > 0) --work_.windowsAnew;
}

void App::screenshot(const std::string& path, const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
    if (espalier::scene::writePng(path, rgba.data(), width, height, work_.error))
        work_.message = "Written: " + wholePath(path);
    wake();
}

SceneImage::Margins App::margins(const Frame& frame) const {
    const auto pixels = [](float share, uint32_t of) { return uint32_t(std::lround(share * float(of))); };
    return {pixels(work_.shift(), frame.extent.width),
            pixels(work_.dockUnits() / std::max(1.f, work_.window.y), frame.extent.height)};
}

bool App::drawFrame(bool moving, bool grew, bool last) {
    // Of a moving camera the next picture is recorded while the last is drawn, if the device is slow; a stroke's
    // picture is of its own frame.
    const bool overlaps = moving && moving_.coarse() && !grew && !last && !controls_->painting();
    const std::optional<Frame> frame = host_->begin(overlaps);
    if (!frame) {
        if (!host_->error().empty()) return fail(host_->error());
        ImGui::EndFrame();
        glfwWaitEventsTimeout(.05);  // minimised, or about to be resized
        work_.redraw = true;
        return true;
    }
    esp::DrawDef draw;
    draw.camera = work_.camera.camera();
    draw.look = work_.scene().look;
    draw.look.shadowsLag = 1;
    draw.look.viewLayer = work_.scene().viewLayer.c_str();
    draw.look.viewOpacity = work_.layout.layerOpacity;
    draw.look.viewLevel = work_.viewLevel;
    draw.look.clock = glfwGetTime();
    EspBrush brush;
    if (std::optional limiting = limitingStroke(work_); limiting_ != limiting) {
        limiting_ = std::move(limiting);
        work_.redraw = true;
    }
    if (limiting_ && brushOf(*limiting_, brush, work_.error)) draw.look.viewBrush = &brush;
    // While the camera moves, or a stroke goes on, on a slow device, less detail.
    const float scale =
        moving_.prepare(draw.look, moving && !last, work_.stats.drawMs, work_.layout.smallerWhileMoving);
    const SceneImage::Margins margins = this->margins(*frame);
    // What draws a view is made when it is first shown, which may take seconds: the frame before says so.
    const bool announces = viewsSeen_.insert(draw.look.view).second && viewsSeen_.size() > 1 && !last;
    if (announces) {
        showUnderWay(work_, "Preparing this view ...");
        image_->showAgain(*frame, margins);
        work_.redraw = true;
        wake();
    } else {
        SceneImage::Wish wish{margins, scale, work_.redraw};
        wish.coarse = moving_.hurried();
        wish.fades = !last;
        wish.refines = idle_ || options_.frames;
        wish.now = glfwGetTime();
        if (!image_->show(work_.context.get(), *frame, draw, wish)) return fail(image_->error());
    }
    if (image_->drew()) {
        work_.redraw = work_.readStats() && (work_.stats.modelsFading > 0 || work_.stats.shadowsBehind ||
                                             (work_.blows() && work_.stats.drawMs < kWindMs));
        moving_.drew(work_.frameMs, uint32_t(work_.stats.drawnLeaves), controls_->painting());
    }
    ImGui::Render();
    if (!ui_->draw(*frame, *ImGui::GetDrawData())) return fail(ui_->error());

    VulkanHost::TakePicture take;
    std::string path = last ? options_.screenshot : "";
    std::error_code unknown;
    if (work_.screenshot && path.empty())
        for (int i = 1; path.empty() || fs::exists(fs::symlink_status(path, unknown)); ++i)
            path = "espalier-" + std::to_string(i) + ".png";
    if (!path.empty())
        take = [&](const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height, const std::string& error) {
            if (error.empty()) return screenshot(path, rgba, width, height);
            work_.error = path + ": no picture was taken: " + error;
        };
    work_.screenshot = false;
    return host_->end(*frame, take) || fail(host_->error());
}

// A column for each picture. What its stages took is known once it is finished: by the next frame on a software device,
// elsewhere a frame or two later.
void App::noteTimes() {
    if (std::exchange(timesAwaited_, false) && work_.readStats() && !work_.history.empty()) {
        work_.history.back()[1] = float(work_.stats.emitMs);
        work_.history.back()[2] = float(work_.stats.drawMs);
    }
    if (!image_->drew()) return;
    work_.pictureMs = work_.frameMs;
    work_.history.push_back({float(grownMs_), 0, 0, float(work_.frameMs)});
    if (work_.history.size() > kHistory) work_.history.erase(work_.history.begin());
    timesAwaited_ = true;
}

// News of one line goes after a while, so that the hints have their room again.
void App::fadeNews() {
    const double now = ImGui::GetTime();
    if (news_ != work_.message) news_ = work_.message, newsBegan_ = now;
    if (now - newsBegan_ > kNewsSeconds && news_.find('\n') == std::string::npos) work_.message.clear();
}

// False: the view stays. The last frame is a whole picture, which nothing moves in.
bool App::turn() {
    if (!options_.turn || frames_ + 1 >= options_.frames) return false;
    if (frames_ == kSettling) turnBegan_ = {std::chrono::steady_clock::now(), std::clock()};
    work_.camera.turnBy(kTurnDegrees * 0.0174533f, 0);
    return true;
}

void App::tellTurn() const {
    const double frames = double(frames_ - kSettling);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - turnBegan_.at;
    std::printf("%.1f frames/s: %.1f ms a frame, %.1f of CPU time; %llu leaves and %.0f %% of the width in the last\n",
                1e3 * frames / took.count(), took.count() / frames,
                double(std::clock() - turnBegan_.cpu) * 1e3 / CLOCKS_PER_SEC / frames,
                static_cast<unsigned long long>(work_.stats.drawnLeaves), double(100 * moving_.share()));
}

void App::endReplay() {
    if (replay_.on()) replay_.stop(work_);
    ImGui::GetIO().ConfigFlags &= ~ImGuiConfigFlags_NoMouse;
    session_.endReplay();
}

// A run's next step in place of what the user does, who can only end it. False: no run is on.
bool App::replay(std::vector<InputEvent>& events) {
    if (!replay_.on()) return false;
    const bool ends = std::ranges::any_of(events, [](const InputEvent& event) {
        const auto* key = std::get_if<KeyEvent>(&event);
        return key && key->key == GLFW_KEY_ESCAPE;
    });
    events.clear();
    ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NoMouse;
    if (!ends && replay_.step(work_, glfwGetTime())) return true;
    endReplay();
    if (options_.frames)
        session_.autosaves().forgetRecovery(false), session_.givesUp = true;  // nobody is there to be asked
    return true;
}

// The window's own button asks as Ctrl+Q does. Clicked twice it ends at once, and what isn't saved is kept.
bool App::closing() {
    if (session_.quit) return true;
    if (!glfwWindowShouldClose(window_.get())) return false;
    if (replay_.on() && !options_.frames) endReplay();  // so that what is asked can be answered
    if (sliderWaits()) {                                // what it is to have counts
        leaveFields();
        wake();
        return false;
    }
    if (asksToQuit() || options_.frames || !session_.modified(work_)) return true;
    glfwSetWindowShouldClose(window_.get(), GLFW_FALSE);
    controls_->askToQuit();
    wake();
    return false;
}

// What the user did, what follows from it, and the picture of that.
bool App::frame(float seconds) {
    using Clock = std::chrono::steady_clock;
    const auto begin = Clock::now();
    if (!session_.openNext.empty() && session_.idle() && !openNext()) return false;
    followModels();
    if (!rescale()) return false;
    std::vector<InputEvent> events;
    ImGui_ImplGlfw_NewFrame();
    input_->gui.feed(events);
    ImGui::NewFrame();
    work_.window = {ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y};
    beginGesture(work_);
    const float wheel = input_->takeWheel();
    const bool replays = replay(events);
    if (!replays) controls_->take(events, wheel);
    const bool moved = !replays && (controls_->step(*input_, seconds) | turn());
    if (moved || frames_ == 0) {
        const EspCamera camera = work_.camera.camera();
        work_.perform(SetCamera{array(vec(camera.eye)), array(vec(camera.target)), camera.fovY});
    }
    if (const std::vector<std::string> files = input_->takeDropped(); !files.empty() && !replays) {
        if (!work_.editing) controls_->setEditing(true);  // where it can be asked about
        controls_->finishTools();
        takeDropped(work_, session_, files);
    }
    if (!replays) playGraphs(work_, glfwGetTime());
    fadeNews();
    showUi();
    retitle();
    const bool grew = update();
    if (moving_.coarse() && !moved && !controls_->painting()) work_.redraw = true;
    ++frames_;
    const bool plays = work_.graphs.playing;
    const bool hurried = moved || controls_->painting() || plays;
    if (!drawFrame(hurried, grew || plays, options_.frames && frames_ >= options_.frames)) return false;
    session_.nextFrame(work_);
    work_.frameMs = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    noteTimes();
    const bool held = image_->fading(glfwGetTime()) || ImGui::IsAnyMouseDown() || ImGui::IsAnyItemActive() ||
                      toolTipWaits() || clickWaits() || controls_->turning() || input_->gui.waiting();
    if (moved || held || replays || plays || wheel != 0 || !events.empty() || grew)
        wake();
    else if (awake_ > 0)
        --awake_;
    return true;
}

namespace {

// Who ends the program from outside, as a desktop does when its user logs out, loses nothing. A second time it ends at
// once.
volatile std::sig_atomic_t ended = 0;
void heedEnd() {
    struct sigaction action {};
    action.sa_handler = [](int) { ended = 1; };
    action.sa_flags = SA_RESETHAND;
    for (int signal : {SIGTERM, SIGINT, SIGHUP}) sigaction(signal, &action, nullptr);
}

}  // namespace

bool App::endAsked() {
    return ended != 0;
}

// Of the context first: what a software device is given back is the process's own memory.
void App::giveBack() {
    (void)espTrim(work_.context.get());
    (void)malloc_trim(0);
}

bool App::loop() {
    heedEnd();
    double before = glfwGetTime();
    while (!closing() && !endAsked() && !(options_.frames && frames_ >= options_.frames)) {
        // Asleep until the user does something, or it is time to look at the grammars' files. Before that, the picture
        // becomes as smooth as it can.
        idle_ = awake_ == 0 && image_->refinable();
        if (awake_ > 0 || idle_ || options_.frames) {
            glfwPollEvents();
            if (idle_ && input_->pending()) wake(), idle_ = false;
        } else {
            const double asleep = glfwGetTime(), most = session_.background().busy() ? kLookAtWorkEvery : kLookEvery;
            glfwWaitEventsTimeout(most);
            if (input_->pending() || glfwGetTime() - asleep < .9 * most) wake();
            before = std::max(before, glfwGetTime() - kWaking);  // what is held now wasn't all the while
        }
        const double now = glfwGetTime();
        input_->gui.polled(now);
        const float seconds = float(std::min(now - before, .5));
        before = now;
        if (session_.step(work_, now)) wake();
        if (awake_ == 0 && !idle_ && !options_.frames) {
            if (rest_.due(now)) giveBack();
            continue;
        }
        if (options_.turn && frames_ + 1 == options_.frames) tellTurn();
        if (!frame(seconds)) {
            rescue();
            return false;
        }
        rest_.drew(glfwGetTime());
    }
    const std::string shown = std::exchange(work_.error, {});
    session_.end(work_);
    keepLayout();
    if (host_->validationMessages())
        return fail(std::to_string(host_->validationMessages()) + " messages of the validation layer");
    // What the end itself says nobody sees in the window; what was shown there a script hasn't seen.
    const std::string& told = work_.error.empty() && options_.frames ? shown : work_.error;
    return told.empty() || fail(told);
}

void App::rescue() noexcept {
    try {
        work_.error.clear();
        if (work_.document) session_.end(work_);
        if (!work_.error.empty()) fail(work_.error);
    } catch (...) {  // what ended the program is told
    }
}

int runApp(const AppOptions& options) {
    App app(options);
    try {
        return app.open() && app.loop() ? 0 : 1;
    } catch (...) {
        app.rescue();
        throw;
    }
}

}  // namespace sample
