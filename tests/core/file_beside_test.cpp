// Which files a document may name.
#include "runtime/core/file_beside.hpp"

#include <doctest/doctest.h>

#include "runtime/core/file.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace espalier;
using namespace espalier::test;

namespace fs = std::filesystem;

TEST_CASE("a document names files near it, and no others") {
    ScratchFolder scratch;
    const fs::path document = scratch.path / "a/kit/models/house.obj";
    for (const char* name :
         {"a/kit/models/house.obj", "a/kit/models/sub/wall.png", "a/kit/textures/wall.png", "a/top.png", "outside.png"})
        REQUIRE(writeFile(scratch.path / name, std::string_view("x")));
    const auto placed = [&](std::string_view name) {
        auto place = placeBeside(document, name);
        return place ? fs::weakly_canonical(*place).lexically_relative(fs::canonical(scratch.path)).string()
                     : "refused: " + place.failure().text();
    };
    const auto refused = [&](std::string_view name, const std::string& why) {
        const std::string said = placed(name);
        CAPTURE(said);
        CHECK(said.starts_with("refused: " + document.string()));
        CHECK(said.find(why) != std::string::npos);
    };
    CHECK(placed("sub/wall.png") == "a/kit/models/sub/wall.png");
    CHECK(placed("sub\\wall.png") == "a/kit/models/sub/wall.png");
    CHECK(placed("./sub/../sub/wall.png") == "a/kit/models/sub/wall.png");
    CHECK(placed("../textures/wall.png") == "a/kit/textures/wall.png");
    CHECK(placed("../../top.png") == "a/top.png");
    refused("../../../outside.png", "2 folders above");
    refused("sub/../../../../outside.png", "2 folders above");
    // What isn't there is named all the same.
    CHECK(placed("missing.png") == "a/kit/models/missing.png");

    SUBCASE("absolute paths count by their last part") {
        REQUIRE(writeFile(scratch.path / "a/kit/models/wall.png", std::string_view("x")));
        for (const char* name :
             {"/etc/wall.png", "C:\\Users\\me\\wall.png", "c:wall.png", "\\\\server\\share\\wall.png"})
            CHECK(placed(name) == "a/kit/models/wall.png");
    }
    SUBCASE("capital letters as another system had them") {
        CHECK(placed("Sub/WALL.PNG") == "a/kit/models/sub/wall.png");
        CHECK(placed("../Textures/Wall.png") == "a/kit/textures/wall.png");
        REQUIRE(writeFile(scratch.path / "a/kit/models/sub/WALL.PNG", std::string_view("x")));
        CHECK(placed("sub/WALL.PNG") == "a/kit/models/sub/WALL.PNG");
    }
    SUBCASE("links lead no farther than paths do") {
        fs::create_symlink("../../top.png", scratch.path / "a/kit/models/near.png");
        fs::create_symlink(scratch.path / "outside.png", scratch.path / "a/kit/models/far.png");
        fs::create_directory_symlink("/etc", scratch.path / "a/kit/models/etc");
        CHECK(placed("near.png") == "a/top.png");
        refused("far.png", "is a link that leads out");
        refused("etc/hostname", "is a link that leads out");
    }
    SUBCASE("no names") {
        refused("", "no file's name");
        refused("..", "no file's name");
        refused("sub/", "no file's name");
        refused(std::string_view("a\0b", 3), "'a' is no file's name");
        refused("https://example.org/wall.png", "is an address");
    }
}
