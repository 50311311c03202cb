// Tokens -> declarations and rules, by recursive descent. `;` ends a rule but may be left out: a name that is the
// first of its line and not indented deeper than the rule, or one that an arrow follows, begins the next statement.
// After a mistake parsing goes on at the next such place.
#include "runtime/grammar/parser.hpp"

#include <algorithm>
#include <filesystem>

#include "runtime/grammar/lexer.hpp"

namespace espalier::grammar {
namespace {

constexpr int kMaxDepth = 64;
constexpr size_t kMaxRules = 1000, kMaxFiles = 16;

struct Stop {};  // unwinds to the statement; never leaves this file

class Parser {
  public:
    Parser(std::vector<Token> tokens, Module& module, Reporter& reporter)
        : tokens_(std::move(tokens)), module_(module), reporter_(reporter) {}

    std::vector<Token> includes;  // their string tokens

    void run() {
        while (!at(TokenKind::end) && !reporter_.full()) {
            size_t before = at_;
            try {
                statement();
            } catch (Stop) {
                if (!rule_.empty()) module_.mistaken.insert(rule_);
                recover(before);
            }
            if (at_ == before) ++at_;
        }
    }

  private:
    const Token& now() const { return tokens_[at_]; }
    const Token& ahead(size_t n) const { return tokens_[std::min(at_ + n, tokens_.size() - 1)]; }
    bool at(TokenKind kind) const { return now().kind == kind; }
    bool at(std::string_view symbol) const { return now().kind == TokenKind::symbol && now().text == symbol; }
    bool atName(std::string_view name) const { return now().kind == TokenKind::name && now().text == name; }
    bool accept(std::string_view symbol) {
        if (!at(symbol)) return false;
        ++at_;
        return true;
    }
    static std::string shown(const Token& token) {
        switch (token.kind) {
            case TokenKind::end:
                return "the end of the text";
            case TokenKind::string:
                return "the text \"" + token.text + "\"";
            case TokenKind::colour:
                return "the colour #" + token.text;
            default:
                return "'" + token.text + "'";
        }
    }
    [[noreturn]] void fail(const std::string& message) {
        reporter_.error(now().place, rule_, message);
        throw Stop{};
    }
    // What is missing as a line ends is told there, not where the next one begins.
    [[noreturn]] void failMissing(const std::string& expected) {
        const bool lineEnds = at_ > 0 && (now().firstOnLine || at(TokenKind::end));
        if (!lineEnds) fail("expected " + expected + ", found " + shown(now()));
        const Token& last = tokens_[at_ - 1];
        Place place = last.place;
        place.column += last.length;
        reporter_.error(place, rule_,
                        "expected " + expected +
                            (at(TokenKind::end) ? ", found the end of the text" : ", found the end of the line"));
        throw Stop{};
    }
    void expect(std::string_view symbol, const std::string& where) {
        if (!accept(symbol)) failMissing("'" + std::string(symbol) + "' " + where);
    }
    std::string expectName(const char* what) {
        if (!at(TokenKind::name)) failMissing(what);
        return tokens_[at_++].text;
    }

    // What stands behind a name and its parenthesised arguments, if it has any.
    const Token& behindName() const {
        size_t i = at_ + 1;
        if (i < tokens_.size() && tokens_[i].kind == TokenKind::symbol && tokens_[i].text == "(") {
            int open = 0;
            for (size_t limit = i + 40; i < tokens_.size() && i < limit; ++i) {
                if (tokens_[i].kind != TokenKind::symbol) continue;
                if (tokens_[i].text == "(") ++open;
                if (tokens_[i].text == ")" && --open == 0) break;
            }
            ++i;
        }
        return tokens_[std::min(i, tokens_.size() - 1)];
    }
    bool symbolFollowsName(std::string_view symbol) const {
        return behindName().kind == TokenKind::symbol && behindName().text == symbol;
    }
    bool arrowFollowsName() const { return symbolFollowsName("->"); }
    // A declaration, or a rule with or without a condition, where an expression or a successor might go on: what is
    // missing is missing before it.
    bool nextStatementBegins() const {
        if (!at(TokenKind::name)) return false;
        if (arrowFollowsName() || symbolFollowsName("=")) return true;
        if (!now().firstOnLine || now().place.column > column_) return false;
        const bool declares =
            atName("param") || atName("let") || atName("context") || atName("include") || atName("field");
        const TokenKind next = ahead(1).kind;
        if (declares && (next == TokenKind::name || next == TokenKind::string)) return true;
        return choices_ == 0 && symbolFollowsName(":");
    }
    bool statementBegins() const {
        if (!at(TokenKind::name)) return false;
        return (now().firstOnLine && now().place.column <= column_) || arrowFollowsName() || symbolFollowsName("=");
    }
    bool numberedRuleBegins() const {
        return at(TokenKind::number) && now().firstOnLine && now().place.column <= column_;
    }
    void recover(size_t before) {
        if (at_ == before) ++at_;
        while (!at(TokenKind::end)) {
            if (accept(";")) return;
            if (now().firstOnLine && at(TokenKind::name) && now().place.column <= column_) return;
            ++at_;
        }
    }

