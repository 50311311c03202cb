// In: a level's arrays, or its bytes. Out: the other. A level is cut into bands of 64 rows, each a zstd frame by
// itself, so that all cores take part; lists of crossings are one more. A band holds, for each texel, a byte that tells
// class and where its triangle comes from; then planes of what prediction left over, of texels that aren't empty; then
// what could not be predicted.
//
//   byte  7 raw: all 24 bytes follow | 6 position follows | 5..3 triangle's source | 2 crease | 1..0 class
#include "runtime/surface/codec.hpp"

#include <meshoptimizer.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "runtime/core/jobs.hpp"

namespace espalier::surface_file {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint32_t kBandRows = 64;
constexpr int kEffort = 9;  // zstd's level
constexpr uint8_t kRaw = 128, kPlaced = 64;
// Whose triangle a texel's is: a neighbour's, or one that is named.
enum Whose : uint32_t { kFromLeft, kFromAbove, kFromAboveLeft, kFromAboveRight, kNamed };
constexpr size_t kPlanes = 7;  // clearance, curvature, normal's x and y by bytes, crossings

Bytes pack(const Bytes& plain) {
    Bytes out(ZSTD_compressBound(plain.size()));
    out.resize(ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), kEffort));
    return out;
}

// Empty where the bytes aren't a frame of at most `most` bytes.
std::optional<Bytes> unpack(std::span<const std::byte> packed, size_t most) {
    const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
    if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > most) return std::nullopt;
    Bytes out(static_cast<size_t>(size));
    if (ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size()) != out.size()) return std::nullopt;
    return out;
}

void putVarint(Bytes& to, int64_t value) {
    uint64_t rest = uint64_t(value) << 1 ^ uint64_t(value >> 63);
    for (; rest >= 128; rest >>= 7) to.push_back(uint8_t(rest | 128));
    to.push_back(uint8_t(rest));
}

template <class T>
void putRaw(Bytes& to, const T& value) {
    const auto* from = reinterpret_cast<const uint8_t*>(&value);
    to.insert(to.end(), from, from + sizeof value);
}

// Reads what the two above wrote; past the end it reads zeros and says so.
struct Source {
    const uint8_t *at, *end;
    bool broken = false;

    int64_t varint() {
        uint64_t value = 0;
        for (int shift = 0; shift < 64; shift += 7) {
            if (at == end) return broken = true, 0;
            const uint8_t byte = *at++;
            value |= uint64_t(byte & 127) << shift;
            if (byte < 128) break;
        }
        return int64_t(value >> 1) ^ -int64_t(value & 1);
    }
    template <class T>
    T raw() {
        T value{};
        if (size_t(end - at) < sizeof value) return broken = true, value;
        std::memcpy(&value, at, sizeof value);
        at += sizeof value;
        return value;
    }
};

// What texels after this one are predicted from.
struct Known {
    uint32_t triangle = kNoIndex;
    int32_t values[4] = {};  // clearance, curvature, the normal's x and y
};

Known knownOf(const Texel& texel, const TexelAux& aux) {
    return {aux.triangle,
            {int32_t(texelClearance(texel.bits)), int32_t(texel.bits >> 24), int32_t(aux.normal & 0xFFFFu),
             int32_t(aux.normal >> 16)}};
}

// The neighbours of a texel; what lies outside of the band is empty.
struct Around {
    const Known &left, &above, &aboveLeft, &aboveRight;

    // Follows an edge that runs through, else carries the slope on (LOCO-I's predictor).
    int32_t predict(int k) const {
        const int32_t w = left.values[k], n = above.values[k], nw = aboveLeft.values[k];
        if (nw >= std::max(w, n)) return std::min(w, n);
        if (nw <= std::min(w, n)) return std::max(w, n);
        return w + n - nw;
    }
    uint32_t nearest() const { return left.triangle != kNoIndex ? left.triangle : above.triangle; }
    uint32_t triangle(uint32_t source) const {
        return source == kFromLeft        ? left.triangle
               : source == kFromAbove     ? above.triangle
               : source == kFromAboveLeft ? aboveLeft.triangle
                                          : aboveRight.triangle;
    }
};

