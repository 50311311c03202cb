// Fields as hosts ask for them: checked, and kept until something reads them.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMostElements = 4096, kMostStrokes = 65536, kMostStrokePoints = 1u << 20, kMostPoints = 1u << 24;
constexpr uint32_t kMostSide = 16384, kMostPasses = 10000;

bool allFinite(const float* numbers, size_t count) {
    return std::all_of(numbers, numbers + count, [](float x) { return std::isfinite(x); });
}

EspResult checkSamples(const EspContext* context, const EspFieldDef& def) {
    const auto refuse = [&](const std::string& why) {
        return fail(context, ESP_INVALID_ARGUMENT, "espSetField: " + why);
    };
    const bool both = def.vectors && def.tensors, either = def.vectors || def.tensors;
    if (def.pointCount > 0 ? !def.points || both || !either : def.points || either)
        return refuse("points need a count, and either vectors or tensors");
    if (def.pointCount > kMostPoints) return refuse("more than 16777216 points");
    const bool sized = def.pictureWidth > 0 && def.pictureHeight > 0;
    if (def.picture ? !sized || def.points : sized) return refuse("a picture needs a size, and no points beside it");
    if (def.pictureWidth > kMostSide || def.pictureHeight > kMostSide)
        return refuse("a picture of more than 16384 texels a side");
    const size_t count = def.pointCount;
    if (count > 0 && (!allFinite(def.points, count * 3) || (def.vectors && !allFinite(def.vectors, count * 3)) ||
                      (def.tensors && !allFinite(def.tensors, count * 6))))
        return refuse("a number of its points isn't finite");
    if (def.picture && !allFinite(def.picture, size_t(def.pictureWidth) * def.pictureHeight * 3))
        return refuse("a number of its picture isn't finite");
    return ESP_OK;
}

EspResult checkStrokes(const EspContext* context, const EspFieldDef& def) {
    if ((def.strokeCount > 0 && !def.strokes) || def.strokeCount > kMostStrokes)
        return fail(context, ESP_INVALID_ARGUMENT, "espSetField: null pointer, or more than 65536 strokes");
    uint64_t points = 0;
    for (uint32_t i = 0; i < def.strokeCount; ++i) {
        const EspFieldStroke& s = def.strokes[i];
        points += s.pointCount;
        if (points > kMostStrokePoints)
            return fail(context, ESP_INVALID_ARGUMENT, "espSetField: more than 1048576 points of strokes");
        if (!isAmong(s.brush, ESP_FIELD_COMB, ESP_FIELD_SMOOTH) || !(s.radius >= 0 && s.radius <= 1e9f) ||
            !(s.strength >= 0 && s.strength <= 1) || (s.pointCount > 0 && !s.points) ||
            !allFinite(s.points, size_t(s.pointCount) * 3))
            return fail(context, ESP_INVALID_ARGUMENT, "espSetField: stroke " + std::to_string(i) + " is out of range");
    }
    return ESP_OK;
}

std::vector<glm::vec3> vectorsOf(const float* numbers, size_t count) {
    std::vector<glm::vec3> all(numbers ? count : 0);
    for (size_t i = 0; i < all.size(); ++i) all[i] = vec(numbers + 3 * i);
    return all;
}

std::vector<FieldStroke> strokesOf(const EspFieldDef& def) {
    std::vector<FieldStroke> all;
    for (const EspFieldStroke& s : std::span(def.strokes, def.strokeCount))
        all.push_back({FieldBrush(s.brush), vectorsOf(s.points, s.pointCount), double(s.radius), double(s.strength)});
    return all;
}

// Whether an earlier call gave the same numbers. values: vectors or tensors, which are floats and nothing else.
template <class Value>
bool isSame(const std::vector<Value>& values, const float* numbers, size_t count) {
    return values.size() == (numbers ? count : 0) &&
           (values.empty() || std::memcmp(values.data(), numbers, count * sizeof(Value)) == 0);
}
bool isSame(const FieldSamples& samples, const EspFieldDef& def) {
    return isSame(samples.points, def.points, def.pointCount) && isSame(samples.vectors, def.vectors, def.pointCount) &&
           isSame(samples.tensors, def.tensors, def.pointCount);
}
bool isSame(const VectorPicture& picture, const EspFieldDef& def) {
    return picture.width == def.pictureWidth && picture.height == def.pictureHeight &&
           isSame(picture.texels, def.picture, size_t(def.pictureWidth) * def.pictureHeight);
}

std::shared_ptr<const FieldSamples> samplesOf(const EspFieldDef& def) {
    auto samples = std::make_shared<FieldSamples>(
        FieldSamples{vectorsOf(def.points, def.pointCount), vectorsOf(def.vectors, def.pointCount), {}});
    samples->tensors.resize(def.tensors ? def.pointCount : 0);
    if (def.tensors) std::memcpy(samples->tensors.data(), def.tensors, sizeof(float) * 6 * def.pointCount);
    return samples;
}

