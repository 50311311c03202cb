#pragma once

// Two contexts that are told the same through the public interface: one grows what edits concern, the other all anew
// each time. A third can be made from nothing but what the first says of itself.

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tools/bake/bake.hpp"

namespace espalier::test {

// A surface's file, for as long as this lives.
struct BakedFile {
    std::string path;

    explicit BakedFile(const Model& model, uint32_t resolution = 128) {
        BakeOptions options;
        options.resolution = resolution;
        auto baked = bake(model, options);
        REQUIRE(baked);
        static int number = 0;
        path = (std::filesystem::temp_directory_path() /
                ("espalier_twins_" + std::to_string(getpid()) + "_" + std::to_string(number++) + ".glb"))
                   .string();
        REQUIRE(writeSurface(baked->surface, path));
    }
    ~BakedFile() { std::filesystem::remove(path); }
    BakedFile(const BakedFile&) = delete;
    BakedFile& operator=(const BakedFile&) = delete;
};

inline EspTransform standing(float x, float y, float z, float scale = 1, float turn = 0) {
    const float c = scale * std::cos(turn), s = scale * std::sin(turn);
    return {{{c, 0, s, x}, {0, scale, 0, y}, {-s, 0, c, z}}};
}

struct Ground {
    std::string file;
    EspTransform place;
};

class Twins {
  public:
    // shadersOnly: of the one that grows what edits concern. The other is native where it can be.
    Twins(const std::vector<Ground>& grounds, bool shadersOnly) {
        for (EspContext*& context : all_) context = created();
        grow_[0].shadersOnly = shadersOnly;
        both([&](EspContext* c) { return espSetGrow(c, &grow_[c == all_[1]]); });
        for (const Ground& ground : grounds) {
            files_.push_back(ground.file);
            places.push_back(ground.place);
            surfaces.push_back(make<EspSurface>([&](EspContext* c, EspSurface* out) {
                return espLoadSurface(c, files_.back().c_str(), &places.back(), out);
            }));
        }
    }
    ~Twins() {
        for (EspContext* context : all_) espDestroy(context);
    }
    Twins(const Twins&) = delete;
    Twins& operator=(const Twins&) = delete;

    // Tells both; false: both refused.
    template <class Call>
    bool both(Call&& call) {
        const EspResult first = call(all_[0]), second = call(all_[1]);
        REQUIRE(first == second);
        if (first != ESP_OK && first != ESP_INVALID_ARGUMENT) FAIL(std::string(espLastError(all_[0])));
        return first == ESP_OK;
    }
    // Makes something in both. Returns its id in the first. None: both refused.
    template <class Id, class Call>
    Id make(Call&& call) {
        Id ids[2] = {};
        both([&](EspContext* c) { return call(c, &ids[c == all_[1]]); });
        for (int i = 0; i < 2; ++i) learn(all_[i], ids[i].id);
        REQUIRE(ids[1].id == in(all_[1], ids[0]).id);
        return ids[0];
    }
    // The same thing's id in another context: ids differ by the contexts' numbers.
    template <class Id>
    Id in(EspContext* c, Id id) const {
        if (id.id != 0) id.id = (id.id & ~kContextBits) | numbers_.at(c);
        return id;
    }
    // Grows both; whether they are the same then.
    bool alike() {
        grow_[1].maxDepth ^= 1;  // another limit: all anew
        must(all_[1], espSetGrow(all_[1], &grow_[1]));
        for (int i = 0; i < 2; ++i) grown_[i] = grownOf(all_[i]);
        return same(grown_[0], grown_[1]);
    }
    EspContext* context() const { return all_[0]; }
    const EspStats& stats() const { return grown_[0]; }
    void tell() const {
        tell("edits", grown_[0]);
        tell("all anew", grown_[1]);
    }

    // A context that is given all that the first one says of itself grows the same. For scenes whose surfaces haven't
    // moved, and whose layers are painted on all of them.
    bool againFromNothing(const std::vector<std::pair<EspGrammar, std::string>>& grammars) {
        EspContext* fresh = created();
        for (size_t i = 0; i < files_.size(); ++i) {
            EspSurface surface{};
            must(fresh, espLoadSurface(fresh, files_[i].c_str(), &places[i], &surface));
            learn(fresh, surface.id);
            REQUIRE(surface.id == in(fresh, surfaces[i]).id);
        }
        for (const auto& [grammar, text] : grammars) giveGrammar(fresh, grammar, text);
        for (uint32_t i = 0; i < espPaintedLayerCount(context()); ++i)
            giveLayer(fresh, espPaintedLayerName(context(), i));
        for (uint32_t i = 0; i < espSeedCount(context()); ++i) giveSeed(fresh, i, grammars);
        for (uint32_t i = 0; i < espPrunedCount(context()); ++i) {
            uint64_t branch = 0;
            must(context(), espPrunedAt(context(), i, &branch));
            must(fresh, espPruneBranch(fresh, branch, 1));
        }
        const EspStats stats = grownOf(fresh);
        const bool found = same(grown_[0], stats);
        if (!found) tell("edits", grown_[0]), tell("from nothing", stats);
        espDestroy(fresh);
        numbers_.erase(fresh);
        return found;
    }

