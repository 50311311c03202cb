#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/core/result.hpp"
#include "shaders/shared/rule_map.h"
#include "shaders/shared/terminal_meshes.h"

// Grammar text -> rule map. The language is described in docs/grammar.md, the map in shaders/shared/rule_map.h.
namespace espalier {

// What a grammar makes: plants walk over surfaces (Buron 2015), roofs stand on houses (Buron 2013), patterns are placed
// on surfaces along fields (Li 2011).
enum class GrammarKind : uint32_t { plants, roofs, patterns };

enum class ParamKind : uint32_t { number, toggle, colour };

// A slider of the editor. value: what it stands at; toggles are 0 or 1; colours use all three, linear 0..1.
struct ParamInfo {
    std::string name, unit, label;
    ParamKind kind = ParamKind::number;
    float minimum = 0, maximum = 1;
    float standard[3] = {};  // the text's default
    float value[3] = {};
    uint32_t slot = 0;  // first bit in the masks of parameters
};

inline uint32_t numbersOf(const ParamInfo& param) {
    return param.kind == ParamKind::colour ? 3 : 1;
}

// A layer of colours is three layers: its name with each of these behind it.
inline constexpr const char* kChannels[3] = {".r", ".g", ".b"};

// A painted layer that the grammar reads. fill: its value where nothing is painted.
struct ContextInfo {
    std::string name, label;
    float fill = 1;
};

// A tangent field that a grammar of patterns reads. symmetry: 1 vectors, 2 lines, as of a symmetric tensor, and so on.
struct FieldInfo {
    std::string name, label;
    uint32_t symmetry = 2;
    bool curvature = false;  // the surface's own; else one that is designed
    bool jumps = false;      // of the first: a way that meets a singularity jumps over it as in Li 2011 §4.3
};

// Of the statements `width` and `avoid`: metres, 0 without one.
struct FixedLength {
    uint32_t uniform = kNoIndex;  // of the results that follow from parameters; kNoIndex: it is constant
    float value = 0;
    bool operator==(const FixedLength&) const = default;
};

struct SymbolInfo {
    std::string name;
    uint32_t argCount = 0;
    bool grows = false;  // a seed may start with it; of plants: it reaches Marching
};

// A mesh that Shape("name") may ask for. bark: bent along spans; else set on them as loose instances.
struct TerminalMesh {
    std::string name;
    bool bark = false;
};

// The meshes there are by default, by TerminalRecord::mesh (terminal_meshes.h).
std::vector<TerminalMesh> standardTerminalMeshes();

// Text of an included file, or why there is none. `name` is relative to the main file's folder.
using IncludeReader = std::function<Result<std::string>(const std::string& name)>;
// Reads what placeBeside (runtime/core/file_beside.hpp) allows, so that a grammar from elsewhere can't read any file.
IncludeReader includesBeside(const std::filesystem::path& file);

inline constexpr size_t kMaxGrammarBytes = 1 << 20;  // of a text, and of each that it includes

struct CompileOptions {
    std::string fileName = "grammar";  // for diagnostics
    IncludeReader readInclude;         // none: includes are refused
    std::vector<TerminalMesh> meshes = standardTerminalMeshes();
    std::vector<TerminalMesh> roofMeshes;  // for grammars of roofs; empty: `meshes`
    std::vector<TerminalMesh> pieces;      // for grammars of patterns; empty: `meshes`

    const std::vector<TerminalMesh>& meshesOfRoofs() const { return roofMeshes.empty() ? meshes : roofMeshes; }
    const std::vector<TerminalMesh>& meshesOfPatterns() const { return pieces.empty() ? meshes : pieces; }
};

// How what has grown by one rule map differs from what grows by another.
struct RuleChanges {
    bool all = false;       // nothing is known to be the same
    uint32_t uses = 0;      // chunks that have one of these bits in Chunk::uses derive anew, others stand
    bool extrudes = false;  // what is drawn on spans, bark and leaves, is another
};

// A compiled grammar with its parameters at some setting. A value type; calls on one object from one thread.
class RuleMap {
  public:
    const std::vector<ParamInfo>& params() const { return params_; }
    const std::vector<ContextInfo>& contexts() const { return contexts_; }
    const std::vector<SymbolInfo>& symbols() const { return symbols_; }
    std::optional<uint32_t> findSymbol(std::string_view name) const;
    std::optional<uint32_t> findParam(std::string_view name) const;
    std::optional<uint32_t> findContext(std::string_view name) const;
    // The predecessor of the first growing rule of the main text.
    uint32_t startSymbol() const { return startSymbol_; }
    GrammarKind kind() const { return kind_; }
    // Its symbols replace shapes on houses; seeds can't start with them.
    bool roofs() const { return kind_ == GrammarKind::roofs; }
    bool patterns() const { return kind_ == GrammarKind::patterns; }
    // Of grammars of patterns, at most kMaxFields; the first guides T.
    const std::vector<FieldInfo>& fields() const { return fields_; }
    const std::vector<Diagnostic>& warnings() const { return warnings_; }

