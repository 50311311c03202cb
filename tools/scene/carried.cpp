// A layer of a project and the bake that it was painted over -> the layer over the surface as it is now.
#include "tools/scene/carried.hpp"

#include <cstdio>
#include <filesystem>

#include "tools/scene/layers.hpp"
#include "tools/scene/scene_parts.hpp"

namespace espalier::scene {
namespace {

namespace fs = std::filesystem;

std::string squareMetres(double area) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g m²", area);
    return text;
}

}  // namespace

std::string keptName(const EspContext* context, EspSurface surface) {
    EspSurfaceInfo info{};
    if (espSurfaceInfo(context, surface, &info) != ESP_OK) return {};
    char name[24];
    std::snprintf(name, sizeof name, "%016llx.glb", static_cast<unsigned long long>(info.hash));
    return name;
}

bool Carrying::carry(const EspContext* context, const Scene& scene, const std::string& channel, const SceneLayer& layer,
                     GreyPicture& picture, std::string& note) {
    const LoadedSurface& surface = scene.surfaces[size_t(layer.surface)];
    const fs::path earlier(layer.over);
    if (layer.over.empty() || earlier.filename() == keptName(context, surface.id)) return false;
    const std::string which = "the layer '" + layer.name + "' of " + fs::path(surface.file).filename().string();
    const auto stays = [&](const std::string& why) {
        note = which + " was painted over another bake of it, " + why + ": it may not fit";
        return false;
    };
    if (std::error_code none; !fs::exists(earlier, none)) return stays("which wasn't kept");
    std::string error;
    if (!latest_ || from_ != layer.over || to_ != surface.file) {
        EspCarry* made = nullptr;
        latest_.reset();
        if (!fromContext(nullptr, espCreateCarry(layer.over.c_str(), surface.file.c_str(), &made), error))
            return stays("which can't be read (" + error + ")");
        latest_.reset(made);
        from_ = layer.over;
        to_ = surface.file;
    }
    GreyPicture there;
    there.width = there.height = espCarrySide(latest_.get());
    there.texels.resize(size_t(there.width) * there.height);
    EspCarried parts{};
    const EspResult done = espCarryLayer(latest_.get(), picture.texels.data(), picture.width, picture.height,
                                         fillOf(context, scene, channel), there.texels.data(), &parts);
    if (!fromContext(nullptr, done, error)) return stays("and couldn't be carried (" + error + ")");
    picture = std::move(there);
    note = which + ", which was baked anew, was carried over";
    if (parts.lost > 0) note += "; " + squareMetres(parts.lost) + " of what was painted are gone";
    if (parts.fresh > 0) note += "; " + squareMetres(parts.fresh) + " of its ground are new and unpainted";
    return true;
}

}  // namespace espalier::scene
