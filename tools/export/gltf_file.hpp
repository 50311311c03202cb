#pragma once

// A binary glTF while it is made: buffers, accessors, and nodes, of which there may be a great many.

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace espalier::exporting {

using Json = nlohmann::ordered_json;

class GltfFile {
  public:
    static constexpr int kFloat = 5126, kUint = 5125, kShort = 5122, kUshort = 5123;
    static constexpr int kVertices = 34962, kIndices = 34963, kOther = 0;

    // Bytes of a vertex's element have to be a multiple of 4. The accessor's number; more may be said in it.
    template <class T>
    size_t accessor(const std::vector<T>& elements, int component, const char* type, bool normalised, int target) {
        return accessor(elements.data(), elements.size() * sizeof(T), elements.size(), component, type, normalised,
                        target);
    }
    // Positions of vertices, with the bounds that glTF asks for; at least one.
    size_t points(const std::vector<std::array<float, 3>>& points);
    size_t view(const void* bytes, size_t size, int target);
    // Adds an object to the list of this name; its number.
    size_t add(const char* list, Json object);

    // Nodes are text from the beginning, since millions of objects take long. `text`: of the object, without braces.
    size_t node(const std::string& text);
    size_t nodeCount() const { return nodeCount_; }
    // Whoever reads the file has to know it, or without `required` may.
    void use(const std::string& extension, bool required);

    Json& json() { return json_; }
    // The whole container; empty: it would be larger than a .glb can be, 4 GiB.
    std::string finish(const std::vector<size_t>& roots, const std::string& sceneName);

  private:
    size_t accessor(const void* bytes, size_t size, size_t count, int component, const char* type, bool normalised,
                    int target);

    Json json_ = {{"asset", {{"version", "2.0"}, {"generator", "espalier-export " ESPALIER_VERSION}}}};
    std::string binary_, nodes_;
    size_t nodeCount_ = 0;
    std::set<std::string> used_, required_;
};

// A number as text, of so many digits behind the point at most; as short as can be.
void appendNumber(std::string& text, float value, int digits);
// `"name":[...]` of some numbers, with a comma before it where there is text already.
void appendNumbers(std::string& text, const char* name, const float* values, size_t count, int digits);
void appendText(std::string& text, const char* name, const std::string& value);

}  // namespace espalier::exporting
