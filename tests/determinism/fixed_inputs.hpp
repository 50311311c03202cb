#pragma once

// One growth's inputs as a file of plain bytes, so that programs built in different ways grow the very same thing.
// Only for files that this test has just written itself: nothing in them is checked but their length.

#include <fstream>
#include <string>
#include <vector>

#include "runtime/expand/growth.hpp"

namespace espalier::determinismtest {

// Growth is cut here: ivy as the paper prints it never ends by itself.
constexpr uint32_t kMostNodes = 60'000;

struct FixedGrammar {
    std::vector<uint32_t> words;
    std::vector<RuleMapRef> ref;  // one, for words at address 0
};

struct FixedLevel {
    uint32_t size = 0;
    std::vector<Texel> texels;
    std::vector<TexelAux> aux;
    std::vector<uint32_t> crossingHead, crossingRefs;
};

struct FixedInputs {
    std::vector<FixedLevel> levels;
    std::vector<Crossing> crossings;
    std::vector<Chart> charts;
    std::vector<TrianglePlane> triangles;
    std::vector<SurfaceRef> surface;  // one; its addresses mean nothing
    std::vector<FixedGrammar> grammars;
    std::vector<Seed> seeds;
};

// A list of numbers or records, or of structs that fields() knows.
template <class File, class T>
void fields(File& file, std::vector<T>& values) {
    uint64_t count = values.size();
    file.bytes(&count, sizeof count);
    if (!file.good()) return;
    values.resize(count);
    if constexpr (std::is_trivially_copyable_v<T>) {
        file.bytes(values.data(), count * sizeof(T));
    } else {
        for (T& value : values) fields(file, value);
    }
}
template <class File>
void fields(File& file, FixedGrammar& g) {
    fields(file, g.words);
    fields(file, g.ref);
}
template <class File>
void fields(File& file, FixedLevel& l) {
    file.bytes(&l.size, sizeof l.size);
    fields(file, l.texels);
    fields(file, l.aux);
    fields(file, l.crossingHead);
    fields(file, l.crossingRefs);
}
template <class File>
void fields(File& file, FixedInputs& in) {
    fields(file, in.levels);
    fields(file, in.crossings);
    fields(file, in.charts);
    fields(file, in.triangles);
    fields(file, in.surface);
    fields(file, in.grammars);
    fields(file, in.seeds);
}

struct Writer {
    std::ofstream stream;
    bool good() const { return bool(stream); }
    void bytes(void* at, size_t count) { stream.write(static_cast<const char*>(at), std::streamsize(count)); }
};
struct Reader {
    std::ifstream stream;
    bool good() const { return bool(stream); }
    void bytes(void* at, size_t count) { stream.read(static_cast<char*>(at), std::streamsize(count)); }
};

inline bool writeInputs(FixedInputs& in, const std::string& path) {
    Writer file{std::ofstream(path, std::ios::binary)};
    fields(file, in);
    file.stream.close();
    return file.good();
}
inline bool readInputs(FixedInputs& in, const std::string& path) {
    Reader file{std::ifstream(path, std::ios::binary)};
    fields(file, in);
    return file.good() && in.surface.size() == 1 && !in.levels.empty() && !in.seeds.empty();
}

// The grammar's record for its words at `address`.
inline RuleMapRef grammarAt(const FixedGrammar& g, uint64_t address) {
    RuleMapRef ref = g.ref.at(0);
    auto move = [address](auto& buffer) {
        using Pointer = decltype(buffer.v);
        buffer.v = reinterpret_cast<Pointer>(reinterpret_cast<uint64_t>(buffer.v) + address);
    };
    move(ref.symbols);
    move(ref.rules);
    move(ref.successors);
    move(ref.extrudes);
    move(ref.terminals);
    move(ref.code);
    move(ref.sites);
    return ref;
}

// The surface's record for arrays that lie where `placed` puts them: it is called with each array and returns its
// address.
template <class Place>
SurfaceRef surfaceAt(FixedInputs& in, Place placed) {
    SurfaceRef ref = in.surface.at(0);
    auto set = [&placed](auto& buffer, auto& values) {
        buffer.v = reinterpret_cast<decltype(buffer.v)>(placed(values));
    };
    for (size_t i = 0; i < in.levels.size(); ++i) {
        set(ref.levels[i].texels, in.levels[i].texels);
        set(ref.levels[i].aux, in.levels[i].aux);
        set(ref.levels[i].crossingHead, in.levels[i].crossingHead);
        set(ref.levels[i].crossingRefs, in.levels[i].crossingRefs);
    }
    set(ref.crossings, in.crossings);
    set(ref.charts, in.charts);
    set(ref.triangles, in.triangles);
    return ref;
}

}  // namespace espalier::determinismtest
