// In: bytes. Out: nothing, if all goes well; a surface that is accepted must hold what it promises.
#include "runtime/surface/surface.hpp"
#include "tests/fuzz/promise.hpp"

namespace espalier::fuzz {

void surface(Bytes bytes) {
    MemoryFile file(bytes);
    auto data = readSurface(file.path());
    if (!data) return checkMessage(data.failure());
    for (uint32_t i : data->indices) require(i < data->vertices.size(), "indices name vertices");
    for (const auto& range : data->ranges) require(range.material < data->materials.size(), "materials exist");
}

}  // namespace espalier::fuzz