    void statement() {
        rule_.clear();
        nesting_ = choices_ = 0;
        column_ = now().place.column;
        if (accept(";")) return;
        // Li 2011 numbers its rules.
        if (at(TokenKind::number) && ahead(1).kind == TokenKind::symbol && ahead(1).text == ":") at_ += 2;
        if (!at(TokenKind::name)) fail("expected a rule or a declaration, found " + shown(now()));
        bool isRule = ahead(1).kind == TokenKind::symbol;  // "param(n) -> ..." would be a rule
        if (!isRule && atName("include")) return include();
        if (!isRule && atName("param")) return param();
        if (!isRule && atName("context")) return context();
        if (!isRule && atName("let")) return let();
        if (!isRule && atName("field")) return field();
        if (!isRule && atName("angles")) return angles();
        // A word of the language here only: rules, parameters and lets may be named so.
        if (atName("width") && !arrowFollowsName() && !symbolFollowsName(":")) return length(module_.widths);
        if (atName("avoid") && !arrowFollowsName() && !symbolFollowsName(":")) return length(module_.avoids);
        rule();
    }
    void include() {
        ++at_;
        if (!at(TokenKind::string)) fail("include needs a file's name between quotes");
        includes.push_back(tokens_[at_++]);
        accept(";");
    }
    bool acceptColour(float (&rgb)[3]) {
        if (!at(TokenKind::colour)) return false;
        std::copy(now().rgb, now().rgb + 3, rgb);
        ++at_;
        return true;
    }
    void param() {
        ++at_;
        ParamDeclaration p;
        p.place = now().place;
        p.name = rule_ = expectName("the parameter's name");
        expect("=", "and the default behind the parameter's name");
        p.colour = acceptColour(p.rgb);
        if (!p.colour) {
            p.toggle = atName("true") || atName("false");
            p.standard = expression();
        }
        if (accept("[")) {
            p.minimum = expression();
            expect("..", "between the least and the greatest value");
            p.maximum = expression();
            expect("]", "behind the range");
        }
        // One text is the label, two are unit and label.
        if (at(TokenKind::string)) p.label = tokens_[at_++].text;
        if (at(TokenKind::string)) {
            p.unit = p.label;
            p.label = tokens_[at_++].text;
        }
        accept(";");
        module_.params.push_back(std::move(p));
    }
    void context() {
        ++at_;
        ContextDeclaration c;
        c.place = now().place;
        c.name = rule_ = expectName("the painted layer's name");
        if (accept("=") && !(c.colour = acceptColour(c.rgb))) c.fill = expression();
        if (at(TokenKind::string)) c.label = tokens_[at_++].text;
        accept(";");
        module_.contexts.push_back(std::move(c));
    }
    void let() {
        ++at_;
        LetDeclaration l;
        l.place = now().place;
        l.name = rule_ = expectName("a name behind let");
        expect("=", "behind the name");
        l.value = expression();
        accept(";");
        module_.lets.push_back(std::move(l));
    }

    // field name : tensor, vector, cross, symmetry(N) or curvature, then jumps or nothing
    void field() {
        ++at_;
        FieldDeclaration f;
        f.place = now().place;
        f.name = rule_ = expectName("the field's name");
        expect(":", "and the kind behind the field's name");
        f.kind = expectName("tensor, vector, cross, symmetry(N) or curvature");
        if (accept("(")) {
            f.symmetry = expression();
            expect(")", "behind the number");
        }
        f.jumps = !now().firstOnLine && atName("jumps");
        if (f.jumps) ++at_;
        if (at(TokenKind::string)) f.label = tokens_[at_++].text;
        accept(";");
        module_.fields.push_back(std::move(f));
    }
    void angles() {
        rule_ = tokens_[at_++].text;
        if (!atName("degrees") && !atName("radians")) failMissing("degrees or radians");
        module_.degrees = atName("degrees");
        ++at_;
        accept(";");
    }

