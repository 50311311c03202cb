// Actions -> the words for them in menus.
#include "tools/document/document.hpp"

namespace espalier::document {
namespace {

std::string counted(size_t count, const char* one, const char* several) {
    return count == 1 ? one : std::to_string(count) + " " + several;
}
std::string seeds(size_t count) {
    return counted(count, "a seed", "seeds");
}

}  // namespace

std::string nameOf(const Action& action) {
    using Name = std::string;
    struct Names {
        Name operator()(const SetParam& a) const { return "Change " + a.param.name; }
        Name operator()(const SetText&) const { return "Edit the grammar"; }
        Name operator()(const AddSeeds& a) const { return "Plant " + seeds(a.seeds.size()); }
        Name operator()(const RemoveSeeds& a) const { return "Remove " + seeds(a.keys.size()); }
        Name operator()(const ChangeSeeds& a) const { return "Change " + seeds(a.seeds.size()); }
        Name operator()(const SetLight&) const { return "Change the light"; }
        Name operator()(const SetWalk&) const { return "Walk otherwise"; }
        Name operator()(const StrokeBegin& a) const {
            return (a.mode == "erase" ? "Erase " : a.mode == "smooth" ? "Smooth " : "Paint ") + a.layer;
        }
        Name operator()(const StrokeDabs&) const { return "Paint"; }
        Name operator()(const StrokeEnd&) const { return "Paint"; }
        Name operator()(const FillLayer& a) const { return "Fill " + a.layer; }
        Name operator()(const LoadLayer& a) const { return "Import " + a.layer; }
        Name operator()(const LoadTownLayer& a) const { return "Import " + a.layer; }
        Name operator()(const SwapStroke&) const { return "Paint"; }
        Name operator()(const FreezeSeeds& a) const {
            return (a.frozen ? "Freeze " : "Thaw ") + counted(a.keys.size(), "a plant", "plants");
        }
        Name operator()(const RestoreFrozen&) const { return "Freeze"; }
        Name operator()(const OrderSeeds&) const { return "Order the seeds"; }
        Name operator()(const PruneBranch& a) const { return a.pruned ? "Prune" : "Let a branch grow again"; }
        Name operator()(const SetHouse&) const { return "Change a house"; }
        Name operator()(const ResetHouse&) const { return "A house as planned"; }
        Name operator()(const SetCamera&) const { return "Move the camera"; }
        Name operator()(const SetView&) const { return "Change the view"; }
        Name operator()(const Undo&) const { return "Undo"; }
        Name operator()(const Redo&) const { return "Redo"; }
    };
    return std::visit(Names{}, action);
}

std::string plantingName(const std::vector<Action>& back) {
    size_t count = 0;
    for (const Action& action : back)
        if (const auto* removal = std::get_if<RemoveSeeds>(&action)) count += removal->keys.size();
    return "Plant " + seeds(count);
}

}  // namespace espalier::document
