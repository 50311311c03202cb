// In: a feature's properties. Out: its tags by OpenStreetMap's names.
#include "runtime/roof/footprint_properties.hpp"

#include <algorithm>

#include "runtime/roof/footprint_values.hpp"

namespace espalier {

namespace {

using nlohmann::json;

constexpr size_t kLongestTable = 1 << 16;  // bytes of a text that holds tags

// Names of the same thing in other schemas, Overture's, and those that OpenStreetMap has given up.
constexpr std::pair<const char*, const char*> kSynonyms[] = {
    {"building:levels", "num_floors"},
    {"building:min_level", "min_floor"},
    {"building:levels:underground", "num_floors_underground"},
    {"height", "building:height"},
    {"height", "est_height"},
    {"min_height", "building:min_height"},
    {"roof:colour", "roof:color"},
    {"roof:colour", "roof_color"},
    {"roof:direction", "roof:slope:direction"},
};

// Text of the form "key"=>"value", "key"=>"value"; a backslash makes the next character plain.
json parseHstore(const std::string& text) {
    json tags = json::object();
    size_t at = 0;
    const auto word = [&]() -> std::optional<std::string> {
        at = text.find('"', at);
        if (at == std::string::npos) return {};
        std::string out;
        for (++at; at < text.size() && text[at] != '"'; ++at) {
            if (text[at] == '\\' && at + 1 < text.size()) ++at;
            out += text[at];
        }
        if (at == text.size()) return {};
        ++at;
        return out;
    };
    while (std::optional<std::string> key = word()) {
        const size_t arrow = text.find_first_not_of(' ', at);
        if (arrow == std::string::npos || text.compare(arrow, 2, "=>") != 0) break;
        at = arrow + 2;
        std::optional<std::string> value = word();
        if (!value) break;
        tags.emplace(std::move(*key), std::move(*value));
    }
    return tags;
}

json parseTable(const std::string& text) {
    if (text.size() > kLongestTable) return {};
    if (text.find("=>") != std::string::npos) return parseHstore(text);
    json tags = json::parse(text, nullptr, false);
    return tags.is_object() ? tags : json();
}

const json* valueIn(const json& source, const std::string& key) {
    const auto found = source.find(key);
    if (found == source.end() || found->is_null()) return nullptr;
    if (found->is_string() && found->get_ref<const std::string&>().empty()) return nullptr;
    return &*found;
}

}  // namespace

FeatureTags::FeatureTags(const json& properties) {
    if (!properties.is_object()) return;
    sources_.push_back(&properties);
    for (const char* name : {"tags", "other_tags", "all_tags"}) {
        const auto nested = properties.find(name);
        if (nested == properties.end()) continue;
        if (nested->is_object()) sources_.push_back(&*nested);
        if (!nested->is_string()) continue;
        json table = parseTable(nested->get_ref<const std::string&>());
        if (!table.is_object()) continue;
        parsed_.push_back(std::make_unique<json>(std::move(table)));
        sources_.push_back(parsed_.back().get());
    }
}

const json* FeatureTags::find(const std::string& key) const {
    std::string flat = key;
    std::replace(flat.begin(), flat.end(), ':', '_');
    for (const json* source : sources_) {
        if (const json* value = valueIn(*source, key)) return value;
        if (flat != key)
            if (const json* value = valueIn(*source, flat)) return value;
        for (const auto& [name, synonym] : kSynonyms)
            if (key == name)
                if (const json* value = valueIn(*source, synonym)) return value;
    }
    return nullptr;
}

std::string FeatureTags::text(const std::string& key) const {
    const json* value = find(key);
    if (!value || !value->is_string()) return {};
    const std::string& text = value->get_ref<const std::string&>();
    return text.size() > kLongestValue ? std::string() : lowered(text);
}

bool FeatureTags::says(const std::string& key) const {
    const json* value = find(key);
    return value && readYes(*value);
}

std::string FeatureTags::spelled(std::string key) {
    if (key.rfind("roof_", 0) == 0) std::replace(key.begin(), key.end(), '_', ':');
    return key;
}

}  // namespace espalier
