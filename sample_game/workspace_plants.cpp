// Plants and their branches: picked, pruned, frozen, and asked why nothing grows.
#include <algorithm>
#include <cstdio>
#include <utility>

#include "sample_game/crossings.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

void Workspace::pickBranch(glm::vec2 at) {
    const Ray ray = rayThrough(at);
    EspPlantHit found;
    branch.reset();
    message.clear();
    if (espPickPlant(context.get(), &ray.origin.x, &ray.direction.x, &found) == ESP_OK)
        branch = found.branch;
    else
        say("No branch there: click a stem or a leaf");
    readPath();
}

// Asked in every frame: picked only when mouse or camera have moved, since what has grown anew has to be read back
// first.
void Workspace::pointAtBranch(std::optional<glm::vec2> at) {
    if (!at) {
        pointer_.reset();
        pointed.clear();
        return;
    }
    const Ray ray = rayThrough(*at);
    if (std::exchange(pointedAt_, stats.expansions) != stats.expansions) pointed.clear();
    if (pointer_ && pointer_->origin == ray.origin && pointer_->direction == ray.direction) return;
    pointer_ = ray;
    pointed.clear();
    EspPlantHit found;
    if (espPickPlant(context.get(), &ray.origin.x, &ray.direction.x, &found) == ESP_OK) pointed = pathOf(found.branch);
}

void Workspace::pickParent() {
    if (!branch || path.empty()) return;
    branch = branchInfo.parent;
    readPath();
}

const espalier::scene::Seed* Workspace::branchSeed() const {
    if (!branch || path.empty()) return nullptr;
    const auto grows = [&](const espalier::scene::Seed& seed) { return seed.planted.id == branchInfo.seed.id; };
    const auto found = std::ranges::find_if(scene().seeds, grows);
    return found == scene().seeds.end() ? nullptr : &*found;
}

void Workspace::prune() {
    if (!branch || path.empty()) return say("No branch is picked: click one");
    if (const auto* seed = branchSeed(); seed && seed->frozen)
        return say("A frozen plant stays as it is: thaw it to prune");
    char key[20];
    std::snprintf(key, sizeof key, "%016llx", static_cast<unsigned long long>(*branch));
    if (!perform(espalier::document::PruneBranch{key, true})) return;
    message = "The branch is cut away, with all that grows from it";
    branch.reset();
    path.clear();
}

void Workspace::renumberSeeds() {
    espalier::document::ChangeSeeds change;
    for (const auto& seed : scene().seeds) {
        change.seeds.push_back(document->recordOf(seed));
        change.seeds.back().number = seed.number * 747796405u + 2891336453u;
    }
    if (!change.seeds.empty()) changeSeeds(change);
}

void Workspace::changeSeeds(const espalier::document::ChangeSeeds& change, uint32_t gesture) {
    const bool done = perform(change, gesture);
    if (done && std::ranges::any_of(change.seeds, [](const auto& seed) { return bool(seed.frozen); }))
        say("A frozen plant stays as it is: what was changed is seen once it is thawed");
}

void Workspace::freeze(const std::vector<uint32_t>& keys, bool frozen) {
    perform(espalier::document::FreezeSeeds{keys, frozen});
}

namespace {

using espalier::document::ShowHouses;
using espalier::document::ShowPlants;
using espalier::document::ShowSurfaces;

constexpr const char* kNothingChosen =
    "Nothing is chosen: click a plant's seed, or a name in the list of plants or houses";

// What is to be shown or hidden, of each kind.
struct Showing {
    ShowPlants plants;
    ShowSurfaces models;
    ShowHouses houses;
    explicit Showing(bool shown) : plants{{}, shown}, models{{}, shown}, houses{{}, shown} {}
    bool empty() const { return plants.keys.empty() && models.surfaces.empty() && houses.houses.empty(); }
    void perform(Workspace& work, uint32_t step) const {
        if (!models.surfaces.empty()) work.perform(models, step);
        if (!houses.houses.empty()) work.perform(houses, step);
        if (!plants.keys.empty()) work.perform(plants, step);
    }
};

// Calls f(kind of thing, number, whether it is hidden) for all that may be hidden.
template <class Plants, class Models, class Houses>
void overAll(const Workspace& work, const Plants& plants, const Models& models, const Houses& houses) {
    const auto& scene = work.scene();
    for (const auto& seed : scene.seeds) plants(seed.key, seed.hidden);
    for (uint32_t i = 0; i < scene.surfaces.size(); ++i) models(i, scene.surfaces[i].hidden);
    for (uint32_t i = 0; scene.town && i < espHouseCount(work.context.get()); ++i)
        houses(i, scene.town->mark(i).hidden);
}

}  // namespace

