#pragma once

#include "runtime/plugin/context.hpp"

namespace espalier {

// With what the inputs point to. Not copyable: they point to their own.
struct FrameInputs : DrawInputs {
    FrameInputs() = default;
    FrameInputs(const FrameInputs&) = delete;
    FrameInputs& operator=(const FrameInputs&) = delete;
    std::vector<Version> carriers;  // DrawInputs::placed
};

// A look as a host has given it, null being the defaults, with the brush that it leads to. Not copyable.
struct TakenLook {
    EspLook look{};
    EspBrush brush{};

    TakenLook(const std::string& call, const EspLook* given);
    TakenLook(const TakenLook&) = delete;
    TakenLook& operator=(const TakenLook&) = delete;
};

// Frames are numbered rising: one that is done is refused.
EspResult checkFrame(const EspContext* context, const std::string& call, uint64_t frame, uint64_t framesDone);
// Numbers of a look. call: the function that was given it, for messages.
EspResult checkLook(const EspContext* context, const std::string& call, const EspLook& look);
// All but the camera. hosted: the frame shows a scene of the host's, which has a ground of its own. Makes the tables of
// surfaces if they are due.
EspResult findInputs(EspContext& context, const std::string& call, const EspLook& look, bool hosted,
                     FrameInputs& inputs);

}  // namespace espalier
