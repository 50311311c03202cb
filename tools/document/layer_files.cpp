// Layers out of a document into pictures, and back.
#include "tools/document/layer_files.hpp"

#include <algorithm>
#include <deque>
#include <filesystem>

#include "tools/scene/layers.hpp"
#include "tools/scene/text_file.hpp"
#include "tools/scene/unfinished.hpp"

namespace espalier::document {

namespace fs = std::filesystem;

std::string pictureOf(const Document& document, const std::string& path, size_t surface) {
    if (surface == 0 || document.scene().surfaces.size() < 2) return path;
    const fs::path file(path);
    const std::string name = file.stem().string() + "-" + std::to_string(surface) + file.extension().string();
    return (file.parent_path() / name).string();
}

namespace {

struct Exported {
    std::string path;
    std::vector<scene::GreyPicture> channels;  // one, or red, green and blue
};

// All of them or, before the first is whole, none.
bool writePictures(std::vector<Exported> pictures, Progress& progress, std::string& error) {
    std::deque<scene::Unfinished> files;
    const float each = 1 / float(pictures.size());
    for (Exported& e : pictures) {
        const std::vector<scene::GreyPicture> channels = std::move(e.channels);
        const float written = float(files.size());
        const auto goOn = [&](float part) { return progress.at((written + part) * each); };
        std::vector<uint8_t> bytes;
        if (!goOn(0) || !encodeChannels(e.path, channels, bytes, error, goOn)) return false;
        scene::Unfinished& file = files.emplace_back(e.path);
        if (!file.write(scene::asText(bytes), error) || !file.flush(error)) return false;
    }
    return progress.at(1) && std::ranges::all_of(files, [&](scene::Unfinished& file) {
               return file.take(error) && file.folder().flush(error);
           });
}

struct Imported {
    std::string path;
    scene::PictureShape shape;
    Picture picture;  // null: its surface keeps its layer
};

// Texels a side.
uint32_t sideOf(const Document& document, const std::string& layer, bool town, size_t surface) {
    uint32_t side = 0;
    if (town)
        (void)espReadTownLayer(document.context(), layer.c_str(), nullptr, &side);
    else
        (void)espReadLayer(document.context(), document.scene().surfaces[surface].id, layer.c_str(), nullptr, &side);
    return side;
}

// What of a picture isn't taken as it is.
std::string describe(const Imported& p, uint32_t side) {
    const std::string name = fs::path(p.path).filename().string();
    if (!p.picture) return name + " isn't there: its surface is left as it was";
    std::string text;
    if (p.shape.width != side || p.shape.height != side)
        text = std::to_string(p.shape.width) + " x " + std::to_string(p.shape.height) + ", resampled to " +
               std::to_string(side) + " x " + std::to_string(side);
    if (p.shape.channels > 2 && p.picture->size() == 1)
        text += std::string(text.empty() ? "" : "; ") + "of its colours the red";
    if (const uint64_t limited = p.picture->front().limited)
        text += std::string(text.empty() ? "" : "; ") + std::to_string(limited) + " values limited to 0 to 1";
    return text.empty() ? text : name + ": " + text;
}

bool readPictures(std::vector<Imported>& pictures, bool colour, Progress& progress, std::string& error) {
    for (size_t i = 0; i < pictures.size(); ++i) {
        Imported& p = pictures[i];
        std::error_code ignored;
        if (!progress.at(float(i) / float(pictures.size()))) return false;
        if (i > 0 && !fs::exists(p.path, ignored)) continue;
        const auto picture = std::make_shared<std::vector<scene::GreyPicture>>();
        if (!readShape(p.path, p.shape, error) || !readChannels(p.path, colour, *picture, error)) return false;
        p.picture = picture;
    }
    return progress.at(1);
}

bool liesOverTown(const Document& document, const std::string& layer) {
    const scene::Scene& scene = document.scene();
    return scene::isTownsAlone(document.context(), scene, channelsOf(scene, layer)[0]);
}

Work::Plan refusing(const std::string& why) {
    Work::Plan plan;
    plan.before.push_back([why](std::string& error) {
        error = why;
        return false;
    });
    return plan;
}

}  // namespace

Work::Plan exporting(const Document& document, const std::string& layer, const std::string& path) {
    Work::Plan plan;
    const bool town = liesOverTown(document, layer);
    const std::string ending = fs::path(path).extension().string();
    if (ending != ".png" && ending != ".exr") return refusing(path + ": layers are written as .png or .exr");
    const auto pictures = std::make_shared<std::vector<Exported>>(town ? 1 : document.scene().surfaces.size());
    if (pictures->empty()) return refusing(path + ": there is no surface whose layer it could be");
    for (size_t i = 0; i < pictures->size(); ++i) {
        Exported& e = (*pictures)[i];
        e.path = town ? path : pictureOf(document, path, i);
        for (const std::string& channel : channelsOf(document.scene(), layer))
            plan.before.push_back([&document, &e, channel, town, i](std::string& error) {
                scene::GreyPicture& picture = e.channels.emplace_back();
                return town ? document.readTownLayer(channel, picture, error)
                            : document.readLayer(i, channel, picture, error);
            });
    }
    plan.beside = [pictures](Progress& progress, std::string& error) {
        return writePictures(std::move(*pictures), progress, error);
    };
    return plan;
}

bool exportLayer(const Document& document, const std::string& layer, const std::string& path, std::string& error) {
    return Work(exporting(document, layer, path)).finish(error);
}

Work::Plan importing(Document& document, const std::string& layer, const std::string& path, uint32_t gesture) {
    Work::Plan plan;
    const bool town = liesOverTown(document, layer);
    const auto pictures = std::make_shared<std::vector<Imported>>(town ? 1 : document.scene().surfaces.size());
    if (pictures->empty()) return refusing(path + ": there is no surface whose layer it could be");
    const auto note = plan.note = std::make_shared<std::string>();
    plan.beside = [pictures, colour = isColour(document.scene(), layer)](Progress& progress, std::string& error) {
        return readPictures(*pictures, colour, progress, error);
    };
    for (uint32_t i = 0; i < pictures->size(); ++i) {
        Imported& p = (*pictures)[i];
        p.path = town ? path : pictureOf(document, path, i);
        plan.after.push_back([&document, &p, note, layer, town, gesture, i](std::string& error) {
            const Action load =
                town ? Action(LoadTownLayer{layer, p.path, p.picture}) : Action(LoadLayer{layer, p.path, i, p.picture});
            if (p.picture && !document.perform(load, error, gesture)) return false;
            const std::string said = describe(p, sideOf(document, channelsOf(document.scene(), layer)[0], town, i));
            p.picture.reset();
            *note += (note->empty() || said.empty() ? "" : "; ") + said;
            return true;
        });
    }
    plan.takeBack = [&document] {
        std::string unheard;
        (void)document.perform(Undo{}, unheard);
    };
    return plan;
}

}  // namespace espalier::document
