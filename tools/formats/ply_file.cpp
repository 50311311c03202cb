// In: a PLY file (text, or binary of either byte order). Out: its header, then the rows of its body.
#include "tools/formats/ply_file.hpp"

#include <algorithm>
#include <cstring>

#include "tools/formats/text.hpp"

namespace espalier::formats {
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

std::string PlyFile::readHeader() {
    bool hasFormat = false;
    for (;;) {
        if (at_ >= text_.size()) return "the header has no end_header";
        std::string_view rest = headerLine(), key = nextWord(rest);
        if (key == "end_header") break;
        hasFormat = hasFormat || key == "format";
        if (std::string wrong = statement(key, rest); !wrong.empty()) return wrong;
    }
    // Where lines end with a carriage return alone, a line feed behind the last one is the body's first byte.
    const bool returnsAlone = text_.size() > 4 && text_[3] == '\r' && text_[4] != '\n';
    if (returnsAlone && text_.substr(0, at_).ends_with("\r\n")) --at_;
    if (!hasFormat) return "the header states no format";
    format_ = stated_;
    ++line_;
    return {};
}

bool PlyFile::next(PlyType type, double& value) {
    if (format_ == Format::text) return nextText(value);
    size_t size = kSize[size_t(type)];
    if (text_.size() - at_ < size) return false;
    uint8_t bytes[8];
    std::memcpy(bytes, text_.data() + at_, size);
    if (format_ == Format::bigEndian) std::reverse(bytes, bytes + size);
    at_ += size;
    value = decode(bytes, type);
    return true;
}

std::string PlyFile::here(const std::string& message) const {
    return (line() > 0 ? std::to_string(line_) : "byte " + std::to_string(at_)) + ": " + message;
}

std::string PlyFile::expect(const PlyElement& element) const {
    // A number takes a byte at least, or a digit and a blank.
    const uint64_t smallest = element.properties.size() * (format_ == Format::text ? 2 : 1);
    if (smallest == 0 || element.count <= (text_.size() - at_ + 1) / smallest) return {};
    return "the file ends before the " + std::to_string(element.count) + " elements '" + element.name +
           "' that its header states";
}

std::string PlyFile::readRow(const PlyElement& element, uint64_t number, std::span<const int> slots, double* values) {
    lists.resize(std::max(lists.size(), element.properties.size()));
    for (size_t k = 0; k < element.properties.size(); ++k) {
        const PlyProperty& property = element.properties[k];
        double value = 0;
        if (!(property.list ? nextList(property, lists[k]) : next(property.type, value)))
            return element.name + " " + std::to_string(number) + ": the file ends or holds no number here";
        if (!property.list && k < slots.size() && slots[k] >= 0) values[slots[k]] = value;
    }
    return {};
}

bool PlyFile::nextList(const PlyProperty& property, std::vector<double>& list) {
    list.clear();
    double count = 0, value = 0;
    if (!next(property.count, count) || !(count >= 0) || count > double(text_.size() - at_)) return false;
    for (uint64_t i = 0; i < uint64_t(count); ++i) {
        if (!next(property.type, value)) return false;
        list.push_back(value);
    }
    return true;
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

std::string PlyFile::statement(std::string_view key, std::string_view rest) {
    if (key == "format") return format(rest);
    if (key == "element") return element(rest);
    if (key == "property") return property(rest);
    // A habit that no specification knows, but MeshLab and many others.
    if (key == "comment" && nextWord(rest) == "TextureFile" && !trimmed(rest).empty())
        textures.emplace_back(trimmed(rest));
    return {};
}

std::string PlyFile::format(std::string_view rest) {
    std::string_view name = nextWord(rest), version = nextWord(rest);
    if (version != "1.0") return "format version '" + std::string(version.substr(0, 20)) + "' instead of 1.0";
    if (name == "ascii")
        stated_ = Format::text;
    else if (name == "binary_little_endian")
        stated_ = Format::littleEndian;
    else if (name == "binary_big_endian")
        stated_ = Format::bigEndian;
    else
        return "unknown format '" + std::string(name.substr(0, 40)) + "'";
    return {};
}

std::string PlyFile::element(std::string_view rest) {
    PlyElement out;
    out.name = nextWord(rest);
    long long count = -1;
    if (!toInteger(nextWord(rest), count) || count < 0) return "element " + out.name + ": no count";
    out.count = uint64_t(count);
    elements.push_back(std::move(out));
    return {};
}

std::string PlyFile::property(std::string_view rest) {
    PlyProperty out;
    std::string_view type = nextWord(rest);
    out.list = type == "list";
    if (out.list && (!typeOf(nextWord(rest), out.count) || out.count >= PlyType::float32))
        return "a list's count is no whole number";
    if (!typeOf(out.list ? nextWord(rest) : type, out.type)) return "a property of an unknown type";
    out.name = nextWord(rest);
    if (elements.empty()) return "a property before the first element";
    elements.back().properties.push_back(std::move(out));
    return {};
}

}  // namespace espalier::formats
