#pragma once

// Where everything on a site stands: some by hand, where a picture wants it, the rest by rules.

#include "tools/content/site_plan.hpp"

namespace espalier::content {

class Layout {
  public:
    Layout(const Plan& plan, Site& site) : plan_(plan), site_(site) {}
    void lay();
    // Of crowns: x, z, radius.
    const std::vector<glm::vec3>& shades() const { return shades_; }

  private:
    // degrees: counterclockwise from above; sink: metres into the ground.
    void put(const std::string& model, glm::vec2 at, float degrees, float scale, float sink = 0);
    // Is there room for a circle off streets, the court and what stands, so many metres from houses?
    bool clear(glm::vec2 p, float radius, float fromHouse) const;
    void tree(const std::string& model, glm::vec2 at, float scale, float radius, uint32_t turn);
    // A row of pieces of two metres along a line; a piece is left out for each gate.
    void row(const std::string& piece, glm::vec2 a, glm::vec2 b, int gate = -1);

    // Turns a prop's front, +z, to `out` and takes its circle, if there's room for it.
    bool place(const std::string& model, glm::vec2 at, glm::vec2 out, float radius, float fromHouse);
    // Against a wall of a house, away from its doors, `depth` metres from the wall to its middle.
    void leanOnWall(const std::string& model, const Outline& house, float radius, float depth, uint32_t salt);

    // Away from a house whose wall lies from a to b.
    glm::vec2 outOf(glm::vec2 a, glm::vec2 b) const;
    // Behind a house, whose wall lies along a to b.
    struct Garden {
        glm::vec2 a, b, along, out;
        float deep;
        glm::vec2 at(float across, float depth) const { return glm::mix(a, b, across) + out * (depth * deep); }
    };
    Garden gardenOf(const Outline& house, uint32_t salt) const;

    void feature();
    void lawnBefore(glm::vec2 at, glm::vec2 out);
    void paddocks();
    void yards();
    void gardens();
    void walls();
    void furnish(const Garden& garden, uint32_t salt);
    void plantBed(glm::vec2 at, glm::vec2 along, glm::vec2 out, uint32_t salt);
    void steps(const Garden& garden, glm::vec2 gate);
    void trees();
    void beds();
    void daisies();
    void shrubs();
    void tallGrass();
    void turf();
    void tufts();
    void feet();
    void fallen();

    const Plan& plan_;
    Site& site_;
    std::vector<glm::vec3> taken_, shades_;  // circles: x, z, radius
};

}  // namespace espalier::content
