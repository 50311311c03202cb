// Enters: pieces where they stand, a view. Leaves: an instance buffer a view and one draw for each level that is seen.
#include "runtime/render/piece_draw.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime/gpu/color_texture.hpp"
#include "runtime/render/view_sides.hpp"

namespace espalier {
namespace {

constexpr float kPieceFade = 0.15f;   // share of the distance over which a level takes over
constexpr float kLeastPiece = 0.35f;  // radius below which a piece isn't drawn

}  // namespace

Result<std::unique_ptr<PieceDraw>> PieceDraw::create(Device& device, TerminalData meshes) {
    std::unique_ptr<PieceDraw> draw(new PieceDraw(device));
    Result<Terminals> terminals = Terminals::create(device, std::move(meshes), TerminalChoice::cpu);
    if (!terminals) return terminals.failure();
    draw->terminals_ = std::move(*terminals);
    if (Status s = assign(draw->sampler_, Sampler::create(device, {.name = "piece textures",
                                                                   .anisotropy = device.info().traits.anisotropy}));
        !s)
        return s.failure();
    return draw;
}

Result<Program> PieceDraw::program(Device& device, const PassFormat& pass, Shading shading) {
    GraphicsDesc desc = inPass(pass, "piece", "render/piece.vert", pass.colors.empty() ? "" : "render/piece.frag",
                               constantsOf(shading, holdsRoots(device)));
    desc.blend = blendOf(shading);
    return Program::graphics(device, desc);
}

const VariantRecord* PieceDraw::variantOf(const PatternPiece& piece) const {
    const TerminalTable& table = terminals_.table();
    const uint32_t kind = piece.mesh & 0xFFFFu;
    if (kind >= table.kinds.size() || table.kinds[kind].variantCount == 0) return nullptr;
    return &table.variants[table.kinds[kind].firstVariant];
}

const TerminalVariant* PieceDraw::meshOf(const PatternPiece& piece) const {
    const VariantRecord* variant = variantOf(piece);
    return variant ? &terminals_.data().variants[size_t(variant - terminals_.table().variants.data())] : nullptr;
}

Status PieceDraw::place(std::vector<PatternPiece> pieces) {
    // A piece stands twice where a level of detail takes over.
    for (Chosen* chosen : {&inView_, &casters_}) {
        Status made = makeTexels(device_, "pieces", std::max<size_t>(2 * pieces.size(), 1) * sizeof(PatternPiece),
                                 VK_FORMAT_R32G32B32A32_UINT, chosen->instances, chosen->texels);
        if (!made) return made;
        chosen->runs.clear();
    }
    pieces_ = std::move(pieces);
    spheres_.clear();
    for (const PatternPiece& p : pieces_) {
        const VariantRecord* variant = variantOf(p);
        const bool line = (p.mesh & kPieceLine) != 0;
        const float scale = line ? glm::length(p.y) : std::max({glm::length(p.x), glm::length(p.y), glm::length(p.z)});
        const float radius = variant ? variant->extent * scale : 0;
        if (line)  // whose curve bulges by less than a tenth
            spheres_.push_back({p.position + p.x * .5f, .6f * glm::length(p.x) + radius, scale});
        else
            spheres_.push_back({p.position, radius, scale});
    }
    chosenFor_ = {};
    ++revision_;
    return Done{};
}

void PieceDraw::bounds(glm::vec3& low, glm::vec3& high) const {
    for (const Sphere& s : spheres_) {
        low = glm::min(low, s.centre - s.radius);
        high = glm::max(high, s.centre + s.radius);
    }
}

Status PieceDraw::choose(Commands& commands, const FrameRecord& frame, float lodPixels) {
    const View view{frame.viewProjection, frame.pixelScale, lodPixels};
    if (chosenFor_ == view) return Done{};
    std::vector<std::vector<PatternPiece>> levels(terminals_.table().buckets.size());
    const ViewSides sides(frame.viewProjection);
    for (size_t i = 0; i < pieces_.size(); ++i) {
        const Sphere& s = spheres_[i];
        const VariantRecord* variant = variantOf(pieces_[i]);
        if (!variant || sides.misses(s.centre - s.radius, s.centre + s.radius)) continue;
        const float distance = std::max(glm::length(s.centre - frame.eye), 1e-4f);
        if (s.radius * frame.pixelScale < kLeastPiece * distance) continue;
        // How many times as far away as needed for a level to do; the coarser takes over just beyond 1.
        uint32_t level = 0;
        float over = 0;
        while (level + 1 < variant->lodCount) {
            const float next = distance * lodPixels / (variant->error[level + 1] * s.scale * frame.pixelScale);
            if (next < 1) break;
            over = next;
            ++level;
        }
        const float share = level > 0 ? std::max((over - 1) / kPieceFade, 0.01f) : 1;
        PatternPiece piece = pieces_[i];
        piece.set = std::bit_cast<uint32_t>(std::min(share, 1.0f));
        levels[variant->firstBucket + level].push_back(piece);
        if (share >= 1) continue;
        piece.set = std::bit_cast<uint32_t>(-share);
        levels[variant->firstBucket + level - 1].push_back(piece);
    }
    if (Status s = upload(commands, levels, inView_); !s) return s;
    chosenFor_ = view;
    return Done{};
}

Status PieceDraw::chooseCasters(Commands& commands, const glm::mat4& sunClip, float texelsPerMetre) {
    std::vector<std::vector<PatternPiece>> levels(terminals_.table().buckets.size());
    for (size_t i = 0; i < pieces_.size(); ++i) {
        const Sphere& s = spheres_[i];
        const VariantRecord* variant = variantOf(pieces_[i]);
        if (!variant) continue;
        const glm::vec4 at = sunClip * glm::vec4(s.centre, 1);
        const float reach = s.radius * glm::length(glm::vec3(sunClip[0]));
        if (std::max(std::abs(at.x), std::abs(at.y)) > 1 + reach) continue;
        uint32_t level = 0;
        while (level + 1 < variant->lodCount && variant->error[level + 1] * s.scale * texelsPerMetre < 1) ++level;
        PatternPiece piece = pieces_[i];
        piece.set = std::bit_cast<uint32_t>(1.0f);
        levels[variant->firstBucket + level].push_back(piece);
    }
    return upload(commands, levels, casters_);
}

Status PieceDraw::upload(Commands& commands, std::span<const std::vector<PatternPiece>> levels, Chosen& out) const {
    std::vector<PatternPiece> all;
    out.runs.clear();
    for (uint32_t b = 0; b < levels.size(); ++b) {
        if (levels[b].empty()) continue;
        out.runs.push_back({b, uint32_t(all.size()), uint32_t(levels[b].size())});
        all.insert(all.end(), levels[b].begin(), levels[b].end());
    }
    if (all.empty()) return Done{};
    commands.barrier(Use::vertex, Use::transfer);
    if (Status s = commands.upload(out.instances, all); !s) return s;
    commands.barrier(Use::transfer, Use::vertex);
    return Done{};
}

void PieceDraw::drawRuns(DrawPass& pass, const Chosen& chosen, const Buffer& frame, const Program& program,
                         const Binding* shadow) const {
    const TerminalTable& table = terminals_.table();
    pass.setIndices(terminals_.batches());
    for (const Run& run : chosen.runs) {
        const BucketRecord& bucket = table.buckets[run.bucket];
        const auto variant = std::ranges::find_if(table.variants, [&](const VariantRecord& v) {
            return run.bucket >= v.firstBucket && run.bucket < v.firstBucket + v.lodCount;
        });
        const TerminalMaterial& material = terminals_.data().materials[bucket.material];
        const PiecePush push{run.first, run.bucket - variant->firstBucket, material.roughness,
                             material.baseColorPicture >= 0 ? 1u : 0u};
        const DrawPass::IndexRange range{bucket.indexCount, bucket.firstIndex, int32_t(bucket.firstVertex), run.count};
        const Binding texels(chosen.texels), meshes(terminals_.vertexTexels());
        if (shadow)
            pass.drawIndexed(program, range, push,
                             {{terminals_.baseColor(bucket.material), sampler_}, *shadow, frame, texels, meshes});
        else
            pass.drawIndexed(program, range, push, {frame, texels, meshes});
    }
}

PieceDraw::Stats PieceDraw::stats() const {
    Stats stats;
    for (const Run& run : inView_.runs) {
        stats.pieces += run.count;
        stats.triangles += uint64_t(run.count) * terminals_.table().buckets[run.bucket].indexCount / 3;
    }
    return stats;
}

}  // namespace espalier