    void length(std::vector<LengthDeclaration>& all) {
        LengthDeclaration length;
        length.place = now().place;
        rule_ = tokens_[at_++].text;
        const std::string name = rule_ == "width" ? "the width" : "the distance";
        if (at("=")) fail(name + " follows without '=': " + rule_ + " 0.01");
        length.value = expression();
        accept(";");
        all.push_back(length);
    }

    void rule() {
        Rule r;
        r.place = now().place;
        r.predecessor = rule_ = expectName("the predecessor");
        if (accept("(")) {
            while (!at(")")) {
                r.args.push_back(expectName("an argument's name"));
                if (!accept(",")) break;
            }
            expect(")", "behind the arguments");
        }
        if (accept(":")) r.condition = expression();
        if (!accept("="))  // as Li 2011 writes it in Fig. 1
            expect("->", r.condition == kNoExpr ? "behind the predecessor" : "behind the condition");
        r.successor = sequence(1);
        if (r.successor.empty()) failMissing("a successor behind -> (NULL stands for none)");
        if (atPriority()) {
            ++at_;
            r.priority = expression();
        }
        if (accept(":")) r.probability = expression();
        bool ended = accept(";");
        if (module_.rules.size() >= kMaxRules) fail("more than 1,000 rules");
        module_.rules.push_back(std::move(r));
        if (!ended && !at(TokenKind::end) && !statementBegins() && !numberedRuleBegins())
            fail("expected ';' or the next rule, found " + shown(now()));
    }
    bool atPriority() const { return atName("priority") && ahead(1).kind == TokenKind::number; }
    // Elements up to whatever can't be one.
    Sequence sequence(int depth) {
        if (depth > 12) fail("successors are nested too deeply (12 levels are the most)");
        Sequence all;
        while (true) {
            if (depth == 1 ? statementBegins() || numberedRuleBegins() : nextStatementBegins()) return all;
            if (depth == 1 && atPriority()) return all;
            if (at("[") || at("]")) {
                Element bracket;
                bracket.name = now().text;
                bracket.place = now().place;
                ++at_;
                all.push_back(std::move(bracket));
            } else if (at(TokenKind::name)) {
                all.push_back(element(depth));
            } else {
                return all;
            }
            if (all.size() > 200) fail("more than 200 successors in a row");
        }
    }
    Element element(int depth) {
        Element e;
        e.place = now().place;
        e.name = expectName("a successor");
        if (accept("(")) e.args = arguments(e.name);
        if (accept("{")) {
            e.hasItems = true;
            while (!at("}")) {
                e.items.push_back(sequence(depth + 1));
                if (e.items.back().empty()) failMissing("a successor (NULL stands for none)");
                if (e.items.size() > 64) fail("more than 64 successors");
                if (!accept(",") && !accept("|")) break;
            }
            expect("}", "behind the successors of " + e.name);
        }
        return e;
    }
    std::vector<ExprId> arguments(const std::string& of) {
        std::vector<ExprId> all;
        while (!at(")")) {
            all.push_back(expression());
            if (all.size() > 16) fail("more than 16 arguments");
            if (!accept(",")) break;
        }
        expect(")", "behind the arguments of " + of);
        return all;
    }

    ExprId add(Expr e) {
        for (ExprId kid : e.kids) e.depth = std::max(e.depth, module_.exprs[kid].depth + 1);
        if (e.depth > kMaxDepth) {
            reporter_.error(e.place, rule_, "the expression is nested too deeply (64 levels are the most)");
            throw Stop{};
        }
        module_.exprs.push_back(std::move(e));
        return static_cast<ExprId>(module_.exprs.size() - 1);
    }
    ExprId binary(const Token& op, ExprId a, ExprId b) {
        return add({ExprKind::binary, op.text, 0, {a, b}, op.place, 1});
    }

