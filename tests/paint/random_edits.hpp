#pragma once

// Edits of all kinds that the public interface has for plants, drawn at random and told to both of two contexts.

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <random>

#include "plugin_api/espalier.hpp"
#include "tests/paint/editions.hpp"
#include "tests/paint/twins.hpp"

namespace espalier::test {

struct RandomEdits {
    // poses_: where the second surface may come to stand. fills: all layers are painted everywhere to begin with.
    RandomEdits(Twins& scene, uint32_t seed, std::vector<std::vector<EspTransform>> where, uint32_t plants, bool fills)
        : twins(scene), random(seed), poses_(std::move(where)), filled_(fills) {
        for (uint32_t g = 0; g < 2; ++g) {
            texts_[g] = editionOf(g, 0);
            const EspGrammarDef def = esp::grammarDef("edits", texts_[g]);
            grammars_.push_back(twins.make<EspGrammar>(
                [&](EspContext* c, EspGrammar* out) { return espCompileGrammar(c, &def, out); }));
        }
        for (const char* layer : {"mask", "cover", "damp"})
            if (filled_) fill(layer, .75f);
        for (uint32_t i = 0; i < plants; ++i) plant();
    }

    float in(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); }
    uint32_t below(uint32_t count) { return uint32_t(random() % count); }

    // One edit. `grow` is called within strokes, as a window draws while the pen is down; false ends all.
    template <class Grow>
    bool edit(Grow&& grow) {
        using Edits = RandomEdits;
        static constexpr struct {
            uint32_t share;
            void (Edits::*make)();
        } kKinds[] = {{8, &Edits::swap},        {3, &Edits::fillAny},   {4, &Edits::import}, {5, &Edits::setParam},
                      {4, &Edits::rewrite},     {6, &Edits::plant},     {5, &Edits::remove}, {6, &Edits::moveSeed},
                      {6, &Edits::number},      {6, &Edits::seedParam}, {8, &Edits::prune},  {9, &Edits::freeze},
                      {3, &Edits::moveSurface}, {1, &Edits::dropLayer}};
        uint32_t drawn = theme_.empty() ? below(100) : theme_[below(uint32_t(theme_.size()))];
        for (const auto& kind : kKinds) {
            if (drawn < kind.share) return (this->*kind.make)(), true;
            drawn -= kind.share;
        }
        return stroke(grow);
    }

    // From now on edits are of few kinds, or (0) of all: few meet on the same things.
    void focus(uint32_t kinds) {
        theme_.clear();
        while (theme_.size() < kinds) theme_.push_back(below(100));
    }

    // Lines begin with what kind of edit it is.
    void note(const char* format, ...) __attribute__((format(printf, 2, 3))) {
        char line[256];
        va_list values;
        va_start(values, format);
        std::vsnprintf(line, sizeof line, format, values);
        va_end(values);
        told.push_back(line);
    }
    std::vector<std::pair<EspGrammar, std::string>> rules() const {
        return {{grammars_[0], texts_[0]}, {grammars_[1], texts_[1]}};
    }

    Twins& twins;
    std::mt19937 random;
    std::vector<std::string> told;  // what was done, for who looks for a mistake
    bool small = false;             // the latest stroke was one

  private:
    const char* layerName() {
        const char* names[] = {"mask", "mask", "mask", "cover", "damp", "tint.g", "idle"};
        return names[below(filled_ ? 6 : 7)];
    }
    EspHit place() {
        EspSurfaceInfo info{};
        REQUIRE(espSurfaceInfo(twins.context(), twins.surfaces[below(uint32_t(twins.surfaces.size()))], &info) ==
                ESP_OK);
        float point[3];
        for (int i = 0; i < 3; ++i) point[i] = in(info.boundsMin[i], info.boundsMax[i]);
        EspHit hit{};
        REQUIRE(espNearest(twins.context(), point, &hit) == ESP_OK);
        return hit;
    }
    template <class Call>
    void forSeed(const char* what, Call&& call) {
        if (const EspSeed seed = anySeed(); seed.id) {
            const bool done = twins.both([&](EspContext* c) { return call(c, twins.in(c, seed)); });
            note("%s seed %x%s", what, seed.id, done ? "" : ": refused");
        }
    }
    EspSeed anySeed() {
        EspSeed seed{};
        if (const uint32_t count = espSeedCount(twins.context()); count > 0)
            REQUIRE(espSeedAt(twins.context(), below(count), &seed) == ESP_OK);
        return seed;
    }
    EspSeedInfo infoOf(EspSeed seed) {
        EspSeedInfo info{};
        REQUIRE(espSeedInfo(twins.context(), seed, &info) == ESP_OK);
        return info;
    }
    EspSeedDef defOf(EspSeed seed) {
        EspSeedDef def{};
        REQUIRE(espSeedDef(twins.context(), seed, &def) == ESP_OK);
        return def;
    }

