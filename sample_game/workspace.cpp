// Points of the window to points of the scene and back, and the way of an action to the document.
#include "sample_game/workspace.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sample_game/crossings.hpp"
#include "tools/scene/layers.hpp"

namespace sample {

glm::vec3 vec(const float* v) {
    return {v[0], v[1], v[2]};
}
glm::vec3 vec(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}
std::array<float, 3> array(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

void tangents(glm::vec3 normal, glm::vec3& u, glm::vec3& v) {
    u = glm::normalize(glm::cross(normal, std::abs(normal.y) < .9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
    v = glm::cross(normal, u);
}

float Workspace::panelUnits() const {
    return editing && layout.panel ? std::round(std::min(layout.panelWidth * scale, window.x * .6f)) : 0;
}

float Workspace::freeAspect() const {
    return std::max(1.f, window.x - panelUnits()) / std::max(1.f, window.y);
}

// What is looked at stands in the middle of what the panel leaves free.
float Workspace::shift() const {
    return panelUnits() / std::max(1.f, window.x);
}

std::pair<glm::vec3, glm::vec3> Workspace::bounds() const {
    glm::vec3 low(1e30f), high(-1e30f);
    for (const auto& surface : scene().surfaces) {
        EspSurfaceInfo info;
        if (espSurfaceInfo(context.get(), surface.id, &info) != ESP_OK) continue;
        low = glm::min(low, vec(info.boundsMin));
        high = glm::max(high, vec(info.boundsMax));
    }
    const uint32_t houses = low.x > high.x ? espHouseCount(context.get()) : 0;
    for (uint32_t i = 0; i < houses; ++i) {
        EspHouseInfo info;
        if (espHouseInfo(context.get(), i, &info) != ESP_OK) continue;
        low = glm::min(low, vec(info.boundsMin));
        high = glm::max(high, vec(info.boundsMax));
    }
    return low.x > high.x ? std::pair(glm::vec3(0), glm::vec3(1)) : std::pair(low, high);
}

float Workspace::reach() const {
    const auto [low, high] = bounds();
    return glm::distance(low, high);
}

void Workspace::fitBrush() {
    constexpr float kLeast = .002f, kMost = .15f;  // of what is painted
    const auto fit = [](float& radius, float size) {
        if (size > 0)
            radius = std::clamp(std::clamp(radius, kLeast * size, kMost * size), kSmallestBrush, kLargestBrush);
    };
    fit(brush.radius, reach());
    if (const auto of = town()) fit(brush.townRadius, of->layerSide);
}

void Workspace::lookFrom(const EspCamera& from) {
    camera.set(from, reach());
    redraw = true;
}

void Workspace::frameAll() {
    lookFrom(espFrameAll(context.get()));
    if (scene().surfaces.empty() && espHouseCount(context.get()) == 0) return;
    // A village around what plants grow on isn't what is worked on.
    const auto [low, high] = bounds();
    camera.frame(low, high, freeAspect());
    // A box is larger than what is in it: what of that is seen from here is gone nearer to.
    if (const std::vector<glm::vec3> seen = seenGround(); !seen.empty()) camera.frame(seen, freeAspect());
}

// Points of surfaces in the view as it is, near enough to each other to tell how far these reach, and seeds. Floors at
// the foot of what stands on them reach further than what is worked on: without them, unless hardly anything is left.
std::vector<glm::vec3> Workspace::seenGround() const {
    constexpr int kAcross = 80;
    constexpr size_t kLeast = 200;
    constexpr float kFoot = .12f, kFloor = .8f;
    const auto [low, high] = bounds();
    const float foot = low.y + kFoot * (high.y - low.y);
    const float step = (window.x - panelUnits()) / kAcross;
    std::vector<glm::vec3> standing, points;
    for (float x = panelUnits() + step / 2; x < window.x; x += step)
        for (float y = step / 2; y < window.y; y += step)
            if (const auto met = pick({x, y})) {
                points.push_back(vec(met->position));
                if (met->normal[1] < kFloor || met->position[1] > foot) standing.push_back(points.back());
            }
    if (points.size() < kLeast) return {};
    if (standing.size() > kLeast) points = std::move(standing);
    // Walls that are ground bear a roof, which belongs to them.
    constexpr glm::vec3 kNear(.3f);
    std::vector<glm::vec3> corners;
    for (uint32_t i = 0; i < espHouseCount(context.get()); ++i) {
        EspHouseInfo info;
        if (espHouseInfo(context.get(), i, &info) != ESP_OK) continue;
        const glm::vec3 least = vec(info.boundsMin) - kNear, most = vec(info.boundsMax) + kNear;
        if (std::ranges::any_of(points, [&](glm::vec3 p) { return glm::clamp(p, least, most) == p; }))
            for (int c = 0; c < 4; ++c)
                corners.emplace_back(c & 1 ? most.x : least.x, most.y, c & 2 ? most.z : least.z);
    }
    points.insert(points.end(), corners.begin(), corners.end());
    for (const auto& seed : scene().seeds) points.push_back(vec(seed.position));
    return points;
}

void Workspace::frameChosen() {
    std::vector<glm::vec3> points;
    if (tool == Tool::seeds)
        for (const auto& seed : scene().seeds)
            if (EspPlantInfo plant; selected.count(seed.key)) {
                points.push_back(vec(seed.position));
                if (espPlantInfo(context.get(), seed.planted, &plant) != ESP_OK) continue;
                points.insert(points.end(), {vec(plant.boundsMin), vec(plant.boundsMax)});
            }
    if (tool == Tool::paint && hit) {  // as much of it as the brush would paint
        const glm::vec3 at = vec(hit->position), around(brushRadius());
        points = {at - around, at + around};
    }
    if (tool == Tool::branch)
        for (const EspPathSample& sample : path) points.push_back(vec(sample.position));
    EspHouseInfo info;
    if (tool == Tool::houses && house && espHouseInfo(context.get(), *house, &info) == ESP_OK)
        points = {vec(info.boundsMin), vec(info.boundsMax)};
    if (points.empty()) return frameAll();
    glm::vec3 low = points[0], high = points[0];
    for (const glm::vec3& point : points) low = glm::min(low, point), high = glm::max(high, point);
    // A seed from which nothing has grown is a point: some of what is around it is seen with it.
    const glm::vec3 centre = (low + high) * .5f, around(std::min(.6f, .07f * reach()));
    camera.frame(glm::min(low, centre - around), glm::max(high, centre + around), freeAspect());
    redraw = true;
}

namespace {

// Most plants may grow anew by it, and that may take long.
bool reachesFar(const espalier::document::Action& action) {
    using namespace espalier::document;
    constexpr size_t kMany = 8;
    const auto is = [&]<class... Kinds>() { return (std::holds_alternative<Kinds>(action) || ...); };
    if (const auto* changed = std::get_if<ChangeSeeds>(&action)) return changed->seeds.size() >= kMany;
    if (const auto* added = std::get_if<AddSeeds>(&action)) return added->seeds.size() >= kMany;
    return is.operator()<SetParam, SetText, SetWalk, FillLayer, LoadLayer, Undo, Redo>();
}

}  // namespace

bool Workspace::perform(const espalier::document::Action& action, uint32_t gesture) {
    // News stands while one looks around.
    if (!std::holds_alternative<espalier::document::SetCamera>(action)) error.clear(), message.clear();
    redraw = true;
    growsWide |= reachesFar(action);
    const bool back = std::holds_alternative<espalier::document::Undo>(action);
    const bool again = std::holds_alternative<espalier::document::Redo>(action);
    const char* name = back ? document->undoName() : again ? document->redoName() : nullptr;
    const std::string done = name ? std::string(back ? "Undone: " : "Done again: ") + name : "";
    if (!document->perform(action, error, gesture)) return false;
    if (name) message = done;
    return true;
}

void Workspace::takeBack(uint32_t gesture) {
    if (document->undoGesture() == gesture && perform(espalier::document::Undo{})) message.clear();
}

void Workspace::choose(Tool chosen) {
    if (chosen == Tool::paint && tool != Tool::paint) seePaint(true);
    if (chosen != Tool::paint && tool == Tool::paint) seePaint(false);
    tool = chosen;
}

void Workspace::setEditing(bool edits) {
    if (tool == Tool::paint && edits != editing) seePaint(edits);
    editing = edits;
    redraw = true;
}

void Workspace::seePaint(bool seen) {
    const EspView view = scene().look.view;
    if (seen && view == ESP_VIEW_SHADED && !brush.layer.empty() && !townLayer(brush.layer)) showLayer(true);
    if (!seen && view == ESP_VIEW_LAYER) showLayer(false);
}

void Workspace::showAtlas(bool shown) {
    if (scene().surfaces.empty()) return say("No surface is here: an atlas is one's, and roofs have none");
    layout.atlas = shown;
}

bool Workspace::readStats() {
    if (espReadStats(context.get(), &stats) == ESP_OK && espReadRoofStats(context.get(), &roofs) == ESP_OK) return true;
    error = espLastError(context.get());
    return false;
}

Workspace::Hands Workspace::hands() const {
    Hands all{brush.layer, plantGrammar, openGrammar, house, houseEdge, {}, {}, 0};
    all.view = {espalier::scene::nameOf(scene().look.view), scene().viewLayer};
    EspHouseInfo info;
    if (house && espHouseInfo(context.get(), *house, &info) == ESP_OK)
        all.houseId = info.id, all.houseCorners = info.cornerCount;
    return all;
}

void Workspace::takeUp(const Hands& hands) {
    redraw = true;
    (void)document->perform(hands.view, error);
    if (std::ranges::find(scene().layers, hands.layer) != scene().layers.end()) brush.layer = hands.layer;
    if (hands.plantGrammar < scene().grammars.size()) plantGrammar = hands.plantGrammar;
    if (hands.openGrammar < scene().grammars.size()) openGrammar = hands.openGrammar;
    if (!hands.house) return;
    EspHouseInfo info;
    const auto is = [&](uint32_t i) {
        return espHouseInfo(context.get(), i, &info) == ESP_OK && hands.houseId == info.id;
    };
    if (is(*hands.house)) house = hands.house;
    for (uint32_t i = 0; !house && !hands.houseId.empty() && i < espHouseCount(context.get()); ++i)
        if (is(i)) house = i;
    if (house && hands.houseCorners == info.cornerCount) houseEdge = hands.houseEdge;
}

bool Workspace::townLayer(const std::string& name) const {
    return espalier::scene::isTownsAlone(context.get(), scene(), channelsOf(scene(), name)[0]);
}

// Over surfaces what is painted is seen by its view, over roofs by what it does to them, unless it is asked for.
void Workspace::chooseLayer(const std::string& name) {
    using espalier::document::SetView;
    const bool seen = scene().look.view == ESP_VIEW_LAYER;
    brush.layer = name;
    if (townLayer(name) ? seen && townLayer(scene().viewLayer) : seen || tool == Tool::paint)
        perform(SetView{"layer", name});
    else if (seen)
        perform(SetView{"shaded", ""});
}

void Workspace::showLayer(bool seen) {
    perform(espalier::document::SetView{seen ? "layer" : "shaded", seen ? brush.layer : ""});
}

void Workspace::followLayers() {
    const auto& layers = scene().layers;
    const auto there = [&](const std::string& name) { return std::ranges::find(layers, name) != layers.end(); };
    if (!there(brush.layer)) brush.layer = layers.empty() ? "" : layers.front();
    if (scene().look.view != ESP_VIEW_LAYER || there(scene().viewLayer)) return;
    const bool seen = tool == Tool::paint && !brush.layer.empty() && !townLayer(brush.layer);
    const espalier::document::SetView view{seen ? "layer" : "shaded", seen ? brush.layer : ""};
    redraw = true;
    (void)document->perform(view, error);  // what was said of the text stays
}

Ray Workspace::rayThrough(glm::vec2 at) const {
    return camera.ray(at / window, window.x / window.y, shift());
}

std::optional<EspHit> Workspace::pick(glm::vec2 at) const {
    const Ray ray = rayThrough(at);
    EspHit found;
    if (espPick(context.get(), &ray.origin.x, &ray.direction.x, &found) != ESP_OK) return {};
    return found;
}

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
    if (branch && (plants || edited)) readPath();
}

std::optional<EspBranchEnd> Workspace::barren(uint32_t key) {
    const auto* seed = document->seed(key);
    if (!seed) return {};
    if (asked_.key == key && asked_.expansions == stats.expansions) return asked_.end;
    EspPlantInfo plant{};
    asked_ = {key, stats.expansions, {}};
    const bool known = espPlantInfo(context.get(), seed->planted, &plant) == ESP_OK;
    if (known && plant.nodes < 2) asked_.end = plant.end;  // the first stands where the seed does
    return asked_.end;
}

std::optional<glm::vec2> Workspace::place(glm::vec3 point) const {
    glm::vec2 at;
    if (!camera.project(point, window.x / window.y, shift(), at)) return {};
    return at * window;
}

bool Workspace::visible(glm::vec3 point) const {
    const glm::vec3 eye = camera.eye(), to = point - eye;
    const float distance = glm::length(to);
    const glm::vec3 direction = to / std::max(distance, 1e-6f);
    EspHit found;
    return espPick(context.get(), &eye.x, &direction.x, &found) != ESP_OK ||
           found.distance > distance - std::max(.02f, distance * .01f);
}

}  // namespace sample
