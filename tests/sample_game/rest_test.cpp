// A window at rest gives memory back.
#include "sample_game/rest.hpp"

#include <doctest/doctest.h>

#include "tests/tools/program.hpp"

using sample::Rest;

TEST_CASE("memory is given back once, when nothing was drawn for two seconds") {
    Rest rest;
    rest.drew(100);
    CHECK(!rest.due(100));
    CHECK(!rest.due(101.9));
    rest.drew(101.9);
    CHECK(!rest.due(102.1));
    CHECK(rest.due(103.91));
    CHECK(!rest.due(104));
    CHECK(!rest.due(1000));
    rest.drew(1000);
    CHECK(!rest.due(1001.9));
    CHECK(rest.due(1002.1));
}

TEST_CASE("a window that is left alone holds less memory afterwards, and gives it back once") {
#ifdef __SANITIZE_ADDRESS__
    MESSAGE("AddressSanitizer's heap isn't the system's; skipped");
    return;
#endif
    if (run("command -v xvfb-run").code != 0) {
        MESSAGE("xvfb-run isn't installed; skipped");
        return;
    }
    const Folder folder;
    const std::string note = folder.file("trimmed");
    // Waits for the note, and then for another one that mustn't come.
    const std::string watched =
        folder.write("watched", "HOME=" + folder.path.string() + " XDG_CONFIG_HOME=" + folder.file("config") +
                                    " LD_PRELOAD=" ESPALIER_NOTE_TRIM " NOTE_TRIM=" + note + " " +
                                    program("espalier-sample") + " " + content("sample.json") + R"( --size 480x320 &
for i in $(seq 1500); do
    [ -s )" + note + R"( ] && break
    kill -0 $! 2>/dev/null || exit 9
    sleep .2
done
sleep 3
kill $!
)");
    const Ran ran = runOnDisplay("640x480", "sh " + watched);
    CHECK_MESSAGE(ran.code == 0, ran.output);
    std::istringstream lines(readAll(note));
    long before = 0, after = 0, contexts = 0;
    REQUIRE((lines >> before >> after >> contexts));
    CHECK(contexts == 1);
    CHECK(after > 0);
    CHECK(after < before);
    MESSAGE("pages resident: " << before << ", then " << after);
    CHECK(!(lines >> before));
}
