// Files device-KEY.passed and, while a check runs, device-KEY.checking in a folder; KEY is a hash of all that a check
// depends on.
#include "runtime/plugin/checked_devices.hpp"

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "runtime/core/file.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/platform.hpp"
#include "runtime/gpu/device.hpp"
#include "runtime/plugin/self_check.hpp"
#include "shaders/shader_table.hpp"

namespace espalier {
namespace {

namespace fs = std::filesystem;

uint64_t keyOf(const Device& device) {
    static const uint64_t kernels = [] {
        uint64_t hash = 0;
        for (const Shader& shader : allShaders()) hash = hashValues(shader.code, hashText(shader.name, hash));
        return hash;
    }();
    const uint64_t parts[] = {device.info().identity, kernels};
    return hashValues<uint64_t>(parts);
}

// Devices that have passed in this process.
struct Passed {
    std::mutex mutex;
    std::set<uint64_t> keys;
};
Passed& passed() {
    static Passed known;
    return known;
}

fs::path fileOf(const fs::path& folder, uint64_t key, const char* ending) {
    char name[40];
    std::snprintf(name, sizeof name, "device-%016llx.%s", static_cast<unsigned long long>(key), ending);
    return folder / name;
}

// The file that stands while a check runs, with the process that runs it.
class RunningMark {
  public:
    RunningMark(Device& device, fs::path file) : file_(std::move(file)) {
        std::error_code ignored;
        if (fs::exists(file_, ignored) && !runs())
            device.log()(Severity::warning,
                         device.info().name + " (" + device.info().driver +
                             "): the last self-check on this device didn't come to its end, as where a "
                             "driver crashes; it is run again");
        (void)writeFile(file_, std::to_string(platform::processNumber()));
    }
    ~RunningMark() {
        std::error_code ignored;
        fs::remove(file_, ignored);
    }

  private:
    bool runs() const {
        const Result<std::string> text = readTextFile(file_);
        return text && platform::processRuns(std::strtoull(text.value().c_str(), nullptr, 10));
    }
    fs::path file_;
};

}  // namespace

void forgetCheckedDevices() {
    const std::lock_guard lock(passed().mutex);
    passed().keys.clear();
}

Status checkDevice(Device& device, const fs::path& folder) {
    const uint64_t key = keyOf(device);
    const std::lock_guard lock(passed().mutex);
    if (passed().keys.contains(key)) return Done{};
    std::error_code ignored;
    const fs::path kept = fileOf(folder, key, "passed");
    if (folder.empty() || !fs::exists(kept, ignored)) {
        std::optional<RunningMark> mark;
        if (!folder.empty()) mark.emplace(device, fileOf(folder, key, "checking"));
        if (Status ran = runSelfCheck(device); !ran) return ran;
        if (!folder.empty()) (void)writeFile(kept, device.info().name + "\n" + device.info().driver + "\n");
    }
    passed().keys.insert(key);
    return Done{};
}

}  // namespace espalier
