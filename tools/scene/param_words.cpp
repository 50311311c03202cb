// A parameter's label -> its parts.
#include "tools/scene/param_words.hpp"

#include <algorithm>
#include <sstream>

namespace espalier::scene {
namespace {

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    return text;
}

}  // namespace

ParamWords paramWords(const std::string& label) {
    ParamWords words;
    const size_t slash = label.find(" / "), begin = slash == std::string::npos ? 0 : slash + 3;
    const size_t stop = label.find(". ", begin);
    if (begin > 0) words.group = label.substr(0, slash);
    words.name = label.substr(begin, stop == std::string::npos ? stop : stop - begin);
    if (stop != std::string::npos) words.tip = label.substr(stop + 2);
    return words;
}

bool holdsWords(const std::string& text, const std::string& wanted) {
    const std::string in = lowered(text);
    std::istringstream words(lowered(wanted));
    for (std::string word; words >> word;)
        if (in.find(word) == std::string::npos) return false;
    return true;
}

}  // namespace espalier::scene
