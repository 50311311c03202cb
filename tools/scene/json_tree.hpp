#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace espalier::scene {

// A JSON value that knows where it stands in its text, for messages. line and column count from 1.
struct Json {
    enum class Kind { null, flag, number, text, list, object };
    Kind kind = Kind::null;
    int line = 1, column = 1;
    bool flag = false;
    double number = 0;
    std::string text;
    std::vector<Json> items;
    struct Member;
    std::vector<Member> members;

    const Json* find(std::string_view name) const;
};
struct Json::Member {
    std::string name;
    Json value;
};

// False: `error` is "line:column: what is wrong". Names that come twice in an object are an error.
bool readJson(std::string_view text, Json& out, std::string& error);

}  // namespace espalier::scene
