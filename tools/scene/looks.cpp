// What a scene says of its terminals' looks -> the context.
#include <algorithm>

#include "tools/scene/scene.hpp"
#include "tools/scene/scene_parts.hpp"

namespace espalier::scene {

bool setLook(EspContext* context, EspGrammar grammar, const TerminalLook& look, std::string& error) {
    EspTerminalLook def{};
    def.mesh = look.mesh.empty() ? nullptr : look.mesh.c_str();
    def.picture = look.picture.empty() ? nullptr : look.picture.c_str();
    def.coloured = look.colour.size() == 3;
    std::copy_n(look.colour.begin(), def.coloured ? 3 : 0, def.colour);
    return fromContext(
        context, espSetTerminalLook(context, grammar, look.terminal.c_str(), look.plain() ? nullptr : &def), error);
}

void putLook(std::vector<TerminalLook>& looks, const TerminalLook& look) {
    std::erase_if(looks, [&](const TerminalLook& other) { return other.terminal == look.terminal; });
    if (look.plain()) return;
    looks.insert(std::ranges::upper_bound(looks, look.terminal, {}, &TerminalLook::terminal), look);
}

}  // namespace espalier::scene
