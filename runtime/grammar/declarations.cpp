// A module's params, contexts and lets -> what expressions find by name; names that are taken, or never used, are said.
#include <algorithm>

#include "runtime/grammar/expressions.hpp"

namespace espalier::grammar {

bool Expressions::takeName(const std::string& name, const Place& place) {
    std::string reserved = reservedFor(name);
    if (!reserved.empty()) {
        reporter_.error(place, name, reserved + "; take another");
        return false;
    }
    if (!names_.insert(name).second) {
        reporter_.error(place, name, "'" + name + "' is declared twice");
        return false;
    }
    return true;
}

float Expressions::constantOf(ExprId expr, const std::string& rule, float otherwise) {
    if (expr == kNoExpr) return otherwise;
    Env env;
    env.rule = rule;
    Node node = lower(expr, env);
    if (graph_.isConstant(node)) return graph_[node].value;
    if (!graph_.isMistaken(node))
        reporter_.error(module_.exprs[expr].place, rule, "a declaration's numbers must be constants");
    return otherwise;
}

void Expressions::declareParam(const ParamDeclaration& p, uint32_t& slots) {
    if (!takeName(p.name, p.place)) return;
    ParamInfo info;
    info.name = p.name;
    info.unit = p.unit;
    info.label = p.label.empty() ? p.name : p.label;
    info.kind = p.colour ? ParamKind::colour : p.toggle ? ParamKind::toggle : ParamKind::number;
    info.slot = slots;
    slots += p.colour ? 3 : 1;
    if (slots > kMaxParams) {
        reporter_.error(p.place, p.name, "too many parameters: 32 are the most, a colour counting as three");
        return;
    }
    if (p.colour) {
        std::copy(p.rgb, p.rgb + 3, info.standard);
    } else {
        info.standard[0] = constantOf(p.standard, p.name, 0);
        float d = info.standard[0];
        bool ranged = p.minimum != kNoExpr && !p.toggle;
        info.minimum = ranged ? constantOf(p.minimum, p.name, 0) : p.toggle ? 0 : std::min(0.0f, 2 * d);
        info.maximum = ranged ? constantOf(p.maximum, p.name, 1) : p.toggle || d == 0 ? 1 : std::max(0.0f, 2 * d);
        if (!(info.minimum < info.maximum))
            reporter_.error(p.place, p.name, "the range is empty: its first number must be the smaller");
        else if (d < info.minimum || d > info.maximum)
            reporter_.error(p.place, p.name, "the default lies outside the range");
    }
    std::copy(info.standard, info.standard + 3, info.value);
    paramByName_[p.name] = static_cast<uint32_t>(params.size());
    params.push_back(std::move(info));
}

// False: there is no room for it.
bool Expressions::declareContext(const ContextDeclaration& c) {
    if (contexts.size() + (c.colour ? 3 : 1) > kMaxLayers) {
        reporter_.error(c.place, c.name, "too many context layers: 16 are the most, a colour counting as three");
        return false;
    }
    const std::string& label = c.label.empty() ? c.name : c.label;
    const auto add = [&](const std::string& name, float fill) {
        contextByName_[name] = static_cast<uint32_t>(contexts.size());
        contexts.push_back({name, label, fill});
    };
    if (c.colour) {
        colourContexts_.insert(c.name);
        for (uint32_t i = 0; i < 3; ++i) add(c.name + kChannels[i], c.rgb[i]);
    } else {
        const float fill = constantOf(c.fill, c.name, 1.0f);
        if (fill < 0 || fill > 1) reporter_.error(c.place, c.name, "a layer's default lies between 0 and 1");
        add(c.name, fill);
    }
    return true;
}

void Expressions::declareField(const FieldDeclaration& f) {
    if (!takeName(f.name, f.place)) return;
    FieldInfo info{f.name, f.label.empty() ? f.name : f.label, 2, false, f.jumps};
    if (f.jumps && !fields.empty())
        reporter_.error(f.place, f.name, "T goes along the first field, so only that one can say 'jumps'");
    if (f.kind == "vector") {
        info.symmetry = 1;
    } else if (f.kind == "cross") {
        info.symmetry = 4;
    } else if (f.kind == "symmetry") {
        const float n = constantOf(f.symmetry, f.name, 0);
        const bool whole = n >= 1 && n <= float(kMaxSymmetry) && n == float(int(n));
        if (!whole) reporter_.error(f.place, f.name, "write symmetry(N) with a whole number from 1 to 12");
        info.symmetry = whole ? uint32_t(n) : 1;
    } else if (f.kind == "curvature") {
        info.curvature = true;
    } else if (f.kind != "tensor") {
        reporter_.error(
            f.place, f.name,
            "a field is a tensor, a vector, a cross, a symmetry(N) or the surface's curvature, not '" + f.kind + "'");
    }
    if (fields.size() == kMaxFields)
        reporter_.error(f.place, f.name, "too many fields: 4 are the most");
    else
        fields.push_back(std::move(info));
}

void Expressions::declare() {
    uint32_t slots = 0;
    for (const ParamDeclaration& p : module_.params) {
        declareParam(p, slots);
        if (slots > kMaxParams) break;
    }
    for (const ContextDeclaration& c : module_.contexts)
        if (takeName(c.name, c.place) && !declareContext(c)) break;
    for (const FieldDeclaration& f : module_.fields) declareField(f);
    for (uint32_t i = 0; i < module_.lets.size(); ++i)
        if (takeName(module_.lets[i].name, module_.lets[i].place)) letByName_[module_.lets[i].name] = i;
}

bool Expressions::known(const std::string& name) const {
    return names_.count(name) != 0;
}

void Expressions::warnUnused() {
    auto warn = [&](const Place& place, const std::string& name, const char* what) {
        bool ours = place.file == 0;  // included texts are libraries
        if (ours && known(name) && used_.count(name) == 0)
            reporter_.warning(place, name, std::string(what) + " '" + name + "' is never used");
    };
    for (const ParamDeclaration& p : module_.params) warn(p.place, p.name, "the parameter");
    for (const ContextDeclaration& c : module_.contexts) warn(c.place, c.name, "the context layer");
    for (const LetDeclaration& l : module_.lets) warn(l.place, l.name, "the value");
}

}  // namespace espalier::grammar
