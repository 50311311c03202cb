#pragma once

// Descriptions of records: the structs of headers that C++ and GLSL share, with the place of every word.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace espalier::records {

enum class Scalar { uint, int32, float32, boolean, uint64, address };

// A word of a record, or two of an uint64 or address.
struct Field {
    std::string path;  // as GLSL reaches it from the record: "walk.uv.x", "args[2]"
    Scalar scalar;
    std::string type;  // of addresses: the buffer's
    uint32_t word;     // where it begins in the record
};

struct Member {
    std::string type, name;
    uint32_t count = 0;  // of an array; 0: it is none
    uint32_t word = 0, words = 0;
    std::string source;  // of a part of another record: what it is called there
};

struct Record {
    std::string name;
    std::vector<Member> members;
    std::vector<Field> fields;
    uint32_t words = 0;
    bool eights = false;  // it begins at multiples of 8 bytes
};

// What a header asks the generator for; see shaders/shared/language.h.
struct Wish {
    enum class Kind { access, part, offsets, texels, words } kind;
    std::string record, whole;
    uint32_t line;
};

struct Header {
    std::string path;
    std::vector<Wish> wishes;
};

// Of all headers together.
struct Records {
    std::map<std::string, Record> structs;
    std::map<std::string, std::string> buffers;  // of a record: the type of its addresses
    std::map<std::string, uint32_t> sizes;       // bytes that STATIC_SIZE says
    std::map<std::string, uint32_t> constants;   // sizes of arrays that have a name
    std::vector<Header> headers;
};

// Adds a header's text. Throws std::runtime_error, whose text names path and line.
void readHeader(Records& all, const std::string& path, std::string_view text);
// Works out where each word lies, and checks it against STATIC_SIZE.
void layOut(Records& all);

// The GLSL and C++ that a header's wishes ask for.
std::string accessOf(const Records& all, const Header& header);

}  // namespace espalier::records
