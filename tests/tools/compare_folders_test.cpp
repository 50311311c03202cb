// espalier-compare over folders: which pictures belong together, its reports, and the page that a browser shows.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/program.hpp"
#include "tools/scene/picture.hpp"

namespace compare_folders {
namespace {

using espalier::scene::writePng;

// Grey, with a lighter box of the given place and size.
struct Lighter {
    uint32_t left = 0, top = 0, width = 0, height = 0;
};
void paint(const std::filesystem::path& file, Lighter box = {}, uint32_t side = 40) {
    std::vector<uint8_t> rgba(4 * size_t(side) * side, 255);
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            const bool inside = x - box.left < box.width && y - box.top < box.height;
            for (uint32_t c = 0; c < 3; ++c) rgba[4 * (size_t(y) * side + x) + c] = inside ? 200 : 100;
        }
    std::string error;
    std::filesystem::create_directories(file.parent_path());
    REQUIRE_MESSAGE(writePng(file.string(), rgba.data(), side, side, error), error);
}

struct Folders : Folder {
    std::string asked = program("espalier-compare") + " " + file("approved") + " " + file("new") + " ";
    void both(const char* name, Lighter changed = {}) const {
        paint(path / "approved" / name);
        paint(path / "new" / name, changed);
    }
    nlohmann::json json() const { return nlohmann::json::parse(readAll(path / "all.json")); }
};

}  // namespace

TEST_CASE("pictures of two folders are compared by their names, and reports say which differ, where and by how much") {
    const Folders folder;
    folder.both("frame_0000.png");
    folder.both("evening/frame_0000.png");
    CHECK(run(folder.asked).code == 0);
    folder.both("frame_0001.png", {5, 7, 10, 4});
    folder.both("a&b.png", {0, 0, 40, 40});
    paint(folder.path / "approved/lost.png");
    paint(folder.path / "new/gained.png");
    paint(folder.path / "approved/small.png", {}, 8);
    paint(folder.path / "new/small.png");
    std::ofstream(folder.path / "new/notes.txt") << "no picture";

    const Ran ran = run(folder.asked + "--report " + folder.file("all.xml") + " --json " + folder.file("all.json") +
                        " --diff " + folder.file("differences"));
    CHECK_MESSAGE(ran.code == 1, ran.output);
    CHECK(contains(ran.output, "frame_0001.png: not alike: 0.97500 of the pixels"));
    CHECK(contains(ran.output, "all within 10 x 4 pixels at 5, 7"));

    const nlohmann::json json = folder.json();
    CHECK(json.at("alike") == 2);
    CHECK(json.at("different") == 5);
    CHECK(json.at("unknown") == 0);
    std::vector<std::string> names;
    for (const auto& picture : json.at("pictures")) names.push_back(picture.at("name"));
    CHECK(names == std::vector<std::string>{"a&b.png", "evening/frame_0000.png", "frame_0000.png", "frame_0001.png",
                                            "gained.png", "lost.png", "small.png"});
    const nlohmann::json& changed = json.at("pictures").at(3);
    CHECK(changed.at("verdict") == "different");
    CHECK(changed.at("beyond") == 40);
    CHECK(changed.at("largest").get<double>() == doctest::Approx(100));
    CHECK(changed.at("box") == nlohmann::json{{"left", 5}, {"top", 7}, {"width", 10}, {"height", 4}});
    CHECK(contains(json.at("pictures").at(4).at("why"), "approved has no such picture"));
    CHECK(contains(json.at("pictures").at(5).at("why"), "new has no such picture"));
    CHECK(contains(json.at("pictures").at(6).at("why"), "is 8 x 8"));

    const std::string xml = readAll(folder.path / "all.xml");
    CHECK(contains(xml, "tests=\"7\" failures=\"5\" errors=\"0\""));
    CHECK(contains(xml, "<testcase classname=\"pictures\" name=\"frame_0000.png\"/>"));
    CHECK(contains(xml, "name=\"a&amp;b.png\">\n    <failure message="));
    if (run("xmllint --version").code == 0) CHECK(run("xmllint --noout " + folder.file("all.xml")).code == 0);
    CHECK(std::filesystem::exists(folder.path / "differences/frame_0001.png.png"));
    CHECK_FALSE(std::filesystem::exists(folder.path / "differences/frame_0000.png.png"));
}

