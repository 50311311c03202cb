#pragma once

// Surfaces that stand in one world, as a context has them, for walks on the CPU.

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "runtime/surface/added_crossings.hpp"
#include "runtime/surface/burial.hpp"
#include "runtime/surface/gpu_surface.hpp"
#include "shaders/shared/walk.h"
#include "tools/bake/bake.hpp"

namespace espalier::contacttest {

// A baked model as it comes out of its file.
inline SurfaceData throughFile(const Model& model, uint32_t resolution, bool keepLayout = false) {
    BakeOptions options;
    options.resolution = resolution;
    options.levels = 2;
    options.keepLayout = keepLayout;
    auto baked = bake(model, options);
    REQUIRE(baked);
    const auto path = std::filesystem::temp_directory_path() / ("espalier_placed_" + std::to_string(getpid()) + ".glb");
    REQUIRE(writeSurface(baked->surface, path.string()));
    auto read = readSurface(path.string());
    std::filesystem::remove(path);
    REQUIRE(read);
    return std::move(*read);
}

class World {
  public:
    // Returns its instance.
    uint32_t add(SurfaceData data, const glm::mat4& toWorld) {
        auto one = std::make_unique<One>();
        one->ground = std::make_unique<ContactGround>(data);
        one->baked = std::move(data);
        one->toWorld = toWorld;
        all_.push_back(std::move(one));
        return uint32_t(all_.size() - 1);
    }
    void place(uint32_t instance, const glm::mat4& toWorld) { all_[instance]->toWorld = toWorld; }

    // Finds all contacts and what is buried, and gives them to the surfaces.
    // crossings: false for what is buried alone.
    void join(bool crossings = true) {
        std::vector<std::vector<Crossing>> added(all_.size());
        std::vector<TexelSets> hidden(all_.size());
        for (uint32_t i = 0; i < all_.size(); ++i)
            for (uint32_t j = i + 1; j < all_.size(); ++j) {
                std::vector<PlacedGround> others;
                for (uint32_t k = 0; k < all_.size(); ++k)
                    if (k != i && k != j) others.push_back(placed(k));
                PlacedContacts found = contactsOf(placed(i), placed(j), others);
                addTo(hidden[i], hiddenTexels(baked(i), placed(i), placed(j), found.fromA, true));
                addTo(hidden[j], hiddenTexels(baked(j), placed(j), placed(i), found.fromB, false));
                for (Crossing& c : found.fromA) c.target = j << 16 | (c.target & 0xFFFFu), added[i].push_back(c);
                for (Crossing& c : found.fromB) c.target = i << 16 | (c.target & 0xFFFFu), added[j].push_back(c);
            }
        refs_.clear();
        for (uint32_t i = 0; i < all_.size(); ++i) {
            One& one = *all_[i];
            one.joined = one.baked;
            const TexelSets buried = buriedTexels(one.baked, hidden[i], added[i]);
            if (!crossings) added[i].clear();
            auto patches = patchLevels(one.baked, added[i], buried);
            REQUIRE(patches);
            for (size_t l = 0; l < patches->size(); ++l) applyPatch((*patches)[l], one.joined.levels[l]);
            one.joined.crossings.insert(one.joined.crossings.end(), added[i].begin(), added[i].end());
            refs_.push_back(surfaceRef(one.joined));
            placeSurface(refs_.back(), one.toWorld);
        }
    }

    const SurfaceData& baked(uint32_t i) const { return all_[i]->baked; }
    const SurfaceData& joined(uint32_t i) const { return all_[i]->joined; }
    glm::mat4 toWorld(uint32_t i) const { return all_[i]->toWorld; }
    double texel(uint32_t i) const {  // metres in the world, of the finest level
        return all_[i]->ground->texel() * glm::length(glm::dvec3(toWorld(i)[0]));
    }
    SurfaceBuf table() { return {refs_.data()}; }

    // On the texel of that kind whose point is nearest to `at`. position, direction: world.
    bool start(WalkState& w, uint32_t instance, glm::vec3 at, glm::vec3 direction, uint32_t level = 0,
               uint32_t kind = kTexelInner) {
        const SurfaceLevelData& finest = all_[instance]->joined.levels[0];
        const glm::mat4 back = glm::inverse(toWorld(instance));
        const glm::vec3 local(back * glm::vec4(at, 1));
        float least = 1e30f;
        glm::vec2 uv(0);
        uint32_t chart = kNoIndex;
        for (uint32_t y = 0; y < finest.size; ++y)
            for (uint32_t x = 0; x < finest.size; ++x) {
                const Texel& t = finest.texels[texelIndex(finest.size, x, y)];
                const float d = glm::length(t.position - local);
                if (texelClass(t.bits) != kind || d >= least) continue;
                least = d, chart = texelChart(t.bits);
                uv = (glm::vec2(float(x), float(y)) + 0.5f) / float(finest.size);
            }
        return startWalk(table(), level, instance << 16 | chart, uv, glm::mat3(back) * direction, w);
    }
    glm::vec3 positionOf(const WalkState& w) const {
        return glm::vec3(toWorld(w.walk.place >> 16) * glm::vec4(w.position, 1));
    }
    glm::vec3 directionOf(const WalkState& w, glm::vec3 local) const {
        return glm::normalize(glm::mat3(toWorld(w.walk.place >> 16)) * local);
    }

  private:
    struct One {
        SurfaceData baked, joined;
        std::unique_ptr<ContactGround> ground;
        glm::mat4 toWorld{1};
    };
    PlacedGround placed(uint32_t i) const { return {all_[i]->ground.get(), glm::dmat4(all_[i]->toWorld)}; }

    std::vector<std::unique_ptr<One>> all_;
    std::vector<SurfaceRef> refs_;
};

}  // namespace espalier::contacttest
