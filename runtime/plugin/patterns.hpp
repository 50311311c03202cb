#pragma once

// Patterns of a context: the pieces there are, fields on surfaces, and what has been derived (patterns.cpp,
// api_patterns.cpp).

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"
#include "runtime/emit/terminals.hpp"
#include "runtime/field/field_picture.hpp"
#include "runtime/field/field_solver.hpp"
#include "runtime/field/field_texels.hpp"
#include "runtime/gpu/buffer.hpp"
#include "runtime/pattern/pattern_growth.hpp"
#include "runtime/plugin/contents.hpp"

namespace espalier {

// What a host has said of one field of one surface; elements and drift in the world, the rest in the surface's space.
struct AskedField {
    std::vector<EspFieldElement> elements;
    std::vector<Remainder> remainders;  // of their positions, where the origin has moved
    float drift[3] = {0, -1, 0};
    float lean = 1;
    bool exact = false, summed = false;
    uint32_t passes = 300;
    std::vector<FieldStroke> strokes;
    std::shared_ptr<const FieldSamples> samples;   // null: none
    std::shared_ptr<const VectorPicture> picture;  // likewise
    Version number = 0;                            // unlike any other that was asked for; 0: the default
};

// A field as kernels read it.
struct MadeField {
    Version asked = 0;  // AskedField::number
    uint32_t symmetry = 0;
    glm::mat4 toObject{1};                         // by which elements and drift were taken into object space
    std::shared_ptr<const VectorPicture> picture;  // that the samples are of, if they are of one
    std::shared_ptr<const FieldSamples> samples;   // of the field
    std::unique_ptr<FieldSolver> solver;
    Field field;
    Buffer texels;
    uint32_t size = 0;  // texels a side
};

struct FieldGround {
    std::unique_ptr<SurfaceData> surface;  // what fields need of it
    FieldMesh mesh;
    std::unique_ptr<FieldSampling> sampling;
    std::map<std::string, MadeField> made;
};

// A field as pictures show it: three layers a surface, the colours.
struct FieldView {
    struct Shown {
        Field field;
        FieldPicture picture;  // of that
        std::array<Buffer, 3> texels;
    };
    std::string name;
    std::vector<uint64_t> from;       // versions of what it was made from
    std::map<uint32_t, Shown> shown;  // by surface's id
    Buffer table;                     // as EspContext::layerTable, of the first three layers only
};

struct ContextPatterns {
    std::filesystem::path shipped, file;  // of the pieces' meshes: those that are there at first, and now
    std::vector<TerminalMesh> names;
    std::optional<TerminalData> data;  // until the renderer has it
    PieceMeshes meshes;
    std::unique_ptr<PatternGrowth> growth;                         // made when the first pattern grows
    std::map<std::pair<uint32_t, std::string>, AskedField> asked;  // by surface's id and name
    std::map<uint32_t, FieldGround> ground;                        // by surface's id; made when a pattern first asks
    FieldView view;
    uint64_t grownFrom = 0;  // what the pattern was derived from; 0: nothing stands
    uint32_t seeds = 0;
    PatternStats stats;
    std::vector<Remainder> remainders;  // of positions of pieces, likewise
    FailedInputs failed;
};

// A field of this name that a grammar declares; null: none does.
const FieldInfo* fieldNamed(const EspContext& context, const std::string& name);
// A field on one surface, made anew if what was asked for is another than it was made from. Null: the surface has no
// triangles.
Result<MadeField*> fieldOn(EspContext& context, uint32_t surface, const FieldInfo& info);
// Drops what is known of surfaces that are there no more.
void forgetGoneFields(EspContext& context);
// A table of layers whose first three show the field on each surface.
Result<LayerBuf> fieldLayers(EspContext& context, const FieldInfo& info);

// Names of the meshes that grammars of patterns may ask for; reads their file the first time.
Status knowPieces(EspContext& context);
// Takes the meshes of another file, or of the shipped one where `file` is empty, before any grammar knows them. On
// failure they are what they were.
EspResult usePieces(EspContext& context, const std::filesystem::path& file);
// Moves what stands, together with all that it stands on: nothing is derived.
EspResult shiftPatterns(EspContext& context, const glm::dvec3& by);
// After all has moved together: patterns are as up to date as they were.
void keepPatterns(EspContext& context);
// For a renderer that is new, if there were any.
EspResult readPiecesAgain(EspContext& context);
// Derives patterns anew if something that they depend on has changed; on failure the last ones stand.
EspResult updatePatterns(EspContext& context);
// Whether a seed begins a pattern, no plant.
bool beginsPattern(const EspContext& context, const PlantedSeed& seed);

}  // namespace espalier
