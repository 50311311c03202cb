#pragma once

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

// Memory that an action in the history takes up.
size_t keptBytes(Action& action);

}  // namespace espalier::document
