// In: elements and objects. Out: the container of binary glTF (glTF 2.0, §4.4).
#include "tools/export/gltf_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace espalier::exporting {
namespace {

void pad(std::string& bytes, char with) {
    bytes.resize((bytes.size() + 3) / 4 * 4, with);
}
void appendWord(std::string& bytes, uint32_t word) {
    for (int i = 0; i < 4; ++i) bytes.push_back(char(word >> (8 * i) & 255u));
}

}  // namespace

size_t GltfFile::view(const void* bytes, size_t size, int target) {
    pad(binary_, '\0');
    Json object = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}};
    if (target != kOther) object["target"] = target;
    binary_.append(static_cast<const char*>(bytes), size);
    return add("bufferViews", std::move(object));
}

size_t GltfFile::accessor(const void* bytes, size_t size, size_t count, int component, const char* type,
                          bool normalised, int target) {
    Json object = {{"bufferView", view(bytes, size, target)}, {"componentType", component}, {"count", count}};
    if (normalised) object["normalized"] = true;
    object["type"] = type;
    return add("accessors", std::move(object));
}

size_t GltfFile::points(const std::vector<std::array<float, 3>>& points) {
    std::array<float, 3> low = points.front(), high = low;
    for (const auto& p : points)
        for (size_t i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
    const size_t number = accessor(points, kFloat, "VEC3", false, kVertices);
    json_["accessors"][number]["min"] = low;
    json_["accessors"][number]["max"] = high;
    return number;
}

size_t GltfFile::add(const char* list, Json object) {
    json_[list].push_back(std::move(object));
    return json_[list].size() - 1;
}

size_t GltfFile::node(const std::string& text) {
    if (nodeCount_ > 0) nodes_ += ',';
    nodes_ += '{';
    nodes_ += text;
    nodes_ += '}';
    return nodeCount_++;
}

void GltfFile::use(const std::string& extension, bool required) {
    used_.insert(extension);
    if (required) required_.insert(extension);
}

std::string GltfFile::finish(const std::vector<size_t>& roots, const std::string& sceneName) {
    pad(binary_, '\0');
    json_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
    json_["scene"] = 0;
    json_["scenes"] = Json::array({{{"name", sceneName}, {"nodes", roots}}});
    if (!used_.empty()) json_["extensionsUsed"] = used_;
    if (!required_.empty()) json_["extensionsRequired"] = required_;
    std::string text = json_.dump();
    text.pop_back();  // the closing brace
    text += ",\"nodes\":[" + nodes_ + "]}";
    nodes_.clear();
    pad(text, ' ');
    const uint64_t total = 12 + 8 + uint64_t(text.size()) + 8 + binary_.size();
    if (total > 0xFFFFFFFFu) return {};
    std::string bytes = "glTF";
    bytes.reserve(total);
    for (uint32_t word : {2u, uint32_t(total), uint32_t(text.size())}) appendWord(bytes, word);
    bytes += "JSON" + text;
    appendWord(bytes, uint32_t(binary_.size()));
    bytes.append("BIN\0", 4);
    bytes += binary_;
    return bytes;
}

void appendNumber(std::string& text, float value, int digits) {
    char room[64];
    auto [end, wrong] = std::to_chars(room, room + sizeof room, value, std::chars_format::fixed, digits);
    if (digits > 0) {
        while (end[-1] == '0') --end;
        if (end[-1] == '.') --end;
    }
    const std::string_view number(room, size_t(end - room));
    text += number == "-0" ? std::string_view("0") : number;
}

void appendNumbers(std::string& text, const char* name, const float* values, size_t count, int digits) {
    if (!text.empty()) text += ',';
    text += '"';
    text += name;
    text += "\":[";
    for (size_t i = 0; i < count; ++i) {
        if (i > 0) text += ',';
        appendNumber(text, values[i], digits);
    }
    text += ']';
}

void appendText(std::string& text, const char* name, const std::string& value) {
    if (!text.empty()) text += ',';
    text += '"';
    text += name;
    text += "\":" + Json(value).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace espalier::exporting
