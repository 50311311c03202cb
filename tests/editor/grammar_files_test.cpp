// What another program writes into grammars' files, beside what is typed.
#include "sample_game/grammar_files.hpp"

#include <chrono>

#include "tests/editor/editing.hpp"

using sample::GrammarFiles;

namespace {

// Two grammars of one folder, the first of which includes a third file.
struct Texts {
    Folder folder;
    espalier::scene::Scene scene;
    GrammarFiles files;
    int writes = 0;
    std::filesystem::file_time_type began = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);

    Texts() {
        write("parts.grammar", "// parts");
        write("deep.grammar", "include \"parts.grammar\"\n");
        for (const char* name : {"a.grammar", "b.grammar"}) {
            const std::string text = name[0] == 'a' ? "  include \"deep.grammar\" // and more\nA -> NULL" : "B -> NULL";
            write(name, text);
            espalier::scene::LoadedGrammar& grammar = scene.grammars.emplace_back();
            grammar.file = folder.file(name);
            grammar.text = grammar.grows = text;
        }
        files.begin(scene);
    }
    // At a time of its own, whatever the file system's clock tells apart.
    void write(const std::string& name, const std::string& text) {
        folder.write(name.c_str(), text);
        std::filesystem::last_write_time(folder.path / name, began + std::chrono::seconds(++writes));
    }
};

}  // namespace

TEST_CASE("a grammar that was saved while the scene was read is taken over") {
    const auto read = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
    Texts t;  // its files were saved later
    t.files.begin(t.scene, read + std::chrono::hours(1));
    t.scene.grammars[1].text = "typed";
    CHECK(t.files.look(t.scene).empty());
    t.scene.grammars[1].text = "B -> before";
    t.files.begin(t.scene, read);
    const auto changes = t.files.look(t.scene);
    REQUIRE(changes.size() == 2);
    CHECK(changes[0].text == t.scene.grammars[0].text);  // compiled again: what it includes may be newer
    CHECK(changes[1].text == "B -> NULL");
    CHECK(t.files.look(t.scene).empty());
}

TEST_CASE("each grammar is judged by its own file and those that it includes, and none by a time in the future") {
    const auto read = std::filesystem::file_time_type::clock::now() - std::chrono::minutes(30);
    Texts t;
    t.scene.grammars[0].text = "typed";
    t.scene.grammars[1].text = "typed, too";
    t.began = read;
    t.write("b.grammar", "B -> C");
    t.files.begin(t.scene, read);
    auto changes = t.files.look(t.scene);
    REQUIRE(changes.size() == 1);
    CHECK(changes[0].grammar == 1);
    CHECK(changes[0].text == "B -> C");
    t.scene.grammars[1].text = "B -> C";

    t.began = read + std::chrono::hours(24);
    for (const char* name : {"c.grammar", "parts.grammar", "a.grammar"}) {
        t.write(name, name);
        for (int reload = 0; reload < 2; ++reload) {
            t.files.begin(t.scene, read + std::chrono::minutes(10));
            CHECK(t.files.look(t.scene).empty());
        }
    }
    t.write("a.grammar", "A -> B");
    changes = t.files.look(t.scene);
    REQUIRE(changes.size() == 1);
    CHECK(changes[0].text == "A -> B");
}

TEST_CASE("a grammar that is saved elsewhere is taken over, and no other one of its folder") {
    Texts t;
    CHECK(t.files.look(t.scene).empty());
    t.scene.grammars[0].text = "typed";
    t.write("b.grammar", "B -> C");
    auto changes = t.files.look(t.scene);
    REQUIRE(changes.size() == 1);
    CHECK(changes[0].grammar == 1);
    CHECK(changes[0].text == "B -> C");
    CHECK(!changes[0].replaces);
    t.scene.grammars[1].text = changes[0].text;
    CHECK(t.files.look(t.scene).empty());

    t.write("a.grammar", "A -> B");
    changes = t.files.look(t.scene);
    REQUIRE(changes.size() == 1);
    CHECK(changes[0].text == "A -> B");
    CHECK_MESSAGE(changes[0].replaces, "what was typed is told of");
    t.scene.grammars[0].text = changes[0].text;

    t.scene.grammars[0].text = "typed and saved elsewhere, too";
    t.write("a.grammar", t.scene.grammars[0].text);
    CHECK_MESSAGE(t.files.look(t.scene).empty(), "what is there already is no news");

    t.write("a.grammar", t.scene.grammars[0].text);
    CHECK_MESSAGE(t.files.look(t.scene).empty(), "the same text again is no change");
    // Restored with a time that is older than the other grammars'.
    t.folder.write("a.grammar", "A -> C");
    std::filesystem::last_write_time(t.folder.path / "a.grammar", t.began - std::chrono::hours(1));
    changes = t.files.look(t.scene);
    REQUIRE(changes.size() == 1);
    CHECK(changes[0].text == "A -> C");
    std::filesystem::remove(t.folder.path / "a.grammar");
    t.write("c.grammar", "");
    CHECK_MESSAGE(t.files.look(t.scene).empty(), "a file that has gone counts as it was");
}

TEST_CASE("what is typed stays when a file that it includes has changed, and is compiled anew") {
    Texts t;
    t.scene.grammars[0].text = "typed";
    t.write("parts.grammar", "// other parts");
    const auto changes = t.files.look(t.scene);
    REQUIRE(changes.size() == 1);
    CHECK(changes[0].grammar == 0);
    CHECK(changes[0].text == "typed");
    CHECK(!changes[0].replaces);
    t.write("deep.grammar", "include \"deep.grammar\"\ninclude \"a.grammar\"\n");  // a circle ends
    CHECK(t.files.look(t.scene).size() == 1);
}

TEST_CASE("what was written from here is no news, though it includes other files than before") {
    Texts t;
    const auto write = [&](const std::string& text) {
        t.scene.grammars[0].text = text;
        t.write("a.grammar", text);
        t.files.wrote(t.scene, 0, text);
    };
    for (const char* text : {"A -> NULL", "include \"parts.grammar\"\nA -> NULL"}) {
        write(text);
        CHECK(t.files.look(t.scene).empty());
    }
    t.write("parts.grammar", "// other parts");
    write("include \"parts.grammar\"\ninclude \"deep.grammar\"\nA -> NULL");
    CHECK_MESSAGE(t.files.look(t.scene).size() == 1, "an included file has changed, too");
    CHECK(t.files.look(t.scene).empty());
}

TEST_CASE("a file that is included from another folder counts, too") {
    Texts t;
    std::filesystem::create_directories(t.folder.path / "lib");
    const std::string text = "include \"lib/parts.grammar\"\nA -> NULL";
    t.write("lib/more.grammar", "// more");
    t.write("lib/parts.grammar", "include \"more.grammar\"\n");
    t.write("a.grammar", text);
    t.scene.grammars[0].text = text;
    t.files.begin(t.scene);
    CHECK(t.files.look(t.scene).empty());
    t.write("lib/more.grammar", "// still more");  // beside the file that includes it
    const auto changes = t.files.look(t.scene);
    REQUIRE(changes.size() == 1);
    CHECK(changes[0].grammar == 0);
    CHECK(t.files.look(t.scene).empty());
}
