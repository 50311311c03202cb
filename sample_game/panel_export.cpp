// What grows, out as glTF, beside the frames.
#include <filesystem>

#include "sample_game/dialogue.hpp"
#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"
#include "tools/export/export_work.hpp"

namespace sample {
namespace {

namespace fs = std::filesystem;
using espalier::document::Work;

std::string withEnding(const std::string& file) {
    return fs::path(file).extension() == ".glb" ? file : file + ".glb";
}

void exportTo(Workspace& work, Session& session, const std::string& file) {
    session.background().ask({"Exporting " + fs::path(file).filename().string(),
                              [&work, file] { return espalier::exporting::exportingTo(work.context.get(), {}, file); },
                              [&work, file](const Work& over) {
                                  const bool good = over.state() == Work::State::done;
                                  work.redraw = true;
                                  work.error = over.error();
                                  work.message = good ? "Written: " + wholePath(file) + " (" + over.note() + ")" : "";
                                  endWait(work, good);
                              }});
}

}  // namespace

void askToExport(const Workspace& work) {
    PathText& file = dialogues().grown;
    put(file, freeName(file[0] ? file.data() : fs::path(work.scene().name).stem().string() + ".glb", ".glb"));
    ask("Export what grows");
}

void exportDialogue(Workspace& work, Session& session) {
    const auto taken = [](const std::string& file) -> Doubt {
        std::error_code ignored;
        return {fs::exists(fs::symlink_status(withEnding(file), ignored))
                    ? wholePath(withEnding(file)) + " is there already."
                    : ""};
    };
    askPath(work, session,
            {"Export what grows",
             "File for engines and Blender (.glb):",
             "Export",
             dialogues().grown,
             {".glb"},
             false,
             taken},
            [&](const char* file) { exportTo(work, session, withEnding(file)); });
}

}  // namespace sample
