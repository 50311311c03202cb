// Files whole, in and out. Writing goes through a neighbour that is renamed, so that nothing is ever half-written.
#include "tools/scene/text_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace espalier::scene {
namespace {

namespace fs = std::filesystem;

std::string systemReason() {
    return std::strerror(errno ? errno : EIO);
}

bool put(const fs::path& file, std::string_view text) {
    errno = 0;
    std::ofstream out(file, std::ios::binary);
    out.write(text.data(), std::streamsize(text.size()));
    out.close();
    return bool(out);
}

// A name beside `path` that nobody else uses.
fs::path neighbourOf(const fs::path& path) {
    return path.parent_path() / ("." + std::to_string(getpid()) + "-" + path.filename().string());
}

// No file that could be replaced: renaming over /dev/null would be a disaster.
bool isSpecial(const fs::path& path) {
    std::error_code code;
    const fs::file_type type = fs::status(path, code).type();
    return type == fs::file_type::character || type == fs::file_type::block || type == fs::file_type::fifo ||
           type == fs::file_type::socket;
}

}  // namespace

fs::path absolutePath(const std::string& path) {
    std::error_code gone;
    const fs::path whole = fs::absolute(path, gone);
    return gone ? fs::path(path) : whole;
}

fs::path behindLinks(const fs::path& path) {
    constexpr int kMostLinks = 40;
    fs::path behind = path;
    std::error_code error;
    for (int i = 0; i < kMostLinks && fs::is_symlink(behind, error); ++i)
        behind = behind.parent_path() / fs::read_symlink(behind, error);
    return behind;
}

bool writeText(const std::string& path, std::string_view text, std::string& error) {
    const auto fail = [&](const std::string& why) {
        error = path + ": can't be written: " + why;
        return false;
    };
    if (isSpecial(path)) return put(path, text) || fail(systemReason());
    const fs::path target = behindLinks(path), neighbour = neighbourOf(target);
    std::error_code code, ignored;
    if (!put(neighbour, text)) {
        const std::string why = systemReason();
        fs::remove(neighbour, ignored);
        return fail(why);
    }
    fs::rename(neighbour, target, code);
    if (!code) return true;
    fs::remove(neighbour, ignored);
    return fail(code.message());
}

bool refused(const std::string& path, std::string& error) {
    std::error_code code;
    const fs::file_type type = fs::status(path, code).type();
    const bool folder = type == fs::file_type::directory;
    if (!folder && !isSpecial(path)) return false;
    const bool pipe = type == fs::file_type::fifo || type == fs::file_type::socket;
    error = path + (folder ? ": is a folder" : pipe ? ": is a pipe, not a file" : ": is a device, not a file");
    return true;
}

bool readText(const std::string& path, std::string& text, std::string& error) {
    if (refused(path, error)) return false;
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    std::ostringstream all;
    if (file) all << file.rdbuf();
    if (!file) {
        error = path + ": can't be read: " + systemReason();
        return false;
    }
    text = all.str();
    return true;
}

}  // namespace espalier::scene
