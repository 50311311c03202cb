#pragma once

// Materials as surface files hold them, which is as glTF does.

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runtime/surface/surface.hpp"

namespace espalier::surface_file {

// What lies beyond the borders of a picture, along u and v.
using Wraps = std::pair<Wrap, Wrap>;

// The textures of a file: pictures by their indices, each with a sampler.
class Textures {
  public:
    // The texture's index; it is added the first time.
    size_t find(int image, Wraps wraps);
    nlohmann::ordered_json textures, samplers;  // lists, or null while there are none

  private:
    std::map<std::pair<int, Wraps>, size_t> textures_;
    std::map<Wraps, size_t> samplers_;
};

// extensions: gets the names of those that are used, each once.
nlohmann::ordered_json materialJson(const Material& material, Textures& textures, std::vector<std::string>& extensions);

// The inverse, but for textures; what is missing, or of another type than glTF's, has glTF's default.
Material materialOf(const nlohmann::json& object);
TextureMap textureMapOf(const nlohmann::json& texture);
Wraps wrapsOf(const nlohmann::json& sampler);

}  // namespace espalier::surface_file
