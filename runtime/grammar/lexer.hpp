#pragma once

#include <string_view>
#include <vector>

#include "runtime/grammar/ast.hpp"

namespace espalier::grammar {

enum class TokenKind : uint8_t { end, name, number, string, colour, symbol };

struct Token {
    TokenKind kind = TokenKind::end;
    std::string text;  // of a string: between its quotes; of a symbol: as written, "→" as "->"
    float value = 0;
    float rgb[3] = {};  // of a colour, linear
    Place place;
    bool firstOnLine = false;
    int length = 0;  // bytes in the text
};

// Splits a text into tokens; the last is `end`. Bytes that belong to no token are reported and skipped.
std::vector<Token> lex(std::string_view text, uint32_t file, Reporter& reporter);

}  // namespace espalier::grammar
