// In: the text of a graph. Out: its nodes, or what is wrong with it. And back.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "runtime/nodes/node_graph.hpp"

namespace espalier {
namespace {

constexpr size_t kMostBytes = 16u << 20, kMostMistakes = 20, kMostInputs = 4096;

struct Token {
    enum class Kind : uint8_t { end, line, name, number, text, symbol, comment };
    Kind kind = Kind::end;
    std::string text;
    float number = 0;
    TextPlace place;
    bool is(char symbol) const { return kind == Kind::symbol && text[0] == symbol; }
};

bool startsName(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
}
bool goesOnName(char c) {
    return startsName(c) || std::isdigit(static_cast<unsigned char>(c));
}

class Reader {
  public:
    Reader(std::string_view text, const std::string& file) : text_(text) { graph_.file = file; }

    Result<NodeGraph> run() {
        if (text_.size() > kMostBytes) return Failure(graph_.file, "is larger than 16 MB, so it is no graph");
        next();
        readHead();
        while (token_.kind != Token::Kind::end && mistakes_.size() < kMostMistakes) readStatement();
        graph_.comments = std::move(comments_);
        if (!mistakes_.empty()) return Failure(std::move(mistakes_));
        return std::move(graph_);
    }

  private:
    void mistake(const TextPlace& place, const std::string& node, std::string message) {
        if (mistakes_.size() < kMostMistakes)
            mistakes_.push_back({graph_.file, place.line, place.column, node, std::move(message), false});
    }

    TextPlace here() const { return {line_, int(at_ - lineStart_) + 1}; }
    char peek(size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

    void next() {
        while (at_ < text_.size() && (peek() == ' ' || peek() == '\t' || peek() == '\r')) ++at_;
        token_ = {};
        token_.place = here();
        if (at_ >= text_.size()) return;
        const char c = peek();
        if (c == '\n') {
            token_.kind = Token::Kind::line;
            ++at_;
            ++line_;
            lineStart_ = at_;
        } else if (c == '#') {
            const size_t end = std::min(text_.find('\n', at_), text_.size());
            token_.kind = Token::Kind::comment;
            token_.text = trimmed(text_.substr(at_ + 1, end - at_ - 1));
            at_ = end;
        } else if (startsName(c)) {
            token_.kind = Token::Kind::name;
            while (at_ < text_.size() && goesOnName(peek())) token_.text += text_[at_++];
        } else if (std::isdigit(static_cast<unsigned char>(c)) || ((c == '-' || c == '.') && isNumberAhead())) {
            readNumber();
        } else if (c == '"') {
            readText();
        } else {
            token_.kind = Token::Kind::symbol;
            token_.text = c;
            ++at_;
        }
    }
    static std::string trimmed(std::string_view s) {
        while (!s.empty() && std::isspace(static_cast<unsigned char>(s.front()))) s.remove_prefix(1);
        while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back()))) s.remove_suffix(1);
        return std::string(s);
    }
    bool isNumberAhead() const {
        const char c = peek(1);
        return std::isdigit(static_cast<unsigned char>(c)) ||
               (c == '.' && std::isdigit(static_cast<unsigned char>(peek(2))));
    }
    void readNumber() {
        token_.kind = Token::Kind::number;
        double value = 0;
        const auto [end, wrong] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        token_.text = text_.substr(at_, size_t(end - text_.data()) - at_);
        token_.number = float(value);
        if (wrong != std::errc() || !std::isfinite(token_.number)) {
            mistake(token_.place, "", "the number doesn't fit into 32 bits");
            token_.number = 0;
        }
        at_ = std::max(size_t(end - text_.data()), at_ + 1);
    }
    void readText() {
        token_.kind = Token::Kind::text;
        for (++at_; at_ < text_.size() && peek() != '"' && peek() != '\n'; ++at_) {
            const bool escaped = peek() == '\\' && at_ + 1 < text_.size() && peek(1) != '\n';
            if (escaped) ++at_;
            token_.text += escaped && peek() == 'n' ? '\n' : peek();
        }
        if (peek() == '"')
            ++at_;
        else
            mistake(token_.place, "", "the text has no closing quote in its line");
    }

