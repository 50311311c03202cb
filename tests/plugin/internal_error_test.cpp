// A check of the library's own that fails, as a host sees it.
#include <doctest/doctest.h>

#include "runtime/core/check.hpp"
#include "runtime/plugin/errors.hpp"

using namespace espalier;

TEST_CASE("a check of ours that fails is a code and a message that names its place, and the process goes on") {
    EspContext context;
    context.log = [](Severity, std::string_view) {};
    const auto mistaken = [] {
        require(false, "what holds always");
        return ESP_OK;
    };
    CHECK(guarded(&context, mistaken) == ESP_INTERNAL_ERROR);
    CHECK(context.error.find("internal_error_test.cpp") != std::string::npos);
    CHECK(context.error.find("what holds always") != std::string::npos);
    CHECK(guardedAlone(mistaken) == ESP_INTERNAL_ERROR);
    CHECK(errorAlone().find("what holds always") != std::string::npos);
}
