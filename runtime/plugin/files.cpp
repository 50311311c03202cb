// Reads whole files, by a host's callbacks where it has given some.
#include "runtime/plugin/files.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "runtime/core/file.hpp"
#include "runtime/core/file_beside.hpp"
#include "runtime/core/undo.hpp"

namespace espalier {
namespace {

Result<std::vector<std::byte>> readByHost(const EspFiles& host, const std::string& path) {
    const void* bytes = nullptr;
    size_t size = 0;
    if (const EspResult result = host.read(host.user, path.c_str(), &bytes, &size))
        return Failure(path, "can't be read: the host's EspFiles::read has answered " + std::to_string(int(result)));
    Undo release([&] { host.release(host.user, bytes, size); });
    if (!bytes && size > 0) return Failure(path, "can't be read: the host's EspFiles::read has given no bytes");
    const auto* first = static_cast<const std::byte*>(bytes);
    return std::vector<std::byte>(first, first + size);
}

}  // namespace

std::string whyUnreadable(const char* path) {
    std::error_code error;
    using Type = std::filesystem::file_type;
    const Type type = std::filesystem::status(path, error).type();
    if (type == Type::directory) return std::string(path) + ": is a folder";
    if (type == Type::fifo || type == Type::socket) return std::string(path) + ": is a pipe, not a file";
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    return file ? "" : std::string(path) + ": can't be read: " + std::strerror(errno);
}

Result<std::vector<std::byte>> Files::read(const std::string& path) const {
    if (host_) return readByHost(*host_, path);
    if (std::string why = whyUnreadable(path.c_str()); !why.empty()) return Failure("", std::move(why));
    return readFile(path);
}

Result<std::filesystem::path> Files::beside(const std::string& document, const std::string& name) const {
    return host_ ? nameBeside(document, name) : placeBeside(document, name);
}

IncludeReader Files::includesOf(const std::string& file) const {
    if (!host_) return includesBeside(file);
    return [file, files = *this](const std::string& name) -> Result<std::string> {
        const Result<std::filesystem::path> place = files.beside(file, name);
        if (!place) return place.failure();
        const Result<std::vector<std::byte>> bytes = files.read(place.value().string());
        if (!bytes) return bytes.failure();
        return std::string(reinterpret_cast<const char*>(bytes.value().data()), bytes.value().size());
    };
}

}  // namespace espalier
