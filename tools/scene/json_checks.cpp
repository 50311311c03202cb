// Enters: a file's JSON. Leaves: its values, and of those that aren't what they are to be, what is wrong and where.
#include "tools/scene/json_checks.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

constexpr size_t kMostTold = 10;

}  // namespace

bool readJsonFile(const std::string& path, Json& out, std::string& error) {
    std::string text;
    if (!readText(path, text, error)) return false;
    if (readJson(text, out, error)) return true;
    error = path + ":" + error;
    return false;
}

std::string JsonChecks::errors() const {
    if (failed_ <= kMostTold) return errors_;
    return errors_ + "\n" + path_ + ": further mistakes: " + std::to_string(failed_ - kMostTold);
}

void JsonChecks::fail(const Json& at, const std::string& message) {
    if (++failed_ <= kMostTold) errors_ += (errors_.empty() ? "" : "\n") + place(at) + ": " + message;
}

void JsonChecks::index(const Json& json, const char* name, size_t count, int& out) {
    const Json* found = json.find(name);
    if (!found) return;
    const double number = found->kind == Json::Kind::number ? found->number : -1;
    if (number >= 0 && number < double(count) && number == std::floor(number))
        out = int(number);
    else
        fail(*found, std::string("'") + name + "' must be a place in the list of " + name + "s, from 0");
}

void JsonChecks::whole(const Json& json, const char* name, uint32_t& out, uint32_t most) {
    float value = float(out);
    number(json, name, 0, float(most), value);
    if (value == std::floor(value))
        out = uint32_t(value);
    else
        fail(*json.find(name), std::string("'") + name + "' must be a whole number");
}

void JsonChecks::word(const Json& json, const char* name, std::string& out) {
    const Json* found = need(json, name);
    if (!found) return;
    if (found->kind == Json::Kind::text)
        out = found->text;
    else
        fail(*found, std::string("'") + name + "' must be a word");
}

bool JsonChecks::lines(const Json& json, const char* name, std::optional<std::string>& out) {
    const Json* found = json.find(name);
    if (!found) return false;
    std::string text;
    bool good = found->kind == Json::Kind::list;
    for (const Json& line : found->items) {
        good = good && line.kind == Json::Kind::text;
        text += line.text + "\n";
    }
    if (good)
        out = text;
    else
        fail(*found, std::string("'") + name + "' must be a list of lines");
    return good;
}

void JsonChecks::flag(const Json& json, const char* name, bool& out) {
    const Json* found = json.find(name);
    if (!found) return;
    if (found->kind == Json::Kind::flag)
        out = found->flag;
    else
        fail(*found, std::string("'") + name + "' must be true or false");
}

std::string JsonChecks::place(const Json& at) const {
    return path_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column);
}

bool JsonChecks::isObject(const Json& json, const std::string& what, std::initializer_list<const char*> keys) {
    if (json.kind != Json::Kind::object) {
        fail(json, what + " must be an object");
        return false;
    }
    std::vector<const Json::Member*> unknown;
    for (const auto& member : json.members)
        if (std::ranges::find(keys, member.name) == keys.end()) unknown.push_back(&member);
    if (unknown.size() > 1 && unknown.size() == json.members.size()) {  // another kind of file
        fail(json, what + " has none of the keys that are here, such as '" + unknown[0]->name + "'");
        return true;
    }
    for (const auto* member : unknown) fail(member->value, what + " has no key '" + member->name + "'");
    return true;
}

const Json* JsonChecks::need(const Json& json, const char* name) {
    const Json* found = json.find(name);
    if (!found) fail(json, std::string("'") + name + "' is missing");
    return found;
}

std::string JsonChecks::file(const Json& json) {
    if (json.kind != Json::Kind::text || json.text.empty()) {
        fail(json, "a file's name must stand here");
        return {};
    }
    // A project that was moved, or lay in a folder that is gone by now, must not matter to what it names.
    return (std::filesystem::path(path_).parent_path() / json.text).lexically_normal().string();
}

void JsonChecks::number(const Json& json, const char* name, float low, float high, float& out) {
    const Json* found = json.find(name);
    if (!found) return;
    if (found->kind != Json::Kind::number || !(found->number >= low) || !(found->number <= high))
        fail(*found, std::string("'") + name + "' must be a number from " + std::to_string(low) + " to " +
                         std::to_string(high));
    else
        out = float(found->number);
}

const Json* JsonChecks::list(const Json& json, const char* name) {
    const Json* found = json.find(name);
    if (found && found->kind != Json::Kind::list) fail(*found, std::string("'") + name + "' must be a list");
    return found;
}

bool JsonChecks::vector(const Json& json, const char* name, std::optional<std::array<float, 3>>& out) {
    const Json* found = json.find(name);
    if (!found) return false;
    std::array<float, 3> value{};
    if (!numbers(*found, value)) {
        fail(*found, std::string("'") + name + "' must be three numbers");
        return false;
    }
    out = value;
    return true;
}

}  // namespace espalier::scene
