#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/scratch_folder.hpp"

// Running the built programs as a user does, through the shell.

struct Ran {
    int code = -1;       // exit code; -1: ended by a signal
    std::string output;  // of stdout and stderr together
};

inline Ran run(const std::string& command) {
    Ran ran;
#ifdef __SANITIZE_ADDRESS__
    // The driver's modules are unloaded at a program's end, and what they keep would be taken for our leak.
    setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
#endif
    FILE* pipe = popen(("( " + command + " ) 2>&1 </dev/null").c_str(), "r");
    if (!pipe) return ran;
    char piece[4096];
    while (size_t got = std::fread(piece, 1, sizeof piece, pipe)) ran.output.append(piece, got);
    const int status = pclose(pipe);
    if (WIFEXITED(status) && WEXITSTATUS(status) < 128) ran.code = WEXITSTATUS(status);
    return ran;
}

// The same with a display of its own, where xvfb-run is installed. The command says itself how it ended: xvfb-run can
// fail to clear up what it made for it.
inline Ran runOnDisplay(const std::string& size, const std::string& command) {
    const std::string end = "command ended with ";
    Ran ran = run("xvfb-run -a -s '-screen 0 " + size + "x24' sh -c '" + command + "; echo \"" + end + "$?\"'");
    const size_t at = ran.output.rfind(end);
    ran.code = at == std::string::npos ? -1 : std::atoi(ran.output.c_str() + at + end.size());
    return ran;
}

inline std::string program(const char* name) {
    return std::string(ESPALIER_BIN) + "/" + name;
}
inline std::string content(const char* name) {
    return std::string(ESPALIER_CONTENT) + "/" + name;
}

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

struct Folder : espalier::test::ScratchFolder {
    std::string write(const char* name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
        return file(name);
    }
    size_t count() const {
        size_t files = 0;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) files += entry.is_regular_file();
        return files;
    }
};

inline std::string readAll(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}
