// In: a model's file. Out: its surface, by another program: what that says on its way is the progress, and its last
// line the reason why it couldn't.
#include "tools/baking/bake_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "tools/scene/scene.hpp"

extern char** environ;

namespace espalier::baking {
namespace {

namespace fs = std::filesystem;
constexpr int kLookEvery = 100;  // milliseconds, at whether it was called off

// A running program, whose stderr is read.
class Child {
  public:
    ~Child() {
        if (output_ >= 0) ::close(output_);
        if (pid_ > 0) {
            ::kill(pid_, SIGTERM);  // which waits while it writes
            ::waitpid(pid_, nullptr, 0);
        }
    }
    bool start(const std::string& program, const std::vector<std::string>& arguments, std::string& error) {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) return failed(program, errno, error);
        output_ = ends[0];
        std::vector<char*> words{const_cast<char*>(program.c_str())};
        for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_adddup2(&files, ends[1], STDERR_FILENO);
        posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        const int code = ::posix_spawn(&pid_, program.c_str(), &files, nullptr, words.data(), environ);
        posix_spawn_file_actions_destroy(&files);
        ::close(ends[1]);
        if (code != 0) pid_ = -1;
        return code == 0 || failed(program, code, error);
    }
    // What it has said since, within a while; empty and `ended`: it says no more.
    std::string read(int milliseconds, bool& ended) {
        pollfd waits{output_, POLLIN, 0};
        if (::poll(&waits, 1, milliseconds) <= 0) return {};
        std::array<char, 4096> piece;
        const ssize_t got = ::read(output_, piece.data(), piece.size());
        ended = got == 0 || (got < 0 && errno != EINTR);
        return got > 0 ? std::string(piece.data(), size_t(got)) : "";
    }
    // Its exit code; -1: it was ended by a signal.
    int wait() {
        int status = 0;
        while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
        }
        pid_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

  private:
    static bool failed(const std::string& program, int code, std::string& error) {
        error = program + ": can't be started: " + std::strerror(code);
        return false;
    }
    pid_t pid_ = -1;
    int output_ = -1;
};

// "  7 % charts": how far it is.
bool isProgress(const std::string& line, float& part) {
    char* end = nullptr;
    const long percent = std::strtol(line.c_str(), &end, 10);
    if (end == line.c_str() || std::strncmp(end, " % ", 3) != 0) return false;
    part = std::clamp(float(percent) / 100, 0.f, 1.f);
    return true;
}

// What is neither progress nor a warning is why it ends, in one line or several.
void takeLine(const std::string& line, float& part, std::string& said) {
    constexpr std::string_view kName = "espalier-bake: ";
    if (isProgress(line, part)) return;
    if (line.starts_with(kName))
        said = line.substr(kName.size());
    else if (!said.empty())
        said += "\n" + line;
}

}  // namespace

fs::path bakeProgram() {
    return fs::path(scene::contentFolder()).parent_path() / "bin" / "espalier-bake";
}

bool bake(const std::string& model, const std::string& surface, const std::vector<std::string>& options,
          document::Progress& progress, std::string& error) {
    std::error_code code;
    fs::create_directories(fs::path(surface).parent_path(), code);
    std::vector<std::string> arguments{model, "-o", surface};
    arguments.insert(arguments.end(), options.begin(), options.end());
    Child child;
    if (!child.start(bakeProgram().string(), arguments, error)) return false;
    std::string line, said;
    float part = 0;
    for (bool ended = false; !ended;) {
        for (char c : child.read(kLookEvery, ended)) {
            if (c != '\n') {
                line += c;
                continue;
            }
            takeLine(line, part, said);
            line.clear();
        }
        if (!progress.at(part)) return false;  // its end ends the program
    }
    const int exit = child.wait();
    if (exit == 0) return true;
    error = exit < 0 || said.empty() ? model + ": the baker ended without a word, perhaps for want of memory" : said;
    return false;
}

}  // namespace espalier::baking
