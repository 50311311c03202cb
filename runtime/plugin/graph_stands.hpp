#pragma once

// What procedural graphs ask of other stages (runtime/nodes/wishes.hpp), as it stands in a context: baked surfaces,
// plants, a town. All is made by the functions that hosts call, too.

#include <map>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"
#include "runtime/graph/node.hpp"
#include "runtime/plugin/graph_town.hpp"

namespace espalier {

class GraphStands {
  public:
    // Lets stand what the graph's shown nodes ask for, and takes away what they don't any more. Plants wait for their
    // ground; until it is baked, those that stood before stay.
    void update(EspContext& context, const NodeEvaluation& graph);
    // Whether update() has something to do though the graph is as it was: ground has come, or other surfaces have.
    bool due(const EspContext& context) const;
    void removeAll(EspContext& context);

    // What stands, stands; meshes of the graph, which lie on a device, are let go of until the next update.
    void letGoOfMeshes();

    // Meshes that stand for ground that isn't baked yet.
    const Geometry& waiting() const { return waiting_; }
    // Ground that a host is to bake; null: none.
    const GroundWish* wanted() const;
    // The host's answer: a surface file, or "" and why it can't be.
    EspResult give(EspContext& context, uint64_t key, const std::string& file, const std::string& why);
    // What nodes ask for in vain, since the last update.
    const std::vector<GraphTrouble>& troubles() const { return troubles_; }

  private:
    struct Ground {
        GroundRef wish;
        EspSurface surface{};  // id 0: it isn't there yet
        std::string failure;   // why it can't be; "": it may come
    };
    // Of a shown node, by its name.
    struct Stand {
        GroundRef ground;  // that the node's plants stand on, or that it shows
        PlantsRef plants;  // that stand
        GraphGrammar grammar;
        std::vector<EspSeed> seeds;  // [point]; id 0: no ground is near
    };
    bool stands(const EspContext& context, const GroundRef& ground) const;
    std::string plant(EspContext& context, const std::string& node, const PlantsRef& wish, Stand& stand);
    void place(EspContext& context, const std::string& node, const PlantsWish& wish, Stand& stand);
    void uproot(EspContext& context, Stand& stand);
    void dropUnused(EspContext& context, const std::vector<GroundRef>& wanted);

    GraphTown town_;
    std::map<uint64_t, Ground> grounds_;  // by key
    std::map<std::string, Stand, std::less<>> stands_;
    Geometry waiting_;
    std::vector<GraphTrouble> troubles_;
    Version surfaces_ = 0;  // of the context, at the last update
    bool due_ = false;
};

}  // namespace espalier
