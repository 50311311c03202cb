// Enters: models with levels of detail, where they stand, a view. Leaves: an instance buffer a view and one draw for
// each level that is seen.
#include "runtime/render/props.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/core/check.hpp"
#include "runtime/gpu/color_texture.hpp"
#include "runtime/render/meadow_noise.hpp"
#include "runtime/render/view_sides.hpp"

namespace espalier {
namespace {

constexpr float kBuiltPixels = 1;                         // error allowed of walls and the like
constexpr float kFoliagePixels = 6;                       // of foliage, which is noise
constexpr float kFadeZone = 0.15f, kFoliageZone = 0.05f;  // shares of the distance over which a level takes over
constexpr float kLeastPixels = 2;                         // radius below which a prop isn't drawn
constexpr float kGrassReach = 24, kGrassShrinks = 10;     // metres from the eye; over which it sinks into the meadow
constexpr float kTallGrass = 0.2f;                        // metres; what is lower sinks nearer by, down to half as far
constexpr float kOwnHue = 0.28f;                          // how far apart the meadow's plants are at one place

// 0 to 1, even over places near each other, and the same whatever else is placed.
float ownTint(glm::vec2 place) {
    return glm::fract(glm::dot(place, glm::vec2(0.7548777f, 0.5698403f)));
}
// PropInstance::tint of what grows in the meadow: its hue there, each plant a little off it.
float meadowTint(glm::vec2 place, float own) {
    const MeadowHue hue = meadowHue(place);
    const float dry = std::clamp(hue.dry + kOwnHue * (own - 0.5f), 0.0f, 0.999f);
    return std::round((hue.shade * (0.9f + 0.2f * own) - 1) / kShadeStep) + dry;
}

}  // namespace

Result<Props> Props::create(Device& device, TerminalData models, VkFormat color, VkFormat depth, uint32_t samples) {
    Props props;
    Result<Terminals> terminals = Terminals::create(device, std::move(models), TerminalChoice::cpu);
    if (!terminals) return terminals.failure();
    props.terminals_ = std::move(*terminals);
    props.measure();
    Result<Sampler> sampler =
        Sampler::create(device, {.name = "prop textures", .anisotropy = device.info().traits.anisotropy});
    if (!sampler) return sampler.failure();
    props.sampler_ = std::move(*sampler);
    Result<Sampler> quick = Sampler::create(device, {.name = "prop textures, quick", .blendMips = false});
    if (!quick) return quick.failure();
    props.quickSampler_ = std::move(*quick);
    if (Status s = props.makePrograms(device, color, depth, samples); !s) return s.failure();
    return props;
}

void Props::measure() {
    tops_.resize(terminals_.table().buckets.size());
    for (const TerminalVariant& variant : variants()) {
        Room& room = rooms_.emplace_back();
        for (const TerminalLod& lod : variant.lods)
            for (uint32_t i = 0; i < lod.vertexCount; ++i) {
                const glm::vec3 at = terminals_.data().vertices[lod.firstVertex + i].position;
                room.around = std::max(room.around, glm::length(glm::vec2(at.x, at.z)));
                room.foot = std::min(room.foot, at.y);
                room.top = std::max(room.top, at.y);
            }
        const VariantRecord& record = terminals_.table().variants[rooms_.size() - 1];
        std::fill_n(tops_.begin() + record.firstBucket, record.lodCount, room.top);
    }
}

Props::Box Props::boxOf(const PropPlace& place) const {
    const Room& room = rooms_[place.variant];
    return {place.position + place.scale * glm::vec3(-room.around, room.foot, -room.around),
            place.position + place.scale * glm::vec3(room.around, room.top, room.around)};
}

const TerminalMaterial& Props::materialOf(const PropPlace& place) const {
    const TerminalTable& table = terminals_.table();
    return terminals_.data().materials[table.buckets[table.variants[place.variant].firstBucket].material];
}

Status Props::makePrograms(Device& device, VkFormat color, VkFormat depth, uint32_t samples) {
    const char* foliage = samples == 1 ? "render/foliage_single.frag" : "render/foliage.frag";
    struct Row {
        Program& program;
        const char* name;
        const char* vertex;
        const char* fragment;
        Shading shading = Shading::full;
        bool shadow = false;
    };
    std::vector<Row> rows{{depth_, "prop shadow", "render/prop.vert", "render/prop_shadow.frag", Shading::full, true}};
    for (uint32_t s = 0; s < kShadings; ++s) {
        if (!isAskedOf(device, Shading(s))) continue;
        rows.push_back({built_[s], "prop", "render/prop.vert", "render/prop.frag", Shading(s)});
        rows.push_back({foliage_[s], "foliage", "render/foliage.vert", foliage, Shading(s)});
    }
    for (const Row& r : rows) {
        GraphicsDesc desc;
        desc.name = r.name;
        desc.vertex = r.vertex;
        desc.fragment = r.fragment;
        desc.depth = depth;
        desc.options.constants = constantsOf(r.shading, holdsRoots(device));
        if (r.shadow) {
            desc.depthBiasConstant = 2;
            desc.depthBiasSlope = 1.8f;
        } else {
            desc.colors = {color};
            desc.blend = blendOf(r.shading);
            desc.samples = samples;
            desc.depthCompare = VK_COMPARE_OP_GREATER_OR_EQUAL;
        }
        if (Status made = assign(r.program, Program::graphics(device, desc)); !made) return made.failure();
    }
    return Done{};
}

Status Props::place(Device& device, std::vector<PropPlace> places) {
    for (const PropPlace& p : places) require(p.variant < variants().size(), "a prop has a variant");
    // An instance stands twice where a level of detail takes over.
    for (Chosen* chosen : {&inView_, &casters_}) {
        Status made = makeTexels(device, "props", std::max<size_t>(2 * places.size(), 1) * sizeof(PropInstance),
                                 VK_FORMAT_R32G32B32A32_UINT, chosen->instances, chosen->texels);
        if (!made) return made;
        chosen->runs.clear();
    }
    places_ = std::move(places);
    instances_.clear();
    for (size_t i = 0; i < places_.size(); ++i) {
        const PropPlace& p = places_[i];
        const glm::vec2 at(p.position.x, p.position.z);
        const std::string& material = materialOf(p).name;
        const bool ofMeadow = material == "grass" || material == "meadow";
        const float tint = ofMeadow ? meadowTint(at, ownTint(at)) : ownTint(at);
        instances_.push_back({p.position, p.scale, {std::cos(p.turn), std::sin(p.turn)}, tint, 1});
    }
    chosenFor_ = {};
    return Done{};
}

void Props::bounds(glm::vec3& low, glm::vec3& high) const {
    for (const PropPlace& p : places_) {
        const Box box = boxOf(p);
        low = glm::min(low, box.low);
        high = glm::max(high, box.high);
    }
}

Status Props::choose(Commands& commands, const FrameRecord& frame) {
    const View view{frame.viewProjection, frame.pixelScale, frame.unit};
    if (chosenFor_ == view) return Done{};
    const TerminalTable& table = terminals_.table();
    std::vector<Level> levels(table.buckets.size());
    const ViewSides sides(frame.viewProjection);
    for (size_t i = 0; i < places_.size(); ++i) {
        const VariantRecord& variant = table.variants[places_[i].variant];
        const TerminalMaterial& material = materialOf(places_[i]);
        PropInstance instance = instances_[i];
        const Box box = boxOf(places_[i]);
        if (sides.misses(box.low, box.high)) continue;
        const float distance = std::max(glm::length(instance.position - frame.eye), 1e-3f);
        if (variant.extent * instance.scale * frame.pixelScale < kLeastPixels * distance) continue;
        if (material.name == "grass") {
            const float high = rooms_[places_[i].variant].top * instance.scale / frame.unit;
            const float reach = kGrassReach * std::clamp(high / kTallGrass, 0.5f, 1.0f);
            instance.scale *= std::clamp((reach - distance / frame.unit) / kGrassShrinks, 0.0f, 1.0f);
            if (instance.scale <= 0) continue;
        }
        const bool noisy = material.alphaCutoff > 0 || material.name == "grass";
        const float allowed = noisy ? kFoliagePixels : kBuiltPixels;
        // How many times as far away as needed for level l to do; the coarser takes over just beyond 1.
        uint32_t level = 0;
        float over = 0;
        while (level + 1 < variant.lodCount) {
            const float next = distance * allowed / (variant.error[level + 1] * instance.scale * frame.pixelScale);
            if (next < 1) break;
            over = next;
            ++level;
        }
        const float share = level > 0 ? (over - 1) / (noisy ? kFoliageZone : kFadeZone) : 1;
        auto& coarse = levels[variant.firstBucket + level].seen;
        if (share >= 1) {
            coarse.emplace_back(distance, instance);
            continue;
        }
        instance.fade = std::max(share, 0.01f);
        coarse.emplace_back(distance, instance);
        instance.fade = -instance.fade;
        levels[variant.firstBucket + level - 1].seen.emplace_back(distance, instance);
    }
    if (Status s = upload(commands, levels, inView_); !s) return s;
    chosenFor_ = view;
    return Done{};
}

Status Props::chooseCasters(Commands& commands, const glm::mat4& sunClip) {
    const TerminalTable& table = terminals_.table();
    std::vector<Level> levels(table.buckets.size());
    for (size_t i = 0; i < places_.size(); ++i) {
        const VariantRecord& variant = table.variants[places_[i].variant];
        const TerminalMaterial& material = materialOf(places_[i]);
        const bool low = rooms_[places_[i].variant].top * places_[i].scale < kTallGrass;
        if (material.name == "grass" || (material.name == "meadow" && low)) continue;
        const glm::vec4 at = sunClip * glm::vec4(places_[i].position, 1);
        const float reach = variant.extent * places_[i].scale * glm::length(glm::vec3(sunClip[0]));
        if (std::max(std::abs(at.x), std::abs(at.y)) > 1 + reach) continue;
        const uint32_t level = std::min(1u, variant.lodCount - 1);
        levels[variant.firstBucket + level].seen.emplace_back(0.0f, instances_[i]);
    }
    return upload(commands, levels, casters_);
}

// Nearest first, so that what is behind costs no shading.
Status Props::upload(Commands& commands, std::vector<Level>& levels, Chosen& out) const {
    std::vector<PropInstance> all;
    out.runs.clear();
    for (uint32_t b = 0; b < levels.size(); ++b) {
        auto& seen = levels[b].seen;
        if (seen.empty()) continue;
        std::stable_sort(seen.begin(), seen.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
        out.runs.push_back({b, uint32_t(all.size()), uint32_t(seen.size())});
        for (const auto& [distance, instance] : seen) all.push_back(instance);
    }
    if (all.empty()) return Done{};
    commands.barrier(Use::vertex, Use::transfer);
    if (Status s = commands.upload(out.instances, all); !s) return s;
    commands.barrier(Use::transfer, Use::vertex);
    return Done{};
}

PropPush Props::pushOf(uint32_t bucket, uint32_t first) const {
    const TerminalMaterial& material = terminals_.data().materials[terminals_.table().buckets[bucket].material];
    return {material.baseColor,   first,        material.name == "grass" ? 1u : 0u, material.roughness,
            material.alphaCutoff, tops_[bucket]};
}

void Props::drawRuns(DrawPass& pass, const Chosen& chosen, const Buffer& frame, const Binding* shadow,
                     Shading shading) const {
    const TerminalTable& table = terminals_.table();
    pass.setIndices(terminals_.batches());
    for (const Run& run : chosen.runs) {
        const BucketRecord& bucket = table.buckets[run.bucket];
        const PropPush push = pushOf(run.bucket, run.first);
        const DrawPass::IndexRange range{bucket.indexCount, bucket.firstIndex, int32_t(bucket.firstVertex), run.count};
        const Sampler& sampler = isQuick(shading) ? quickSampler_ : sampler_;
        const Binding color{terminals_.baseColor(bucket.material), sampler}, texels(chosen.texels),
            meshes(terminals_.vertexTexels());
        if (!shadow)
            pass.drawIndexed(depth_, range, push, {color, frame, texels, meshes});
        else if (push.alphaCutoff > 0 || push.grass)
            pass.drawIndexed(foliage_[size_t(shading)], range, push, {color, *shadow, frame, texels, meshes});
        else
            pass.drawIndexed(built_[size_t(shading)], range, push, {color, *shadow, frame, texels, meshes});
    }
}

void Props::draw(DrawPass& pass, const Buffer& frame, const Binding& shadow, Shading shading) const {
    drawRuns(pass, inView_, frame, &shadow, shading);
}

void Props::drawDepth(DrawPass& pass, const Buffer& frame) const {
    drawRuns(pass, casters_, frame, nullptr, Shading::full);
}

}  // namespace espalier
