// What dialogues offer instead of a typed path.
#include "sample_game/folder_list.hpp"

#include "tests/editor/editing.hpp"

using sample::FolderEntry, sample::listFolder, sample::wholePath;

namespace {

std::string namesOf(const std::vector<FolderEntry>& entries) {
    std::string all;
    for (const FolderEntry& entry : entries) all += entry.name + " ";
    return all;
}

}  // namespace

TEST_CASE("a dialogue lists folders, projects and the files of its kind beside what is typed") {
    const Folder folder;
    for (const char* name : {"b.json", "a.glb", "notes.txt", ".hidden.json"}) folder.write(name, "{}");
    for (const char* name : {"zoo", "garden"}) std::filesystem::create_directory(folder.path / name);
    folder.write("garden/project.json", "{}");
    const std::string in = folder.path.string() + "/";

    const auto all = listFolder(in, {".json", ".glb"});
    CHECK(namesOf(all) == ".. garden zoo/ a.glb b.json ");
    CHECK(all[0].path == folder.path.parent_path().string() + "/");
    CHECK(all[1].kind == FolderEntry::project);
    CHECK(all[1].path == in + "garden");
    CHECK_MESSAGE(listFolder(all[1].path, {".json", ".glb"})[1].path == all[1].path, "clicked, it stays where it was");
    CHECK(all[2].kind == FolderEntry::folder);
    CHECK(all[3].kind == FolderEntry::file);
    CHECK(all[4].path == in + "b.json");
    // A name that is being typed, there or not, stays in its folder.
    CHECK(namesOf(listFolder(in + "gard", {})) == ".. garden zoo/ ");
    CHECK(namesOf(listFolder(all[1].path + "/", {".json"})) == ".. project.json ");
    CHECK(namesOf(listFolder(in + "no such/", {".json"})) == ".. ");
    CHECK(listFolder("/", {})[0].name != "..");

    CHECK(wholePath(in) == folder.path.string());
    CHECK(wholePath("x.png") == (std::filesystem::current_path() / "x.png").string());
}
