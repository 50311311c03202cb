// In: rows. Out: the report for programs and for people.
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "runtime/core/file.hpp"
#include "tools/bake/main/folder.hpp"

namespace espalier::folder {
namespace {

struct Column {
    const char* title;
    const char* place;  // JSON pointer into the row's report
    int width;
};
constexpr Column kColumns[] = {{"triangles", "/triangles", 10},        {"charts", "/charts", 7},
                               {"area m2", "/walkable_area", 10},      {"str50", "/stretch/p50", 6},
                               {"str95", "/stretch/p95", 6},           {"overlaps", "/overlapping_texels", 9},
                               {"walkable", "/levels/0/walkable", 9},  {"seams", "/crossings/seam", 8},
                               {"nearest", "/crossings/nearest", 8},   {"contact", "/crossings/contact", 8},
                               {"dangling", "/crossings/dangling", 9}, {"one-way", "/crossings/dangling_contacts", 8},
                               {"reach", "/reachable/least", 6}};

// At least a space before it.
std::string padded(std::string text, int width) {
    return std::string(size_t(std::max(1, width - int(text.size()))), ' ') + text;
}

std::string cell(const Row& row, const Column& column) {
    Row::json_pointer place(column.place);
    if (!row.contains("report") || !row["report"].contains(place)) return padded("-", column.width);
    const Row& value = row["report"][place];
    char text[40] = "-";
    if (value.is_number_float())
        std::snprintf(text, sizeof text, value < 1e6 ? "%.*f" : "%.*e", value < 100 ? 2 : 0, value.get<double>());
    if (value.is_number_integer()) std::snprintf(text, sizeof text, "%lld", value.get<long long>());
    return padded(text, column.width);
}

std::string firstLine(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

}  // namespace

Status writeReport(const Options& options, const std::vector<Row>& rows) {
    size_t counts[3] = {};
    std::string table = "outcome";
    for (const Column& c : kColumns) table += padded(c.title, c.width);
    table += padded("levels", 7) + padded("warnings", 9) + "  model\n";
    Row all;
    all["baker"] = std::string("espalier-bake ") + ESPALIER_VERSION;
    all["options"] = options.asked;
    all["models"] = Row::array();
    for (const Row& row : rows) {
        std::string outcome = row["outcome"];
        ++counts[outcome == "baked" ? 0 : outcome == "refused" ? 1 : 2];
        table += outcome + std::string(7 - std::min<size_t>(outcome.size(), 7), ' ');
        for (const Column& c : kColumns) table += cell(row, c);
        const Row report = row.value("report", Row::object());
        table += padded(std::to_string(report.value("levels", Row::array()).size()), 7);
        table += padded(std::to_string(report.value("warnings", Row::array()).size()), 9);
        table += "  " + row.value("model", "") + "\n";
        if (row.contains("message")) table += "        " + firstLine(row["message"]) + "\n";
        all["models"].push_back(row);
    }
    all["baked"] = counts[0];
    all["refused"] = counts[1];
    all["failed"] = counts[2];
    table += "\n" + std::to_string(rows.size()) + " models: " + std::to_string(counts[0]) + " baked, " +
             std::to_string(counts[1]) + " refused, " + std::to_string(counts[2]) + " failed\n";
    std::string text = all.dump(1, ' ', false, Row::error_handler_t::replace) + "\n";
    std::filesystem::path out(options.out);
    Status written = writeFile(out / "report.json", text);
    if (!written) return written;
    return writeFile(out / "report.txt", table);
}

Progress::Progress(size_t total, bool quiet) : total_(total), quiet_(quiet), bar_(isatty(STDERR_FILENO) != 0) {
    if (!quiet_ && bar_) draw();
}

Progress::~Progress() {
    if (!quiet_ && bar_) std::fputc('\n', stderr);
}

void Progress::finished(const Row& row, bool known) {
    ++done_;
    bool baked = row["outcome"] == "baked";
    bad_ += !baked;
    std::string message = row.value("message", "");
    if (bar_ && !quiet_ && !baked) std::fprintf(stderr, "\r\x1b[K%s\n", message.c_str());
    if (bar_ && !quiet_) return draw();
    if (quiet_ && baked) return;
    std::fprintf(stderr, "%zu/%zu %s%s %s\n", done_, total_, row["outcome"].get<std::string>().c_str(),
                 known ? " already" : "", baked ? row.value("model", "").c_str() : message.c_str());
}

void Progress::running(const std::vector<std::string>& models) {
    now_.clear();
    for (const std::string& model : models) now_ += (now_.empty() ? "" : ", ") + model;
    if (bar_ && !quiet_) draw();
}

void Progress::draw() {
    constexpr size_t kWidth = 24;
    size_t filled = total_ ? done_ * kWidth / total_ : kWidth;
    std::string bar(kWidth, '.');
    bar.replace(0, filled, std::string(filled, '#'));
    std::string line = "[" + bar + "] " + std::to_string(done_) + "/" + std::to_string(total_);
    if (bad_ > 0) line += ", " + std::to_string(bad_) + " not baked";
    if (!now_.empty()) line += ": " + now_;
    // A line that wraps could not be drawn over.
    std::fprintf(stderr, "\r\x1b[K%.*s", 79, line.c_str());
    std::fflush(stderr);
}

}  // namespace espalier::folder
