// What was compared as a page for people.
#include <filesystem>

#include "tools/compare/markup.hpp"
#include "tools/compare/reports.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::compare {
namespace {

// --at is where the slider stands, as a part of the width: left of it the first picture, right of it the second. A
// picture's box is drawn in per cent, so that it fits at any size.
constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>Compared pictures</title>
<style>
body { margin: 2em auto; max-width: 80em; padding: 0 1em; font: 16px/1.5 sans-serif; background: #fff; color: #222; }
article { margin: 2em 0; border-top: 1px solid #ccc; }
h2 { font-size: 1.1em; }
h2 b { font-weight: normal; padding: 0 .5em; border-radius: .3em; color: #fff; background: #287a3c; }
h2 b.different { background: #b3261e; }
h2 b.unknown { background: #8a5a00; }
.pair { position: relative; display: inline-block; max-width: 100%; --at: 50%; touch-action: none; cursor: ew-resize; }
.pair img { display: block; max-width: 100%; image-rendering: pixelated; }
.pair img + img { position: absolute; inset: 0; width: 100%; clip-path: inset(0 0 0 var(--at)); }
.pair .line { position: absolute; top: 0; bottom: 0; left: var(--at); width: 2px; margin-left: -1px; background: #fff; box-shadow: 0 0 3px #000; }
.pair .box { position: absolute; outline: 2px solid #ff2d20; pointer-events: none; }
.pair .difference { position: absolute; inset: 0; width: 100%; display: none; clip-path: none !important; }
.pair.differs .difference { display: block; }
.pair.differs .line, .pair.bare .box { display: none; }
input[type=range] { width: 24em; max-width: 60%; vertical-align: middle; }
</style>
)";

constexpr const char* kScript = R"(<script>
for (const article of document.querySelectorAll("article")) {
  const pair = article.querySelector(".pair");
  if (!pair) continue;
  const slider = article.querySelector("input[type=range]");
  const move = at => { slider.value = at; pair.style.setProperty("--at", at + "%"); };
  slider.addEventListener("input", () => move(slider.value));
  const follow = event => {
    const box = pair.getBoundingClientRect();
    move(Math.min(100, Math.max(0, 100 * (event.clientX - box.left) / box.width)));
  };
  pair.addEventListener("pointerdown", event => { pair.setPointerCapture(event.pointerId); follow(event); event.preventDefault(); });
  pair.addEventListener("pointermove", event => { if (event.buttons) follow(event); });
  article.querySelector(".differences").addEventListener("change", event => pair.classList.toggle("differs", event.target.checked));
  article.querySelector(".boxes").addEventListener("change", event => pair.classList.toggle("bare", !event.target.checked));
}
</script>
)";

const char* titleOf(Verdict verdict) {
    return verdict == Verdict::alike ? "alike" : verdict == Verdict::different ? "not alike" : "can't tell";
}
const char* classOf(Verdict verdict) {
    return verdict == Verdict::alike ? "alike" : verdict == Verdict::different ? "different" : "unknown";
}

std::string percent(uint32_t part, uint32_t whole) {
    return std::to_string(100 * double(part) / double(whole)) + "%";
}

std::string boxOf(const Comparison& found) {
    if (found.beyond == 0) return "";
    return "<div class=\"box\" style=\"left:" + percent(found.box.left, found.width) +
           ";top:" + percent(found.box.top, found.height) + ";width:" + percent(found.box.width, found.width) +
           ";height:" + percent(found.box.height, found.height) + "\"></div>";
}

}  // namespace

bool Page::begin(std::string& error) const {
    std::error_code code;
    std::filesystem::create_directories(folder_, code);
    if (code) error = folder_ + ": can't be made: " + code.message();
    return !code;
}

bool Page::add(const Comparison& found, const Limits& limits, std::string& error) {
    ++pictures_;
    different_ += found.verdict != Verdict::alike;
    rows_ += "<article>\n<h2>" + escaped(found.name) + " <b class=\"" + classOf(found.verdict) + "\">" +
             titleOf(found.verdict) + "</b></h2>\n<p>" +
             escaped(found.measured ? figuresOf(found, limits) : found.why) + "</p>\n";
    if (!found.pictures[0].empty()) {
        const char* const kinds[] = {"approved", "new", "difference"};
        std::string names[3];
        for (size_t i = 0; i < 3; ++i) {
            names[i] = std::to_string(shown_ + 1) + "-" + kinds[i] + ".png";
            const std::string file = (std::filesystem::path(folder_) / names[i]).string();
            if (!scene::writePng(file, found.pictures[i].data(), found.width, found.height, error)) return false;
        }
        ++shown_;
        rows_ +=
            "<div class=\"pair\"><img alt=\"approved\" src=\"" + names[0] + "\"><img alt=\"new\" src=\"" + names[1] +
            "\"><img alt=\"differences\" class=\"difference\" src=\"" + names[2] + "\">" + boxOf(found) +
            "<div class=\"line\"></div></div>\n"
            "<p><label>approved <input type=\"range\" min=\"0\" max=\"100\" step=\"any\" value=\"50\"> new</label> "
            "<label><input type=\"checkbox\" class=\"differences\"> differences</label> "
            "<label><input type=\"checkbox\" class=\"boxes\" checked> box</label></p>\n";
    }
    rows_ += "</article>\n";
    return true;
}

bool Page::finish(std::string& error) const {
    const std::string sum =
        different_ == 0 ? "All " + std::to_string(pictures_) + " pictures are alike."
                        : std::to_string(different_) + " of " + std::to_string(pictures_) + " pictures are not alike.";
    return scene::writeText((std::filesystem::path(folder_) / "index.html").string(),
                            kHead + ("<h1>" + sum + "</h1>\n") + rows_ + kScript, error);
}

}  // namespace espalier::compare
