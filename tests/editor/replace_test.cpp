// What lies where something is to be saved, and what is offered instead.
#include <imgui_internal.h>

#include <chrono>

#include "sample_game/dialogue.hpp"
#include "sample_game/folder_list.hpp"
#include "sample_game/panels.hpp"
#include "tests/editor/imgui_keys.hpp"
#include "tests/editor/window.hpp"
#include "tools/document/project.hpp"

namespace {

namespace fs = std::filesystem;
using sample::dialogues;
using Turn = sample::Dialogues::Turn;

// A window whose dialogues are laid out and answered by Return.
struct Answered : Editor {
    Answered(const Folder& folder, const std::string& file) : Editor(folder, file, sample::Tool::look) {
        panels = [this] { sample::showDialogues(work, session); };
        dialogues() = {};
    }
    ~Answered() {
        sample::closeDialogues();
        dialogues() = {};
    }
    void settle() {
        for (int i = 0; i < 4; ++i) {
            frame({});
            session.background().finish();
        }
    }
    void enter() {
        settle();
        for (const bool down : {true, false}) {
            setKey(ImGuiKey_Enter, down);
            frame({});
        }
        settle();
    }
};

void touch(const std::string& file) {
    fs::last_write_time(file, fs::file_time_type::clock::now() + std::chrono::seconds(5));
}

}  // namespace

TEST_CASE("another's project is replaced only when that is confirmed, and one's own that nobody else saved at once") {
    const Folder folder;
    const std::string garden = folder.file("garden"), json = garden + "/project.json";
    Answered window(folder, smallScene(folder));
    REQUIRE_MESSAGE(saveProject(*window.work.document, garden, window.work.error), window.work.error);
    const std::string before = readAll(json);
    window.fill(.5f);
    CHECK(!sample::askToSave(window.work, window.session));
    sample::put(dialogues().project, garden);
    window.enter();
    CHECK(dialogues().turn == Turn::confirms);
    CHECK_MESSAGE(contains(dialogues().why, garden + " is a project already"), dialogues().why);
    CHECK(readAll(json) == before);
    window.settle();
    ImGui::GetIO().AddInputCharacter('x');
    window.settle();
    CHECK(dialogues().turn == Turn::asks);  // another path is another question
    sample::closeDialogues();
    window.settle();
    CHECK(!sample::askToSave(window.work, window.session));
    sample::put(dialogues().project, garden);
    window.enter();
    CHECK(dialogues().turn == Turn::confirms);
    window.enter();
    CHECK(readAll(json) != before);
    CHECK(window.session.folder() == garden);
    CHECK(!fs::exists(garden + "x"));

    window.fill(.75f);
    CHECK(sample::askToSave(window.work, window.session));
    window.settle();
    CHECK(!window.session.modified(window.work));

    touch(json);
    window.fill(.25f);
    const std::string theirs = readAll(json);
    CHECK(!sample::askToSave(window.work, window.session));
    window.settle();
    CHECK(dialogues().turn == Turn::confirms);
    CHECK_MESSAGE(contains(dialogues().why, "saved by somebody else"), dialogues().why);
    CHECK(readAll(json) == theirs);
    window.enter();
    CHECK(readAll(json) != theirs);
    CHECK(sample::askToSave(window.work, window.session));
    window.settle();
}

TEST_CASE("Ctrl+Shift+S saves elsewhere, and what is offered is free") {
    const Folder folder;
    const std::string garden = folder.file("garden");
    Answered window(folder, smallScene(folder));
    REQUIRE(window.save(garden));
    window.key(GLFW_KEY_S, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
    window.settle();
    CHECK(std::string(dialogues().project.data()) == garden + "-2");
    window.enter();
    CHECK(window.session.folder() == garden + "-2");
    CHECK(fs::exists(garden + "/project.json"));

    sample::put(dialogues().run, folder.write("run.jsonl", "{}"));
    sample::askToRecord();
    CHECK(std::string(dialogues().run.data()) == folder.file("run-2.jsonl"));
    sample::put(dialogues().run, folder.file("run"));  // its ending comes by itself
    window.enter();
    CHECK(dialogues().turn == Turn::confirms);
    CHECK(readAll(folder.file("run.jsonl")) == "{}");
    window.enter();
    CHECK(window.session.recording());

    CHECK(sample::freeName(folder.file("v1.2")) == folder.file("v1.2"));
    folder.write("v1.2", "");
    folder.write("v1.2-2", "");
    CHECK(sample::freeName(folder.file("v1.2")) == folder.file("v1.2-3"));
    std::filesystem::create_symlink(folder.file("elsewhere"), folder.file("v1.2-3"));
    CHECK(sample::freeName(folder.file("v1.2")) == folder.file("v1.2-4"));  // a link, too, be there nothing behind it
}

TEST_CASE("a picture is written over another only when that is confirmed") {
    const Folder folder;
    Answered window(folder, smallScene(folder));
    window.fill(.5f);
    const std::string path = folder.write("mask.exr", "somebody's");
    sample::askForLayer("mask", false);
    sample::put(dialogues().picture, path);
    window.enter();
    CHECK(readAll(path) == "somebody's");
    CHECK(dialogues().turn == Turn::confirms);
    window.enter();
    CHECK(readAll(path) != "somebody's");
    // Once more it is offered a name that is free, of the kind that was taken.
    sample::askForLayer("mask", false);
    CHECK(std::string(dialogues().picture.data()) == folder.file("mask-2.exr"));
    sample::put(dialogues().picture, folder.write("mask.png", ""));
    sample::askForLayer("mask", false);
    CHECK(std::string(dialogues().picture.data()) == folder.file("mask-2.png"));
}

TEST_CASE("what couldn't be saved while another dialogue was open is asked about after it, unless saved by then") {
    const Folder folder;
    const auto isOpen = [](const char* title) {
        const ImGuiWindow* found = ImGui::FindWindowByName(title);
        return found && found->WasActive;
    };
    for (const bool saved : {false, true}) {
        CAPTURE(saved);
        Answered window(folder, smallScene(folder));
        window.fill(.5f);
        sample::askForLayer("mask", false);
        window.settle();
        REQUIRE(dialogues().asks);
        dialogues().unsaved = "no room";
        window.settle();
        CHECK(!isOpen("Save the project"));
        CHECK(dialogues().unsaved == "no room");
        if (saved) REQUIRE(window.save(folder.file("elsewhere")));
        ImGui::ClosePopupToLevel(0, true);
        window.settle();
        CHECK(dialogues().unsaved.empty());
        CHECK(isOpen("Save the project") == !saved);
    }
}
