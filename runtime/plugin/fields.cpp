// Enters: fields that were asked for. Leaves: fields as kernels read them, and pictures of them.
#include <bit>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/patterns.hpp"

namespace espalier {
namespace {

Result<FieldGround*> groundOf(EspContext& context, uint32_t id) {
    FieldGround& ground = context.patterns.ground[id];
    if (ground.surface) return &ground;
    const PlacedSurface& placed = *context.surfaces.find(id);
    auto surface = std::make_unique<SurfaceData>();
    surface->charts = placed.content->data.charts;
    if (Status read = placed.gpu.readForFields(*context.device, *surface); !read) return read.failure();
    ground.mesh = makeFieldMesh(*surface);
    ground.sampling = std::make_unique<FieldSampling>(*surface, ground.mesh);
    ground.surface = std::move(surface);
    return &ground;
}

glm::dvec3 turnedBy(const glm::mat4& m, const float v[3]) {
    return glm::dvec3(glm::mat3(m) * vec(v));
}

FieldDesign designOf(const AskedField& asked, const PlacedSurface& surface, uint32_t symmetry) {
    FieldDesign design;
    design.symmetry = symmetry;
    design.drift = turnedBy(surface.toObject, asked.drift);
    design.lean = double(asked.lean);
    design.exact = asked.exact;
    design.summed = asked.summed;
    design.passes = asked.passes;
    design.strokes = asked.strokes;
    for (const EspFieldElement& e : asked.elements) {
        const FieldElement element{ElementKind(e.kind), glm::dvec3(surface.toObject * glm::vec4(vec(e.position), 1)),
                                   turnedBy(surface.toObject, e.direction), double(e.radius / surface.scale)};
        if (fits(element.kind, symmetry)) design.elements.push_back(element);
    }
    return design;
}

// Of a picture they are read once.
std::shared_ptr<const FieldSamples> samplesFor(const AskedField& asked, const FieldGround& ground,
                                               const MadeField& made) {
    if (!asked.picture) return asked.samples;
    if (made.picture == asked.picture) return made.samples;
    return std::make_shared<FieldSamples>(samplesOf(*ground.surface, ground.mesh, *asked.picture));
}

Result<Field> designed(EspContext& context, const FieldGround& ground, const AskedField& asked,
                       const PlacedSurface& surface, const FieldInfo& info, MadeField& made) {
    FieldDesign design = designOf(asked, surface, info.symmetry);
    design.samples = samplesFor(asked, ground, made);
    if (!made.solver) made.solver = std::make_unique<FieldSolver>(ground.mesh);
    Result<Field> field = made.solver->design(design);
    if (!field) return Failure("field '" + info.name + "'", field.failure().diagnostics.front().message);
    const bool other = made.samples != design.samples;
    made.picture = asked.picture;
    made.samples = design.samples;
    if (other && field->unsampled > 0)
        context.log(Severity::warning, "field '" + info.name + "': " + std::to_string(field->unsampled) + " of " +
                                           std::to_string(ground.mesh.positions.size()) +
                                           " vertices have nothing of what was given near by, and follow the others");
    return field;
}

// What hasn't changed of a picture stays.
Status showField(EspContext& context, const FieldGround& ground, const Field& field, FieldView::Shown& shown) {
    if (shown.field.symmetry == field.symmetry && shown.field.power == field.power) return Done{};
    if (shown.field.symmetry == field.symmetry && shown.field.power.size() == field.power.size())
        updateFieldPicture(*ground.surface, ground.mesh, shown.field, field, shown.picture);
    else
        shown.picture = fieldPicture(*ground.surface, ground.mesh, field);
    shown.field = field;
    for (size_t c = 0; c < shown.texels.size(); ++c) {
        Status made = assign(shown.texels[c], makeBuffer(*context.device, "field picture", shown.picture.channels[c]));
        if (made) continue;
        shown.field.power.clear();  // the next picture is made anew
        return made;
    }
    return Done{};
}

// Of the field that shows under this name, on one surface.
Status addPicture(EspContext& context, uint32_t id, const FieldInfo& info, std::span<LayerRef> layers) {
    const Result<MadeField*> made = fieldOn(context, id, info);
    if (!made) return made.failure();
    if (!made.value()) return Done{};
    FieldView::Shown& shown = context.patterns.view.shown[id];
    if (Status painted = showField(context, context.patterns.ground[id], made.value()->field, shown); !painted)
        return painted;
    for (size_t c = 0; c < shown.texels.size(); ++c)
        layers[c] = {addressOf<FloatBuf>(shown.texels[c]), shown.picture.size, 0};
    return Done{};
}

}  // namespace

const FieldInfo* fieldNamed(const EspContext& context, const std::string& name) {
    const FieldInfo* found = nullptr;
    context.grammars.forEach([&](uint32_t, const LoadedGrammar& grammar) {
        for (const FieldInfo& info : grammar.map.fields())
            if (!found && info.name == name) found = &info;
    });
    return found;
}

Result<MadeField*> fieldOn(EspContext& context, uint32_t id, const FieldInfo& info) {
    const PlacedSurface& surface = *context.surfaces.find(id);
    Result<FieldGround*> found = groundOf(context, id);
    if (!found) return found.failure();
    FieldGround& ground = **found;
    if (ground.mesh.triangles.empty()) return static_cast<MadeField*>(nullptr);
    static const AskedField kDefault;
    const auto asked = context.patterns.asked.find({id, info.name});
    const AskedField& wish = asked != context.patterns.asked.end() ? asked->second : kDefault;
    MadeField& made = ground.made[info.name + (info.curvature ? "\n" : "")];
    const bool same = made.texels && made.symmetry == info.symmetry &&
                      (info.curvature || (made.asked == wish.number && made.toObject == surface.toObject));
    if (!same) {
        Result<Field> field = info.curvature ? Result<Field>(curvatureField(ground.mesh))
                                             : designed(context, ground, wish, surface, info, made);
        if (!field) return field.failure();
        Result<Buffer> texels = makeBuffer(*context.device, "field texels", ground.sampling->texels(*field));
        if (!texels) return texels.failure();
        made.asked = wish.number;
        made.symmetry = info.symmetry;
        made.toObject = surface.toObject;
        made.size = ground.surface->levels[0].size;
        made.field = std::move(*field);
        made.texels = std::move(*texels);
    }
    return &made;
}

void forgetGoneFields(EspContext& context) {
    std::erase_if(context.patterns.ground, [&](const auto& g) { return !context.surfaces.find(g.first); });
    std::erase_if(context.patterns.asked, [&](const auto& a) { return !context.knowsSurface(a.first.first); });
}

Result<LayerBuf> fieldLayers(EspContext& context, const FieldInfo& info) {
    FieldView& view = context.patterns.view;
    forgetGoneFields(context);
    const std::vector<uint64_t> from{context.nodes.fields.version(), context.nodes.tables.version(), info.symmetry,
                                     info.curvature};
    if (view.name != info.name) view = {};
    if (view.from != from) {
        std::erase_if(view.shown, [&](const auto& s) { return !context.surfaces.find(s.first); });
        std::vector<LayerRef> layers(std::max(context.surfaceSlots(), 1u) * kMaxLayers, LayerRef{{nullptr}, 0, .2f});
        Status all = Done{};
        context.surfaces.forEach([&](uint32_t id, const PlacedSurface& surface) {
            if (all) all = addPicture(context, id, info, std::span(layers).subspan(surface.instance * kMaxLayers, 3));
        });
        if (!all) return all.failure();
        if (Status made = assign(view.table, makeBuffer(*context.device, "field picture table", layers)); !made)
            return made.failure();
        view.name = info.name;
        view.from = from;
    }
    return addressOf<LayerBuf>(view.table);
}

}  // namespace espalier
