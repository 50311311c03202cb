#pragma once

// Fields of a scene's surfaces: what is said of them in its file, and to a context.

#include <array>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"

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
// The field of this name on one surface.
struct SceneField {
    std::string name;
    std::array<float, 3> drift{0, -1, 0};
    float lean = 1;
    std::vector<SceneElement> elements;
    bool exact = false;  // no singularities but the elements' and those that topology asks for
    template <class V>
    void fields(V&& v) {
        v("name", name), v("drift", drift), v("lean", lean), v("elements", elements), v("exact", exact);
    }
    bool operator==(const SceneField&) const = default;
};

// False: there is no such kind of element.
bool elementNamed(const std::string& name, EspElementKind& out);

// Gives the surface its fields; a failure is the context's.
EspResult setFields(EspContext* context, EspSurface surface, const std::vector<SceneField>& fields);

}  // namespace espalier::scene
