// What a save may touch: files of the project's own folder, through no link, and none that another text there names.
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <map>

#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;
namespace fs = std::filesystem;

namespace {

// A project whose layer was filled, and a folder beside it that is none of its business.
struct Garden {
    Folder folder;
    Editing editing;
    std::string path = folder.file("garden"), outside = folder.file("outside");

    Garden() : editing(smallScene(folder)) {
        fs::create_directories(outside);
        folder.write("outside/mask-0-0123456789abcdef.exr", "another's");
        folder.write("outside/notes.txt", "another's");
        fill(.25f);
    }
    void fill(float value) { REQUIRE(editing.perform(FillLayer{"mask", value})); }
    void save() { REQUIRE_MESSAGE(saveProject(*editing.document, path, editing.error), editing.error); }
    // The save fails, and says why.
    void refuse(const std::string& where, const std::string& cause) {
        editing.error.clear();
        CHECK_FALSE(saveProject(*editing.document, path, editing.error));
        CHECK_MESSAGE(contains(editing.error, path + where), editing.error);
        CHECK_MESSAGE(contains(editing.error, cause), editing.error);
        CHECK(outsideStands());
    }
    bool outsideStands() const {
        size_t files = 0;
        for (const auto& entry : fs::recursive_directory_iterator(outside)) {
            files += 1;
            if (readAll(entry.path()) != "another's") return false;
        }
        return files == 2;
    }
    // Instead of what lies there.
    void link(const std::string& name, const fs::path& to) const {
        fs::remove_all(path + name);
        fs::create_symlink(to, path + name);
    }
    std::vector<std::string> layers() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(path + "/layers")) names.push_back(entry.path().string());
        return names;
    }
};

std::map<std::string, std::string> contentsOf(const std::string& folder) {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) all[entry.path().string()] = readAll(entry.path());
    return all;
}

}  // namespace

TEST_CASE("a save goes into no linked folder, and sweeps none out") {
    Garden garden;
    garden.save();
    for (const char* place : {"/layers", "/surfaces"}) {
        garden.link(place, garden.outside);
        garden.fill(.3f);
        garden.refuse(place, "is a link");
        fs::remove(garden.path + place);
        garden.save();
    }
    // Of a document that has no layers: nothing is written there, and nothing may be removed.
    Editing bare(smallScene(garden.folder));
    for (const char* place : {"/layers", "/surfaces", "/plants"}) garden.link(place, garden.outside);
    REQUIRE_MESSAGE(saveProject(*bare.document, garden.path, bare.error), bare.error);
    CHECK(garden.outsideStands());
    CHECK(fs::is_symlink(garden.path + "/layers"));
}

TEST_CASE("a save and an autosave go through no link in place of a project's files") {
    Garden garden;
    garden.save();
    const std::string victim = garden.outside + "/notes.txt";
    garden.link("/project.json", victim);
    garden.refuse("/project.json", "is a link");
    garden.link("/project.json", garden.outside + "/made");
    garden.refuse("/project.json", "is a link");
    fs::remove(garden.path + "/project.json");
    garden.link("/autosave.json", victim);
    CHECK_FALSE(autosave(*garden.editing.document, garden.path, garden.editing.error));
    CHECK_MESSAGE(contains(garden.editing.error, "autosave.json: is a link"), garden.editing.error);
    garden.link("/.writing", victim);
    garden.refuse("/.writing", "is a link");
    garden.link("/.writing", garden.outside + "/made");
    garden.refuse("/.writing", "is a link");
    fs::remove(garden.path + "/.writing");
    garden.save();
    CHECK(garden.outsideStands());
    CHECK_FALSE(fs::exists(fs::symlink_status(garden.path + "/autosave.json")));  // as after any save
}

TEST_CASE("a layer's file that is a link is written anew in its place") {
    Garden garden;
    garden.save();
    REQUIRE(garden.layers().size() == 1);
    const std::string layer = garden.layers()[0], whole = readAll(layer);
    fs::remove(layer);
    fs::create_symlink(garden.outside + "/notes.txt", layer);
    garden.save();
    CHECK(fs::is_regular_file(fs::symlink_status(layer)));
    CHECK(readAll(layer) == whole);
    CHECK(garden.outsideStands());
}

