// In: values of OpenStreetMap's tags and of columns that other programs export. Out: numbers in metres and degrees.
#include "runtime/roof/footprint_values.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

namespace espalier {

namespace {

using nlohmann::json;

constexpr double kFoot = 0.3048, kInch = 0.0254;

// A number at the text's begin, which is taken off with the blanks around it. A comma counts as a point: heights of
// a thousand metres aren't written.
std::optional<double> takeNumber(std::string_view& text) {
    const auto skip = [&] {
        while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    };
    skip();
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    std::string plain(text);
    if (const size_t comma = plain.find(','); comma != std::string::npos && plain.find('.') == std::string::npos)
        plain[comma] = '.';
    double d = 0;
    const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), d);
    if (error != std::errc()) return {};
    text.remove_prefix(size_t(end - plain.data()));
    skip();
    return d;
}

// Typographic marks of feet, inches and degrees as plain ones.
std::string plainMarks(std::string text) {
    static constexpr std::pair<const char*, const char*> marks[] = {
        {"′", "'"}, {"’", "'"}, {"″", "\""}, {"”", "\""}, {"''", "\""}, {"°", " deg"}, {"º", " deg"}};
    for (const auto& [mark, plain] : marks)
        for (size_t at; (at = text.find(mark)) != std::string::npos;) text.replace(at, std::string(mark).size(), plain);
    return text;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '.')) text.remove_suffix(1);
    return text;
}

bool among(std::string_view text, std::initializer_list<std::string_view> words) {
    return std::find(words.begin(), words.end(), text) != words.end();
}

// Metres of a unit; 0: there is none of this name.
double metresOf(std::string_view unit) {
    unit = trimmed(unit);
    if (among(unit, {"", "m", "metre", "metres", "meter", "meters", "mt", "mtr"})) return 1;
    if (among(unit, {"cm"})) return 0.01;
    if (among(unit, {"mm"})) return 0.001;
    if (among(unit, {"'", "ft", "feet", "foot"})) return kFoot;
    if (among(unit, {"\"", "in", "inch", "inches"})) return kInch;
    return 0;
}

std::optional<std::string> textOf(const json& value) {
    if (!value.is_string()) return {};
    const std::string& text = value.get_ref<const std::string&>();
    if (text.size() > kLongestValue) return {};
    return plainMarks(lowered(text));
}

}  // namespace

std::string lowered(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

std::optional<double> readLength(const json& value) {
    if (value.is_number()) return value.get<double>();
    const std::optional<std::string> text = textOf(value);
    if (!text) return {};
    std::string_view rest = *text;
    const std::optional<double> number = takeNumber(rest);
    if (!number) return {};
    // The unit goes up to the next number: inches behind feet.
    const size_t next = std::min(rest.find_first_of("0123456789"), rest.size());
    std::string_view name = rest.substr(0, next);
    if (next < rest.size() && name.ends_with('-')) name.remove_suffix(1);
    const double unit = metresOf(name);
    rest.remove_prefix(next);
    if (unit == 0) return {};
    if (rest.empty()) return *number * unit;
    const std::optional<double> inches = unit == kFoot ? takeNumber(rest) : std::nullopt;
    if (!inches || *inches < 0 || *inches >= 12 || metresOf(rest) != kInch) return {};
    return *number * kFoot + (*number < 0 ? -1 : 1) * *inches * kInch;
}

std::optional<double> readNumber(const json& value) {
    if (value.is_number()) return value.get<double>();
    const std::optional<std::string> text = textOf(value);
    if (!text) return {};
    std::string_view rest = *text;
    const std::optional<double> number = takeNumber(rest);
    if (!number || !among(trimmed(rest), {"", "deg", "degree", "degrees"})) return {};
    return number;
}

std::optional<double> readDirection(const json& value) {
    if (const std::optional<double> degrees = readNumber(value)) return degrees;
    std::optional<std::string> text = textOf(value);
    if (!text) return {};
    // Words become their letters: north-north-east is nne.
    static constexpr std::pair<const char*, char> words[] = {
        {"north", 'n'}, {"south", 's'}, {"east", 'e'}, {"west", 'w'}};
    for (const auto& [word, letter] : words)
        for (size_t at; (at = text->find(word)) != std::string::npos;)
            text->replace(at, std::string(word).size(), 1, letter);
    std::erase_if(*text, [](char c) { return c == '-' || c == '_' || c == ' '; });
    static constexpr std::array<std::string_view, 16> points{"n", "nne", "ne", "ene", "e", "ese", "se", "sse",
                                                             "s", "ssw", "sw", "wsw", "w", "wnw", "nw", "nnw"};
    const auto point = std::find(points.begin(), points.end(), *text);
    if (point == points.end()) return {};
    return 22.5 * double(point - points.begin());
}

bool readYes(const json& value) {
    if (value.is_boolean()) return value.get<bool>();
    if (value.is_number()) return value.get<double>() != 0;
    if (!value.is_string()) return true;
    if (value.get_ref<const std::string&>().size() > kLongestValue) return true;
    const std::string text = lowered(value.get<std::string>());
    return !among(text, {"no", "false", "0", "none"});
}

}  // namespace espalier