    template <class Grow>
    bool stroke(Grow&& grow) {
        const char* modes[] = {"paint", "erase", "smooth"};
        EspBrush brush = esp::defaults<EspBrush>();
        brush.layer = layerName();
        brush.mode = EspBrushMode(below(5) % 3);
        brush.radius = below(3) ? in(.02f, .12f) : in(.1f, .6f);
        brush.value = below(3) ? 0 : in(0, 1);
        brush.strength = in(.3f, 1);
        brush.hardness = in(0, 1);
        brush.frontOnly = int(below(2));
        if (below(3) == 0) brush.slopeRange[0] = in(0, 1), brush.slopeRange[1] = in(1, 3);
        if (below(3) == 0) brush.heightRange[0] = in(-1, 0), brush.heightRange[1] = in(0, 1);
        if (below(2)) brush.limitSoftness = in(0, 1);
        const EspStroke made =
            twins.make<EspStroke>([&](EspContext* c, EspStroke* out) { return espBeginStroke(c, &brush, out); });
        REQUIRE(made.id);
        for (uint32_t call = below(3) + 1; call-- > 0;) {
            std::vector<EspDab> dabs(below(4) + 1);
            EspHit at = place();
            for (EspDab& dab : dabs) {
                for (int i = 0; i < 3; ++i) {
                    dab.position[i] = at.position[i] + in(-.5f, .5f) * brush.radius;
                    dab.normal[i] = at.normal[i];
                }
                dab.pressure = in(.5f, 1);
            }
            note("%s %s by stroke %x, radius %.3f, value %.2f: %zu dabs at %.3f %.3f %.3f", modes[brush.mode],
                 brush.layer, int(brush.mode), double(brush.radius), double(brush.value), dabs.size(),
                 double(at.position[0]), double(at.position[1]), double(at.position[2]));
            REQUIRE(twins.both([&](EspContext* c) {
                return espStrokeDabs(c, twins.in(c, made), dabs.data(), uint32_t(dabs.size()));
            }));
            small = brush.radius < .12f;
            if (call > 0 && !grow()) return false;
        }
        REQUIRE(twins.both([&](EspContext* c) { return espEndStroke(c, twins.in(c, made)); }));
        keep(made);
        return true;
    }
    void keep(EspStroke stroke) {
        for (EspStroke gone : undone_)
            twins.both([&](EspContext* c) { return espDestroyStroke(c, twins.in(c, gone)); });
        undone_.clear();
        done_.push_back(stroke);
    }
    void swap() {
        const bool back = undone_.empty() || below(3) > 0;
        std::vector<EspStroke>&from = back ? done_ : undone_, &to = back ? undone_ : done_;
        if (from.empty()) return;
        note("%s %x", back ? "undo" : "redo", from.back().id);
        REQUIRE(twins.both([&](EspContext* c) { return espSwapStroke(c, twins.in(c, from.back())); }));
        to.push_back(from.back());
        from.pop_back();
    }
    void fill(const char* layer, float value) {
        note("fill %s with %.2f", layer, double(value));
        keep(twins.make<EspStroke>([&](EspContext* c, EspStroke* out) { return espFillLayer(c, layer, value, out); }));
    }
    void fillAny() {
        const char* layer = layerName();
        fill(layer, below(2) ? in(0, 1) : 1);
    }
    void import() {
        EspLayerDef def = esp::defaults<EspLayerDef>();
        def.surface = twins.surfaces[below(uint32_t(twins.surfaces.size()))];
        def.name = layerName();
        def.space = below(2) ? ESP_LAYER_WALK_UV : ESP_LAYER_TEXELS;
        def.width = def.height = 9;
        std::vector<float> texels(81);
        for (float& texel : texels) texel = below(5) ? 1 : in(0, 1);
        if (def.space == ESP_LAYER_TEXELS) {  // what is there, or a few rows of it other
            REQUIRE(espReadLayer(twins.context(), def.surface, def.name, nullptr, &def.width) == ESP_OK);
            texels.resize(size_t(def.width) * def.width);
            REQUIRE(espReadLayer(twins.context(), def.surface, def.name, texels.data(), &def.width) == ESP_OK);
            def.height = def.width;
            const size_t rows = below(2) * 3;
            const size_t row = below(def.width - 4) * size_t(def.width);
            for (size_t i = row; i < row + rows * def.width; ++i) texels[i] = .2f;
        }
        def.texels = texels.data();
        note("import %s on %x, %u texels wide", def.name, def.surface.id, def.width);
        const EspSurface surface = def.surface;
        keep(twins.make<EspStroke>([&](EspContext* c, EspStroke* out) {
            def.surface = twins.in(c, surface);
            return espImportLayer(c, &def, out);
        }));
    }
    void dropLayer() {
        if (filled_) return;
        EspLayerDef def = esp::defaults<EspLayerDef>();
        def.surface = twins.surfaces[below(uint32_t(twins.surfaces.size()))];
        def.name = layerName();
        note("drop %s from %x", def.name, def.surface.id);
        const EspSurface surface = def.surface;
        twins.both([&](EspContext* c) {
            def.surface = twins.in(c, surface);
            return espSetLayer(c, &def);
        });
    }

