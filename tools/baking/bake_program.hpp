#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/document/work.hpp"

namespace espalier::baking {

// espalier-bake, which lies beside the programs that use this.
std::filesystem::path bakeProgram();

// Bakes the model into that surface by the program: what takes all memory or finds a fault costs a message. options:
// further arguments. The surface is written whole or not at all. Waits; for threads that work beside.
bool bake(const std::string& model, const std::string& surface, const std::vector<std::string>& options,
          document::Progress& progress, std::string& error);

}  // namespace espalier::baking
