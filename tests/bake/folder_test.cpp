// espalier-bake over folders, as a user runs it: the cache, shards, failures among successes, interruption, a full
// disk.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "runtime/core/file.hpp"
#include "runtime/surface/surface.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace espalier;
using namespace espalier::test;
namespace fs = std::filesystem;

namespace {

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// A square in OBJ with room around its chart, `lift` above the ground.
std::string square(int lift) {
    std::string z = std::to_string(lift);
    return "v 0 0 " + z + "\nv 1 0 " + z + "\nv 1 1 " + z + "\nv 0 1 " + z +
           "\nvt 0.2 0.2\nvt 0.8 0.2\nvt 0.8 0.8\nvt 0.2 0.8\nf 1/1 2/2 3/3 4/4\n";
}

// A wavy sheet of 1,152 triangles: some 40 KB when it is baked.
std::string sheet(int lift) {
    std::string text;
    constexpr int n = 24;
    for (int i = 0; i < (n + 1) * (n + 1); ++i) {
        const double x = double(i % (n + 1)) / n, y = double(i / (n + 1)) / n;
        text += "v " + std::to_string(x) + " " + std::to_string(y) + " " +
                std::to_string(lift + 0.02 * std::sin(17 * x) * std::cos(21 * y)) + "\nvt " +
                std::to_string(0.2 + 0.6 * x) + " " + std::to_string(0.2 + 0.6 * y) + "\n";
    }
    for (int i = 0; i < n * n; ++i) {
        text += "f";
        for (int step : {0, 1, n + 2, n + 1}) {
            const std::string v = std::to_string(i / n * (n + 1) + i % n + step + 1);
            text += " " + v + "/" + v;
        }
        text += "\n";
    }
    return text;
}

struct Bench {
    ScratchFolder folder;
    std::string said;  // of the last run, both streams

