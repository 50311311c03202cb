// Which sets stand: pieces that meet, rounds of decisions, and what is derived next (Li 2011 §4.4).
#ifndef ESPALIER_SHARED_PATTERN_DECIDE_H
#define ESPALIER_SHARED_PATTERN_DECIDE_H
#include "shaders/shared/pattern_derive.h"

ESPALIER_BEGIN

// Whether the segment from p to q goes through the triangle's inside.
FN bool segmentMeets(vec3 p, vec3 q, vec3 a, vec3 b, vec3 c) {
    vec3 n = cross3(b - a, c - a);
    float dp = dot3(n, p - a);
    float dq = dot3(n, q - a);
    if (!((dp > 0.0f && dq < 0.0f) || (dp < 0.0f && dq > 0.0f))) return false;
    vec3 d = q - p;
    float u = dot3(d, cross3(a - p, b - p));
    float v = dot3(d, cross3(b - p, c - p));
    float w = dot3(d, cross3(c - p, a - p));
    return (u > 0.0f && v > 0.0f && w > 0.0f) || (u < 0.0f && v < 0.0f && w < 0.0f);
}
FN bool trianglesMeet(vec3 a, vec3 b, vec3 c, vec3 d, vec3 e, vec3 f) {
    return segmentMeets(a, b, d, e, f) || segmentMeets(b, c, d, e, f) || segmentMeets(c, a, d, e, f) ||
           segmentMeets(d, e, a, b, c) || segmentMeets(e, f, a, b, c) || segmentMeets(f, d, a, b, c);
}

FN uint fewer(uint a, uint b) { return a < b ? a : b; }
FN vec3 placedPoint(PatternPiece p, vec3 v) { return p.position + p.x * v.x + p.y * v.y + p.z * v.z; }

// A place or direction of the world as a piece has it in its own space.
FN vec3 inPiece(PatternPiece p, vec3 v) {
    return vec3(divExact(dot3(v, p.x), dot3(p.x, p.x)), divExact(dot3(v, p.y), dot3(p.y, p.y)),
                divExact(dot3(v, p.z), dot3(p.z, p.z)));
}
// From one piece's space to another's, in which lengths are at most `scale` times as long.
struct PieceToPiece {
    vec3 x, y, z;
    vec3 origin;
    float scale;
};
FN PieceToPiece pieceToPiece(PatternPiece from, PatternPiece to) {
    PieceToPiece m = {};
    m.x = inPiece(to, from.x);
    m.y = inPiece(to, from.y);
    m.z = inPiece(to, from.z);
    m.origin = inPiece(to, from.position - to.position);
    float longest = larger(larger(dot3(from.x, from.x), dot3(from.y, from.y)), dot3(from.z, from.z));
    float shortest = smaller(smaller(dot3(to.x, to.x), dot3(to.y, to.y)), dot3(to.z, to.z));
    m.scale = sqrtExact(divExact(longest, shortest)) * 1.0001f;
    return m;
}
FN vec3 carriedPoint(IN(PieceToPiece) m, vec3 v) { return m.origin + m.x * v.x + m.y * v.y + m.z * v.z; }

// Whether three points lie on one side of the plane through `a` with normal n, or in it.
FN bool liesAside(vec3 n, vec3 a, vec3 p, vec3 q, vec3 r) {
    float x = dot3(n, p - a);
    float y = dot3(n, q - a);
    float z = dot3(n, r - a);
    return (x >= 0.0f && y >= 0.0f && z >= 0.0f) || (x <= 0.0f && y <= 0.0f && z <= 0.0f);
}

// The square of the distance from a place to the box around three points.
FN float outsideOf(float at, float a, float b, float c) {
    return larger(larger(smaller(smaller(a, b), c) - at, at - larger(larger(a, b), c)), 0.0f);
}
FN float boxDistance2nd(vec3 at, vec3 a, vec3 b, vec3 c) {
    vec3 off = vec3(outsideOf(at.x, a.x, b.x, c.x), outsideOf(at.y, a.y, b.y, c.y), outsideOf(at.z, a.z, b.z, c.z));
    return dot3(off, off);
}

