// What holds of the project's own files and of the built library, rather than of a run.
#include <doctest/doctest.h>

#include "tests/tools/program.hpp"

TEST_CASE("the program in docs/embedding.md is the one that is compiled and run") {
    const std::string program = readAll("tests/plugin/embedding_example.c");
    REQUIRE(program.size() > 500);
    CHECK(contains(readAll("docs/embedding.md"), "```c\n" + program + "```"));
}

TEST_CASE("the library shows its interface and nothing else") {
    const Ran symbols = run("nm -D --defined-only " + std::string(ESPALIER_LIBRARY));
    REQUIRE(symbols.code == 0);
    std::istringstream lines(symbols.output);
    size_t count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        const std::string name = line.substr(line.rfind(' ') + 1);
        CHECK_MESSAGE(name.rfind("esp", 0) == 0, name);
    }
    CHECK(count >= 30);
}

TEST_CASE("the runtime's folders include each other in one direction") {
    const Ran good = run("tools/lib/check_includes");
    CHECK_MESSAGE(good.code == 0, good.output);
    // And the check finds what it is for.
    const Folder folder;
    std::filesystem::create_directories(folder.path / "runtime/core");
    std::filesystem::create_directories(folder.path / "runtime/gpu");
    std::filesystem::create_directories(folder.path / "runtime/grammar");
    folder.write("runtime/core/a.cpp", "#include \"runtime/gpu/b.hpp\"\n");
    const Ran bad = run("tools/lib/check_includes " + folder.path.string());
    CHECK(bad.code == 1);
    CHECK(contains(bad.output, "runtime/core/a.cpp:1:"));
}

TEST_CASE("the compiler makes vectors of loops over lanes") {
    const std::string check = std::string("tools/lib/check_vectors ") + ESPALIER_BUILD;
    const Ran good = run(check);
    CHECK_MESSAGE(good.code == 0, good.output);
    if (!good.output.empty()) {
        MESSAGE(good.output);
        return;
    }
    // And the check finds what it is for: a loop that may end early.
    const std::string file = "runtime/host/wide_nodes.cpp", end = "l.packedTint[i] = leaf.tint;\n";
    std::string text = readAll(file);
    const size_t at = text.find(end);
    REQUIRE(at != std::string::npos);
    text.insert(at + end.size(), "if (leaf.tint == 7) return;\n");
    const Folder folder;
    const Ran bad = run(check + " " + file + " " + folder.write("early.cpp", text));
    CHECK(bad.code == 1);
    CHECK_MESSAGE(contains(bad.output, "early.cpp:"), bad.output);
}
