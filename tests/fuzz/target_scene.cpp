// In: bytes. Out: nothing, if all goes well; a scene that is accepted is the same once it has been written and read
// again.
#include "tests/fuzz/promise.hpp"
#include "tools/scene/scene_file.hpp"

namespace espalier::fuzz {

void scene(Bytes bytes) {
    const MemoryFile file(bytes);
    scene::SceneFile first, second;
    std::string error;
    if (!scene::readSceneFile(file.path(), first, error)) return require(!error.empty(), "a failure has a message");
    const std::string text = scene::writeSceneText(file.path(), first);
    const MemoryFile again({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    require(scene::readSceneFile(again.path(), second, error), "what was written can be read");
    require(scene::writeSceneText(file.path(), second) == text, "and is the same");
}

}  // namespace espalier::fuzz
