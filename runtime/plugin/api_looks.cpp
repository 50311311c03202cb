// Looks of terminals: what a host chooses for one kind of one grammar becomes a kind of its own among the terminal
// meshes, and the grammar's rule map draws that kind.
#include <algorithm>
#include <bit>
#include <optional>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/looks.hpp"
#include "runtime/plugin/seeds.hpp"
#include "runtime/surface/picture.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMostLookSide = 4096;

// By their numbers; the strings live as long as the library.
const std::vector<TerminalMesh>& terminals() {
    static const std::vector<TerminalMesh> all = standardTerminalMeshes();
    return all;
}

const LoadedGrammar* plantsOf(const EspContext* context, EspGrammar id) {
    const LoadedGrammar* grammar = context ? context->grammars.find(id.id) : nullptr;
    return grammar && grammar->map.kind() == GrammarKind::plants ? grammar : nullptr;
}

std::optional<uint32_t> shippedNamed(const char* terminal) {
    for (uint32_t i = 0; terminal && i < terminals().size(); ++i)
        if (terminals()[i].name == terminal) return i;
    return {};
}

// A kind that no other look has, for a terminal of that shipped kind.
std::optional<uint32_t> freeKind(const EspContext& context, uint32_t grammar, uint32_t shipped) {
    uint32_t taken = 0;
    for (const GrammarLook& other : context.looks) {
        if (shippedMesh(other.look.kind) != shipped) continue;
        if (other.grammar == grammar) return other.look.kind;
        taken |= 1u << other.look.kind / kOwnMeshes;
    }
    for (uint32_t look = 1; look < kMaxTerminalKinds / kOwnMeshes; ++look)
        if (!(taken >> look & 1u)) return look * kOwnMeshes + shipped;
    return {};
}

EspResult readMesh(const EspContext& context, const char* path, TerminalLook& look) {
    std::vector<std::byte> file;
    if (const EspResult unread = readWhole(&context, path, file)) return unread;
    Result<TerminalData> meshes = parseTerminals(file, path, {"none"});
    if (!meshes) return failContent(&context, meshes.failure());
    look.mesh = std::move(*meshes);
    return ESP_OK;
}

EspResult readPicture(const EspContext& context, const char* path, TerminalLook& look) {
    std::vector<std::byte> file;
    if (const EspResult unread = readWhole(&context, path, file)) return unread;
    Result<Picture> picture = decodePicture(file, path, uint64_t(kMostLookSide) * kMostLookSide);
    if (!picture) return failContent(&context, picture.failure());
    if (std::max(picture->width, picture->height) > kMostLookSide)
        return fail(&context, ESP_INVALID_CONTENT, std::string(path) + ": has more than 4,096 texels a side");
    look.picture = TerminalPicture{picture->width, picture->height, std::move(picture->rgba)};
    return ESP_OK;
}

EspResult readLook(const EspContext& context, const EspTerminalLook& def, TerminalLook& look) {
    const auto isShare = [](float v) { return v >= 0 && v <= 1; };
    if (def.coloured && !std::ranges::all_of(def.colour, isShare))
        return fail(&context, ESP_INVALID_ARGUMENT, "espSetTerminalLook: the colour isn't of 0 to 1");
    if (def.mesh && shippedMesh(look.kind) == kMeshBark)
        return fail(&context, ESP_INVALID_ARGUMENT,
                    "espSetTerminalLook: bark is bent along its stem, so it has no mesh of its own; give it a picture");
    if (def.coloured) look.colour = vec(def.colour);
    if (def.mesh)
        if (const EspResult bad = readMesh(context, def.mesh, look)) return bad;
    return def.picture ? readPicture(context, def.picture, look) : ESP_OK;
}