// One band's texels row by row: calls body(index of the record, uv, neighbours) and keeps what it returns.
template <class Body>
void walkBand(uint32_t size, uint32_t firstRow, uint32_t rows, Body&& body) {
    std::vector<Known> above(size + 2), row(size + 2);  // one more on either side
    for (uint32_t y = firstRow; y < firstRow + rows; ++y) {
        for (uint32_t x = 0; x < size; ++x) {
            const Around around{row[x], above[x + 1], above[x], above[x + 2]};
            const glm::vec2 uv((float(x) + 0.5f) / float(size), (float(y) + 0.5f) / float(size));
            row[x + 1] = body(texelIndex(size, x, y), uv, around);
        }
        std::swap(above, row);
        row[0] = Known{};
    }
}

uint16_t folded(int32_t difference) {
    const int16_t d = int16_t(difference);
    return uint16_t(uint16_t(d) << 1 ^ uint16_t(d >> 15));
}
int32_t unfolded(uint32_t value) {
    return int32_t(value >> 1) ^ -int32_t(value & 1);
}

bool isDefault(const Texel& texel, const TexelAux& aux, uint32_t crossings) {
    static const Texel kEmpty{glm::vec3(0), 0};
    return std::memcmp(&texel, &kEmpty, sizeof texel) == 0 && aux.normal == 0 && aux.triangle == kNoIndex &&
           crossings == 0;
}

Bytes encodeBand(const SurfaceLevelData& level, std::span<const TrianglePlane> triangles, uint32_t firstRow,
                 uint32_t rows) {
    Bytes kinds, planes[kPlanes], named, raw;
    walkBand(level.size, firstRow, rows, [&](size_t at, glm::vec2 uv, const Around& around) -> Known {
        const Texel& texel = level.texels[at];
        const TexelAux& aux = level.aux[at];
        const uint32_t crossings = level.crossingHead[at] & 255u;
        if (isDefault(texel, aux, crossings)) {
            kinds.push_back(0);
            return {};
        }
        planes[6].push_back(uint8_t(crossings));
        const Known now = knownOf(texel, aux);
        if (texelClass(texel.bits) == kTexelEmpty || aux.triangle >= triangles.size() ||
            triangles[aux.triangle].chart != texelChart(texel.bits)) {
            kinds.push_back(kRaw);
            putRaw(raw, texel);
            putRaw(raw, aux);
            return now;
        }
        uint32_t source = kFromLeft;
        while (source < kNamed && around.triangle(source) != aux.triangle) ++source;
        if (source == kNamed) putVarint(named, int64_t(aux.triangle) - int64_t(around.nearest()));
        const glm::vec3 place = placeOn(triangles[aux.triangle], uv);
        const bool placed = std::memcmp(&place, &texel.position, sizeof place) != 0;
        if (placed) putRaw(raw, texel.position);
        kinds.push_back(uint8_t((placed ? kPlaced : 0) | source << 3 | (texel.bits >> 16 & 7u)));
        planes[0].push_back(uint8_t(now.values[0] - around.predict(0)) & 31);
        planes[1].push_back(uint8_t(now.values[1] - around.predict(1)));
        for (int k = 0; k < 2; ++k) {
            const uint16_t left = folded(now.values[2 + k] - around.predict(2 + k));
            planes[2 + k * 2].push_back(uint8_t(left));
            planes[3 + k * 2].push_back(uint8_t(left >> 8));
        }
        return now;
    });
    Bytes plain;
    const auto add = [&](const Bytes& part) {
        putRaw(plain, uint32_t(part.size()));
        plain.insert(plain.end(), part.begin(), part.end());
    };
    add(kinds);
    for (const Bytes& plane : planes) add(plane);
    add(named);
    add(raw);
    return pack(plain);
}

