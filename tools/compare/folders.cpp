// Which pictures of two folders belong together.
#include "tools/compare/folders.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

namespace espalier::compare {
namespace {

namespace fs = std::filesystem;

bool isPicture(const fs::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    return ending == ".png" || ending == ".jpg" || ending == ".jpeg" || ending == ".exr";
}

template <class Take>
bool eachPicture(const std::string& folder, Take&& take, std::string& error) {
    std::error_code code;
    fs::recursive_directory_iterator at(folder, code);
    for (; !code && at != fs::recursive_directory_iterator(); at.increment(code))
        if (std::error_code none; isPicture(at->path()) && !at->is_directory(none))
            take(at->path().lexically_relative(folder).generic_string(), at->path().string());
    if (code) error = folder + ": can't be read: " + code.message();
    return !code;
}

}  // namespace

bool pairsOf(const std::string& first, const std::string& second, std::vector<Pair>& out, std::string& error) {
    std::map<std::string, Pair> pairs;
    const bool read =
        eachPicture(
            first, [&](const std::string& name, const std::string& file) { pairs[name].first = file; }, error) &&
        eachPicture(
            second, [&](const std::string& name, const std::string& file) { pairs[name].second = file; }, error);
    if (!read) return false;
    for (auto& [name, pair] : pairs) {
        pair.name = name;
        out.push_back(pair);
    }
    if (out.empty()) error = first + " and " + second + " hold no picture (.png, .jpg, .jpeg, .exr)";
    return !out.empty();
}

}  // namespace espalier::compare