    // Of what one may mean by what stands here.
    std::string said() const {
        switch (token_.kind) {
            case Token::Kind::end:
                return "the text's end";
            case Token::Kind::line:
                return "the line's end";
            case Token::Kind::comment:
                return "a comment";
            default:
                return "'" + token_.text.substr(0, 40) + "'";
        }
    }
    bool expect(char symbol, const std::string& node, const char* where) {
        if (token_.is(symbol)) {
            next();
            return true;
        }
        mistake(token_.place, node, std::string("expected '") + symbol + "' " + where + ", found " + said());
        return false;
    }
    void skipLine() {
        while (token_.kind != Token::Kind::end && token_.kind != Token::Kind::line) next();
    }
    void endStatement(const std::string& node) {
        if (token_.kind == Token::Kind::comment) {
            comments_.push_back(token_.text);
            next();
        }
        if (token_.kind == Token::Kind::end) return;
        if (token_.kind != Token::Kind::line) mistake(token_.place, node, "expected the line's end, found " + said());
        skipLine();
        next();
    }
    // Within parentheses a statement goes on over lines' ends.
    void skipBreaks() {
        while (token_.kind == Token::Kind::line || token_.kind == Token::Kind::comment) {
            if (token_.kind == Token::Kind::comment) comments_.push_back(token_.text);
            next();
        }
    }

    void readHead() {
        skipBreaks();
        const bool is = token_.kind == Token::Kind::name && token_.text == "graph";
        if (is) next();
        if (!is || token_.kind != Token::Kind::number) {
            mistake(token_.place, "", "a graph begins with 'graph 1', found " + said());
            return skipLine();
        }
        if (token_.number != float(NodeGraph::kVersion))
            mistake(token_.place, "",
                    "version " + token_.text + " of graphs isn't known; this program reads version 1");
        next();
        endStatement("");
    }

    void readStatement() {
        if (token_.kind == Token::Kind::line) return next();
        if (token_.kind == Token::Kind::comment) {
            comments_.push_back(token_.text);
            return next();
        }
        if (token_.kind != Token::Kind::name) {
            mistake(token_.place, "", "expected a node's name, 'show', 'mute' or 'layout', found " + said());
            return skipLine();
        }
        const Token name = token_;
        next();
        if (name.text == "show" && !token_.is('=')) return readNames(graph_.shown);
        if (name.text == "mute" && !token_.is('=')) return readNames(graph_.muted);
        if (name.text == "layout" && !token_.is('=')) return readLayout();
        readNode(name);
    }

    void readNames(std::vector<std::pair<std::string, TextPlace>>& into) {
        for (; token_.kind == Token::Kind::name; next()) into.emplace_back(token_.text, token_.place);
        endStatement("");
    }

    void readLayout() {
        if (!expect('{', "", "after 'layout'")) return skipLine();
        for (skipBreaks(); token_.kind == Token::Kind::name; skipBreaks()) {
            const std::string name = token_.text;
            float at[2] = {};
            next();
            for (float& v : at) {
                if (token_.kind != Token::Kind::number) {
                    mistake(token_.place, name, "a node's place in the layout is two numbers, found " + said());
                    return skipLine();
                }
                v = token_.number;
                next();
            }
            graph_.layout.emplace_back(name, glm::vec3(at[0], at[1], 0));
            skipBreaks();
            if (token_.is(';')) next();
        }
        if (expect('}', "", "at the layout's end"))
            endStatement("");
        else
            skipLine();
    }

