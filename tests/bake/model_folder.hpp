#pragma once

// Model files that a test writes, and what reading them gives.

#include <doctest/doctest.h>

#include "runtime/core/file.hpp"
#include "tests/bake/baking.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/bake/import_model.hpp"

namespace espalier::test {

struct ModelFolder : ScratchFolder {
    void put(const std::string& name, std::string_view bytes) const { REQUIRE(writeFile(file(name), bytes)); }
    // Ends the test case where the model can't be read.
    Model read(const std::string& name, std::string_view bytes, const ImportOptions& options = {}) const {
        put(name, bytes);
        auto model = importModel(file(name), options);
        if (!model) FAIL(model.failure().text());
        return std::move(*model);
    }
    // The message with which it is refused, or "imported".
    std::string refusal(const std::string& name, std::string_view bytes) const {
        put(name, bytes);
        return messageOf(importModel(file(name)));
    }
};

inline bool warns(const Model& model, const std::string& part) {
    for (const Diagnostic& warning : model.warnings)
        if (toString(warning).find(part) != std::string::npos) return true;
    return false;
}

}  // namespace espalier::test
