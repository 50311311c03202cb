// Files whole, in and out. Writing goes through a neighbour that is renamed, so that nothing is ever half-written.
#include "tools/scene/text_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "tools/scene/unfinished.hpp"

namespace espalier::scene {
namespace {

namespace fs = std::filesystem;

std::string systemReason() {
    return std::strerror(errno ? errno : EIO);
}

// To what isn't replaced.
bool put(const fs::path& device, std::string_view text) {
    errno = 0;
    std::ofstream out(device, std::ios::binary);
    out.write(text.data(), std::streamsize(text.size()));
    out.close();
    return bool(out);
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
    if (!isSpecial(path)) {
        Unfinished file(path);
        return file.write(text, error) && file.take(error);
    }
    const bool good = put(path, text);
    if (!good) error = path + ": can't be written: " + systemReason();
    return good;
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

bool readText(const std::string& path, std::string& text, std::string& error, uint64_t most) {
    const auto fail = [&](const std::string& why) {
        error = path + why;
        return false;
    };
    if (refused(path, error)) return false;
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) return fail(": can't be read: " + systemReason());
    // By pieces: files that grow, and those of /proc, have no size to trust.
    std::error_code unknown;
    const uint64_t said = fs::file_size(path, unknown);
    text.clear();
    if (!unknown && said <= most) text.reserve(size_t(said));
    for (char piece[1 << 14]; file.good();) {
        file.read(piece, sizeof piece);
        text.append(piece, size_t(file.gcount()));
        if (text.size() > most) return fail(" has more than " + std::to_string(most >> 20) + " MiB");
    }
    return !file.bad() || fail(": can't be read: " + systemReason());
}

}  // namespace espalier::scene
