// What the generator writes: reads and writes of whole records in pairs of words, parts of records, records from
// texels, records over words of any memory, and where words lie.
#include <sstream>
#include <stdexcept>

#include "tools/records/records.hpp"

namespace espalier::records {
namespace {

struct Writer {
    const Records& all;
    const Header& header;
    std::ostringstream out;

    const Record& record(const std::string& name, uint32_t line) const {
        const auto it = all.structs.find(name);
        if (it == all.structs.end())
            throw std::runtime_error(header.path + ":" + std::to_string(line) + ": there is no record " + name +
                                     " whose members are all numbers, addresses or records");
        return it->second;
    }
    const std::string& bufferOf(const std::string& name, uint32_t line) const {
        const auto it = all.buffers.find(name);
        if (it == all.buffers.end())
            throw std::runtime_error(header.path + ":" + std::to_string(line) + ": there is no BUFFER of " + name);
        return it->second;
    }

    // The value of a field from expressions of words.
    template <class Word>
    static std::string fromWords(const Field& f, const Word& word) {
        switch (f.scalar) {
            case Scalar::float32:
                return "uintBitsToFloat(" + word(f.word) + ")";
            case Scalar::int32:
                return "int(" + word(f.word) + ")";
            case Scalar::boolean:
                return word(f.word) + " != 0u";
            case Scalar::uint64:
                return "packUint2x32(uvec2(" + word(f.word) + ", " + word(f.word + 1) + "))";
            case Scalar::address:
                return f.type + "(packUint2x32(uvec2(" + word(f.word) + ", " + word(f.word + 1) + ")))";
            default:
                return word(f.word);
        }
    }
    // Word `word` of the record that `variable` holds.
    static std::string toWord(const Record& r, uint32_t word, const std::string& variable = "r") {
        for (const Field& f : r.fields) {
            const bool wide = f.scalar == Scalar::uint64 || f.scalar == Scalar::address;
            if (word < f.word || word >= f.word + (wide ? 2 : 1)) continue;
            const std::string value = variable + "." + f.path;
            if (wide) return "unpackUint2x32(uint64_t(" + value + "))." + (word == f.word ? "x" : "y");
            if (f.scalar == Scalar::float32) return "floatBitsToUint(" + value + ")";
            if (f.scalar == Scalar::int32) return "uint(" + value + ")";
            if (f.scalar == Scalar::boolean) return "(" + value + " ? 1u : 0u)";
            return value;
        }
        return "0u";  // between members
    }
    static std::string pairWord(uint32_t word) {
        return "w" + std::to_string(word / 2) + (word % 2 == 0 ? ".x" : ".y");
    }

    void readPairs(const std::string& name, const std::string& buffer, const Record& whole,
                   const std::vector<Field>& fields) {
        out << name << " read" << name << "(" << buffer << " from, uint at) {\n"
            << "    PairBuf pairs = PairBuf(uint64_t(from) + uint64_t(at) * " << whole.words * 4 << "ul);\n";
        std::vector<bool> used(whole.words / 2 + 1);
        for (const Field& f : fields) {
            used[f.word / 2] = true;
            if (f.scalar == Scalar::uint64 || f.scalar == Scalar::address) used[(f.word + 1) / 2] = true;
        }
        for (uint32_t i = 0; i < used.size(); ++i)
            if (used[i]) out << "    uvec2 w" << i << " = unpackUint2x32(pairs.v[" << i << "]);\n";
        assign(name, fields, pairWord);
    }
    template <class Word>
    void assign(const std::string& name, const std::vector<Field>& fields, const Word& word) {
        out << "    " << name << " r;\n";
        for (const Field& f : fields) out << "    r." << f.path << " = " << fromWords(f, word) << ";\n";
        out << "    return r;\n}\n";
    }
    void writePairs(const Record& r, const std::string& buffer) {
        out << "void write" << r.name << "(" << buffer << " buf, uint at, " << r.name << " r) {\n"
            << "    uint64_t address = uint64_t(buf) + uint64_t(at) * " << r.words * 4 << "ul;\n";
        const auto pair = [&](uint32_t low) {
            return "packUint2x32(uvec2(" + toWord(r, low) + ", " + toWord(r, low + 1) + "))";
        };
        if (r.words % 2 == 0) {
            out << "    PairBuf to = PairBuf(address);\n";
            for (uint32_t i = 0; i < r.words; i += 2) out << "    to.v[" << i / 2 << "] = " << pair(i) << ";\n";
        } else {  // pairs begin at every second record's first word, and at the others' second
            out << "    bool odd = (at & 1u) != 0u;\n    PairBuf to = PairBuf(address + (odd ? 4ul : 0ul));\n";
            for (uint32_t i = 0; i + 1 < r.words; i += 2)
                out << "    to.v[" << i / 2 << "] = odd ? " << pair(i + 1) << " : " << pair(i) << ";\n";
            out << "    UintBuf rest = UintBuf(address + (odd ? 0ul : " << (r.words - 1) * 4 << "ul));\n"
                << "    rest.v[0] = odd ? " << toWord(r, 0) << " : " << toWord(r, r.words - 1) << ";\n";
        }
        out << "}\n";
    }

