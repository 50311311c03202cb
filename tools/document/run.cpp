// Runs in and out of their files.
#include "tools/document/run.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "tools/document/fields.hpp"
#include "tools/scene/guarded.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::document {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kMaxFrames = 1000000;

std::string checkHead(const RunHead& head) {
    if (head.version < 1) return "1:1: there is no format " + std::to_string(head.version) + " of runs";
    if (head.version > RunHead::kVersion)
        return "1:1: this run was recorded by a newer Espalier (format " + std::to_string(head.version) +
               "); this one reads up to " + std::to_string(RunHead::kVersion);
    if (head.width < 1 || head.height < 1 || head.width > 16384 || head.height > 16384)
        return "1:1: frames of " + std::to_string(head.width) + " x " + std::to_string(head.height) + " pixels";
    if (!(head.step > 0 && head.step <= 10)) return "1:1: 'step' must be above 0 and at most 10 seconds";
    return {};
}

bool readHead(const std::string& text, RunHead& head, std::string& error) {
    scene::Json json;
    if (!scene::readJson(text, json, error)) return false;
    if (!json.find("espalier_run")) {
        error = "1:1: this isn't a recorded run: its first line has no 'espalier_run'";
        return false;
    }
    FieldReader reader(json, error);
    head.fields(reader);
    reader.end();
    if (error.empty()) error = checkHead(head);
    return error.empty();
}

// The files that it reads.
std::vector<std::string*> filesOf(Action& action) {
    if (auto* load = std::get_if<LoadLayer>(&action)) return {&load->file};
    if (auto* load = std::get_if<LoadTownLayer>(&action)) return {&load->file};
    if (auto* add = std::get_if<AddSurface>(&action)) return {&add->file};
    if (auto* add = std::get_if<AddGrammar>(&action)) return {&add->file};
    if (auto* add = std::get_if<AddGraph>(&action)) return {&add->file};
    std::vector<std::string*> files;
    if (auto* look = std::get_if<SetLook>(&action)) files = {&look->mesh, &look->picture};
    if (auto* set = std::get_if<SetField>(&action)) files = {&set->field.file};
    std::erase_if(files, [](const std::string* file) { return file->empty(); });
    return files;
}

bool readLines(const std::string& path, Run& out, std::string& error) {
    out = Run{};
    std::string text;
    if (!scene::readText(path, text, error)) return false;
    size_t number = 0;
    for (size_t begin = 0; begin < text.size(); ++number) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        begin = end + 1;
        // A line is a text of its own to the reader; what it says of line 1 is said of this one.
        const auto fail = [&](const std::string& message) {
            const size_t colon = message.find(':');
            error = path + ":" + std::to_string(number + 1) + message.substr(colon == std::string::npos ? 0 : colon);
            return false;
        };
        std::string mistake;
        if (number == 0) {
            if (!readHead(line, out.head, mistake)) return fail(mistake);
            continue;
        }
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        RunLine& entry = out.lines.emplace_back();
        if (!fromJson(line, entry, mistake)) {
            scene::Json whole;
            std::string unheard;
            const bool cutOff = end == text.size() && !scene::readJson(line, whole, unheard);
            if (!cutOff || out.lines.size() < 2) return fail(mistake);
            out.lines.pop_back();
            out.note = path + ":" + std::to_string(number + 1) + ": the last line is cut off and left out";
            break;
        }
        entry.number = number + 1;
        if (out.lines.size() > 1 && entry.frame < out.lines[out.lines.size() - 2].frame)
            return fail("1:1: frame " + std::to_string(entry.frame) + " comes after a later one");
        if (entry.frame > kMaxFrames) return fail("1:1: more than a million frames");
    }
    if (number == 0) {
        error = path + ": the file is empty";
        return false;
    }
    const auto find = [&](std::string& file) {
        if (!fs::path(file).is_absolute()) file = (fs::path(path).parent_path() / file).lexically_normal().string();
    };
    find(out.head.scene);
    for (RunLine& line : out.lines)
        for (std::string* file : filesOf(line.action)) find(*file);
    return true;
}

}  // namespace

bool readRun(const std::string& path, Run& out, std::string& error) {
    return scene::guarded(path + ": ", error, [&] { return readLines(path, out, error); });
}

bool Recorder::begin(const std::string& path, RunHead head, std::string& error) {
    folder_ = scene::absolutePath(path).parent_path().lexically_normal().string();
    head.scene = beside(head.scene);
    if (!scene::isUtf8(head.scene)) {
        error = head.scene + ": its name isn't UTF-8, which a run can't hold";
        return false;
    }
    errno = 0;
    file_.reset(std::fopen(path.c_str(), "w"));
    if (!file_) {
        error = path + ": can't be written: " + std::strerror(errno);
        return false;
    }
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    head.fields(FieldWriter(json));
    frame_ = 0;
    path_ = path;
    failed_ = 0;
    write(scene::textOf(json));
    return true;
}

// A file's name as the run has it: it and what lies beside it may be moved together.
std::string Recorder::beside(const std::string& file) const {
    const fs::path near = scene::absolutePath(file).lexically_normal().lexically_relative(folder_);
    return near.empty() ? file : near.string();
}

// Half a line is the last one, or what follows would be read as its end.
void Recorder::write(const std::string& line) {
    if (failed_ != 0) return;
    errno = 0;
    const bool good = std::fprintf(file_.get(), "%s\n", line.c_str()) > 0 && std::fflush(file_.get()) == 0;
    if (!good && failed_ == 0) failed_ = errno != 0 ? errno : EIO;
}

void Recorder::note(const Action& action, uint32_t gesture) {
    if (!file_) return;
    if (std::holds_alternative<SetCamera>(action)) camera_ = action;
    RunLine line{frame_, gesture, action, 0};
    for (std::string* file : filesOf(line.action)) *file = beside(*file);
    write(toJson(line));
}

bool Recorder::end(std::string& error) {
    if (file_ && std::holds_alternative<SetCamera>(camera_)) note(Action(camera_), 0);
    file_.reset();
    if (failed_ != 0) error = path_ + ": not all of the run could be written: " + std::strerror(failed_);
    return failed_ == 0;
}

}  // namespace espalier::document
