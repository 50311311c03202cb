#pragma once

// The town that a procedural graph asks for, and what it wants layers over the town to hold.

#include <map>
#include <string>
#include <vector>

#include "runtime/plugin/graph_grammar.hpp"
#include "runtime/plugin/graph_trouble.hpp"

namespace espalier {

class GraphTown {
  public:
    // Towns and layers that shown nodes ask for: the first town counts.
    void update(EspContext& context, const NodeEvaluation& graph, std::vector<GraphTrouble>& troubles);
    // Another town stands than the one that the layers were laid over.
    bool due(const EspContext& context) const;
    void removeAll(EspContext& context);

  private:
    std::string bringTown(EspContext& context, const TownRef& wish);
    void dropTown(EspContext& context);
    std::string lay(EspContext& context, const CoverRef& wish);

    TownRef town_;  // that stands; null: none of ours
    GraphGrammar grammar_;
    Version number_ = 0;                                   // of the town that stands since the last update; 0: none
    std::map<std::string, CoverRef, std::less<>> layers_;  // that are laid, by name
};

}  // namespace espalier
