// In: a mesh some of whose materials are bare. Out: crossings that lead nowhere around these, and texels that are no
// ground. Charts know nothing of it: a model has one atlas, whatever is to grow on it.
#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {

std::vector<Link> bareBorders(const BakeMesh& mesh) {
    std::vector<Link> out;
    for (uint32_t h = 0; h < mesh.joined.size(); ++h)
        if (mesh.joined[h] && !mesh.triangles[h / 3].bare && mesh.parted(h / 3, mesh.twin[h] / 3))
            out.push_back({h, kNone, 0, 1, 0, 0, kCrossingOpen});
    return out;
}

void closeTowardsBare(const BakeMesh& mesh, const std::vector<Sides>& sides, std::vector<Crossing>& crossings) {
    for (size_t i = 0; i < sides.size(); ++i) {
        if (sides[i].to == kNone || !mesh.parted(sides[i].from, sides[i].to)) continue;
        Crossing& c = crossings[i];
        if ((c.flags & 3u) == kCrossingContact)
            c = closed(c);
        else
            c.flags |= kCrossingOpen;
    }
}

uint64_t takeBareTexels(const BakeMesh& mesh, SurfaceLevelData& level) {
    uint64_t count = 0;
    for (size_t i = 0; i < level.texels.size(); ++i) {
        uint32_t& bits = level.texels[i].bits;
        if (texelClass(bits) != kTexelInner || !mesh.triangles[level.aux[i].triangle].bare) continue;
        bits = (bits & ~0x30000u) | kTexelLink << 16;
        ++count;
    }
    return count;
}

}  // namespace espalier::bakery
