// RuleMap <-> bytes: header (magic, version, content hash, checksum of the rest), metadata, words. Everything read
// is bounded by the bytes there are; the checksum finds damage, rule_map_verify.cpp finds malice.
#include <bit>

#include "runtime/core/hash.hpp"
#include "runtime/grammar/rule_map_layout.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMagic = 0x4D525345u;  // "ESRM"
constexpr uint32_t kVersion = 9;
constexpr size_t kHeaderBytes = 24;
static_assert(std::endian::native == std::endian::little);

class Writer {
  public:
    std::vector<uint8_t> bytes;
    template <class T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto* p = reinterpret_cast<const uint8_t*>(&value);
        bytes.insert(bytes.end(), p, p + sizeof(T));
    }
    void put(const std::string& s) {
        put(static_cast<uint32_t>(s.size()));
        bytes.insert(bytes.end(), s.begin(), s.end());
    }
    template <class T>
    void putAll(const std::vector<T>& all) {
        put(static_cast<uint32_t>(all.size()));
        for (const T& x : all) put(x);
    }
};

class Reader {
  public:
    explicit Reader(std::span<const uint8_t> bytes) : bytes_(bytes) {}
    bool good() const { return good_; }
    bool atEnd() const { return at_ == bytes_.size(); }
    template <class T>
    T get() {
        T value{};
        if (!take(sizeof(T))) return value;
        std::memcpy(static_cast<void*>(&value), &bytes_[at_ - sizeof(T)], sizeof(T));
        return value;
    }
    std::string text() {
        uint32_t n = get<uint32_t>();
        if (!take(n)) return {};
        return {reinterpret_cast<const char*>(bytes_.data()) + at_ - n, n};
    }
    // A count of things of which each takes at least `bytesEach` bytes.
    uint32_t count(size_t bytesEach) {
        uint32_t n = get<uint32_t>();
        if (n > (bytes_.size() - at_) / bytesEach) good_ = false;
        return good_ ? n : 0;
    }
    template <class T>
    std::vector<T> all() {
        std::vector<T> result(count(sizeof(T)));
        for (T& x : result) x = get<T>();
        return result;
    }

  private:
    bool take(size_t n) {
        good_ = good_ && n <= bytes_.size() - at_;
        at_ += good_ ? n : 0;
        return good_;
    }
    std::span<const uint8_t> bytes_;
    size_t at_ = 0;
    bool good_ = true;
};

uint64_t checksum(std::span<const uint8_t> bytes) {
    return hashBytes(std::as_bytes(bytes));
}

}  // namespace

std::vector<uint8_t> RuleMap::save() const {
    RuleMap plain = *this;
    for (ParamInfo& p : plain.params_) std::copy(p.standard, p.standard + 3, p.value);
    RuleMapAccess::evaluate(plain);
    Writer body;
    body.put(plain.startSymbol_);
    body.put(plain.kind_);
    body.put(static_cast<uint32_t>(params_.size()));
    for (const ParamInfo& p : plain.params_) {
        body.put(p.name);
        body.put(p.unit);
        body.put(p.label);
        body.put(p.kind);
        body.put(p.minimum);
        body.put(p.maximum);
        body.put(p.standard);
        body.put(p.slot);
    }
    body.put(static_cast<uint32_t>(contexts_.size()));
    for (const ContextInfo& c : plain.contexts_) {
        body.put(c.name);
        body.put(c.label);
        body.put(c.fill);
    }
    body.put(static_cast<uint32_t>(fields_.size()));
    for (const FieldInfo& f : plain.fields_) {
        body.put(f.name);
        body.put(f.label);
        body.put(f.symmetry);
        body.put(static_cast<uint32_t>(f.curvature));
        body.put(static_cast<uint32_t>(f.jumps));
    }
    body.put(static_cast<uint32_t>(symbols_.size()));
    for (const SymbolInfo& s : plain.symbols_) {
        body.put(s.name);
        body.put(s.argCount);
    }
    body.put(static_cast<uint32_t>(warnings_.size()));
    for (const Diagnostic& d : plain.warnings_) {
        body.put(d.file);
        body.put(d.line);
        body.put(d.column);
        body.put(d.rule);
        body.put(d.message);
    }
    body.put(sections_);
    body.putAll(plain.words_);
    body.putAll(plain.uniformCode_);
    body.putAll(plain.uniforms_);
    body.putAll(plain.patches_);
    body.put(plain.avoid_);
    body.put(plain.width_);

    Writer file;
    file.put(kMagic);
    file.put(kVersion);
    file.put(contentHash_);
    file.put(checksum(body.bytes));
    file.bytes.insert(file.bytes.end(), body.bytes.begin(), body.bytes.end());
    return std::move(file.bytes);
}

