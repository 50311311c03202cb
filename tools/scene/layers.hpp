#pragma once

#include <string>
#include <vector>

#include "tools/scene/picture.hpp"
#include "tools/scene/scene.hpp"

namespace espalier::scene {

// A layer of colours, which grammars declare as `context NAME = #rrggbb`, is three to the plugin: NAME.r, .g and .b. A
// scene lists it once, in Scene::layers and Scene::colourLayers.

// Projects name files by their layers, so that a name must be no path. False: `why` says what it should be.
bool isLayersName(const std::string& name, std::string& why);
bool isColour(const Scene& scene, const std::string& layer);
// Whether the scene lists the layer, or one of colours whose channel it is.
bool readsLayer(const Scene& scene, const std::string& name);
// Its roofs read it, or it is painted over them, and no grammar of plants does: it lies over the town and no surface.
bool isTownsAlone(const EspContext* context, const Scene& scene, const std::string& channel);
// The plugin's layers of one of the scene's: red, green and blue, or itself.
std::vector<std::string> channelsOf(const Scene& scene, const std::string& layer);
// What one of the plugin's layers has where nothing is painted: what all of it was filled with last, or else what the
// first grammar that declares it says, or 0.
float fillOf(const EspContext* context, const Scene& scene, const std::string& layer);

// The names of all layers that the grammars read, or that surfaces or the town are painted with, into the scene.
void noteLayers(const EspContext* context, Scene& scene);

// A value of a layer that has a name.
struct NamedValue {
    float value = 0;  // 0 to 1
    std::string name;
};
// What a grammar's label says behind its title: "Missing tiles: 0 none, 1 all, of the whole house" names two values and
// has a note.
struct LayerWords {
    std::vector<NamedValue> values;
    std::string note;
};
LayerWords labelWords(const std::string& label);
// What the first grammar that says anything of one of the plugin's layers says of it; "" where none does.
std::string labelOf(const EspContext* context, const Scene& scene, const std::string& layer);

// A file's picture for each channel: three of a layer of colours, else one.
bool readChannels(const std::string& path, bool colour, std::vector<GreyPicture>& out, std::string& error);

}  // namespace espalier::scene
