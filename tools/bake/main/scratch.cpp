// In: a cache's folder. Out: one in it for a run, and none of runs that are dead.
//
//   .run-SPACE-PID-XXXXXX   of the process PID. Machines that share the folder have other SPACEs, as have containers:
//                           whether their processes live can't be told from here
#include "tools/bake/main/scratch.hpp"

#include <unistd.h>

#include <cerrno>
#include <cinttypes>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "runtime/core/file.hpp"
#include "runtime/core/hash.hpp"

namespace espalier::folder {
namespace {

namespace fs = std::filesystem;

// Of the processes among which a number stands for one: since the machine's last start, in this container. 0: unknown.
uint64_t spaceOfProcesses() {
    std::error_code error;
    auto start = readTextFile("/proc/sys/kernel/random/boot_id");
    const fs::path container = fs::read_symlink("/proc/self/ns/pid", error);
    return start && !error ? hashText(container.string(), hashText(*start, 1)) : 0;
}

bool isDead(pid_t process) {
    return ::kill(process, 0) != 0 && errno == ESRCH;
}

void removeDead(const std::string& at, uint64_t space) {
    std::error_code error;
    for (fs::directory_iterator it(at, error), end; !error && it != end; it.increment(error)) {
        uint64_t ofSpace = 0;
        int process = 0;
        const std::string name = it->path().filename().string();
        if (std::sscanf(name.c_str(), ".run-%16" SCNx64 "-%d-", &ofSpace, &process) != 2) continue;
        std::error_code ignored;
        if (ofSpace == space && process > 0 && isDead(process)) fs::remove_all(it->path(), ignored);
    }
}

}  // namespace

Status Scratch::make(const std::string& at) {
    std::error_code error;
    fs::create_directories(at, error);
    if (error) return Failure(at, "cannot be made: " + error.message());
    const uint64_t space = spaceOfProcesses();
    if (space != 0) removeDead(at, space);
    char name[64];
    std::snprintf(name, sizeof name, "/.run-%016" PRIx64 "-%d-XXXXXX", space, int(::getpid()));
    std::string path = at + name;
    if (!::mkdtemp(path.data())) return Failure(at, std::string("cannot be written into: ") + std::strerror(errno));
    path_ = path;
    return Done{};
}

Scratch::~Scratch() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace espalier::folder