    void access(const Wish& wish) {
        const Record& r = record(wish.record, wish.line);
        const std::string& buffer = bufferOf(wish.record, wish.line);
        out << "#ifdef __cplusplus\n"
            << "inline const " << r.name << "& read" << r.name << "(" << buffer
            << " from, uint at) { return from.v[at]; }\n"
            << "inline void write" << r.name << "(" << buffer << " to, uint at, const " << r.name
            << "& r) { to.v[at] = r; }\n#else\n";
        if (r.words % 2 == 0) {
            readPairs(r.name, buffer, r, r.fields);
        } else {
            out << r.name << " read" << r.name << "(" << buffer << " from, uint at) { return from.v[at]; }\n";
        }
        writePairs(r, buffer);
        out << "#endif\n";
    }
    // Fields of `part`, each with the place of what it takes of `whole`.
    void part(const Wish& wish) {
        const Record &part = record(wish.record, wish.line), &whole = record(wish.whole, wish.line);
        const std::string& buffer = bufferOf(wish.whole, wish.line);
        std::vector<Field> fields;
        out << "#ifdef __cplusplus\ninline " << part.name << " read" << part.name << "(" << buffer
            << " from, uint at) {\n    const " << whole.name << "& w = from.v[at];\n    " << part.name << " r;\n";
        for (const Member& m : part.members) {
            const uint32_t word = wordOf(whole, m, wish.line);
            for (const Field& f : part.fields) {
                if (f.word < m.word || f.word >= m.word + m.words) continue;
                Field moved = f;
                moved.word = word + (f.word - m.word);
                fields.push_back(moved);
                out << "    r." << f.path << " = w." << fieldAt(whole, moved.word, wish.line).path << ";\n";
            }
        }
        out << "    return r;\n}\n#else\n";
        readPairs(part.name, buffer, whole, fields);
        out << "#endif\n";
    }
    const Field& fieldAt(const Record& whole, uint32_t word, uint32_t line) const {
        for (const Field& f : whole.fields)
            if (f.word == word) return f;
        throw std::runtime_error(header.path + ":" + std::to_string(line) + ": nothing of " + whole.name +
                                 " begins at word " + std::to_string(word));
    }
    uint32_t wordOf(const Record& whole, const Member& m, uint32_t line) const {
        for (const Field& f : whole.fields)
            if (f.path == m.source || f.path.starts_with(m.source + ".") || f.path.starts_with(m.source + "["))
                return f.word;
        throw std::runtime_error(header.path + ":" + std::to_string(line) + ": " + whole.name + " has no " + m.source);
    }

    void offsets(const Wish& wish) {
        const Record& r = record(wish.record, wish.line);
        for (const Member& m : r.members) out << "CONST_UINT(k" << r.name << "_" << m.name << ", " << m.word << "u);\n";
        out << "CONST_UINT(k" << r.name << "_words, " << r.words << "u);\n";
    }

    // From texels of four words: a function of them, and a macro that fetches them by FETCH(view, index).
    void texels(const Wish& wish) {
        const Record& r = record(wish.record, wish.line);
        const uint32_t count = r.words / 4;
        if (r.words % 4 != 0)
            throw std::runtime_error(header.path + ":" + std::to_string(wish.line) + ": " + r.name +
                                     " isn't a whole number of texels");
        out << "#ifndef __cplusplus\n" << r.name << " texels" << r.name << "(";
        for (uint32_t i = 0; i < count; ++i) out << (i ? ", " : "") << "uvec4 t" << i;
        out << ") {\n";
        assign(r.name, r.fields, [](uint32_t word) { return "t" + std::to_string(word / 4) + "." + "xyzw"[word % 4]; });
        out << "#define FETCH_" << r.name << "(FETCH, view, i) texels" << r.name << "(";
        for (uint32_t i = 0; i < count; ++i)
            out << (i ? ", " : "") << "FETCH(view, " << count << "u * (i) + " << i << "u)";
        out << ")\n#endif\n";
    }

    // Statements over words that a macro reaches: FILL_X(r, WORD, at) reads, KEEP_X(r, WORD, at) writes word WORD(at +
    // i). The parameters' names are no member's.
    void words(const Wish& wish) {
        const Record& r = record(wish.record, wish.line);
        const auto word = [](uint32_t i) { return "WORD((FIRST) + " + std::to_string(i) + "u)"; };
        out << "#define FILL_" << r.name << "(RECORD, WORD, FIRST)";
        for (const Field& f : r.fields) out << " \\\n    RECORD." << f.path << " = " << fromWords(f, word) << ";";
        out << "\n#define KEEP_" << r.name << "(RECORD, WORD, FIRST)";
        for (uint32_t i = 0; i < r.words; ++i) out << " \\\n    " << word(i) << " = " << toWord(r, i, "RECORD") << ";";
        out << "\n";
    }

    void writeAll() {
        for (const Wish& wish : header.wishes) {
            out << "\n";
            switch (wish.kind) {
                case Wish::Kind::access:
                    access(wish);
                    break;
                case Wish::Kind::part:
                    part(wish);
                    break;
                case Wish::Kind::offsets:
                    offsets(wish);
                    break;
                case Wish::Kind::texels:
                    texels(wish);
                    break;
                case Wish::Kind::words:
                    words(wish);
                    break;
            }
        }
    }
};

}  // namespace

std::string accessOf(const Records& all, const Header& header) {
    Writer writer{all, header, {}};
    writer.writeAll();
    std::string guard = "ESPALIER_RECORDS_" + header.path;
    for (char& c : guard)
        c = std::isalnum(static_cast<unsigned char>(c)) ? char(std::toupper(static_cast<unsigned char>(c))) : '_';
    return "// Made by tools/records from " + header.path + ".\n#ifndef " + guard + "\n#define " + guard +
           "\n#include \"shaders/shared/pairs.h\"\n#include \"" + header.path + "\"\n\nESPALIER_BEGIN\n" +
           writer.out.str() + "\nESPALIER_END\n#endif\n";
}

}  // namespace espalier::records
