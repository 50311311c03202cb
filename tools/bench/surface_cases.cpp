// surface/…: what a level costs in a file and how fast it is there again, beside meshoptimizer's lossless encoding of
// the arrays and beside zstd -3 of the raw ones; and the mesh by Draco, beside meshoptimizer's encodings.
#include <meshoptimizer.h>
#include <zstd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "runtime/core/jobs.hpp"
#include "runtime/surface/carry.hpp"
#include "runtime/surface/codec.hpp"
#include "tools/bake/bake.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {
namespace {

using surface_file::decodeLevel;
using surface_file::encodeLevel;
using Bytes = std::vector<uint8_t>;

// One array of a level as the other sides see it.
struct Array {
    const void* data;
    size_t count, stride;
    Bytes meshopt, zstd, out;
};

std::vector<Array> arraysOf(const SurfaceData& data) {
    std::vector<Array> arrays;
    for (const SurfaceLevelData& level : data.levels) {
        arrays.push_back({level.texels.data(), level.texels.size(), sizeof(Texel), {}, {}, {}});
        arrays.push_back({level.aux.data(), level.aux.size(), sizeof(TexelAux), {}, {}, {}});
        arrays.push_back({level.crossingHead.data(), level.crossingHead.size(), 4, {}, {}, {}});
        if (!level.crossingRefs.empty())
            arrays.push_back({level.crossingRefs.data(), level.crossingRefs.size(), 4, {}, {}, {}});
    }
    for (Array& a : arrays) {
        a.meshopt.resize(meshopt_encodeVertexBufferBound(a.count, a.stride));
        a.meshopt.resize(meshopt_encodeVertexBuffer(a.meshopt.data(), a.meshopt.size(), a.data, a.count, a.stride));
        a.zstd.resize(ZSTD_compressBound(a.count * a.stride));
        a.zstd.resize(ZSTD_compress(a.zstd.data(), a.zstd.size(), a.data, a.count * a.stride, 3));
        a.out.resize(a.count * a.stride);
    }
    return arrays;
}

template <class Work>
void each(std::vector<Array>& arrays, Work&& work) {
    parallelFor(arrays.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) work(arrays[i]);
    });
}

void levelCase(Bench& bench, const std::string& name, const SurfaceData& data) {
    std::vector<Array> arrays = arraysOf(data);
    double raw = 0, texels = 0, meshopt = 0, zstd = 0, ours = 0;
    for (const Array& a : arrays)
        raw += double(a.count * a.stride), meshopt += double(a.meshopt.size()), zstd += double(a.zstd.size());
    std::vector<Bytes> levels;
    for (const SurfaceLevelData& level : data.levels) {
        levels.push_back(*encodeLevel(level, data.triangles));
        ours += double(levels.back().size());
        texels += double(level.texels.size());
    }
    std::vector<SurfaceLevelData> out(levels.size());
    auto decode = [&] {
        for (size_t i = 0; i < levels.size(); ++i) {
            out[i].size = data.levels[i].size;
            decodeLevel(std::as_bytes(std::span(levels[i])), data.triangles, data.levels[i].crossingRefs.size(),
                        out[i]);
        }
    };
    const Pair byMeshopt = medianSeconds(bench.options().repeats, decode, [&] {
        each(arrays, [](Array& a) {
            meshopt_decodeVertexBuffer(a.out.data(), a.count, a.stride, a.meshopt.data(), a.meshopt.size());
        });
    });
    const Pair byZstd = medianSeconds(bench.options().repeats, decode, [&] {
        each(arrays, [](Array& a) { ZSTD_decompress(a.out.data(), a.out.size(), a.zstd.data(), a.zstd.size()); });
    });
    char figure[64];
    std::snprintf(figure, sizeof figure, "all levels, %.1f bytes a texel raw", raw / texels);
    bench.add({name + "/bytes", figure, "B/texel", ours / texels, "meshoptimizer, lossless", meshopt / texels});
    bench.add({name + "/bytes-zstd", figure, "B/texel", ours / texels, "zstd -3 of the raw arrays", zstd / texels});
    bench.add({name + "/decode", "decoded", "GB/s", raw * 1e-9 / byMeshopt.a, "meshoptimizer, lossless",
               raw * 1e-9 / byMeshopt.b});
    bench.add({name + "/decode-zstd", "decoded", "GB/s", raw * 1e-9 / byZstd.a, "zstd -3 of the raw arrays",
               raw * 1e-9 / byZstd.b});
}

