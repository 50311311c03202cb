// docs/graph.md lists the kinds of nodes as the table has them.
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/nodes/graphs.hpp"

using namespace espalier;
using namespace espalier::nodetest;

namespace {

constexpr const char* kPage = "docs/graph.md";
const std::string kBegin = "<!-- kinds: written by ESPALIER_UPDATE_DOCS=1 ctest -R nodes -->\n";
const std::string kEnd = "<!-- end of kinds -->";

std::string standardOf(const NodePort& port) {
    const glm::vec3& v = port.standard.numbers;
    switch (port.standard.kind) {
        case Literal::Kind::number:
            return numberText(v.x);
        case Literal::Kind::vector:
            return "(" + numberText(v.x) + ", " + numberText(v.y) + ", " + numberText(v.z) + ")";
        case Literal::Kind::text:
            return "\"" + port.standard.text + "\"";
        default:
            return "";
    }
}

std::string rangeOf(const NodePort& port) {
    std::string out;
    for (const std::string& word : port.words) out += (out.empty() ? "\"" : ", \"") + word + "\"";
    if (port.high > port.low) out = numberText(port.low) + " to " + numberText(port.high);
    return *port.unit ? out + " " + port.unit : out;
}

std::string kindsAsText() {
    std::string out;
    for (const NodeKind& kind : nodeKinds()) {
        out += "\n### " + kind.name + "\n\n" + kind.help + " Gives ";
        for (size_t i = 0; i < kind.outputs.size(); ++i)
            out += (i ? ", " : "") + ("`" + kind.outputs[i].name) + "` (" +
                   (kind.outputs[i].asInput ? "as the first input" : nameOf(kind.outputs[i].type)) + ")";
        out += ".\n";
        if (kind.inputs.empty()) continue;
        out += "\n| input | type | standard | range | |\n|---|---|---|---|---|\n";
        for (const NodePort& port : kind.inputs) {
            const bool wired = port.standard.kind == Literal::Kind::none;
            out += "| " + (wired ? "*" + port.name + "*" : port.name) + " | " + nameOf(port.type) +
                   (port.many ? ", any number" : "") + " | " + standardOf(port) + " | " + rangeOf(port) + " | " +
                   port.help + " |\n";
        }
    }
    return out + "\n";
}

}  // namespace

TEST_CASE("docs/graph.md lists the kinds of nodes as the table has them") {
    std::ostringstream read;
    read << std::ifstream(kPage).rdbuf();
    const std::string page = read.str();
    const size_t begin = page.find(kBegin), end = page.find(kEnd);
    REQUIRE(begin != std::string::npos);
    REQUIRE(end != std::string::npos);
    const std::string wanted = page.substr(0, begin) + kBegin + kindsAsText() + page.substr(end);
    if (std::getenv("ESPALIER_UPDATE_DOCS")) std::ofstream(kPage) << wanted;
    CHECK((page == wanted || std::getenv("ESPALIER_UPDATE_DOCS")));
}
