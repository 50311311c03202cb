// In: stretches of walls that neighbours share, an outline that was mended meanwhile. Out: its edges, divided.
#include "runtime/roof/shapes_beside.hpp"

#include <algorithm>
#include <cmath>

namespace espalier {

namespace {

constexpr double kOff = 0.05;        // metres that mending may have moved a wall
constexpr double kLeastPiece = 0.6;  // metres: shorter pieces of an edge go to the one beside them
constexpr double kSameTop = 0.3;     // metres

}  // namespace

OutlineNeighbours::OutlineNeighbours(const std::vector<SharedWall>& shared, glm::dvec2 origin,
                                     const OutlineEdges& edges)
    : edges_(edges), along_(edges.corner.size()) {
    if (shared.empty()) return;
    for (size_t e = 0; e < along_.size(); ++e) along_[e] = stretchesOn(e, origin, shared);
    closeLines();
}

std::vector<OutlineNeighbours::Stretch> OutlineNeighbours::stretchesOn(size_t edge, glm::dvec2 origin,
                                                                       const std::vector<SharedWall>& shared) const {
    const double length = edges_.length(edge);
    const glm::dvec2 along = edges_.along(edge), left(-along.y, along.x), a = origin + edges_.corner[edge];
    std::vector<Stretch> found;
    for (const SharedWall& wall : shared) {
        const glm::dvec2 p = wall.from - a, q = wall.to - a;
        if (std::max(std::abs(glm::dot(p, left)), std::abs(glm::dot(q, left))) > kOff) continue;
        double from = std::max(glm::dot(p, along), 0.0), to = std::min(glm::dot(q, along), length);
        if (from < kLeastPiece) from = 0;
        if (to > length - kLeastPiece) to = length;
        if (to - from >= std::min(kLeastPiece, length))
            found.push_back({from, to, {wall.top, wall.endsRoof, wall.alike}});
    }
    std::sort(found.begin(), found.end(), [](const Stretch& s, const Stretch& t) { return s.from < t.from; });
    std::vector<Stretch> joined;
    for (Stretch s : found) {
        if (!joined.empty() && s.from < joined.back().to + kLeastPiece) {
            Stretch& last = joined.back();
            const bool alike = std::abs(last.beside.top - s.beside.top) < kSameTop || s.to < last.to + kLeastPiece;
            if (alike) {
                last.to = std::max(last.to, s.to);
                last.beside.add(s.beside);
                continue;
            }
            s.from = last.to;
        }
        if (s.to - s.from >= kLeastPiece) joined.push_back(s);
    }
    return joined;
}

void OutlineNeighbours::closeLines() {
    for (size_t first = 0; first < along_.size(); ++first) {
        if (edges_.continues(first)) continue;
        double length = 0, closed = 0;
        Beside whole;
        std::vector<size_t> line;
        for (size_t e = first; line.empty() || (e != first && edges_.continues(e)); e = edges_.next[e]) {
            line.push_back(e);
            length += edges_.length(e);
            for (const Stretch& s : along_[e]) {
                whole.add(s.beside);
                if (s.beside.alike) closed += s.to - s.from;
            }
        }
        if (closed == 0 || closed < length / 2) continue;
        for (size_t e : line) along_[e] = {{0, edges_.length(e), whole}};
    }
}

bool OutlineNeighbours::closes(size_t edge) const {
    return along_[edge].size() == 1 && along_[edge][0].beside.alike &&
           along_[edge][0].to - along_[edge][0].from >= edges_.length(edge);
}

DividedOutline OutlineNeighbours::divide(const std::vector<std::vector<glm::dvec2>>& rings,
                                         const std::function<bool(size_t)>& whole) const {
    DividedOutline out;
    uint32_t e = 0;
    for (const auto& ring : rings) {
        out.rings.emplace_back();
        for (size_t i = 0; i < ring.size(); ++i, ++e) {
            const auto begin = [&](double at, Beside beside) {
                const glm::dvec2 p = ring[i] + at * edges_.along(e);
                out.rings.back().push_back(at == 0 ? ring[i] : glm::dvec2(glm::vec2(p)));  // floats hold every corner
                out.edges.push_back(e);
                out.beside.push_back(beside);
            };
            if (whole(e)) {
                Beside all;
                for (const Stretch& s : along_[e]) all.add(s.beside);
                begin(0, all);
                continue;
            }
            double at = 0;
            for (const Stretch& s : along_[e]) {
                if (s.from > at) begin(at, {});
                begin(s.from, s.beside);
                at = s.to;
            }
            if (at < edges_.length(e)) begin(at, {});
        }
    }
    return out;
}

}  // namespace espalier