// Gives the renderer meshes for all looks; what: begins a message.
EspResult useLooks(EspContext& context, std::vector<GrammarLook> looks, const std::string& what) {
    if (!context.shippedTerminals) context.shippedTerminals = context.renderer->terminals().data();
    std::vector<TerminalLook> drawn;
    for (const GrammarLook& look : looks) drawn.push_back(look.look);
    const Status set = context.renderer->setTerminals(withLooks(*context.shippedTerminals, drawn));
    if (!set && set.failure().ofDevice()) return failGpu(&context, set.failure());
    if (!set)
        return fail(&context, ESP_INVALID_ARGUMENT,
                    what + ": there is no room for another look: " + set.failure().text());
    context.looks = std::move(looks);
    return ESP_OK;
}

// The grammar draws another mesh in place of a shipped one; only what stands on spans grows anew.
void drawAs(EspContext& context, uint32_t id, uint32_t shipped, uint32_t kind) {
    LoadedGrammar& grammar = *context.grammars.find(id);
    RuleMap map = grammar.map;
    map.setTerminalMesh(shipped, kind);
    noteRules(context, context.grammarIndex(id), {grammar.map, grammar.layerOf}, {map, grammar.layerOf});
    grammar.map = std::move(map);
    context.changeRules(grammar);
}

EspResult setLook(EspContext& context, uint32_t id, uint32_t shipped, const EspTerminalLook* given) {
    std::vector<GrammarLook> looks = context.looks;
    std::erase_if(
        looks, [&](const GrammarLook& look) { return look.grammar == id && shippedMesh(look.look.kind) == shipped; });
    if (!given && looks.size() == context.looks.size()) return ESP_OK;
    uint32_t kind = shipped;
    if (given) {
        const EspTerminalLook def = taken("espSetTerminalLook", given);
        const std::optional<uint32_t> free = freeKind(context, id, shipped);
        if (!free)
            return fail(&context, ESP_INVALID_ARGUMENT,
                        "espSetTerminalLook: five grammars have a look of '" + terminals()[shipped].name + "' already");
        GrammarLook look{id, {}};
        look.look.kind = kind = *free;
        if (const EspResult bad = readLook(context, def, look.look)) return bad;
        looks.push_back(std::move(look));
    }
    if (const EspResult bad = useLooks(context, std::move(looks), "espSetTerminalLook")) return bad;
    drawAs(context, id, shipped, kind);
    return ESP_OK;
}

}  // namespace

EspResult drawLooksAgain(EspContext& context) {
    return context.looks.empty() ? ESP_OK : useLooks(context, context.looks, "looks");
}

void takeLooks(const EspContext& context, uint32_t grammar, RuleMap& map) {
    for (const GrammarLook& look : context.looks)
        if (look.grammar == grammar && map.kind() == GrammarKind::plants)
            map.setTerminalMesh(shippedMesh(look.look.kind), look.look.kind);
}

}  // namespace espalier

using namespace espalier;

extern "C" {

uint32_t espTerminalCount(const EspContext* context, EspGrammar id) {
    const LoadedGrammar* grammar = plantsOf(context, id);
    return grammar ? uint32_t(std::popcount(grammar->map.terminalMeshes())) : 0;
}

const char* espTerminalName(const EspContext* context, EspGrammar id, uint32_t index) {
    const LoadedGrammar* grammar = plantsOf(context, id);
    uint32_t meshes = grammar ? grammar->map.terminalMeshes() : 0;
    for (uint32_t i = 0; i < terminals().size(); ++i)
        if (meshes >> i & 1u && index-- == 0) return terminals()[i].name.c_str();
    return "";
}

EspResult espSetTerminalLook(EspContext* context, EspGrammar id, const char* terminal, const EspTerminalLook* look) {
    return guarded(context, [&] {
        if (!plantsOf(context, id))
            return fail(context, ESP_INVALID_ARGUMENT, "espSetTerminalLook: there is no such grammar of plants");
        const std::optional<uint32_t> shipped = shippedNamed(terminal);
        if (!shipped)
            return fail(context, ESP_INVALID_ARGUMENT,
                        std::string("espSetTerminalLook: there is no terminal '") + (terminal ? terminal : "") + "'");
        return setLook(*context, id.id, *shipped, look);
    });
}

}  // extern "C"
