#pragma once

// Inside of the reader: an opened file whose ranges are checked before anything is read from them. All functions throw
// Damage, the first thing that is wrong; readSurface makes a failure of it.

#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "runtime/surface/surface.hpp"

namespace espalier::surface_file {

using nlohmann::json;

constexpr uint64_t kMaxRecords = uint64_t(1) << 27;

struct Damage {
    std::string place, message;
};
[[noreturn]] void fail(const std::string& place, const std::string& message);

// Fields of a JSON object; `place` is for messages.
const json& at(const json& object, const char* key, const std::string& place);
uint64_t whole(const json& object, const char* key, const std::string& place, uint64_t most);
uint64_t hexadecimal(const json& object, const char* key, const std::string& place);
const json& array(const json& object, const char* key, const char* place, size_t most);
float number(const json& object, const char* key, float otherwise);  // what isn't finite counts as missing
bool flag(const json& object, const char* key);                      // what isn't true is false
std::string indexed(const char* name, size_t i);

inline bool sane(glm::vec3 p) {
    return std::abs(p.x) < 1e30f && std::abs(p.y) < 1e30f && std::abs(p.z) < 1e30f;
}

// A .glb: its document, and its binary chunk.
class Container {
  public:
    // partial: the end of the file is missing, and isn't asked for.
    explicit Container(std::vector<std::byte> file, bool partial);
    Container(const Container&) = delete;  // holds places in its own bytes

    const json& root() const { return root_; }
    const json& walk() const;  // the extension
    bool partial() const { return partial_; }
    std::span<const std::byte> binary() const { return binary_; }
    std::span<const std::byte> view(uint64_t index, const std::string& place) const;
    // What several fields refer to is decoded for each: together they are bounded by the file's size.
    void take(uint64_t bytes, const std::string& place);
    // Likewise of pictures, of which some are one colour and small for what they hold.
    void takePicture(uint64_t bytes, const std::string& place);

  private:
    std::vector<std::byte> file_;
    std::span<const std::byte> binary_;
    json root_;
    bool partial_;
    uint64_t taken_ = 0, pictures_ = 0;  // bytes decoded so far
};

// Reads what a walk needs, from level `finest` on, all of it validated: every index that a kernel would follow.
void readWalk(Container& file, uint32_t finest, bool comparesHashes, SurfaceData& data);
// Materials, pictures, the mesh and its coarser ones; of a partial file, coarser ones only if it has any.
void readDrawing(Container& file, SurfaceData& data);

}  // namespace espalier::surface_file
