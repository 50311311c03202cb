#pragma once

#include <CLI/CLI.hpp>
#include <optional>

namespace espalier {

// Reads a program's command line into the options that `app` knows. Nothing: it goes on. Else it is to end with this
// code: 0 after --help or --version, 2 where the line can't be read, which stderr has been told.
inline std::optional<int> parseCommandLine(CLI::App& app, int argc, char** argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) ? 2 : 0;
    }
    return std::nullopt;
}

}  // namespace espalier
