#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"
#include "runtime/core/let_go.hpp"
#include "runtime/core/result.hpp"
#include "runtime/expand/growth.hpp"
#include "runtime/gpu/device.hpp"
#include "runtime/graph/node.hpp"
#include "runtime/plugin/contents.hpp"
#include "runtime/plugin/files.hpp"
#include "runtime/plugin/graphs.hpp"
#include "runtime/plugin/id_table.hpp"
#include "runtime/plugin/parts.hpp"
#include "runtime/plugin/patterns.hpp"
#include "runtime/plugin/streaming.hpp"
#include "runtime/plugin/surface_changes.hpp"
#include "runtime/plugin/surface_loads.hpp"
#include "runtime/render/renderer.hpp"

namespace espalier {

// A place is the number of an instance, for which records have 16 bits. Each is used 1,023 times.
using SurfaceTable = IdTable<PlacedSurface, 16>;

// What of a context is made from what. An edit calls change() of what it changes; what is made from that is due then.
struct ContextNodes {
    graph::Node surfaces;   // which there are, and where they stand
    graph::Node layers;     // which there are over surfaces, and by which numbers kernels know them
    graph::Node paint;      // on layers that grammars of plants read
    graph::Node rules;      // of plants and patterns, with their parameters
    graph::Node seeds;      // with what is pruned and what stands frozen
    graph::Node limits;     // EspContext::grow
    graph::Node fields;     // that patterns are laid along
    graph::Node origin;     // of the world
    graph::Node town;       // its houses, what is painted over it, which grammar it grows by
    graph::Node roofRules;  // with their parameters

    graph::Node contacts{&surfaces};                  // between surfaces
    graph::Node carriers{&contacts, &seeds};          // surfaces that plants stand on or may get to
    graph::Node tables{&contacts, &layers, &origin};  // by which kernels read surfaces and layers
    graph::Node plants{&contacts, &paint, &rules, &seeds, &limits};
    graph::Node patterns{&tables, &paint, &rules, &seeds, &limits, &fields};
    graph::Node roofs{&town, &roofRules};
};

}  // namespace espalier

// What the C ABI calls a context. Every function of the ABI goes through guarded().
struct EspContext {
    espalier::Log log;
    std::string cacheFolder;
    espalier::Files files;
    mutable std::string error;
    std::filesystem::path terminals;  // file
    bool validation = false, checksDevice = true;
    bool bare = false;  // what lies on the device went with one that was lost: api_recreate.cpp

    // Destroyed from the last to the first: the device goes last, its objects before it.
    std::unique_ptr<espalier::Device> device;
    std::unique_ptr<espalier::Growth> growth;
    std::unique_ptr<espalier::Renderer> renderer;
    // Made when the first grammar of roofs or town asks for them.
    std::unique_ptr<espalier::RoofGrowth> roofs;
    std::vector<espalier::RoofMesh> roofBounds;
    std::optional<espalier::TerminalData> roofMeshes;  // the renderer has a copy
    std::vector<espalier::TerminalMesh> roofMeshNames;
    std::filesystem::path roofMeshFile;
    std::optional<espalier::LoadedTown> town;
    espalier::ContextPatterns patterns;
    espalier::ContextNumber number;
    espalier::ContextGraphs graphs{number.value()};
    espalier::SurfaceTable surfaces{number.value()};
    espalier::IdTable<espalier::LoadedGrammar, 10> grammars{number.value()};
    espalier::IdTable<espalier::PlantedSeed, 20> seeds{number.value()};
    std::vector<espalier::PaintedLayer> layers;
    uint64_t layersMade = 0;   // ever
    bool paintBehind = false;  // some copies of paint are to be made yet: kept_paint.hpp
    espalier::IdTable<espalier::PaintStroke, 20> strokes{number.value()};
    std::map<std::string, std::optional<float>, std::less<>> filled;  // with what, as a whole: erasing leads there
    std::unique_ptr<espalier::Painter> painter;                       // made with the first stroke
    std::vector<espalier::SceneLayer> sceneLayers;
    espalier::TwinTable twins;
    std::vector<espalier::GrammarVariant> variants;
    std::vector<espalier::GrammarLook> looks;
    std::optional<espalier::TerminalData> shippedTerminals;  // kept from the first look on
    espalier::Furnishing props;
    espalier::SiteMap site;
    std::vector<uint64_t> pruned;  // keys of branches, ascending

