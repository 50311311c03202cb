// Lines "file:line:column: warning: rule: message", all but the message left out where they aren't known -> remarks.
#include "sample_game/remarks.hpp"

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <sstream>

namespace sample {
namespace {

Remark remarkOf(const std::string& line, const std::string& file) {
    Remark remark{0, false, line};
    if (line.starts_with(file + ":")) {
        const std::string rest = line.substr(file.size() + 1);
        remark.line = std::atoi(rest.c_str());
        remark.text = remark.line > 0 ? "line " + rest : rest;
    }
    static const std::regex kRule(R"((:\d+: (?:warning: )?)([A-Za-z_]\w*): )");
    remark.text = std::regex_replace(remark.text, kRule, "$1in '$2': ", std::regex_constants::format_first_only);
    // Behind the place, before what might be quoted.
    const size_t word = line.find(": warning: ");
    remark.warning = word != std::string::npos && line.find('\'') > word;
    return remark;
}

}  // namespace

std::vector<Remark> remarksOf(const espalier::scene::LoadedGrammar& grammar) {
    std::vector<Remark> remarks;
    for (const std::string* text : {&grammar.error, &grammar.warnings}) {
        std::istringstream lines(*text);
        for (std::string line; std::getline(lines, line);) remarks.push_back(remarkOf(line, grammar.file));
    }
    std::stable_partition(remarks.begin(), remarks.end(), [](const Remark& remark) { return !remark.warning; });
    return remarks;
}

}  // namespace sample
