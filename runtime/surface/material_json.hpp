#pragma once

// Materials as surface files hold them, which is as glTF does.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/surface/surface.hpp"

namespace espalier::surface_file {

// Textures are named by their images' indices. extensions: gets the names of those that are used, each once.
nlohmann::ordered_json materialJson(const Material& material, std::vector<std::string>& extensions);

// The inverse, but for textures; what is missing, or of another type than glTF's, has glTF's default.
Material materialOf(const nlohmann::json& object);
TextureMap textureMapOf(const nlohmann::json& texture);

}  // namespace espalier::surface_file
