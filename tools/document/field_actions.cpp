// Fields of surfaces: what is said of one, and what takes that back.
#include <algorithm>

#include "tools/document/document.hpp"

namespace espalier::document {

bool Document::carryOut(const SetField& action, std::vector<Action>& back, std::string& error) {
    if (action.surface >= scene_.surfaces.size()) {
        error = "there is no surface " + std::to_string(action.surface);
        return false;
    }
    for (const scene::SceneElement& element : action.field.elements)
        if (EspElementKind kind; !scene::elementNamed(element.kind, kind)) {
            error = "there is no element of the kind '" + element.kind + "'";
            return false;
        }
    scene::LoadedSurface& surface = scene_.surfaces[action.surface];
    const std::string& name = action.field.name;
    const EspResult set = action.said ? scene::setFields(context_, surface.id, {action.field})
                                      : espSetField(context_, surface.id, name.c_str(), nullptr);
    if (failed(set, error)) return false;
    const auto known = std::ranges::find(surface.fields, name, &scene::SceneField::name);
    const bool before = known != surface.fields.end();
    back.push_back(SetField{action.surface, before ? *known : scene::SceneField{.name = name, .elements = {}}, before});
    if (before && !action.said)
        surface.fields.erase(known);
    else if (before)
        *known = action.field;
    else if (action.said)
        surface.fields.push_back(action.field);
    std::ranges::sort(surface.fields, {}, &scene::SceneField::name);
    return true;
}

}  // namespace espalier::document
