// What other programs write while the editor is in the middle of something else than a tool's drag.
#include "tests/editor/user.hpp"

using namespace espalier::document;

namespace {

// The small scene with a grammar of the test's own, and a slider.
struct Outside : User {
    std::string grammar;
    float value = 10;

    explicit Outside(const Folder& folder)
        : User(folder, sceneOfItsOwn(folder), sample::Tool::look), grammar(folder.file("own.grammar")) {
        panel = [this] { (void)sample::slider("##value", &value, 0, 100, "%.0f"); };
        rest();
        wait();
    }
    void writeGrammar() { std::ofstream(grammar, std::ios::app) << "// saved elsewhere\n"; }
    size_t taken() {
        for (int i = 0; i < 3; ++i) (void)session.step(work, ++now);
        return all<SetText>().size();
    }
};

}  // namespace

TEST_CASE("what another program saves while a slider is dragged is taken over when that is let go") {
    const Folder folder;
    Outside user(folder);
    user.hold(user.placeOf({"##value"}));
    user.rest();
    user.point(user.mouse + glm::vec2(30, 0));
    user.rest();
    CHECK(user.work.busy);
    user.writeGrammar();
    CHECK(user.taken() == 0);
    user.letGo();
    user.rest();
    CHECK(!user.work.busy);
    CHECK(user.taken() == 1);
}

TEST_CASE("what another program saves while a run is replayed is taken over when that has ended") {
    const Folder folder;
    Outside user(folder);
    user.session.replays(folder.file("run.jsonl"));
    user.writeGrammar();
    CHECK(user.taken() == 0);
    user.session.endReplay();
    CHECK(user.taken() == 1);
}
