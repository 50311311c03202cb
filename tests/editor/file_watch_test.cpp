// Files that are touched, rewritten, restored, half written and gone.
#include "sample_game/file_watch.hpp"

#include <doctest/doctest.h>

#include <chrono>

#include "tests/tools/program.hpp"

using sample::FileWatch;

namespace {

struct Watched {
    Folder folder;
    FileWatch watch;
    int writes = 0;
    std::filesystem::file_time_type began = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);

    Watched() {
        write("model.glb", "bytes");
        write("town.json", "houses");
        watch.begin({folder.file("model.glb"), folder.file("town.json")});
    }
    // At a time of its own, `later` or before all others.
    void write(const std::string& name, const std::string& text, bool later = true) {
        folder.write(name.c_str(), text);
        const auto apart = std::chrono::seconds(++writes) * (later ? 1 : -1000);
        std::filesystem::last_write_time(folder.path / name, began + apart);
    }
    // In one of two looks: the first may find it still being written.
    bool changed() {
        const bool first = watch.changed();
        return watch.changed() || first;
    }
};

}  // namespace

TEST_CASE("a file counts as changed when it holds other bytes, not when it is touched") {
    Watched t;
    CHECK(!t.changed());
    t.write("model.glb", "bytes");
    CHECK_MESSAGE(!t.changed(), "touched");
    t.write("model.glb", "bites");
    CHECK_MESSAGE(t.changed(), "as long as it was");
    CHECK(!t.changed());
    t.write("town.json", "houses and", false);
    CHECK_MESSAGE(t.changed(), "older than it was");
    t.write("model.glb", "bytes");
    CHECK(t.changed());
    CHECK(!t.changed());
}

TEST_CASE("a file that was written while it was read counts as changed, once it stands still") {
    const auto read = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
    Watched t;  // its files were written later
    t.watch.begin({t.folder.file("model.glb")}, read);
    CHECK(t.changed());
    CHECK(!t.changed());
    t.watch.begin({t.folder.file("model.glb")}, read + std::chrono::hours(1));
    CHECK(!t.changed());
}

TEST_CASE("a file whose time lies in the future counts as changed when its bytes change, not whenever it is read") {
    const auto read = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
    Watched t;
    t.began = read + std::chrono::hours(24);
    t.write("model.glb", "bytes");
    for (int reload = 0; reload < 3; ++reload) {
        t.watch.begin({t.folder.file("model.glb")}, read);
        CHECK(!t.changed());
    }
    t.write("model.glb", "bites");
    CHECK(t.changed());
    CHECK(!t.changed());
}

TEST_CASE("a file that is being written, or isn't there, counts as it was") {
    Watched t;
    t.write("model.glb", "b");
    CHECK(!t.watch.changed());
    t.write("model.glb", "by");
    CHECK(!t.watch.changed());
    t.write("model.glb", "bytes");
    CHECK(!t.watch.changed());
    CHECK(!t.watch.changed());  // whole, and the same
    std::filesystem::remove(t.folder.path / "model.glb");
    CHECK(!t.changed());
    t.write("model.glb", "bytes");
    CHECK(!t.changed());
    t.write("model.glb", "others");
    CHECK(t.changed());
}

TEST_CASE("a file that takes another's place is noticed, be it as long and of the same instant") {
    const Folder folder;
    const std::string file = folder.write("a.grammar", "one"), other = folder.write("b.grammar", "two");
    std::filesystem::last_write_time(other, std::filesystem::last_write_time(file));
    FileWatch watch;
    watch.begin({file}, sample::kNeverWritten);
    CHECK_FALSE(watch.changed());
    std::filesystem::rename(other, file);
    bool noticed = watch.changed();
    noticed = watch.changed() || noticed;  // once it stands still
    CHECK(noticed);
}
