// The user's own files: values of parameters under names.
#include <cstdlib>

#include "sample_game/settings.hpp"
#include "tests/editor/editing.hpp"

using namespace espalier::document;
using namespace sample;

namespace {

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("a preset is kept, renamed, removed and brought back; a name that is taken is refused") {
    const Folder folder;
    const char* home = std::getenv("XDG_CONFIG_HOME");
    const std::string before = home ? home : "";
    setenv("XDG_CONFIG_HOME", folder.path.c_str(), 1);
    const std::vector<Param> long_{{"reach", {3}}, {"tint", {.1f, .2f, .3f}}}, short_{{"reach", {.5f}}};
    std::string error;
    REQUIRE_MESSAGE(writePreset("ivy", "long", long_, error), error);
    REQUIRE_MESSAGE(writePreset("ivy", "short", short_, error), error);
    REQUIRE_MESSAGE(writePreset("moss", "../../out", short_, error), error);
    CHECK(presetNames("moss") == Names{"..-..-out"});  // a name leads nowhere else

    CHECK(!renamePreset("ivy", "short", "long", error));
    CHECK_MESSAGE(contains(error, "long.json"), error);
    std::vector<Param> read;
    REQUIRE(readPreset("ivy", "long", read, error));
    CHECK(read == long_);
    REQUIRE(renamePreset("ivy", "short", "brief", error));
    CHECK(renamePreset("ivy", "brief", "brief", error));
    CHECK(presetNames("ivy") == Names{"brief", "long"});

    CHECK(removedPreset("ivy").empty());
    REQUIRE_MESSAGE(removePreset("ivy", "long", error), error);
    REQUIRE_MESSAGE(removePreset("ivy", "brief", error), error);
    CHECK(presetNames("ivy").empty());
    CHECK(removedPreset("ivy") == "brief");  // the last one
    REQUIRE_MESSAGE(writePreset("ivy", "brief", long_, error), error);
    CHECK(!restorePreset("ivy", error));  // its name has been taken since
    REQUIRE(renamePreset("ivy", "brief", "other", error));
    REQUIRE_MESSAGE(restorePreset("ivy", error), error);
    CHECK(presetNames("ivy") == Names{"brief", "other"});
    REQUIRE(readPreset("ivy", "brief", read, error));
    CHECK(read == short_);
    CHECK(removedPreset("ivy").empty());
    error.clear();
    CHECK(!removePreset("ivy", "nothing", error));
    CHECK_MESSAGE(contains(error, "nothing.json"), error);

    folder.write("espalier/presets/ivy/broken.json", "{\"params\": [{\"name\": 3}]}");
    error.clear();
    CHECK(!readPreset("ivy", "broken", read, error));
    CHECK_MESSAGE(contains(error, "broken.json:1:"), error);
    home ? setenv("XDG_CONFIG_HOME", before.c_str(), 1) : unsetenv("XDG_CONFIG_HOME");
}
