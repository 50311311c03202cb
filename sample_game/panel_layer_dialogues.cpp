// Pictures of layers, out and in, beside the frames.
#include <filesystem>

#include "sample_game/dialogue.hpp"
#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"
#include "tools/document/layer_files.hpp"

namespace sample {
namespace {

using namespace espalier::document;

// The end of the work, for the dialogue and the line at the bottom.
void tell(Workspace& work, const Work& over, const std::string& message) {
    work.redraw = true;
    work.error = over.error();
    work.message = over.state() == Work::State::done ? message : "";
    endWait(work, over.state() == Work::State::done);
}

// The path that was asked for and, beside it, those of the other surfaces' pictures that are there.
std::string named(const Workspace& work, bool town, const std::string& file) {
    std::string text = wholePath(file);
    for (size_t i = 1; !town && i < work.scene().surfaces.size(); ++i) {
        const std::filesystem::path other = pictureOf(*work.document, file, i);
        std::error_code ignored;
        if (std::filesystem::exists(other, ignored)) text += ", " + other.filename().string();
    }
    return text;
}

void importFrom(Workspace& work, Session& session, bool town, const std::string& file) {
    const uint32_t gesture = work.newGesture();
    session.background().ask(
        {"Importing " + file,
         [&work, layer = dialogues().layer, file, gesture] { return importing(*work.document, layer, file, gesture); },
         [&work, town, file](const Work& over) {
             const std::string note = over.note();
             tell(work, over, "Read: " + named(work, town, file) + (note.empty() ? "" : " (" + note + ")"));
         }});
}

void exportTo(Workspace& work, Session& session, bool town, const std::string& file) {
    const std::string layer = dialogues().layer;
    session.background().ask(
        {"Exporting " + layer, [&work, layer, file] { return exporting(*work.document, layer, file); },
         [&work, town, file](const Work& over) { tell(work, over, "Written: " + named(work, town, file)); }});
}

}  // namespace

void layerDialogues(Workspace& work, Session& session) {
    Dialogues& d = dialogues();
    const bool town = work.townLayer(d.layer);
    const size_t surfaces = town ? 1 : work.scene().surfaces.size();
    const std::string others =
        surfaces > 1 ? "\nIt is the first surface's; those of the others are called so, with -1, -2 ..." : "";
    const std::string read =
        (town ? "Picture of " + d.layer + " over the town, from above, north up (.png, .exr):"
              : "Picture of " + d.layer + " over the surface's atlas (F5), as Export writes it (.png, .exr):") +
        others;
    const std::string written = "File of the picture of " + d.layer + " (.png: 16 bits, .exr: floats):" + others;
    const std::vector<std::string> endings{".png", ".exr"};
    askPath(work, session, {"Import a layer", read.c_str(), "Import", d.picture, endings},
            [&](const char* file) { importFrom(work, session, town, file); });
    const auto taken = [&](const std::string& file) -> Doubt {
        for (size_t i = 0; i < surfaces; ++i) {
            const std::string each = town ? file : pictureOf(*work.document, file, i);
            std::error_code ignored;
            if (std::filesystem::exists(each, ignored)) return {wholePath(each) + " is there already."};
        }
        return {};
    };
    askPath(work, session, {"Export a layer", written.c_str(), "Export", d.picture, endings, false, taken},
            [&](const char* file) { exportTo(work, session, town, file); });
}

void askForLayer(const std::string& layer, bool import) {
    Dialogues& d = dialogues();
    if (d.layer != layer || !d.picture[0]) put(d.picture, layer + ".png");
    d.layer = layer;
    const std::string name = d.picture.data();
    if (!import) put(d.picture, freeName(name, std::filesystem::path(name).extension().string()));
    ask(import ? "Import a layer" : "Export a layer");
}

}  // namespace sample