// Of triangle d, e, f against run i of mesh m, which lies within the sphere, all in the mesh's space.
FN bool triangleMeets(PatternEnv env, uint m, uint i, vec4 sphere, vec3 d, vec3 e, vec3 f) {
    vec3 middle = vec3(sphere.x, sphere.y, sphere.z);
    vec3 normal = cross3(e - d, f - d);
    float off = dot3(normal, middle - d);
    if (off * off > sphere.w * sphere.w * dot3(normal, normal) || boxDistance2nd(middle, d, e, f) > sphere.w * sphere.w)
        return false;
    uint end = fewer(env.meshes.v[m].triangleCount, (i + 1u) * kClusterTriangles);
    bool meet = false;
    for (uint s = i * kClusterTriangles; s < end && !meet; ++s) {
        uint at = env.meshes.v[m].firstVertex + 3u * s;
        vec3 a = env.corners.v[at];
        vec3 b = env.corners.v[at + 1u];
        vec3 c = env.corners.v[at + 2u];
        if (liesAside(normal, d, a, b, c) || liesAside(cross3(b - a, c - a), a, d, e, f)) continue;
        meet = trianglesMeet(a, b, c, d, e, f);
    }
    return meet;
}

// Run j of mesh n, carried into the space of mesh m, against run i of that.
FN bool clustersMeet(PatternEnv env, uint m, uint i, vec4 sphere, uint n, uint j, IN(PieceToPiece) carry) {
    uint end = fewer(env.meshes.v[n].triangleCount, (j + 1u) * kClusterTriangles);
    bool meet = false;
    for (uint t = j * kClusterTriangles; t < end && !meet; ++t) {
        uint at = env.meshes.v[n].firstVertex + 3u * t;
        vec3 d = carriedPoint(carry, env.corners.v[at]);
        vec3 e = carriedPoint(carry, env.corners.v[at + 1u]);
        vec3 f = carriedPoint(carry, env.corners.v[at + 2u]);
        meet = triangleMeets(env, m, i, sphere, d, e, f);
    }
    return meet;
}
FN bool spheresMeet(vec4 a, vec4 b) {
    vec3 off = vec3(a.x - b.x, a.y - b.y, a.z - b.z);
    float reach = a.w + b.w;
    return dot3(off, off) <= reach * reach;
}
// Whether triangles of piece q, whose mesh is n, run through those of mesh m.
FN bool surfacesMeet(PatternEnv env, uint m, uint n, IN(PieceToPiece) carry) {
    vec3 middle = env.meshes.v[m].centre;
    vec4 all = vec4(middle.x, middle.y, middle.z, env.meshes.v[m].radius);
    bool meet = false;
    for (uint j = 0u; j < env.meshes.v[n].clusterCount && !meet; ++j) {
        vec4 l = env.clusters.v[env.meshes.v[n].firstCluster + j];
        vec3 c = carriedPoint(carry, vec3(l.x, l.y, l.z));
        vec4 run = vec4(c.x, c.y, c.z, l.w * carry.scale);
        if (!spheresMeet(run, all)) continue;
        for (uint i = 0u; i < env.meshes.v[m].clusterCount && !meet; ++i) {
            vec4 k = env.clusters.v[env.meshes.v[m].firstCluster + i];
            if (spheresMeet(run, k)) meet = clustersMeet(env, m, i, k, n, j, carry);
        }
    }
    return meet;
}