    glm::dvec3 origin{0};  // of the world, seen from the first one

    EspGrowDef grow;
    std::unique_ptr<espalier::GrowthWatch> watch;  // null: nobody does
    espalier::ContextNodes nodes;
    // What of the inputs of plants changed since they last grew, as far as growth doesn't find out by itself. Who
    // changes one of these nodes notes it here, or calls changeWholly().
    espalier::GrowthChanges changes;
    std::vector<uint32_t> grownGrammars;  // ids, in the order of growth's indices
    espalier::FailedInputs failed;        // of plants
    espalier::SurfaceChanges surfaceChanges;
    std::vector<espalier::SurfacePair> pairs;
    std::set<uint32_t> touched;     // surfaces of pairs that changed, until refreshContacts has told them
    uint32_t contactCount = 0;      // crossings between surfaces
    double contactMs = 0;           // of finding them the last time, CPU
    espalier::Buffer surfaceTable;  // SurfaceRef[stands().size()]
    espalier::Buffer layerTable;    // LayerRef[stands().size() * kMaxLayers]
    double compileMs = 0;

    std::vector<uint32_t> grownSeeds;  // ids, in the order of growth's indices
    struct GrownSurface {
        uint32_t id = 0;  // 0: there was none
        glm::mat4 toWorld{1};
        espalier::Version placed = 0;  // of that
    };
    std::vector<bool> carriers;               // [instance], likewise
    std::vector<GrownSurface> grownSurfaces;  // [instance], as growth found them
    std::optional<espalier::Plants> plants;   // what was grown, read back when asked for
    uint64_t plantsRevision = 0;              // of the growth's view

    bool hasPicture = false;
    uint32_t pictureWidth = 0, pictureHeight = 0;
    uint64_t preparedFrame = 0;                      // the host's, of the last espPrepare
    std::vector<std::byte> vertices, indices;        // of the last espMaterialise, until something grows
    espalier::StandingParts parts;                   // of the last espReadParts
    std::unique_ptr<espalier::Streaming> streaming;  // made with the first streamed surface
    // Last, so that its thread ends first. Made with the first load.
    std::unique_ptr<espalier::SurfaceLoads> loads;

    // An input of plants changed in a way that only a full growth answers.
    void changeWholly(espalier::graph::Node& input) noexcept {
        changes.everything = true;
        input.change();
    }
    // A grammar has other rules or parameters.
    void changeRules(espalier::LoadedGrammar& grammar) noexcept {
        grammar.version = (grammar.map.roofs() ? nodes.roofRules : nodes.rules).change();
    }
    // The arrays of espMaterialise.
    void dropTriangles() { espalier::letGo(vertices, indices); }
    // Standing, or streamed and away.
    bool knowsSurface(uint32_t id) const { return surfaces.find(id) || (streaming && streaming->knows(id)); }
    // The index by which growth and GrowthChanges know a grammar.
    uint32_t grammarIndex(uint32_t id) const;
    uint32_t surfaceSlots() const;
    // [instance]: where what has grown on a surface stands in the world, also if that has been destroyed since.
    std::vector<glm::mat4> stands() const;
    // [instance]: of where a surface stands that carries growth; 0: none of it does.
    std::vector<espalier::Version> carriersPlaced() const;
    // Makes the tables if they are due, and uploads grammars that have changed.
    espalier::Status refreshTables();
};
