// Real models, where they are at hand: imported and baked within the promised figures.
#include <doctest/doctest.h>

#include <filesystem>

#include "tests/support/data.hpp"
#include "tools/bake/bake.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

struct Expected {
    const char* file;
    uint32_t charts;  // 0: not checked
};

}  // namespace

TEST_CASE("real models bake within the promised figures") {
    const Expected models[] = {{"models/polyhaven_concrete_cat_statue/concrete_cat_statue_1k.gltf", 32},
                               {"models/threedscans/Hermes.glb", 0},
                               {"models/threedscans/Plato.glb", 9},
                               {"models/threedscans/Column03.glb", 6},
                               {"models/danishstatues/Maria.glb", 0},
                               {"derived/bunny_unwrap.glb", 0},
                               {"models/quaternius/1Story_GableRoof_Mat.glb", 0},
                               {"models/quaternius/4Story_Mat.glb", 0},
                               {"models/quaternius/2Story_Stairs_Mat.glb", 0},
                               {"models/quaternius/Well.glb", 0},
                               {"models/kaykit_city/building_H_withoutBase.gltf", 0}};
    for (const Expected& expected : models) {
        auto path = dataFile(expected.file);
        if (!path) continue;
        CAPTURE(expected.file);
        auto model = importModel(*path);
        if (!model) FAIL(model.failure().text());
        auto baked = bake(*model, {});
        if (!baked) FAIL(baked.failure().text());
        const BakeReport& r = baked->report;
        if (expected.charts) CHECK(r.charts == expected.charts);
        uint32_t linked = r.seamCrossings + r.nearestCrossings;
        CHECK(r.seamCrossings > 100);
        CHECK(r.roundTrip999 <= 0.05);
        CHECK(r.gap999 <= 0.1);
        CHECK(double(r.danglingCrossings) <= 0.001 * double(linked));
        CHECK(double(r.danglingContacts) <= 0.005 * double(r.contactCrossings));
        CHECK(r.reachableShare() >= 0.95);
        CHECK(r.leastReachable() >= 0.95);
        CHECK(r.innerTexels + r.buriedTexels > 300000);
        CHECK(r.walkableByLevel[0].second > 0.999);
    }
}

TEST_CASE("one model in five encodings imports alike") {
    auto plain = dataFile("models/threedscans/Hermes.glb");
    if (!plain) return;
    auto reference = importModel(*plain);
    REQUIRE(reference);
    auto bounds = [](const Model& m) {
        glm::vec3 low(1e30f), high(-1e30f);
        for (const glm::vec3& p : m.positions) low = glm::min(low, p), high = glm::max(high, p);
        return high - low;
    };
    glm::vec3 size = bounds(*reference);
    for (const char* name : {"hermes_draco", "hermes_meshopt", "hermes_quant", "hermes_gltfpack_cc"}) {
        auto path = dataFile(std::string("derived/") + name + ".glb");
        if (!path) continue;
        CAPTURE(name);
        auto model = importModel(*path);
        if (!model) FAIL(model.failure().text());
        CHECK(model->indices.size() == doctest::Approx(double(reference->indices.size())).epsilon(0.001));
        CHECK(glm::length(bounds(*model) - size) < 0.002f * glm::length(size));
        auto baked = bake(*model, {});
        if (!baked) FAIL(baked.failure().text());
        CHECK(baked->report.charts >= 41);
        CHECK(baked->report.roundTrip999 <= 0.05);
        CHECK(baked->report.gap999 <= 0.1);
    }
}

TEST_CASE("every sample and hostile file is imported or refused with a message that names it") {
    size_t imported = 0, refused = 0;
    for (const char* folder : {"models/khronos", "validator_cases", "models/gltf_transform", "models/pmndrs"}) {
        auto path = dataFile(folder);
        if (!path) continue;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(*path)) {
            std::string name = entry.path().string(), ending = entry.path().extension().string();
            if (ending != ".gltf" && ending != ".glb") continue;
            CAPTURE(name);
            auto model = importModel(name);
            if (model) {
                ++imported;
                BakeOptions options;
                options.resolution = 128;
                auto baked = bake(*model, options);  // refused or not: no crash
                if (!baked) CHECK(!baked.failure().text().empty());
            } else {
                ++refused;
                CHECK(model.failure().diagnostics.front().file.find(entry.path().filename().string()) !=
                      std::string::npos);
                CHECK(!model.failure().diagnostics.front().message.empty());
            }
        }
    }
    if (!dataFolder().empty()) {
        CHECK(imported > 10);
        CHECK(refused > 10);
    }
}
