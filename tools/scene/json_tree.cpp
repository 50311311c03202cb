// JSON text -> a tree with places. The library's event reader is fed through an iterator that counts what it has
// read, so that each event knows how far the text has been consumed.
#include "tools/scene/json_tree.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <unordered_set>

namespace espalier::scene {
namespace {

struct CountingIterator {
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    const char* at = nullptr;
    size_t* read = nullptr;
    reference operator*() const { return *at; }
    CountingIterator& operator++() {
        ++at;
        if (read) ++*read;
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const CountingIterator& other) const { return at == other.at; }
    bool operator!=(const CountingIterator& other) const { return at != other.at; }
};

std::pair<int, int> placeOf(std::string_view text, size_t offset) {
    offset = std::min(offset, text.size());
    const std::string_view before = text.substr(0, offset);
    const int line = 1 + int(std::count(before.begin(), before.end(), '\n'));
    const size_t lineStart = before.rfind('\n');
    return {line, int(offset - (lineStart == std::string_view::npos ? 0 : lineStart + 1)) + 1};
}

class Builder : public nlohmann::json_sax<nlohmann::json> {
  public:
    Builder(std::string_view text, const size_t& read, Json& root) : text_(text), read_(read), root_(root) {}

    bool null() override { return put(Json::Kind::null) != nullptr; }
    bool boolean(bool value) override {
        Json* json = put(Json::Kind::flag);
        if (json) json->flag = value;
        return json;
    }
    bool number_integer(number_integer_t value) override { return number(double(value)); }
    bool number_unsigned(number_unsigned_t value) override { return number(double(value)); }
    bool number_float(number_float_t value, const string_t&) override { return number(value); }
    bool string(string_t& value) override {
        if (!isWhole(value)) return false;
        Json* json = put(Json::Kind::text);
        if (json) json->text = value;
        return json;
    }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(put(Json::Kind::object)); }
    bool start_array(std::size_t) override { return open(put(Json::Kind::list)); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
        if (!isWhole(name)) return false;
        if (!keys_.back().insert(name).second) return fail(read_, "'" + name + "' comes twice");
        key_ = name;
        return true;
    }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& e) override {
        // The library's message begins with its own numbers; what follows the last ": " of the head is the cause.
        std::string what = e.what();
        const size_t cause = what.find("syntax error");
        return fail(position ? position - 1 : 0, cause == std::string::npos ? what : what.substr(cause));
    }

    std::string error;

  private:
    static constexpr size_t kMaxDepth = 64;

    // Names of files and layers end at a NUL wherever C reads them.
    bool isWhole(const string_t& text) {
        return text.find('\0') == string_t::npos || fail(read_, "a text holds a NUL character");
    }
    bool number(double value) {
        Json* json = put(Json::Kind::number);
        if (json) json->number = value;
        return json;
    }
    Json* put(Json::Kind kind) {
        Json* json = &root_;
        if (!open_.empty()) {
            Json& parent = *open_.back();
            if (parent.kind == Json::Kind::list)
                json = &parent.items.emplace_back();
            else
                json = &parent.members.emplace_back(Json::Member{key_, {}}).value;
        }
        json->kind = kind;
        std::tie(json->line, json->column) = place(read_ ? read_ - 1 : 0);
        return json;
    }
    // As placeOf, of offsets that never go back: a text of many values is counted once, not once a value.
    std::pair<int, int> place(size_t offset) {
        for (offset = std::min(offset, text_.size()); counted_ < offset; ++counted_)
            if (text_[counted_] == '\n') ++line_, lineStart_ = counted_ + 1;
        return {line_, int(offset - lineStart_) + 1};
    }
    bool open(Json* json) {
        if (open_.size() >= kMaxDepth) return fail(read_, "nested too deeply");
        open_.push_back(json);
        keys_.emplace_back();
        return true;
    }
    bool close() {
        open_.pop_back();
        keys_.pop_back();
        return true;
    }
    bool fail(size_t offset, const std::string& message) {
        const auto [line, column] = placeOf(text_, offset);
        error = std::to_string(line) + ":" + std::to_string(column) + ": " + message;
        return false;
    }

    std::string_view text_;
    const size_t& read_;
    Json& root_;
    std::string key_;
    size_t counted_ = 0, lineStart_ = 0;
    int line_ = 1;
    // Pointers stay good: while a value is open, nothing is added beside it.
    std::vector<Json*> open_;
    std::vector<std::unordered_set<std::string>> keys_;  // of each
};

}  // namespace

const Json* Json::find(std::string_view name) const {
    for (const auto& [key, value] : members)
        if (key == name) return &value;
    return nullptr;
}

bool readJson(std::string_view text, Json& out, std::string& error) {
    size_t read = 0;
    out = Json{};
    Builder builder(text, read, out);
    const bool good = nlohmann::json::sax_parse(CountingIterator{text.data(), &read},
                                                CountingIterator{text.data() + text.size(), nullptr}, &builder);
    if (!good) error = builder.error.empty() ? "1:1: this isn't JSON" : builder.error;
    return good;
}

}  // namespace espalier::scene
