// In: a PLY file (text, or binary of either byte order). Out: its polygons as triangles, with the vertices' normals and
// UVs where it has them. Elements and properties that we don't know are passed over; what reaches past the file's end
// or names vertices that aren't there is an error at a line of the text, or at a byte of the binary part.
#include <array>
#include <cstring>
#include <limits>

#include "tools/bake/import.hpp"
#include "tools/bake/import_text.hpp"

namespace espalier::import {
namespace {

enum class Type : uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
constexpr size_t kSize[8] = {1, 1, 2, 2, 4, 4, 4, 8};
constexpr size_t kMaxList = 1 << 16;  // corners of a face

bool typeOf(std::string_view word, Type& out) {
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
            out = Type(i);
            return true;
        }
    return false;
}

struct Property {
    std::string name;
    bool list = false;
    Type count = Type::uint8, type = Type::float32;
};

struct Element {
    std::string name;
    uint64_t count = 0;
    std::vector<Property> properties;
};

enum class Format { text, littleEndian, bigEndian };

// Reads the header, then hands out one number after the other.
class PlyFile {
  public:
    PlyFile(const std::string& path, Bytes file)
        : path_(path), text_(reinterpret_cast<const char*>(file.data()), file.size()) {}

    std::vector<Element> elements;

    Status readHeader() {
        bool hasFormat = false;
        for (;;) {
            if (at_ >= text_.size()) return here("the header has no end_header");
            std::string_view line = nextLine(), rest = line, key = nextWord(rest);
            if (key == "end_header") break;
            hasFormat = hasFormat || key == "format";
            Status done = statement(key, rest);
            if (!done) return done;
        }
        if (!hasFormat) return here("the header states no format");
        return Done{};
    }

    bool isText() const { return format_ == Format::text; }
    size_t bytesLeft() const { return text_.size() - at_; }

