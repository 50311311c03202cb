#pragma once

#include <optional>
#include <string>
#include <vector>

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
    // What the picture was made of.
    struct Shown {
        uint32_t surface = ~0u;  // index into Scene::surfaces
        uint32_t level = 0;
        bool charts = true, links = true;
        std::string layer;  // empty: none
        float opacity = .8f;
        uint64_t revision = 0;  // of the document; counts with a layer only
        bool operator==(const Shown&) const = default;
    };
    struct View;  // where the picture lies in the window

    void followBranch(const Workspace& work);
    void surfaceChoice(const Workspace& work);
    void controls(Workspace& work);
    bool read(Workspace& work, const Shown& wanted);
    bool compose();
    void mixColours();
    uint32_t colourOf(uint32_t x, uint32_t y) const;
    void drawLinks(std::vector<uint32_t>& pixels, uint32_t side) const;
    void moveView(const View& view);
    void drawWalk(const Workspace& work, const View& view) const;
    void tellAt(const View& view) const;
    const EspLink* linkAt(const View& view, ImVec2 at) const;

    HostImage picture_;
    Shown wanted_, shown_;
    uint32_t size_ = 0, layerSize_ = 0;  // texels a side
    std::vector<uint32_t> texels_;       // as espReadAtlas gives them
    std::vector<EspLink> links_;
    std::vector<std::vector<float>> layer_;              // one, or red, green and blue
    std::vector<uint32_t> chartColours_, layerColours_;  // of each chart; of values from 0 to 1
    std::optional<uint64_t> followed_;                   // the branch whose surface was turned to
    float zoom_ = 1;
    float centre_[2] = {.5f, .5f};  // walk UV
};

}  // namespace sample
