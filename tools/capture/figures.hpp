#pragma once

#include <string>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tools/scene/scene.hpp"

namespace espalier::capture {

// A file that the picture depends on, and scene::hashName of its bytes; empty: it can't be read any more.
struct Input {
    std::string file, hash;
};
// The scene's file (of a project's folder its project.json), what it names, what the request adds, and `further`: each
// once. What a grammar includes isn't among them.
std::vector<Input> inputsOf(const scene::Request& request, const scene::Scene& scene,
                            const std::vector<std::string>& further);

struct Figures {
    EspStats growth;
    EspRoofStats roofs;
    EspPatternStats patterns;
};
// What stands in stats.json (docs/frame_capture_tests.md).
std::string figuresJson(const EspContext* context, const Figures& figures, const std::vector<Input>& inputs);

}  // namespace espalier::capture
