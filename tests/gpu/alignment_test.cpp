// What shaders read and write by address is as aligned as Vulkan asks for
// (VUID-RuntimeSpirv-PhysicalStorageBuffer64-06314): by the largest number or address in it. Debian's validator doesn't
// look, today's do. Judged by the SPIR-V's words.
#include <algorithm>
#include <filesystem>
#include <map>

#include "shaders/shader_table.hpp"
#include "tests/gpu/gpu_test.hpp"

using namespace espalier;

namespace {

enum : uint32_t {  // of SPIR-V's specification
    kTypeInt = 21,
    kTypeFloat = 22,
    kTypeVector = 23,
    kTypeMatrix = 24,
    kTypeArray = 28,
    kTypeRuntimeArray = 29,
    kTypeStruct = 30,
    kTypePointer = 32,
    kForwardPointer = 39,
    kLoad = 61,
    kStore = 62,
    kAligned = 2,
    kByAddress = 5349,
};

// The bytes of the largest scalar in each type; of types of pointers that are addresses, what they lead to; the type of
// each such pointer.
struct Types {
    std::map<uint32_t, uint32_t> largest{}, pointee{}, typeOf{};

    uint32_t of(uint32_t type) const {
        const auto found = largest.find(type);
        return found == largest.end() ? 4 : found->second;
    }
    void take(uint32_t op, std::span<const uint32_t> w) {
        if (op == kTypeInt || op == kTypeFloat) largest[w[1]] = w[2] / 8;
        if (op == kTypeVector || op == kTypeMatrix || op == kTypeArray || op == kTypeRuntimeArray)
            largest[w[1]] = of(w[2]);
        if (op == kTypeStruct)
            for (size_t i = 2; i < w.size(); ++i) largest[w[1]] = std::max(of(w[i]), largest[w[1]]);
        if (op == kForwardPointer && w[2] == kByAddress) largest[w[1]] = 8;
        if (op == kTypePointer && w[2] == kByAddress) {
            largest[w[1]] = 8;
            pointee[w[1]] = w[3];
        }
    }
};

struct Found {
    size_t accesses = 0, wide = 0, short_ = 0;
};

Found judge(std::span<const uint32_t> code) {
    Types types{};
    Found found;
    for (size_t at = 5; at < code.size(); at += code[at] >> 16) {
        const uint32_t op = code[at] & 0xFFFF;
        const std::span<const uint32_t> w = code.subspan(at, code[at] >> 16);
        types.take(op, w);
        // Of what has a type that is its first word; in types' own declarations that is their number.
        if (op != kTypePointer && w.size() > 2 && types.pointee.count(w[1])) types.typeOf[w[2]] = w[1];
        const bool load = op == kLoad;
        if (!load && op != kStore) continue;
        const uint32_t pointer = load ? w[3] : w[1];
        const size_t operands = load ? 4 : 3;
        const auto to = types.pointee.find(types.typeOf[pointer]);
        if (to == types.pointee.end()) continue;
        const uint32_t needed = types.of(to->second);
        ++found.accesses;
        found.wide += needed == 8;
        const bool said = w.size() > operands + 1 && (w[operands] & kAligned);
        found.short_ += !said || w[operands + 1] % needed != 0;
    }
    return found;
}

}  // namespace

TEST_CASE("what shaders read and write by address is aligned as its largest number is") {
    namespace fs = std::filesystem;
    const fs::path shaders = fs::path(ESPALIER_SOURCE_DIR) / "shaders";
    size_t modules = 0, accesses = 0, wide = 0;
    for (const auto& entry : fs::recursive_directory_iterator(shaders)) {
        const std::string name = fs::relative(entry.path(), shaders).generic_string();
        const std::span<const uint32_t> code = shaderCode(name);
        if (code.empty()) continue;
        const Found found = judge(code);
        CHECK_MESSAGE(found.short_ == 0, name << ": " << found.short_ << " of " << found.accesses);
        ++modules;
        accesses += found.accesses;
        wide += found.wide;
    }
    CHECK(modules > 100);
    CHECK(accesses > 1500);
    CHECK(wide > 200);
}
