#pragma once

#include <memory>

#include "tools/document/work.hpp"
#include "tools/export/export.hpp"

namespace espalier::exporting {

// Writes what stands in the context, beside the frames. The plan's note says what was written.
document::Work::Plan exportingTo(EspContext* context, const Options& options, const std::string& path);

}  // namespace espalier::exporting