// The mesh as meshoptimizer would hold it at the same precision: 20 bytes a vertex before encoding.
size_t meshoptBytes(const SurfaceData& data) {
    struct Packed {
        uint16_t position[4], normal[2], uv[2], walkUv[2];
    };
    std::vector<uint32_t> indices(data.indices.size());
    meshopt_optimizeVertexCache(indices.data(), data.indices.data(), indices.size(), data.vertices.size());
    std::vector<DrawVertex> vertices(data.vertices.size());
    vertices.resize(meshopt_optimizeVertexFetch(vertices.data(), indices.data(), indices.size(), data.vertices.data(),
                                                data.vertices.size(), sizeof(DrawVertex)));
    glm::vec2 uvLow(1e9f), uvHigh(-1e9f);
    for (const DrawVertex& v : vertices) uvLow = glm::min(uvLow, v.uv), uvHigh = glm::max(uvHigh, v.uv);
    std::vector<Packed> packed;
    const glm::vec3 size = data.boundsMax - data.boundsMin;
    const float extent = std::max({size.x, size.y, size.z});
    for (const DrawVertex& v : vertices) {
        Packed p{};
        for (int k = 0; k < 3; ++k) p.position[k] = uint16_t((v.position[k] - data.boundsMin[k]) / extent * 65535);
        const glm::vec3 n = v.normal / (std::abs(v.normal.x) + std::abs(v.normal.y) + std::abs(v.normal.z));
        const glm::vec2 folded =
            n.z >= 0 ? glm::vec2(n)
                     : (1.0f - glm::abs(glm::vec2(n.y, n.x))) * glm::vec2(n.x < 0 ? -1 : 1, n.y < 0 ? -1 : 1);
        for (int k = 0; k < 2; ++k) {
            p.normal[k] = uint16_t((folded[k] * 0.5f + 0.5f) * 4095);
            p.uv[k] = uint16_t((v.uv[k] - uvLow[k]) / std::max(uvHigh[k] - uvLow[k], 1e-9f) * 65535);
            p.walkUv[k] = uint16_t(v.walkUv[k] * 65535);
        }
        packed.push_back(p);
    }
    Bytes v(meshopt_encodeVertexBufferBound(packed.size(), sizeof(Packed)));
    v.resize(meshopt_encodeVertexBuffer(v.data(), v.size(), packed.data(), packed.size(), sizeof(Packed)));
    Bytes i(meshopt_encodeIndexBufferBound(indices.size(), packed.size()));
    i.resize(meshopt_encodeIndexBuffer(i.data(), i.size(), indices.data(), indices.size()));
    return v.size() + i.size();
}

// What the mesh takes in a file that was written.
size_t dracoBytes(const std::string& path) {
    auto file = readFile(path);
    if (!file || file->size() < 20) return 0;
    uint32_t text;
    std::memcpy(&text, file->data() + 12, 4);
    const char* begin = reinterpret_cast<const char*>(file->data()) + 20;
    const auto root = nlohmann::json::parse(begin, begin + text);
    size_t sum = 0;
    for (const auto& primitive : root["meshes"][0]["primitives"]) {
        const size_t view = primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"];
        sum += root["bufferViews"][view]["byteLength"].get<size_t>();
    }
    return sum;
}

// A layer to the ruin's next bake, whose atlas has another size.
void carryCase(Bench& bench) {
    const char* name = "surface/carry";
    if (!bench.wants(name)) return;
    Result<Model> model = importModel(bench.options().contentFolder + "/ruin.glb");
    if (!model) return bench.skip(name, model.failure().text());
    BakeOptions smaller;
    smaller.resolution = 512;
    Result<Baked> earlier = bake(*model, smaller), later = bake(*model, {});
    if (!earlier || !later) return bench.skip(name, (earlier ? later : earlier).failure().text());
    const uint32_t side = earlier->surface.levels[0].size;
    const UvPicture layer{side, side, std::vector<float>(size_t(side) * side, 1.0f)};
    std::vector<double> carried, baked;
    for (int i = 0; i < bench.options().repeats; ++i) {
        carried.push_back(seconds([&] { (void)SurfaceMatch(earlier->surface, later->surface).carry(layer); }));
        baked.push_back(seconds([&] { (void)bake(*model, {}); }));
    }
    char figure[96];
    std::snprintf(figure, sizeof figure, "a layer of %u texels a side to a bake of %u", side,
                  later->surface.levels[0].size);
    bench.add({name, figure, "s", median(carried), "that bake", median(baked)});
}

}  // namespace

void surfaceCases(Bench& bench) {
    carryCase(bench);
    struct Case {
        const char *name, *file;
    };
    const Case cases[] = {{"surface/bunny-1024", "derived/bunny.glb"},
                          {"surface/hermes-1024", "models/threedscans/Hermes.glb"},
                          {"surface/house-1024", "models/quaternius/House2.glb"},
                          {"surface/ruin-1024", ""}};
    for (const Case& c : cases) {
        if (!bench.wants(c.name)) continue;
        const std::string path =
            *c.file ? bench.options().dataFolder + "/" + c.file : bench.options().contentFolder + "/ruin.glb";
        Result<Model> model = importModel(path);
        if (!model) {
            bench.skip(c.name, "needs " + path);
            continue;
        }
        Result<Baked> baked = bake(*model, {});
        if (!baked) {
            bench.skip(c.name, baked.failure().text());
            continue;
        }
        levelCase(bench, c.name, baked->surface);
        const std::string file = neighbourOf(std::filesystem::temp_directory_path() / "espalier_bench_surface.glb");
        if (!writeSurface(baked->surface, file)) continue;
        const double triangles = double(baked->surface.indices.size() / 3);
        bench.add({std::string(c.name) + "/mesh", "mesh by Draco", "B/triangle", double(dracoBytes(file)) / triangles,
                   "meshoptimizer, as precise", double(meshoptBytes(baked->surface)) / triangles});
        std::filesystem::remove(file);
    }
}

}  // namespace espalier
