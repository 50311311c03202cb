// A roof structure -> atoms with their targets, the pieces of their outlines and their regions (Buron 2013 §3.1).
// Planes lean halfway between the two faces that meet in them (Figure 4 d-f), so that tiles of both meet there.
#include "runtime/roof_growth/atoms.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "runtime/core/hash.hpp"
#include "runtime/core/srgb.hpp"
#include "shaders/shared/random.h"

namespace espalier {
namespace {

constexpr uint32_t kWallOnly = 3;  // RoofAtom::kind
constexpr float kLevel = 1e-3f;    // metres

struct Frame {
    glm::vec3 origin, a, b, c;
    glm::vec3 local(glm::vec3 p) const {
        const glm::vec3 d = p - origin;
        return {glm::dot(a, d), glm::dot(b, d), glm::dot(c, d)};
    }
    glm::vec3 turned(glm::vec3 v) const { return {glm::dot(a, v), glm::dot(b, v), glm::dot(c, v)}; }
};

glm::vec3 unitOr(glm::vec3 v, glm::vec3 other) {
    const float l = glm::length(v);
    return l > 1e-9f ? v / l : other;
}

class HouseAtoms {
  public:
    HouseAtoms(RoofTables& tables, const RoofStructure& structure, uint32_t house, uint32_t number,
               const AtomOptions& options)
        : t_(tables), s_(structure), h_(structure.houses[house]), number_(number), options_(options) {}

    RoofTables::House run() {
        RoofTables::House range{uint32_t(t_.atoms.size()), 0};
        for (uint32_t f = 0; f < h_.faceCount; ++f) {
            const RoofFace& face = s_.faces[h_.firstFace + f];
            groups_[{face.tier, face.edge, uint32_t(face.kind)}].push_back(h_.firstFace + f);
        }
        uint32_t next = range.firstAtom;
        for (const auto& [key, faces] : groups_)
            for (uint32_t f : faces) atomOf_[f] = next + uint32_t(std::distance(groups_.begin(), groups_.find(key)));
        for (const auto& [key, faces] : groups_) addFaces(faces);
        claimUppers();
        addBareWalls();
        range.atomCount = uint32_t(t_.atoms.size()) - range.firstAtom;
        for (uint32_t i = 0; i < range.atomCount; ++i) markPieces(t_.atoms[range.firstAtom + i]);
        return range;
    }

  private:
    static glm::vec3 normalOf(const RoofFace& face) {
        const glm::vec3 along = unitOr(face.eave[1] - face.eave[0], {1, 0, 0});
        const glm::vec3 inward = glm::cross(glm::vec3(0, 1, 0), along);
        if (face.kind == FaceKind::gable) return -inward;
        return glm::normalize(glm::vec3(0, 1, 0) - inward * face.slope);
    }
    static Frame frameOf(const RoofFace& face) {
        Frame f;
        f.origin = face.eave[0];
        f.a = unitOr(face.eave[1] - face.eave[0], {1, 0, 0});
        f.a.y = 0;
        f.a = unitOr(f.a, {1, 0, 0});
        f.b = face.kind == FaceKind::gable ? glm::vec3(0, 1, 0) : glm::cross(glm::vec3(0, 1, 0), f.a);
        f.c = glm::cross(f.a, f.b);
        return f;
    }

