// In: a document and a name that it uses. Out: the file that it may read by that name.
#include "runtime/core/file_beside.hpp"

#include <algorithm>

namespace espalier {
namespace {

namespace fs = std::filesystem;

char lowerOf(char c) {
    return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
}

bool sameButForCapitals(const std::string& a, const std::string& b) {
    return std::ranges::equal(a, b, {}, lowerOf, lowerOf);
}

// As in "C:/a".
bool hasDrive(std::string_view name) {
    return name.size() > 1 && name[1] == ':' && lowerOf(name[0]) >= 'a' && lowerOf(name[0]) <= 'z';
}

int foldersUp(const fs::path& normal) {
    return int(std::ranges::count(normal, fs::path("..")));
}

// `wanted` in `folder`, or the first entry in order of names that differs from it in capital letters only.
fs::path entryOf(const fs::path& folder, const fs::path& wanted) {
    std::error_code ignored;
    if (wanted == ".." || fs::exists(fs::symlink_status(folder / wanted, ignored))) return folder / wanted;
    fs::path found;
    for (fs::directory_iterator at(folder.empty() ? "." : folder, ignored), end; !ignored && at != end;
         at.increment(ignored)) {
        const fs::path name = at->path().filename();
        if (sameButForCapitals(name.string(), wanted.string()) && (found.empty() || name < found)) found = name;
    }
    return folder / (found.empty() ? wanted : found);
}

bool liesIn(const fs::path& folder, const fs::path& file) {
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

Failure refusal(const fs::path& document, std::string_view name, const std::string& why) {
    return Failure(document.string(),
                   "'" + std::string(name.substr(0, std::min<size_t>(200, name.find('\0')))) + "' " + why);
}

const std::string& reach() {
    static const std::string folder = "the folder " + std::to_string(kFoldersUp) + " folders above this file's";
    return folder;
}

// The way from the document's folder to the file that it names.
Result<fs::path> wayTo(const fs::path& document, std::string_view name) {
    const auto refuse = [&](const std::string& why) { return refusal(document, name, why); };
    std::string text(name);
    std::ranges::replace(text, '\\', '/');
    if (text.empty() || text.find('\0') != std::string::npos) return refuse("is no file's name");
    if (text.find("://") != std::string::npos) return refuse("is an address: only files beside this one are read");
    const bool absolute = text.front() == '/' || hasDrive(text);
    if (hasDrive(text)) text.erase(0, 2);
    fs::path inside = fs::path(text).lexically_normal();
    if (absolute) inside = inside.filename();
    if (!inside.has_filename() || inside.filename() == "." || inside.filename() == "..")
        return refuse("is no file's name");
    if (foldersUp(inside) > kFoldersUp) return refuse("leads out of what may be read: " + reach());
    return inside;
}

}  // namespace

Result<fs::path> nameBeside(const fs::path& document, std::string_view name) {
    Result<fs::path> way = wayTo(document, name);
    if (!way) return way;
    return (document.parent_path() / *way).lexically_normal();
}

Result<fs::path> placeBeside(const fs::path& document, std::string_view name) {
    const Result<fs::path> way = wayTo(document, name);
    if (!way) return way.failure();
    fs::path file = document.parent_path();
    for (const fs::path& part : way.value()) file = entryOf(file, part);
    std::error_code error;
    fs::path top = fs::canonical(document.has_parent_path() ? document.parent_path() : ".", error);
    for (int i = 0; i < kFoldersUp; ++i) top = top.parent_path();
    const fs::path behind = fs::weakly_canonical(fs::absolute(file, error), error);
    if (!error && !liesIn(top, behind)) return refusal(document, name, "is a link that leads out of " + reach());
    return file;
}

}  // namespace espalier