// Whether a point of the world is inside of a piece: a ray from it leaves through an odd number of triangles.
FN bool isWithin(PatternEnv env, PatternPiece p, uint m, vec3 point) {
    vec3 o = inPiece(p, point - p.position);
    vec3 away = o - env.meshes.v[m].centre;
    float radius = env.meshes.v[m].radius;
    if (!(env.meshes.v[m].inner > 0.0f) || dot3(away, away) > radius * radius) return false;
    vec3 d = vec3(0.5377f, 0.7311f, 0.4197f);
    bool odd = false;
    uint first = env.meshes.v[m].firstVertex;
    uint count = env.meshes.v[m].triangleCount;
    for (uint t = 0u; t < count; ++t) {
        vec3 a = env.corners.v[first + 3u * t] - o;
        vec3 b = env.corners.v[first + 3u * t + 1u] - o;
        vec3 c = env.corners.v[first + 3u * t + 2u] - o;
        float u = dot3(d, cross3(a, b));
        float v = dot3(d, cross3(b, c));
        float w = dot3(d, cross3(c, a));
        bool right = u > 0.0f && v > 0.0f && w > 0.0f;
        bool left = u < 0.0f && v < 0.0f && w < 0.0f;
        vec3 n = cross3(b - a, c - a);
        bool ahead = (dot3(n, a) > 0.0f) == (dot3(n, d) > 0.0f);
        odd = (right || left) && ahead ? !odd : odd;
    }
    return odd;
}

// How far a piece reaches in a direction.
FN float reachOf(PatternEnv env, PatternPiece p, vec3 direction) {
    uint m = p.mesh & 0xFFFFu;
    vec3 d = vec3(dot3(direction, p.x), dot3(direction, p.y), dot3(direction, p.z));
    uint first = env.meshes.v[m].firstVertex + 3u * env.meshes.v[m].triangleCount;
    uint end = first + env.meshes.v[m].placeCount;
    float most = -1e30f;
    for (uint i = first; i < end; ++i) most = larger(most, dot3(d, env.corners.v[i]));
    return most + dot3(direction, p.position);
}
// Whether a plane across the line between their middles has the pieces on its two sides, as most neighbours.
FN bool standApart(PatternEnv env, PatternPiece p, PatternPiece q, vec3 fromPToQ) {
    return reachOf(env, p, fromPToQ) < -reachOf(env, q, -fromPToQ);
}

// Whether two pieces run through each other, or one is within the other.
FN bool piecesMeet(PatternEnv env, PatternPiece p, PatternPiece q) {
    uint m = p.mesh & 0xFFFFu;
    uint n = q.mesh & 0xFFFFu;
    vec4 sphere = sphereOf(env, q);
    vec4 spherePs = sphereOf(env, p);
    if (standApart(env, p, q, vec3(sphere.x - spherePs.x, sphere.y - spherePs.y, sphere.z - spherePs.z))) return false;
    bool meet = surfacesMeet(env, m, n, pieceToPiece(q, p));
    if (!meet) meet = isWithin(env, q, n, placedPoint(p, env.meshes.v[m].within)) || isWithin(env, p, m, placedPoint(q, env.meshes.v[n].within));
    return meet;
}

// Pair k of the wave: where its pieces meet, the later one's set falls, or waits for the earlier one's.
FN void meetPair(PatternEnv env, uint k) {
    PatternPair pair = env.pairs.v[k];
    uint own = env.pieces.v[pair.piece].set;
    uint set = env.pieces.v[pair.other].set;
    // One that stands is enough.
    if (loadShared(env.sets.v[own].state) != kSetOpen) return;
    uint layer = layerOf(env.pieces.v[pair.piece].mesh);
    float at = 0.0f;
    float there = 0.0f;
    bool meet = false;
    if (layer == 0u) {
        meet = piecesMeet(env, env.pieces.v[pair.other], env.pieces.v[pair.piece]);
    } else if (layer == 1u) {
        meet = segmentsCross(env.pieces.v[pair.piece], env.pieces.v[pair.other], at, there);
    } else {
        meet = isLike(env.pieces.v[pair.piece], env.pieces.v[pair.other], env.sets.v[own].reach, env.sets.v[own].turn, there);
    }
    if (!meet) return;
    if (layer == 0u && set < env.status.v[0].firstSet) {
        settle(env, own, kSetFallen);
        return;
    }
    uint edge = atomicAdd(env.status.v[0].edges, 1u);
    if (edge < env.status.v[0].edgeRoom) {
        env.edges.v[edge].set = set;
        env.edges.v[edge].at = at;
        env.edges.v[edge].there = there;
        env.edges.v[edge].next = atomicExchange(env.sets.v[own].met, edge);
    }
}

