#pragma once

// Where a context's files come from: the disk, or the host (EspFiles).

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"
#include "runtime/core/result.hpp"
#include "runtime/grammar/grammar.hpp"

namespace espalier {

// Why a file on the disk can't be read at all; empty: it can.
std::string whyUnreadable(const char* path);

class Files {
  public:
    Files() = default;  // the disk
    explicit Files(const EspFiles& host) : host_(host) {}

    bool fromHost() const { return host_.has_value(); }  // read by callbacks, on the context's thread only

    // Where the file lies that another names: by the rule of runtime/core/file_beside.hpp.
    Result<std::filesystem::path> beside(const std::string& document, const std::string& name) const;
    // The whole file, or why it can't be read.
    Result<std::vector<std::byte>> read(const std::string& path) const;
    // For what the file of this name includes.
    IncludeReader includesOf(const std::string& file) const;

  private:
    std::optional<EspFiles> host_;
};

}  // namespace espalier
