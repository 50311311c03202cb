// Grammar text -> tokens. ASCII but for strings, comments and the two signs of the papers, → and π; anything else
// is reported with its column (counted in bytes) and skipped, so that parsing goes on behind it.
#include "runtime/grammar/lexer.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "runtime/core/srgb.hpp"

namespace espalier::grammar {
namespace {

constexpr size_t kMaxTokens = 200'000;
constexpr std::string_view kArrow = "\xE2\x86\x92", kPiSign = "\xCF\x80", kTilde = "\xE2\x88\xBC";
constexpr std::array<std::string_view, 28> kSymbols = {"->", "<=", ">=", "==", "!=", "&&", "||", "..", "(", ")",
                                                       "{",  "}",  "[",  "]",  ",",  ";",  ":",  "?",  "+", "-",
                                                       "*",  "/",  "%",  "<",  ">",  "=",  "~",  "|"};

bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

// Length of the valid UTF-8 sequence at the start of `text`, 0 if there is none.
size_t utf8Length(std::string_view text) {
    auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    unsigned lead = byte(0);
    if (lead < 0x80) return 1;
    size_t length = lead >= 0xC2 && lead < 0xE0 ? 2 : (lead >> 4) == 0xE ? 3 : lead >= 0xF0 && lead < 0xF5 ? 4 : 0;
    for (size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xC0) != 0x80) return 0;
    if (lead == 0xE0 && byte(1) < 0xA0) return 0;
    if (lead == 0xED && byte(1) > 0x9F) return 0;
    if (lead == 0xF0 && byte(1) < 0x90) return 0;
    if (lead == 0xF4 && byte(1) > 0x8F) return 0;
    return length;
}

// Of a number whose size no double holds: whether it is too small for one.
bool isTiny(std::string_view digits) {
    const size_t e = std::min(digits.find_first_of("eE"), digits.size());
    const std::string_view mantissa = digits.substr(0, e);
    const auto before = std::ptrdiff_t(std::min(mantissa.find('.'), mantissa.size()));
    const auto first = std::ptrdiff_t(std::min(mantissa.find_first_of("123456789"), mantissa.size()));
    const bool negative = digits.substr(e).starts_with("e-") || digits.substr(e).starts_with("E-");
    const size_t power = std::min(digits.find_first_not_of("eE+-", e), digits.size());
    std::ptrdiff_t exponent = 0;
    const auto read = std::from_chars(digits.data() + power, digits.data() + digits.size(), exponent);
    if (read.ec == std::errc::result_out_of_range) return negative;
    return before - first + (negative ? -exponent : exponent) < 0;
}

class Lexer {
  public:
    Lexer(std::string_view text, uint32_t file, Reporter& reporter) : text_(text), file_(file), reporter_(reporter) {}

