// In: bytes. Out: nothing, if all goes well; a surface that is accepted must hold what it promises.
#include "runtime/surface/surface.hpp"
#include "tests/fuzz/promise.hpp"

namespace espalier::fuzz {

void surface(Bytes bytes) {
    MemoryFile file(bytes);
    auto data = readSurface(file.path());
    if (!data) return checkMessage(data.failure());
    const auto check = [&](const auto& mesh) {
        for (uint32_t i : mesh.indices) require(i < mesh.vertices.size(), "indices name vertices");
        for (const auto& range : mesh.ranges) require(range.material < data->materials.size(), "materials exist");
    };
    check(*data);
    for (const CoarserMesh& mesh : data->coarser) check(mesh);
}

}  // namespace espalier::fuzz
