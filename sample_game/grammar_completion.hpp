#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sample {

// What may stand in place of the letters before the cursor.
struct Completion {
    std::string name, usage;  // usage: how it is written; empty: that isn't known
    bool operator==(const Completion&) const = default;
};

// The letters of the name that ends at the cursor; 0: none does, or it stands in a remark or a text.
size_t lettersBefore(std::string_view text, size_t cursor);

// Names that begin with these letters, in whatever case: those of the text, each told by the line that declares it,
// before `words` of the language; by name, at most kMostCompletions. Nothing that is typed in full.
constexpr size_t kMostCompletions = 8;
std::vector<Completion> completionsOf(std::string_view text, size_t cursor, const std::vector<Completion>& words);

// What is to be inserted: with the bracket that a function or a rule kind with arguments needs.
std::string insertedBy(const Completion& completion);

}  // namespace sample