    RoofAtom newAtom(uint32_t edge, uint32_t tier) const {
        RoofAtom atom{};
        const uint64_t house = mix64(hashText(h_.id, 0x526F6F66u));
        atom.key = childKey(house, edge, tier);
        atom.random = uniformRandom(house, 1);
        atom.region = kNoIndex;
        atom.house = number_;
        atom.tier = tier;
        atom.style = uint32_t(h_.shape) | (h_.material & 255u) << 8 | ((h_.colour >> 24) != 0 ? 1u << 16 : 0u) |
                     h_.chimneys << kAtomChimneys | (h_.open ? kAtomOpen : 0u) | sharedOf(edge) << kAtomShared;
        atom.overhang = h_.overhang;
        for (int c = 0; c < 3; ++c) atom.colour[c] = linearOfSrgb(float(h_.colour >> (8 * c) & 255) / 255);
        atom.firstPiece = uint32_t(t_.pieces.size());
        if (tier == 0) atom.corners = cornersOf(edge);
        return atom;
    }
    bool closed(uint32_t edge) const { return edge < h_.shared.size() && h_.shared[edge] == kEndsRoof; }
    // For RoofAtom::style: rounded up, but below the eave.
    uint32_t sharedOf(uint32_t edge) const {
        if (closed(edge)) return kAtomClosed;
        const float most = std::min(h_.eaveHeight - h_.baseHeight - 0.25f, 0.25f * (kAtomClosed - 1));
        const float shared = edge < h_.shared.size() ? std::min(h_.shared[edge], most) : 0;
        return uint32_t(std::max(std::ceil(4 * shared), 0.0f));
    }
    // Overhanging eaves of two edges meet on the line that halves their corner: tan of half the turn.
    glm::vec2 cornersOf(uint32_t edge) const {
        // Beside a wall that goes up to the roof there is no eave to meet. At a neighbour's eaves end with the wall.
        auto walled = [&](uint32_t e) { return groups_.count({0, e, uint32_t(FaceKind::gable)}) != 0; };
        constexpr float kNone = 1e-6f;
        uint32_t first = 0;
        for (const auto& ring : h_.rings) {
            const uint32_t n = uint32_t(ring.size());
            if (edge >= n) {
                edge -= n;
                first += n;
                continue;
            }
            auto side = [&](uint32_t i) { return glm::dvec2(ring[(i + 1) % n]) - glm::dvec2(ring[i % n]); };
            auto half = [](glm::dvec2 a, glm::dvec2 b) {
                const double turn = std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
                return float(glm::clamp(std::tan(turn / 2), -2.0, 2.0));
            };
            auto beside = [&](uint32_t e, float meeting) {
                return closed(first + e) ? kNone : walled(first + e) ? 0 : meeting == 0 ? kNone : meeting;
            };
            const uint32_t before = (edge + n - 1) % n, behind = (edge + 1) % n;
            return {beside(before, half(side(before), side(edge))), beside(behind, half(side(edge), side(behind)))};
        }
        return {0, 0};
    }
    void setEave(RoofAtom& atom, glm::vec3 from, glm::vec3 along, float length) const {
        atom.tangent = along;
        atom.eaveLength = length;
        atom.foot = from;
        atom.foot.y = std::min(h_.baseHeight, from.y);
        atom.wallHeight = from.y - atom.foot.y;
    }

    void addFaces(const std::vector<uint32_t>& faces) {
        const uint32_t main = *std::min_element(faces.begin(), faces.end(), [&](uint32_t a, uint32_t b) {
            return std::make_pair(s_.faces[a].detached, a) < std::make_pair(s_.faces[b].detached, b);
        });
        const RoofFace& face = s_.faces[main];
        Frame frame = frameOf(face);
        RoofAtom atom = newAtom(face.edge, face.tier);
        atom.kind = uint32_t(face.kind);
        atom.slope = face.slope;
        float begin = 0, end = 0;
        for (uint32_t f : faces) {
            if (s_.faces[f].detached) continue;
            for (glm::vec3 p : s_.faces[f].eave) {
                begin = std::min(begin, frame.local(p).x);
                end = std::max(end, frame.local(p).x);
            }
        }
        frame.origin += frame.a * begin;
        setEave(atom, frame.origin, frame.a, end - begin);
        atom.region = uint32_t(t_.regions.size());
        RoofRegion region{};
        region.origin = frame.origin;
        region.axisA = frame.a;
        region.axisB = frame.b;
        region.axisC = frame.c;
        region.low = glm::vec2(1e9f);
        region.high = -region.low;
        region.firstPart = uint32_t(t_.parts.size());
        for (uint32_t f : faces) addOutline(f, frame, region);
        region.partCount = uint32_t(t_.parts.size()) - region.firstPart;
        for (uint32_t f : faces) addPieces(f, frame);
        atom.pieceCount = uint32_t(t_.pieces.size()) - atom.firstPiece;
        findTargets(atom, frame);
        t_.regions.push_back(region);
        t_.atoms.push_back(atom);
    }

    // The corners from which a face's segments lead: eave[1] first, or for detached ones where the last one ends.
    glm::vec3 chainBegin(const RoofFace& face) const {
        return face.detached ? s_.segments[face.firstSegment + face.segmentCount - 1].to : face.eave[1];
    }

