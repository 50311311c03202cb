#pragma once

// Seeds of a scene or a project whose ground a changed model doesn't have any more.

#include <string>
#include <vector>

#include "runtime/surface/surface.hpp"

namespace espalier {

struct SeedsArguments {
    std::string scene;  // a scene file or a project's folder; empty: none
    std::string from;   // the surface before the change, as a path
    std::string to;     // the new one
};

// Adds a note for each seed that stood on `before` and whose ground isn't on `after`, and one that counts. A scene of
// one surface is taken to be of these; of several those of the same file name are, and a seed is theirs if it stands on
// them. Fails where the scene can't be read, naming the place.
Status findLostSeeds(const SeedsArguments& arguments, const SurfaceData& before, const SurfaceData& after,
                     std::vector<Diagnostic>& notes);

}  // namespace espalier