TEST_CASE("a layer with a long name is saved and comes back; one whose name leads elsewhere is refused") {
    Garden garden;
    const std::string name(300, 'l');
    const auto fill = [&](const std::string& layer) {  // the document takes less, its context any
        EspStroke filled{};
        REQUIRE(espFillLayer(garden.editing.context.get(), layer.c_str(), .5f, &filled) == ESP_OK);
    };
    fill(name);
    garden.save();
    garden.save();  // which sweeps
    CHECK(garden.layers().size() == 2);
    Editing opened(garden.path);
    espalier::scene::GreyPicture picture;
    REQUIRE_MESSAGE(opened.document->readLayer(0, name, picture, opened.error), opened.error);
    CHECK(picture.texels[0] == .5f);
    const auto before = contentsOf(garden.path);
    for (const char* leading : {"../../outside/evil", "/etc/evil", ".unfinished-1"}) fill(leading);
    garden.refuse("", "evil");
    CHECK(contentsOf(garden.path) == before);
}

TEST_CASE("a text that a killed program has left unfinished keeps no layer") {
    Garden garden;
    garden.save();
    const std::string older = garden.layers()[0];
    const std::string left = garden.path + "/.unfinished-999999999-0123456789abcdef";
    fs::copy_file(garden.path + "/project.json", left);
    garden.fill(.5f);
    garden.save();
    CHECK_FALSE(fs::exists(left));
    CHECK_FALSE(fs::exists(older));
    CHECK(garden.layers().size() == 1);
}

TEST_CASE("a layer that another text in the folder names stays as long as that is there") {
    Garden garden;
    garden.save();
    const std::string older = garden.layers()[0], name = fs::path(older).filename().string();
    fs::copy_file(garden.path + "/project.json", garden.path + "/before the storm.backup");
    garden.fill(.5f);
    garden.save();
    CHECK(garden.layers().size() == 2);
    CHECK(fs::exists(older));
    fs::rename(garden.path + "/before the storm.backup", garden.path + "/older.json");
    CHECK(Editing(garden.path + "/older.json").document->scene().notes.empty());
    fs::remove(garden.path + "/older.json");
    // A run, and a text that begins with a mark and writes slashes as some programs do.
    garden.folder.write("garden/a.jsonl",
                        "{\"espalier_run\":1}\n{\"load_layer\":{\"file\":\"layers/" + name + "\"}}\n");
    garden.fill(.6f);
    garden.save();
    CHECK(fs::exists(older));
    fs::remove(garden.path + "/a.jsonl");
    garden.folder.write("garden/b", "\xEF\xBB\xBF \n{\"layers\": {\"mask\": \"layers\\/" + name + "\"}}");
    garden.fill(.7f);
    garden.save();
    CHECK(fs::exists(older));
    fs::remove(garden.path + "/b");
    // In a folder of the project's, behind many blanks, and with a letter that is written by its number.
    std::string escaped = name;
    char digits[8];
    std::snprintf(digits, sizeof digits, "\\u%04x", unsigned(escaped[escaped.size() - 6]));
    escaped.replace(escaped.size() - 6, 1, digits);
    fs::create_directories(garden.path + "/scenes/old");
    garden.folder.write("garden/scenes/old/c.json",
                        std::string(5000, ' ') + "{\"layers\": {\"mask\": \"../../layers/" + escaped + "\"}}");
    garden.fill(.75f);
    garden.save();
    CHECK(fs::exists(older));
    fs::remove_all(garden.path + "/scenes");
    garden.fill(.8f);
    garden.save();
    CHECK_FALSE(fs::exists(older));
    CHECK(garden.layers().size() == 1);
}

TEST_CASE("wherever a disk is full during a save, the project stands as it was, and the save says so") {
    Garden garden;
    garden.save();
    const auto before = contentsOf(garden.path);
    garden.fill(.9f);
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit unlimited{};
    getrlimit(RLIMIT_FSIZE, &unlimited);
    int failed = 0;
    for (const rlim_t room : {0, 1, 100, 500, 1000, 2000, 4000}) {
        const rlimit few{room, unlimited.rlim_max};
        setrlimit(RLIMIT_FSIZE, &few);
        garden.editing.error.clear();
        const bool saved = saveProject(*garden.editing.document, garden.path, garden.editing.error);
        setrlimit(RLIMIT_FSIZE, &unlimited);
        if (saved) break;
        ++failed;
        CHECK_MESSAGE(contains(garden.editing.error, "can't be written"), garden.editing.error);
        CHECK_MESSAGE(contains(garden.editing.error, garden.path), garden.editing.error);
        CHECK(contentsOf(garden.path) == before);
    }
    std::signal(SIGXFSZ, SIG_DFL);
    CHECK(failed >= 3);
    garden.save();
}
