// In: a document. Out: the pictures of its textures, decoded. What is missing, damaged or stored in a way that isn't
// read becomes a warning: a model without its textures can still be baked.
#include <algorithm>

#include "tools/bake/import_gltf.hpp"

namespace espalier::import {
namespace {

using nlohmann::json;

constexpr const char* kWebp = "EXT_texture_webp";

Result<std::vector<uint8_t>> imageBytes(const Document& document, int index, const std::string& place) {
    if (!document.images.is_array() || index < 0 || size_t(index) >= document.images.size() ||
        !document.images[size_t(index)].is_object())
        return Failure(document.path, place + " does not exist");
    const json& image = document.images[size_t(index)];
    if (image.contains("uri") && image["uri"].is_string()) return readUri(document, image["uri"].get<std::string>());
    if (!image.contains("bufferView") || !image["bufferView"].is_number_unsigned() ||
        image["bufferView"].get<uint64_t>() >= document.views.size())
        return Failure(document.path, place + ": neither a file nor a buffer view");
    Bytes bytes = document.views[image["bufferView"].get<size_t>()];
    if (!document.intake->take(bytes.size()))
        return Failure(document.path, place + ": absurdly much for a file of its size");
    return std::vector<uint8_t>(bytes.begin(), bytes.end());
}

std::string placeOf(int image) {
    return "images[" + std::to_string(image) + "]";
}

Result<Picture> decodeImage(const Document& document, int index) {
    std::string place = placeOf(index);
    auto bytes = imageBytes(document, index, place);
    if (!bytes) return std::move(bytes.failure());
    auto decoded = readPicture(std::move(*bytes), document.path, *document.intake);
    if (!decoded) return Failure(document.path, place + ": " + decoded.failure().diagnostics.front().message);
    return decoded;
}

// The image that an extension of a texture names beside, or in place of, its plain source.
struct Alternative {
    std::string extension;
    int image;
};
std::vector<Alternative> alternativesOf(const tinygltf::Texture& texture) {
    std::vector<Alternative> all;
    for (const auto& [name, value] : texture.extensions)
        if (value.IsObject() && value.Get("source").IsInt()) all.push_back({name, value.Get("source").Get<int>()});
    return all;
}

}  // namespace

void Textures::warn(std::string text) {
    const auto said = [&](const Diagnostic& d) { return d.message == text; };
    if (std::ranges::none_of(warnings_, said)) warnings_.push_back({document_.path, 0, 0, {}, std::move(text), true});
}

int Textures::find(int texture) {
    if (texture < 0) return -1;
    if (auto known = textures_.find(texture); known != textures_.end()) return known->second;
    return textures_[texture] = choose(texture);
}

glm::vec4 Textures::meanOf(int texture) {
    const size_t before = pictures_.size();
    const int found = find(texture);
    if (found < 0) return glm::vec4(1);
    const std::vector<uint8_t>& rgba = pictures_[size_t(found)].rgba;
    uint64_t sum[4] = {};
    for (size_t i = 0; i < rgba.size(); ++i) sum[i % 4] += rgba[i];
    glm::vec4 mean(1);
    for (int k = 0; k < 4 && !rgba.empty(); ++k) mean[k] = float(double(sum[k]) / (255.0 * double(rgba.size() / 4)));
    if (pictures_.size() > before) {
        pictures_.pop_back();
        textures_.erase(texture);
        std::erase_if(images_, [&](const auto& known) { return known.second == found; });
    }
    return mean;
}

int Textures::choose(int index) {
    if (size_t(index) >= document_.gltf.textures.size()) {
        warn("textures[" + std::to_string(index) + "] does not exist");
        return -1;
    }
    const tinygltf::Texture& texture = document_.gltf.textures[size_t(index)];
    const std::string otherwise =
        texture.source >= 0 ? ": " + placeOf(texture.source) + " is taken in its place" : ": the texture is left out";
    for (const Alternative& other : alternativesOf(texture)) {
        if (other.extension != kWebp) {
            warn(other.extension + " is not read, " + placeOf(other.image) + " neither" + otherwise);
            continue;
        }
        if (const int found = decode(other.image, other.extension + ": ", otherwise); found >= 0) return found;
    }
    if (texture.source >= 0) return decode(texture.source, "", ": the texture is left out");
    if (texture.extensions.empty()) warn("textures[" + std::to_string(index) + "] names no image");
    return -1;
}

int Textures::decode(int image, const std::string& by, const std::string& otherwise) {
    if (auto known = images_.find(image); known != images_.end()) return known->second;
    auto picture = decodeImage(document_, image);
    if (!picture) {
        warn(by + picture.failure().diagnostics.front().message + otherwise);
        return images_[image] = -1;
    }
    images_[image] = int(pictures_.size());
    pictures_.push_back(std::move(*picture));
    return images_[image];
}

}  // namespace espalier::import
