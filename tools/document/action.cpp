// Actions -> lines of JSON and back, through the fields that each record names.
#include "tools/document/action.hpp"

#include "tools/document/fields.hpp"

namespace espalier::document {
namespace {

template <size_t I = 0>
bool make(const std::string& name, Action& out) {
    if constexpr (I < std::variant_size_v<Action>) {
        if (name.empty() || name != std::variant_alternative_t<I, Action>::kName) return make<I + 1>(name, out);
        out.emplace<I>();
        return true;
    }
    return false;
}

bool whole(const scene::Json& json, uint32_t& out) {
    if (json.kind != scene::Json::Kind::number || json.number < 0 || json.number > 4294967295.0 ||
        json.number != std::floor(json.number))
        return false;
    out = uint32_t(json.number);
    return true;
}

}  // namespace

std::string layerOf(const Action& action) {
    const auto layer = []<class A>(const A& a) -> std::string {
        constexpr bool changes = std::is_same_v<A, StrokeBegin> || std::is_same_v<A, FillLayer> ||
                                 std::is_same_v<A, LoadLayer> || std::is_same_v<A, LoadTownLayer>;
        if constexpr (changes) return a.layer;
        return {};
    };
    return std::visit(layer, action);
}

std::string toJson(const RunLine& line) {
    nlohmann::ordered_json json{{"frame", line.frame}};
    if (line.gesture) json["gesture"] = line.gesture;
    Action action = line.action;
    std::visit(
        [&](auto& a) {
            nlohmann::ordered_json fields = nlohmann::ordered_json::object();
            a.fields(FieldWriter(fields));
            json[a.kName] = std::move(fields);
        },
        action);
    return scene::textOf(json);
}

bool fromJson(const std::string& text, RunLine& out, std::string& error) {
    out = RunLine{};
    scene::Json json;
    if (!scene::readJson(text, json, error)) return false;
    const auto fail = [&](const scene::Json& at, const std::string& message) {
        error = std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + message;
        return false;
    };
    if (json.kind != scene::Json::Kind::object) return fail(json, "a line of a run must be an object");
    const scene::Json* frame = json.find("frame");
    if (!frame || !whole(*frame, out.frame)) return fail(json, "'frame' must be a whole number");
    if (const scene::Json* gesture = json.find("gesture"); gesture && !whole(*gesture, out.gesture))
        return fail(*gesture, "'gesture' must be a whole number");
    bool found = false;
    for (const auto& member : json.members) {
        const std::string& name = member.name;
        const scene::Json& fields = member.value;
        if (name == "frame" || name == "gesture") continue;
        if (found) return fail(fields, "one action a line");
        if (!make(name, out.action)) return fail(fields, "there is no action '" + name + "'");
        if (fields.kind != scene::Json::Kind::object) return fail(fields, "'" + name + "' must be an object");
        std::visit(
            [&](auto& action) {
                FieldReader reader(fields, error);
                action.fields(reader);
                reader.end();
            },
            out.action);
        if (!error.empty()) return false;
        found = true;
    }
    return found || fail(json, "there is no action");
}

}  // namespace espalier::document
