#pragma once

#include "runtime/grammar/ast.hpp"
#include "runtime/grammar/grammar.hpp"

namespace espalier::grammar {

// Parses a text and what it includes into `module` (empty before). Mistakes go to the reporter; what could be
// understood is in the module all the same, so that later stages find theirs in the same go.
// sources: all texts read, in order, for the content hash.
void parseModule(std::string_view text, const CompileOptions& options, Module& module, Reporter& reporter,
                 std::vector<std::string>& sources);

}  // namespace espalier::grammar
