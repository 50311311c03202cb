// Models on their way into a scene.
#include "sample_game/additions.hpp"

#include <algorithm>
#include <filesystem>

#include "sample_game/folder_list.hpp"
#include "sample_game/model_bake.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/replay.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using namespace espalier::document;
using espalier::scene::Placing;

bool isSurface(const std::string& file) {
    std::string ignored;
    return fs::path(file).extension() == ".glb" && espalier::scene::mayOpen(file, ignored);
}

struct Box {
    glm::vec3 low, high;
    glm::vec3 size() const { return high - low; }
};

// Where a model of that box stands: on the ground, and beside what is there already.
Placing placeOf(const Box& model, const std::optional<Box>& others, const EspLook& look) {
    constexpr float kGap = .1f;  // of the larger one's width
    const glm::vec3 size = model.size();
    Placing place;
    place.scale = espalier::scene::livingScale(std::max({size.x, size.y, size.z}));
    const Box scaled{place.scale * model.low, place.scale * model.high};
    if (look.ground) place.position[1] = look.groundLevel - scaled.low.y;
    const auto apart = [&](int axis) {
        return scaled.high[axis] < others->low[axis] || scaled.low[axis] > others->high[axis];
    };
    if (others && !apart(0) && !apart(2))
        place.position[0] = others->high.x + kGap * std::max(others->size().x, scaled.size().x) - scaled.low.x;
    return place;
}

// The first model decides how large plants are.
void fitPlants(Workspace& work, const Box& model, uint32_t gesture) {
    const glm::vec3 size = model.size();
    for (uint32_t i = 0; i < work.scene().grammars.size(); ++i)
        for (const auto& value : espalier::scene::fittingParams(work.context.get(), work.scene().grammars[i].id,
                                                                std::max({size.x, size.y, size.z}), size.y))
            work.perform(SetParam{i, {value.name, {value.value.begin(), value.value.begin() + value.count}}}, gesture);
}

// What others that came with it met stays told.
bool addSurface(Workspace& work, const std::string& file, const std::string& called) {
    const std::string told = work.error;
    const bool first = work.scene().surfaces.empty() && !work.scene().town;
    const auto [low, high] = work.bounds();
    const uint32_t gesture = work.newGesture();
    if (!work.perform(AddSurface{file}, gesture)) return false;
    const uint32_t index = uint32_t(work.scene().surfaces.size() - 1);
    EspSurfaceInfo info;
    if (espSurfaceInfo(work.context.get(), work.scene().surfaces[index].id, &info) != ESP_OK) return false;
    const Box model{vec(info.boundsMin), vec(info.boundsMax)};
    const Placing place = placeOf(model, first ? std::nullopt : std::optional(Box{low, high}), work.scene().look);
    if (place != Placing{})
        work.perform(PlaceSurface{index, place.position, place.turn, place.scale, place.mirror}, gesture);
    if (first) {
        fitPlants(work, {place.scale * model.low, place.scale * model.high}, gesture);
        work.fitBrush();
    }
    work.frameAll();
    work.looked = true;
    work.document->callStep(gesture, "Add " + called);
    if (!work.error.empty()) return false;
    work.message = "Added: " + called;
    work.error = told;
    return true;
}

// Then `act` is given the surface.
void bakeFirst(Workspace& work, Session& session, const std::string& model,
               const std::function<void(const std::string& surface)>& act) {
    if (isBaked(model)) return act(surfaceOf(model));
    Background::Job job{"Baking " + fs::path(model).filename().string(), [model] { return baking(model); },
                        [&work, model, act](const Work& over) {
                            if (over.state() == Work::State::done) return act(surfaceOf(model));
                            work.error = over.error();
                            if (work.error.empty()) work.message = "Cancelled: " + fs::path(model).filename().string();
                        }};
    job.leavesWithDocument = true;
    session.background().ask(std::move(job));
}

}  // namespace

std::string emptyScene() {
    return espalier::scene::contentFolder() + "/untitled.json";
}

void addModels(Workspace& work, Session& session, const std::vector<std::string>& files) {
    work.error.clear();
    for (const std::string& typed : files) {
        const std::string file = wholePath(typed), name = fs::path(file).filename().string();
        if (isSurface(file)) {
            addSurface(work, file, name);
        } else if (isModel(file)) {
            bakeFirst(work, session, file,
                      [&work, name](const std::string& surface) { addSurface(work, surface, name); });
        } else {
            work.error = file + ": is no model (.glb, .gltf, .obj, .ply, .stl, .fbx)";
        }
    }
}

void openModel(Workspace& work, Session& session, const std::string& model) {
    bakeFirst(work, session, wholePath(model), [&](const std::string& surface) { askToLeave(work, session, surface); });
}

void takeDropped(Workspace& work, Session& session, const std::vector<std::string>& files) {
    const auto comes = [](const std::string& file) { return isModel(file) || isSurface(file); };
    if (files.size() == 1 && !comes(files.front())) {
        const std::string& file = files.front();
        if (Replay::names(file) || espalier::scene::mayOpen(file, work.error)) askToLeave(work, session, file);
        return;
    }
    std::vector<std::string> models;
    std::ranges::copy_if(files, std::back_inserter(models), comes);
    addModels(work, session, models);
    if (models.size() < files.size())
        work.error = std::to_string(files.size() - models.size()) +
                     " of the files are no models: drop a scene, a project or a run by itself to open it";
}

}  // namespace sample
