#pragma once

#include <filesystem>

#include "runtime/core/result.hpp"

namespace espalier {

class Device;

// Runs the self-check (self_check.hpp) on a device that hasn't passed yet. A device is known by its and its driver's
// UUIDs, the width of its subgroups and the kernels themselves; what has passed isn't checked again in this process,
// nor, with a folder, in later ones. folder: empty, nothing is kept on disk. A check that didn't come to its end, since
// the driver crashed or hung, is told in the device's log the next time. Any thread; one check at a time.
Status checkDevice(Device& device, const std::filesystem::path& folder);
// What has passed in this process is checked again when it is asked for; for tests.
void forgetCheckedDevices();

}  // namespace espalier
