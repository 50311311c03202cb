// In: rule maps and their hashes. Out: files in a folder, the oldest of which go when there are too many. What another
// process does there meanwhile, or forbids, costs a compilation and nothing else.
#include "runtime/grammar/rule_map_cache.hpp"

#include <algorithm>
#include <cstdio>
#include <system_error>
#include <vector>

#include "runtime/core/file.hpp"

namespace espalier {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".rulemap";
constexpr size_t kHashDigits = 16;

bool isOurs(const fs::path& file) {
    const std::string name = file.stem().string();
    return file.extension() == kEnding && name.size() == kHashDigits &&
           name.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

fs::path RuleMapCache::fileOf(uint64_t contentHash) const {
    char name[kHashDigits + 1];
    std::snprintf(name, sizeof name, "%016llx", static_cast<unsigned long long>(contentHash));
    return folder_ / (std::string(name) + kEnding);
}

std::optional<RuleMap> RuleMapCache::find(uint64_t contentHash) const {
    const fs::path file = fileOf(contentHash);
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return std::nullopt;
    Result<std::vector<std::byte>> bytes = readFile(file);
    if (!bytes) return std::nullopt;
    Result<RuleMap> map =
        RuleMap::load({reinterpret_cast<const uint8_t*>(bytes->data()), bytes->size()}, file.filename().string());
    if (!map || map->contentHash() != contentHash) return std::nullopt;
    fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);  // used last
    return std::move(*map);
}

Status RuleMapCache::keep(const RuleMap& map) const {
    const std::vector<uint8_t> bytes = map.save();
    Status written = writeFile(fileOf(map.contentHash()), std::as_bytes(std::span(bytes)), Links::replace);
    if (written) dropOldest();
    return written;
}

void RuleMapCache::dropOldest() const {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    std::error_code error;
    for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error))
        if (isOurs(it->path())) {
            std::error_code gone;
            const auto time = it->last_write_time(gone);
            if (!gone) files.emplace_back(time, it->path());
        }
    if (files.size() <= kMost) return;
    std::ranges::sort(files);
    files.resize(files.size() - kMost);
    for (const auto& [time, file] : files) fs::remove(file, error);
}

}  // namespace espalier
