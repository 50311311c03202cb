#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "sample_game/panels.hpp"
#include "tests/editor/widgets.hpp"

using namespace espalier::document;
using sample::array;
using sample::Tool;
using sample::vec;

using Keys = std::set<uint32_t>;

// Somebody with the seed tool in hand before the wall of the small scene.
struct Gardener : Editor {
    explicit Gardener(const Folder& folder) : Editor(folder, smallScene(folder), Tool::seeds) { faceWall(*this, 1.4f); }
    glm::vec2 onWall(float x, float y) const { return at({x, y, .36f}); }
    std::vector<SeedRecord> seeds() const {
        std::vector<SeedRecord> records;
        for (const auto& seed : work.scene().seeds) records.push_back(work.document->recordOf(seed));
        return records;
    }
    SeedRecord seed(uint32_t key) const {
        const auto* found = work.document->seed(key);
        REQUIRE(found);
        return work.document->recordOf(*found);
    }
    // The key of one that is planted by a click.
    uint32_t plant(glm::vec2 place) {
        click(place);
        REQUIRE(work.selected.size() == 1);
        return *work.selected.begin();
    }
    glm::vec2 marker(uint32_t key) const { return at(vec(seed(key).position)); }
    size_t steps() const { return work.document->undoSteps(); }
};

inline float angle(glm::vec3 a, glm::vec3 b) {
    return std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.f, 1.f));
}
