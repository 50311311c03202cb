// Files, hashes and jobs.
#include <doctest/doctest.h>

#include <atomic>
#include <filesystem>
#include <numeric>
#include <set>
#include <vector>

#include <unistd.h>

#include "runtime/core/file.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/jobs.hpp"

using namespace espalier;
namespace fs = std::filesystem;

namespace {

// A folder of our own that goes away again.
struct Scratch {
    fs::path path = fs::temp_directory_path() / ("espalier_core_test_" + std::to_string(::getpid()));
    Scratch() { fs::create_directories(path); }
    ~Scratch() { fs::remove_all(path); }
};

size_t filesIn(const fs::path& folder) {
    return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("files that cannot be read or written say which and why, and leave nothing") {
    Scratch scratch;
    Result<std::string> none = readTextFile(scratch.path / "none.txt");
    REQUIRE_FALSE(none);
    CHECK(none.failure().text().find("none.txt: cannot be opened") != std::string::npos);
    CHECK_FALSE(readFile(scratch.path));
    CHECK_FALSE(readFile("/dev/zero"));
    CHECK_FALSE(writeFile(scratch.path, "a folder"));
    REQUIRE(writeFile(scratch.path / "file", "x"));
    CHECK_FALSE(writeFile(scratch.path / "file" / "below.txt", "y"));
    CHECK_FALSE(writeFile("/proc/nowhere/file.txt", "y"));
    CHECK(filesIn(scratch.path) == 1);
    Status full = writeFile("/dev/full", std::string(10, 'x'));  // a device stays one
    REQUIRE_FALSE(full);
    CHECK(full.failure().text().find("/dev/full") != std::string::npos);
    CHECK(fs::is_character_file("/dev/full"));
    REQUIRE(writeFile("/dev/null", "x"));
    CHECK(fs::is_character_file("/dev/null"));
}

TEST_CASE("files are replaced whole, folders are made") {
    Scratch scratch;
    const fs::path path = scratch.path / "a" / "b" / "text.txt";
    REQUIRE(writeFile(path, std::string(100000, 'x')));
    REQUIRE(writeFile(path, "short"));
    CHECK(readTextFile(path).value() == "short");
    REQUIRE(writeFile(path, ""));
    CHECK(readFile(path).value().empty());
    const fs::path link = scratch.path / "link.txt";
    fs::create_symlink("a/b/text.txt", link);
    REQUIRE(writeFile(link, "by a link"));
    CHECK(fs::is_symlink(link));
    CHECK(readTextFile(path).value() == "by a link");
    CHECK(filesIn(scratch.path) == 2);
    CHECK(filesIn(path.parent_path()) == 1);
    CHECK_FALSE(readTextFile("/proc/self/status").value().empty());  // has no size to trust
}

TEST_CASE("hashes differ by a bit, a length and a seed, and never change") {
    std::set<uint64_t> seen;
    for (size_t length = 0; length < 40; ++length) {
        std::string text(length, '\0');
        seen.insert(hashText(text));
        for (size_t i = 0; i < length * 8; ++i) {
            text[i / 8] ^= char(1 << i % 8);
            seen.insert(hashText(text));
            text[i / 8] ^= char(1 << i % 8);
        }
    }
    CHECK(seen.size() == 40 + 8 * 39 * 40 / 2);
    CHECK(hashText("ivy", 1) != hashText("ivy", 2));
    CHECK(hashText("ivy") == 0x3918ca056b837d8bull);
}

TEST_CASE("parallelFor visits everything once") {
    for (size_t count : {0u, 1u, 63u, 64u, 65u, 10000u})
        for (unsigned threads : {0u, 1u, 3u, 16u}) {
            std::vector<std::atomic<int>> visits(count);
            parallelFor(
                count, 64,
                [&](size_t begin, size_t end) {
                    CHECK(end - begin <= 64);
                    for (size_t i = begin; i < end; ++i) ++visits[i];
                },
                threads);
            CHECK(std::accumulate(visits.begin(), visits.end(), 0) == int(count));
            bool once = true;
            for (const auto& v : visits) once = once && v == 1;
            CHECK(once);
        }
}

TEST_CASE("a crew goes from range to range") {
    for (unsigned threads : {1u, 2u, 5u}) {
        Crew crew(threads);
        // Each range reads what the one before has written, by whichever thread.
        std::vector<uint32_t> values(1000, 0), before;
        for (uint32_t range = 0; range < 200; ++range) {
            before = values;
            const size_t count = range % 7 == 0 ? 3 : values.size();
            crew.overRange(count, 16, [&](size_t begin, size_t end) {
                for (size_t i = begin; i < end; ++i) values[i] += 1 + before[count - 1 - i];
            });
            for (size_t i = 0; i < count; ++i) before[i] = before[i] + 1;
            std::vector<uint32_t> wanted = before;
            for (size_t i = 0; i < count; ++i) wanted[i] = before[i] + before[count - 1 - i] - 1;
            REQUIRE(values == wanted);
        }
    }
}

TEST_CASE("what a body throws reaches the caller when all threads are done, and the crew goes on") {
    for (unsigned threads : {1u, 2u, 5u}) {
        Crew crew(threads);
        for (size_t count : {16u, 1000u})
            for (size_t bad : {size_t(0), count / 2, count - 1}) {
                std::atomic<int> within = 0;
                const auto body = [&](size_t begin, size_t end) {
                    ++within;
                    std::this_thread::yield();
                    --within;
                    if (begin <= bad && bad < end) throw std::bad_alloc();
                };
                CHECK_THROWS_AS(crew.overRange(count, 16, body), std::bad_alloc);
                CHECK(within == 0);
                std::atomic<size_t> visits = 0;
                crew.overRange(count, 16, [&](size_t begin, size_t end) { visits += end - begin; });
                CHECK(visits == count);
            }
    }
    // All of them at once: one exception is told.
    CHECK_THROWS_AS(parallelFor(
                        64, 1, [](size_t, size_t) { throw std::bad_alloc(); }, 4),
                    std::bad_alloc);
}
