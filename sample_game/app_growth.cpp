// Growing what a frame has changed, and what is seen of growth that takes long.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <cmath>
#include <cstdio>
#include <utility>

#include "sample_game/app_state.hpp"
#include "sample_game/panels.hpp"

namespace sample {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kGrowing = "Growing ...  Esc stops it; drawing what has grown takes a moment more";
constexpr const char* kStopped =
    "Growth was stopped: plants stand as they were. Ctrl+Z takes back what asked for so much; with the next change all "
    "that is new grows.";

constexpr const char* kCut =
    "More would grow than the limit of nodes allows: all plants are cut short. Ctrl+Z takes back what asked for so "
    "much.";

double millisecondsSince(Clock::time_point then) {
    return std::chrono::duration<double, std::milli>(Clock::now() - then).count();
}

}  // namespace

bool App::update() {
    grownMs_ = 0;
    const bool changed = work_.document->revision() != work_.grownRevision || controls_->painting();
    const bool dragged = ImGui::IsMouseDown(0) && ImGui::IsAnyItemActive();
    const GrowthPace::Step step = pace_.next(changed, work_.growsWide, dragged, controls_->painting());
    if (step != GrowthPace::Step::grow) {
        showUnderWay(work_, step == GrowthPace::Step::wait ? "Grows when you let go" : kGrowing);
        wake();
        return false;
    }
    const uint32_t expansions = work_.stats.expansions;
    const uint64_t housesGrown = work_.roofs.housesGrown;
    work_.remedied(std::exchange(growthError_, {}));
    growth_ = {Clock::now(), input_->gui.count(), true, false};
    const EspResult grown = espUpdate(work_.context.get());
    growth_.underWay = false;
    if (growth_.told && grown == ESP_OK) entitle("Espalier \u2014 drawing what has grown");
    if (grown == ESP_STOPPED && growth_.told) pace_.grew(millisecondsSince(growth_.began), true);
    if (grown != ESP_OK)
        work_.error = growthError_ = grown == ESP_STOPPED ? kStopped : espLastError(work_.context.get());
    const bool known = work_.readStats();
    const bool plants = work_.stats.expansions != expansions, houses = work_.roofs.housesGrown != housesGrown;
    work_.noteGrown(plants);
    if (grown == ESP_OK) bakeForGraphs();
    if (!known) return false;
    grownMs_ = (plants ? work_.stats.expandMs : 0) + (houses ? work_.roofs.expandMs : 0);
    if (grown == ESP_OK && plants && work_.stats.cut > 0) work_.message = kCut;
    if (plants || houses) work_.grownMs = grownMs_;
    if (plants || houses) pace_.grew(grownMs_, plants && 2 * work_.stats.derivedNodes > work_.stats.nodes);
    work_.redraw |= plants || houses;
    return plants || houses;
}

// Now and then while plants grow within update(); elsewhere a frame may be half laid out. False: they are given up,
// which Esc asks for, and who ends the program; a run that is played again grows all.
bool App::growing(uint64_t nodes) {
    if (!growth_.underWay || millisecondsSince(growth_.began) < GrowthPace::kSlowMs) return true;
    glfwPollEvents();
    input_->gui.polled(glfwGetTime());
    if (!std::exchange(growth_.told, true)) showWaiting();
    char title[96];
    std::snprintf(title, sizeof title, "Espalier \u2014 growing: %.1f million nodes; Esc stops", double(nodes) * 1e-6);
    entitle(title);
    return replay_.on() ||
           !(input_->gui.takeEscape(growth_.events) || glfwWindowShouldClose(window_.get()) || endAsked());
}

// The last picture, the panels as this frame has them, and that something grows.
void App::showWaiting() {
    showUnderWay(work_, kGrowing);
    const std::optional<Frame> frame = host_->begin();
    if (!frame) return;
    image_->showAgain(*frame, margins(*frame));
    ImGui::Render();
    if (ui_->draw(*frame, *ImGui::GetDrawData())) (void)host_->end(*frame);
}

}  // namespace sample