Chosen Workspace::chosen() const {
    Chosen out;
    if (tool == Tool::houses && house)
        out.houses = {*house};
    else
        out.plants = {selected.begin(), selected.end()};
    return out;
}

void Workspace::hideChosen() {
    const Chosen hidden = chosen();
    if (!hidden.houses.empty()) {
        if (!perform(ShowHouses{hidden.houses, false})) return;
        house.reset();
        return say("The house is hidden: Alt+H shows it");
    }
    if (hidden.plants.empty()) return say(kNothingChosen);
    if (!perform(ShowPlants{hidden.plants, false})) return;
    selected.clear();
    say(hidden.plants.size() == 1 ? "The plant is hidden: Alt+H shows it" : "The plants are hidden: Alt+H shows them");
}

void Workspace::isolateChosen() {
    const Chosen alone = chosen();
    if (alone.empty()) return say(kNothingChosen);
    isolate(alone);
}

bool Workspace::anyHidden() const {
    bool any = false;
    const auto see = [&](uint32_t, bool hidden) { any |= hidden; };
    overAll(*this, see, see, see);
    return any;
}

void Workspace::showAll() {
    Showing shown(true);
    const auto into = [](std::vector<uint32_t>& list) {
        return [&list](uint32_t one, bool hidden) {
            if (hidden) list.push_back(one);
        };
    };
    overAll(*this, into(shown.plants.keys), into(shown.models.surfaces), into(shown.houses.houses));
    if (shown.empty()) return say("Nothing is hidden");
    const uint32_t step = newGesture();
    shown.perform(*this, step);
    document->callStep(step, "Show all");
}

void Workspace::isolate(const Chosen& alone) {
    Showing shown(true), hidden(false);
    const auto among = [](const std::vector<uint32_t>& list, uint32_t one) {
        return std::ranges::find(list, one) != list.end();
    };
    const auto apart = [&](const std::vector<uint32_t>& kept, std::vector<uint32_t>& show,
                           std::vector<uint32_t>& hide) {
        return [&](uint32_t one, bool isHidden) {
            if (!kept.empty() && among(kept, one) == isHidden) (isHidden ? show : hide).push_back(one);
        };
    };
    overAll(*this, apart(alone.plants, shown.plants.keys, hidden.plants.keys),
            apart(alone.models, shown.models.surfaces, hidden.models.surfaces),
            apart(alone.houses, shown.houses.houses, hidden.houses.houses));
    if (shown.empty() && hidden.empty()) return showAll();
    const uint32_t step = newGesture();
    shown.perform(*this, step);
    hidden.perform(*this, step);
    document->callStep(step, "Isolate");
    std::erase_if(selected, [&](uint32_t key) { return !alone.plants.empty() && !among(alone.plants, key); });
    say("Only what is chosen is seen: Alt+H shows all again");
}

std::vector<EspPathSample> Workspace::pathOf(uint64_t of) const {
    uint32_t count = 0;
    if (espBranchPath(context.get(), of, nullptr, &count) != ESP_OK) return {};
    std::vector<EspPathSample> samples(count);
    if (espBranchPath(context.get(), of, samples.data(), &count) != ESP_OK) samples.clear();
    return samples;
}

void Workspace::readPath() {
    path = branch ? pathOf(*branch) : std::vector<EspPathSample>{};
    if (!path.empty() && espBranchInfo(context.get(), *branch, &branchInfo) != ESP_OK) path.clear();
    crossings = crossingsOf(path);
}

void Workspace::noteGrown(bool plants) {
    const bool edited = std::exchange(grownRevision, document->revision()) != document->revision();
    growsWide = false;
    if (house && scene().town && scene().town->mark(*house).hidden) house.reset(), houseEdge.reset();
    if (branch && (plants || edited)) readPath();
}

std::optional<EspPlantInfo> Workspace::barren(uint32_t key) {
    const auto* seed = document->seed(key);
    if (!seed) return {};
    if (asked_.key == key && asked_.expansions == stats.expansions) return asked_.barren;
    EspPlantInfo plant{};
    asked_ = {key, stats.expansions, {}};
    EspGrammarKind kind;  // a pattern has no plant
    if (espGrammarKind(context.get(), scene().grammars[seed->grammar].id, &kind) == ESP_OK &&
        kind == ESP_GRAMMAR_PATTERNS)
        return {};
    const bool known = espPlantInfo(context.get(), seed->planted, &plant) == ESP_OK;
    if (known && plant.nodes < 2) asked_.barren = plant;  // the first stands where the seed does
    return asked_.barren;
}

}  // namespace sample
