#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"
#include "runtime/core/result.hpp"
#include "runtime/expand/growth.hpp"
#include "runtime/gpu/device.hpp"
#include "runtime/plugin/contents.hpp"
#include "runtime/plugin/id_table.hpp"
#include "runtime/render/renderer.hpp"

// What the C ABI calls a context. Every function of the ABI goes through guarded().
struct EspContext {
    espalier::Log log;
    std::string cacheFolder;
    mutable std::string error;

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
    uint64_t grammarRevisions = 0, towns = 0;
    espalier::IdTable<espalier::PlacedSurface> surfaces;
    espalier::IdTable<espalier::LoadedGrammar> grammars;
    espalier::IdTable<espalier::PlantedSeed> seeds;
    std::vector<espalier::PaintedLayer> layers;
    uint64_t layersMade = 0;  // ever
    espalier::IdTable<espalier::PaintStroke> strokes;
    std::map<std::string, std::optional<float>, std::less<>> filled;  // with what, as a whole: erasing leads there
    std::unique_ptr<espalier::Painter> painter;                       // made with the first stroke
    std::vector<espalier::SceneLayer> sceneLayers;
    espalier::TwinTable twins;
    std::vector<espalier::GrammarVariant> variants;
    std::vector<uint64_t> pruned;  // keys of branches, ascending

    EspGrowDef grow;
    std::unique_ptr<espalier::GrowthWatch> watch;  // null: nobody does
    // Of the inputs, since the last growth. Edits go through touch(), or note here what they changed and raise
    // `revision` themselves (for seeds that is all there is to do).
    espalier::GrowthChanges changes;
    std::vector<uint32_t> grownGrammars;  // ids, in the order of growth's indices
    uint64_t revision = 1;                // of everything that growth depends on
    uint64_t grownRevision = 0;           // what the growth was made from
    espalier::FailedInputs failed;
    bool contactsStale = false;  // surfaces came, went or moved
    std::vector<bool> moved;     // [instance]: plants on it may stand on what has moved since the last growth
    std::vector<espalier::SurfacePair> pairs;
    std::set<uint32_t> touched;     // surfaces of pairs that changed, until refreshContacts has told them
    uint32_t contactCount = 0;      // crossings between surfaces
    double contactMs = 0;           // of finding them the last time, CPU
    bool tablesStale = true;        // the two below don't describe surfaces and layers any more
    espalier::Buffer surfaceTable;  // SurfaceRef[stands().size()]
    uint64_t tablesRevision = 0;    // grows when they are made anew
    espalier::Buffer layerTable;    // LayerRef[stands().size() * kMaxLayers]
    double compileMs = 0;

    std::vector<uint32_t> grownSeeds;  // ids, in the order of growth's indices
    struct GrownSurface {
        uint32_t id = 0;  // 0: there was none
        glm::mat4 toWorld{1};
    };
    std::vector<GrownSurface> grownSurfaces;  // [instance], as growth found them
    std::optional<espalier::Plants> plants;   // what was grown, read back when asked for
    uint64_t plantsRevision = 0;              // of the growth's view

    bool hasPicture = false;
    uint32_t pictureWidth = 0, pictureHeight = 0;
    std::vector<std::byte> vertices, indices;  // of the last espMaterialise, until something grows

    // An input of growth changed in a way that only a full growth answers.
    void touch() {
        changes.everything = true;
        ++revision;
    }
    // The arrays of espMaterialise.
    void dropTriangles() { vertices = {}, indices = {}; }
    // The index by which growth and GrowthChanges know a grammar.
    uint32_t grammarIndex(uint32_t id) const;
    uint32_t surfaceSlots() const;
    // [instance]: where what has grown on a surface stands in the world, also if that has been destroyed since.
    std::vector<glm::mat4> stands() const;
    // Uploads what is stale of tables and grammars.
    espalier::Status refreshTables();
};