// Returns the number of crossings listed, or nothing where the band is damaged.
std::optional<uint64_t> decodeBand(std::span<const std::byte> packed, std::span<const TrianglePlane> triangles,
                                   uint32_t firstRow, uint32_t rows, SurfaceLevelData& level) {
    const size_t texels = size_t(rows) * level.size, most = texels * (1 + kPlanes + 10 + 24) + 64;
    const std::optional<Bytes> plain = unpack(packed, most);
    if (!plain) return std::nullopt;
    Source all{plain->data(), plain->data() + plain->size()};
    Source parts[kPlanes + 3];
    for (Source& part : parts) {
        const uint32_t length = all.raw<uint32_t>();
        if (all.broken || length > size_t(all.end - all.at)) return std::nullopt;
        part = {all.at, all.at + length};
        all.at += length;
    }
    Source &kinds = parts[0], *planes = parts + 1, &named = parts[kPlanes + 1], &raw = parts[kPlanes + 2];
    // Short planes are refused here, so that texels can be read without looking.
    size_t whole = 0, known = 0;
    for (const uint8_t* k = kinds.at; k < kinds.end; ++k) known += *k != 0, whole += *k != 0 && !(*k & kRaw);
    if (size_t(kinds.end - kinds.at) != texels || size_t(planes[6].end - planes[6].at) != known) return std::nullopt;
    for (int p = 0; p < 6; ++p)
        if (size_t(planes[p].end - planes[p].at) != whole) return std::nullopt;
    bool broken = false;
    uint64_t listed = 0;
    walkBand(level.size, firstRow, rows, [&](size_t at, glm::vec2 uv, const Around& around) -> Known {
        Texel& texel = level.texels[at];
        TexelAux& aux = level.aux[at];
        const uint8_t kind = *kinds.at++;
        if (kind == 0) {
            texel = {glm::vec3(0), 0};
            aux = {0, kNoIndex};
            level.crossingHead[at] = 0;
            return {};
        }
        level.crossingHead[at] = *planes[6].at++;
        listed += level.crossingHead[at];
        if (kind & kRaw) {
            texel = raw.raw<Texel>();
            aux = raw.raw<TexelAux>();
            return knownOf(texel, aux);
        }
        const uint32_t source = kind >> 3 & 7u;
        const uint32_t triangle =
            source < kNamed ? around.triangle(source) : around.nearest() + uint32_t(named.varint());
        if (triangle >= triangles.size()) {
            broken = true;
            return {};
        }
        const uint32_t clearance = uint32_t(around.predict(0) + *planes[0].at++) & 31u;
        const uint32_t curvature = uint32_t(around.predict(1) + *planes[1].at++) & 255u;
        uint32_t normal[2];
        for (int k = 0; k < 2; ++k) {
            const uint32_t left = uint32_t(*planes[2 + k * 2].at++) | uint32_t(*planes[3 + k * 2].at++) << 8;
            normal[k] = uint32_t(around.predict(2 + k) + unfolded(left)) & 0xFFFFu;
        }
        const TrianglePlane& plane = triangles[triangle];
        texel.position = kind & kPlaced ? raw.raw<glm::vec3>() : placeOn(plane, uv);
        texel.bits = packTexelBits(plane.chart & 0xFFFFu, kind & 3u, kind >> 2 & 1u, clearance, curvature);
        aux = {normal[0] | normal[1] << 16, triangle};
        return knownOf(texel, aux);
    });
    if (broken || named.broken || raw.broken) return std::nullopt;
    return listed;
}

// Heads follow from the counts: lists stand one after another in the order of texels.
bool headsFollow(const SurfaceLevelData& level) {
    uint64_t first = 0;
    for (uint32_t head : level.crossingHead) {
        if (head != 0 && (head & 255u) != 0 && head >> 8 == first)
            first += head & 255u;
        else if (head != 0)
            return false;
    }
    return first == level.crossingRefs.size();
}

void setHeads(SurfaceLevelData& level) {
    uint32_t first = 0;
    for (uint32_t& head : level.crossingHead) {
        const uint32_t count = head & 255u;
        head = count == 0 ? 0 : first << 8 | count;
        first += count;
    }
}

// Lists of crossings; before them the heads themselves, where they don't follow from the counts.
Bytes encodeLists(const SurfaceLevelData& level) {
    Bytes plain{uint8_t(headsFollow(level) ? 0 : 1)};
    if (plain[0])
        for (uint32_t head : level.crossingHead) putRaw(plain, head);
    int64_t before = 0;
    for (uint32_t ref : level.crossingRefs) putVarint(plain, int64_t(ref) - std::exchange(before, ref));
    return pack(plain);
}