Result<RuleMap> RuleMap::load(std::span<const uint8_t> bytes, std::string_view fileName) {
    auto refuse = [&](const std::string& why) { return Failure(fileName, "not a usable rule map: " + why); };
    if (bytes.size() < kHeaderBytes) return refuse("it is too short");
    Reader header(bytes.first(kHeaderBytes));
    if (header.get<uint32_t>() != kMagic) return refuse("it doesn't begin like one");
    if (header.get<uint32_t>() != kVersion) return refuse("it is of another version");
    RuleMap map;
    map.contentHash_ = header.get<uint64_t>();
    std::span<const uint8_t> rest = bytes.subspan(kHeaderBytes);
    if (header.get<uint64_t>() != checksum(rest)) return refuse("its checksum is wrong");

    Reader r(rest);
    map.startSymbol_ = r.get<uint32_t>();
    map.kind_ = static_cast<GrammarKind>(r.get<uint32_t>());
    for (uint32_t i = r.count(40); i > 0 && r.good(); --i) {
        ParamInfo p;
        p.name = r.text();
        p.unit = r.text();
        p.label = r.text();
        p.kind = static_cast<ParamKind>(r.get<uint32_t>());
        p.minimum = r.get<float>();
        p.maximum = r.get<float>();
        for (float& x : p.standard) x = r.get<float>();
        p.slot = r.get<uint32_t>();
        std::copy(p.standard, p.standard + 3, p.value);
        map.params_.push_back(std::move(p));
    }
    for (uint32_t i = r.count(12); i > 0 && r.good(); --i) {
        std::string name = r.text();
        std::string label = r.text();
        map.contexts_.push_back({name, label, r.get<float>()});
    }
    for (uint32_t i = r.count(20); i > 0 && r.good(); --i) {
        FieldInfo f;
        f.name = r.text();
        f.label = r.text();
        f.symmetry = r.get<uint32_t>();
        f.curvature = r.get<uint32_t>() != 0;
        f.jumps = r.get<uint32_t>() != 0;
        map.fields_.push_back(std::move(f));
    }
    for (uint32_t i = r.count(8); i > 0 && r.good(); --i) {
        std::string name = r.text();
        map.symbols_.push_back({name, r.get<uint32_t>(), true});
    }
    for (uint32_t i = r.count(20); i > 0 && r.good(); --i) {
        Diagnostic d;
        d.warning = true;
        d.file = r.text();
        d.line = r.get<int>();
        d.column = r.get<int>();
        d.rule = r.text();
        d.message = r.text();
        map.warnings_.push_back(std::move(d));
    }
    for (Section& s : map.sections_) s = r.get<Section>();
    map.words_ = r.all<uint32_t>();
    map.uniformCode_ = r.all<CodeWord>();
    map.uniforms_ = r.all<Uniform>();
    map.patches_ = r.all<Patch>();
    map.avoid_ = r.get<FixedLength>();
    map.width_ = r.get<FixedLength>();
    if (!r.good() || !r.atEnd()) return refuse("its parts don't add up");
    std::string wrong = RuleMapAccess::verify(map);
    if (!wrong.empty()) return refuse("it is damaged in: " + wrong);
    RuleMapAccess::evaluate(map);
    return map;
}

}  // namespace espalier