    // A parameter of a grammar, and a value for it near its present one.
    EspParamInfo param(uint32_t grammar, float* value) {
        EspParamInfo info{};
        const uint32_t index = below(espParamCount(twins.context(), grammars_[grammar]));
        REQUIRE(espParamInfo(twins.context(), grammars_[grammar], index, &info) == ESP_OK);
        *value = below(3) ? info.initial[0] * in(.6f, 1.4f) : info.initial[0];
        return info;
    }
    void setParam() {
        const uint32_t g = below(2);
        float value = 0;
        const std::string name = param(g, &value).name;
        note("set %s of grammar %u: %g", name.c_str(), g, double(value));
        REQUIRE(twins.both(
            [&](EspContext* c) { return espSetParam(c, twins.in(c, grammars_[g]), name.c_str(), &value, 1); }));
    }
    void seedParam() {
        const EspSeed seed = anySeed();
        if (!seed.id) return;
        float value = 0;
        const std::string name = param(defOf(seed).grammar.id == grammars_[1].id, &value).name;
        const uint32_t count = below(4) ? 1 : 0;
        note("%s %s of seed %x: %g", count ? "give" : "take", name.c_str(), seed.id, double(value));
        REQUIRE(twins.both(
            [&](EspContext* c) { return espSetSeedParam(c, twins.in(c, seed), name.c_str(), &value, count); }));
    }
    void rewrite() {
        const uint32_t g = below(2), edition = below(2) ? 0 : below(5);
        note("write edition %u of grammar %u", edition, g);
        texts_[g] = editionOf(g, edition);
        const EspGrammarDef def = esp::grammarDef("edits", texts_[g]);
        REQUIRE(twins.both([&](EspContext* c) { return espRecompileGrammar(c, twins.in(c, grammars_[g]), &def); }));
    }