TEST_CASE("what can't be told of folders ends with 2, and what could be told is told") {
    const Folders folder;
    folder.both("a.png");
    folder.both("torn.png");
    folder.write("new/torn.png", "no picture");
    const Ran torn = run(folder.asked + "--json " + folder.file("all.json") + " --report " + folder.file("all.xml"));
    CHECK(torn.code == 2);
    CHECK(contains(torn.output, "torn.png"));
    CHECK(folder.json().at("unknown") == 1);
    CHECK(folder.json().at("alike") == 1);
    CHECK(contains(readAll(folder.path / "all.xml"), "<error message="));

    CHECK(run(program("espalier-compare") + " " + folder.file("approved") + " " + folder.file("new/a.png")).code == 2);
    std::filesystem::create_directories(folder.path / "empty");
    const Ran empty = run(program("espalier-compare") + " " + folder.file("empty") + " " + folder.file("empty"));
    CHECK(empty.code == 2);
    CHECK(contains(empty.output, "hold no picture"));
    CHECK(run(folder.asked + "--html " + folder.file("new/page")).code == 2);
    CHECK(run(folder.asked + "--json " + folder.file("x") + " --report " + folder.file("x")).code == 2);
    CHECK(run(folder.asked + "--json " + folder.file("none/all.json")).code == 2);
}

// The slider is dragged by a browser of its own, and its picture tells what is seen.
TEST_CASE("the page shows both pictures under a slider, in a browser, without a network") {
    const Folders folder;
    folder.both("alike.png");
    folder.both("<b>.png", {0, 0, 40, 40});
    CHECK(run(folder.asked + "--html " + folder.file("page")).code == 1);
    const std::string page = readAll(folder.path / "page/index.html");
    CHECK(contains(page, "1 of 2 pictures are not alike."));
    CHECK(contains(page, "&lt;b&gt;.png"));
    CHECK_FALSE(contains(page, "http"));
    CHECK(std::filesystem::exists(folder.path / "page/1-new.png"));
    CHECK_FALSE(std::filesystem::exists(folder.path / "page/2-new.png"));  // of the pair that is alike

    const std::string browser =
        "chromium --headless --no-sandbox --disable-gpu --virtual-time-budget=2000 "
        "--user-data-dir=" +
        folder.file("profile") + " ";
    if (run("command -v chromium").code != 0) {
        MESSAGE("chromium isn't installed; the page isn't opened");
        return;
    }
    // A fifth of the width from the left: the new picture is to be seen right of there.
    const std::string test =
        "<script>addEventListener('load',()=>{const s=document.querySelector('input[type=range]');s.value=20;"
        "s.dispatchEvent(new Event('input'));const p=document.querySelector('.pair'),b=p.getBoundingClientRect();"
        "document.title=[p.style.getPropertyValue('--at'),[...p.querySelectorAll('img')].map(i=>i.naturalWidth),"
        "getComputedStyle(p.querySelectorAll('img')[1]).clipPath,"
        "Math.round(p.querySelector('.line').getBoundingClientRect().left-b.left)].join('|')})</script>";
    std::ofstream(folder.path / "page/driven.html") << page << test;
    const Ran shown = run(browser + "--dump-dom file://" + folder.file("page/driven.html") + " 2>/dev/null");
    CHECK_MESSAGE(contains(shown.output, "<title>20%|40,40,40|inset(0px 0px 0px 20%)|7</title>"), shown.output);
}

}  // namespace compare_folders
