// In: a model's name. Out: what baking it gave before, if nothing that it was made of has changed.
//
//   .cache/NAME.inputs   the files that the model NAME (hashed, with the options) was last made of
//   .cache/KEY.json      the row of the report; KEY also covers those files' bytes
//   .cache/KEY.glb       the surface, of which the one in the output is a link (or a copy, across file systems)
#include <cinttypes>
#include <filesystem>
#include <sstream>

#include "runtime/core/file.hpp"
#include "runtime/core/hash.hpp"
#include "tools/bake/main/folder.hpp"

namespace espalier::folder {
namespace {

namespace fs = std::filesystem;

std::string hex(uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, value);
    return text;
}

uint64_t hashFile(const fs::path& path) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return 0;
    auto bytes = readFile(path);
    return bytes ? std::max<uint64_t>(hashBytes(*bytes), 1) : 0;
}

}  // namespace

Cache::Cache(const Options& options) : options_(options), cache_((fs::path(options.out) / ".cache").string()) {
    // Another build of the baker may bake otherwise, whatever its version says.
    baker_ = hashText(options.asked, hashFile("/proc/self/exe"));
}

std::string Cache::notePath(const Item& item) const {
    return cache_ + "/" + hex(hashText(item.model, baker_)) + ".inputs";
}

std::string Cache::keyOf(const Item& item, const std::vector<InputFile>& inputs) const {
    uint64_t key = hashText(item.model, baker_);
    for (const InputFile& input : inputs) key = hashText(input.path + " " + hex(input.hash), key);
    return cache_ + "/" + hex(key);
}

Row Cache::find(const Item& item) {
    auto note = readTextFile(notePath(item));
    if (!note) return {};
    std::vector<InputFile> inputs;
    std::istringstream lines(*note);
    for (std::string line; std::getline(lines, line);)
        inputs.push_back({line, hashFile(fs::path(options_.folder) / line)});
    std::string entry = keyOf(item, inputs);
    auto text = readTextFile(entry + ".json");
    if (!text) return {};
    Row row = Row::parse(*text, nullptr, false);
    // A damaged entry is none.
    if (!row.is_object() || row["model"] != item.model || !row["outcome"].is_string()) return {};
    if (row["outcome"] == "baked") {
        if (!row["bytes_hash"].is_string() || row["bytes_hash"] != hex(hashFile(entry + ".glb"))) return {};
        if (!place(entry, item)) return {};
    }
    row.erase("bytes_hash");
    return row;
}

Status Cache::store(const Item& item, const Row& row, const std::vector<InputFile>& inputs,
                    const std::string& surface) {
    std::string entry = keyOf(item, inputs), note;
    bool canBeNoted = true;
    for (const InputFile& input : inputs) {
        canBeNoted = canBeNoted && input.path.find('\n') == std::string::npos;
        note += input.path + "\n";
    }
    Row kept = row;
    bool baked = row["outcome"] == "baked";
    if (baked) {
        kept["bytes_hash"] = hex(hashFile(surface));
        std::error_code error;
        fs::rename(surface, entry + ".glb", error);
        if (error) return Failure(entry + ".glb", "cannot be written: " + error.message());
        Status placed = place(entry, item);
        if (!placed) return placed;
    }
    if (!canBeNoted) return Done{};  // so it is baked each time
    Status written =
        writeFile(entry + ".json", kept.dump(-1, ' ', false, Row::error_handler_t::replace), Links::replace);
    if (!written) return written;
    return writeFile(notePath(item), std::string_view(note), Links::replace);
}

Status Cache::place(const std::string& entry, const Item& item) {
    std::error_code error;
    fs::path from = entry + ".glb", to = fs::path(options_.out) / item.surface;
    if (fs::equivalent(from, to, error)) return Done{};
    fs::create_directories(to.parent_path(), error);
    const fs::path beside = neighbourOf(to);
    fs::create_hard_link(from, beside, error);
    if (error) fs::copy_file(from, beside, fs::copy_options::none, error);
    if (!error) fs::rename(beside, to, error);
    if (!error) return Done{};
    std::error_code ignored;
    fs::remove(beside, ignored);
    return Failure(to.string(), "cannot be written: " + error.message());
}

}  // namespace espalier::folder