    std::vector<Token> run() {
        if (text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = lineStart_ = 3;
        while (skipBlank(), at_ < text_.size()) {
            if (tokens_.size() >= kMaxTokens) {
                reporter_.error(here(), {}, "the text has more than 200,000 tokens");
                break;
            }
            if (reporter_.full()) break;
            const size_t start = at_, before = tokens_.size();
            next();
            if (tokens_.size() > before) tokens_.back().length = static_cast<int>(at_ - start);
        }
        begin(TokenKind::end);
        return std::move(tokens_);
    }

  private:
    char peek(size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
    bool startsWith(std::string_view s) const { return text_.substr(at_, s.size()) == s; }
    Place here() const { return {file_, line_, static_cast<int>(at_ - lineStart_) + 1}; }

    Token& begin(TokenKind kind) {
        Token token;
        token.kind = kind;
        token.place = here();
        token.firstOnLine = firstOnLine_;
        firstOnLine_ = false;
        tokens_.push_back(std::move(token));
        return tokens_.back();
    }
    void newLine() {
        ++line_;
        lineStart_ = at_ + 1;
        firstOnLine_ = true;
    }

    void skipBlank() {
        while (at_ < text_.size()) {
            char c = peek();
            if (c == '\n') {
                newLine();
                ++at_;
            } else if (c == ' ' || c == '\t' || c == '\r') {
                ++at_;
            } else if (startsWith("//")) {
                while (at_ < text_.size() && peek() != '\n') skipCommentByte();
            } else if (startsWith("/*")) {
                blockComment();
            } else {
                return;
            }
        }
    }
    void blockComment() {
        Place place = here();
        at_ += 2;
        while (at_ < text_.size() && !startsWith("*/")) {
            if (peek() == '\n') newLine();
            skipCommentByte();
        }
        if (at_ >= text_.size()) reporter_.error(place, {}, "this comment is never closed; it needs */");
        at_ = std::min(at_ + 2, text_.size());
    }
    void skipCommentByte() {
        size_t length = utf8Length(text_.substr(at_));
        if (length == 0) badByte();
        at_ += std::max<size_t>(length, 1);
    }
    void badByte() {
        char hex[8];
        std::snprintf(hex, sizeof hex, "0x%02X", static_cast<unsigned char>(peek()));
        reporter_.error(here(), {}, std::string("byte ") + hex + " isn't UTF-8 text; save the file as UTF-8");
    }

    void next() {
        char c = peek();
        if (isLetter(c)) return name();
        if (isDigit(c) || (c == '.' && isDigit(peek(1)))) return number();
        if (c == '"') return string();
        if (c == '#') return colour();
        if (startsWith(kArrow)) return symbol("->", kArrow.size());
        if (startsWith("~>")) return symbol("->", 2);  // as Li 2011 writes it
        if (startsWith(kTilde)) return symbol("~", kTilde.size());
        if (startsWith(kPiSign)) {
            begin(TokenKind::name).text = "pi";
            at_ += kPiSign.size();
            return;
        }
        for (std::string_view s : kSymbols)
            if (startsWith(s)) return symbol(s, s.size());
        if (c == '!' || c == '.') return symbol(text_.substr(at_, 1), 1);
        stray();
    }
    void symbol(std::string_view s, size_t length) {
        begin(TokenKind::symbol).text = s;
        at_ += length;
    }
    void name() {
        Token& token = begin(TokenKind::name);
        size_t start = at_;
        while (isLetter(peek()) || isDigit(peek())) ++at_;
        token.text = text_.substr(start, at_ - start);
        if (token.text.size() > 100) {
            reporter_.error(token.place, {}, "a name of more than 100 characters");
            token.text.resize(100);
        }
    }
    void number() {
        Token& token = begin(TokenKind::number);
        size_t start = at_;
        while (isDigit(peek())) ++at_;
        if (peek() == '.' && peek(1) != '.') {  // 0..1 is a range of whole numbers
            ++at_;
            while (isDigit(peek())) ++at_;
        }
        size_t sign = peek(1) == '+' || peek(1) == '-' ? 2 : 1;
        if ((peek() == 'e' || peek() == 'E') && isDigit(peek(sign))) {
            at_ += sign;
            while (isDigit(peek())) ++at_;
        }
        std::string_view digits = text_.substr(start, at_ - start);
        double value = 0;
        auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        bool tooLarge = code == std::errc::result_out_of_range && !isTiny(digits);
        if (tooLarge || value > 1e9) {
            reporter_.error(token.place, {},
                            "the number " + std::string(digits.substr(0, 24)) + " is too large (1e9 is the most)");
            value = 0;
        } else if (code == std::errc()) {
            token.value = static_cast<float>(value);
        }
        token.text = digits;
        if (isLetter(peek()))
            reporter_.error(here(), {}, "a letter directly behind a number; write * between them or a space");
    }
    void string() {
        Token& token = begin(TokenKind::string);
        Place place = token.place;
        ++at_;
        std::string content;
        while (at_ < text_.size() && peek() != '"' && peek() != '\n') {
            size_t length = utf8Length(text_.substr(at_));
            if (length == 0)
                badByte();
            else if (static_cast<unsigned char>(peek()) >= 32 && content.size() < 200)
                content += text_.substr(at_, length);
            at_ += std::max<size_t>(length, 1);
        }
        token.text = content;
        if (peek() == '"')
            ++at_;
        else
            reporter_.error(place, {}, "this text is not closed before the line's end; it needs a second \"");
    }
    void colour() {
        Token& token = begin(TokenKind::colour);
        ++at_;
        std::string digits;
        while (digits.size() < 6 && std::isxdigit(static_cast<unsigned char>(peek()))) digits += text_[at_++];
        if (digits.size() < 6) {
            reporter_.error(token.place, {}, "a colour is # and six hexadecimal digits; comments begin with //");
            return;
        }
        for (int i = 0; i < 3; ++i) {
            int byte = 0;
            std::from_chars(digits.data() + 2 * i, digits.data() + 2 * i + 2, byte, 16);
            float v = static_cast<float>(byte) / 255.0f;
            token.rgb[i] = linearOfSrgb(v);
        }
        token.text = digits;
    }
    void stray() {
        size_t length = utf8Length(text_.substr(at_));
        if (length == 0) {
            badByte();
        } else if (length == 1 && static_cast<unsigned char>(peek()) < 32) {
            reporter_.error(here(), {}, "a control character");
        } else {
            reporter_.error(here(), {}, "'" + std::string(text_.substr(at_, length)) + "' has no meaning here");
        }
        at_ += std::max<size_t>(length, 1);
    }

    std::string_view text_;
    uint32_t file_;
    Reporter& reporter_;
    size_t at_ = 0, lineStart_ = 0;
    int line_ = 1;
    bool firstOnLine_ = true;
    std::vector<Token> tokens_;
};

}  // namespace

std::vector<Token> lex(std::string_view text, uint32_t file, Reporter& reporter) {
    return Lexer(text, file, reporter).run();
}

}  // namespace espalier::grammar
