// Actions in, a changed scene and context out, with what takes each back. An action's inverse is made of actions
// too, so undoing, redoing and replaying share all of the code below.
#include "tools/document/document.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/document/layer_history.hpp"
#include "tools/document/params.hpp"
#include "tools/scene/daylight.hpp"
#include "tools/scene/guarded.hpp"
#include "tools/scene/scene_file.hpp"

namespace espalier::document {
namespace {

using scene::Seed;

constexpr size_t kMaxSteps = 10000;

Seed seedOf(const SeedRecord& record) {
    Seed seed;
    seed.key = record.key;
    seed.grammar = record.grammar;
    seed.position = record.position;
    seed.direction = record.direction;
    seed.number = record.number;
    seed.frozen = record.frozen;
    seed.hidden = record.hidden;
    seed.line = record.line;
    for (const Param& param : record.params) seed.params.push_back(valueOf(param));
    return seed;
}

bool finite(const std::array<float, 3>& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

// Of a camera or a bookmark.
template <class View>
bool seesSomething(const View& view, std::string& error) {
    if (finite(view.eye) && finite(view.target) && view.eye != view.target &&
        view.fov >= scene::fovOfDegrees(scene::kLeastFov) && view.fov <= scene::fovOfDegrees(scene::kMostFov))
        return true;
    error = "a camera that sees nothing";
    return false;
}

// Within one gesture only the first value counts for undo: what later actions set is overwritten anyway.
std::optional<uint32_t> houseOf(const Action& action) {
    if (const auto* set = std::get_if<SetHouse>(&action)) return set->house.index;
    if (const auto* reset = std::get_if<ResetHouse>(&action)) return reset->house;
    return {};
}

bool overwrites(const Action& earlier, const Action& later) {
    if (const auto house = houseOf(earlier)) return house == houseOf(later);
    if (earlier.index() != later.index()) return false;
    if (const auto* a = std::get_if<SetParam>(&earlier)) {
        const auto& b = std::get<SetParam>(later);
        return a->grammar == b.grammar && a->param.name == b.param.name;
    }
    if (const auto* a = std::get_if<SetGraphText>(&earlier)) return a->graph == std::get<SetGraphText>(later).graph;
    if (const auto* a = std::get_if<SetText>(&earlier)) return a->grammar == std::get<SetText>(later).grammar;
    if (const auto* a = std::get_if<ChangeSeeds>(&earlier)) {
        const auto& b = std::get<ChangeSeeds>(later);
        return std::equal(a->seeds.begin(), a->seeds.end(), b.seeds.begin(), b.seeds.end(),
                          [](const SeedRecord& x, const SeedRecord& y) { return x.key == y.key; });
    }
    if (const auto* a = std::get_if<SetLook>(&earlier)) {
        const auto& b = std::get<SetLook>(later);
        return a->grammar == b.grammar && a->terminal == b.terminal;
    }
    if (const auto* a = std::get_if<PlaceSurface>(&earlier)) return a->surface == std::get<PlaceSurface>(later).surface;
    if (const auto* a = std::get_if<SetField>(&earlier)) {
        const auto& b = std::get<SetField>(later);
        return a->surface == b.surface && a->field.name == b.field.name;
    }
    if (const auto* a = std::get_if<TrimField>(&earlier)) {
        const auto& b = std::get<TrimField>(later);
        return a->surface == b.surface && a->field == b.field;
    }
    return std::holds_alternative<SetLight>(earlier);
}

// The last of the earlier actions set all that the later ones do.
bool endsLike(const std::vector<Action>& earlier, const std::vector<Action>& later) {
    return earlier.size() >= later.size() &&
           std::equal(later.rbegin(), later.rend(), earlier.rbegin(),
                      [](const Action& after, const Action& before) { return overwrites(before, after); });
}

}  // namespace

Document::~Document() {
    for (const OpenStroke& open : strokes_) espDestroyStroke(context_, open.stroke);
}

bool Document::failed(EspResult result, std::string& error) const {
    if (result == ESP_OK) return false;
    error = espLastError(context_);
    if (error.empty()) error = "error " + std::to_string(int(result));
    return true;
}

bool Document::open(const scene::Request& request, std::string& error) {
    return scene::guarded(request.file + ": ", error, [&] { return openGuarded(request, error); });
}

bool Document::openGuarded(const scene::Request& request, std::string& error) {
    if (!openScene(context_, request, scene_, error)) return false;
    if (!plant(error)) {
        // As while it was edited, seeds of a project wait for a text that grows plants.
        if (!scene_.project) return false;
        scene_.notes.push_back(std::exchange(error, {}));
    }
    for (const Seed& seed : scene_.seeds) {
        lastKey_ = std::max(lastKey_, seed.key);
        const scene::LoadedGrammar& grammar = scene_.grammars[seed.grammar];
        for (const scene::ParamValue& own : seed.params) {
            if (takesParam(context_, grammar.id, own)) continue;
            const std::string missing = grammar.file + ": there is no parameter '" + own.name + "' of " +
                                        (own.count == 3 ? "a colour" : "a number") + ", which a seed sets";
            if (!scene_.project) {
                error = request.file + ": " + missing;
                return false;
            }
            scene_.notes.push_back(missing);
        }
    }
    return true;
}

const Seed* Document::seed(uint32_t key) const {
    const size_t i = indexOf(key);
    return i < scene_.seeds.size() ? &scene_.seeds[i] : nullptr;
}

size_t Document::indexOf(uint32_t key) const {
    const auto found =
        std::find_if(scene_.seeds.begin(), scene_.seeds.end(), [&](const Seed& seed) { return seed.key == key; });
    return size_t(found - scene_.seeds.begin());
}

SeedRecord Document::recordOf(const Seed& seed) const {
    SeedRecord record{seed.key, seed.grammar, seed.position, seed.direction, seed.number};
    for (const scene::ParamValue& value : seed.params) record.params.push_back(paramOf(value));
    record.frozen = seed.frozen;
    record.hidden = seed.hidden;
    record.line = seed.line;
    return record;
}

// ---- One step there, one back

bool Document::perform(const Action& action, std::string& error, uint32_t gesture) {
    std::vector<Action> back;
    const bool strokes = std::holds_alternative<StrokeDabs>(action) || std::holds_alternative<StrokeEnd>(action);
    const bool changes = isEdit(action) || std::holds_alternative<Undo>(action) || std::holds_alternative<Redo>(action);
    if (stroking() && !strokes && changes) {
        error = "a stroke isn't ended yet";
        return false;
    }
    if (changes && settle_) settle_();
    std::string name = std::holds_alternative<StrokeEnd>(action) ? strokeName_ : nameOf(*this, action);
    if (!carryOut(action, back, error)) return false;
    if (!back.empty()) remember(action, std::move(name), std::move(back), gesture);
    if (changes) ++revision_;
    if (listener_) listener_(action, gesture);
    return true;
}

bool Document::carryOut(const Action& action, std::vector<Action>& back, std::string& error) {
    return std::visit([&](const auto& a) { return carryOut(a, back, error); }, action);
}

void Document::remember(const Action& action, std::string name, std::vector<Action> back, uint32_t gesture) {
    undone_.clear();
    if (gesture && undoGesture() == gesture) {
        Step& step = done_.back();
        step.state = ++lastState_;
        if (!endsLike(step.back, back)) std::ranges::move(back, std::back_inserter(step.back));
        if (std::holds_alternative<AddSeeds>(action)) step.name = plantingName(step.back);
        const auto* set = std::get_if<SetParam>(&action);
        if (set && step.name != name) step.name = "Values of " + grammarName(scene_, set->grammar);
    } else {
        done_.push_back({std::move(name), gesture, ++lastState_, std::move(back)});
    }
    keep(done_);
}

void Document::callStep(uint32_t gesture, std::string name) {
    if (gesture && undoGesture() == gesture) done_.back().name = std::move(name);
}

size_t Document::historyBytes() const {
    size_t bytes = 0;
    for (const std::vector<Step>* steps : {&done_, &undone_})
        for (const Step& step : *steps) bytes += step.bytes;
    return bytes;
}

std::vector<std::string> Document::filesOfHistory() const {
    std::vector<std::string> files;
    for (const auto& [seed, file] : scene_.unreadPlants) files.push_back(file);  // also of seeds that were removed
    for (const std::vector<Step>* steps : {&done_, &undone_})
        for (const Step& step : *steps)
            for (const Action& action : step.back) {
                if (const auto* swap = std::get_if<SwapStroke>(&action))
                    for (const scene::SceneLayer& picture : swap->stroke->unread) files.push_back(picture.file);
                if (const auto* restore = std::get_if<RestoreFrozen>(&action))
                    for (const RestoreFrozen::Plant& plant : restore->plants) files.push_back(plant.unread);
            }
    return files;
}

// Counts the last of the steps, which has come or changed, and forgets the first ones if it is too much.
void Document::keep(std::vector<Step>& steps) {
    steps.back().bytes = 0;
    for (Action& action : steps.back().back) {
        steps.back().bytes += keptBytes(action);
        if (const auto* set = std::get_if<SetField>(&action)) steps.back().bytes += droppedBytes(*set);
    }
    size_t bytes = historyBytes();
    auto kept = steps.begin();
    while (kept + 1 < steps.end() && (bytes > maxHistoryBytes_ || size_t(steps.end() - kept) > kMaxSteps))
        bytes -= (kept++)->bytes;
    if (&steps == &done_ && kept != steps.begin()) {
        bottom_ = (kept - 1)->state;
        beyond_ -= std::min(beyond_, size_t(kept - steps.begin()));
    }
    steps.erase(steps.begin(), kept);
}

bool Document::move(std::vector<Step>& from, std::vector<Step>& to, std::string& error) {
    if (&from == &done_ ? undoSteps() == 0 : from.empty()) {
        error = &from != &done_ ? "there is nothing to redo"
                : beyond_ == 0  ? "there is nothing to undo"
                                : "there is nothing to undo since the recording began; what was done before it can be "
                                  "undone when it has ended";
        return false;
    }
    Step step = std::move(from.back());
    from.pop_back();
    // Strokes that come after it were painted on the surface as it was loaded before.
    const auto loads = [](const Action& action) { return std::holds_alternative<AddSurface>(action); };
    if (&from == &undone_ && std::ranges::any_of(step.back, loads)) from.clear();
    Step opposite{step.name, 0, step.state, {}};
    while (!step.back.empty() && carryOut(step.back.back(), opposite.back, error)) step.back.pop_back();
    const bool whole = step.back.empty();
    // All of it or nothing. Where not even what was done of it can be taken back, that is a step of its own, and what
    // couldn't be done stays to be tried again.
    std::string unheard;
    while (!whole && !opposite.back.empty() && carryOut(opposite.back.back(), step.back, unheard))
        opposite.back.pop_back();
    const bool begun = !opposite.back.empty();
    if (!whole) {
        if (begun) ++revision_, (&from == &done_ ? step : opposite).state = ++lastState_;
        from.push_back(std::move(step));
        keep(from);
    }
    if (whole || begun) {
        to.push_back(std::move(opposite));
        keep(to);
    }
    return whole;
}

const char* Document::undoName() const {
    return undoSteps() == 0 ? nullptr : done_.back().name.c_str();
}
const char* Document::redoName() const {
    return undone_.empty() ? nullptr : undone_.back().name.c_str();
}

// ---- Seeds. What grows has to be a function of the list alone, not of how it came to be: the plugin tells seeds of
// one number apart by the order in which they were planted. So the list is planted anew.

bool Document::carryOut(const AddSeeds& action, std::vector<Action>& back, std::string& error) {
    const std::vector<Seed> before = scene_.seeds;
    if (action.places.size() != action.seeds.size()) {
        error = "each seed needs a place in the list";
        return false;
    }
    RemoveSeeds remove;
    for (size_t i = 0; i < action.seeds.size(); ++i) {
        const SeedRecord& record = action.seeds[i];
        if (record.key == 0 || seed(record.key) || record.grammar >= scene_.grammars.size() ||
            !finite(record.position) || !finite(record.direction) || action.places[i] > scene_.seeds.size()) {
            error = "the seed of key " + std::to_string(record.key) + " can't be planted: " +
                    (record.key == 0 || seed(record.key)        ? "another has this key, or it is 0"
                     : record.grammar >= scene_.grammars.size() ? "there is no such grammar"
                     : action.places[i] > scene_.seeds.size()   ? "its place is beyond the end of the list"
                                                                : "a number isn't finite");
            scene_.seeds = before;
            return false;
        }
        scene_.seeds.insert(scene_.seeds.begin() + action.places[i], seedOf(record));
        remove.keys.push_back(record.key);
        lastKey_ = std::max(lastKey_, record.key);
    }
    if (!replant(before, error)) return false;
    back.push_back(std::move(remove));
    return true;
}

bool Document::carryOut(const RemoveSeeds& action, std::vector<Action>& back, std::string& error) {
    const std::vector<Seed> before = scene_.seeds;
    AddSeeds add;
    for (size_t i = 0; i < before.size(); ++i)
        if (std::find(action.keys.begin(), action.keys.end(), before[i].key) != action.keys.end()) {
            add.seeds.push_back(recordOf(before[i]));
            add.places.push_back(uint32_t(i));
        }
    if (add.seeds.size() != action.keys.size()) {
        error = "there is no such seed";
        return false;
    }
    std::erase_if(scene_.seeds, [&](const Seed& seed) {
        return std::find(action.keys.begin(), action.keys.end(), seed.key) != action.keys.end();
    });
    if (!replant(before, error)) return false;
    back.push_back(std::move(add));
    return true;
}

bool Document::carryOut(const ChangeSeeds& action, std::vector<Action>& back, std::string& error) {
    const std::vector<Seed> before = scene_.seeds;
    ChangeSeeds inverse;
    bool onlyMoved = true;
    for (const SeedRecord& record : action.seeds) {
        const size_t i = indexOf(record.key);
        if (i == before.size() || record.grammar >= scene_.grammars.size() || !finite(record.position) ||
            !finite(record.direction)) {
            error = "a seed that can't be changed: key " + std::to_string(record.key);
            scene_.seeds = before;
            return false;
        }
        inverse.seeds.push_back(recordOf(before[i]));
        inverse.seeds.back().frozen = nullptr;  // which only FreezeSeeds changes
        inverse.seeds.back().hidden = false;    // and ShowPlants
        onlyMoved = onlyMoved && record.number == before[i].number && record.grammar == before[i].grammar &&
                    record.params == inverse.seeds.back().params;
        scene_.seeds[i] = seedOf(record);
        scene_.seeds[i].planted = before[i].planted;
        scene_.seeds[i].frozen = before[i].frozen;
        scene_.seeds[i].hidden = before[i].hidden;
    }
    if (!(onlyMoved && allPlanted_ ? moveSeeds(action, before, error) : replant(before, error))) return false;
    back.push_back(std::move(inverse));
    return true;
}

// Only what grows from these seeds grows anew.
bool Document::moveSeeds(const ChangeSeeds& action, const std::vector<Seed>& before, std::string& error) {
    const auto move = [&](const Seed& seed) {
        return espMoveSeed(context_, seed.planted, seed.position.data(), seed.direction.data());
    };
    for (const SeedRecord& record : action.seeds) {
        if (!failed(move(scene_.seeds[indexOf(record.key)]), error)) continue;
        scene_.seeds = before;
        for (const SeedRecord& moved : action.seeds) (void)move(scene_.seeds[indexOf(moved.key)]);
        return false;
    }
    return true;
}

// Seeds that couldn't be planted before, such as a file's, don't keep others from it.
bool Document::replant(const std::vector<Seed>& before, std::string& error) {
    const auto missing = [](const std::vector<Seed>& seeds) {
        return std::ranges::count_if(seeds, [](const Seed& seed) { return seed.planted.id == 0; });
    };
    if (plant(error)) return true;
    if (missing(scene_.seeds) <= missing(before)) {
        error.clear();
        return true;
    }
    scene_.seeds = before;
    std::string ignored;
    (void)plant(ignored);
    return false;
}

// Values that a text has lost or has of another kind, or that another grammar's seed had, wait in the list for a text
// that has them.
bool Document::plant(std::string& error) {
    const std::vector<Seed> listed = scene_.seeds;
    for (Seed& seed : scene_.seeds)
        std::erase_if(seed.params, [&](const scene::ParamValue& own) {
            return !takesParam(context_, scene_.grammars[seed.grammar].id, own);
        });
    allPlanted_ = plantAll(context_, scene_, error);
    for (size_t i = 0; i < listed.size(); ++i) scene_.seeds[i].params = listed[i].params;
    return allPlanted_;
}

// ---- Light, walk and camera

bool Document::carryOut(const SetLight& action, std::vector<Action>& back, std::string& error) {
    if (action.hour != scene::kOwnSun && !(action.hour >= 0 && action.hour <= 24)) {
        error = "an hour is 0 to 24, or -1 for the scene's own light";
        return false;
    }
    if (!(std::abs(action.exposure) <= scene::kMostExposure)) {
        error = "an exposure is -20 to 20 stops";
        return false;
    }
    const EspLook view = scene_.look;
    back.push_back(SetLight{scene_.hour, view.exposure, view.shadows != 0});
    scene_.hour = action.hour;
    scene_.look = scene_.ownLook;
    if (action.hour != scene::kOwnSun) scene::applyDaylight(action.hour, scene_.look);
    scene_.look.exposure = action.exposure;
    scene_.look.shadows = action.shadows;
    scene_.look.view = view.view;
    return true;
}

bool Document::carryOut(const SetWalk& action, std::vector<Action>& back, std::string& error) {
    EspGrowDef grow = scene_.grow;
    if (!scene::walkNamed(action.walk, grow.walk)) {
        error = "there is no walk '" + action.walk + "'";
        return false;
    }
    if (failed(espSetGrow(context_, &grow), error)) return false;
    back.push_back(SetWalk{scene::nameOf(scene_.grow.walk)});
    scene_.grow = grow;
    return true;
}

bool Document::carryOut(const SetCamera& action, std::vector<Action>&, std::string& error) {
    if (!seesSomething(action, error)) return false;
    std::copy(action.eye.begin(), action.eye.end(), scene_.camera.eye);
    std::copy(action.target.begin(), action.target.end(), scene_.camera.target);
    scene_.camera.fovY = action.fov;
    return true;
}

bool Document::carryOut(const SetBookmark& action, std::vector<Action>& back, std::string& error) {
    if (action.digit < 1 || action.digit > scene::kMostBookmarks) {
        error = "bookmarks have the digits 1 to 9";
        return false;
    }
    if (action.kept && !seesSomething(action, error)) return false;
    std::vector<scene::Bookmark>& all = scene_.bookmarks;
    const auto known = std::ranges::lower_bound(all, action.digit, {}, &scene::Bookmark::digit);
    const bool there = known != all.end() && known->digit == action.digit;
    const scene::Bookmark bookmark{action.digit, action.eye, action.target, action.fov};
    SetBookmark before{action.digit, there};
    if (there) before.eye = known->eye, before.target = known->target, before.fov = known->fov;
    if (there && action.kept)
        *known = bookmark;
    else if (there)
        all.erase(known);
    else if (action.kept)
        all.insert(known, bookmark);
    back.push_back(before);
    return true;
}

bool Document::carryOut(const SetView& action, std::vector<Action>&, std::string& error) {
    if (scene::viewNamed(action.view, scene_.look.view)) {
        scene_.viewLayer = action.layer;
        return true;
    }
    error = "there is no view '" + action.view + "'";
    return false;
}

// ---- What actions are

bool isEdit(const Action& action) {
    return !std::holds_alternative<SetCamera>(action) && !std::holds_alternative<SetView>(action) &&
           !std::holds_alternative<SetGraphTime>(action) && !std::holds_alternative<Undo>(action) &&
           !std::holds_alternative<Redo>(action);
}

}  // namespace espalier::document
