#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/scene/json_out.hpp"
#include "tools/scene/json_tree.hpp"

namespace espalier::document {

// A record that is kept as JSON names its fields once, in a member
//     template <class V> void fields(V&& v) { v("radius", radius); ... }
// which FieldWriter and FieldReader visit.
class FieldWriter {
  public:
    explicit FieldWriter(nlohmann::ordered_json& out) : out_(out) {}

    template <class T>
    void operator()(const char* name, T& value) {
        out_[name] = json(value);
    }
    // One that is left out where it is empty.
    template <class T>
    void optional(const char* name, std::vector<T>& value) {
        if (!value.empty()) (*this)(name, value);
    }
    template <class T>
    void optional(const char* name, std::optional<T>& value) {
        if (value) (*this)(name, *value);
    }
    void optional(const char* name, std::string& value) {
        if (!value.empty()) (*this)(name, value);
    }
    // Or where it is false.
    void optional(const char* name, bool& value) {
        if (value) (*this)(name, value);
    }

  private:
    using Out = nlohmann::ordered_json;
    static Out json(bool value) { return value; }
    static Out json(uint32_t value) { return value; }
    static Out json(const std::string& value) { return value; }
    static Out json(float value) { return scene::shortest(value); }
    template <size_t N>
    static Out json(const std::array<float, N>& value) {
        return scene::shortestList(value);
    }
    template <class T>
    static Out json(std::vector<T>& values) {
        Out list = Out::array();
        for (T& value : values) list.push_back(json(value));
        return list;
    }
    template <class T>
    requires requires(T t, FieldWriter w) { t.fields(w); }
    static Out json(T& record) {
        Out object = Out::object();
        record.fields(FieldWriter(object));
        return object;
    }

    Out& out_;
};

// Every field that isn't optional must be there, and of its kind; what else stands in the object is an error too.
// error(): "line:column: message" of the first mistake, empty if there is none.
class FieldReader {
  public:
    explicit FieldReader(const scene::Json& from, std::string& error) : from_(from), error_(error) {}

    template <class T>
    void operator()(const char* name, T& value) {
        known_.push_back(name);
        const scene::Json* json = from_.find(name);
        if (!json) return fail(from_, std::string("'") + name + "' is missing");
        if (!read(*json, value)) fail(*json, std::string("'") + name + "' must be " + kindOf(value));
    }
    template <class T>
    void optional(const char* name, std::vector<T>& value) {
        if (from_.find(name)) (*this)(name, value);
    }
    void optional(const char* name, std::string& value) {
        if (from_.find(name)) (*this)(name, value);
    }
    void optional(const char* name, bool& value) {
        if (from_.find(name)) (*this)(name, value);
    }
    template <class T>
    void optional(const char* name, std::optional<T>& value) {
        if (from_.find(name)) (*this)(name, value.emplace());
    }
    // After all fields.
    void end() {
        for (const auto& member : from_.members)
            if (std::ranges::find(known_, member.name) == known_.end())
                return fail(member.value, "there is no key '" + member.name + "' here");
    }

  private:
    using Kind = scene::Json::Kind;
    static bool read(const scene::Json& json, bool& value) {
        value = json.flag;
        return json.kind == Kind::flag;
    }
    static bool read(const scene::Json& json, uint32_t& value) {
        if (json.kind != Kind::number || json.number < 0 || json.number > 4294967295.0 ||
            json.number != std::floor(json.number))
            return false;
        value = uint32_t(json.number);
        return true;
    }
    static bool read(const scene::Json& json, float& value) {
        if (json.kind != Kind::number || !std::isfinite(float(json.number))) return false;
        value = float(json.number);
        return true;
    }
    static bool read(const scene::Json& json, std::string& value) {
        value = json.text;
        return json.kind == Kind::text;
    }
    template <size_t N>
    static bool read(const scene::Json& json, std::array<float, N>& value) {
        if (json.kind != Kind::list || json.items.size() != N) return false;
        for (size_t i = 0; i < N; ++i)
            if (!read(json.items[i], value[i])) return false;
        return true;
    }
    template <class T>
    bool read(const scene::Json& json, std::vector<T>& values) {
        if (json.kind != Kind::list) return false;
        values.resize(json.items.size());
        for (size_t i = 0; i < values.size(); ++i)
            if (!read(json.items[i], values[i])) return false;
        return true;
    }
    template <class T>
    requires requires(T t, FieldWriter w) { t.fields(w); }
    bool read(const scene::Json& json, T& record) {
        if (json.kind != Kind::object) return false;
        FieldReader inner(json, error_);
        record.fields(inner);
        inner.end();
        return error_.empty();
    }
    // What read() takes, in words.
    static std::string kindOf(bool) { return "true or false"; }
    static std::string kindOf(uint32_t) { return "a whole number up to 4294967295"; }
    static std::string kindOf(float) { return "a number"; }
    static std::string kindOf(const std::string&) { return "a text"; }
    template <class T, size_t N>
    static std::string kindOf(const std::array<T, N>&) {
        return "a list of " + std::to_string(N) + " numbers";
    }
    template <class T>
    static std::string kindOf(const std::vector<T>&) {
        return "a list, of which each is " + kindOf(T{});
    }
    template <class T>
    requires requires(T t, FieldWriter w) { t.fields(w); }
    static std::string kindOf(const T&) { return "an object"; }

    void fail(const scene::Json& at, const std::string& message) {
        if (error_.empty()) error_ = std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + message;
    }

    const scene::Json& from_;
    std::string& error_;
    std::vector<std::string_view> known_;  // the fields' names so far
};

// Counts the memory that a record's fields hold besides the record itself.
class FieldBytes {
  public:
    template <class T>
    void operator()(const char*, T& value) {
        bytes_ += of(value);
    }
    template <class T>
    void optional(const char* name, T& value) {
        (*this)(name, value);
    }
    template <class T>
    void optional(const char* name, std::optional<T>& value) {
        if (value) (*this)(name, *value);
    }
    size_t bytes() const { return bytes_; }

  private:
    template <class T>
    static size_t of(T&) {
        return 0;
    }
    static size_t of(std::string& value) { return value.size(); }
    template <class T>
    static size_t of(std::vector<T>& values) {
        size_t bytes = values.size() * sizeof(T);
        for (T& value : values) bytes += of(value);
        return bytes;
    }
    template <class T>
    requires requires(T t, FieldBytes b) { t.fields(b); }
    static size_t of(T& record) {
        FieldBytes inner;
        record.fields(inner);
        return inner.bytes();
    }

    size_t bytes_ = 0;
};

}  // namespace espalier::document