    std::vector<EspSurface> surfaces;
    std::vector<EspTransform> places;  // as they were loaded

  private:
    static constexpr uint32_t kContextBits = 0xFC000000u;  // of an id: the number of its context
    void learn(EspContext* c, uint32_t id) {
        if (id != 0) numbers_[c] = id & kContextBits;
    }
    static EspContext* created() {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = [](void*, EspLogLevel, const char*) {};
        EspContext* context = nullptr;
        if (espCreate(ESP_VERSION, &def, &context) != ESP_OK) FAIL(std::string(espLastError(nullptr)));
        return context;
    }
    static void must(EspContext* context, EspResult result) {
        if (result != ESP_OK) FAIL(std::string(espLastError(context)));
    }
    static EspStats grownOf(EspContext* context) {
        must(context, espUpdate(context));
        EspStats stats{};
        must(context, espReadStats(context, &stats));
        return stats;
    }
    static bool same(const EspStats& a, const EspStats& b) {
        return a.hash == b.hash && a.nodes == b.nodes && a.leaves == b.leaves && a.chunks == b.chunks &&
               a.branches == b.branches && a.seeds == b.seeds && a.stopped == b.stopped && a.deadEnds == b.deadEnds &&
               a.contacts == b.contacts && a.overflow == 0 && b.overflow == 0;
    }
    static void tell(const char* name, const EspStats& s) {
        std::printf(
            "  %-12s hash %016llx, %u seeds, %llu nodes, %llu leaves, %u chunks, %u branches, %u stopped, "
            "%u dead ends, %u contacts\n",
            name, (unsigned long long)s.hash, s.seeds, (unsigned long long)s.nodes, (unsigned long long)s.leaves,
            s.chunks, s.branches, s.stopped, s.deadEnds, s.contacts);
    }
    void giveGrammar(EspContext* fresh, EspGrammar grammar, const std::string& text) {
        const EspGrammarDef def = esp::grammarDef("edits", text);
        EspGrammar made{};
        must(fresh, espCompileGrammar(fresh, &def, &made));
        REQUIRE(made.id == in(fresh, grammar).id);
        for (uint32_t i = 0; i < espParamCount(context(), grammar); ++i) {
            EspParamInfo info{};
            must(context(), espParamInfo(context(), grammar, i, &info));
            must(fresh, espSetParam(fresh, made, info.name, info.value, 1));
        }
    }
    void giveLayer(EspContext* fresh, const char* name) {
        for (EspSurface surface : surfaces) {
            EspLayerDef def = esp::defaults<EspLayerDef>();
            must(context(), espReadLayer(context(), surface, name, nullptr, &def.width));
            std::vector<float> texels(size_t(def.width) * def.width);
            must(context(), espReadLayer(context(), surface, name, texels.data(), &def.width));
            def.surface = in(fresh, surface);
            def.name = name;
            def.space = ESP_LAYER_TEXELS;
            def.texels = texels.data();
            def.height = def.width;
            must(fresh, espSetLayer(fresh, &def));
        }
    }
    void giveSeed(EspContext* fresh, uint32_t index, const std::vector<std::pair<EspGrammar, std::string>>& grammars) {
        EspSeed seed{}, made{};
        EspSeedInfo info{};
        must(context(), espSeedAt(context(), index, &seed));
        must(context(), espSeedInfo(context(), seed, &info));
        EspSeedDef def{};
        must(context(), espSeedDef(context(), seed, &def));
        const EspGrammar own = def.grammar;
        def.grammar = in(fresh, own);
        must(fresh, espPlant(fresh, &def, &made));
        for (const auto& [grammar, text] : grammars)
            for (uint32_t i = 0; grammar.id == own.id && i < espParamCount(context(), grammar); ++i) {
                EspParamInfo param{};
                must(context(), espParamInfo(context(), grammar, i, &param));
                float value[3];
                uint32_t count = 0;
                must(context(), espSeedParam(context(), seed, param.name, value, &count));
                if (count > 0) must(fresh, espSetSeedParam(fresh, made, param.name, value, count));
            }
        if (!info.frozen) return;
        size_t size = 0;
        must(context(), espReadFrozen(context(), seed, nullptr, &size));
        std::vector<char> bytes(size);
        must(context(), espReadFrozen(context(), seed, bytes.data(), &size));
        must(fresh, espFreezeAs(fresh, made, bytes.data(), size));
    }

    EspContext* all_[2] = {};
    EspGrowDef grow_[2] = {esp::defaults<EspGrowDef>(), esp::defaults<EspGrowDef>()};
    EspStats grown_[2] = {};
    std::vector<std::string> files_;
    std::map<EspContext*, uint32_t> numbers_;  // kContextBits of each one's ids
};

}  // namespace espalier::test
