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

    void feature();
    void yards();
    void gardens();
    void trees();
    void beds();
    void daisies();
    void shrubs();
    void tufts();

    const Plan& plan_;
    Site& site_;
    std::vector<glm::vec3> taken_, shades_;  // circles: x, z, radius
};

}  // namespace espalier::content
