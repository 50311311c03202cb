#pragma once

#include <doctest/doctest.h>

#include <string>

#include "tools/bake/bake.hpp"

namespace espalier::test {

inline std::string messageOf(const Result<Model>& model) {
    return model ? "imported" : model.failure().text();
}

// Ends the test case where the model can't be baked.
inline Baked bakeOrFail(const Model& model, const BakeOptions& options) {
    Result<Baked> baked = bake(model, options);
    if (!baked) FAIL(baked.failure().text());
    return std::move(*baked);
}

inline Baked bakeOrFail(const Model& model, uint32_t resolution = 256, bool keepLayout = false) {
    BakeOptions options;
    options.resolution = resolution;
    options.keepLayout = keepLayout;
    return bakeOrFail(model, options);
}

}  // namespace espalier::test
