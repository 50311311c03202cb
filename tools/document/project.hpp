#pragma once

#include <string>
#include <vector>

#include "tools/document/document.hpp"
#include "tools/document/work.hpp"
#include "tools/scene/scene_file.hpp"

namespace espalier::document {

// A project is a folder: project.json (docs/scene_format.md), which scene::openScene opens, and the pictures of its
// layers. Saving writes new files beside the old ones and then project.json in one step, so that whenever the program
// is stopped, the project opens as it was before or as it is after. Files that no project.json names any more are
// removed afterwards.

// All that is written, taken from the document and its context; writing needs neither.
struct ProjectData {
    struct Layer {
        std::string name;
        int surface = 0;  // index into SceneFile::surfaces, or SceneLayer::kTown
        scene::GreyPicture picture;
    };
    struct Bake {
        std::string name;  // scene::keptName
        std::shared_ptr<const scene::KeptFile> file;
    };
    scene::SceneFile file;
    std::vector<Layer> layers;
    std::vector<Bake> bakes;                       // [surface]
    std::optional<scene::TownSquare> square = {};  // that the town's layers lie over
    std::vector<std::string> history = {};         // files that undo may bring back: no save removes them
};
bool gather(const Document& document, ProjectData& out, std::string& error);
// False: `error` tells file and cause, and the project is as it was. Texels are given back as they are written.
bool writeProject(ProjectData data, const std::string& folder, Progress& progress, std::string& error);
bool writeAutosave(ProjectData data, const std::string& folder, Progress& progress, std::string& error);

// Both, as work beside whatever else is done: what is saved is the document as it was when this was called, so its next
// edit is to come after Work::settle (Document::beforeEdits). Cancelled, the project is as it was.
Work::Plan saving(const Document& document, const std::string& folder);
bool saveProject(const Document& document, const std::string& folder, std::string& error);

// The same into autosave.json of the folder, which leaves project.json alone; saving removes it.
Work::Plan autosaving(const Document& document, const std::string& folder);
bool autosave(const Document& document, const std::string& folder, std::string& error);
// The autosave of a folder that was made since its project was saved, empty if there is none: a program has ended
// without saving. It is opened as any scene file.
std::string recoverable(const std::string& folder);
void dropAutosave(const std::string& folder);

}  // namespace espalier::document
