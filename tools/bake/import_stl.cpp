// In: an STL file, text or binary. Out: its triangles; equal corners are one vertex only after the weld. STL has
// neither normals worth reading (they are the faces') nor UVs, materials or units.
#include <cstring>

#include "tools/bake/import_polygons.hpp"
#include "tools/bake/import_text.hpp"

namespace espalier::import {
namespace {

constexpr size_t kHeader = 84, kFacet = 50;  // bytes; a facet: normal, three corners, two bytes of anything

size_t facetsOf(Bytes file) {
    uint32_t count = 0;
    if (file.size() >= kHeader) std::memcpy(&count, file.data() + 80, 4);
    return count;
}

// Some binary files begin with "solid", too: their length tells.
bool isBinary(Bytes file) {
    return file.size() >= kHeader && (file.size() - kHeader) / kFacet >= facetsOf(file) && facetsOf(file) > 0;
}

Status readBinary(const std::string& path, Bytes file, std::vector<glm::dvec3>& corners) {
    const size_t count = facetsOf(file);
    if (count * 3 > kMaxVertices) return Failure(path, "more than 67 million vertices");
    for (size_t i = 0; i < count * 3; ++i) {
        float p[3];
        std::memcpy(p, file.data() + kHeader + i / 3 * kFacet + 12 + i % 3 * 12, sizeof p);
        corners.push_back({p[0], p[1], p[2]});
    }
    return Done{};
}

// "vertex x y z", three of them between "outer loop" and "endloop"; all else is passed over.
Status readText(const std::string& path, std::string_view text, std::vector<glm::dvec3>& corners,
                Blemishes& blemishes) {
    size_t ofLoop = 0;
    const auto endLoop = [&](int number) {
        if (ofLoop == 1 || ofLoop == 2) {
            corners.resize(corners.size() - ofLoop);
            blemishes.note("a facet of fewer than 3 corners left out", number);
        }
        ofLoop = 0;
    };
    Status read = eachLine(text, [&](std::string_view line, int number) -> Status {
        const std::string key = smallLetters(nextWord(line));
        if (key == "outer" || key == "endloop") endLoop(number);
        if (key != "vertex") return Done{};
        if (ofLoop == 3) return Failure(Diagnostic{path, number, 0, {}, "a facet of more than 3 corners"});
        glm::dvec3 p(0);
        for (int k = 0; k < 3; ++k)
            if (!toNumber(nextWord(line), p[k]))
                return Failure(Diagnostic{path, number, 0, {}, "a vertex without three numbers"});
        if (corners.size() >= kMaxVertices) return Failure(path, "more than 67 million vertices");
        corners.push_back(p);
        ++ofLoop;
        return Done{};
    });
    endLoop(0);
    return read;
}

}  // namespace

Status importStl(const std::string& path, Bytes file, const ImportOptions& options, Model& model) {
    std::vector<glm::dvec3> corners;
    Blemishes blemishes(path);
    const bool binary = isBinary(file);
    Status done = binary
                      ? readBinary(path, file, corners)
                      : readText(path, {reinterpret_cast<const char*>(file.data()), file.size()}, corners, blemishes);
    if (!done) return done;
    if (corners.empty()) return Failure(path, "the STL file holds no facets, or is cut off");
    Polygons polygons;
    for (uint32_t i = 0; i < corners.size(); i += 3) {
        for (uint32_t k = 0; k < 3; ++k)
            if (!isPlace(corners[i + k]))
                return Failure(path, "facet " + std::to_string(i / 3) + ": a position is not a number of sane size");
        const uint32_t facet[3] = {i, i + 1, i + 2};
        polygons.add(facet, 0);
    }
    settle(corners, polygons.corners(), options.origin, model);
    polygons.fill(model);
    model.triangleMaterial.clear();
    model.materials.emplace_back();
    blemishes.tell(model);
    return Done{};
}

}  // namespace espalier::import
