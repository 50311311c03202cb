// In: bytes. Out: nothing, if all goes well; a preset that is accepted is the same once it has been written and read
// again, and a layout keeps to its bounds.
#include <cmath>

#include "sample_game/settings.hpp"
#include "tests/fuzz/promise.hpp"

namespace espalier::fuzz {

void preset(Bytes bytes) {
    static const MemoryFolder memory;
    static const bool set = ::setenv("XDG_CONFIG_HOME", memory.path.c_str(), 1) == 0 &&
                            std::filesystem::create_directories(memory.path / "espalier/presets/ivy");
    require(set, "settings lie in memory");
    memory.write("espalier/presets/ivy/one.json", textOf(bytes));
    memory.write("espalier/layout.json", textOf(bytes));

    std::vector<document::Param> params, again;
    std::string error;
    if (!sample::readPreset("ivy", "one", params, error)) {
        require(!error.empty(), "a failure has a message");
    } else {
        require(sample::writePreset("ivy", "two", params, error), "a preset can be written");
        require(sample::readPreset("ivy", "two", again, error), "and read again");
        require(again.size() == params.size(), "and is the same");
    }
    sample::Layout layout;
    sample::Brush brush;
    sample::readLayout(layout, brush, error);
    require(layout.windowWidth <= 16384 && layout.windowHeight <= 16384, "a window has a size");
    require(layout.layerOpacity >= .05f && layout.layerOpacity <= 1, "a layer is seen");
    require(brush.radius > 0 && std::isfinite(brush.radius), "a brush has a radius");
}

}  // namespace espalier::fuzz
