#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"
#include "tools/document/work.hpp"
#include "tools/scene/scene.hpp"

namespace espalier::baking {

// A mesh that a Bake node of a scene's graphs wants to have as ground. What was baked is kept in the user's cache by
// the mesh's content, so the same mesh is baked once.
struct GraphBake {
    EspGraph graph{};
    uint64_t key = 0;
    std::string surface;        // the file that it becomes
    bool there = false;         // it was baked before
    document::Work::Plan plan;  // else: bakes it beside the frames
};

// What graphs ask for after an espUpdate; the same again until it is answered.
std::optional<GraphBake> nextGraphBake(EspContext* context, const std::vector<scene::LoadedGraph>& graphs);
// Tells the graph that its surface is there, or by `error` why it isn't. The next espUpdate lets plants grow on it.
void answerGraphBake(EspContext* context, const GraphBake& bake, const std::string& error);
// All that graphs ask for, waiting, with an espUpdate behind each. False: that failed.
bool bakeForGraphs(EspContext* context, const std::vector<scene::LoadedGraph>& graphs, std::string& error);

}  // namespace espalier::baking
