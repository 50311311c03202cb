#pragma once

// What scenes are opened with, between scene.cpp, described_scene.cpp and bare_scene.cpp. Functions return false with
// what went wrong in `error`.

#include "tools/scene/scene_file.hpp"

namespace espalier::scene {

// Whether a call went well; its message otherwise.
bool fromContext(const EspContext* context, EspResult result, std::string& error);

// Loads a surface whose file and place are known, and keeps its file. Where that is the file of one of the scene's, it
// shares what has been read of that.
bool loadSurface(EspContext* context, const Scene& scene, LoadedSurface& surface, std::string& error);

// grammar.file names it in messages.
bool compile(EspContext* context, LoadedGrammar& grammar, const std::string& text, std::string& error);
bool compileFile(EspContext* context, LoadedGrammar& grammar, std::string& error);

class Carrying;
// Lays a picture over the surfaces that it is for. `carrying` knows the bakes that were compared.
bool layLayer(EspContext* context, Scene& scene, const SceneLayer& layer, Carrying& carrying, std::string& error);

// Loads out.town, which grows by the grammar that it names or the first that makes roofs.
bool loadTown(EspContext* context, Scene& out, std::string& error);

// A picture of a town's layer that was painted over another square becomes one over what they lie over now: what is in
// both stays at its place, all else is as the layer is.
bool moveOver(EspContext* context, const std::string& channel, const TownSquare& from, GreyPicture& picture,
              std::string& error);

// A scene or a project, by its file.
bool openDescription(EspContext* context, const Request& request, Scene& out, std::string& error);
// A surface, or a town, on its own: with standard grammars, seeds where they have a chance, ground and a camera.
bool openSurface(EspContext* context, const Request& request, Scene& out, std::string& error);
bool openTown(EspContext* context, const Request& request, Scene& out, std::string& error);
// A procedural graph on its own, on a ground.
bool openGraph(EspContext* context, const Request& request, Scene& out, std::string& error);
// Adds graphs to a scene.
bool loadGraphs(EspContext* context, const std::vector<SceneGraph>& graphs, Scene& out, std::string& error);
// What stands alone gets something to stand on, below all of it, floors too. The eye is not to be below it.
void layGround(float level, Scene& scene);
// Whether it may be a baked surface; else `error` says what it is, or why it can't be read.
bool isSurface(const std::string& path, std::string& error);

}  // namespace espalier::scene