    // The next number of the body.
    bool next(Type type, double& value) {
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

    // A failure at the place that has been reached.
    Failure here(std::string message) const {
        if (format_ == Format::text) return Failure(Diagnostic{path_, line_, 0, {}, std::move(message)});
        return Failure(path_, "byte " + std::to_string(at_) + ": " + message);
    }

  private:
    std::string_view nextLine() {
        // Old Macintosh files end their lines with a carriage return alone.
        size_t end = text_.find_first_of("\r\n", at_);
        if (end != text_.npos && text_.substr(end, 2) == "\r\n") ++end;
        std::string_view line = text_.substr(at_, end == text_.npos ? end : end - at_);
        at_ = end == text_.npos ? text_.size() : end + 1;
        ++line_;
        return trimmed(line);
    }

    bool nextText(double& value) {
        while (at_ < text_.size() && (isBlank(text_[at_]) || text_[at_] == '\n')) line_ += text_[at_++] == '\n';
        size_t end = at_;
        while (end < text_.size() && !isBlank(text_[end]) && text_[end] != '\n') ++end;
        bool good = toNumber(text_.substr(at_, end - at_), value);
        at_ = end;
        return good;
    }

    static double decode(const uint8_t* bytes, Type type) {
        auto as = [&](auto value) {
            std::memcpy(&value, bytes, sizeof value);
            return double(value);
        };
        switch (type) {
            case Type::int8:
                return as(int8_t());
            case Type::uint8:
                return as(uint8_t());
            case Type::int16:
                return as(int16_t());
            case Type::uint16:
                return as(uint16_t());
            case Type::int32:
                return as(int32_t());
            case Type::uint32:
                return as(uint32_t());
            case Type::float32:
                return as(float());
            case Type::float64:
                break;
        }
        return as(double());
    }

    Status statement(std::string_view key, std::string_view rest) {
        if (key == "format") return format(rest);
        if (key == "element") return element(rest);
        if (key == "property") return property(rest);
        return Done{};  // comments
    }

    Status format(std::string_view rest) {
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

    Status element(std::string_view rest) {
        Element out;
        out.name = nextWord(rest);
        long long count = -1;
        if (!toInteger(nextWord(rest), count) || count < 0) return here("element " + out.name + ": no count");
        out.count = uint64_t(count);
        elements.push_back(std::move(out));
        return Done{};
    }

    Status property(std::string_view rest) {
        Property out;
        std::string_view type = nextWord(rest);
        out.list = type == "list";
        if (out.list && (!typeOf(nextWord(rest), out.count) || out.count >= Type::float32))
            return here("a list's count is no whole number");
        if (!typeOf(out.list ? nextWord(rest) : type, out.type)) return here("a property of an unknown type");
        out.name = nextWord(rest);
        if (elements.empty()) return here("a property before the first element");
        elements.back().properties.push_back(std::move(out));
        return Done{};
    }

  public:
    // From here on numbers come from the body.
    void enterBody() { format_ = stated_, ++line_; }

  private:
    const std::string& path_;
    std::string_view text_;
    size_t at_ = 0;
    int line_ = 0;
    Format format_ = Format::text, stated_ = Format::text;  // the header is text in each
};

// Where a vertex's property goes: 0 to 2 the position, 3 to 5 the normal, 6 and 7 the UV; -1: nowhere.
int slotOf(std::string_view name) {
    static constexpr std::string_view kNames[3][8] = {{"x", "y", "z", "nx", "ny", "nz", "u", "v"},
                                                      {"", "", "", "", "", "", "s", "t"},
                                                      {"", "", "", "", "", "", "texture_u", "texture_v"}};
    for (const auto& row : kNames)
        for (int i = 0; i < 8; ++i)
            if (name == row[i]) return i;
    return -1;
}

class PlyReader {
  public:
    PlyReader(const std::string& path, Bytes file, Model& model) : path_(path), file_(path, file), model_(model) {}

    Status run() {
        Status done = file_.readHeader();
        if (!done) return done;
        file_.enterBody();
        for (const Element& element : file_.elements) {
            done = read(element);
            if (!done) return done;
        }
        if (model_.indices.empty()) return Failure(path_, strips_ ? "its faces are strips" : "the file holds no faces");
        model_.materials.emplace_back();
        return Done{};
    }

  private:
    Status read(const Element& element) {
        // A number takes a byte at least, or a digit and a blank.
        uint64_t smallest = element.properties.size() * (file_.isText() ? 2 : 1);
        if (smallest == 0) return Done{};
        if (element.count > (file_.bytesLeft() + 1) / smallest)
            return file_.here("the file ends before the " + std::to_string(element.count) + " elements '" +
                              element.name + "' that its header states");
        if (element.name == "vertex") return readVertices(element);
        if (element.name == "tristrips") strips_ = true;
        bool faces = element.name == "face";
        for (uint64_t i = 0; i < element.count; ++i) {
            Status done = readOther(element, faces, i);
            if (!done) return done;
        }
        return Done{};
    }

    Failure cut(const Element& element, uint64_t i) {
        return file_.here(element.name + " " + std::to_string(i) + ": the file ends or holds no number here");
    }

    Status readVertices(const Element& element) {
        if (element.count > kMaxVertices) return Failure(path_, "more than 67 million vertices");
        std::vector<int> slots;
        uint32_t has = 0;
        for (const Property& p : element.properties) {
            slots.push_back(p.list ? -1 : slotOf(p.name));
            if (slots.back() >= 0) has |= 1u << slots.back();
        }
        if ((has & 7u) != 7u) return Failure(path_, "vertices have no x, y and z");
        bool normals = (has & 0x38u) == 0x38u, uvs = (has & 0xC0u) == 0xC0u;
        for (uint64_t i = 0; i < element.count; ++i) {
            float values[8] = {};
            for (size_t k = 0; k < slots.size(); ++k) {
                double value = 0;
                if (!readProperty(element.properties[k], value, nullptr)) return cut(element, i);
                if (slots[k] < 0) continue;
                values[slots[k]] = float(value);
                if (slots[k] < 3 && !std::isfinite(float(value)))
                    return file_.here("vertex " + std::to_string(i) + ": a position is not a number");
            }
            model_.positions.push_back({values[0], values[1], values[2]});
            if (normals) model_.normals.push_back(normalised({values[3], values[4], values[5]}));
            if (uvs) model_.uvs.push_back({values[6], 1 - values[7]});  // as OBJ, v counts upwards
        }
        return Done{};
    }

    static glm::vec3 normalised(glm::vec3 n) {
        float length = glm::length(n);
        return length > 0 && std::isfinite(length) ? n / length : glm::vec3(0);
    }

    // One number, or a list (put into `list` where that is wanted).
    bool readProperty(const Property& property, double& value, std::vector<double>* list) {
        if (!property.list) return file_.next(property.type, value);
        double count = 0;
        if (!file_.next(property.count, count) || !(count >= 0) || count > double(file_.bytesLeft())) return false;
        for (uint64_t i = 0; i < uint64_t(count); ++i) {
            if (!file_.next(property.type, value)) return false;
            if (list) list->push_back(value);
        }
        return true;
    }

    Status readOther(const Element& element, bool face, uint64_t number) {
        for (const Property& p : element.properties) {
            bool corners = face && p.list && (p.name == "vertex_indices" || p.name == "vertex_index");
            double value = 0;
            list_.clear();
            if (!readProperty(p, value, corners ? &list_ : nullptr)) return cut(element, number);
            if (!corners) continue;
            if (list_.size() < 3) continue;
            if (list_.size() > kMaxList) return file_.here("face " + std::to_string(number) + ": too many corners");
            polygon_.clear();
            for (double index : list_) {
                if (!(index >= 0) || index >= double(model_.positions.size()) || index != std::floor(index))
                    return file_.here("face " + std::to_string(number) + ": vertex " +
                                      std::to_string((long long)(std::abs(index) < 1e15 ? index : -1)) +
                                      " does not exist: the file has " + std::to_string(model_.positions.size()));
                polygon_.push_back(uint32_t(index));
            }
            triangulate(model_.positions, polygon_, model_.indices);
        }
        return Done{};
    }

    const std::string& path_;
    PlyFile file_;
    Model& model_;
    std::vector<double> list_;
    std::vector<uint32_t> polygon_;
    bool strips_ = false;
};

}  // namespace

Status importPly(const std::string& path, Bytes file, Model& model) {
    return PlyReader(path, file, model).run();
}

}  // namespace espalier::import
