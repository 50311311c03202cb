#pragma once

#include "tests/editor/window.hpp"

// An editor (Base) of a town with the houses in hand, seen from above.
template <class Base>
struct OverTown : Base {
    OverTown(const Folder& folder, const std::string& town) : Base(folder, town, sample::Tool::houses) {
        this->work.frameAll();
        this->work.camera.turnTo(0, -1.5f);
    }
    EspHouseInfo info(uint32_t house) const {
        EspHouseInfo found;
        REQUIRE(espHouseInfo(this->work.context.get(), house, &found) == ESP_OK);
        return found;
    }
    uint32_t named(const std::string& id) const {
        for (uint32_t i = 0; i < espHouseCount(this->work.context.get()); ++i)
            if (info(i).id == id) return i;
        FAIL("no house is called ", id);
        return 0;
    }
    // The middle of a house's box: that of its roof, if nothing of the box is left out.
    glm::vec2 middle(uint32_t house) const {
        const EspHouseInfo of = info(house);
        return this->at((sample::vec(of.boundsMin) + sample::vec(of.boundsMax)) * .5f);
    }
};
