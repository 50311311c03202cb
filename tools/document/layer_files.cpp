// Layers out of a document into pictures, and back.
#include "tools/document/layer_files.hpp"

#include <filesystem>

#include "tools/document/durable.hpp"

namespace espalier::document {

namespace fs = std::filesystem;

std::string pictureOf(const Document& document, const std::string& path, size_t surface) {
    if (surface == 0 || document.scene().surfaces.size() < 2) return path;
    const fs::path file(path);
    const std::string name = file.stem().string() + "-" + std::to_string(surface) + file.extension().string();
    return (file.parent_path() / name).string();
}

namespace {

// Whole or not at all: what was there before stays if the disk is full.
bool writePicture(const std::string& path, const scene::GreyPicture& picture, std::string& error) {
    const std::string ending = fs::path(path).extension().string();
    if (ending != ".png" && ending != ".exr") {
        error = path + ": layers are written as .png or .exr";
        return false;
    }
    return writeDurably(
        path, [&](const std::string& beside, std::string& why) { return writeGrey(beside, picture, why); }, error);
}

// What of a picture isn't taken as it is.
std::string describe(const std::string& path, const scene::PictureShape& shape, uint32_t side) {
    std::string text;
    if (shape.width != side || shape.height != side)
        text = std::to_string(shape.width) + " x " + std::to_string(shape.height) + ", resampled to " +
               std::to_string(side) + " x " + std::to_string(side);
    if (shape.channels > 2) text += std::string(text.empty() ? "" : "; ") + "of its colours the red";
    return text.empty() ? text : fs::path(path).filename().string() + " is " + text;
}

}  // namespace

bool exportLayer(const Document& document, const std::string& layer, const std::string& path, std::string& error) {
    for (size_t i = 0; i < document.scene().surfaces.size(); ++i) {
        scene::GreyPicture picture;
        if (!document.readLayer(i, layer, picture, error) ||
            !writePicture(pictureOf(document, path, i), picture, error))
            return false;
    }
    return true;
}

bool exportTownLayer(const Document& document, const std::string& layer, const std::string& path, std::string& error) {
    scene::GreyPicture picture;
    return document.readTownLayer(layer, picture, error) && writePicture(path, picture, error);
}

bool importLayer(Document& document, const std::string& layer, const std::string& path, uint32_t gesture,
                 std::string& note, std::string& error) {
    note.clear();
    bool begun = false;
    for (uint32_t i = 0; i < document.scene().surfaces.size(); ++i) {
        const std::string file = pictureOf(document, path, i);
        std::error_code ignored;
        std::string said;
        if (i > 0 && !fs::exists(file, ignored)) {
            said = fs::path(file).filename().string() + " isn't there: its surface is left as it was";
        } else {
            scene::PictureShape shape;
            uint32_t side = 0;
            (void)espReadLayer(document.context(), document.scene().surfaces[i].id, layer.c_str(), nullptr, &side);
            if (!readShape(file, shape, error) || !document.perform(LoadLayer{layer, file, i}, error, gesture)) {
                std::string unheard;
                if (begun) (void)document.perform(Undo{}, unheard);
                return false;
            }
            begun = true;
            said = describe(file, shape, side);
        }
        if (!said.empty()) note += (note.empty() ? "" : "\n") + said;
    }
    return true;
}

}  // namespace espalier::document