    void plant() {
        EspSeedDef def = esp::defaults<EspSeedDef>();
        const EspHit at = place();
        def.grammar = grammars_[below(3) == 0];
        for (int i = 0; i < 3; ++i) def.position[i] = at.position[i], def.direction[i] = in(-1, 1);
        def.number = below(4);
        const EspGrammar grammar = def.grammar;
        const EspSeed made = twins.make<EspSeed>([&](EspContext* c, EspSeed* out) {
            def.grammar = twins.in(c, grammar);
            return espPlant(c, &def, out);
        });
        note("plant %x, number %u, at %.3f %.3f %.3f", made.id, def.number, double(at.position[0]),
             double(at.position[1]), double(at.position[2]));
    }
    void remove() {
        forSeed("remove", [](EspContext* c, EspSeed seed) { return espRemoveSeed(c, seed); });
    }
    void moveSeed() {
        const bool turn = below(2);
        const EspHit at = place();
        const float direction[3] = {in(-1, 1), in(-1, 1), in(-1, 1)};
        forSeed(turn ? "turn" : "move", [&](EspContext* c, EspSeed seed) {
            const EspSeed ours = twins.in(twins.context(), seed);
            return espMoveSeed(c, seed, turn ? defOf(ours).position : at.position, direction);
        });
    }
    // Few numbers, so that plants follow each other under one.
    void number() {
        const uint32_t value = below(4), twin = below(3) ? 0 : below(9);
        forSeed("number", [&](EspContext* c, EspSeed seed) { return espSetSeedNumber(c, seed, value, twin); });
    }
    void prune() {
        if (const uint32_t count = espPrunedCount(twins.context()); count > 0 && below(2)) {
            uint64_t branch = 0;
            REQUIRE(espPrunedAt(twins.context(), below(count), &branch) == ESP_OK);
            note("unprune %llx", (unsigned long long)branch);
            twins.both([&](EspContext* c) { return espPruneBranch(c, branch, 0); });
            return;
        }
        const EspSeed seed = anySeed();
        if (!seed.id) return;
        const EspSeedInfo info = infoOf(seed);
        EspPlantHit hit{};
        for (int i = 0; i < 32 && hit.branch == 0; ++i) {
            const float about = .02f * float(i % 8);
            float from[3], way[3];
            for (int k = 0; k < 3; ++k) {
                from[k] = info.position[k] + .3f * info.normal[k] + in(-about, about);
                way[k] = -info.normal[k];
            }
            (void)espPickPlant(twins.context(), from, way, &hit);
        }
        if (hit.branch == 0) return;
        note("prune %llx at depth %u", (unsigned long long)hit.branch, hit.depth);
        twins.both([&](EspContext* c) { return espPruneBranch(c, hit.branch, 1); });
    }
    void freeze() {
        if (below(4) == 0 && !kept_.empty())
            return forSeed("refreeze", [&](EspContext* c, EspSeed seed) {
                return espFreezeAs(c, seed, kept_.data(), kept_.size());
            });
        EspSeed seed = anySeed();
        for (int i = 0; i < 8 && seed.id && infoOf(seed).frozen; ++i) seed = anySeed();
        for (int i = below(2) * 8; i > 0 && seed.id && !infoOf(seed).frozen; --i) seed = anySeed();
        if (!seed.id) return;
        const int frozen = infoOf(seed).frozen;
        if (frozen) {
            size_t size = 0;
            REQUIRE(espReadFrozen(twins.context(), seed, nullptr, &size) == ESP_OK);
            kept_.resize(size);
            REQUIRE(espReadFrozen(twins.context(), seed, kept_.data(), &size) == ESP_OK);
        }
        const bool did = twins.both([&](EspContext* c) { return espFreezePlant(c, twins.in(c, seed), !frozen); });
        note("%s seed %x%s", frozen ? "thaw" : "freeze", seed.id, did ? "" : ": refused");
    }
    void moveSurface() {
        if (filled_) return;
        const uint32_t which = below(uint32_t(poses_.size())), pose = below(uint32_t(poses_[which].size()));
        note("place surface %u in its pose %u", which, pose);
        REQUIRE(twins.both([&](EspContext* c) {
            return espMoveSurface(c, twins.in(c, twins.surfaces[which]), &poses_[which][pose]);
        }));
    }

    std::vector<uint32_t> theme_;
    std::vector<std::vector<EspTransform>> poses_;
    bool filled_;
    std::vector<EspGrammar> grammars_;
    std::string texts_[2];
    std::vector<EspStroke> done_, undone_;
    std::vector<char> kept_;  // a plant that was frozen once
};

}  // namespace espalier::test