    void addOutline(uint32_t f, const Frame& frame, RoofRegion& region) {
        const RoofFace& face = s_.faces[f];
        std::vector<OutlineEdge> edges;
        glm::vec3 from = chainBegin(face);
        auto add = [&](glm::vec3 a, glm::vec3 b, vec4 plane, bool open, bool seam) {
            const glm::vec3 p = frame.local(a), q = frame.local(b);
            edges.push_back({{p.x, p.y}, {q.x, q.y}, plane, open, seam});
            region.low = glm::min(region.low, glm::vec2(p));
            region.high = glm::max(region.high, glm::vec2(p));
        };
        if (!face.detached)
            add(face.eave[0], face.eave[1], planeOf(face, frame, face.eave[0], face.eave[1], nullptr),
                face.kind != FaceKind::flat, false);
        bool verge = false;
        for (uint32_t i = 0; i < face.segmentCount; ++i) {
            const ChainSegment& segment = s_.segments[face.firstSegment + i];
            vec4 plane = planeOf(face, frame, from, segment.to, &segment);
            // Roofs reach over the walls of their gables, but not over a neighbour.
            if (reachesOver(segment) && face.kind == FaceKind::slope) {
                plane.w += options_.verge;
                verge = true;
            }
            add(from, segment.to, plane, false, segment.kind == JointKind::cut);
            from = segment.to;
        }
        if (verge) {
            region.low.x -= options_.verge;
            region.high.x += options_.verge;
        }
        cutIntoParts(edges, t_.parts, t_.planes);
    }

    bool reachesOver(const ChainSegment& segment) const {
        return segment.kind == JointKind::verge && !(segment.face != kNoFace && closed(s_.faces[segment.face].edge));
    }

    // The half-space inside an edge of the outline; leaning between the two faces where another one meets it.
    vec4 planeOf(const RoofFace& face, const Frame& frame, glm::vec3 from, glm::vec3 to,
                 const ChainSegment* segment) const {
        const glm::vec3 p = frame.local(from), q = frame.local(to);
        glm::vec3 outward(q.y - p.y, p.x - q.x, 0);
        const float length = glm::length(outward);
        if (length < 1e-9f) return {0, 0, 0, 1};
        outward /= length;
        const bool meets = segment != nullptr && segment->face != kNoFace && face.kind != FaceKind::gable &&
                           s_.faces[segment->face].kind != FaceKind::gable && segment->kind != JointKind::cut;
        if (meets) {
            const glm::vec3 between = normalOf(face) + normalOf(s_.faces[segment->face]);
            glm::vec3 m = frame.turned(glm::cross(glm::normalize(to - from), between));
            if (glm::dot(m, outward) < 0) m = -m;
            if (glm::length(m) > 1e-6f && glm::dot(glm::normalize(m), outward) > 0.05f) outward = glm::normalize(m);
        }
        return {outward, glm::dot(outward, p)};
    }

    void addPieces(uint32_t f, const Frame& frame) {
        const RoofFace& face = s_.faces[f];
        glm::vec3 from = chainBegin(face);
        for (uint32_t i = 0; i < face.segmentCount; ++i) {
            const ChainSegment& segment = s_.segments[face.firstSegment + i];
            if (segment.kind != JointKind::cut && glm::length(segment.to - from) > kLevel) {
                RoofPiece piece{};
                piece.from = frame.local(from);
                piece.to = frame.local(segment.to);
                glm::vec3 normal = normalOf(face);
                if (segment.face != kNoFace && s_.faces[segment.face].kind != FaceKind::gable)
                    normal = unitOr(normal + normalOf(s_.faces[segment.face]), normal);
                piece.normal = frame.turned(normal);
                const float lean = glm::clamp(glm::dot(normal, normalOf(face)), 0.05f, 1.0f);
                piece.fold = std::sqrt(1 - lean * lean) / lean;
                const bool atNeighbour = segment.kind == JointKind::verge && !reachesOver(segment);
                piece.kind = uint32_t(atNeighbour ? JointKind::wall : segment.kind) + 1;
                piece.upper = kNoIndex;
                piece.owner = segment.face == kNoFace || f < segment.face ? 1 : 0;
                beyond_.push_back({uint32_t(t_.pieces.size()), f, segment.face});
                t_.pieces.push_back(piece);
            }
            from = segment.to;
        }
    }