namespace espalier {

EspResult fail(const EspContext* context, EspResult code, std::string message);
// Is what a host gave among the enumerators from `first` to `last`? It may be any number, which C++ mustn't look at as
// one.
template <class Enum>
bool isAmong(const Enum& given, Enum first, Enum last) {
    static_assert(sizeof(Enum) == sizeof(int));
    int number = 0;
    std::memcpy(&number, &given, sizeof number);
    return number >= int(first) && number <= int(last);
}
constexpr const char* kNoMemory = "out of memory";  // short enough to take none
// Names of the meshes that grammars of roofs may ask for; reads their file the first time.
Status knowRoofMeshes(EspContext& context);
// Grows what has changed of the town; on failure the last roofs stand, and what changed waits.
EspResult updateTown(EspContext& context);
// Null: there is no town, or none that it grows by.
const LoadedGrammar* townGrammar(const EspContext& context);
// What the town's roofs read where nothing of the layer is painted.
float fillOverTown(const EspContext& context, const std::string& name);
// Gives roofs the town's layers, and adds to LoadedTown::changed the houses that have read what was painted since.
void bindTownLayers(EspContext& context, RoofInputs& inputs);
// Adds the town's roofs to what espMaterialise gives: TriangleVertex, uint32_t.
EspResult materialiseTown(EspContext& context, std::vector<std::byte>& vertices, std::vector<std::byte>& indices);
// The number by which the town's grammar knows the layer; kNoIndex.
uint32_t shownTownLayer(const EspContext& context, const std::string& name);
EspResult failContent(const EspContext* context, const Failure& failure);
// For failures of GPU work: DEVICE_LOST or OUT_OF_MEMORY, as the device says.
EspResult gpuCode(const EspContext& context);
EspResult failGpu(const EspContext* context, const Failure& failure);
// For work that may also refuse what it is given, as INVALID_CONTENT.
EspResult failWork(const EspContext* context, const Failure& failure);
// Why a file can't be read at all; empty: it can.
std::string whyUnreadable(const char* path);
// OK, or IO_FAILED with the system's reason, for a file that is to be read.
EspResult checkReadable(const EspContext* context, const char* path);

// Runs what grows: want of the host's own memory is a failure like that of the GPU's.
template <class F>
EspResult grownOr(const EspContext& context, F&& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return fail(&context, ESP_OUT_OF_MEMORY, kNoMemory);
    }
}

// What espLastError(NULL) tells: why this thread's last call without a context failed.
std::string& errorAlone();
inline EspResult failAlone(EspResult code, std::string_view message) noexcept {
    try {
        errorAlone() = message;
    } catch (...) {  // no memory for it: the code has to do
        errorAlone().clear();
    }
    return code;
}
// Runs a function of the ABI. No exception leaves it.
template <class F>
EspResult guarded(const EspContext* context, F&& body) noexcept {
    try {
        if (!context) return failAlone(ESP_INVALID_ARGUMENT, "there is no context: it is null");
        context->error.clear();
        return body();
    } catch (const std::bad_alloc&) {
        return fail(context, ESP_OUT_OF_MEMORY, kNoMemory);
    } catch (const std::exception& e) {
        return fail(context, ESP_INVALID_CONTENT, e.what());
    } catch (...) {
        return fail(context, ESP_INVALID_CONTENT, "unknown error");
    }
}

// The same for functions without a context.
template <class F>
EspResult guardedAlone(F&& body) noexcept {
    try {
        errorAlone().clear();
        return body();
    } catch (const std::bad_alloc&) {
        return failAlone(ESP_OUT_OF_MEMORY, kNoMemory);
    } catch (const std::exception& e) {
        return failAlone(ESP_INVALID_CONTENT, e.what());
    } catch (...) {
        return failAlone(ESP_INVALID_CONTENT, "unknown error");
    }
}

// The number by which nodes and kernels know the surface of this id.
inline uint32_t instanceOf(uint32_t surfaceId) {
    return (surfaceId & ((1u << IdTable<PlacedSurface>::kPlaceBits) - 1)) - 1;
}

// Of two places of a surface: a turn's columns are rounded.
inline bool sameScale(float a, float b) {
    return std::abs(a - b) <= 1e-5f * b;
}

