#pragma once

// What a context holds: surfaces, layers, grammars, seeds, strokes, a town.

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "plugin_api/espalier.h"
#include "runtime/emit/terminals.hpp"
#include "runtime/gpu/buffer.hpp"
#include "runtime/grammar/grammar.hpp"
#include "runtime/graph/node.hpp"
#include "runtime/paint/painter.hpp"
#include "runtime/plugin/plants.hpp"
#include "runtime/plugin/shifted.hpp"
#include "runtime/render/ground.hpp"
#include "runtime/render/props.hpp"
#include "runtime/roof/footprint.hpp"
#include "runtime/roof_growth/plan_layers.hpp"
#include "runtime/roof_growth/roof_growth.hpp"
#include "runtime/surface/burial.hpp"
#include "runtime/surface/gpu_surface.hpp"
#include "runtime/surface/mesh_tree.hpp"
#include "runtime/surface/surface.hpp"

namespace espalier {

// What a surface is read from.
struct SurfaceRequest {
    std::string name;  // for messages, and of the file
    EspTransform place;
    bool groundOnly = false;
    std::shared_ptr<const std::vector<std::byte>> bytes;  // a host's, in memory; null: they are in the file
    glm::dvec3 stand{0};                                  // as PlacedSurface's
};

// What picking, planting and laying layers need of a surface on the CPU: once for all its places.
struct SurfaceContent {
    SurfaceData data;                    // without images and all levels but the first, once it is on the GPU
    uint32_t triangles = 0, levels = 0;  // of the file
    MeshTree tree;
    BlockBounds blocks;  // made when it is first painted on
    // Made when it first comes near another surface; data then holds crossings and all levels again, without aux.
    std::unique_ptr<ContactGround> ground;
};

// A surface at a place. Its place in the id table is its instance number, which nodes and seeds carry.
struct PlacedSurface {
    uint32_t instance = 0;
    SurfaceRequest from;  // what it is read from, and where it stood when it was read last
    EspTransform place;
    glm::dvec3 stand{0};  // where its own origin lies, seen from the world's first one; see EspContext::origin
    Version placed = 0;   // of where it stands
    glm::mat4 toWorld{1}, toObject{1};
    float scale = 1;
    bool hidden = false;
    std::shared_ptr<SurfaceContent> content;
    EspSurfaceInfo info;
    GpuSurface gpu;
    std::vector<Crossing> contacts;  // to other surfaces, as its GPU data has them
    TexelSets buried;                // by other surfaces, likewise
};

// The contacts of two surfaces as they stood when these were found; others: surfaces that may have hidden some.
struct SurfacePair {
    struct Stand {
        uint32_t id = 0;
        glm::mat4 toWorld{1};
        bool operator==(const Stand&) const = default;
    };
    Stand a, b;
    std::vector<Stand> others;
    PlacedContacts found;
    TexelSets hiddenOfA, hiddenOfB;  // texels of the one that bodies of the other hide
};

// One painted layer of one surface. `name` may be one that no grammar reads (yet).
struct PaintedLayer {
    std::string name;
    uint32_t surface = 0;  // id
    uint32_t size = 0;     // texels a side
    Buffer texels;
    std::vector<float> kept;  // the host's copy, as of the last stroke that has ended
    uint64_t number = 0;      // unlike any other layer's of the context, those before it included
    int strokes = 0;          // that have changed it since it came and aren't undone
    bool behind = false;      // memory was short: `kept` lacks what was painted last
};

struct LoadedGrammar {
    std::string name;
    RuleMap map;
    std::string warnings;             // of the map, as text
    Version version = nextVersion();  // of rules and parameters
    Buffer words;                     // of the map
    Version uploaded = 0;             // what they are of
    std::vector<uint32_t> layerOf;    // scene layer of each of the map's contexts
    double compileMs = 0;
};

// A value that a seed has in place of its grammar's.
struct SeedParam {
    std::string name;
    std::array<float, 3> value{};
    uint32_t count = 0;
    bool operator==(const SeedParam&) const = default;
};

struct PlantedSeed {
    uint32_t grammar = 0;  // id
    uint32_t surface = 0;  // id
    std::string symbol;    // empty: the grammar's first
    uint32_t number = 0;
    uint32_t twin = 1;  // tells apart seeds of one number
    Walk walk{};
    bool ofGraph = false;                            // a procedural graph planted it, and takes it away
    bool hidden = false;                             // nothing grows from it until it is shown
    bool onBare = false;                             // no ground is near: it waits
    glm::vec3 position{0}, normal{0}, direction{0};  // world
    glm::vec3 givenPosition{0}, givenDirection{0};   // as the host asked
    Remainder remainder, givenRemainder;             // of the two positions
    std::vector<SeedParam> params;                   // by name
    std::shared_ptr<const PlantRecords> frozen;      // its plant, if it is to stay as it is
    std::vector<uint32_t> frozenOn;                  // instances of surfaces that this stands on
    uint32_t variant = kNoIndex;                     // place in EspContext::variants, since the last refreshVariants
};

// A grammar as seeds with values of their own grow by it.
struct GrammarVariant {
    uint32_t grammar = 0;  // id
    Version madeFrom = 0;  // of the grammar
    std::vector<SeedParam> params;
    std::vector<uint32_t> layerOf;
    RuleMap map;
    Buffer words;
    bool used = false;
};

// How terminals of a grammar look; the renderer has a kind of its own for each.
struct GrammarLook {
    uint32_t grammar = 0;  // id
    TerminalLook look;
};

// Props as a host has placed them.
struct Furnishing {
    std::string models;  // file
    std::vector<PropPlace> places;
};

// Which twins of which numbers are planted.
class TwinTable {
  public:
    static constexpr uint32_t kMaxTwin = 1u << 20;
    // wanted: 0 for the first that is free. False: it is taken, or beyond kMaxTwin.
    bool take(uint32_t number, uint32_t wanted, uint32_t& twin);
    void release(uint32_t number, uint32_t twin);
    size_t numbers() const { return numbers_.size(); }  // that are planted

