#pragma once

#include <string>
#include <vector>

#include "sample_game/session.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

// Models come to the open scene, in this order: one that isn't baked yet is baked beside the frames first. Each is one
// step of undo. A model stands where its file has it, raised or lowered onto the ground; where something stands
// already, it stands beside that. What can't be read or baked changes nothing, and Workspace::error says why.
void addModels(Workspace& work, Session& session, const std::vector<std::string>& files);

// A model opens in place of what is open now, once it is baked; see askToLeave.
void openModel(Workspace& work, Session& session, const std::string& model);

// What was dropped onto the window: models are added; a scene, project or run is opened, if it came alone.
void takeDropped(Workspace& work, Session& session, const std::vector<std::string>& files);

// A scene without models.
std::string emptyScene();

}  // namespace sample
