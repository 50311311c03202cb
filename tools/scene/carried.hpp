#pragma once

#include <memory>
#include <string>

#include "tools/scene/scene.hpp"

namespace espalier::scene {

// The name of a surface's file among those that a project keeps: HASH.glb.
std::string keptName(const EspContext* context, EspSurface surface);

// Layers that were painted over an earlier bake of their surface, laid over the present one.
class Carrying {
  public:
    // Does nothing to the picture of a channel that was painted over this bake, or of which that isn't known. Else it
    // becomes one over this bake (`carried`; beside its charts it has nothing), or, where the earlier one isn't kept,
    // stays as it is; `note` says what became of it. False: `error` tells file and cause.
    bool carry(const EspContext* context, const Scene& scene, const std::string& channel, const SceneLayer& layer,
               GreyPicture& picture, bool& carried, std::string& note, std::string& error);

  private:
    struct Destroy {
        void operator()(EspCarry* carry) const { espDestroyCarry(carry); }
    };
    std::unique_ptr<EspCarry, Destroy> latest_;  // a surface's layers often follow each other
    std::string from_, to_;                      // of the latest
};

}  // namespace espalier::scene
