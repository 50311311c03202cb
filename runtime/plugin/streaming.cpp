// Enters: where the eye is, and what each surface takes. Leaves: surfaces that come and go.
#include "runtime/plugin/streaming.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "runtime/core/undo.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/surface_point.hpp"

namespace espalier {
namespace {

constexpr float kStays = 1.25f;  // what stands counts as needed so much more, lest two take turns

// Surfaces that agree in these share what is read.
using SharedFile = std::pair<std::string_view, bool>;
SharedFile fileOf(const auto& streamed) {
    return {streamed.request.name, streamed.request.groundOnly};
}

}  // namespace

EspResult Streaming::add(SurfaceRequest request, glm::vec3 low, glm::vec3 high, EspSurface* out) {
    Streamed streamed;
    const glm::mat4 toWorld = matrixOf(request.place);
    streamed.middle = glm::vec3(toWorld * glm::vec4((low + high) * 0.5f, 1));
    streamed.radius = glm::length(glm::vec3(toWorld[0])) * glm::length(high - low) * 0.5f;
    streamed.request = std::move(request);
    const uint32_t id = context_.surfaces.reserve();
    if (!id) return fail(&context_, ESP_OUT_OF_MEMORY, "espAddStreamed: no numbers for surfaces are left");
    Undo reserving([&] { context_.surfaces.release(id); });
    surfaces_.emplace(id, std::move(streamed));
    reserving.done();
    out->id = id;
    return ESP_OK;
}

void Streaming::forget(uint32_t id) {
    const auto found = surfaces_.find(id);
    if (found == surfaces_.end()) return;
    endLoad(found->second);
    if (!stands(id)) context_.surfaces.release(id);
    surfaces_.erase(found);
}

bool Streaming::stands(uint32_t id) const {
    return context_.surfaces.find(id) != nullptr;
}

bool Streaming::uploading(const Streamed& streamed) const {
    if (streamed.load == 0) return false;
    const SurfaceLoads::State* state = context_.loads->find(streamed.load);
    return state && state->state == ESP_LOAD_UPLOADING;
}

uint64_t Streaming::deviceBytes() const {
    uint64_t sum = 0;
    std::set<const SurfaceContent*> counted;
    for (const auto& [id, streamed] : surfaces_) {
        const PlacedSurface* standing = context_.surfaces.find(id);
        if (standing ? counted.insert(standing->content.get()).second : uploading(streamed)) sum += streamed.bytes;
    }
    return sum;
}

float Streaming::needOf(uint32_t id, const Streamed& streamed) const {
    const float distance = glm::length(streamed.middle - vec(def_.eye));
    const float need = distance > 0 ? streamed.radius / distance : std::numeric_limits<float>::max();
    return stands(id) ? need * kStays : need;
}

// By need, as far as the budget goes. What hasn't been read yet is taken to be like the others.
std::set<uint32_t> Streaming::wanted() const {
    uint64_t known = 0, sum = 0;
    std::vector<std::pair<float, uint32_t>> order;
    for (const auto& [id, streamed] : surfaces_) {
        if (streamed.result != ESP_OK) continue;
        order.emplace_back(needOf(id, streamed), id);
        known += streamed.bytes > 0;
        sum += streamed.bytes;
    }
    std::ranges::sort(order, [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    std::set<uint32_t> wanted;
    std::set<SharedFile> files;
    uint64_t used = 0;
    for (const auto& [need, id] : order) {
        if (need < def_.leastSize) break;
        const uint64_t own = surfaces_.at(id).bytes, bytes = own > 0 || known == 0 ? own : sum / known;
        if (bytes > def_.deviceBytes) continue;
        const bool shares = files.contains(fileOf(surfaces_.at(id)));
        if (!shares && used + bytes > def_.deviceBytes) break;
        if (!shares) used += bytes;
        files.insert(fileOf(surfaces_.at(id)));
        wanted.insert(id);
    }
    return wanted;
}

bool Streaming::makeRoomBelow(float need) {
    std::map<const SurfaceContent*, float> needs;  // as of the place that needs it most
    for (const auto& [id, streamed] : surfaces_)
        if (const PlacedSurface* standing = context_.surfaces.find(id)) {
            float& most = needs[standing->content.get()];
            most = std::max(most, needOf(id, streamed));
        }
    const auto least = std::ranges::min_element(needs, {}, [](const auto& content) { return content.second; });
    if (least == needs.end() || !(least->second < need)) return false;
    for (auto& [id, streamed] : surfaces_)
        if (const PlacedSurface* standing = context_.surfaces.find(id))
            if (standing->content.get() == least->first) sendAway(id, streamed);
    return true;
}

void Streaming::advance() {
    const std::set<uint32_t> wants = wanted();
    uint32_t coming = 0;
    for (auto& [id, streamed] : surfaces_) {
        if (streamed.load == 0) continue;
        if (wants.contains(id))
            ++coming;
        else
            endLoad(streamed);
    }
    while (deviceBytes() > def_.deviceBytes && makeRoomBelow(std::numeric_limits<float>::infinity())) {
    }
    std::vector<std::pair<float, uint32_t>> order;
    for (const uint32_t id : wants)
        if (!stands(id) && surfaces_.at(id).load == 0) order.emplace_back(-needOf(id, surfaces_.at(id)), id);
    std::ranges::sort(order);
    std::map<SharedFile, uint32_t> standing;  // one of them
    std::set<SharedFile> onTheirWay;
    for (const auto& [id, streamed] : surfaces_) {
        if (stands(id)) standing.emplace(fileOf(streamed), id);
        if (streamed.load != 0) onTheirWay.insert(fileOf(streamed));
    }
    for (const auto& [need, id] : order) {
        Streamed& streamed = surfaces_.at(id);
        if (const auto like = standing.find(fileOf(streamed)); like != standing.end()) {
            standAsIs(id, streamed, like->second);
            continue;
        }
        if (coming >= def_.loadsAtOnce || !onTheirWay.insert(fileOf(streamed)).second) continue;
        ++coming;
        std::optional<std::vector<std::byte>> file;
        if (context_.files.fromHost()) {
            const EspResult unread = readWhole(&context_, streamed.request.name, file.emplace());
            if (unread != ESP_OK) {
                failed(id, unread, std::exchange(context_.error, {}));
                continue;
            }
        }
        streamed.load = context_.loads->begin(streamed.request, std::move(file), id);
    }
}

void Streaming::standAsIs(uint32_t id, Streamed& streamed, uint32_t like) {
    const PlacedSurface& standing = *context_.surfaces.find(like);
    const uint64_t hash = standing.content->data.hash;
    if (const EspResult bad = mayStand(streamed, hash); bad != ESP_OK)
        return failed(id, bad, std::exchange(context_.error, {}));
    streamed.bytes = surfaces_.at(like).bytes;
    standLike(context_, id, standing, streamed.request);
    stood(streamed, hash);
}

bool Streaming::makeRoom(uint32_t load, uint64_t bytes) {
    const auto found = std::ranges::find_if(surfaces_, [&](const auto& s) { return s.second.load == load; });
    if (found == surfaces_.end()) return true;
    auto& [id, streamed] = *found;
    streamed.bytes = bytes;
    const float need = needOf(id, streamed);
    while (deviceBytes() + bytes > def_.deviceBytes)
        if (!makeRoomBelow(need)) return false;  // the next advance() finds what is wanted now
    return true;
}

EspResult Streaming::mayStand(const Streamed& streamed, uint64_t hash) const {
    if (streamed.hash == 0 || hash == streamed.hash) return ESP_OK;
    return fail(
        &context_, ESP_INVALID_CONTENT,
        streamed.request.name + ": isn't the file any more that stood here: destroy the surface and add it anew");
}

EspResult Streaming::stand(uint32_t id, SurfaceRead read) {
    Streamed& streamed = surfaces_.at(id);
    const uint64_t hash = read.surface.content->data.hash;
    if (const EspResult bad = mayStand(streamed, hash); bad != ESP_OK) return bad;
    standAs(context_, id, std::move(read));
    stood(streamed, hash);
    return ESP_OK;
}

void Streaming::stood(Streamed& streamed, uint64_t hash) {
    context_.layers.insert(context_.layers.end(), std::make_move_iterator(streamed.layers.begin()),
                           std::make_move_iterator(streamed.layers.end()));
    streamed.layers.clear();
    streamed.hash = hash;
    endLoad(streamed);
}

void Streaming::failed(uint32_t id, EspResult result, const std::string& message) {
    Streamed& streamed = surfaces_.at(id);
    streamed.result = result;
    streamed.message = message;
    endLoad(streamed);
}

void Streaming::endLoad(Streamed& streamed) {
    if (streamed.load != 0) context_.loads->end(streamed.load);
    streamed.load = 0;
}

void Streaming::shift(const glm::dvec3& by) {
    for (int k = 0; k < 3; ++k) def_.eye[k] = float(double(def_.eye[k]) - by[k]);
    for (auto& [id, streamed] : surfaces_) {
        streamed.request.place = placeAt(context_, streamed.request.place, streamed.request.stand);
        espalier::shift(streamed.middle, streamed.remainder, by);
    }
}

std::vector<PaintedLayer*> Streaming::layersAway() {
    std::vector<PaintedLayer*> layers;
    for (auto& [id, streamed] : surfaces_)
        for (PaintedLayer& layer : streamed.layers) layers.push_back(&layer);
    return layers;
}

void Streaming::loseFile(uint32_t id, EspResult result, const std::string& message) {
    failed(id, result, message);
    sendAway(id, surfaces_.at(id));
}

void Streaming::endLoads() {
    for (auto& [id, streamed] : surfaces_) endLoad(streamed);
}

// Its seeds stay, and wait. Its layers stay on the device, and are found again with it.
void Streaming::sendAway(uint32_t id, Streamed& streamed) {
    const uint32_t instance = context_.surfaces.find(id)->instance;
    SurfaceChanges changes = withChange(context_, instance, SurfaceChange::ground);
    const auto own = [&](const PaintedLayer& layer) { return layer.surface == id; };
    streamed.layers.reserve(size_t(std::ranges::count_if(context_.layers, own)));
    for (PaintedLayer& layer : context_.layers)
        if (own(layer)) streamed.layers.push_back(std::move(layer));
    std::erase_if(context_.layers, own);
    context_.renderer->removeSurface(instance);
    (void)context_.surfaces.take(id);
    context_.surfaceChanges = std::move(changes);
    context_.nodes.surfaces.change();
}

EspStreamedInfo Streaming::infoOf(uint32_t id) const {
    const Streamed& streamed = surfaces_.at(id);
    EspStreamedInfo info{};
    info.state = streamed.result != ESP_OK ? ESP_STREAMED_FAILED
                 : stands(id)              ? ESP_STREAMED_STANDS
                 : streamed.load != 0      ? ESP_STREAMED_COMING
                                           : ESP_STREAMED_AWAY;
    info.result = streamed.result;
    info.message = streamed.message.c_str();
    info.bytes = streamed.bytes;
    return info;
}

EspStreamingInfo Streaming::info() const {
    EspStreamingInfo info{};
    info.streamed = uint32_t(surfaces_.size());
    for (const auto& [id, streamed] : surfaces_) {
        info.standing += stands(id);
        info.coming += streamed.load != 0;
    }
    info.deviceBytes = deviceBytes();
    return info;
}

}  // namespace espalier
