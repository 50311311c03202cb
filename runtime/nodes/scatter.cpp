// In: places, shapes. Out: the shapes with a step that places them.
#include "runtime/nodes/scatter.hpp"

#include <algorithm>
#include <utility>

namespace espalier {
namespace {

constexpr size_t kMostScattered = 4096;  // parts: each is a draw
// Sites of random numbers; those of sizes and turns are in instanceStep().
constexpr uint32_t kVariantSite = 2, kCutSite = 3;

std::string grouped(uint64_t number) {
    std::string text = std::to_string(number);
    for (size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
    return text;
}

uint64_t instancesIn(const Geometry& shape) {
    uint64_t all = 0;
    for (const GeometryPart& part : shape) all += part.instances();
    return all;
}

}  // namespace

Result<Scattering> Scattering::create(NodeWork& work) {
    Scattering scattering(work);
    scattering.seed_ = work.whole("seed");
    for (const GeometryPart& on : work.geometry("points")) {
        const bool upright = work.choice("up") == 0;
        Result<GeometryPart> points = work.realised(on, !upright);
        if (!points) return points.failure();
        DeformOp op{};
        op.kind = kDeformInstance;
        op.seed = scattering.seed_;
        op.points = points->positions;
        op.points.count = points->elements;
        op.row = points->row;
        op.used = points->used;
        Places& places = scattering.parts_.emplace_back(op, std::vector<BlockRef>{points->positionBlock});
        if (points->normals && !upright) places.op.normals = points->normals->as<UintBuf>();
        if (points->sizes) places.op.sizes = points->sizes->as<FloatBuf>();
        if (points->normals) places.held.push_back(points->normals);
        if (points->sizes) places.held.push_back(points->sizes);
        places.op.a[0] = work.number("size");
        places.op.a[1] = work.number("sizeSpread");
        places.op.a[2] = work.number("turnSpread");
        scattering.count_ += points->elements;
    }
    return scattering;
}

void Scattering::vary(uint32_t variants) {
    firsts_.assign(variants, kNowhere);
    variants_.resize(count_);
    for (uint32_t place = 0; place < count_; ++place) {
        const uint32_t variant = variants == count_ ? place : nodeHash(seed_, place, kVariantSite) % variants;
        variants_[place] = variant;
        firsts_[variant] = std::min(firsts_[variant], place);
    }
}

Status Scattering::give(std::span<const Geometry> shapes, uint64_t most) {
    std::vector<uint64_t> weights, counts(shapes.size());
    for (const Geometry& shape : shapes) weights.push_back(instancesIn(shape));
    for (uint32_t place = 0; place < variants_.size(); ++place) ++counts[variants_[place]];
    if (variants_.empty()) counts.front() = count_;
    uint64_t asked = 0;
    for (size_t v = 0; v < shapes.size(); ++v) asked += weights[v] * counts[v];
    if (variants_.empty() && asked <= most) {
        for (const Places& at : parts_)
            for (const GeometryPart& part : shapes.front())
                if (Status added = put(part, at); !added) return added;
    } else if (Status added = giveLists(shapes, cutAt(weights, most)); !added) {
        return added;
    }
    if (asked > most) work_.note(grouped(most) + " of " + grouped(asked) + " instances");
    work_.give(std::move(out_));
    return Done{};
}

// Places in the order of a hash, as far as `most` goes. Halves are weighed, so only the place at the end is found, and
// nothing is sorted.
Scattering::Cut Scattering::cutAt(std::span<const uint64_t> weights, uint64_t most) const {
    Cut cut{std::vector<bool>(count_, true), kNowhere, 0};
    std::vector<std::pair<uint32_t, uint32_t>> order(count_);
    uint64_t asked = 0;
    for (uint32_t place = 0; place < count_; ++place) {
        order[place] = {nodeHash(seed_, place, kCutSite), place};
        asked += weights[variantOf(place)];
    }
    if (asked <= most) return cut;
    size_t low = 0, high = count_;
    while (high - low > 1) {
        const auto at = [&](size_t i) { return order.begin() + std::ptrdiff_t(i); };
        const size_t middle = low + (high - low) / 2;
        std::nth_element(at(low), at(middle), at(high));
        uint64_t weight = 0;
        for (size_t i = low; i < middle; ++i) weight += weights[variantOf(order[i].second)];
        if (weight <= most) {
            most -= weight;
            low = middle;
        } else {
            high = middle;
        }
    }
    for (size_t i = low; i < count_; ++i) cut.stands[order[i].second] = false;
    cut.last = order[low].second;
    cut.rest = most;
    return cut;
}

// What stands by lists of places: one for each variant and each part of the places.
Status Scattering::giveLists(std::span<const Geometry> shapes, const Cut& cut) {
    std::vector<std::vector<uint32_t>> lists(shapes.size() * parts_.size());
    std::vector<uint32_t> words;
    size_t lastPart = 0;
    for (uint32_t part = 0, first = 0; part < parts_.size(); first += parts_[part++].op.points.count)
        for (uint32_t i = 0; i < parts_[part].op.points.count; ++i) {
            if (cut.stands[first + i]) lists[variantOf(first + i) * parts_.size() + part].push_back(i);
            if (first + i != cut.last) continue;
            lastPart = part;
            words.push_back(i);
        }
    for (const std::vector<uint32_t>& list : lists) words.insert(words.end(), list.begin(), list.end());
    Result<NodeWork::Room> sent = work_.sent("which places", words);
    if (!sent) return sent.failure();
    const auto listed = [&](size_t part, size_t word, size_t count) {
        Places at = parts_[part];
        at.op.which.v = sent->block->as<UintBuf>().v + word;
        at.op.points.count = uint32_t(count);
        at.held.push_back(sent->block);
        return at;
    };
    size_t word = cut.last == kNowhere ? 0 : 1;
    for (size_t v = 0; v < shapes.size(); ++v)
        for (size_t part = 0; part < parts_.size(); ++part) {
            const size_t count = lists[v * parts_.size() + part].size();
            if (count > 0)
                for (const GeometryPart& shape : shapes[v])
                    if (Status added = put(shape, listed(part, word, count)); !added) return added;
            word += count;
        }
    if (cut.last == kNowhere) return Done{};
    Geometry firsts;
    uint64_t rest = cut.rest;
    for (const GeometryPart& shape : shapes[variantOf(cut.last)]) {
        const uint64_t some = std::min(rest, shape.instances());
        if (Status added = firstInstances(shape, some, firsts); !added) return added;
        rest -= some;
    }
    for (GeometryPart& part : firsts)
        if (Status added = put(std::move(part), listed(lastPart, 0, 1)); !added) return added;
    return Done{};
}

// A part's first so many instances, as parts of their own: whole places of its last step that has some, and those of
// one more place.
Status Scattering::firstInstances(const GeometryPart& part, uint64_t instances, Geometry& out) {
    if (instances == 0) return Done{};
    if (instances >= part.instances()) {
        out.push_back(part);
        return Done{};
    }
    size_t last = part.program.size();
    while (part.program[--last].kind != kDeformInstance) {
    }
    GeometryPart inner = part;
    inner.program.resize(last);
    const uint64_t full = instances / inner.instances();
    const auto add = [&](GeometryPart each, const DeformOp& op) {
        each.program.push_back(op);
        each.program.insert(each.program.end(), part.program.begin() + std::ptrdiff_t(last) + 1, part.program.end());
        out.push_back(std::move(each));
    };
    DeformOp op = part.program[last];
    op.points.count = uint32_t(full);
    if (full > 0) add(inner, op);
    Geometry firsts;
    if (Status found = firstInstances(inner, instances % inner.instances(), firsts); !found) return found;
    if (firsts.empty()) return Done{};
    op.points.count = 1;
    if (op.which.v) {
        op.which.v += full;
    } else {
        Result<NodeWork::Room> sent = work_.sent("which place", std::vector<uint32_t>{uint32_t(full)});
        if (!sent) return sent.failure();
        op.which = sent->block->as<UintBuf>();
        for (GeometryPart& each : firsts) each.held.push_back(sent->block);
    }
    for (GeometryPart& each : firsts) add(std::move(each), op);
    return Done{};
}

Status Scattering::put(GeometryPart part, const Places& at) {
    if (part.program.size() >= kMostDeforms) return Failure("", "more than 64 steps act on one geometry");
    if (out_.size() == kMostScattered)
        return Failure("", "gives more than 4,096 different shapes; take fewer variants");
    part.program.push_back(at.op);
    part.held.insert(part.held.end(), at.held.begin(), at.held.end());
    out_.push_back(std::move(part));
    return Done{};
}

std::vector<NodePort> scatterPorts() {
    return {numberPort("size", 1, 0, 1e6f, "", "times its own"),
            numberPort("sizeSpread", 0, 0, 1, "", "how far sizes differ: 0.2 is a fifth up or down"),
            numberPort("turnSpread", 1, 0, 1, "turns", "how far shapes are turned about their y axes"),
            {"up", ValueType::choice, "y", 0, 0, "", "what a shape's y axis becomes", {"y", "normal"}},
            seedPort(),
            wholePort("most", kMostNodeInstances, 1, kMostNodeInstances,
                      "instances at most; of more, some places stay empty, and a larger number only adds")};
}

}  // namespace espalier
