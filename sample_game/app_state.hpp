#pragma once

#include <chrono>
#include <ctime>
#include <memory>
#include <set>
#include <string>

#include "sample_game/app.hpp"
#include "sample_game/atlas_view.hpp"
#include "sample_game/controls.hpp"
#include "sample_game/growth_pace.hpp"
#include "sample_game/replay.hpp"
#include "sample_game/rest.hpp"
#include "sample_game/scene_image.hpp"
#include "sample_game/shown_pictures.hpp"
#include "sample_game/ui_renderer.hpp"
#include "tools/baking/graph_bakes.hpp"
#include "tools/scene/moving.hpp"

namespace sample {

struct WindowCloser {
    void operator()(GLFWwindow* window) const;
};

// The window, its device, what is open in it, and the loop over frames.
class App {
  public:
    explicit App(const AppOptions& options) : options_(options) {}
    ~App();
    bool open();
    bool loop();
    // Of what can't go on: what isn't saved is kept, or told that it couldn't be.
    void rescue() noexcept;

  private:
    bool fail(const std::string& message);  // false
    void recall();
    void keepLayout();
    bool openWindow();
    void openUi();
    bool openDocument(const espalier::scene::Request& request, std::string& error);

    bool rescale();
    void retitle();
    void entitle(const std::string& title);
    void showUi();
    bool update();
    void bakeForGraphs();
    void takeGraphBake(const espalier::baking::GraphBake& bake, const std::string& error);
    bool growing(uint64_t nodes);
    void showWaiting();
    void dropClicks();
    bool showOpening(const std::string& file, const std::string& part = {}, float share = 0);
    SceneImage::Margins margins(const Frame& frame) const;
    bool drawFrame(bool moving, bool grew, bool last);
    void endReplay();
    void screenshot(const std::string& path, const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height);
    bool openNext();
    void noteRecent(const std::string& file);
    void beginReplay();
    bool replay(std::vector<InputEvent>& events);
    bool closing();
    void followModels();
    void reload();
    void openReloaded();
    void dropReloaded();
    bool frame(float seconds);
    void noteTimes();
    void fadeNews();
    bool turn();
    void tellTurn() const;
    void giveBack();
    static bool endAsked();  // from outside
    void wake() { awake_ = kFramesAfterChange; }

    AppOptions options_;
    bool glfw_ = false, imgui_ = false;
    std::unique_ptr<GLFWwindow, WindowCloser> window_;
    std::unique_ptr<VulkanHost> host_;
    std::unique_ptr<SceneImage> image_;
    std::unique_ptr<UiRenderer> ui_;
    std::unique_ptr<AtlasView> atlas_;
    std::unique_ptr<ShownPictures> pictures_;
    std::unique_ptr<Input> input_;
    std::string layoutFile_;   // of ImGui's windows
    std::string title_;        // of the window
    std::string layoutError_;  // why what was remembered can't be taken

    Workspace work_;
    Session session_;
    struct {
        std::string kept;    // the project that it was saved to; empty: none
        uint64_t state = 0;  // of the document then
    } reloading_;
    bool reloadWaits_ = false;  // for the user, who has been told
    Replay replay_;
    std::unique_ptr<Controls> controls_;

    static constexpr int kFramesAfterChange = 3;  // ImGui settles within two
    int awake_ = kFramesAfterChange;
    bool idle_ = false;  // nothing but that the picture becomes smoother
    uint64_t frames_ = 0;
    std::optional<espalier::document::StrokeBegin> limiting_;  // whose limits the scene's picture shows
    Rest rest_;
    espalier::scene::MovingPicture moving_;
    struct {
        std::chrono::steady_clock::time_point at;
        std::clock_t cpu = 0;
    } turnBegan_;         // once detail and size have settled
    double grownMs_ = 0;  // what growth took in this frame
    struct {
        std::chrono::steady_clock::time_point began;
        size_t events = 0;  // that waited then
        bool underWay = false, told = false;
    } growth_;                 // of update()
    std::string growthError_;  // of the last frame
    bool bakingForGraph_ = false;
    bool timesAwaited_ = false;  // of the last picture
    GrowthPace pace_;
    float themeScale_ = 0;
    std::set<EspView> viewsSeen_;  // of this document
    std::string news_;             // the latest message, since when it is shown
    double newsBegan_ = 0;
};

}  // namespace sample
