#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sample_game/workspace.hpp"

namespace sample {

// What a picture of an atlas shows.
struct AtlasShown {
    uint32_t surface = ~0u;  // index into Scene::surfaces
    uint32_t level = 0;
    bool charts = true, links = true;
    std::string layer;  // empty: none
    float opacity = .8f;
    uint64_t revision = 0;  // of the document; counts with a layer only
    bool operator==(const AtlasShown&) const = default;
    // Another surface in place of one that isn't there any more, and no such layer.
    void keepTo(const espalier::scene::Scene& scene);
};

// By its file; one of several of a file has its number.
std::string surfaceName(const std::vector<espalier::scene::LoadedSurface>& surfaces, size_t index);
// Where walks over a link of the surface `shown` arrive, in words.
std::string leadsTo(const espalier::scene::Scene& scene, uint32_t shown, const EspLink& link);

// A surface's atlas as a picture: charts, links and a painted layer. Colours are ImGui's, as IM_COL32 packs them. One
// thread, the context's.
class AtlasPicture {
  public:
    // Of seams, nearest points, contacts, the model's borders; by EspLink::kind.
    static const uint32_t kLinkColours[4];

    // Reads back what is another than was shown. False: Workspace::error or espLastError tells why, and what was shown
    // stays `shown`.
    bool read(Workspace& work, const AtlasShown& wanted);
    // What was read belongs to a document that is no more.
    void forget();

    const AtlasShown& shown() const { return shown_; }
    uint32_t size() const { return size_; }  // texels a side; 0: nothing has been read
    uint32_t texel(uint32_t x, uint32_t y) const { return texels_[size_t(y) * size_ + x]; }  // as espReadAtlas has it
    const std::vector<EspLink>& links() const { return links_; }
    // What the layer holds at a walk UV, each from 0 to below 1: nothing, one number, or red, green and blue.
    std::vector<float> layerAt(float u, float v) const;
    // side: pixels a side, as many to each texel. v runs upward, rows downward. Once something has been read.
    std::vector<uint32_t> pixels(uint32_t& side);

  private:
    void mixColours();
    uint32_t colourOf(uint32_t x, uint32_t y) const;
    void drawLinks(std::vector<uint32_t>& pixels, uint32_t side) const;

    AtlasShown shown_;
    uint32_t size_ = 0, layerSize_ = 0;  // texels a side
    std::vector<uint32_t> texels_;
    std::vector<EspLink> links_;
    std::vector<std::vector<float>> layer_;              // one, or red, green and blue
    std::vector<uint32_t> chartColours_, layerColours_;  // of each chart; of values from 0 to 1
};

}  // namespace sample
