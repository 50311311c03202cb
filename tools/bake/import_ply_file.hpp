#pragma once

// A PLY file's header, and its body as one number after the other.

#include <array>

#include "tools/bake/import.hpp"

namespace espalier::import {

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

class PlyFile {
  public:
    PlyFile(const std::string& path, Bytes file)
        : path_(path), text_(reinterpret_cast<const char*>(file.data()), file.size()) {}

    std::vector<PlyElement> elements;
    std::vector<std::string> textures;  // that comments name

    // Afterwards numbers come from the body.
    Status readHeader();
    bool isText() const { return format_ == Format::text; }
    size_t bytesLeft() const { return text_.size() - at_; }
    // The next number of the body. False: the file ends, or holds no number here.
    bool next(PlyType type, double& value);
    // A failure at the place that has been reached: a line of a text, a byte of a binary.
    Failure here(std::string message) const;
    int line() const { return format_ == Format::text ? line_ : 0; }

  private:
    enum class Format { text, littleEndian, bigEndian };

    std::string_view headerLine();
    bool nextText(double& value);
    Status statement(std::string_view key, std::string_view rest);
    Status format(std::string_view rest);
    Status element(std::string_view rest);
    Status property(std::string_view rest);

    const std::string& path_;
    std::string_view text_;
    size_t at_ = 0;
    int line_ = 0;
    Format format_ = Format::text, stated_ = Format::text;  // the header is text in each
};

}  // namespace espalier::import
