#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>

#include "tools/scene/json_tree.hpp"

namespace espalier::scene {

// False: `error` is "file: what is wrong", or "file:line:column: what is wrong".
bool readJsonFile(const std::string& path, Json& out, std::string& error);

// Takes values out of a file's JSON, and notes all that isn't what it is to be. What isn't there, or has a mistake,
// leaves `out` as it is.
class JsonChecks {
  public:
    explicit JsonChecks(std::string path) : path_(std::move(path)) {}

    // A line each, "file:line:column: what is wrong", the first ten and how many more; empty: all was well so far.
    std::string errors() const;
    void fail(const Json& at, const std::string& message);
    std::string place(const Json& at) const;

    // `what` begins the message; where it has none of the keys at all that is told once. False: it isn't one, and has
    // no members.
    bool isObject(const Json& json, const std::string& what, std::initializer_list<const char*> keys);
    // Null, with a mistake: there is none.
    const Json* need(const Json& json, const char* name);
    // Null, without one: there is none.
    const Json* list(const Json& json, const char* name);
    // A file's name, seen from this file's folder; empty after a mistake.
    std::string file(const Json& json);

    void flag(const Json& json, const char* name, bool& out);
    void number(const Json& json, const char* name, float low, float high, float& out);
    void whole(const Json& json, const char* name, uint32_t& out, uint32_t most = 1000000);  // up to 2^24
    // A place in a list of so many, from 0.
    void index(const Json& json, const char* name, size_t count, int& out);
    void word(const Json& json, const char* name, std::string& out);  // not optional
    // A text as a list of its lines. True: there is one.
    bool lines(const Json& json, const char* name, std::optional<std::string>& out);
    // True: there is one.
    bool vector(const Json& json, const char* name, std::optional<std::array<float, 3>>& out);
    // False: `json` isn't a list of so many finite numbers; that is the caller's to tell.
    template <size_t N>
    static bool numbers(const Json& json, std::array<float, N>& out) {
        if (json.kind != Json::Kind::list || json.items.size() != N) return false;
        for (size_t i = 0; i < N; ++i) {
            if (json.items[i].kind != Json::Kind::number || !std::isfinite(float(json.items[i].number))) return false;
            out[i] = float(json.items[i].number);
        }
        return true;
    }

  private:
    std::string path_, errors_;
    size_t failed_ = 0;
};

}  // namespace espalier::scene
