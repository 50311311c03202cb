// Fields of surfaces: what is said of one, strokes of brushes over it, and what takes that back.
#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/document/document.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::document {
namespace {

using scene::SceneField;
using scene::SceneStroke;

const SceneField* fieldOf(const scene::Scene& scene, uint32_t surface, const std::string& name) {
    if (surface >= scene.surfaces.size()) return nullptr;
    const auto& fields = scene.surfaces[surface].fields;
    const auto known = std::ranges::find(fields, name, &SceneField::name);
    return known != fields.end() ? &*known : nullptr;
}

bool isStroke(const SceneStroke& stroke, std::string& error) {
    const auto isPoint = [](const std::array<float, 3>& p) {
        return std::ranges::all_of(p, [](float x) { return std::isfinite(x); });
    };
    EspFieldBrush known;
    error = !scene::fieldBrushNamed(stroke.brush, known)      ? "there is no brush '" + stroke.brush + "'"
            : !std::ranges::all_of(stroke.points, isPoint)    ? "a point of a stroke isn't finite"
            : !(stroke.radius >= 0 && stroke.radius <= 1e9f)  ? "the radius of a stroke isn't 0 to 1e9 m"
            : !(stroke.strength >= 0 && stroke.strength <= 1) ? "the strength of a stroke isn't 0 to 1"
                                                              : "";
    return error.empty();
}

// The same brush, so that its points may follow.
bool isLike(const SceneStroke& a, const SceneStroke& b) {
    return a.brush == b.brush && a.radius == b.radius && a.strength == b.strength;
}

// What lays strokes again that trimming takes away: performed from the last to the first.
std::vector<Action> strokesBack(const TrimField& trim, const std::vector<SceneStroke>& strokes) {
    std::vector<Action> back;
    for (size_t i = strokes.size(); i > trim.strokes; --i)
        back.push_back(BrushField{trim.surface, trim.field, strokes[i - 1]});
    if (trim.strokes == 0 || trim.points == strokes[trim.strokes - 1].points.size()) return back;
    SceneStroke rest = strokes[trim.strokes - 1];
    rest.points.erase(rest.points.begin(), rest.points.begin() + std::ptrdiff_t(trim.points));
    back.push_back(BrushField{trim.surface, trim.field, std::move(rest), true});
    return back;
}

SetField withoutStrokes(uint32_t surface, SceneField field, bool said) {
    field.strokes.clear();
    return {surface, std::move(field), said};
}

}  // namespace

// Many steps may share one file, but only one of them let it go.
size_t Document::droppedBytes(const SetField& back) const {
    const SceneField* now = fieldOf(scene_, back.surface, back.field.name);
    return back.field.given && (!now || now->given != back.field.given) ? back.field.given->bytes() : 0;
}

// Gives the surface the field, or takes it from it. The context may refuse; then all is as it was.
bool Document::changeField(uint32_t surface, const std::string& name, const std::optional<SceneField>& now,
                           std::string& error) {
    scene::LoadedSurface& on = scene_.surfaces[surface];
    const EspResult set =
        now ? scene::setFields(context_, on.id, {*now}) : espSetField(context_, on.id, name.c_str(), nullptr);
    if (failed(set, error)) return false;
    std::erase_if(on.fields, [&](const SceneField& field) { return field.name == name; });
    if (now) on.fields.insert(std::ranges::upper_bound(on.fields, name, {}, &SceneField::name), *now);
    return true;
}

bool Document::carryOut(const SetField& action, std::vector<Action>& back, std::string& error) {
    if (action.surface >= scene_.surfaces.size()) {
        error = "there is no surface " + std::to_string(action.surface);
        return false;
    }
    SceneField now = action.field;
    for (const scene::SceneElement& element : now.elements)
        if (EspElementKind kind; !scene::elementNamed(element.kind, kind)) {
            error = "there is no element of the kind '" + element.kind + "'";
            return false;
        }
    const SceneField* known = fieldOf(scene_, action.surface, now.name);
    const SceneField before = known ? *known : SceneField{.name = now.name, .elements = {}};
    now.strokes = before.strokes;
    if (!now.file.empty()) now.file = scene::absolutePath(now.file).string();
    if (now.file == before.file)
        now.given = before.given;
    else if (!now.given && !scene::readGiven(now, error))
        return false;
    if (!changeField(action.surface, now.name, action.said ? std::optional(now) : std::nullopt, error)) return false;
    if (!action.said) back = strokesBack({action.surface, now.name}, before.strokes);
    back.push_back(withoutStrokes(action.surface, before, known != nullptr));
    return true;
}

bool Document::carryOut(const BrushField& action, std::vector<Action>& back, std::string& error) {
    if (action.surface >= scene_.surfaces.size()) {
        error = "there is no surface " + std::to_string(action.surface);
        return false;
    }
    if (!isStroke(action.stroke, error)) return false;
    const SceneField* known = fieldOf(scene_, action.surface, action.field);
    SceneField now = known ? *known : SceneField{.name = action.field, .elements = {}};
    const bool first = !known || known->strokes.empty();
    TrimField trim{action.surface, action.field, uint32_t(now.strokes.size()), 0, known != nullptr};
    if (!first) trim.points = uint32_t(now.strokes.back().points.size());
    if (action.goesOn && (first || !isLike(now.strokes.back(), action.stroke))) {
        error = "there is no stroke of this brush to go on with";
        return false;
    }
    if (!action.goesOn)
        now.strokes.push_back(SceneStroke{action.stroke.brush, action.stroke.radius, action.stroke.strength, {}});
    auto& points = now.strokes.back().points;
    points.insert(points.end(), action.stroke.points.begin(), action.stroke.points.end());
    if (!changeField(action.surface, action.field, now, error)) return false;
    back.push_back(std::move(trim));
    return true;
}

bool Document::carryOut(const TrimField& action, std::vector<Action>& back, std::string& error) {
    const SceneField* known = fieldOf(scene_, action.surface, action.field);
    const size_t count = known ? known->strokes.size() : 0;
    const size_t points =
        action.strokes > 0 && action.strokes <= count ? known->strokes[action.strokes - 1].points.size() : 0;
    if (!known || action.strokes > count || action.points > points) {
        error = "the field '" + action.field + "' has fewer strokes";
        return false;
    }
    const SceneField before = *known;
    SceneField now = before;
    now.strokes.resize(action.strokes);
    if (action.strokes > 0) now.strokes.back().points.resize(action.points);
    if (!changeField(action.surface, action.field, action.said ? std::optional(now) : std::nullopt, error))
        return false;
    TrimField trimmed = action;
    if (!action.said) trimmed.strokes = 0;
    back = strokesBack(trimmed, before.strokes);
    if (!action.said) back.push_back(withoutStrokes(action.surface, before, true));
    return true;
}

}  // namespace espalier::document