  private:
    struct Uses {
        std::vector<bool> taken;  // [twin - 1]
        uint32_t firstFree = 0;   // none before it is free
    };
    std::unordered_map<uint32_t, Uses> numbers_;
};

// A stroke: open while it takes dabs, then a record for undoing.
struct PaintStroke {
    std::string layer;
    BrushRecord brush{};
    bool smooths = false, erases = false;
    float radius = 0;  // metres
    bool open = true;
    std::vector<DabRecord> dabs;  // that surfaces have taken and the host has no copy of: since it began
    bool roofsOnly = false;       // these make no layers on surfaces
    // What it has to do with one layer.
    struct Hold {
        uint64_t layer = 0;  // number of the layer
        bool made = false;   // that came into being by it, filled with `fill`; it goes when undone
        float fill = 0;
        bool counts = false;  // among the layer's strokes
        bool undone = false;
    };
    struct Part : Hold {
        uint32_t surface = 0;  // id
        BlockRecord record;
    };
    struct TownPart : Hold {
        uint64_t town = 0;  // LoadedTown::number; 0: it has come to none
        PlanRecord record;
    };
    std::vector<Part> parts;
    TownPart plan;
    // Of one that fills the whole layer: the layer's entry in EspContext::filled before it, or once it is undone,
    // after.
    std::optional<std::optional<float>> filled;
};

// Inputs that couldn't be grown, and why. What failed fails again, and trying it anew in each frame would only cost;
// but memory may have come back, or the driver may do better, so such growth is tried again after 1, 2, 4 ... calls, at
// most 1,024.
class FailedInputs {
  public:
    // Whether these inputs are known to fail and aren't to be tried by this call.
    bool known(Version inputs) {
        if (result_ == ESP_OK || inputs != inputs_) return false;
        return !passes() || ++calls_ < wait_;
    }
    EspResult tell(std::string& error) const {
        error = why_;
        return result_;
    }
    EspResult note(Version inputs, EspResult result, const std::string& why) {
        const bool again = passes() && inputs == inputs_;
        wait_ = again ? std::min(2 * wait_, 1024u) : 1;
        calls_ = 0;
        inputs_ = inputs;
        why_ = why;
        return result_ = result;
    }
    EspResult forget() { return result_ = ESP_OK; }

  private:
    bool passes() const { return result_ == ESP_OUT_OF_MEMORY || result_ == ESP_DRIVER_FAILED; }

    EspResult result_ = ESP_OK;
    Version inputs_ = 0;
    uint32_t wait_ = 1, calls_ = 0;
    std::string why_;
};

// A house that a designer has changed.
struct ChangedHouse {
    Footprint footprint;  // as it is wanted; where only its look is, it may make several houses as the plan's does
    RoofHouse planned;    // as its plan has it
};

// A town and what has been made of it.
struct LoadedTown {
    std::string name;
    std::vector<Footprint> footprints;               // as they were loaded
    glm::dvec2 origin{0};                            // as of Town
    bool geographic = false;                         // likewise
    std::vector<uint32_t> footprintOf;               // [house]; an outline that crosses itself makes several
    std::map<uint32_t, ChangedHouse> changedHouses;  // [house]
    RoofStructure structure;
    RoofTables tables;
    Version tablesMade = 0;         // unlike any other town's; houses that change leave it
    uint32_t grammar = 0;           // id; 0: none yet
    Version grown = 0;              // as of the roofs that stand
    Version whole = 0;              // of the last change that concerned all houses
    std::vector<uint32_t> changed;  // houses that have to grow, if not all
    FailedInputs failed;
    GroundLook ground;
    Version number = 0;  // unlike any other town's
    PlanLayers layers;
    std::vector<std::pair<std::string, PlanRect>> painted;  // layers that changed since the roofs last grew
    std::map<std::string, std::vector<float>> grownOver;    // texels of layers as they were then
    std::vector<float> means;                               // [house * kRoofLayers + layer of the grammar]
    RoofView view;                                          // of what stands
    std::vector<ContextInfo> contexts;                      // that it was grown by
    double structureMs = 0;

    // Whether more than `changed` and `painted` tell has changed since the roofs grew, by this grammar.
    bool growsWhole(const LoadedGrammar& by) const { return std::max(whole, by.version) > grown; }
    // The roofs stand as of a version. wholly: all of them have grown.
    void stands(Version version, bool wholly);
};

// A layer as kernels know it: its number is the place in this list. Two grammars that name the same layer, but
// want another value where nothing is painted, read two of them.
struct SceneLayer {
    std::string name;
    float fill = 1;
    bool operator==(const SceneLayer&) const = default;
};

}  // namespace espalier
