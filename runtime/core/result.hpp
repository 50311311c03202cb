#pragma once

#include <cassert>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace espalier {

// Where in a content file something is wrong. line and column count from 1; 0: not known (a binary file).
// `rule` names the grammar rule, node or accessor concerned, or is empty.
struct Diagnostic {
    std::string file;
    int line = 0;
    int column = 0;
    std::string rule;
    std::string message;
    bool warning = false;
};

// "file:line:column: rule: message", leaving out what is empty; warnings say so.
std::string toString(const Diagnostic& diagnostic);
std::string toString(const std::vector<Diagnostic>& diagnostics);

// A content mistake or an outside failure: at least one diagnostic.
struct Failure {
    // What failed. All but `content` are failures of the device: what it was given is sound.
    enum class Cause {
        content,
        memory,  // the device's memory has run out, or one of its limits is too low
        driver,  // a call of the driver failed for another reason
        lost,    // the device is lost
        fault,   // the driver runs kernels otherwise than they are written
    };
    std::vector<Diagnostic> diagnostics;
    Cause cause = Cause::content;

    Failure(Diagnostic d) { diagnostics.push_back(std::move(d)); }
    explicit Failure(std::vector<Diagnostic> all) : diagnostics(std::move(all)) { assert(!diagnostics.empty()); }
    Failure(std::string_view file, std::string message)
        : Failure(Diagnostic{std::string(file), 0, 0, {}, std::move(message)}) {}
    std::string text() const { return toString(diagnostics); }
    bool ofDevice() const { return cause != Cause::content; }
};

// What the device can't do, whatever the content.
Failure deviceFailure(std::string_view object, std::string message, Failure::Cause cause = Failure::Cause::memory);

// A value or why there is none. Content mistakes and outside failures travel in it; programming mistakes assert.
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::move(value)) {}
    Result(Failure failure) : state_(std::move(failure)) {}

    explicit operator bool() const { return std::holds_alternative<T>(state_); }
    T& value() & { return std::get<T>(state_); }
    const T& value() const& { return std::get<T>(state_); }
    T&& value() && { return std::get<T>(std::move(state_)); }
    T* operator->() { return &value(); }
    T& operator*() { return value(); }
    Failure& failure() { return std::get<Failure>(state_); }
    const Failure& failure() const { return std::get<Failure>(state_); }

  private:
    std::variant<T, Failure> state_;
};

struct Done {};
using Status = Result<Done>;

// Of steps that have all been taken, in this order: the first failure.
inline Status allDone(std::initializer_list<Status> steps) {
    for (const Status& step : steps)
        if (!step) return step;
    return Done{};
}

// What was made takes the place of what `into` holds, which stays where nothing could be made.
template <class T, class U>
Status assign(T& into, Result<U> made) {
    if (!made) return std::move(made.failure());
    into = std::move(*made);
    return Done{};
}

}  // namespace espalier
