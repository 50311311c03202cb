#pragma once

#include <string>

#include "runtime/surface/surface.hpp"

namespace espalier {

// Writes pictures of the finest level into `folder` (made if missing): charts.png, each chart in a colour of its
// own, shaded; links.png, crossings over that, seams joined by lines to where they lead; stretch.png, distortion
// from blue (shrunk) over white to red (stretched). Fails with the file and the system's reason.
Status writePictures(const SurfaceData& surface, const std::string& folder);

}  // namespace espalier
