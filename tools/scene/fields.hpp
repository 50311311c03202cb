#pragma once

// Fields of a scene's surfaces: what is said of them in its file, and to a context.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"
#include "tools/scene/field_file.hpp"

namespace espalier::scene {

struct SceneElement {
    std::string kind = "regular";  // wedge, trisector, node, centre, saddle
    std::array<float, 3> position{}, direction{1, 0, 0};
    float radius = 0;  // metres; 0: a tenth of the surface's radius
    template <class V>
    void fields(V&& v) {
        v("kind", kind), v("position", position), v("direction", direction), v("radius", radius);
    }
    bool operator==(const SceneElement&) const = default;
};
// A stroke of a brush over a field, as of EspFieldStroke.
struct SceneStroke {
    std::string brush = "comb";  // or "smooth"
    float radius = 0, strength = .5f;
    std::vector<std::array<float, 3>> points;  // in the surface's space
    template <class V>
    void fields(V&& v) {
        v("brush", brush), v("radius", radius), v("strength", strength), v("points", points);
    }
    bool operator==(const SceneStroke&) const = default;
};
constexpr uint32_t kUsualPasses = 300;

// The field of this name on one surface.
struct SceneField {
    std::string name;
    std::array<float, 3> drift{0, -1, 0};
    float lean = 1;
    std::vector<SceneElement> elements;
    bool exact = false;   // no singularities but the elements' and those that topology asks for
    bool summed = false;  // the paper's way, with so many passes of smoothing
    uint32_t passes = kUsualPasses;
    std::string file = {};                        // that another program's field comes from; empty: none
    std::shared_ptr<const FieldFile> given = {};  // what the file holds; null: nothing, or it couldn't be read
    std::vector<SceneStroke> strokes = {};
    // But for the strokes, which come and go by actions of their own.
    template <class V>
    void fields(V&& v) {
        v("name", name), v("drift", drift), v("lean", lean), v("elements", elements), v("exact", exact);
        v.optional("file", file), v.optional("summed", summed);
        std::optional<uint32_t> said = passes;
        if (!summed && passes == kUsualPasses) said.reset();
        v.optional("passes", said);
        passes = said.value_or(kUsualPasses);
    }
    bool operator==(const SceneField&) const = default;
};

// False: there is no such kind of element, or no such brush.
bool elementNamed(const std::string& name, EspElementKind& out);
bool fieldBrushNamed(const std::string& name, EspFieldBrush& out);

// Reads the field's file, if it names one. False: `error` says why, and nothing is given.
bool readGiven(SceneField& field, std::string& error);

// Gives the surface its fields; a failure is the context's.
EspResult setFields(EspContext* context, EspSurface surface, const std::vector<SceneField>& fields);

}  // namespace espalier::scene
