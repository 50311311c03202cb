// What a scene says of its fields -> the context.
#include "tools/scene/fields.hpp"

#include <cstring>

#include "plugin_api/espalier.hpp"

namespace espalier::scene {
namespace {

std::vector<EspFieldElement> elementsOf(const SceneField& field) {
    std::vector<EspFieldElement> elements;
    for (const SceneElement& e : field.elements) {
        EspFieldElement& out = elements.emplace_back(EspFieldElement{});
        (void)elementNamed(e.kind, out.kind);
        std::memcpy(out.position, e.position.data(), sizeof out.position);
        std::memcpy(out.direction, e.direction.data(), sizeof out.direction);
        out.radius = e.radius;
    }
    return elements;
}

std::vector<EspFieldStroke> strokesOf(const SceneField& field) {
    std::vector<EspFieldStroke> strokes;
    for (const SceneStroke& s : field.strokes) {
        EspFieldStroke& out = strokes.emplace_back(EspFieldStroke{});
        (void)fieldBrushNamed(s.brush, out.brush);
        out.radius = s.radius;
        out.strength = s.strength;
        out.pointCount = uint32_t(s.points.size());
        out.points = s.points.empty() ? nullptr : s.points[0].data();
    }
    return strokes;
}

// Of a file; points: room for its points, as the surface has them.
void give(const FieldFile& file, const EspSurfaceInfo& surface, std::vector<float>& points, EspFieldDef& def) {
    if (file.width > 0) {
        def.picture = file.vectors.data();
        def.pictureWidth = file.width;
        def.pictureHeight = file.height;
        return;
    }
    points.reserve(file.points.size() * 3);
    for (const auto& point : file.points)
        for (size_t k = 0; k < 3; ++k) points.push_back(float(point[k] - surface.origin[k]));
    def.points = points.data();
    def.pointCount = uint32_t(file.points.size());
    def.vectors = file.vectors.empty() ? nullptr : file.vectors.data();
    def.tensors = file.tensors.empty() ? nullptr : file.tensors.data();
}

EspResult setField(EspContext* context, EspSurface surface, const SceneField& field) {
    const std::vector<EspFieldElement> elements = elementsOf(field);
    const std::vector<EspFieldStroke> strokes = strokesOf(field);
    std::vector<float> points;
    EspFieldDef def = esp::defaults<EspFieldDef>();
    def.elements = elements.data();
    def.elementCount = uint32_t(elements.size());
    std::memcpy(def.drift, field.drift.data(), sizeof def.drift);
    def.lean = field.lean;
    def.exact = field.exact;
    def.summed = field.summed;
    def.passes = field.passes;
    def.strokes = strokes.data();
    def.strokeCount = uint32_t(strokes.size());
    if (field.given) {
        EspSurfaceInfo info;
        if (const EspResult asked = espSurfaceInfo(context, surface, &info); asked != ESP_OK) return asked;
        give(*field.given, info, points, def);
    }
    return espSetField(context, surface, field.name.c_str(), &def);
}

}  // namespace

bool readGiven(SceneField& field, std::string& error) {
    field.given.reset();
    if (field.file.empty()) return true;
    auto given = std::make_shared<FieldFile>();
    if (!readFieldFile(field.file, field.name, *given, error)) return false;
    field.given = std::move(given);
    return true;
}

EspResult setFields(EspContext* context, EspSurface surface, const std::vector<SceneField>& fields) {
    for (const SceneField& field : fields)
        if (const EspResult set = setField(context, surface, field); set != ESP_OK) return set;
    return ESP_OK;
}

}  // namespace espalier::scene
