// Texts of grammars and the values of their parameters.
#include <algorithm>

#include "tools/document/document.hpp"
#include "tools/document/params.hpp"
#include "tools/scene/layers.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::document {

using scene::Seed;

Param paramOf(const scene::ParamValue& value) {
    return {value.name, {value.value.begin(), value.value.begin() + value.count}};
}

scene::ParamValue valueOf(const Param& param) {
    scene::ParamValue value{param.name};
    value.count = uint32_t(std::min(param.value.size(), value.value.size()));
    std::copy_n(param.value.begin(), value.count, value.value.begin());
    return value;
}

namespace {

uint32_t countOf(const EspParamInfo& info) {
    return info.kind == ESP_PARAM_COLOUR ? 3 : 1;
}

}  // namespace

bool takesParam(const EspContext* context, EspGrammar grammar, const scene::ParamValue& value) {
    for (uint32_t i = 0; i < espParamCount(context, grammar); ++i) {
        EspParamInfo info;
        if (espParamInfo(context, grammar, i, &info) == ESP_OK && info.name == value.name)
            return countOf(info) == value.count;
    }
    return false;
}

std::vector<Param> Document::paramsOf(uint32_t grammar) const {
    std::vector<Param> params;
    for (const scene::ParamValue& value : scene::changedParams(context_, scene_.grammars[grammar].id))
        params.push_back(paramOf(value));
    for (const scene::ParamValue& value : scene_.grammars[grammar].unset) params.push_back(paramOf(value));
    return params;
}

SetText Document::withText(uint32_t grammar, std::string text) const {
    return {grammar, std::move(text), grammar < scene_.grammars.size() ? paramsOf(grammar) : std::vector<Param>{}};
}

bool Document::carryOut(const SetParam& action, std::vector<Action>& back, std::string& error) {
    if (action.grammar >= scene_.grammars.size()) {
        error = "there is no grammar " + std::to_string(action.grammar);
        return false;
    }
    const EspGrammar grammar = scene_.grammars[action.grammar].id;
    SetParam before{action.grammar, {action.param.name, {}}};
    for (uint32_t i = 0; i < espParamCount(context_, grammar); ++i) {
        EspParamInfo info;
        if (espParamInfo(context_, grammar, i, &info) == ESP_OK && info.name == action.param.name)
            before.param.value.assign(info.value, info.value + countOf(info));
    }
    if (failed(espSetParam(context_, grammar, action.param.name.c_str(), action.param.value.data(),
                           uint32_t(action.param.value.size())),
               error))
        return false;
    back.push_back(before);
    return true;
}

bool Document::townGrows() const {
    EspGrammar grammar{};
    return scene_.town && espTownGrammar(context_, &grammar) == ESP_OK && grammar.id != 0;
}

bool Document::carryOut(const SetText& action, std::vector<Action>& back, std::string& error) {
    if (action.grammar >= scene_.grammars.size()) {
        error = "there is no grammar " + std::to_string(action.grammar);
        return false;
    }
    scene::LoadedGrammar& grammar = scene_.grammars[action.grammar];
    const std::string grows = grammar.text == grammar.grows ? "" : grammar.grows;
    back.push_back(SetText{action.grammar, grammar.text, paramsOf(action.grammar), grows});
    const bool grew =
        !action.grows.empty() && action.grows != grammar.grows && setText(context_, grammar, action.grows);
    if (setText(context_, grammar, action.text) || grew) noteLayers(context_, scene_);
    // While a text has mistakes the parameters are those of the last good one; those that are there get their values.
    for (uint32_t i = 0; i < espParamCount(context_, grammar.id); ++i) {
        EspParamInfo info;
        if (espParamInfo(context_, grammar.id, i, &info) != ESP_OK) continue;
        const uint32_t count = countOf(info);
        const auto own = std::ranges::find_if(
            action.params, [&](const Param& param) { return param.name == info.name && param.value.size() == count; });
        if (own == action.params.end())
            espSetParam(context_, grammar.id, info.name, info.initial, count);
        else
            espSetParam(context_, grammar.id, info.name, own->value.data(), count);
    }
    grammar.unset.clear();
    for (const Param& param : action.params)
        if (!grammar.error.empty() && !takesParam(context_, grammar.id, valueOf(param)))
            grammar.unset.push_back(valueOf(param));
    // A town, or seeds, that wait for the text to make roofs, to have their values, or to be one that can be planted.
    std::string ignored;
    if (scene_.town && !townGrows()) (void)setTownGrammar(context_, scene_, ignored);
    const bool waits = std::ranges::any_of(
        scene_.seeds, [&](const Seed& seed) { return seed.grammar == action.grammar && !seed.params.empty(); });
    if (waits || !allPlanted_) (void)plant(ignored);
    return true;
}

bool Document::carryOut(const SetLook& action, std::vector<Action>& back, std::string& error) {
    if (action.grammar >= scene_.grammars.size()) {
        error = "there is no grammar " + std::to_string(action.grammar);
        return false;
    }
    scene::LoadedGrammar& grammar = scene_.grammars[action.grammar];
    const auto whole = [](const std::string& file) { return file.empty() ? file : scene::absolutePath(file).string(); };
    const scene::TerminalLook look{action.terminal, whole(action.mesh), whole(action.picture), action.colour};
    SetLook before{action.grammar, action.terminal};
    for (const scene::TerminalLook& known : grammar.looks)
        if (known.terminal == action.terminal)
            before.mesh = known.mesh, before.picture = known.picture, before.colour = known.colour;
    if (!scene::setLook(context_, grammar.id, look, error)) return false;
    scene::putLook(grammar.looks, look);
    back.push_back(std::move(before));
    return true;
}

}  // namespace espalier::document
