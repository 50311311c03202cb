// In: the bytes of a .glb, or of something that claims to be one. Out: its document and checked ranges of its binary
// chunk.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/core/glb.hpp"
#include "runtime/surface/surface_file.hpp"
#include "runtime/surface/surface_reader.hpp"

namespace espalier::surface_file {

[[noreturn]] void fail(const std::string& place, const std::string& message) {
    throw Damage{place, message};
}

const json& at(const json& object, const char* key, const std::string& place) {
    if (!object.is_object() || !object.contains(key)) fail(place, std::string(key) + " is missing");
    return object[key];
}

uint64_t whole(const json& object, const char* key, const std::string& place, uint64_t most) {
    const json& value = at(object, key, place);
    if (!value.is_number_unsigned() || value.get<uint64_t>() > most)
        fail(place, std::string(key) + " is not a whole number up to " + std::to_string(most));
    return value.get<uint64_t>();
}

uint64_t hexadecimal(const json& object, const char* key, const std::string& place) {
    const json& value = at(object, key, place);
    std::string text = value.is_string() ? value.get<std::string>() : std::string();
    if (text.size() != 16 || text.find_first_not_of("0123456789abcdef") != std::string::npos)
        fail(place, std::string(key) + " is not a hash");
    return std::stoull(text, nullptr, 16);
}

const json& array(const json& object, const char* key, const char* place, size_t most) {
    const json& value = at(object, key, place);
    if (!value.is_array() || value.size() > most) fail(place, std::string(key) + " is not an array of sane length");
    return value;
}

float number(const json& object, const char* key, float otherwise) {
    if (!object.is_object() || !object.contains(key) || !object[key].is_number()) return otherwise;
    float f = object[key].get<float>();
    return std::isfinite(f) ? f : otherwise;
}

bool flag(const json& object, const char* key) {
    return object.is_object() && object.contains(key) && object[key].is_boolean() && object[key].get<bool>();
}

std::string indexed(const char* name, size_t i) {
    return std::string(name) + "[" + std::to_string(i) + "]";
}

Container::Container(std::vector<std::byte> file, bool partial) : file_(std::move(file)), partial_(partial) {
    const auto word = [&](size_t offset) {
        uint32_t value;
        std::memcpy(&value, file_.data() + offset, 4);
        return value;
    };
    if (file_.size() < 28 || word(0) != kGlbMagic) fail("header", "not a .glb");
    if (word(4) != 2) fail("header", "glTF container version " + std::to_string(word(4)));
    if (!partial && word(8) != file_.size())
        fail("header",
             "truncated or damaged: states " + std::to_string(word(8)) + " bytes, has " + std::to_string(file_.size()));
    size_t text = word(12);
    if (word(16) != kGlbJson || text > file_.size() - 28) fail("JSON chunk", "reaches past the end of the file");
    root_ = json::parse(reinterpret_cast<const char*>(file_.data()) + 20,
                        reinterpret_cast<const char*>(file_.data()) + 20 + text, nullptr, false);
    if (root_.is_discarded() || !root_.is_object()) fail("JSON chunk", "does not parse");
    size_t binary = word(20 + text);
    const size_t there = file_.size() - 28 - text;
    if (word(24 + text) != kGlbBinary || (!partial && binary > there))
        fail("binary chunk", "reaches past the end of the file");
    binary_ = std::span(file_).subspan(28 + text, std::min(binary, there));
}

const json& Container::walk() const {
    const auto all = root_.find("extensions");
    if (all == root_.end() || !all->is_object() || !all->contains(kExtension))
        fail("glTF",
             "not a baked surface, which espalier-bake makes of a model: " + std::string(kExtension) + " is missing");
    return (*all)[kExtension];
}

std::span<const std::byte> Container::view(uint64_t index, const std::string& place) const {
    const json& views = array(root_, "bufferViews", "glTF", kMaxViews);
    if (index >= views.size()) fail(place, indexed("bufferViews", index) + " does not exist");
    std::string here = indexed("bufferViews", index);
    uint64_t buffer = whole(views[index], "buffer", here, 0),
             length = whole(views[index], "byteLength", here, binary_.size());
    uint64_t offset = whole(views[index], "byteOffset", here, binary_.size());
    if (buffer != 0 || length > binary_.size() - offset) fail(here, "reaches past the end of the binary chunk");
    return binary_.subspan(offset, length);
}

namespace {

void takeOf(uint64_t& taken, uint64_t bytes, uint64_t allowed, const std::string& place) {
    taken += bytes;
    if (taken > allowed) fail(place, "absurdly much for the file's size");
}

constexpr uint64_t kMultiple = 256;  // of a file's bytes: what decoding it may allocate

}  // namespace

void Container::take(uint64_t bytes, const std::string& place) {
    takeOf(taken_, bytes, (uint64_t(256) << 20) + file_.size() * kMultiple, place);
}

void Container::takePicture(uint64_t bytes, const std::string& place) {
    takeOf(pictures_, bytes, (uint64_t(1) << 30) + file_.size() * kMultiple, place);
}

}  // namespace espalier::surface_file
