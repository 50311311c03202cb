// Surfaces of a scene: those of one file share what was read of it.
#include <algorithm>

#include "tools/scene/scene_parts.hpp"

namespace espalier::scene {

bool loadSurface(EspContext* context, const Scene& scene, LoadedSurface& surface, std::string& error) {
    const EspTransform place = surface.placing.transform();
    const auto like = std::ranges::find_if(scene.surfaces, [&](const LoadedSurface& other) {
        return other.file == surface.file && other.drawn == surface.drawn && other.kept &&
               other.kept->isStill(surface.file);
    });
    if (like != scene.surfaces.end()) {
        surface.kept = like->kept;
        return fromContext(context, espPlaceAgain(context, like->id, &place, &surface.id), error);
    }
    surface.kept = KeptFile::open(surface.file);
    const auto load = surface.drawn ? espLoadSurface : espLoadGround;
    return fromContext(context, load(context, surface.file.c_str(), &place, &surface.id), error);
}

}  // namespace espalier::scene
