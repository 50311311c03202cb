#include <doctest/doctest.h>

#include <set>
#include <string>

#include "runtime/plugin/id_table.hpp"

using namespace espalier;

TEST_CASE("an id finds its object until it is erased, and nothing after") {
    IdTable<std::string, 20> table(0);
    CHECK(table.find(0) == nullptr);
    CHECK(table.find(0xFFFFFFFFu) == nullptr);
    CHECK(!table.erase(0));
    const uint32_t a = table.insert("a"), b = table.insert("b");
    CHECK(a != 0);
    CHECK(b != 0);
    REQUIRE(table.find(a));
    CHECK(*table.find(a) == "a");
    CHECK(table.erase(a));
    CHECK(!table.erase(a));
    CHECK(table.find(a) == nullptr);
    const uint32_t c = table.insert("c");  // in a's place
    CHECK(c != a);
    CHECK(table.find(a) == nullptr);
    CHECK(*table.find(b) == "b");
    CHECK(*table.find(c) == "c");
    CHECK(table.size() == 2);
}

TEST_CASE("an object stays where it is until it is erased, however many come and go") {
    IdTable<std::string, 20> table(0);
    const uint32_t id = table.insert("short");
    const char* text = table.find(id)->c_str();
    for (int round = 0; round < 100; ++round) {
        const uint32_t gone = table.insert("gone");
        table.insert("stays");
        REQUIRE(table.erase(gone));
    }
    CHECK(table.find(id)->c_str() == text);
    CHECK(std::string(text) == "short");
}

TEST_CASE("no id ever comes twice, even when a place has used up its generations") {
    using Table = IdTable<int, 16>;
    Table table(63);
    std::set<uint32_t> seen;
    for (uint32_t i = 0; i < 3 * Table::kLastGeneration; ++i) {
        const uint32_t id = table.insert(int(i));
        REQUIRE(id != 0);
        REQUIRE(seen.insert(id).second);
        REQUIRE(table.erase(id));
    }
    CHECK(table.size() == 0);
}
