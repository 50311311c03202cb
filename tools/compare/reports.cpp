// What was compared as JUnit's XML and as JSON.
#include "tools/compare/reports.hpp"

#include <algorithm>
#include <cmath>

#include "tools/compare/markup.hpp"
#include "tools/scene/json_out.hpp"

namespace espalier::compare {
namespace {

size_t count(const std::vector<Comparison>& all, Verdict verdict) {
    return size_t(std::count_if(all.begin(), all.end(), [&](const Comparison& one) { return one.verdict == verdict; }));
}

const char* nameOf(Verdict verdict) {
    return verdict == Verdict::alike ? "alike" : verdict == Verdict::different ? "different" : "unknown";
}

nlohmann::ordered_json jsonOf(const Comparison& one) {
    nlohmann::ordered_json json{{"name", one.name}, {"verdict", nameOf(one.verdict)}};
    if (!one.why.empty()) json["why"] = one.why;
    if (!one.measured) return json;
    json["width"] = one.width;
    json["height"] = one.height;
    json["within"] = one.within;
    json["beyond"] = one.beyond;
    if (std::isfinite(one.largest))
        json["largest"] = scene::shortest(one.largest);
    else
        json["largest"] = nullptr;  // JSON has no infinity
    if (one.beyond > 0)
        json["box"] = {
            {"left", one.box.left}, {"top", one.box.top}, {"width", one.box.width}, {"height", one.box.height}};
    return json;
}

}  // namespace

std::string junitOf(const std::vector<Comparison>& all) {
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"espalier-compare\" tests=\"" +
                       std::to_string(all.size()) + "\" failures=\"" + std::to_string(count(all, Verdict::different)) +
                       "\" errors=\"" + std::to_string(count(all, Verdict::unknown)) + "\">\n";
    for (const Comparison& one : all) {
        text += "  <testcase classname=\"pictures\" name=\"" + escaped(one.name) + "\"";
        const char* mark = one.verdict == Verdict::different ? "failure" : "error";
        if (one.verdict == Verdict::alike)
            text += "/>\n";
        else
            text += std::string(">\n    <") + mark + " message=\"" + escaped(one.why) + "\"/>\n  </testcase>\n";
    }
    return text + "</testsuite>\n";
}

std::string jsonOf(const std::vector<Comparison>& all, const Limits& limits) {
    nlohmann::ordered_json json{
        {"tolerance", limits.tolerance},           {"share", limits.share},
        {"alike", count(all, Verdict::alike)},     {"different", count(all, Verdict::different)},
        {"unknown", count(all, Verdict::unknown)}, {"pictures", nlohmann::ordered_json::array()}};
    for (const Comparison& one : all) json["pictures"].push_back(jsonOf(one));
    return scene::textOf(json, 2) + "\n";
}

}  // namespace espalier::compare
