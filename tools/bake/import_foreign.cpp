// In: the bytes of a model that another program can read. Out: the model, by way of a glTF file in a folder of its own.
#include "tools/bake/import_foreign.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "runtime/core/file.hpp"

namespace espalier::import {
namespace {

namespace fs = std::filesystem;

constexpr int kSeconds = 120;
constexpr rlim_t kMostMemory = rlim_t(4) << 30, kMostOutput = rlim_t(1) << 30;  // bytes

// Goes away with all that is in it.
class OwnFolder {
  public:
    OwnFolder() {
        std::error_code ignored;
        std::string name = (fs::temp_directory_path(ignored) / "espalier-convert-XXXXXX").string();
        if (::mkdtemp(name.data())) path_ = name;
    }
    ~OwnFolder() {
        std::error_code ignored;
        if (!path_.empty()) fs::remove_all(path_, ignored);
    }
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;
    std::string file(const std::string& name) const { return (path_ / name).string(); }
    explicit operator bool() const { return !path_.empty(); }

  private:
    fs::path path_;
};

// Of the program's file, by the folders of PATH; empty: it isn't there.
std::string findProgram(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::string_view rest = path ? path : "/usr/bin:/bin";
    while (!rest.empty()) {
        const size_t end = std::min(rest.find(':'), rest.size());
        const std::string file = std::string(rest.substr(0, end)) + "/" + name;
        if (file.front() == '/' && ::access(file.c_str(), X_OK) == 0) return file;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return {};
}

void limit(int resource, rlim_t most) {
    const rlimit both{most, most};
    ::setrlimit(resource, &both);
}

// Only what a forked process may do. Never returns.
[[noreturn]] void becomeProgram(char* const* arguments, int log) {
    static char locale[] = "LC_ALL=C";
    char* const environment[] = {locale, nullptr};
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    limit(RLIMIT_CPU, kSeconds);
    limit(RLIMIT_AS, kMostMemory);
    limit(RLIMIT_FSIZE, kMostOutput);
    limit(RLIMIT_CORE, 0);
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    ::execve(arguments[0], arguments, environment);
    ::_exit(127);
}

// Runs the program and says why it failed; empty: it didn't. What it writes goes into the file `log`.
std::string run(std::vector<std::string> words, const std::string& log) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0) return "its messages can't be written";
    const pid_t process = ::fork();
    if (process == 0) becomeProgram(arguments.data(), file);
    ::close(file);
    if (process < 0) return "no process is left for it";
    int status = 0;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(kSeconds);
    while (::waitpid(process, &status, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > end) {
            ::kill(process, SIGKILL);
            ::waitpid(process, &status, 0);
            return "it takes more than " + std::to_string(kSeconds) + " seconds";
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    if (WIFSIGNALED(status)) return std::string("it ended by a fault (") + ::strsignal(WTERMSIG(status)) + ")";
    if (WEXITSTATUS(status) == 0) return {};
    auto said = readTextFile(log);
    const size_t error = said ? said->rfind("ERROR: ") : std::string::npos;
    if (error == std::string::npos) return "it ended with code " + std::to_string(WEXITSTATUS(status));
    std::string line = said->substr(error + 7, 300);
    return line.substr(0, line.find('\n'));
}

}  // namespace

Status importForeign(const std::string& path, Bytes file, const FileKind& kind, const ImportOptions& options,
                     Intake& intake, Model& model) {
    const std::string is = std::string("the file is ") + kind.name;
    const std::string program = findProgram("assimp");
    // Whether it is there, and which version: what is remembered of the model depends on it.
    intake.note(program.empty() ? "/usr/bin/assimp" : program);
    if (program.empty())
        return Failure(path,
                       is + ", which the program assimp reads: install it (on Debian: apt install assimp-utils), or " +
                           kind.advice);
    OwnFolder folder;
    if (!folder) return Failure(path, is + ", and no folder can be made for converting it");
    const std::string from = folder.file(std::string("model") + kind.ending), to = folder.file("model.glb");
    if (Status copied = writeFile(from, std::as_bytes(file)); !copied) return copied;
    const std::string why = run({program, "export", from, to, "-fglb2", "-tri", "-gs"}, folder.file("log"));
    if (!why.empty())
        return Failure(path, is + ", and the program assimp can't convert it: " + why + "; " + kind.advice);
    auto converted = readFile(to);
    if (!converted || !intake.take(converted->size()))
        return Failure(path, is + ", and the program assimp made nothing usable of it; " + kind.advice);
    model.warnings.push_back({path, 0, 0, {}, is + ": the program assimp has converted it to glTF", true});
    const Bytes bytes(reinterpret_cast<const uint8_t*>(converted->data()), converted->size());
    return importGltf(path, bytes, options, intake, model);
}

}  // namespace espalier::import
