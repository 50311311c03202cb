// Files that are written: whole or not at all, under names that nobody can foresee, and through no link but one that
// the user has named.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "tests/support/scratch_folder.hpp"
#include "tools/scene/text_file.hpp"
#include "tools/scene/unfinished.hpp"

using namespace espalier::scene;
using espalier::test::ScratchFolder;
namespace fs = std::filesystem;

namespace {

std::string contentOf(const std::string& path) {
    std::string text, error;
    REQUIRE_MESSAGE(readText(path, text, error), error);
    return text;
}

void put(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

size_t filesIn(const fs::path& folder) {
    return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("a name in a folder leads nowhere else") {
    for (const char* name : {"", ".", "..", "a/b", "/a", "../a"}) CHECK_FALSE(Folder::isName(name));
    CHECK_FALSE(Folder::isName(std::string_view("a\0b", 3)));
    for (const char* name : {"a", "..a", "a.exr", " "}) CHECK(Folder::isName(name));
    const ScratchFolder scratch;
    put(scratch.file("outside"), "stays");
    fs::create_directory(scratch.path / "home");
    std::string error;
    const Folder home = Folder::at(scratch.file("home"), error);
    REQUIRE(home);
    for (const char* name : {"../outside", "..", ""}) {
        Unfinished file(home, name);
        CHECK_FALSE(file.write("gone", error));
        CHECK_FALSE(home.in(name, true, error));
        home.remove(name);
    }
    CHECK(contentOf(scratch.file("outside")) == "stays");
    CHECK(filesIn(scratch.path / "home") == 0);
}

TEST_CASE("in a folder a link is replaced, and a linked folder isn't entered") {
    const ScratchFolder scratch;
    put(scratch.file("outside"), "stays");
    fs::create_directories(scratch.path / "home");
    fs::create_directories(scratch.path / "elsewhere");
    fs::create_symlink("../outside", scratch.path / "home/file");
    fs::create_symlink("../elsewhere", scratch.path / "home/layers");
    std::string error;
    const Folder home = Folder::at(scratch.file("home"), error);
    REQUIRE(home);
    CHECK(home.holdsLink("file"));
    CHECK_FALSE(home.holdsFile("file"));
    {
        Unfinished file(home, "file");
        REQUIRE_MESSAGE((file.write("new", error) && file.take(error)), error);
    }
    CHECK(home.holdsFile("file"));
    CHECK(contentOf(scratch.file("outside")) == "stays");
    CHECK(contentOf(scratch.file("home/file")) == "new");
    for (const bool make : {false, true}) {
        CHECK_FALSE(home.in("layers", make, error));
        CHECK_MESSAGE(error.find(scratch.file("home/layers") + ": can't be used: is a link") == 0, error);
    }
    home.removeFolder("layers");
    CHECK(fs::is_symlink(scratch.path / "home/layers"));
    home.remove("layers");
    CHECK(fs::exists(scratch.path / "elsewhere"));
}

TEST_CASE("what a user names is written through a link, and keeps who may read it") {
    const ScratchFolder scratch;
    put(scratch.file("real"), "old");
    ::chmod(scratch.file("real").c_str(), 0600);
    fs::create_symlink("real", scratch.path / "link");
    std::string error;
    REQUIRE_MESSAGE(writeText(scratch.file("link"), "new", error), error);
    CHECK(fs::is_symlink(scratch.path / "link"));
    CHECK(contentOf(scratch.file("real")) == "new");
    struct stat now {};
    REQUIRE(::stat(scratch.file("real").c_str(), &now) == 0);
    CHECK((now.st_mode & 0777) == 0600);
    CHECK(filesIn(scratch.path) == 2);
}

TEST_CASE("nobody can lay a file or a link where one is going to be written") {
    const ScratchFolder scratch;
    std::string error;
    std::set<std::string> seen;
    for (int i = 0; i < 20; ++i) {
        Unfinished file(scratch.file("a"));
        REQUIRE_MESSAGE(file.write("half", error), error);
        for (const auto& entry : fs::directory_iterator(scratch.path)) {
            struct stat now {};
            REQUIRE(::lstat(entry.path().c_str(), &now) == 0);
            CHECK(S_ISREG(now.st_mode));
            CHECK(seen.insert(entry.path().filename().string()).second);
        }
    }
    CHECK(seen.size() == 20);
    CHECK(filesIn(scratch.path) == 0);  // what isn't taken goes
}

TEST_CASE("where no more can be written the file that stood there stands, and nothing is left beside it") {
    const ScratchFolder scratch;
    const std::string old(5000, 'o'), longer(9000, 'n');
    put(scratch.file("a"), old);
    signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    for (const rlim_t room : {rlim_t(0), rlim_t(1), rlim_t(4096), rlim_t(8999)}) {
        const rlimit few{room, before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &few);
        std::string error;
        CHECK_FALSE(writeText(scratch.file("a"), longer, error));
        CHECK_MESSAGE(error.find(scratch.file("a") + ": can't be written: ") == 0, error);
        setrlimit(RLIMIT_FSIZE, &before);
        CHECK(contentOf(scratch.file("a")) == old);
        CHECK(filesIn(scratch.path) == 1);
    }
    signal(SIGXFSZ, SIG_DFL);
    std::string error;
    CHECK(writeText(scratch.file("a"), longer, error));
    CHECK(contentOf(scratch.file("a")) == longer);
}

TEST_CASE("a file of more bytes than are wanted isn't read") {
    const ScratchFolder scratch;
    std::string text, error;
    put(scratch.file("a"), std::string(3 << 20, 'a'));
    CHECK_FALSE(readText(scratch.file("a"), text, error, 2 << 20));
    CHECK(error == scratch.file("a") + " has more than 2 MiB");
    CHECK(readText(scratch.file("a"), text, error, 3 << 20));
}
