#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace espalier {

// Reads a program's command line into the options that `app` knows. Nothing: it goes on. Else it is to end with this
// code: 0 after --help or --version, 2 where the line can't be read, which stderr has been told.
inline std::optional<int> parseCommandLine(CLI::App& app, int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN);  // too large a file is an error like a full disk, with a message
    app.failure_message([](const CLI::App* program, const CLI::Error& mistake) {
        return program->get_name() + ": " + mistake.what() + "; see --help\n";
    });
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) ? 2 : 0;
    }
    return std::nullopt;
}

// Runs a program's body. No exception, of a library's either, ends the program: it is a message and the code `failed`.
template <class F>
int runProgram(const char* name, F&& body, int failed = 1) {
    const auto tell = [&](const char* why) {
        std::fprintf(stderr, "%s: %s\n", name, why);
        return failed;
    };
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return tell("memory has run out");
    } catch (const std::exception& mistake) {
        return tell(mistake.what());
    } catch (...) {
        return tell("something has failed that doesn't say what");
    }
}

// "1280x720": two whole numbers from `least` to `most`. Nothing: the text says something else.
inline std::optional<std::pair<uint32_t, uint32_t>> sizeSaid(std::string_view text, uint32_t least, uint32_t most) {
    const auto number = [&](std::string_view digits) {
        uint32_t value = 0;
        const auto [end, wrong] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        return wrong == std::errc() && end == digits.data() + digits.size() && value >= least && value <= most ? value
                                                                                                               : 0;
    };
    const size_t by = std::min(text.find('x'), text.size());
    const uint32_t width = number(text.substr(0, by)), height = number(text.substr(std::min(by + 1, text.size())));
    if (width == 0 || height == 0) return std::nullopt;
    return std::pair(width, height);
}

// "NAME=FILE", neither of them empty. Nothing: the text says something else.
inline std::optional<std::pair<std::string, std::string>> namedFileSaid(const std::string& text) {
    const size_t sign = text.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == text.size()) return std::nullopt;
    return std::pair(text.substr(0, sign), text.substr(sign + 1));
}

// What --layer NAME=FILE has said, each layer once; else what is wrong with it.
inline std::string takeLayers(const std::vector<std::string>& said,
                              std::vector<std::pair<std::string, std::string>>& layers) {
    for (const std::string& text : said) {
        const auto read = namedFileSaid(text);
        if (!read) return "--layer takes NAME=FILE, not '" + text + "'";
        for (const auto& [name, file] : layers)
            if (name == read->first) return "--layer: '" + name + "' comes twice";
        layers.push_back(*read);
    }
    return {};
}

// Whether both lead to one file, be it there already or not.
inline bool sameFile(const std::string& a, const std::string& b) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const auto whole = [&](const std::string& path) { return fs::weakly_canonical(fs::absolute(path), ignored); };
    return fs::equivalent(a, b, ignored) || whole(a) == whole(b);
}

// The first of the files to be written that is among those to be read, or is to be written twice; names that are empty
// stand for none, and devices take anything.
inline std::optional<std::string> writtenOver(const std::vector<std::string>& read,
                                              const std::vector<std::string>& written) {
    namespace fs = std::filesystem;
    for (size_t i = 0; i < written.size(); ++i) {
        std::error_code ignored;
        const fs::file_type type = fs::status(written[i], ignored).type();
        const bool file = type == fs::file_type::regular || type == fs::file_type::not_found;
        if (written[i].empty() || !file) continue;
        const auto same = [&](const std::string& other) { return !other.empty() && sameFile(other, written[i]); };
        if (std::any_of(read.begin(), read.end(), same) ||
            std::any_of(written.begin(), written.begin() + std::ptrdiff_t(i), same))
            return written[i];
    }
    return std::nullopt;
}

}  // namespace espalier