// Whether piece `other` may be met by `own`'s set, whose spheres overlap: not by one of its own set, nor by one that comes
// after it in the order.
FN bool countsAgainst(PatternEnv env, uint own, vec4 sphere, uint set, vec4 s) {
    vec3 off = vec3(s.x, s.y, s.z) - vec3(sphere.x, sphere.y, sphere.z);
    float reach = s.w + sphere.w;
    if (set == own || dot3(off, off) > reach * reach) return false;
    return set < env.status.v[0].firstSet || comesBefore(env.sets.v[set], env.sets.v[own]);
}

FN void addPair(PatternEnv env, uint piece, uint other) {
    uint at = atomicAdd(env.status.v[0].pairs, 1u);
    if (at >= env.status.v[0].pairRoom) {
        atomicMax(env.status.v[0].mostPairs, at + 1u);
        return;
    }
    env.pairs.v[at].piece = piece;
    env.pairs.v[at].other = other;
    if (at % kPatternGroup == 0u) atomicMax(env.status.v[0].pairGroups[0], patternGroups(at + 1u));
}

// A ball inside of a piece; its radius is 0 where there is none.
FN vec4 ballWithin(PatternEnv env, PatternPiece p) {
    if (layerOf(p.mesh) != 0u) return vec4(0.0f);
    PatternMesh m = env.meshes.v[p.mesh & 0xFFFFu];
    vec3 c = placedPoint(p, m.within);
    float side2 = smaller(smaller(dot3(p.x, p.x), dot3(p.y, p.y)), dot3(p.z, p.z));
    return vec4(c.x, c.y, c.z, m.inner * sqrtExact(side2));
}
FN bool ballsMeet(vec4 a, vec4 b) {
    vec3 off = vec3(a.x - b.x, a.y - b.y, a.z - b.z);
    float reach = (a.w + b.w) * 0.999f;
    return a.w > 0.0f && b.w > 0.0f && dot3(off, off) < reach * reach;
}

// Piece i of the wave -> pairs with all that stands or may come to stand before it and that it may meet. Most tries run
// so deep into a piece that stands that balls inside of both say so, and need no pair.
FN void lookAround(PatternEnv env, uint i) {
    uint piece = env.status.v[0].firstPiece + i;
    uint own = env.pieces.v[piece].set;
    bool looks = (env.pieces.v[piece].mesh & kPieceFree) == 0u && loadShared(env.sets.v[own].state) == kSetOpen;
    uint layer = layerOf(env.pieces.v[piece].mesh);
    vec4 sphere = sphereOf(env, env.pieces.v[piece]);
    vec4 ball = ballWithin(env, env.pieces.v[piece]);
    bool fell = false;
    for (uint left = looks ? env.status.v[0].classes[layer] : 0u; left != 0u; left = left & (left - 1u)) {
        uint c = lowestBit(left);
        float side = cellSide(c);
        float reach = sphere.w + 0.5f * side;
        int x0 = cellIndex(sphere.x - reach, side);
        int y0 = cellIndex(sphere.y - reach, side);
        int z0 = cellIndex(sphere.z - reach, side);
        uint nx = uint(cellIndex(sphere.x + reach, side) - x0) + 1u;
        uint ny = uint(cellIndex(sphere.y + reach, side) - y0) + 1u;
        uint nz = uint(cellIndex(sphere.z + reach, side) - z0) + 1u;
        for (uint n = 0u; n < nx * ny * nz && !fell; ++n) {
            int x = x0 + int(n % nx);
            int y = y0 + int((n / nx) % ny);
            int z = z0 + int(n / (nx * ny));
            uint other = env.cells.v[cellAt3(env, layer, c, x, y, z)];
            // Cells share lists where their hashes agree: a piece is looked at from its own cell only.
            while (other != kNoIndex && !fell) {
                uint set = env.pieces.v[other].set;
                // Of ten pieces that have been tried, nine may have fallen.
                if (loadShared(env.sets.v[set].state) != kSetFallen) {
                    vec4 s = sphereOf(env, env.pieces.v[other]);
                    bool here = layerOf(env.pieces.v[other].mesh) == layer && classOf(s.w) == c && cellIndex(s.x, side) == x && cellIndex(s.y, side) == y &&
                                cellIndex(s.z, side) == z;
                    if (here && countsAgainst(env, own, sphere, set, s)) {
                        fell = set < env.status.v[0].firstSet && ballsMeet(ball, ballWithin(env, env.pieces.v[other]));
                        if (!fell) addPair(env, piece, other);
                    }
                }
                other = env.pieces.v[other].next;
            }
        }
    }
    if (fell) settle(env, own, kSetFallen);
}

