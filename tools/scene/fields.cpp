#include "tools/scene/fields.hpp"

#include <cstring>

#include "plugin_api/espalier.hpp"

namespace espalier::scene {
namespace {

constexpr struct {
    const char* name;
    EspElementKind kind;
} kKinds[] = {{"regular", ESP_ELEMENT_REGULAR}, {"wedge", ESP_ELEMENT_WEDGE},   {"trisector", ESP_ELEMENT_TRISECTOR},
              {"node", ESP_ELEMENT_NODE},       {"centre", ESP_ELEMENT_CENTRE}, {"saddle", ESP_ELEMENT_SADDLE}};

}  // namespace

bool elementNamed(const std::string& name, EspElementKind& out) {
    for (const auto& row : kKinds) {
        if (name != row.name) continue;
        out = row.kind;
        return true;
    }
    return false;
}

EspResult setFields(EspContext* context, EspSurface surface, const std::vector<SceneField>& fields) {
    for (const SceneField& field : fields) {
        std::vector<EspFieldElement> elements;
        for (const SceneElement& e : field.elements) {
            EspFieldElement& out = elements.emplace_back(EspFieldElement{});
            (void)elementNamed(e.kind, out.kind);
            std::memcpy(out.position, e.position.data(), sizeof out.position);
            std::memcpy(out.direction, e.direction.data(), sizeof out.direction);
            out.radius = e.radius;
        }
        EspFieldDef def = esp::defaults<EspFieldDef>();
        def.elements = elements.data();
        def.elementCount = uint32_t(elements.size());
        std::memcpy(def.drift, field.drift.data(), sizeof def.drift);
        def.lean = field.lean;
        def.exact = field.exact;
        if (const EspResult set = espSetField(context, surface, field.name.c_str(), &def); set != ESP_OK) return set;
    }
    return ESP_OK;
}

}  // namespace espalier::scene
