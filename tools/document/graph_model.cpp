// The text of a graph -> nodes, by the plugin's reader, and nodes -> a text that it reads.
#include "tools/document/graph_model.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <memory>
#include <unordered_set>

namespace espalier::document {
namespace {

void writeText(std::string& out, const std::string& text) {
    out += '"';
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (c == '\n')
            out += "\\n";
        else
            out += c;
    }
    out += '"';
}

void writeComments(std::string& out, const std::optional<std::string>& comments) {
    if (!comments) return;
    for (size_t begin = 0; begin <= comments->size();) {
        const size_t end = std::min(comments->find('\n', begin), comments->size());
        out += "# " + comments->substr(begin, end - begin) + "\n";
        begin = end + 1;
    }
}

void writeNames(std::string& out, const char* word, const std::vector<std::string>& names) {
    if (names.empty()) return;
    out += word;
    for (const std::string& name : names) out += " " + name;
    out += "\n";
}

GraphNode nodeOf(const EspGraphNodes* nodes, uint32_t n, const EspGraphNode& info) {
    GraphNode node{info.name, info.kind, {}, {}, info.line};
    if (info.comments) node.comments = info.comments;
    for (uint32_t i = 0; i < info.inputs; ++i) {
        EspGraphGiven given;
        if (espGraphNodeInput(nodes, n, i, &given) != ESP_OK) continue;
        node.inputs.push_back({given.input, given.kind, {}, given.text, given.from, given.output});
        std::copy(std::begin(given.numbers), std::end(given.numbers), node.inputs.back().numbers.begin());
    }
    return node;
}

bool goesOnName(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

}  // namespace

std::string shortText(float number) {
    char text[64];
    const auto [end, wrong] = std::to_chars(text, text + sizeof text, number == 0 ? 0.f : number);
    return {text, end};
}

std::string valueText(const GraphGiven& given) {
    const auto& v = given.numbers;
    std::string out;
    switch (given.kind) {
        case ESP_GRAPH_NUMBER:
            return shortText(v[0]);
        case ESP_GRAPH_VECTOR:
            return "(" + shortText(v[0]) + ", " + shortText(v[1]) + ", " + shortText(v[2]) + ")";
        case ESP_GRAPH_TEXT:
            writeText(out, given.text);
            return out;
        case ESP_GRAPH_WIRE:
            break;
    }
    return given.from + (given.output.empty() ? "" : "." + given.output);
}

bool isNodeName(const std::string& name) {
    return !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) && std::ranges::all_of(name, goesOnName);
}

const GraphGiven* GraphNode::given(const std::string& input) const {
    const auto found = std::ranges::find(inputs, input, &GraphGiven::input);
    return found == inputs.end() ? nullptr : &*found;
}

bool GraphModel::read(EspContext* context, const std::string& text, const std::string& file, std::string& error) {
    EspGraphDef def{};
    def.name = file.c_str();
    def.text = text.data();
    def.length = text.size();
    EspGraphNodes* made = nullptr;
    if (espReadGraphNodes(context, &def, &made) != ESP_OK) {
        error = espLastError(context);
        return false;
    }
    const std::unique_ptr<EspGraphNodes, void (*)(EspGraphNodes*)> from(made, espFreeGraphNodes);
    *this = {};
    // Lists have their own order.
    std::vector<std::pair<uint32_t, std::string>> shows, mutes;
    std::vector<std::pair<uint32_t, std::pair<std::string, Place>>> places;
    for (uint32_t n = 0; n < espGraphNodeCount(made); ++n) {
        EspGraphNode info;
        if (espGraphNodeAt(made, n, &info) != ESP_OK) continue;
        nodes.push_back(nodeOf(made, n, info));
        if (info.shown) shows.emplace_back(info.shown, info.name);
        if (info.muted) mutes.emplace_back(info.muted, info.name);
        if (info.placed) places.push_back({info.placed, {info.name, {info.place[0], info.place[1]}}});
    }
    for (auto* list : {&shows, &mutes}) std::ranges::sort(*list);
    std::ranges::sort(places);
    for (auto& [at, name] : shows) shown.push_back(name);
    for (auto& [at, name] : mutes) muted.push_back(name);
    for (auto& [at, entry] : places) layout.push_back(entry);
    if (const char* behind = espGraphRemarks(made)) remarks = behind;
    index();
    return true;
}