// Whether that has come to pass which a part or a set waits for: kSetStands: yes; kSetFallen: it won't; kSetOpen: this
// isn't known yet. A set that stands has all that it waited for itself; one that has fallen may have been culled.
FN uint fateOf(PatternEnv env, uint waitsFor) {
    uint fate = kSetStands;
    while (waitsFor != kNoIndex && fate == kSetStands) {
        uint set = waitsFor & ~kIfFallen;
        bool ifFallen = (waitsFor & kIfFallen) != 0u;
        uint state = loadShared(env.sets.v[set].state);
        fate = state == kSetOpen ? kSetOpen : (state != kSetStands) == ifFallen ? kSetStands : kSetFallen;
        waitsFor = ifFallen ? env.sets.v[set].prereq : kNoIndex;
    }
    return fate;
}

// One round for set i of the wave: its fate, if those that it hangs on have theirs.
FN void decideSet(PatternEnv env, uint i) {
    uint at = env.status.v[0].firstSet + i;
    if (loadShared(env.sets.v[at].state) != kSetOpen) return;
    uint before = fateOf(env, env.sets.v[at].prereq);
    if (before == kSetOpen) return;
    // What is cut or merges asks all, for the nearest; else one that stands is enough.
    bool merges = env.sets.v[at].reach > 0.0f;
    uint kept = before;
    uint into = kNoIndex;
    float there = 0.0f;
    bool waits = false;
    for (uint e = env.sets.v[at].met; e != kNoIndex && (merges ? before == kSetStands : kept != kSetFallen);
         e = env.edges.v[e].next) {
        PatternEdge edge = env.edges.v[e];
        uint state = loadShared(env.sets.v[edge.set].state);
        waits = waits || state == kSetOpen;
        if (state == kSetOpen || state == kSetFallen || edge.there > uintBitsToFloat(state)) continue;
        uint left = floatBitsToUint(edge.at);
        bool first = left < kept;
        if (left == kept && into != kNoIndex)
            first = edge.there < there || (edge.there == there && comesBefore(env.sets.v[edge.set], env.sets.v[into]));
        into = first ? edge.set : into;
        there = first ? edge.there : there;
        kept = first ? left : kept;
    }
    if (waits && (merges || kept != kSetFallen)) return;
    env.sets.v[at].into = into;
    settle(env, at, kept);
}

FN bool waveDecided(PatternEnv env) { return env.status.v[0].decided == env.status.v[0].sets - env.status.v[0].firstSet; }
FN bool foundRoom(PatternEnv env) {
    return foundSetRoom(env) && env.status.v[0].edges <= env.status.v[0].edgeRoom && env.status.v[0].mostPairs == 0u && env.status.v[0].mostItems <= env.status.v[0].itemRoom;
}