    // The highest piece's ends: of a ridge both, of an apex twice the same (§3.1).
    void findTargets(RoofAtom& atom, const Frame& frame) const {
        auto height = [&](glm::vec3 p) { return frame.a.y * p.x + frame.b.y * p.y + frame.c.y * p.z; };
        float best = -1e9f;
        for (uint32_t i = 0; i < atom.pieceCount; ++i) {
            const RoofPiece& piece = t_.pieces[atom.firstPiece + i];
            for (const auto& [p, q] : {std::pair(piece.from, piece.to), std::pair(piece.to, piece.from)}) {
                const bool level = std::abs(height(p) - height(q)) < kLevel;
                if (height(p) < best + (level ? -kLevel : kLevel)) continue;
                best = std::max(best, height(p));
                atom.target1 = level ? piece.to : p;
                atom.target2 = level ? piece.from : p;
            }
        }
        atom.height = std::max(best, 0.0f);
    }

    // Above a break, growth goes on: with the face over the same edge, or else from the first that reaches it.
    void claimUppers() {
        std::map<uint32_t, bool> claimed;
        for (bool sameEdge : {true, false})
            for (const auto& [piece, face, other] : beyond_) {
                if (other == kNoFace || s_.faces[other].tier <= s_.faces[face].tier) continue;
                if (sameEdge && s_.faces[other].edge != s_.faces[face].edge) continue;
                const uint32_t upper = atomOf_.at(other);
                if (claimed[upper]) continue;
                claimed[upper] = true;
                t_.pieces[piece].upper = upper;
            }
    }

    void markPieces(RoofAtom& atom) const {
        for (uint32_t i = 0; i < atom.pieceCount; ++i) {
            const RoofPiece& piece = t_.pieces[atom.firstPiece + i];
            if (piece.upper != kNoIndex) atom.style |= kAtomGoesOn;
            if (piece.kind == uint32_t(JointKind::ridge) + 1) atom.style |= kAtomRidged;
        }
    }

    // Walls whose edge has no face above it (a flat roof hangs on one of its edges).
    void addBareWalls() {
        uint32_t edge = 0;
        for (const auto& ring : h_.rings)
            for (size_t i = 0; i < ring.size(); ++i, ++edge) {
                const bool roofed = std::any_of(groups_.begin(), groups_.end(), [&](const auto& g) {
                    return std::get<1>(g.first) == edge && std::get<0>(g.first) == 0;
                });
                const glm::vec2 p = ring[i], q = ring[(i + 1) % ring.size()];
                if (roofed || glm::length(q - p) < kLevel) continue;
                RoofAtom atom = newAtom(edge, 0);
                atom.kind = kWallOnly;
                setEave(atom, {p.x, h_.eaveHeight, -p.y}, glm::normalize(glm::vec3(q.x - p.x, 0, p.y - q.y)),
                        glm::length(q - p));
                t_.atoms.push_back(atom);
            }
    }

    struct Beyond {
        uint32_t piece, face, other;
    };
    RoofTables& t_;
    const RoofStructure& s_;
    const RoofHouse& h_;
    uint32_t number_;
    AtomOptions options_;
    std::map<std::tuple<uint32_t, uint32_t, uint32_t>, std::vector<uint32_t>> groups_;  // tier, edge, kind -> faces
    std::map<uint32_t, uint32_t> atomOf_;
    std::vector<Beyond> beyond_;
};

}  // namespace

namespace {

RoofPlot plotOf(const RoofHouse& house) {
    return {{float(house.origin.x), float(-house.origin.y)}, 0, 0};
}

}  // namespace

RoofTables makeAtoms(const RoofStructure& structure, const AtomOptions& options) {
    RoofTables tables;
    for (uint32_t i = 0; i < structure.houses.size(); ++i) {
        tables.houses.push_back(HouseAtoms(tables, structure, i, i, options).run());
        tables.plots.push_back(plotOf(structure.houses[i]));
    }
    return tables;
}

void replaceAtoms(RoofTables& tables, uint32_t index, const RoofStructure& structure, const AtomOptions& options) {
    const bool hidden = tables.houses[index].hidden;
    tables.houses[index] = HouseAtoms(tables, structure, 0, index, options).run();
    tables.houses[index].hidden = hidden;
    tables.plots[index] = plotOf(structure.houses[0]);
}

void appendStarts(const RoofTables& tables, uint32_t house, std::vector<uint32_t>& atoms) {
    const RoofTables::House& range = tables.houses[house];
    if (range.hidden) return;
    for (uint32_t i = range.firstAtom; i < range.firstAtom + range.atomCount; ++i)
        if (tables.atoms[i].tier == 0 && tables.atoms[i].eaveLength > 0) atoms.push_back(i);
}

}  // namespace espalier
