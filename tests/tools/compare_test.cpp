// espalier-compare: what is alike, and how the picture of the differences is written.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <random>

#include "tests/tools/program.hpp"
#include "tools/scene/picture.hpp"

TEST_CASE("a comparison says alike, not alike, or why it can't tell") {
    const Folder folder;
    const std::string compare = program("espalier-compare") + " ";
    const Ran made = run("convert -size 100x100 xc:gray50 " + folder.file("a.png") + " && convert " +
                         folder.file("a.png") + " -fill white -draw 'rectangle 0,0,9,9' " + folder.file("b.png") +
                         " && convert -size 10x10 xc:gray50 " + folder.file("small.png"));
    if (made.code != 0) {
        MESSAGE("ImageMagick isn't installed; skipped");
        return;
    }
    const std::string a = folder.file("a.png") + " ", b = folder.file("b.png") + " ";
    CHECK(run(compare + a + a).code == 0);
    CHECK(run(compare + a + b).code == 1);  // one in a hundred differs
    CHECK(run(compare + a + b + "--share 0.98").code == 0);
    CHECK(run(compare + a + b + "--tolerance 255").code == 0);
    CHECK(run(compare + a + b + "--diff " + folder.file("diff.png")).code == 1);
    CHECK(std::filesystem::exists(folder.file("diff.png")));
    CHECK(run(compare + a + folder.file("small.png")).code == 1);
    CHECK(run(compare + a + folder.file("none.png")).code == 2);
    for (const char* share : {"nan", "1.5", "-0.1", "half", ""})
        CHECK(run(compare + a + a + "--share '" + share + "'").code == 2);
    folder.write("torn.png", readAll(folder.file("a.png")).substr(0, 60));
    CHECK(run(compare + a + folder.file("torn.png")).code == 2);
}

TEST_CASE("a comparison keeps to its tolerance to the last step, of alpha too, and of floats to the bit") {
    const Folder folder;
    const std::string compare = program("espalier-compare") + " --share 1 ";
    const auto grey = [&](const char* name, int value) {
        std::string error;
        const std::vector<uint8_t> rgba(64, uint8_t(value));
        REQUIRE_MESSAGE(espalier::scene::writePng(folder.file(name), rgba.data(), 4, 4, error), error);
        return folder.file(name) + " ";
    };
    const std::string a = grey("a.png", 100), near = grey("near.png", 105), far = grey("far.png", 106);
    CHECK(run(compare + a + near).code == 0);
    CHECK(run(compare + a + far).code == 1);
    CHECK(run(compare + a + far + "--tolerance 6").code == 0);
    CHECK(run(compare + a + near + "--tolerance 0").code == 1);
    CHECK(run(compare + a + a + "--tolerance 0").code == 0);

    using espalier::scene::GreyPicture;
    const auto floats = [&](const char* name, float value) {
        std::string error;
        REQUIRE_MESSAGE(espalier::scene::writeGrey(folder.file(name), GreyPicture{4, 4, std::vector(16, value)}, error),
                        error);
        return folder.file(name) + " ";
    };
    const std::string half = floats("half.exr", .5f), next = floats("next.exr", .500001f),
                      same = floats("same.exr", .5f);
    CHECK(run(compare + half + next).code == 0);
    CHECK(run(compare + half + next + "--tolerance 0").code == 1);
    CHECK(run(compare + half + same + "--tolerance 0").code == 0);
    CHECK(readAll(folder.file("half.exr")) == readAll(folder.file("same.exr")));

    const Ran made = run("convert -size 4x4 xc:'rgba(100,100,100,0)' " + folder.file("clear.png") +
                         " && convert -size 4x4 xc:'rgba(100,100,100,1)' PNG32:" + folder.file("full.png"));
    if (made.code != 0) {
        MESSAGE("ImageMagick isn't installed; alpha is skipped");
        return;
    }
    CHECK(run(compare + folder.file("clear.png") + " " + folder.file("full.png")).code == 1);
}

TEST_CASE("what is written is whole, what a link leads to, and no device is replaced") {
    const Folder folder;
    std::mt19937 random(1);
    const auto noise = [&](const char* name) {
        std::vector<uint8_t> rgba(600 * 600 * 4);
        for (uint8_t& value : rgba) value = uint8_t(random());
        std::string error;
        REQUIRE_MESSAGE(espalier::scene::writePng(folder.file(name), rgba.data(), 600, 600, error), error);
        return folder.file(name) + " ";
    };
    const std::string a = noise("a.png"), b = noise("b.png");
    const std::string compare = program("espalier-compare") + " " + a + b + "--diff ";
    const std::string diff = folder.write("diff.png", "what was there");
    const size_t files = folder.count();
    CHECK(run(compare + folder.file("diff.jpg")).code == 2);
    // A file of 32 KiB, 64 blocks, is as full a disk.
    const Ran full = run("trap '' XFSZ; ulimit -f 64; " + compare + diff);
    CHECK(full.code == 2);
    CHECK_MESSAGE(contains(full.output, "diff.png: can't be written"), full.output);
    CHECK(readAll(diff) == "what was there");
    CHECK(folder.count() == files);

    std::filesystem::create_symlink("diff.png", folder.path / "link.png");
    CHECK(run(compare + folder.file("link.png")).code == 1);
    CHECK(std::filesystem::is_symlink(folder.path / "link.png"));
    CHECK(readAll(diff).substr(1, 3) == "PNG");

    const std::string pipe = folder.file("pipe");
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    run("timeout 20 cat " + pipe + " > " + folder.file("got") + " & " + compare + pipe + "; wait");
    CHECK(std::filesystem::is_fifo(pipe));
    CHECK(readAll(folder.file("got")) == readAll(diff));
}