// Shape i of the wave, once all sets have their fate: what its production makes that goes on.
FN void goOn(PatternEnv env, uint i) {
    PatternShape shape = env.shapes.v[i];
    if (shape.rule == kNoIndex) return;
    RuleRecord rule = env.grammars.v[shape.grammar].rules.v[shape.rule];
    uint standing = 0u;
    uint sets = rule.extrude & 0xFFFFu;
    for (uint s = 0u; s < sets; ++s) standing += env.sets.v[shape.firstSet + s].state != kSetFallen ? 1u : 0u;
    atomicAdd(env.status.v[0].shapes, 1u);
    if (standing > 0u) atomicAdd(env.status.v[0].standing, standing);
    if (sets > standing) atomicAdd(env.status.v[0].fallen, sets - standing);
    bool deep = shape.depth >= env.status.v[0].mostDepth;
    if (deep && rule.successorCount > sets) atomicAdd(env.status.v[0].deep, 1u);
    for (uint k = 0u; k < rule.successorCount && !deep; ++k) {
        uint at = rule.firstSuccessor + k;
        if (env.grammars.v[shape.grammar].parts.v[at].kind != kPartSymbol) continue;
        uint prereq = env.grammars.v[shape.grammar].parts.v[at].prereq;
        if (fateOf(env, setWaitedFor(shape.firstSet, prereq)) != kSetStands) continue;
        uint priority = env.grammars.v[shape.grammar].parts.v[at].priority;
        uint slot = atomicAdd(env.status.v[0].waiting[priority], 1u);
        if (slot >= env.status.v[0].itemRoom) {
            atomicMax(env.status.v[0].mostItems, slot + 1u);
            continue;
        }
        PatternItem item = {};
        item.key = shape.key;
        item.scope = shape.scope;
        for (uint a = 0u; a < 4u; ++a) item.args[a] = shape.args[a];
        item.grammar = shape.grammar;
        item.part = at;
        item.symbol = 0u;
        item.depth = shape.depth + 1u;
        item.seed = shape.seed;
        env.items.v[priority * env.status.v[0].itemRoom + slot] = item;
    }
}

// Between waves, by one invocation: takes the symbols of the highest priority, unless the wave before isn't decided yet,
// or something has found no room.
FN void beginWave(PatternEnv env) {
    bool room = foundRoom(env);
    bool goes = room && waveDecided(env);
    uint count = 0u;
    uint priority = 0u;
    for (uint p = 0u; p < kPatternPriorities && goes; ++p) {
        uint waits = env.status.v[0].waiting[p];
        priority = waits > 0u ? p : priority;
        count = waits > 0u ? waits : count;
    }
    env.status.v[0].deriveGroups[0] = 0u;
    env.status.v[0].pieceGroups[0] = 0u;
    env.status.v[0].pairGroups[0] = 0u;
    env.status.v[0].pairs = 0u;
    if (!goes) {   // only sets are looked at once more
        env.status.v[0].setGroups[0] = room ? env.status.v[0].setGroups[0] : 0u;
        return;
    }
    uint groups = patternGroups(count);
    env.status.v[0].deriveGroups[0] = groups;
    env.status.v[0].shapeGroups[0] = groups;
    env.status.v[0].wave = count;
    env.status.v[0].setGroups[0] = 0u;
    env.status.v[0].firstSet = env.status.v[0].sets;
    env.status.v[0].firstPiece = env.status.v[0].pieces;
    env.status.v[0].decided = 0u;
    env.status.v[0].priority = priority;
    if (count > 0u) {
        env.status.v[0].waiting[priority] = 0u;
        env.status.v[0].waves += 1u;
    }
}

// What a piece that stands adds to the hash: its key, its mesh and its place, to the bit.
FN uvec2 hashOfPiece(PatternEnv env, uint i) {
    PatternPiece p = env.pieces.v[i];
    uint state = env.sets.v[p.set].state;
    if (state == kSetFallen) return uvec2(0u);
    uvec2 h = hashWord(hashWord(hashKey(env.sets.v[p.set].key), env.sets.v[p.set].number), state);
    h = hashVec3(hashVec3(hashVec3(hashVec3(hashWord(h, p.mesh), p.x), p.y), p.z), p.position);
    return hashWord(h, p.colour);
}

ESPALIER_END
#endif
