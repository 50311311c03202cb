// Meshes that graphs want to have as ground are baked between the frames.
#include "sample_game/app_state.hpp"

namespace sample {

using espalier::baking::GraphBake;
using espalier::document::Work;

void App::bakeForGraphs() {
    EspContext* context = work_.context.get();
    if (bakingForGraph_) return;
    const std::optional<GraphBake> next = espalier::baking::nextGraphBake(context, work_.scene().graphs);
    if (!next) return;
    if (next->there) return takeGraphBake(*next, "");
    bakingForGraph_ = true;
    session_.background().ask(
        {"Baking a mesh of the graph", [next] { return next->plan; },
         [this, next](const Work& over) {
             bakingForGraph_ = false;
             const bool baked = over.state() == Work::State::done;
             const bool calledOff = over.state() == Work::State::cancelled;
             takeGraphBake(*next, baked ? "" : calledOff ? "baking was called off" : over.error());
         },
         false, true});
}

void App::takeGraphBake(const GraphBake& bake, const std::string& error) {
    espalier::baking::answerGraphBake(work_.context.get(), bake, error);
    if (!error.empty()) work_.error = "The graph's mesh isn't ground: " + error;
    work_.grownRevision = ~0ull;  // plants grow on it
    work_.redraw = true;
    wake();
}

}  // namespace sample
