// Layers out of a document into pictures.
#include "tools/document/layer_files.hpp"

#include <filesystem>

namespace espalier::document {

namespace fs = std::filesystem;

std::string pictureOf(const Document& document, const std::string& path, size_t surface) {
    if (surface == 0 || document.scene().surfaces.size() < 2) return path;
    const fs::path file(path);
    const std::string name = file.stem().string() + "-" + std::to_string(surface) + file.extension().string();
    return (file.parent_path() / name).string();
}

bool exportLayer(const Document& document, const std::string& layer, const std::string& path, std::string& error) {
    for (size_t i = 0; i < document.scene().surfaces.size(); ++i) {
        scene::GreyPicture picture;
        if (!document.readLayer(i, layer, picture, error) || !writeGrey(pictureOf(document, path, i), picture, error))
            return false;
    }
    return true;
}

bool exportTownLayer(const Document& document, const std::string& layer, const std::string& path, std::string& error) {
    scene::GreyPicture picture;
    return document.readTownLayer(layer, picture, error) && writeGrey(path, picture, error);
}

}  // namespace espalier::document