bool decodeLists(std::span<const std::byte> packed, bool& follow, std::vector<uint32_t>& heads,
                 std::vector<uint32_t>& refs) {
    const std::optional<Bytes> plain = unpack(packed, 1 + heads.size() * 4 + refs.size() * 10);
    if (!plain || plain->empty()) return false;
    Source source{plain->data(), plain->data() + plain->size()};
    follow = source.raw<uint8_t>() == 0;
    if (!follow)
        for (uint32_t& head : heads) head = source.raw<uint32_t>();
    uint32_t ref = 0;
    for (uint32_t& out : refs) out = ref += uint32_t(source.varint());
    return !source.broken && source.at == source.end;
}

}  // namespace

std::optional<Bytes> encodeLevel(const SurfaceLevelData& level, std::span<const TrianglePlane> triangles) {
    const size_t texels = size_t(level.size) * level.size;
    if (level.size == 0 || level.size % 8 != 0 || level.texels.size() != texels || level.aux.size() != texels ||
        level.crossingHead.size() != texels)
        return std::nullopt;
    const uint32_t rows = std::min(kBandRows, level.size), bands = level.size / rows;
    std::vector<Bytes> frames(bands + 1);
    parallelFor(frames.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            frames[i] = i < bands ? encodeBand(level, triangles, uint32_t(i) * rows, rows) : encodeLists(level);
    });
    Bytes out;
    for (const Bytes& frame : frames) putRaw(out, uint32_t(frame.size()));
    for (const Bytes& frame : frames) out.insert(out.end(), frame.begin(), frame.end());
    return out;
}

std::string decodeLevel(std::span<const std::byte> bytes, std::span<const TrianglePlane> triangles, uint64_t refs,
                        SurfaceLevelData& level) {
    const size_t texels = size_t(level.size) * level.size;
    const uint32_t rows = std::min(kBandRows, level.size), bands = level.size / rows;
    std::vector<std::span<const std::byte>> frames(bands + 1);
    size_t at = frames.size() * 4;
    for (size_t i = 0; i < frames.size(); ++i) {
        uint32_t length = 0;
        if (bytes.size() < frames.size() * 4) return "too short for its bands";
        std::memcpy(&length, bytes.data() + i * 4, 4);
        if (length > bytes.size() - at) return "band " + std::to_string(i) + " reaches past the end";
        frames[i] = bytes.subspan(at, length);
        at += length;
        // Before there is room made for the texels.
        const unsigned long long states = ZSTD_getFrameContentSize(frames[i].data(), length);
        if (i < bands && (states >= ZSTD_CONTENTSIZE_ERROR || states < uint64_t(rows) * level.size))
            return "band " + std::to_string(i) + " is damaged";
    }
    level.texels.resize(texels);
    level.aux.resize(texels);
    level.crossingHead.resize(texels);
    level.crossingRefs.resize(refs);
    std::vector<uint32_t> heads(texels);
    bool follow = true;
    std::vector<std::optional<uint64_t>> listed(frames.size());
    parallelFor(frames.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            if (i < bands)
                listed[i] = decodeBand(frames[i], triangles, uint32_t(i) * rows, rows, level);
            else if (decodeLists(frames[i], follow, heads, level.crossingRefs))
                listed[i] = 0;
    });
    uint64_t sum = 0;
    for (size_t i = 0; i < listed.size(); ++i) {
        if (!listed[i]) return i < bands ? "band " + std::to_string(i) + " is damaged" : "its lists are damaged";
        sum += *listed[i];
    }
    if (!follow)
        level.crossingHead = std::move(heads);
    else if (sum != refs)
        return "lists of another length than its texels count";
    else
        setHeads(level);
    return {};
}

Bytes encodeRecords(const void* records, size_t count, size_t stride) {
    Bytes plain(meshopt_encodeVertexBufferBound(count, stride));
    plain.resize(meshopt_encodeVertexBuffer(plain.data(), plain.size(), records, count, stride));
    return pack(plain);
}

bool decodeRecords(std::span<const std::byte> bytes, void* records, size_t count, size_t stride) {
    const std::optional<Bytes> plain = unpack(bytes, meshopt_encodeVertexBufferBound(count, stride));
    return plain && meshopt_decodeVertexBuffer(records, count, stride, plain->data(), plain->size()) == 0;
}

}  // namespace espalier::surface_file