    // Sets a parameter, limited to its range (colours: 0..1; NaN: left as it was), and works out what depends
    // on it. values: 1 number, or 3 for a colour (missing ones stay). Returns the mask of slots that changed.
    uint32_t setParam(uint32_t param, std::span<const float> values);

    // What the statement `width` says with the parameters as they stand: metres, finite, at least 0; 0 without one.
    // Growth takes the surface as coarse as suits shapes of this width (GrowthInputs::widths).
    float width() const { return width_.value; }
    // The same of `avoid`: how far stems stay away from other stems (GrowthInputs::avoid); 0: they don't.
    float avoid() const { return avoid_.value; }

    // The shipped meshes of plants' terminals that it draws: bit i, of kMesh... i.
    uint32_t terminalMeshes() const;
    // Draws another mesh in place of a shipped one from now on: a look of its own (kOwnMeshes), or the shipped one
    // again.
    void setTerminalMesh(uint32_t shipped, uint32_t mesh);

    // All that its rules and terminals ask of a place: kInput... bits.
    uint32_t inputs() const;

    // What a device needs: a run of 32-bit words to be copied to an address that is a multiple of 16. Their number
    // is fixed; their content changes with setParam only.
    std::span<const uint32_t> words() const;
    // Hash of text, includes, meshes and compiler version; parameters don't enter.
    uint64_t contentHash() const { return contentHash_; }

    // The same plants and roofs grow from both, whatever their parameters are set to later: the texts differ in
    // comments, layout, labels and defaults alone, and their parameters now stand at the same values.
    bool growsAs(const RuleMap& other) const;
    // What grows otherwise than by `before`, with the parameters of both as they stand. Of plants only, others: `all`.
    RuleChanges changesFrom(const RuleMap& before) const;

    // The map's record for words that lie at `address` (of a device, or of words().data() for the CPU, as long as
    // this object lives unchanged in place). layerOf is the identity: the caller binds layers by name.
    RuleMapRef refAt(uint64_t address) const;
    RuleMapRef ref() const { return refAt(reinterpret_cast<uint64_t>(words().data())); }

    // The whole as bytes, parameters at their defaults, and back. Loading verifies every index, range and
    // operation, so that no file can make the interpreter leave its bounds; a failure names the file.
    std::vector<uint8_t> save() const;
    static Result<RuleMap> load(std::span<const uint8_t> bytes, std::string_view fileName);

  private:
    friend struct RuleMapAccess;
    uint64_t contentHash_ = 0;
    uint32_t startSymbol_ = 0;
    std::vector<ParamInfo> params_;
    std::vector<ContextInfo> contexts_;
    std::vector<FieldInfo> fields_;
    std::vector<SymbolInfo> symbols_;
    std::vector<Diagnostic> warnings_;
    std::vector<uint32_t> words_;
    struct Section {
        uint32_t offset = 0, count = 0;  // words; records
    };
    static constexpr uint32_t kSections = 12;
    GrammarKind kind_ = GrammarKind::plants;
    Section sections_[kSections];
    // What follows from parameters: code that the host runs, its results, and the words that take them.
    struct Uniform {
        CodeRange code;
        Value value;
    };
    struct Patch {
        uint32_t uniform, word;
    };
    std::vector<CodeWord> uniformCode_;
    std::vector<Uniform> uniforms_;
    std::vector<Patch> patches_;
    FixedLength width_, avoid_;
};

// Compiles a text. Never throws, hangs or crashes on any bytes; all mistakes found are in the failure.
// cacheFolder: if not empty, the map is kept there under its content hash (made if need be; a cache that can't be
// read or written is no failure, the map is compiled then and a warning added).
Result<RuleMap> compileGrammar(std::string_view text, const CompileOptions& options = {},
                               const std::filesystem::path& cacheFolder = {});

// Reads and compiles a file, likewise; includes are looked for beside it. Its name and how includes are read are set
// here.
Result<RuleMap> compileGrammarFile(const std::filesystem::path& file, CompileOptions options = {},
                                   const std::filesystem::path& cacheFolder = {});

}  // namespace espalier