    Bench() {
        for (int i = 0; i < 4; ++i) write("in/square" + std::to_string(i) + ".obj", square(i));
        write("in/deeper/square0.obj", "mtllib paint.mtl\nusemtl red\n" + square(7));
        write("in/deeper/paint.mtl", "newmtl red\nKd 1 0 0\n");
        write("in/broken.obj", "v 0 0 0\nf 1 2 3\n");
        write("in/.hidden/x.obj", "f");
    }
    std::string path(const std::string& name) const { return folder.file(name); }
    void write(const std::string& name, const std::string& text) const {
        REQUIRE(writeFile(path(name), std::string_view(text)));
    }
    // The exit code.
    int run(const std::string& arguments, const std::string& before = "") {
        std::string command = "cd '" + folder.path.string() + "' && " + before + " '" ESPALIER_BAKE_PROGRAM "' in " +
                              arguments + " --resolution 64 > log.txt 2>&1 </dev/null";
        int status = std::system(command.c_str());
        said = readTextFile(path("log.txt")) ? *readTextFile(path("log.txt")) : "";
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    // Every file below a folder but the cache's, with its bytes.
    std::map<std::string, std::string> files(const std::string& name) const {
        std::map<std::string, std::string> out;
        for (const auto& entry : fs::recursive_directory_iterator(path(name))) {
            std::string relative = entry.path().lexically_relative(path(name)).string();
            if (entry.is_regular_file() && !has(relative, ".cache")) out[relative] = *readTextFile(entry.path());
        }
        return out;
    }
    size_t partials(const std::string& name) const {
        size_t n = 0;
        for (const auto& entry : fs::recursive_directory_iterator(path(name)))
            n += has(entry.path().filename(), ".partial") || has(entry.path().filename(), ".run-");
        return n;
    }
    size_t times(const std::string& word) const {
        size_t n = 0;
        for (size_t at = said.find(word); at != said.npos; at = said.find(word, at + 1)) ++n;
        return n;
    }
};

}  // namespace

TEST_CASE("a folder is baked with a row a model; what fails stops nothing else; what is unchanged is not baked again") {
    Bench b;
    CHECK(b.run("-o out --jobs 2") == 1);
    CAPTURE(b.said);
    auto files = b.files("out");
    CHECK(files.size() == 7);
    CHECK(files.count("deeper/square0.surface.glb") == 1);
    auto report = nlohmann::json::parse(files["report.json"], nullptr, false);
    REQUIRE(report.is_object());
    REQUIRE(report["models"].size() == 6);
    CHECK(report["baked"] == 5);
    CHECK(report["refused"] == 1);
    CHECK(report["models"][0]["model"] == "broken.obj");
    CHECK(has(report["models"][0]["message"], "broken.obj:2: vertex 2"));
    CHECK(report["models"][1]["report"]["triangles"] == 2);
    CHECK(has(files["report.txt"], "6 models: 5 baked, 1 refused"));
    CHECK(has(files["report.txt"], "square3.obj"));
    CHECK(b.times(" already ") == 0);
    CHECK(b.partials("out") == 0);

    CHECK(b.run("-o out") == 1);
    CHECK(b.times(" already ") == 6);
    CHECK(b.files("out") == files);

    // A changed model, a changed file that a model refers to, one that was missing, other options, a lost surface.
    b.write("in/square1.obj", square(9));
    b.write("in/deeper/paint.mtl", "newmtl red\nKd 0 1 0\n");
    fs::remove(b.path("out/square2.surface.glb"));
    CHECK(b.run("-o out") == 1);
    CHECK(b.times(" already ") == 4);
    CHECK(b.files("out").size() == 7);
    CHECK(b.files("out")["square2.surface.glb"] == files["square2.surface.glb"]);
    CHECK(b.files("out")["square1.surface.glb"] != files["square1.surface.glb"]);
    fs::remove(b.path("in/deeper/paint.mtl"));
    CHECK(b.run("-o out") == 1);
    CHECK(b.times(" already ") == 5);
    CHECK(b.run("-o out --levels 1 --uv-set 0") == 1);
    CHECK(b.times(" already ") == 0);

    // A damaged entry is baked anew.
    for (const auto& entry : fs::directory_iterator(b.path("out/.cache")))
        if (entry.path().extension() == ".glb") fs::resize_file(entry.path(), 100);
    CHECK(b.run("-o out") == 1);
    CHECK(b.times(" already ") == 1);
    b.write("in/broken.obj", square(5));
    CHECK(b.run("-o out -q") == 0);
    CHECK(b.said.empty());
}

TEST_CASE("a model whose name can't be noted is baked each time") {
    Bench b;
    b.write("in/two\nlines.obj", square(3));
    for (int i = 0; i < 2; ++i) {
        CHECK(b.run("-o out") == 1);  // broken.obj
        CAPTURE(b.said);
        CHECK(has(b.said, "6 of 7 models baked"));
        CHECK(b.times(" already ") == (i == 0 ? 0 : 6));
        CHECK(readSurface(b.path("out/two\nlines.surface.glb")));
        fs::remove(b.path("out/two\nlines.surface.glb"));
    }
}

TEST_CASE("shards make byte for byte what one run makes") {
    Bench b;
    CHECK(b.run("-o whole") == 1);
    CHECK(b.run("-o parts --shard 2/3") == 0);
    CHECK(b.run("-o parts --shard 1/3 --jobs 1") == 1);
    CHECK(b.run("-o parts --shard 3/3") == 0);
    CHECK(b.files("parts").count("report.json") == 0);
    CHECK(b.run("-o parts") == 1);
    CHECK(b.times(" already ") == 6);
    CHECK(b.files("parts") == b.files("whole"));
    for (const char* bad : {"0/3", "4/3", "1/0", "x", "1/3x"}) CHECK(b.run(std::string("-o x --shard ") + bad) == 2);
    CHECK(!fs::exists(b.path("x")));
}

TEST_CASE("a disk without room is a message and a code, and leaves no halves") {
    Bench b;
    for (int i = 0; i < 4; ++i) b.write("in/square" + std::to_string(i) + ".obj", sheet(i));
    b.write("in/deeper/square0.obj", sheet(7));
    // Eight blocks of 1 KiB: less than a surface takes, more than a log.
    CHECK(b.run("-o out", "ulimit -f 8;") == 1);
    CAPTURE(b.said);
    CHECK(has(b.said, "failed"));
    CHECK(has(b.said, "square1.obj"));
    CHECK(has(b.said, "File too large"));
    CHECK(b.partials("out") == 0);
    for (const auto& [name, bytes] : b.files("out")) CHECK(!has(name, ".glb"));
    // The machine's faults are not remembered.
    CHECK(b.run("-o out") == 1);
    CHECK(has(b.said, "5 of 6 models baked"));
    CHECK(b.run("-o /proc/nowhere") == 1);
    CHECK(has(b.said, "/proc/nowhere"));
}

namespace {

// A run on its own, which is told to end; told: as it begins.
pid_t start(const Bench& b, bool told = false) {
    const pid_t child = ::fork();
    if (child == 0) {
        int quiet = ::open("/dev/null", O_RDWR);
        ::dup2(quiet, 1);
        ::dup2(quiet, 2);
        ::signal(SIGHUP, SIG_DFL);
        sigset_t waits;
        sigemptyset(&waits);
        sigaddset(&waits, SIGINT);
        if (told) ::sigprocmask(SIG_BLOCK, &waits, nullptr), ::raise(SIGINT);
        ::execl(ESPALIER_BAKE_PROGRAM, "espalier-bake", b.path("in").c_str(), "-o", b.path("out").c_str(), "--jobs",
                "2", "--resolution", "64", nullptr);
        ::_exit(99);
    }
    REQUIRE(child > 0);
    return child;
}

int endOf(pid_t child) {
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace

TEST_CASE("an interrupted run ends at once, with whole files only, and can be gone on with") {
    for (int signal : {SIGINT, SIGTERM, SIGHUP, SIGKILL}) {
        CAPTURE(signal);
        Bench b;
        for (int i = 0; i < 24; ++i) b.write("in/more" + std::to_string(i) + ".obj", square(100 + i));
        const pid_t child = start(b);
        // As soon as some are done.
        for (int i = 0; i < 2000 && !fs::exists(b.path("out/deeper/square0.surface.glb")); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        ::kill(child, signal);
        CHECK(endOf(child) == (signal == SIGKILL ? -SIGKILL : 130));
        CHECK((b.partials("out") > 0) == (signal == SIGKILL));
        CHECK(!fs::exists(b.path("out/report.json")));
        for (const auto& [name, bytes] : b.files("out")) CHECK(readSurface(b.path("out/" + name)));
        if (signal != SIGKILL) continue;
        CHECK(b.run("-o out") == 1);
        CHECK(b.partials("out") == 0);
    }
}

TEST_CASE("a run that finds all baked can be interrupted, too") {
    Bench b;
    CHECK(b.run("-o out") == 1);
    CHECK(endOf(start(b, true)) == 130);
    CHECK(b.partials("out") == 0);
}
