#pragma once

// Inside of the importer: what the three formats share.

#include <span>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"
#include "tools/bake/import_model.hpp"

namespace espalier::import {

using Bytes = std::span<const uint8_t>;

// What one import has read, and what it may still allocate: a small file that states great sizes is refused before
// they are believed.
class Intake {
  public:
    explicit Intake(std::vector<InputFile>* inputs) : inputs_(inputs) {}

    // A file's bytes, unpacked where they are gzip. A failure blames `blame`, the file that refers to this one.
    Result<std::vector<uint8_t>> read(const std::string& path, const std::string& blame);
    // A file that a document refers to, by the rule of placeBeside (runtime/core/file_beside.hpp).
    Result<std::vector<uint8_t>> readBeside(const std::string& document, const std::string& name);
    // Whether there is such a file.
    bool isBeside(const std::string& document, const std::string& name);

    // Counts a file among those that the import depends on, without reading it for the model.
    void note(const std::string& path);

    // False: so many bytes more are beyond what files of this size can reasonably hold.
    bool take(uint64_t bytes);
    uint64_t left() const { return allowed_ - taken_; }

  private:
    std::vector<InputFile>* inputs_;
    std::vector<std::string> known_;
    uint64_t allowed_ = uint64_t(256) << 20, taken_ = 0;
};

// Each fails naming the file and the line, element or offset concerned.
Status importGltf(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model);
Status importObj(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model);
Status importPly(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model);
Status importStl(const std::string& path, Bytes file, const ImportOptions& options, Model& model);

// Decodes a PNG or JPEG within what the intake allows, or a WebP; `encoded` keeps the bytes of the first two.
Result<Picture> readPicture(std::vector<uint8_t> bytes, const std::string& file, Intake& intake);

// Sets the model's positions and its origin, by which they are less than `places`: the one that is wanted, else one
// where float32 would lose what matters. used: the vertices that triangles name; others needn't be numbers.
void settle(const std::vector<glm::dvec3>& places, std::span<const uint32_t> used,
            const std::optional<glm::dvec3>& wanted, Model& model);

// WebP, by libwebp where the machine has it; fails where it hasn't. file: for the message.
bool isWebp(Bytes bytes);
Result<Picture> decodeWebp(Bytes bytes, const std::string& file, uint64_t maxTexels);

// Decides which materials are bare: those that readers have marked, being transparent, and by the options' names.
void decideBare(const ImportOptions& options, Model& model);

constexpr size_t kMaxVertices = size_t(1) << 26;

}  // namespace espalier::import