    void readNode(const Token& name) {
        GraphNode node;
        node.name = name.text;
        node.place = name.place;
        node.comments = std::move(comments_);
        comments_.clear();
        if (!expect('=', name.text, "after the node's name")) return skipLine();
        if (token_.kind != Token::Kind::name) {
            mistake(token_.place, name.text, "expected a kind of node, found " + said());
            return skipLine();
        }
        node.kind = token_.text;
        const NodeKind* kind = findNodeKind(node.kind);
        next();
        if (token_.is('(')) {
            next();
            if (!readInputs(node, kind)) return skipLine();
        }
        endStatement(node.name);
        if (kind) inOrder(node, *kind);
        if (graph_.nodes.size() == NodeGraph::kMostNodes)
            mistake(name.place, name.text, "a graph has at most 100,000 nodes");
        if (graph_.nodes.size() < NodeGraph::kMostNodes) graph_.nodes.push_back(std::move(node));
    }

    bool readInputs(GraphNode& node, const NodeKind* kind) {
        bool named = false;
        for (skipBreaks(); !token_.is(')'); skipBreaks()) {
            if (token_.kind == Token::Kind::end || node.inputs.size() == kMostInputs) {
                mistake(token_.place, node.name, "the node's inputs have no end: a ')' is missing");
                return false;
            }
            NodeInput input;
            input.place = token_.place;
            if (!readInput(input, node, named)) return false;
            if (input.port.empty() && kind && !placeInput(input, node, *kind)) return false;
            node.inputs.push_back(std::move(input));
            skipBreaks();
            if (token_.is(',')) {
                next();
                continue;
            }
            if (!token_.is(')')) return expect(')', node.name, "or ',' behind an input");
        }
        next();
        return true;
    }

    bool readInput(NodeInput& input, const GraphNode& node, bool& named) {
        if (token_.kind == Token::Kind::name) {
            const Token first = token_;
            next();
            if (token_.is(':')) {
                named = true;
                input.port = first.text;
                next();
                skipBreaks();
                input.place = token_.place;
                return readValue(input, node);
            }
            if (named) return refusePlaced(first.place, node);
            return readWire(input, first.text, node);
        }
        return named ? refusePlaced(token_.place, node) : readValue(input, node);
    }
    bool refusePlaced(const TextPlace& place, const GraphNode& node) {
        mistake(place, node.name, "an input without a name can't follow one with a name");
        return false;
    }
    // The n-th input without a name is the n-th port; the last may take many.
    bool placeInput(NodeInput& input, const GraphNode& node, const NodeKind& kind) {
        const size_t at = std::min(node.inputs.size(), kind.inputs.empty() ? 0 : kind.inputs.size() - 1);
        if (kind.inputs.empty() || (node.inputs.size() > at && !kind.inputs[at].many)) {
            mistake(input.place, node.name,
                    kind.name + " has no more than " + std::to_string(kind.inputs.size()) + " inputs");
            return false;
        }
        input.port = kind.inputs[at].name;
        return true;
    }
    bool readWire(NodeInput& input, const std::string& from, const GraphNode& node) {
        input.from = from;
        if (!token_.is('.')) return true;
        next();
        if (token_.kind != Token::Kind::name) {
            mistake(token_.place, node.name, "expected the name of an output behind '" + from + ".', found " + said());
            return false;
        }
        input.output = token_.text;
        next();
        return true;
    }
    bool readValue(NodeInput& input, const GraphNode& node) {
        if (token_.kind == Token::Kind::name) {
            const std::string from = token_.text;
            next();
            return readWire(input, from, node);
        }
        if (token_.kind == Token::Kind::number || token_.kind == Token::Kind::text) {
            input.constant = token_.kind == Token::Kind::number ? Literal(token_.number) : Literal(token_.text);
            next();
            return true;
        }
        if (!token_.is('(')) {
            mistake(token_.place, node.name, "expected a number, three numbers, a text or a node, found " + said());
            return false;
        }
        next();
        glm::vec3 v{0};
        for (int i = 0; i < 3; ++i) {
            skipBreaks();
            if (token_.kind != Token::Kind::number) {
                mistake(token_.place, node.name, "a vector is three numbers, found " + said());
                return false;
            }
            v[i] = token_.number;
            next();
            skipBreaks();
            if (!expect(i < 2 ? ',' : ')', node.name, "in a vector of three numbers")) return false;
        }
        input.constant = Literal(v);
        return true;
    }

