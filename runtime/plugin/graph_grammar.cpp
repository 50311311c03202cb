// In: a grammar's text and parameters, as a graph has them. Out: a grammar of the context.
#include "runtime/plugin/graph_grammar.hpp"

#include <algorithm>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/given.hpp"

namespace espalier {
namespace {

std::string compile(EspContext& context, const RulesWish& rules, EspGrammar& id) {
    EspGrammarDef def = {};
    def.structSize = sizeof def;
    def.name = rules.file.c_str();
    def.text = rules.text.data();
    def.length = rules.text.size();
    const bool there = context.grammars.find(id.id);
    const EspResult made = there ? espRecompileGrammar(&context, id, &def) : espCompileGrammar(&context, &def, &id);
    return made == ESP_OK ? std::string() : context.error;
}

std::string setParams(EspContext& context, const RulesWish& rules, EspGrammar id) {
    const std::vector<ParamInfo> params = context.grammars.find(id.id)->map.params();
    for (const WishedParam& wished : rules.params)
        if (std::ranges::find(params, wished.name, &ParamInfo::name) == params.end())
            return rules.file + ": has no parameter '" + wished.name + "'";
    for (const ParamInfo& param : params) {
        const auto wished = std::ranges::find(rules.params, param.name, &WishedParam::name);
        const bool own = wished != rules.params.end();
        const glm::vec3 value = own ? wished->value : vec(param.standard);
        const uint32_t count = own ? wished->count : numbersOf(param);
        if (espSetParam(&context, id, param.name.c_str(), &value.x, count) != ESP_OK) return context.error;
    }
    return {};
}

}  // namespace

std::string GraphGrammar::bring(EspContext& context, const RulesRef& rules) {
    const bool there = context.grammars.find(id_.id);
    if (there && made_ && *made_ == *rules) return {};
    const bool compiled = there && made_ && made_->text == rules->text && made_->file == rules->file;
    if (!compiled) {
        if (const std::string why = compile(context, *rules, id_); !why.empty()) return why;
    }
    const std::string why = setParams(context, *rules, id_);
    made_ = why.empty() ? rules : nullptr;
    return why;
}

void GraphGrammar::drop(EspContext& context) {
    if (context.grammars.find(id_.id)) espDestroyGrammar(&context, id_);
    *this = {};
}

}  // namespace espalier
