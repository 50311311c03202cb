#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/core/file.hpp"

namespace espalier {

// Files that are written before the one that they belong to. Unless that comes, each is again what it was, or gone.
class Beforehand {
  public:
    Beforehand() = default;
    Beforehand(const Beforehand&) = delete;
    ~Beforehand() {
        for (auto file = files_.rbegin(); file != files_.rend(); ++file) {
            std::error_code ignored;
            if (file->before)
                (void)writeFile(file->path, *file->before);
            else
                std::filesystem::remove(file->path, ignored);
        }
    }
    Status write(const std::string& path, std::span<const std::byte> bytes) {
        std::error_code ignored;
        const auto type = std::filesystem::status(path, ignored).type();
        File file{path, {}};
        if (type == std::filesystem::file_type::regular)
            if (auto before = readFile(path)) file.before = std::move(*before);
        Status written = writeFile(path, bytes);
        // A pipe or a device stays what it is, and so does what can't be read.
        if (written && (file.before || type == std::filesystem::file_type::not_found))
            files_.push_back(std::move(file));
        return written;
    }
    void keep() { files_.clear(); }

  private:
    struct File {
        std::string path;
        std::optional<std::vector<std::byte>> before;
    };
    std::vector<File> files_;
};

}  // namespace espalier
