// In: expressions. Out: a postfix program, or the first thing that is wrong.
#include "runtime/nodes/function_text.hpp"

#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>

#include "shaders/shared/node_function.h"

namespace espalier {
namespace {

constexpr uint32_t kMostNested = 64;

struct Called {
    const char* name;
    uint32_t word, arguments;
};
constexpr Called kCalls[] = {{"min", kFunctionLeast, 2},    {"max", kFunctionMost, 2},    {"mod", kFunctionModulo, 2},
                             {"abs", kFunctionAbsolute, 1}, {"floor", kFunctionFloor, 1}, {"sqrt", kFunctionRoot, 1},
                             {"sin", kFunctionSine, 1},     {"cos", kFunctionCosine, 1},  {"noise", kFunctionNoise, 3}};
constexpr std::string_view kInputs[] = {"x", "y", "z", "a", "b", "c"};

class Expression {
  public:
    // under: numbers that are on the stack already.
    Expression(const std::string& text, uint32_t under, std::vector<uint32_t>& code)
        : text_(text), depth_(under), code_(code) {}

    // "", or what is wrong.
    std::string run() {
        sum();
        if (wrong_.empty() && peek() != '\0') fail("expected an operator, found '" + std::string(1, peek()) + "'");
        return wrong_;
    }

  private:
    void fail(const std::string& why) {
        if (wrong_.empty()) wrong_ = "column " + std::to_string(at_ + 1) + ": " + why;
    }
    char peek() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    bool take(char c) {
        if (peek() != c) return false;
        ++at_;
        return true;
    }
    void emit(uint32_t word, uint32_t takes) {
        depth_ = depth_ + 1 - takes;
        if (depth_ > kFunctionDepth) return fail("keeps too many numbers at once; write it with fewer parentheses");
        if (code_.size() + 2 > kMostFunction) return fail("is too long");
        code_.push_back(word);
    }

    void sum() {
        if (++nested_ > kMostNested) fail("has too many parentheses");
        if (!wrong_.empty()) return;
        product();
        while (wrong_.empty() && (peek() == '+' || peek() == '-')) {
            const bool plus = text_[at_++] == '+';
            product();
            if (wrong_.empty()) emit(plus ? kFunctionAdd : kFunctionSubtract, 2);
        }
        --nested_;
    }
    void product() {
        factor();
        while (wrong_.empty() && (peek() == '*' || peek() == '/')) {
            const bool times = text_[at_++] == '*';
            factor();
            if (wrong_.empty()) emit(times ? kFunctionMultiply : kFunctionDivide, 2);
        }
    }
    void factor() {
        uint32_t negated = 0;
        while (take('-')) ++negated;
        const char c = peek();
        if (std::isdigit(static_cast<unsigned char>(c)) || c == '.')
            number();
        else if (std::isalpha(static_cast<unsigned char>(c)))
            name();
        else if (take('('))
            inner();
        else
            fail(c == '\0' ? "expected a number, a name or '(', but the text ends"
                           : "expected a number, a name or '(', found '" + std::string(1, c) + "'");
        if (wrong_.empty() && negated % 2) emit(kFunctionNegate, 1);
    }
    void inner() {
        sum();
        if (wrong_.empty() && !take(')')) fail("a ')' is missing");
    }
    void number() {
        double value = 0;
        const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (error != std::errc() || !std::isfinite(float(value))) return fail("this is no number");
        emit(kFunctionNumber, 0);
        if (wrong_.empty()) code_.push_back(std::bit_cast<uint32_t>(float(value)));
        at_ = size_t(end - text_.data());
    }
    void name() {
        const size_t begin = at_;
        while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_]))) ++at_;
        const std::string_view word = std::string_view(text_).substr(begin, at_ - begin);
        for (uint32_t i = 0; i < std::size(kInputs); ++i)
            if (word == kInputs[i]) return emit(kFunctionInput + i, 0);
        for (const Called& called : kCalls)
            if (word == called.name) return call(called);
        at_ = begin;
        fail("there is no '" + std::string(word) +
             "': names are x, y, z, a, b, c, min, max, mod, abs, floor, sqrt, sin, cos and noise");
    }
    void call(const Called& called) {
        if (!take('(')) return fail(std::string("expected '(' behind ") + called.name);
        for (uint32_t i = 0; i < called.arguments && wrong_.empty(); ++i) {
            if (i > 0 && !take(','))
                return fail(std::string(called.name) + " takes " + std::to_string(called.arguments) + " numbers");
            sum();
        }
        if (wrong_.empty() && !take(')')) return fail(std::string("expected ')' at the end of ") + called.name);
        if (wrong_.empty()) emit(called.word, called.arguments);
    }

    const std::string& text_;
    size_t at_ = 0;
    uint32_t depth_, nested_ = 0;
    std::vector<uint32_t>& code_;
    std::string wrong_;
};

}  // namespace

Result<std::vector<uint32_t>> compileFunction(const std::array<std::string, 3>& texts) {
    std::vector<uint32_t> code;
    for (uint32_t i = 0; i < 3; ++i)
        if (const std::string wrong = Expression(texts[i], i, code).run(); !wrong.empty())
            return Failure("", std::string("'") + "xyz"[i] + "': " + wrong);
    return code;
}

}  // namespace espalier
