#pragma once

// A grammar of a context, as a procedural graph wants it.

#include <string>

#include "plugin_api/espalier.h"
#include "runtime/nodes/wishes.hpp"

namespace espalier {

class GraphGrammar {
  public:
    // Compiles it, and sets its parameters: those that the graph doesn't name have what the text says. "", or what is
    // wrong; then what grew by it goes on.
    std::string bring(EspContext& context, const RulesRef& rules);
    void drop(EspContext& context);  // what grows by it goes
    EspGrammar id() const { return id_; }

  private:
    EspGrammar id_{};
    RulesRef made_;  // what it stands as
};

}  // namespace espalier