std::string GraphModel::write() const {
    std::string out = "graph 1\n";
    for (const GraphNode& node : nodes) {
        writeComments(out, node.comments);
        out += node.name + " = " + node.kind;
        for (size_t i = 0; i < node.inputs.size(); ++i) {
            const GraphGiven& given = node.inputs[i];
            out += (i == 0 ? "(" : ", ") + (given.input.empty() ? "" : given.input + ": ") + valueText(given);
        }
        out += node.inputs.empty() ? "\n" : ")\n";
    }
    writeNames(out, "show", shown);
    writeNames(out, "mute", muted);
    if (!layout.empty()) {
        out += "layout {\n";
        for (const auto& [name, at] : layout)
            out += "    " + name + " " + shortText(at[0]) + " " + shortText(at[1]) + "\n";
        out += "}\n";
    }
    writeComments(out, remarks);
    return out;
}

void GraphModel::index() {
    named_.clear();
    places_.clear();
    for (size_t i = 0; i < nodes.size(); ++i) named_.emplace(nodes[i].name, i);
    for (size_t i = 0; i < layout.size(); ++i) places_.emplace(layout[i].first, i);
}

int GraphModel::find(const std::string& name) const {
    const auto found = named_.find(name);
    return found == named_.end() ? -1 : int(found->second);
}

std::optional<GraphModel::Place> GraphModel::placeOf(const std::string& name) const {
    const auto found = places_.find(name);
    return found == places_.end() ? std::nullopt : std::optional(layout[found->second].second);
}

void GraphModel::place(const std::string& name, Place at) {
    if (const auto found = places_.find(name); found != places_.end()) {
        layout[found->second].second = at;
        return;
    }
    places_.emplace(name, layout.size());
    layout.emplace_back(name, at);
}

bool GraphModel::isShown(const std::string& name) const {
    return std::ranges::find(shown, name) != shown.end();
}

bool GraphModel::isMuted(const std::string& name) const {
    return std::ranges::find(muted, name) != muted.end();
}

std::optional<EspNodeType> GraphModel::typeOf(const std::string& name, const std::string& output) const {
    std::string at = name, of = output;
    for (size_t steps = 0; steps <= nodes.size(); ++steps) {
        const int n = find(at);
        const NodeKind* kind = n < 0 ? nullptr : findNodeKind(nodes[size_t(n)].kind);
        const int o = kind ? kind->output(of) : -1;
        if (o < 0) return {};
        const bool through = kind->outputs[size_t(o)].asFirst || (o == 0 && isMuted(at));
        if (!through) return kind->outputs[size_t(o)].type;
        const GraphGiven* first = kind->inputs.empty() ? nullptr : nodes[size_t(n)].given(kind->inputs[0].name);
        if (!first || !first->wire()) return {};
        at = first->from;
        of = first->output;
    }
    return {};
}

std::vector<std::string> GraphModel::way(const std::string& from, const std::string& to) const {
    if (from == to) return {from};
    // Backwards, since nodes know what they read.
    std::unordered_map<std::string, std::string> next;  // on the way to `to`
    std::vector<std::string> open{to};
    while (!open.empty()) {
        const std::string at = open.back();
        open.pop_back();
        const int n = find(at);
        if (n < 0) continue;
        for (const GraphGiven& given : nodes[size_t(n)].inputs) {
            if (!given.wire() || given.from == to || !next.emplace(given.from, at).second) continue;
            if (given.from != from) {
                open.push_back(given.from);
                continue;
            }
            std::vector<std::string> way{from};
            while (way.back() != to) way.push_back(next.at(way.back()));
            return way;
        }
    }
    return {};
}

std::string GraphModel::freshName(const std::string& wanted) const {
    std::string name = wanted;
    if (!name.empty()) name[0] = char(std::tolower(static_cast<unsigned char>(name[0])));
    // Words of the language begin other lines.
    if (find(name) < 0 && name != "show" && name != "mute" && name != "layout") return name;
    while (name.size() > 1 && std::isdigit(static_cast<unsigned char>(name.back()))) name.pop_back();
    for (int i = 2;; ++i)
        if (find(name + std::to_string(i)) < 0) return name + std::to_string(i);
}

}  // namespace espalier::document
