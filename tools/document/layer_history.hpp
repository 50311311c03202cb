#pragma once

#include <utility>
#include <vector>

#include "plugin_api/espalier.h"
#include "tools/document/action.hpp"

namespace espalier::document {

// An ended stroke that the plugin keeps for as long as a step of undo or redo refers to it.
struct StrokeRecord {
    EspContext* context = nullptr;
    EspStroke stroke{};
    std::vector<scene::SceneLayer> unread;  // pictures of Scene::unread whose places it has painted
    StrokeRecord(EspContext* c, EspStroke s, std::vector<scene::SceneLayer> pictures)
        : context(c), stroke(s), unread(std::move(pictures)) {}
    StrokeRecord(const StrokeRecord&) = delete;
    ~StrokeRecord() { espDestroyStroke(context, stroke); }
};

// Memory that an action in the history takes up.
size_t keptBytes(Action& action);

}  // namespace espalier::document
