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
    // True: the picture of a channel that was painted over another bake has become one over this; beside its charts it
    // has nothing. False: it is over this one, or that isn't known, or it can't be carried; a project opens all the
    // same. `note`: what became of it, if it isn't over this one.
    bool carry(const EspContext* context, const Scene& scene, const std::string& channel, const SceneLayer& layer,
               GreyPicture& picture, std::string& note);

  private:
    struct Destroy {
        void operator()(EspCarry* carry) const { espDestroyCarry(carry); }
    };
    std::unique_ptr<EspCarry, Destroy> latest_;  // a surface's layers often follow each other
    std::string from_, to_;                      // of the latest
};

}  // namespace espalier::scene
