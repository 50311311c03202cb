#pragma once

#include <filesystem>
#include <optional>

#include "runtime/core/result.hpp"
#include "runtime/grammar/grammar.hpp"

namespace espalier {

// Compiled grammars on disk, a file each, by the hash of what they were compiled from. Who types a grammar compiles a
// hundred texts that never come again, so the folder holds no more than kMost files: those used last stay. Several
// processes may share it; other files in it are left alone.
class RuleMapCache {
  public:
    static constexpr size_t kMost = 256;

    explicit RuleMapCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // What is kept under this hash, if it loads and passes verification.
    std::optional<RuleMap> find(uint64_t contentHash) const;
    // Fails when the file can't be written; makes the folder if need be.
    Status keep(const RuleMap& map) const;

  private:
    std::filesystem::path fileOf(uint64_t contentHash) const;
    void dropOldest() const;

    std::filesystem::path folder_;
};

}  // namespace espalier