    void inOrder(GraphNode& node, const NodeKind& kind) {
        std::ranges::stable_sort(node.inputs, {}, [&](const NodeInput& input) {
            const int port = kind.port(input.port);
            return port < 0 ? int(kind.inputs.size()) : port;
        });
    }

    std::string_view text_;
    size_t at_ = 0, lineStart_ = 0;
    int line_ = 1;
    Token token_;
    NodeGraph graph_;
    std::vector<std::string> comments_;
    std::vector<Diagnostic> mistakes_;
};

void printText(std::string& out, const std::string& text) {
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

void printInput(std::string& out, const NodeInput& input, bool named) {
    if (named) out += input.port + ": ";
    const glm::vec3& v = input.constant.numbers;
    switch (input.constant.kind) {
        case Literal::Kind::none:
            out += input.from + (input.output.empty() ? "" : "." + input.output);
            break;
        case Literal::Kind::number:
            out += numberText(v.x);
            break;
        case Literal::Kind::vector:
            out += "(" + numberText(v.x) + ", " + numberText(v.y) + ", " + numberText(v.z) + ")";
            break;
        case Literal::Kind::text:
            printText(out, input.constant.text);
            break;
    }
}

void printNode(std::string& out, const GraphNode& node) {
    for (const std::string& comment : node.comments) out += comment.empty() ? "#\n" : "# " + comment + "\n";
    out += node.name + " = " + node.kind;
    const NodeKind* kind = findNodeKind(node.kind);
    // What is wired to the first ports says by itself what it is.
    bool placed = true;
    for (size_t i = 0; i < node.inputs.size(); ++i) {
        const NodeInput& input = node.inputs[i];
        if (kind) {
            const int port = kind->port(input.port);
            placed = placed && port >= 0 && input.constant.kind == Literal::Kind::none &&
                     kind->inputs[size_t(port)].type >= ValueType::material &&
                     (size_t(port) == i || (kind->inputs[size_t(port)].many && size_t(port) < i));
        } else {
            placed = input.port.empty();
        }
        out += i == 0 ? "(" : ", ";
        printInput(out, input, !placed);
    }
    out += node.inputs.empty() ? "\n" : ")\n";
}

void printNames(std::string& out, const char* word, const std::vector<std::pair<std::string, TextPlace>>& names) {
    if (names.empty()) return;
    out += word;
    for (const auto& [name, place] : names) out += " " + name;
    out += "\n";
}

}  // namespace

std::string numberText(float number) {
    char text[64];
    const auto [end, wrong] = std::to_chars(text, text + sizeof text, number == 0 ? 0.0f : number);
    return {text, end};
}

int NodeGraph::find(std::string_view name) const {
    for (size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].name == name) return int(i);
    return -1;
}

Result<NodeGraph> parseGraph(std::string_view text, const std::string& file) {
    return Reader(text, file).run();
}

std::string printGraph(const NodeGraph& graph) {
    std::string out = "graph 1\n";
    for (const GraphNode& node : graph.nodes) printNode(out, node);
    printNames(out, "show", graph.shown);
    printNames(out, "mute", graph.muted);
    if (!graph.layout.empty()) {
        out += "layout {\n";
        for (const auto& [name, at] : graph.layout)
            out += "    " + name + " " + numberText(at.x) + " " + numberText(at.y) + "\n";
        out += "}\n";
    }
    for (const std::string& comment : graph.comments) out += comment.empty() ? "#\n" : "# " + comment + "\n";
    return out;
}

}  // namespace espalier
