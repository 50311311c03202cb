// In: grids of cells. Out: triangles. A cell is cut in its grid's own coordinates by the half-spaces of each part of
// its region that it meets, so that neighbouring faces' tiles share their cuts (Buron 2013 §3.3).
#include "runtime/emit/roof_triangles.hpp"

#include <algorithm>

#include "shaders/shared/roof_cells.h"

namespace espalier {
namespace {

glm::vec3 unitOf(glm::vec3 v) {
    const float l = glm::length(v);
    return l > 1e-12f ? v / l : glm::vec3(0, 1, 0);
}

// A corner of a mesh while it is cut; at: the grid's coordinates.
struct Corner {
    glm::vec3 at, normal;
    float shade;
};
Corner between(const Corner& a, const Corner& b, float t) {
    return {glm::mix(a.at, b.at, t), glm::mix(a.normal, b.normal, t), glm::mix(a.shade, b.shade, t)};
}
using Polygon = std::vector<Corner>;

void cut(Polygon& polygon, CellPlane plane) {
    auto beyond = [&](const Corner& c) {
        return plane.fx * c.at.x + plane.fy * c.at.y + plane.fz * c.at.z - plane.limit;
    };
    Polygon kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const float da = beyond(a), db = beyond(b);
        if (da <= 0) kept.push_back(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) kept.push_back(between(a, b, da / (da - db)));
    }
    polygon = std::move(kept);
}

class GridWriter {
  public:
    GridWriter(const RoofEnv& env, const RoofGrid& grid, const TerminalData& data, RoofTriangles& out)
        : env_(env), g_(grid), data_(data), out_(out) {
        const uint32_t kind = grid.mesh & 255u;
        for (const TerminalVariant& v : data.variants)
            if (v.kind == kind && !lod_) lod_ = &v.lods.front();
        up_ = glm::cross(glm::vec3(g_.axisX), glm::vec3(g_.axisY));
        drops_ = mayDrop(env, g_);
        const glm::vec2 plot = plotOf(env, g_.house);
        plot_ = {plot.x, 0, plot.y};
        if (g_.region != kNoIndex) region_ = env.regions.v[g_.region], space_ = cellSpace(g_, region_);
        const glm::vec3 root(float(g_.colour & 255u), float(g_.colour >> 8 & 255u), float(g_.colour >> 16 & 255u));
        colour_ = root * root / (255.0f * 255.0f);
    }
    bool run(size_t most) {
        if (lod_ && g_.firstRow == kNoIndex) cell(0, 0, true);
        const uint32_t rows = lod_ && g_.firstRow != kNoIndex ? g_.cells >> 16 : 0;
        for (uint32_t row = 0; row < rows; ++row) {
            const RoofRun run = env_.runs.v[g_.firstRow + row];
            const uint32_t whole = runFirst(run.whole), wholeEnd = whole + runCount(run.whole);
            for (uint32_t c = runFirst(run.touched); c < runFirst(run.touched) + runCount(run.touched); ++c) {
                if (out_.bytes() > most) return false;
                if (!drops_ || !cellDropped(env_, g_, c, row)) cell(c, row, c >= whole && c < wholeEnd);
            }
        }
        return out_.bytes() <= most;
    }

