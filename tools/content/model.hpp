#pragma once

// The content tool's meshes: charts laid out in metres, welded into one surface, displaced, packed, painted.

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace espalier::content {

// An 8-bit RGBA picture, rows top to bottom.
struct Picture {
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;
    Picture() = default;
    Picture(int w, int h) : width(w), height(h), rgba(static_cast<size_t>(w) * static_cast<size_t>(h) * 4, 0) {}
    uint8_t* at(int x, int y) {
        return &rgba[(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) * 4];
    }
    const uint8_t* at(int x, int y) const {
        return &rgba[(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) * 4];
    }
};

// What a surface is like at one point of a chart. height: metres along the chart's normal, what the mesh is
// displaced by and, as far as the mesh is too coarse for it, the normal map. bump: metres more for the normal map
// alone. albedo: linear.
struct Detail {
    float height = 0;
    glm::vec3 albedo{0.5f};
    float bump = 0;
};
using DetailAt = std::function<Detail(glm::vec2 st)>;

// A piece of the undisplaced block-out, laid flat. st: metres, s to the right and t up as seen from outside, so
// that triangles are counter-clockwise in st.
struct Chart {
    std::string name;
    std::vector<glm::vec2> st;
    std::vector<glm::vec3> block;   // where the vertex is before displacement, metres
    std::vector<glm::vec3> normal;  // of the block-out there, unit
    std::vector<std::array<uint32_t, 3>> triangles;
    DetailAt detail;
    // Painted layers, [0, 1]; empty: as the comment says everywhere.
    std::function<float(glm::vec2 st)> mask;  // the guided grammar's path; 0
    std::function<float(glm::vec2 st)> ivy;   // how much ivy the sample wants; 0.5
};

// Where a chart lies in the atlas: uv = offset + scale * (s, height - t), turned by a quarter where `turned`.
struct Placement {
    glm::vec2 low{0}, size{0};  // of the chart in st
    glm::vec2 offset{0};        // metres in the atlas
    bool turned = false;
};

// A mesh ready to be written. Vertices of different charts at one place share `weld`.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec2> uvs;
    std::vector<uint32_t> weld;
    std::vector<uint32_t> indices;
};

// Charts joined at equal block-out positions (to a tenth of a millimetre), displaced and placed in one atlas.
struct Assembly {
    Mesh mesh;
    std::vector<uint32_t> firstVertex;  // of each chart, in the mesh
    std::vector<float> meshHeight;      // detail().height at each vertex
    std::vector<Placement> placements;  // of each chart
    float atlasMetres = 0;              // side of the atlas

    glm::vec2 toUv(size_t chart, glm::vec2 st) const;
    glm::vec2 toSt(size_t chart, glm::vec2 uv) const;
};

// warp moves a point of the block-out as a whole (leaning walls, ground that rises at their foot).
// gutter: room between charts and at the border, as a fraction of the atlas' side.
Assembly assemble(const std::vector<Chart>& charts, const std::function<glm::vec3(glm::vec3)>& warp, float gutter);

// Base colour (sRGB), tangent-space normals (+Y up) and the layers over an assembly's atlas, `size` texels a side,
// carried on into the gutters.
struct Painted {
    Picture color, normal, mask, ivy;
};
Painted paint(const std::vector<Chart>& charts, const Assembly& assembly, int size, int layerSize);

// Fills texels whose `filled` is 0 from their neighbours, `rounds` texels wide; alpha is left as it is.
void dilate(Picture& picture, std::vector<uint8_t> filled, int rounds);

// Candidate vertices of a planar chart, accepted in this order when no accepted one of the same rank is nearer
// than `spacing` and none of another rank nearer than `clear`.
struct Candidates {
    std::vector<glm::vec2> points;
    float spacing = 0, clear = 0;
};

// A planar chart from its border loops (dense polylines in st) and candidates.
void triangulate(Chart& chart, const std::vector<std::vector<glm::vec2>>& loops,
                 const std::vector<Candidates>& candidates);

// A chart from a grid of columns × rows points; at(column, row) fills st, block and normal.
struct GridPoint {
    glm::vec2 st;
    glm::vec3 block, normal;
};
void gridChart(Chart& chart, uint32_t columns, uint32_t rows,
               const std::function<GridPoint(uint32_t column, uint32_t row)>& at);

}  // namespace espalier::content
