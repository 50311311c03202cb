// In: bytes. Out: nothing, if all goes well; of meshes that are accepted every index stays within its mesh.
#include "runtime/emit/terminals.hpp"
#include "tests/fuzz/promise.hpp"

namespace espalier::fuzz {

void terminals(Bytes bytes) {
    const MemoryFile file(bytes);
    for (const std::vector<std::string>& kinds : {standardTerminalKinds(), {"bark"}}) {  // the second takes any more
        Result<TerminalData> read = readTerminals(file.path(), kinds);
        if (!read) {
            checkMessage(read.failure());
            continue;
        }
        for (const TerminalVariant& variant : read->variants)
            for (const TerminalLod& lod : variant.lods) {
                require(lod.material < read->materials.size(), "a mesh has a material");
                require(lod.firstIndex + lod.indexCount <= read->indices.size(), "a mesh has its indices");
                for (uint32_t i = 0; i < lod.indexCount; ++i)
                    require(read->indices[lod.firstIndex + i] < lod.vertexCount, "an index is of a vertex");
            }
    }
}

}  // namespace espalier::fuzz
