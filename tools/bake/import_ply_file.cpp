// In: a PLY file (text, or binary of either byte order). Out: its header, then the numbers of its body.
#include "tools/bake/import_ply_file.hpp"

#include <algorithm>
#include <cstring>

#include "tools/bake/import_text.hpp"

namespace espalier::import {
namespace {

bool typeOf(std::string_view word, PlyType& out) {
    static constexpr std::array<std::array<std::string_view, 2>, 8> kNames = {{{"char", "int8"},
                                                                               {"uchar", "uint8"},
                                                                               {"short", "int16"},
                                                                               {"ushort", "uint16"},
                                                                               {"int", "int32"},
                                                                               {"uint", "uint32"},
                                                                               {"float", "float32"},
                                                                               {"double", "float64"}}};
    for (size_t i = 0; i < kNames.size(); ++i)
        if (word == kNames[i][0] || word == kNames[i][1]) {
            out = PlyType(i);
            return true;
        }
    return false;
}

constexpr size_t kSize[8] = {1, 1, 2, 2, 4, 4, 4, 8};

double decode(const uint8_t* bytes, PlyType type) {
    auto as = [&](auto value) {
        std::memcpy(&value, bytes, sizeof value);
        return double(value);
    };
    switch (type) {
        case PlyType::int8:
            return as(int8_t());
        case PlyType::uint8:
            return as(uint8_t());
        case PlyType::int16:
            return as(int16_t());
        case PlyType::uint16:
            return as(uint16_t());
        case PlyType::int32:
            return as(int32_t());
        case PlyType::uint32:
            return as(uint32_t());
        case PlyType::float32:
            return as(float());
        case PlyType::float64:
            break;
    }
    return as(double());
}

}  // namespace

int PlyElement::find(const PlyNames& names) const {
    for (std::string_view wanted : names)
        for (size_t i = 0; i < properties.size(); ++i)
            if (!wanted.empty() && properties[i].name == wanted) return int(i);
    return -1;
}

Status PlyFile::readHeader() {
    bool hasFormat = false;
    for (;;) {
        if (at_ >= text_.size()) return here("the header has no end_header");
        std::string_view rest = headerLine(), key = nextWord(rest);
        if (key == "end_header") break;
        hasFormat = hasFormat || key == "format";
        Status done = statement(key, rest);
        if (!done) return done;
    }
    // Where lines end with a carriage return alone, a line feed behind the last one is the body's first byte.
    const bool returnsAlone = text_.size() > 4 && text_[3] == '\r' && text_[4] != '\n';
    if (returnsAlone && text_.substr(0, at_).ends_with("\r\n")) --at_;
    if (!hasFormat) return here("the header states no format");
    format_ = stated_;
    ++line_;
    return Done{};
}

bool PlyFile::next(PlyType type, double& value) {
    if (format_ == Format::text) return nextText(value);
    size_t size = kSize[size_t(type)];
    if (bytesLeft() < size) return false;
    uint8_t bytes[8];
    std::memcpy(bytes, text_.data() + at_, size);
    if (format_ == Format::bigEndian) std::reverse(bytes, bytes + size);
    at_ += size;
    value = decode(bytes, type);
    return true;
}

Failure PlyFile::here(std::string message) const {
    if (format_ == Format::text) return Failure(Diagnostic{path_, line_, 0, {}, std::move(message)});
    return Failure(path_, "byte " + std::to_string(at_) + ": " + message);
}

std::string_view PlyFile::headerLine() {
    std::string_view rest = text_.substr(at_);
    const std::string_view line = nextLine(rest);
    at_ = text_.size() - rest.size();
    ++line_;
    return trimmed(line);
}

bool PlyFile::nextText(double& value) {
    const auto isEnd = [](char c) { return c == '\n' || c == '\r'; };
    while (at_ < text_.size() && (isBlank(text_[at_]) || isEnd(text_[at_]))) {
        // "\r\n" ends one line.
        line_ += text_[at_] == '\n' ? at_ == 0 || text_[at_ - 1] != '\r' : text_[at_] == '\r';
        ++at_;
    }
    size_t end = at_;
    while (end < text_.size() && !isBlank(text_[end]) && !isEnd(text_[end])) ++end;
    bool good = toNumber(text_.substr(at_, end - at_), value);
    at_ = end;
    return good;
}

Status PlyFile::statement(std::string_view key, std::string_view rest) {
    if (key == "format") return format(rest);
    if (key == "element") return element(rest);
    if (key == "property") return property(rest);
    // A habit that no specification knows, but MeshLab and many others.
    if (key == "comment" && nextWord(rest) == "TextureFile" && !trimmed(rest).empty())
        textures.emplace_back(trimmed(rest));
    return Done{};
}

Status PlyFile::format(std::string_view rest) {
    std::string_view name = nextWord(rest), version = nextWord(rest);
    if (version != "1.0") return here("format version '" + std::string(version.substr(0, 20)) + "' instead of 1.0");
    if (name == "ascii")
        stated_ = Format::text;
    else if (name == "binary_little_endian")
        stated_ = Format::littleEndian;
    else if (name == "binary_big_endian")
        stated_ = Format::bigEndian;
    else
        return here("unknown format '" + std::string(name.substr(0, 40)) + "'");
    return Done{};
}

Status PlyFile::element(std::string_view rest) {
    PlyElement out;
    out.name = nextWord(rest);
    long long count = -1;
    if (!toInteger(nextWord(rest), count) || count < 0) return here("element " + out.name + ": no count");
    out.count = uint64_t(count);
    elements.push_back(std::move(out));
    return Done{};
}

Status PlyFile::property(std::string_view rest) {
    PlyProperty out;
    std::string_view type = nextWord(rest);
    out.list = type == "list";
    if (out.list && (!typeOf(nextWord(rest), out.count) || out.count >= PlyType::float32))
        return here("a list's count is no whole number");
    if (!typeOf(out.list ? nextWord(rest) : type, out.type)) return here("a property of an unknown type");
    out.name = nextWord(rest);
    if (elements.empty()) return here("a property before the first element");
    elements.back().properties.push_back(std::move(out));
    return Done{};
}

}  // namespace espalier::import
