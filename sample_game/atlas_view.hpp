#pragma once

#include <optional>

#include "sample_game/atlas_picture.hpp"
#include "sample_game/host_image.hpp"
#include "sample_game/workspace.hpp"

struct ImVec2;

namespace sample {

// A window onto a surface's atlas (Buron 2015, Figure 4): charts, links and a painted layer as a picture, over it the
// walk of the picked branch and, at the mouse, what lies there and where its link leads.
class AtlasView {
  public:
    explicit AtlasView(const VulkanHost& host) : picture_(host) {}

    // Between ImGui::NewFrame and Render. Reads back what has changed since the last call; a closed window costs
    // nothing.
    void show(Workspace& work);
    // What was read belongs to a document that is no more.
    void forget();

  private:
    struct View;  // where the picture lies in the window

    void followBranch(const Workspace& work);
    void surfaceChoice(const Workspace& work);
    void controls(Workspace& work);
    void moveView(const View& view);
    void drawWalk(const Workspace& work, const View& view) const;
    void tellAt(const Workspace& work, const View& view) const;
    static void drawLink(const View& view, const EspLink& link, EspSurface shown);
    const EspLink* linkAt(const View& view, ImVec2 at) const;

    HostImage picture_;
    AtlasShown wanted_;
    AtlasPicture atlas_;
    std::optional<uint64_t> followed_;  // the branch whose surface was turned to
    float zoom_ = 1;
    float centre_[2] = {.5f, .5f};  // walk UV
};

}  // namespace sample