// The id of the surface and the walk's place for a point of its mesh.
struct SurfacePoint {
    uint32_t surface = 0;  // id
    uint32_t chart = 0;
    glm::vec2 uv{0};
    glm::vec3 position{0}, normal{0};  // world; the triangle's own normal
    float distance = 0;
    bool bare = false;  // nothing grows there
};
// v: of any length but 0, though its square be more, or less, than a float holds.
glm::vec3 unitOf(glm::vec3 v);
std::optional<SurfacePoint> pickSurfaces(const EspContext& context, glm::vec3 origin, glm::vec3 direction);
std::optional<SurfacePoint> nearestOnSurfaces(const EspContext& context, glm::vec3 point);
const char* whyNoneNear(const EspContext& context);  // for messages, where there is no nearest
// About the nearest ground around a place on bare ground that is seen by who looks straight at it: not what lies behind
// a pane.
std::optional<SurfacePoint> groundBeside(const EspContext& context, const SurfacePoint& bare);

// The root of a seed's derivation path. Doesn't depend on other seeds or grammars.
uint64_t seedKey(const PlantedSeed& seed);
// Lets frozen plants grow again that have grown on a surface instance; with `across` only those that stand on others
// too.
void thawPlantsOn(EspContext& context, uint32_t instance, bool across);
// Adds the surfaces that plants on these may get to, over any number of contacts: [instance].
void addReached(const EspContext& context, std::vector<bool>& instances);
// Finds contacts between surfaces that came, went or moved, and gives them to the surfaces' GPU data.
Status refreshContacts(EspContext& context);
// Does another surface hide a seed's ground, within a solid body or beneath a face that lies on it? Such seeds wait. As
// surfaces stood at the last refreshContacts; costs microseconds where bodies are near, else next to nothing.
bool buriedByOthers(const EspContext& context, const PlantedSeed& seed);
// Takes a seed out, and all notes of it.
void removeSeed(EspContext& context, uint32_t id);
// The plants as last grown, read back if that is still to do; null on failure, which is noted.
const Plants* readPlants(EspContext& context);
// Makes the variants that seeds ask for, and brings up to date those whose grammar has changed.
Status refreshVariants(EspContext& context);
// Notes for the next growth what grows otherwise by these rules than by those that stood in their place. index: among
// growth's grammars.
struct BoundRules {
    const RuleMap& map;
    std::span<const uint32_t> layerOf;  // scene layer of each of the map's contexts
};
void noteRules(EspContext& context, uint32_t index, const BoundRules& before, const BoundRules& now);

// What is wrong with a brush; null: nothing.
const char* mistakeIn(const EspBrush& brush);
BrushLimits limitsOf(const EspBrush& brush);
// The numbers by which a kernel applies the brush; `fill` is the layer's.
BrushRecord recordOf(const EspBrush& brush, float fill);

// The number of the layer that a grammar's context reads; made if need be, from one that no grammar but `without` reads
// any more and that isn't among `kept` where there are kMaxLayers already. Nothing: all of those are read.
std::optional<uint32_t> sceneLayer(EspContext& context, const std::string& name, float fill,
                                   std::span<const uint32_t> kept = {}, uint32_t without = 0);
PaintedLayer* paintedLayer(EspContext& context, uint32_t surface, const std::string& name);
// What the first grammar that declares the layer fills it with; nothing if none does.
std::optional<float> declaredFill(const EspContext& context, const std::string& name);
// Tells growth that these 8×8 blocks of a layer have changed; where `texels` are given, of each block only those whose
// bit 8 y + x is set.
void layerChanged(EspContext& context, uint32_t surface, const std::string& name, std::span<const uint32_t> blocks,
                  std::span<const uint64_t> texels = {});
// Sets all texels of a layer (texelIndex order), and makes an ended stroke of it.
EspResult replaceLayer(EspContext& context, uint32_t surface, const std::string& name, std::span<const float> texels,
                       EspStroke* out);
void wholeLayerChanged(EspContext& context, uint32_t surface, const std::string& name);

}  // namespace espalier
