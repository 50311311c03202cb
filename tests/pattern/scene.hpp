#pragma once

// A surface with fields, grammars, pieces and seeds, on which patterns grow.

#include <functional>
#include <string>
#include <vector>

#include "runtime/field/field.hpp"
#include "runtime/grammar/grammar.hpp"
#include "runtime/pattern/pattern_data.hpp"
#include "tools/bake/bake.hpp"

namespace espalier::patterntest {

// A square of the given side, metres, about the origin, facing up.
Model square(float side);
// nu x nv quads over (u, v) in [0, 1]², one chart.
Model sheet(uint32_t nu, uint32_t nv, const std::function<glm::vec3(float, float)>& place,
            const std::function<glm::vec3(float, float)>& normal);
// About the y axis, nu x nv quads, one chart.
Model torus(float large, float small, uint32_t nu = 96, uint32_t nv = 48);

class Scene {
  public:
    Scene(const Model& model, uint32_t resolution);

    // Of the grammar that is added next or was added last. A box has unit edges and stands on its origin, a ring lies
    // around it, one wide.
    uint32_t addGrammar(const std::string& text);
    // The field by its name in the grammar added last.
    void setField(const std::string& name, const Field& field);
    const FieldMesh& mesh() const { return mesh_; }
    const RuleMap& grammar(uint32_t i) const { return grammars_[i]; }
    // The middle of the texel that is nearest, where a seed planted there stands.
    glm::vec3 placeNear(glm::vec3 at) const { return texelNear(at).second; }
    // A seed's way begins in this direction.
    void plant(glm::vec3 at, glm::vec3 direction, uint32_t grammar = 0, uint64_t number = 1);
    std::vector<Seed>& seeds() { return seeds_; }

    GrownPattern grow(unsigned threads = 1) const;
    Result<GrownPattern> tryGrow(const PatternLimits& limits, unsigned threads = 1) const;

    const PieceMeshes& meshes() const { return meshes_; }
    const SurfaceData& surface() const { return surface_; }

  private:
    std::pair<Walk, glm::vec3> texelNear(glm::vec3 at) const;

    SurfaceData surface_;
    FieldMesh mesh_;
    PieceMeshes meshes_;
    std::vector<RuleMap> grammars_;
    std::vector<std::vector<std::vector<FieldTexel>>> fields_;  // [grammar][field]
    std::vector<std::vector<uint32_t>> symmetry_;
    std::vector<Seed> seeds_;
};

}  // namespace espalier::patterntest
