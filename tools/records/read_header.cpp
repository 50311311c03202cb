// Reads the structs of a shared header. Their text is regular: a member or several of one type a line.
#include <charconv>
#include <regex>
#include <sstream>

#include "tools/records/records.hpp"

namespace espalier::records {
namespace {

std::string trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
    return first == std::string_view::npos ? "" : std::string(text.substr(first, last - first + 1));
}

// "16" or "16u": sizes of arrays are such numbers, or names of such.
bool plainNumber(std::string_view text, uint32_t& value) {
    if (text.ends_with('u')) text.remove_suffix(1);
    const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
    return wrong == std::errc() && end == text.data() + text.size();
}

struct Reader {
    Records& all;
    Header header;
    Record* open = nullptr;
    uint32_t line = 0;

    void read(const std::string& text) {
        const size_t slashes = text.find("//");
        const std::string code = trimmed(std::string_view(text).substr(0, slashes));
        const std::string comment =
            slashes == std::string::npos ? "" : trimmed(std::string_view(text).substr(slashes + 2));
        std::smatch m;
        static const std::regex kStruct(R"(struct (\w+) \{)"), kSize(R"(STATIC_SIZE\((\w+), (\d+)\);)");
        static const std::regex kBuffer(R"(BUFFER\((\w+), (\w+)\))"), kConstant(R"(CONST_UINT\((\w+), (\d+)u\);)");
        static const std::regex kWish(R"(RECORD_(ACCESS|OFFSETS|TEXELS|WORDS)\((\w+)\))"),
            kPart(R"(RECORD_PART\((\w+), (\w+)\))");
        if (open && code == "};") {
            open = nullptr;
        } else if (open) {
            if (!code.empty()) readMembers(code, comment);
        } else if (std::regex_match(code, m, kStruct)) {
            open = &all.structs[m[1]];
            *open = {.name = m[1], .members = {}, .fields = {}};
        } else if (std::regex_match(code, m, kSize)) {
            all.sizes[m[1]] = uint32_t(std::stoul(m[2]));
        } else if (std::regex_match(code, m, kBuffer)) {
            all.buffers.emplace(m[2], m[1]);
        } else if (std::regex_match(code, m, kConstant)) {
            all.constants[m[1]] = uint32_t(std::stoul(m[2]));
        } else if (std::regex_match(code, m, kPart)) {
            header.wishes.push_back({Wish::Kind::part, m[1], m[2], line});
        } else if (std::regex_match(code, m, kWish)) {
            static const std::map<std::string, Wish::Kind> kKinds = {{"ACCESS", Wish::Kind::access},
                                                                     {"OFFSETS", Wish::Kind::offsets},
                                                                     {"TEXELS", Wish::Kind::texels},
                                                                     {"WORDS", Wish::Kind::words}};
            header.wishes.push_back({kKinds.at(m[1]), m[2], "", line});
        }
    }

    // Nothing can be asked of a struct with functions, initial values or sizes that no plain constant says.
    void giveUp() {
        all.structs.erase(open->name);
        open = nullptr;
    }
    // "vec3 du, dv;" or "uint reads[3];".
    void readMembers(const std::string& code, const std::string& comment) {
        static const std::regex kLine(R"((\w+) ([^;(]+);)"), kName(R"((\w+)(?:\[(\w+)\])?)"),
            kSource(R"(= (\w[\w.\[\]]*).*)");
        std::smatch m, s;
        if (!std::regex_match(code, m, kLine)) return giveUp();
        std::stringstream names(m[2]);
        for (std::string name; std::getline(names, name, ',');) {
            name = trimmed(name);
            std::smatch n;
            if (!std::regex_match(name, n, kName)) return giveUp();
            Member member{.type = m[1], .name = n[1], .source = n[1]};
            if (n[2].matched && !plainNumber(n[2].str(), member.count)) {
                const auto known = all.constants.find(n[2]);
                if (known == all.constants.end()) return giveUp();
                member.count = known->second;
            }
            if (std::regex_match(comment, s, kSource)) member.source = s[1];
            open->members.push_back(member);
        }
    }
};

}  // namespace

void readHeader(Records& all, const std::string& path, std::string_view text) {
    Reader reader{.all = all, .header = {path, {}}};
    std::stringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
        ++reader.line;
        reader.read(line);
    }
    all.headers.push_back(std::move(reader.header));
}

}  // namespace espalier::records
