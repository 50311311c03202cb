// The scalar layout that C++ and GLSL agree on: members follow each other, as aligned as their largest number.
#include <algorithm>
#include <functional>
#include <set>
#include <stdexcept>

#include "tools/records/records.hpp"

namespace espalier::records {
namespace {

struct Vector {
    Scalar scalar;
    uint32_t count;
};

bool vectorOf(const std::string& type, Vector& out) {
    static const std::map<std::string, Vector> kTypes = {
        {"uint", {Scalar::uint, 1}},    {"uvec2", {Scalar::uint, 2}},    {"uvec3", {Scalar::uint, 3}},
        {"uvec4", {Scalar::uint, 4}},   {"int", {Scalar::int32, 1}},     {"ivec2", {Scalar::int32, 2}},
        {"ivec3", {Scalar::int32, 3}},  {"float", {Scalar::float32, 1}}, {"vec2", {Scalar::float32, 2}},
        {"vec3", {Scalar::float32, 3}}, {"vec4", {Scalar::float32, 4}},  {"u64", {Scalar::uint64, 1}},
        {"bool", {Scalar::boolean, 1}}};
    const auto it = kTypes.find(type);
    if (it == kTypes.end()) return false;
    out = it->second;
    return true;
}

struct LayOut {
    Records& all;
    std::set<std::string> done;

    // False: a member's type is nobody's.
    bool lay(const std::string& name) {
        if (done.contains(name)) return true;
        const auto it = all.structs.find(name);
        if (it == all.structs.end()) return false;
        Record& r = it->second;
        uint32_t at = 0;
        for (Member& m : r.members) {
            const uint32_t count = std::max(m.count, 1u);
            m.word = aligned(r, m.type, at);
            at = m.word;
            for (uint32_t i = 0; i < count; ++i) {
                const std::string path = m.count != 0 ? m.name + "[" + std::to_string(i) + "]" : m.name;
                if (!add(r, m.type, path, at)) return false;
            }
            m.words = at - m.word;
        }
        r.words = r.eights ? (at + 1) / 2 * 2 : at;
        done.insert(name);
        return true;
    }
    uint32_t aligned(Record& r, const std::string& type, uint32_t at) {
        Vector v{};
        bool eights = type.ends_with("Buf") || type.ends_with("Buffer");
        if (vectorOf(type, v))
            eights = v.scalar == Scalar::uint64;
        else if (!eights && lay(type))
            eights = all.structs.at(type).eights;
        r.eights = r.eights || eights;
        return eights ? (at + 1) / 2 * 2 : at;
    }
    bool add(Record& r, const std::string& type, const std::string& path, uint32_t& at) {
        Vector v{};
        if (type.ends_with("Buf")) {
            r.fields.push_back({path, Scalar::address, type, at});
            at += 2;
            return true;
        }
        if (vectorOf(type, v)) {
            for (uint32_t k = 0; k < v.count; ++k) {
                const std::string component = v.count > 1 ? std::string(".") + "xyzw"[k] : "";
                r.fields.push_back({path + component, v.scalar, "", at});
                at += v.scalar == Scalar::uint64 ? 2 : 1;
            }
            return true;
        }
        if (!lay(type)) return false;
        const Record& inner = all.structs.at(type);
        for (const Field& f : inner.fields) r.fields.push_back({path + "." + f.path, f.scalar, f.type, at + f.word});
        at += inner.words;
        return true;
    }
};

}  // namespace

void layOut(Records& all) {
    LayOut layout{all, {}};
    std::vector<std::string> names;
    for (const auto& [name, record] : all.structs) names.push_back(name);
    for (const std::string& name : names) {
        if (!layout.lay(name)) {
            all.structs.erase(name);  // nothing can be asked of it
            continue;
        }
        const auto size = all.sizes.find(name);
        const uint32_t bytes = all.structs.at(name).words * 4;
        if (size != all.sizes.end() && size->second != bytes)
            throw std::runtime_error(name + " takes " + std::to_string(bytes) + " bytes, and not the " +
                                     std::to_string(size->second) + " that its header says");
    }
}

}  // namespace espalier::records
