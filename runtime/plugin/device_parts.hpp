#pragma once

// What of a context lies on a device, whatever the context holds.

#include <memory>
#include <string>

#include "runtime/plugin/context.hpp"

namespace espalier {

struct DeviceParts {
    std::unique_ptr<Device> device;  // goes last
    std::unique_ptr<Renderer> renderer;
    std::unique_ptr<Growth> growth;
};

// What is wrong with a host's device; null: nothing that can be seen.
const char* mistakeIn(const EspHostDevice& host);
// host: null for a device of our own. The device is checked before it is used. why: of a failure; nothing is logged.
EspResult makeDeviceParts(const EspContext& context, const EspHostDevice* host, DeviceParts& out, std::string& why);
// Returns when the GPU is done with all that was submitted, a host's frames included: an empty submission is behind
// them.
Status finishFrames(Device& device, const char* name);

}  // namespace espalier