  private:
    void cell(uint32_t column, uint32_t row, bool whole) {
        const bool bond = (g_.mesh & kGridBond) != 0 && (row & 1u) != 0;
        const glm::vec2 corner((float(column) - (bond ? 0.5f : 0.0f)) * g_.step.x, float(row) * g_.step.y);
        if (whole && out_.cellsApart && apart(corner)) return;
        const RoofMesh bounds = env_.meshes.v[g_.mesh & 255u];
        for (uint32_t i = 0; i + 2 < lod_->indexCount; i += 3) {
            Polygon triangle;
            for (uint32_t k = 0; k < 3; ++k) {
                const TerminalVertex& v = data_.vertices[lod_->firstVertex + data_.indices[lod_->firstIndex + i + k]];
                const glm::vec3 n = unpackOct(v.normal);
                triangle.push_back(
                    {glm::vec3(corner + glm::vec2(v.position) * glm::vec2(g_.size), v.position.z * g_.thickness),
                     {n.x / std::max(g_.size.x, 1e-4f), n.y / std::max(g_.size.y, 1e-4f),
                      n.z / std::max(g_.thickness, 1e-4f)},
                     v.uv.x});
            }
            if (whole || g_.region == kNoIndex)
                write(std::move(triangle), whole);
            else
                for (uint32_t p = 0; p < region_.partCount; ++p) {
                    const RoofPart part = env_.parts.v[region_.firstPart + p];
                    const uint32_t cuts = partCuts(env_, space_, part, cellBox(g_, bounds, column, row));
                    if (cuts == kPartMissed) continue;
                    Polygon piece = triangle;
                    for (uint32_t k = 0; k < kPartPlanes; ++k)
                        if (cuts >> k & 1u) cut(piece, cellPlane(space_, env_.planes.v[part.firstPlane + k]));
                    write(std::move(piece), false);
                }
        }
    }
    bool apart(glm::vec2 corner) {
        if (g_.taper.x != 0 || g_.taper.y != 0 || !(g_.thickness > 0)) return false;
        const glm::vec3 x(g_.axisX), y(g_.axisY);
        out_.cells.push_back({x * g_.size.x, y * g_.size.y, up_ * g_.thickness,
                              plot_ + glm::vec3(g_.origin) + x * corner.x + y * corner.y});
        return true;
    }
    void write(Polygon polygon, bool whole) {
        if (!whole && (g_.mesh & kGridRect) != 0) {
            cut(polygon, {-1, 0, 0, 0});
            cut(polygon, {1, 0, 0, g_.extent.x});
            cut(polygon, {0, 1, 0, g_.extent.y});
        }
        if (polygon.size() < 3) return;
        const uint32_t first = uint32_t(out_.positions.size());
        for (const Corner& c : polygon) {
            glm::vec3 p = c.at;
            const float t = g_.extent.y > 0 && g_.extent.y < 1e5f ? p.y / g_.extent.y : 0;
            p.x += t * glm::mix(g_.taper.x, g_.taper.y, g_.extent.x > 0 ? p.x / g_.extent.x : 0);
            out_.positions.push_back(plot_ + glm::vec3(g_.origin) + glm::vec3(g_.axisX) * p.x +
                                     glm::vec3(g_.axisY) * p.y + up_ * p.z);
            out_.normals.push_back(
                unitOf(glm::vec3(g_.axisX) * c.normal.x + glm::vec3(g_.axisY) * c.normal.y + up_ * c.normal.z));
            uint32_t colour = 0xFF000000u;
            for (int k = 0; k < 3; ++k)
                colour |= uint32_t(glm::clamp(colour_[k] * c.shade, 0.0f, 1.0f) * 255 + 0.5f) << (8 * k);
            out_.colours.push_back(colour);
        }
        for (uint32_t i = 1; i + 1 < polygon.size(); ++i)
            for (uint32_t v : {0u, i, i + 1}) out_.indices.push_back(first + v);
    }

    const RoofEnv& env_;
    const RoofGrid g_;
    const TerminalData& data_;
    RoofTriangles& out_;
    const TerminalLod* lod_ = nullptr;
    RoofRegion region_{};
    CellSpace space_{};
    bool drops_ = false;
    glm::vec3 up_{}, colour_{}, plot_{};
};

}  // namespace

std::vector<RoofMesh> terminalBounds(const TerminalData& data) {
    std::vector<RoofMesh> all(data.kinds.size(), RoofMesh{{0, 0, 0}, {1, 1, 0}});
    for (const TerminalVariant& v : data.variants) {
        RoofMesh b{glm::vec3(1e9f), glm::vec3(-1e9f)};
        const TerminalLod& lod = v.lods.front();
        for (uint32_t i = 0; i < lod.vertexCount; ++i) {
            b.low = glm::min(b.low, data.vertices[lod.firstVertex + i].position);
            b.high = glm::max(b.high, data.vertices[lod.firstVertex + i].position);
        }
        all[v.kind] = b;
    }
    return all;
}

bool appendGrid(const RoofEnv& env, const RoofGrid& grid, const TerminalData& meshes, RoofTriangles& out, size_t most) {
    return GridWriter(env, grid, meshes, out).run(most);
}

}  // namespace espalier
