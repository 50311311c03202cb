#pragma once

// Models as pieces that patterns place, a palette, and as what plants draw.

#include <functional>

#include "tools/bake/import_model.hpp"

namespace espalier {

struct PaletteArguments {
    std::string input, output;  // a model or a folder of them; the file that is written (.glb)
    ImportOptions importing;
};

// Writes each model as a mesh that fills a scope of size 1: it stands on y = 0 with its middle above the origin, and
// its longer side along x or z is 1. A mesh is named after its file, of which letters and digits count, and has coarser
// levels. told: a line about each model. Fails naming the file, where a model can't be read, none is there, or there
// are too many.
Status bakePalette(const PaletteArguments& arguments, const std::function<void(const std::string&)>& told);

// Writes one model as a mesh for plants' terminals, such as leaves: its stalk at the origin, 1 long along +Y, looking
// along +Z, with coarser levels; what its pictures' alpha cuts out stays cut out.
Status bakeTerminal(const PaletteArguments& arguments, const std::function<void(const std::string&)>& told);

}  // namespace espalier
