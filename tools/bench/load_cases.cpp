// load/…: what a surface takes of the thread that frames are drawn on, loaded beside them and at once.
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <thread>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {
namespace {

constexpr int kSurfaces = 6;
constexpr float kApart = 50;  // metres: they touch nothing

// Of this thread: it is what a host's frame has to spare.
double threadMs() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) * 1e3 + double(now.tv_nsec) * 1e-6;
}

EspSurfaceDef defOf(const std::string& path, const EspTransform& place) {
    EspSurfaceDef def{};
    def.structSize = sizeof def;
    def.name = path.c_str();
    def.place = &place;
    return def;
}
EspTransform at(int i) {
    EspTransform place = espIdentity();
    place.rows[0][3] = kApart * float(i);
    return place;
}

struct Costs {
    std::vector<double> atOnce, beside, longest;  // ms; of one call
    std::string failed;
};

double loadAtOnce(EspContext* context, const std::string& path, int i, Costs& costs) {
    const EspTransform place = at(i);
    EspSurface surface{};
    const double before = threadMs();
    if (espLoadSurface(context, path.c_str(), &place, &surface) != ESP_OK || espUpdate(context) != ESP_OK)
        costs.failed = espLastError(context);
    const double cost = threadMs() - before;
    (void)espDestroySurface(context, surface);
    return cost;
}

// Updates until it stands; the longest of them is noted, too.
double loadBeside(EspContext* context, const std::string& path, int i, Costs& costs) {
    const EspTransform place = at(i);
    const EspSurfaceDef def = defOf(path, place);
    EspLoad load{};
    EspLoadInfo info{};
    info.structSize = sizeof info;
    double sum = 0, longest = 0;
    const auto timed = [&](EspResult (*call)(EspContext*, const EspSurfaceDef*, EspLoad*)) {
        const double before = threadMs();
        const EspResult result = call ? call(context, &def, &load) : espUpdate(context);
        const double cost = threadMs() - before;
        sum += cost;
        longest = std::max(longest, cost);
        if (result != ESP_OK) costs.failed = espLastError(context);
    };
    timed(espBeginLoad);
    while (costs.failed.empty() && info.state < ESP_LOAD_STANDS) {
        timed(nullptr);
        if (espLoadInfo(context, load, &info) != ESP_OK || info.state == ESP_LOAD_FAILED) costs.failed = info.message;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    timed(nullptr);  // finds what it touches
    (void)espEndLoad(context, load);
    (void)espDestroySurface(context, info.surface);
    costs.longest.push_back(longest);
    return sum;
}

// Many places of one surface, beside as many loads.
void placesCase(Bench& bench, EspContext* context, const std::string& path, double loadMs) {
    constexpr int kPlaces = 2000;
    const char* const name = "load/places";
    if (!bench.wants(name)) return;
    const EspTransform origin = at(0);
    std::vector<EspSurface> surfaces(1);
    bool good =
        espLoadSurface(context, path.c_str(), &origin, surfaces.data()) == ESP_OK && espUpdate(context) == ESP_OK;
    const auto stats = [&] {
        EspStats read{};
        read.structSize = sizeof read;
        good = good && espReadStats(context, &read) == ESP_OK;
        return read;
    };
    const auto bytes = [&] { return double(stats().totalBytes) / (1 << 20); };
    // Two that run into each other.
    EspTransform beside = origin;
    beside.rows[0][3] = 3.5f, beside.rows[2][3] = 0.3f;
    EspSurface second{};
    const double surface = double(stats().surfaceBytes) / (1 << 20);
    good = good && espPlaceAgain(context, surfaces[0], &beside, &second) == ESP_OK && espUpdate(context) == ESP_OK;
    const double touched = (double(stats().surfaceBytes) / (1 << 20) - surface) / 2;
    good = good && espDestroySurface(context, second) == ESP_OK && espUpdate(context) == ESP_OK;
    const double one = bytes(), before = threadMs();
    for (int i = 1; i < kPlaces && good; ++i) {
        const EspTransform place = at(i);
        good = espPlaceAgain(context, surfaces[0], &place, &surfaces.emplace_back()) == ESP_OK;
    }
    good = good && espUpdate(context) == ESP_OK;
    const double ms = threadMs() - before, all = bytes();
    for (const EspSurface place : surfaces) (void)espDestroySurface(context, place);
    if (!good) return bench.skip(name, espLastError(context));
    bench.add({name, "memory of the device, 2,000 places", "MiB", all, "one place", one});
    bench.add({name, "memory for each of two that touch", "MiB", touched, "the surface", surface});
    bench.add({name, "CPU time of the frame's thread, a place", "ms", ms / kPlaces, "loaded", loadMs});
}

}  // namespace

void loadCases(Bench& bench) {
    const char* const name = "load/ruin";
    if (!bench.wants(name) && !bench.wants("load/places")) return;
    const std::string path = bench.options().contentFolder + "/ruin.surface.glb";
    if (!std::filesystem::exists(path)) return bench.skip(name, "there is no " + path);
    esp::Result<esp::Context> made = esp::Context::create();
    if (!made) return bench.skip(name, made.error().message);
    EspContext* context = made->get();
    Costs costs;
    for (int i = 0; i < kSurfaces && costs.failed.empty(); ++i) {
        costs.atOnce.push_back(loadAtOnce(context, path, i, costs));
        costs.beside.push_back(loadBeside(context, path, i, costs));
    }
    if (!costs.failed.empty()) return bench.skip(name, costs.failed);
    placesCase(bench, context, path, median(costs.atOnce));
    if (!bench.wants(name)) return;
    bench.add({name, "CPU time of the frame's thread, all calls", "ms", median(costs.beside), "loaded at once",
               median(costs.atOnce)});
    bench.add({name, "longest of these calls", "ms", median(costs.longest), "loaded at once", median(costs.atOnce)});
}

}  // namespace espalier
