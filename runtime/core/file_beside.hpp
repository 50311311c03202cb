#pragma once

// What a file that came from elsewhere may make us read. One rule for models' buffers, pictures and materials and for
// grammars' includes.

#include <filesystem>
#include <string_view>

#include "runtime/core/result.hpp"

namespace espalier {

// How many folders above its own a document may reach: kits keep pictures in ../textures or ../../textures.
inline constexpr int kFoldersUp = 2;

// Where the file lies that `document` names by `name`:
//   - a relative path starts in the document's folder; `/` and `\` separate folders alike;
//   - `..` leads up to kFoldersUp folders above the document's, and no link may lead out of that folder either;
//   - of an absolute path, as another machine had it, only the file's own name counts, beside the document;
//   - where no file has exactly this name, one that differs in capital letters is taken, as on the system that wrote
//   it.
// A file that isn't there is no failure: reading it will be. Fails with the document's name and the reason.
Result<std::filesystem::path> placeBeside(const std::filesystem::path& document, std::string_view name);

// The same by names alone, without a look at the disk: for documents that lie elsewhere, such as in a host's archive.
// Neither links nor capital letters are of account.
Result<std::filesystem::path> nameBeside(const std::filesystem::path& document, std::string_view name);

}  // namespace espalier