// What is the same as before stays the same object, so that what was made of it is known; it isn't even copied, since
// hosts give a whole file with each change of what lies over it.
void takeSamples(const EspFieldDef& def, const AskedField& before, AskedField& asked) {
    if (def.pointCount > 0)
        asked.samples = before.samples && isSame(*before.samples, def) ? before.samples : samplesOf(def);
    if (!def.picture) return;
    asked.picture = before.picture && isSame(*before.picture, def)
                        ? before.picture
                        : std::make_shared<VectorPicture>(
                              VectorPicture{def.pictureWidth, def.pictureHeight,
                                            vectorsOf(def.picture, size_t(def.pictureWidth) * def.pictureHeight)});
}

EspResult checkField(const EspContext* context, const EspFieldDef& def) {
    if ((def.elementCount > 0 && !def.elements) || def.elementCount > kMostElements)
        return fail(context, ESP_INVALID_ARGUMENT, "espSetField: null pointer, or more than 4096 elements");
    if (!finite(def.drift) || !(def.lean >= 0 && def.lean <= 1e6f))
        return fail(context, ESP_INVALID_ARGUMENT, "espSetField: the drift isn't finite, or 'lean' isn't 0 to 1e6");
    for (uint32_t i = 0; i < def.elementCount; ++i) {
        const EspFieldElement& e = def.elements[i];
        if (!isAmong(e.kind, ESP_ELEMENT_REGULAR, ESP_ELEMENT_SADDLE) || !finite(e.position) || !finite(e.direction) ||
            !(e.radius >= 0 && e.radius <= 1e9f))
            return fail(context, ESP_INVALID_ARGUMENT,
                        "espSetField: element " + std::to_string(i) + " is out of range");
    }
    if (def.summed && def.exact)
        return fail(context, ESP_INVALID_ARGUMENT, "espSetField: a field is either exact or summed");
    if (def.passes > kMostPasses) return fail(context, ESP_INVALID_ARGUMENT, "espSetField: more than 10000 passes");
    if (EspResult bad = checkStrokes(context, def)) return bad;
    return checkSamples(context, def);
}

}  // namespace

void setDefaults(EspFieldDef& def) {
    const AskedField standard;
    std::memcpy(def.drift, standard.drift, sizeof def.drift);
    def.lean = standard.lean;
    def.passes = standard.passes;
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espDefaultFieldDef(EspFieldDef* out) {
    return giveDefaults("espDefaultFieldDef", out);
}

EspResult espSetField(EspContext* context, EspSurface surface, const char* name, const EspFieldDef* given) {
    return guarded(context, [&] {
        if (!context->surfaces.find(surface.id) || !name || !*name)
            return fail(context, ESP_INVALID_ARGUMENT, "espSetField: no such surface, or no name");
        ContextPatterns& patterns = context->patterns;
        const std::pair<uint32_t, std::string> key{surface.id, name};
        if (!given) {
            if (patterns.asked.erase(key) > 0) context->nodes.fields.change();
            return ESP_OK;
        }
        const EspFieldDef def = taken("espSetField", given);
        if (EspResult bad = checkField(context, def)) return bad;
        AskedField asked;
        asked.elements.assign(def.elements, def.elements + def.elementCount);
        std::memcpy(asked.drift, def.drift, sizeof asked.drift);
        asked.lean = def.lean;
        asked.exact = def.exact != 0;
        asked.summed = def.summed != 0;
        asked.passes = def.passes;
        asked.strokes = strokesOf(def);
        takeSamples(def, patterns.asked[key], asked);
        asked.number = context->nodes.fields.change();
        patterns.asked[key] = std::move(asked);
        return ESP_OK;
    });
}

EspResult espFieldSingularities(EspContext* context, EspSurface surface, const char* name, EspSingularity* out,
                                uint32_t* count) {
    return guarded(context, [&] {
        const PlacedSurface* placed = context->surfaces.find(surface.id);
        const FieldInfo* info = name ? fieldNamed(*context, name) : nullptr;
        if (!placed || !info || !count)
            return fail(context, ESP_INVALID_ARGUMENT,
                        "espFieldSingularities: no such surface, no grammar that declares the field, or no count");
        const Result<MadeField*> made = fieldOn(*context, surface.id, *info);
        if (!made) return failWork(context, made.failure());
        std::vector<Singularity> found;
        const FieldMesh& mesh = context->patterns.ground[surface.id].mesh;
        if (made.value()) found = singularitiesOf(mesh, made.value()->field);
        for (uint32_t i = 0; out && i < std::min(size_t(*count), found.size()); ++i) {
            const glm::vec3 place(placed->toWorld * glm::vec4(glm::vec3(placeOf(mesh, found[i])), 1));
            out[i] = {{place.x, place.y, place.z}, float(found[i].turns) / float(info->symmetry)};
        }
        *count = uint32_t(found.size());
        return ESP_OK;
    });
}

}  // extern "C"
