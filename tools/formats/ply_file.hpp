#pragma once

// A PLY file's header, and its body as rows of numbers.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace espalier::formats {

enum class PlyType : uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

// By which programs call one thing; those that are empty are none.
using PlyNames = std::array<std::string_view, 3>;

struct PlyProperty {
    std::string name;
    bool list = false;
    PlyType count = PlyType::uint8, type = PlyType::float32;
};

struct PlyElement {
    std::string name;
    uint64_t count = 0;
    std::vector<PlyProperty> properties;
    // Where the property of one of these names stands; -1: there is none.
    int find(const PlyNames& names) const;
};

// Functions that return a string return what is wrong at the place that has been reached; empty: nothing is.
class PlyFile {
  public:
    explicit PlyFile(std::string_view bytes) : text_(bytes) {}  // they outlive this

    std::vector<PlyElement> elements;
    std::vector<std::string> textures;  // that comments name

    // Afterwards numbers come from the body, element by element.
    std::string readHeader();
    // Whether the file is long enough for as many rows of an element as its header states.
    std::string expect(const PlyElement& element) const;
    // The next row of an element, the one of this number. slots: where single numbers go in `values`, by property; -1,
    // or beyond them: nowhere. Lists go into `lists`, by property.
    std::string readRow(const PlyElement& element, uint64_t number, std::span<const int> slots, double* values);
    std::vector<std::vector<double>> lists;

    // The place that has been reached. A line of a text, from 1; 0: the file is binary. A byte, from 0.
    int line() const { return format_ == Format::text ? line_ : 0; }
    size_t byte() const { return at_; }
    // "LINE: message", or "byte BYTE: message".
    std::string here(const std::string& message) const;

  private:
    enum class Format { text, littleEndian, bigEndian };

    std::string_view headerLine();
    bool next(PlyType type, double& value);
    bool nextText(double& value);
    bool nextList(const PlyProperty& property, std::vector<double>& list);
    std::string statement(std::string_view key, std::string_view rest);
    std::string format(std::string_view rest);
    std::string element(std::string_view rest);
    std::string property(std::string_view rest);

    std::string_view text_;
    size_t at_ = 0;
    int line_ = 0;
    Format format_ = Format::text, stated_ = Format::text;  // the header is text in each
};

}  // namespace espalier::formats
