#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"
#include "tools/document/action.hpp"

namespace espalier::document {

// An ended stroke that the plugin keeps for as long as a step of undo or redo refers to it.
struct StrokeRecord {
    EspContext* context = nullptr;
    EspStroke stroke{};
    StrokeRecord(EspContext* c, EspStroke s) : context(c), stroke(s) {}
    StrokeRecord(const StrokeRecord&) = delete;
    ~StrokeRecord() { espDestroyStroke(context, stroke); }
};

// What a layer of one surface held, only where it was changed: tiles of kTile texels a side, row by row.
struct LayerTiles {
    static constexpr uint32_t kTile = 32;
    uint32_t surface = 0;  // index into Scene::surfaces
    std::string layer;
    uint32_t side = 0;  // texels of the layer
    std::vector<uint32_t> places;
    std::vector<float> texels;

    // What `before` held where `after`, of the same size, is another.
    static LayerTiles difference(const std::vector<float>& before, const std::vector<float>& after, uint32_t side);
    // Exchanges them with those of `layer`.
    LayerTiles swappedInto(std::vector<float>& layer) const;
};

// Memory that an action in the history holds besides itself.
size_t keptBytes(const Action& action);

}  // namespace espalier::document