    ExprId expression() {
        if (++nesting_ > kMaxDepth) {
            nesting_ = 0;
            fail("the expression is nested too deeply (64 levels are the most)");
        }
        ExprId test = level(0);
        if (at("?")) {
            Place place = tokens_[at_++].place;
            ++choices_;
            ExprId yes = expression();
            --choices_;
            expect(":", "between the two values of a choice");
            ExprId no = expression();
            test = add({ExprKind::choice, "?", 0, {test, yes, no}, place, 1});
        }
        --nesting_;
        return test;
    }
    // Left-associative operators, the weakest first.
    ExprId level(int l) {
        static const std::vector<std::string_view> kLevels[] = {
            {"||", "or"}, {"&&", "and"}, {"==", "!=", "<", "<=", ">", ">="}, {"+", "-"}, {"*", "/", "%"}};
        if (l == 5) return unary();
        ExprId left = level(l + 1);
        while ((at(TokenKind::symbol) || at(TokenKind::name)) && !(at(TokenKind::name) && now().firstOnLine)) {
            const auto& here = kLevels[l];
            if (std::find(here.begin(), here.end(), now().text) == here.end()) break;
            Token op = tokens_[at_++];
            if (op.text == "or") op.text = "||";
            if (op.text == "and") op.text = "&&";
            left = binary(op, left, level(l + 1));
        }
        return left;
    }
    ExprId unary() {
        // A size of Split: a share of the rest, of weight 1 if none is said.
        if (at("~")) {
            Token tilde = tokens_[at_++];
            bool plain = at(",") || at(")");
            ExprId weight = plain ? add({ExprKind::number, "1", 1, {}, tilde.place, 1}) : primary();
            return add({ExprKind::call, "~", 0, {weight}, tilde.place, 1});
        }
        if (at("-") || at("!") || at("+") || atName("not")) {
            Token op = tokens_[at_++];
            if (++nesting_ > kMaxDepth) {
                nesting_ = 0;
                fail("the expression is nested too deeply (64 levels are the most)");
            }
            ExprId inner = unary();
            --nesting_;
            if (op.text == "+") return inner;
            return add({ExprKind::unary, op.text == "not" ? "!" : op.text, 0, {inner}, op.place, 1});
        }
        return primary();
    }
    ExprId primary() {
        Token token = now();
        if (at(TokenKind::number)) {
            ++at_;
            return add({ExprKind::number, token.text, token.value, {}, token.place, 1});
        }
        if (at(TokenKind::string)) {
            ++at_;
            return add({ExprKind::string, token.text, 0, {}, token.place, 1});
        }
        if (accept("(")) {
            ExprId inner = expression();
            expect(")", "behind the expression");
            return inner;
        }
        const bool next = now().firstOnLine && nextStatementBegins();
        if (!at(TokenKind::name) || next) failMissing("a value");
        ++at_;
        Expr e{ExprKind::name, token.text, 0, {}, token.place, 1};
        while (at(".")) {
            ++at_;
            e.text += "." + expectName("a name behind the dot");
            if (e.text.size() > 200) fail("a name of more than 200 characters");
        }
        if (accept("(")) {
            e.kind = ExprKind::call;
            e.kids = arguments(e.text);
        }
        return add(std::move(e));
    }

    std::vector<Token> tokens_;
    Module& module_;
    Reporter& reporter_;
    size_t at_ = 0;
    int column_ = 1, nesting_ = 0, choices_ = 0;
    std::string rule_;
};

void parseFile(std::string_view text, const std::string& name, const CompileOptions& options, Module& module,
               Reporter& reporter, std::vector<std::string>& sources) {
    uint32_t file = static_cast<uint32_t>(module.files.size());
    module.files.push_back(name);
    sources.emplace_back(text);
    if (text.size() > kMaxGrammarBytes) {
        reporter.error({file, 0, 0}, {}, "the text is longer than 1 MiB");
        return;
    }
    Parser parser(lex(text, file, reporter), module, reporter);
    parser.run();
    const std::string mainName = std::filesystem::path(module.files.front()).filename().string();  // as includes say it
    for (const Token& included : parser.includes) {
        // As the main file would name it: what an included file includes lies beside that one.
        const auto folder = file == 0 ? std::filesystem::path() : std::filesystem::path(name).parent_path();
        const std::string wanted = (folder / included.text).lexically_normal().string();
        if (std::ranges::find(module.files, wanted) != module.files.end() || wanted == mainName) continue;
        if (module.files.size() >= kMaxFiles) {
            reporter.error(included.place, {}, "more than 16 included files");
            return;
        }
        Result<std::string> content =
            options.readInclude ? options.readInclude(wanted) : Failure(wanted, "there is no folder to look for it in");
        if (content)
            parseFile(*content, wanted, options, module, reporter, sources);
        else
            reporter.error(
                included.place, {},
                "can't read the included file \"" + wanted + "\": " + content.failure().diagnostics.front().message);
    }
}

}  // namespace

void parseModule(std::string_view text, const CompileOptions& options, Module& module, Reporter& reporter,
                 std::vector<std::string>& sources) {
    parseFile(text, options.fileName, options, module, reporter, sources);
}

}  // namespace espalier::grammar
