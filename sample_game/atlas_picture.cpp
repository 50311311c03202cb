// Texels, links and a layer, as the plugin gives them back -> a picture.
#include "sample_game/atlas_picture.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "sample_game/widgets.hpp"
#include "tools/scene/layers.hpp"

namespace sample {
namespace {

constexpr uint32_t kLeastSide = 512;  // pixels of the picture: texels of coarse levels are drawn as squares
constexpr size_t kShades = 256;
constexpr ImU32 kEmpty = IM_COL32(20, 21, 24, 255), kPlain = IM_COL32(62, 65, 70, 255);

ImU32 mixed(ImU32 a, ImU32 b, float share) {
    const auto channel = [&](int shift) {
        const float x = float(a >> shift & 255), y = float(b >> shift & 255);
        return ImU32(x + (y - x) * share + .5f) << shift;
    };
    return channel(IM_COL32_R_SHIFT) | channel(IM_COL32_G_SHIFT) | channel(IM_COL32_B_SHIFT) | IM_COL32_A_MASK;
}

}  // namespace

const uint32_t AtlasPicture::kLinkColours[4] = {IM_COL32(150, 170, 190, 255), IM_COL32(90, 210, 210, 255),
                                                IM_COL32(240, 200, 60, 255), IM_COL32(225, 80, 70, 255)};

void AtlasShown::keepTo(const espalier::scene::Scene& scene) {
    if (surface >= scene.surfaces.size()) surface = 0;
    if (std::ranges::find(scene.layers, layer) == scene.layers.end()) layer.clear();
}

std::string surfaceName(const std::vector<espalier::scene::LoadedSurface>& surfaces, size_t index) {
    std::string name = std::filesystem::path(surfaces[index].file).filename().string();
    name = name.substr(0, name.find('.'));
    return surfaces.size() > 1 ? std::to_string(index + 1) + "  " + name : name;
}

std::string leadsTo(const espalier::scene::Scene& scene, uint32_t shown, const EspLink& link) {
    if (link.kind == ESP_LINK_OPEN) return "a border of the model";
    const std::string from = "leads from chart " + std::to_string(link.chart) + " to ",
                      to = std::to_string(link.toChart);
    const auto& surfaces = scene.surfaces;
    const auto at = std::ranges::find(surfaces, link.toSurface.id, [](const auto& surface) { return surface.id.id; });
    const size_t index = size_t(at - surfaces.begin());
    if (index == shown) return from + to;
    return from + "chart " + to + " of " + (at == surfaces.end() ? "another surface" : surfaceName(surfaces, index));
}

void AtlasPicture::forget() {
    shown_ = {};
    size_ = 0;
    texels_.clear();
    links_.clear();
    layer_.clear();
}

bool AtlasPicture::read(Workspace& work, const AtlasShown& wanted) {
    EspContext* context = work.context.get();
    const EspSurface surface = work.scene().surfaces[wanted.surface].id;
    const bool sameSurface = wanted.surface == shown_.surface;
    AtlasPicture next = *this;  // so that what is shown stands whole until all has been read
    next.shown_ = wanted;
    if (!sameSurface || wanted.level != shown_.level) {
        if (espReadAtlas(context, surface, wanted.level, nullptr, &next.size_) != ESP_OK) return false;
        next.texels_.resize(size_t(next.size_) * next.size_);
        if (espReadAtlas(context, surface, wanted.level, next.texels_.data(), &next.size_) != ESP_OK) return false;
    }
    if (!sameSurface) {
        uint32_t count = 0;
        if (espReadLinks(context, surface, nullptr, &count) != ESP_OK) return false;
        next.links_.resize(count);
        if (espReadLinks(context, surface, next.links_.data(), &count) != ESP_OK) return false;
    }
    if (!sameSurface || wanted.layer != shown_.layer || wanted.revision != shown_.revision) next.layer_.clear();
    if (next.layer_.empty() && !wanted.layer.empty())
        for (const std::string& channel : channelsOf(work.scene(), wanted.layer)) {
            espalier::scene::GreyPicture picture;
            if (!work.document->readLayer(wanted.surface, channel, picture, work.error)) return false;
            next.layerSize_ = picture.width;
            next.layer_.push_back(std::move(picture.texels));
        }
    *this = std::move(next);
    return true;
}

// As the views of charts and of a layer have them on the model.
void AtlasPicture::mixColours() {
    uint32_t charts = 1;
    for (uint32_t texel : texels_) charts = std::max(charts, (texel & 0xFFFFu) + 1);
    while (chartColours_.size() < charts)
        chartColours_.push_back(viewColour(ESP_VIEW_CHARTS, float(chartColours_.size())));
    while (layerColours_.size() < kShades)
        layerColours_.push_back(viewColour(ESP_VIEW_LAYER, float(layerColours_.size()) / (kShades - 1)));
}

uint32_t AtlasPicture::colourOf(uint32_t x, uint32_t y) const {
    const uint32_t texel = texels_[size_t(y) * size_ + x], kind = texel >> 16 & 3u;
    if (kind == ESP_TEXEL_EMPTY) return kEmpty;
    ImU32 colour = shown_.charts ? chartColours_[texel & 0xFFFFu] : kPlain;
    if (texel >> 18 & 1u) colour = mixed(colour, kEmpty, .75f);
    if (kind != ESP_TEXEL_INNER) return mixed(colour, kEmpty, .6f);
    if (shown_.layer.empty()) return colour;
    // At the texel's middle: around a chart the layer holds what nobody has painted.
    const auto middle = [&](uint32_t i) { return (2 * size_t(i) + 1) * layerSize_ / (2 * size_); };
    const size_t u = middle(x), v = middle(y);
    const size_t at = v * layerSize_ + u;
    if (layer_.size() == 3)
        return mixed(colour, shownColour({layer_[0][at], layer_[1][at], layer_[2][at]}), shown_.opacity);
    const float value = std::clamp(layer_[0][at], 0.f, 1.f);
    return mixed(colour, layerColours_[size_t(value * (kShades - 1) + .5f)], shown_.opacity);
}

void AtlasPicture::drawLinks(std::vector<uint32_t>& pixels, uint32_t side) const {
    for (const EspLink& link : links_) {
        const float dx = (link.b[0] - link.a[0]) * float(side), dy = (link.b[1] - link.a[1]) * float(side);
        const int steps = std::min(int(std::max(std::abs(dx), std::abs(dy))) + 1, 16384);
        for (int i = 0; i <= steps; ++i) {
            const float t = float(i) / float(steps);
            const int x = int(link.a[0] * float(side) + dx * t), y = int(link.a[1] * float(side) + dy * t);
            if (x < 0 || y < 0 || x >= int(side) || y >= int(side)) continue;
            pixels[size_t(y) * side + size_t(x)] = kLinkColours[link.kind];
        }
    }
}

std::vector<float> AtlasPicture::layerAt(float u, float v) const {
    std::vector<float> values;
    const size_t at = size_t(v * float(layerSize_)) * layerSize_ + size_t(u * float(layerSize_));
    for (const std::vector<float>& channel : layer_) values.push_back(channel[at]);
    return values;
}

std::vector<uint32_t> AtlasPicture::pixels(uint32_t& side) {
    mixColours();
    const uint32_t factor = std::max(1u, kLeastSide / size_);
    side = size_ * factor;
    std::vector<uint32_t> pixels(size_t(side) * side);
    std::vector<uint32_t> row(size_);
    for (uint32_t y = 0; y < size_; ++y) {
        for (uint32_t x = 0; x < size_; ++x) row[x] = colourOf(x, y);
        for (uint32_t k = 0; k < factor; ++k)
            for (uint32_t x = 0; x < side; ++x) pixels[size_t(y * factor + k) * side + x] = row[x / factor];
    }
    if (shown_.links) drawLinks(pixels, side);
    return pixels;
}

}  // namespace sample
